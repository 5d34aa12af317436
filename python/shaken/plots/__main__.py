# SPDX-License-Identifier: MIT
"""python3 -m shaken.plots; or this file by its path, which also tells what is not installed."""
import logging
import sys
from pathlib import Path


def run() -> int:
    from shaken.needed import not_installed
    if missing := not_installed():
        print(missing)
        return 2
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # that it lists the fonts, the first time
    from shaken.plots.app import main
    return main(sys.argv[1:])


if __name__ == "__main__":
    if not __package__:
        # by its path: the folder that Python has put first holds names of this package, not modules
        sys.path[0] = str(Path(__file__).resolve().parents[2])
    sys.exit(run())
