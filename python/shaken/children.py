# SPDX-License-Identifier: MIT
"""Programs and folders that do not outlive this process, however it ends."""
from __future__ import annotations

import contextlib
import ctypes
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Iterator

_PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None)


def ends_with_us() -> None:
    """For `preexec_fn` of subprocess: the program gets SIGTERM when the thread that started it ends."""
    _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


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
