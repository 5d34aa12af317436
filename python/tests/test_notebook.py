"""docs/notebook.ipynb, run as it stands, on the archive."""
from pathlib import Path

import nbclient
import nbformat

from conftest import night

ROOT = Path(__file__).resolve().parents[2]


@night
def test_the_notebook_runs_and_draws(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "python"))
    book = nbformat.read(ROOT / "docs/notebook.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells), "outputs are not kept: they grow old"
    nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(ROOT / "docs")}}).execute()
    outputs = [output for cell in book.cells for output in cell.get("outputs", [])]
    assert sum("image/png" in output.get("data", {}) for output in outputs) == 3
    n_runs = len(list((ROOT / "docs/archive").glob("*.run.xz")))
    assert f"{n_runs} runs\n" in [output.get("text") for output in outputs]
