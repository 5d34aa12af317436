# SPDX-License-Identifier: MIT
"""`python3 -m shaken.study`, or by its path, from which the package is found."""
import sys
from pathlib import Path

if __package__:
    from .app import main
else:
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    try:
        from shaken.study.app import main
    except ModuleNotFoundError as error:
        print(f"shaken: {error.name} is not installed, which `shaken figures` needs: `apt install python3-numpy "
              "python3-scipy python3-matplotlib python3-h5py`", file=sys.stderr)
        sys.exit(2)

sys.exit(main())
