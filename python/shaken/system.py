"""Programs and folders that do not outlive this process, however it ends; files that are whole or not there."""
import contextlib
import ctypes
import os
import secrets
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import BinaryIO, Iterator, Sequence

from .errors import ShakenError

_PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None)


def ends_with_us() -> None:
    """For `preexec_fn` of subprocess: the program gets SIGTERM when the thread that started it ends."""
    _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


def output_of(command: Sequence[str], whose: str) -> str:
    """What a program prints, which goes with us. Raises ShakenError with its words where it fails; `whose`: before
    these."""
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                          preexec_fn=ends_with_us)
    if done.returncode != 0:
        raise ShakenError(f"{whose}: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


@contextlib.contextmanager
def scratch_folder(prefix: str) -> Iterator[Path]:
    """A folder that is removed behind it, or when this process is killed: by a shell that waits for its end."""
    folder = tempfile.mkdtemp(prefix=prefix)
    remover = subprocess.Popen(["/bin/sh", "-c", 'cat; until rm -rf -- "$0"; do sleep 1; done', folder],
                               stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
    try:
        yield Path(folder)
    finally:
        remover.communicate()


@contextlib.contextmanager
def whole_file(path: Path, sync: bool = False) -> Iterator[BinaryIO]:
    """A file to be written, which takes its place at the end: a reader never finds half of it, and writers do not
    disturb each other. With `sync` it is on the disk then."""
    beside = path.with_name(f".{path.name[:200]}.{secrets.token_hex(6)}.tmp")
    try:
        with beside.open("xb") as file:
            yield file
            if sync:
                file.flush()
                os.fsync(file.fileno())
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)
    if sync:
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def write_whole(path: Path, content: bytes, sync: bool = False) -> None:
    """As whole_file, at once."""
    with whole_file(path, sync) as file:
        file.write(content)
