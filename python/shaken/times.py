# SPDX-License-Identifier: MIT
"""Times as scenes and command lines have them: "0.1 s", "20 ms", "5min"."""
from __future__ import annotations

import re

from .errors import ShakenError

_SECONDS = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}


def seconds(time: float | str) -> float:
    """A time [s] given as a number of seconds, or as a text with its unit (us, ms, s, min, h, d)."""
    if not isinstance(time, str):
        return float(time)
    match = re.fullmatch(r"\s*([0-9.eE+-]+)\s*([a-z]*)\s*", time)
    try:
        return float(match[1]) * _SECONDS[match[2] or "s"]  # type: ignore[index]
    except (TypeError, KeyError, ValueError):
        raise ShakenError(f"'{time}' is no time: write a number and a unit, as in \"0.1 s\" ({', '.join(_SECONDS)})")
