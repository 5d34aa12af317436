"""`python -m shaken` is the program `shaken`; by another name that a wheel installs, that program."""
import os
import sys
from pathlib import Path

from .native import programs_folder


def main() -> None:
    """Goes on as the program, whose Python is this one unless SHAKEN_PYTHON says otherwise."""
    name = Path(sys.argv[0]).name
    program = programs_folder() / ("shaken" if name == "__main__.py" else name)
    if not program.exists():
        sys.exit(f"shaken: the programs are not here: there is no {program}. `./dev build programs` builds them, and "
                 "the Debian package and the wheel have them")
    os.environ.setdefault("SHAKEN_PYTHON", sys.executable)
    os.execv(program, [str(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
