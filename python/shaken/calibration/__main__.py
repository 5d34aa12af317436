# SPDX-License-Identifier: MIT
"""`python3 -m shaken.calibration`, or by its path, from which the package is found."""
import sys
from pathlib import Path

if __package__:
    from .app import main
else:
    sys.path[0] = str(Path(__file__).resolve().parents[2])
    try:
        from shaken.calibration.app import main
    except ModuleNotFoundError as error:
        print(f"shaken: {error.name} is not installed, which `shaken calibrate` needs: `apt install python3-numpy "
              "python3-h5py`", file=sys.stderr)
        sys.exit(2)

sys.exit(main())
