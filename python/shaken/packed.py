"""Runs in one file, to be handed on: the files of their directories as they are, in a tar that xz compresses. Equal
runs give equal files."""
import filecmp
import lzma
import os
import re
import shutil
import tarfile
import tempfile
from pathlib import Path
from typing import Iterable

from .errors import ShakenError
from .hdf5 import open_file
from .run import DirectoryRun
from .system import whole_file
from .text import printable

SUFFIX = ".tar.xz"
#: Of a run, what is packed: the last only if it is asked for. The summary comes last: it says that all is there.
_FILES = ("scene.json", "observables.h5", "trajectory.h5", "summary.json")
_MEMBER = re.compile(f"([0-9a-f]{{16}})/({'|'.join(map(re.escape, _FILES))})")


def pack(directories: Iterable[str | Path], file: str | Path, frames: bool = False) -> list[str]:
    """Writes the runs of these directories into a file, with their trajectories if `frames`; returns their ids. Raises
    ShakenError for a run that has not ended, or whose files are damaged."""
    runs = {run.id: run for run in map(DirectoryRun, directories)}
    if not runs:
        raise ShakenError("there is no run to be packed: none of them is done")
    with whole_file(Path(file), sync=True) as content, lzma.open(content, "wb", preset=6) as compressed, \
            tarfile.open(fileobj=compressed, mode="w") as tar:
        for run_id, run in sorted(runs.items()):
            for name in _FILES:
                path = run.directory / name
                if not path.exists() or (name == "trajectory.h5" and not frames):
                    continue
                if path.suffix == ".h5":
                    open_file(path).close()  # it is what the run has written
                entry = tarfile.TarInfo(f"{run_id}/{name}")
                entry.size = path.stat().st_size
                with path.open("rb") as source:
                    tar.addfile(entry, source)
    return sorted(runs)


def unpack(file: str | Path, folder: str | Path) -> list[Path]:
    """Puts the runs of a file of `pack` into a folder, a directory for each, and returns these. What is there already
    is left as it is. Raises ShakenError, and puts nothing there, where the file is no such file or is damaged, or where
    a directory of the same name holds other results."""
    place = Path(folder)
    beside_it = next(parent for parent in (place, *place.absolute().parents) if parent.is_dir())
    with tempfile.TemporaryDirectory(prefix=".unpacked-", dir=beside_it) as beside:
        names = _extracted(file, Path(beside))
        for name in names:
            if DirectoryRun(Path(beside, name)).id != name:
                raise ShakenError(f"{file}: what is called {name} is another run")
            for path in Path(beside, name).iterdir():
                if path.suffix == ".h5":
                    open_file(path).close()
                there = place / name / path.name
                if there.exists() and not filecmp.cmp(there, path, shallow=False):
                    raise ShakenError(f"{there} is there, and is another file: unpack into another folder")
        for name in names:
            (place / name).mkdir(parents=True, exist_ok=True)
            for part in _FILES:
                if Path(beside, name, part).exists():
                    os.replace(Path(beside, name, part), place / name / part)
    return [place / name for name in names]


def _extracted(file: str | Path, folder: Path) -> list[str]:
    """The names of the runs in a file, whose files are in the folder then."""
    names: dict[str, None] = {}
    try:
        with lzma.open(file) as compressed, tarfile.open(fileobj=compressed, mode="r|") as tar:
            for entry in tar:
                match = _MEMBER.fullmatch(entry.name)
                source = tar.extractfile(entry) if match and entry.isreg() and not entry.pax_headers else None
                if match is None or source is None or entry.issparse():
                    raise ShakenError(f"{file} has a member '{printable(entry.name)}', which `shaken pack` has not "
                                      "written")
                names[match[1]] = None
                (folder / match[1]).mkdir(exist_ok=True)
                with (folder / match[1] / match[2]).open("xb") as target:
                    shutil.copyfileobj(source, target)
    except (OSError, EOFError, ValueError, MemoryError, lzma.LZMAError, tarfile.TarError) as error:
        raise ShakenError(f"{file} is damaged, or no file of `shaken pack`: {error}") from None
    if not names:
        raise ShakenError(f"{file} has no runs")
    return list(names)
