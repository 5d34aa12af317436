"""Runs in one file, to be handed on: the files of their directories as they are, in a tar that xz compresses. Equal
runs give equal files."""
from __future__ import annotations

import io
import lzma
import re
import tarfile
from pathlib import Path
from typing import Iterable

from .errors import ShakenError
from .hdf5 import open_file
from .run import DirectoryRun
from .system import write_whole

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
    content = io.BytesIO()
    with lzma.open(content, "wb", preset=6) as compressed, tarfile.open(fileobj=compressed, mode="w") as tar:
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
    write_whole(Path(file), content.getvalue(), sync=True)
    return sorted(runs)


def unpack(file: str | Path, folder: str | Path) -> list[Path]:
    """Puts the runs of a file of `pack` into a folder, a directory for each, and returns these. What is there already
    is left as it is. Raises ShakenError where the file is no such file or is damaged, and where a directory of the same
    name holds other results; directories of runs that came before it are whole."""
    found: dict[str, Path] = {}
    try:
        with lzma.open(file) as compressed, tarfile.open(fileobj=compressed, mode="r|") as tar:
            for entry in tar:
                match = _MEMBER.fullmatch(entry.name)
                if match is None or not entry.isreg():
                    raise ShakenError(f"{file} has a member '{entry.name}', which `shaken pack` has not written")
                source = tar.extractfile(entry)
                assert source is not None
                found[match[1]] = Path(folder) / match[1]
                _put(found[match[1]] / match[2], source.read())
    except (OSError, EOFError, lzma.LZMAError, tarfile.TarError) as error:
        raise ShakenError(f"{file} is damaged, or no file of `shaken pack`: {error}") from None
    if not found:
        raise ShakenError(f"{file} has no runs")
    for run_id, directory in found.items():
        if DirectoryRun(directory).id != run_id:
            raise ShakenError(f"{file}: what is called {run_id} is another run")
        for path in directory.glob("*.h5"):
            open_file(path).close()
    return list(found.values())


def _put(path: Path, content: bytes) -> None:
    if path.exists() and path.read_bytes() != content:
        raise ShakenError(f"{path} is there, and is another file: unpack into another folder")
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, content)
