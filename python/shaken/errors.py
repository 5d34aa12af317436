# SPDX-License-Identifier: MIT
"""What goes wrong, in one sentence with the way out."""


class ShakenError(Exception):
    """Something that the caller can mend: a path, a name, an option, a daemon that does not run."""


class NoDaemon(ShakenError):
    """No daemon answers at its root: none runs there, or it has just ended."""
