# SPDX-License-Identifier: MIT
"""Files that are written whole or not at all."""
from __future__ import annotations

import os
import secrets
from pathlib import Path


def write_whole(path: Path, content: bytes, sync: bool = False) -> None:
    """A reader never finds half a file, and writers do not disturb each other. With `sync` it is on the disk then."""
    beside = path.with_name(f".{path.name[:200]}.{secrets.token_hex(6)}.tmp")
    try:
        with beside.open("xb") as file:
            file.write(content)
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
