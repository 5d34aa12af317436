# SPDX-License-Identifier: MIT
"""What goes wrong, in one sentence with the way out."""
from __future__ import annotations

import difflib
from typing import Iterable


class ShakenError(Exception):
    """Something that the caller can mend: a path, a name, an option, a daemon that does not run."""


class NoDaemon(ShakenError):
    """No daemon answers at its root: none runs there, or it has just ended."""


class UnknownName(ShakenError, KeyError):
    """A name that nothing has, with the nearest that there is."""

    def __init__(self, said: str, name: str, known: Iterable[str], of: str = "there are") -> None:
        names = list(known)
        near = difflib.get_close_matches(name, names, 1)
        hint = f"; did you mean {near[0]}?" if near else ""
        super().__init__(f"{said}{hint} ({of} {', '.join(names) or 'none'})")

    __str__ = Exception.__str__  # a KeyError's is that of its repr
