"""The blocks of docs/python.md, run in order as they stand, on runs of a real daemon."""
import os
import re
import socket
import subprocess
import sys
from pathlib import Path

import pytest

import shaken

DOCS = Path(__file__).resolve().parents[2] / "docs"
SWEEP = {"name": "demo", "scene": {"box": {"side": "14 mm"}, "accuracy": "draft",
                                   "time": {"steady": "0.1 s", "measure": "0.4 s"},
                                   "measure": {"order": {"every": "10 ms"}, "msd": {"every": "10 ms"}},
                                   "trajectory": {"every": "50 ms"}},
         "sweep": {"grid": {"rods.area_fraction": [0.4, 0.6]}, "replicas": 2}}
#: Single runs, so short that none has an error.
SHORT = {**SWEEP, "name": "short", "sweep": {"grid": {"rods.area_fraction": [0.3, 0.5]}}}


def test_every_block_of_python_md_works(programs, tmp_path, monkeypatch, capsys):
    pytest.importorskip("pandas")
    daemon = programs.start_daemon("--no-lcm", "--slots", "2")
    daemon.wait(daemon.submit(SWEEP), timeout="100 s")
    monkeypatch.setenv("SHAKEN_ROOT", str(programs.root))
    monkeypatch.setenv("MPLBACKEND", "Agg")
    monkeypatch.chdir(tmp_path)
    page = (DOCS / "python.md").read_text()
    blocks = re.findall(r"^```python\n(.*?)^```$", page, flags=re.M | re.S)
    assert len(blocks) == 14
    assert len([line for line in blocks[0].splitlines() if line]) <= 11
    names: dict = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    said = capsys.readouterr().out.splitlines()
    shown = re.findall(r"^print\(.*\)  # ([<{][^;\n]*[>}])", page, flags=re.M)  # what the page says is printed
    assert len(shown) == 2 and set(shown) <= set(said)
    assert (tmp_path / "phases.png").read_bytes()[1:4] == b"PNG"
    assert (tmp_path / "order.pdf").read_bytes()[:4] == b"%PDF" and (tmp_path / "order.csv").exists()
    assert list((tmp_path / "archive").iterdir())
    # and the first also where no error is known
    daemon.wait(daemon.submit(SHORT), timeout="100 s")
    (tmp_path / "phases.png").unlink()
    exec(compile(blocks[0], "docs/python.md", "exec"), {})
    assert (tmp_path / "phases.png").exists()


def test_the_live_observable_of_the_docs(programs):
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        relay = f"127.0.0.1:{listener.getsockname()[1]}"
    daemon = programs.start_daemon("--slots", "1", "--relay", relay, "--lcm-url", f"tcpq://{relay}")
    daemon.submit({"box": {"side": "16 mm"}, "accuracy": "draft", "time": {"measure": "1000 s"}}, name="live")
    script = subprocess.Popen([sys.executable, DOCS / "live_observable.py", relay], stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "PYTHONPATH": str(Path(shaken.__file__).parents[1])})
    line = script.stdout.readline()
    script.kill()
    script.wait()
    script.stdout.close()
    daemon.cancel("live")
    assert re.fullmatch(r"[0-9a-f]{8}  t = [0-9.]+ s  S = [0-9.]+  bend [0-9.]+ degrees\n", line), line
