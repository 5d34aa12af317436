"""Where the compiled half of the package is: what simulates and measures in this process."""
from __future__ import annotations

import functools
import importlib.machinery
import importlib.util
import sys
from pathlib import Path
from typing import Any

from .errors import ShakenError

_PACKAGE = Path(__file__).resolve().parent
_INSTALLED, _BUILT = _PACKAGE.parents[3], _PACKAGE.parents[1] / "build" / "release"
#: In a wheel beside these files; installed with the programs; in a clone that was built.
_PLACES = (_PACKAGE, _INSTALLED / "lib" / "shaken", _BUILT / "lib")


def programs_folder() -> Path:
    """Where the programs are that this package came with."""
    return next((folder for folder in (_PACKAGE / "bin", _INSTALLED / "bin", _BUILT / "bin")
                 if (folder / "shaken").exists()), _INSTALLED / "bin")


@functools.cache
def native() -> Any:
    """The module `shaken._native`. Raises ShakenError where it is not there, or is of another Python."""
    spec = importlib.machinery.PathFinder.find_spec("_native", [str(place) for place in _PLACES])
    if spec is None or spec.loader is None:
        name = "_native" + importlib.machinery.EXTENSION_SUFFIXES[0]
        raise ShakenError(f"the compiled half of the package is missing: there is no {name} in "
                          f"{', '.join(map(str, _PLACES))}. `./dev build programs` builds it, and the Debian package "
                          "and the wheel have it, each for one version of Python")
    spec.name = "shaken._native"
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules["shaken._native"] = module
    return module
