# SPDX-License-Identifier: MIT
"""Where the daemon keeps its queue and its runs."""
from __future__ import annotations

import os
from pathlib import Path

from .errors import ShakenError


def root_folder(root: str | Path | None = None) -> Path:
    """`root`; if that is None, $SHAKEN_ROOT, else $XDG_DATA_HOME/shaken, else ~/.local/share/shaken. Relative paths in
    the last two are ignored, as the XDG base directory specification has it: they would be another root in every
    folder."""
    if root is not None:
        return Path(root)
    if os.environ.get("SHAKEN_ROOT"):
        return Path(os.environ["SHAKEN_ROOT"])
    data = os.environ.get("XDG_DATA_HOME", "")
    if os.path.isabs(data):
        return Path(data) / "shaken"
    home = os.environ.get("HOME", "")
    if not os.path.isabs(home):
        raise ShakenError("no root directory: set SHAKEN_ROOT, or HOME to an absolute path")
    return Path(home) / ".local" / "share" / "shaken"
