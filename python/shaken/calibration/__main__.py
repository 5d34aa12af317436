"""`python3 -m shaken.calibration`, or by its path, from which the package is found."""
import sys
from pathlib import Path

if not __package__:
    sys.path[0] = str(Path(__file__).resolve().parents[2])

from shaken.program import BAD_INPUT, failed, not_installed  # noqa: E402, which the line before finds

if missing := not_installed("numpy", "h5py"):
    sys.exit(failed(missing, BAD_INPUT, "--json" in sys.argv))

from shaken.calibration.app import main  # noqa: E402, which needs these

sys.exit(main(sys.argv[1:]))
