# SPDX-License-Identifier: MIT
"""What figures need besides Python's own library."""
import importlib.util
import sys

#: Module -> the Debian package that has it.
NEEDED = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy", "h5py": "python3-h5py"}


def not_installed() -> str:
    """In words what is not installed, and how it is; "" where all is."""
    missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    return (f"figures need {' and '.join(missing)} of {sys.executable}: "
            f"`apt install {' '.join(NEEDED[name] for name in missing)}`") if missing else ""
