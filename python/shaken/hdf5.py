"""h5py, which reads the files of runs; and whether they are what the runs have written (docs/files.md)."""
import ctypes
import functools
import json
import subprocess
from pathlib import Path
from typing import Any

from .errors import Failed, ShakenError


def h5py_module() -> Any:
    """The module; a ShakenError that says how to install it where it is not there."""
    try:
        import h5py
    except ImportError:
        raise ShakenError("h5py is not installed, which reads the files of runs: `apt install python3-h5py`, or "
                          "`pip install h5py`") from None
    return h5py


def open_file(path: str | Path) -> Any:
    """An HDF5 file, to be read; a ShakenError where it cannot be, or where it is damaged."""
    h5py = h5py_module()
    try:
        _check_content(Path(path))
        return h5py.File(path, "r")
    except OSError as error:
        raise ShakenError(f"{path}: {error}") from None


@functools.lru_cache(maxsize=1)
def _xxhash() -> Any:
    try:
        library = ctypes.CDLL("libxxhash.so.0")
    except OSError:
        raise ShakenError("libxxhash is not installed, which tells damaged files of runs: `apt install libxxhash0`"
                          ) from None
    library.XXH3_createState.restype = ctypes.c_void_p
    library.XXH3_64bits_reset.argtypes = library.XXH3_freeState.argtypes = [ctypes.c_void_p]
    library.XXH3_64bits_update.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t]
    library.XXH3_64bits_digest.argtypes, library.XXH3_64bits_digest.restype = [ctypes.c_void_p], ctypes.c_uint64
    library.XXH3_64bits.argtypes, library.XXH3_64bits.restype = [ctypes.c_char_p, ctypes.c_size_t], ctypes.c_uint64
    return library


def hash_of(content: bytes) -> int:
    """XXH3, 64 bits."""
    return int(_xxhash().XXH3_64bits(content, len(content)))


@functools.lru_cache(maxsize=10_000)
def _xxh3(path: Path, *identity: int) -> str:
    """Of the file that this is, which is read once for each `identity`."""
    library = _xxhash()
    state = library.XXH3_createState()
    try:
        library.XXH3_64bits_reset(state)
        with path.open("rb") as file:
            while piece := file.read(1 << 20):
                library.XXH3_64bits_update(state, piece, len(piece))
        return f"{library.XXH3_64bits_digest(state):016x}"
    finally:
        library.XXH3_freeState(state)


def object_in(file: Path) -> dict[str, Any]:
    """The object of a file that a run writes, "summary.json"; an empty one where it is not there yet, or is damaged."""
    try:
        found = json.loads(file.read_text())
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _promised(path: Path) -> dict[str, Any] | None:
    """Size and hash of a file, if the summary.json beside it has them."""
    files = object_in(path.with_name("summary.json")).get("files")
    promised = files.get(path.name) if isinstance(files, dict) else None
    return promised if isinstance(promised, dict) else None


def try_to_read(path: Path, reader: Path) -> None:
    """As try_to_read of run/files/foreign_file.h: where no hash vouches for the file, the program shaken-worker at
    `reader` tries it. Raises Failed where that is ended or kept by it, as HDF5 is by damaged metadata."""
    if _promised(path) or path.suffix != ".h5":
        return
    try:
        code = subprocess.run([reader, "read", path], capture_output=True, timeout=60, check=False).returncode
    except subprocess.TimeoutExpired:
        raise Failed(f"{path} cannot be read: it kept its reader for over 60 s, as damaged files do") from None
    if code < 0:
        raise Failed(f"{path} cannot be read: it ended its reader (signal {-code}), as damaged files do")


def _check_content(path: Path) -> None:
    """As check_content of run/files/content_hash.h: refuses a file that is not what the summary.json beside it says."""
    for _ in range(2):  # both may be replaced between the look at the one and at the other
        promised = _promised(path)
        if promised is None or not path.exists():
            return
        now = path.stat()
        if now.st_size == promised.get("bytes") and promised.get("xxh3") == _xxh3(
                path, now.st_dev, now.st_ino, now.st_size, now.st_mtime_ns):
            return
    if object_in(path.with_name("progress.json")).get("state") != "running":  # which replaces its files one by one
        raise Failed(f"{path} is damaged: it is not the file that the run has written, as its hash in "
                     "summary.json tells. Put a copy of it back; or remove summary.json beside it and submit the "
                     "scene again, which makes the run's files anew")
