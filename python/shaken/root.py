# SPDX-License-Identifier: MIT
"""Where the daemon keeps its queue and its runs."""
from __future__ import annotations

import os
from pathlib import Path


def root_folder(root: str | Path | None = None) -> Path:
    """`root`; if that is None, $SHAKEN_ROOT, else $XDG_DATA_HOME/shaken, else ~/.local/share/shaken."""
    if root is not None:
        return Path(root)
    if os.environ.get("SHAKEN_ROOT"):
        return Path(os.environ["SHAKEN_ROOT"])
    if os.environ.get("XDG_DATA_HOME"):
        return Path(os.environ["XDG_DATA_HOME"]) / "shaken"
    return Path.home() / ".local" / "share" / "shaken"
