# SPDX-License-Identifier: MIT
"""python3 -m shaken.plots; or this file by its path, which also tells what is not installed."""
import importlib.util
import logging
import sys
from pathlib import Path

#: Module -> the Debian package that has it.
NEEDED = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy", "h5py": "python3-h5py"}


def run() -> int:
    missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if missing:
        print(f"figures need {' and '.join(missing)} of {sys.executable}: "
              f"`apt install {' '.join(NEEDED[name] for name in missing)}`")
        return 2
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # that it lists the fonts, the first time
    from shaken.plots.app import main
    return main(sys.argv[1:])


if __name__ == "__main__":
    if not __package__:
        # by its path: the folder that Python has put first holds names of this package, not modules
        sys.path[0] = str(Path(__file__).resolve().parents[2])
    sys.exit(run())
