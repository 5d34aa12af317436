"""A run by what a user calls it."""
import re
from pathlib import Path

from .archive import read_archived
from .daemon import root_folder
from .errors import ShakenError
from .run import DirectoryRun, Run


def open_run(run: str | Path, root: str | Path | None = None) -> Run:
    """The run of a directory, of a file of an archive, or of a job's id (or a prefix of it, four digits at least) among
    the runs of `root` ($SHAKEN_ROOT, else ~/.local/share/shaken, as of the daemon).

    Of a run that has not ended there are the frames so far. Raises ShakenError where there is no such run, or where it
    has neither ended nor recorded frames.
    """
    path = Path(run)
    if path.is_dir():
        return DirectoryRun(path, so_far=True)
    if path.is_file():
        return read_archived(path)
    runs = root_folder(root) / "runs"
    name = str(run)
    found = sorted(runs.glob(name + "*")) if re.fullmatch("[0-9a-fA-F]{4,}", name) else []
    if len(found) == 1:
        return DirectoryRun(found[0], so_far=True)
    if found:
        raise ShakenError(f"'{name}' fits {len(found)} runs in {runs}: write more digits")
    raise ShakenError(f"there is no run '{name}': neither a directory, nor a file of an archive, nor a job in {runs}")
