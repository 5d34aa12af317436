# SPDX-License-Identifier: MIT
"""h5py, which reads the files of runs."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from .errors import ShakenError


def h5py_module() -> Any:
    """The module; a ShakenError that says how to install it where it is not there."""
    try:
        import h5py
    except ImportError:
        raise ShakenError("h5py is not installed, which reads the files of runs: `apt install python3-h5py`, or "
                          "`pip install h5py`") from None
    return h5py


def open_file(path: str | Path) -> Any:
    """An HDF5 file, to be read; a ShakenError where it cannot be."""
    h5py = h5py_module()
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise ShakenError(f"{path}: {error}") from None
