"""`python3 -m shaken.plots`, or by its path, from which the package is found."""
import sys
from pathlib import Path

if not __package__:
    sys.path[0] = str(Path(__file__).resolve().parents[2])

from shaken.plots.app import main  # noqa: E402, which the line before finds

sys.exit(main(sys.argv[1:]))
