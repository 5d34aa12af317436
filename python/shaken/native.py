"""Where the compiled half of the package is: what simulates and measures in this process."""
import functools
import importlib.machinery
import importlib.util
import shutil
import sys
from pathlib import Path
from typing import Any

from .errors import ShakenError

_PACKAGE = Path(__file__).resolve().parent


def _installations() -> list[Path]:
    """Folders with the bin/ of the programs, and the lib/ of the compiled half, that may belong to this package: a
    wheel, a clone that was built, what it is installed with, and where the program `shaken` of the PATH is."""
    found = [_PACKAGE, _PACKAGE.parents[1] / "build" / "release"]
    if len(_PACKAGE.parents) > 3:
        found.append(_PACKAGE.parents[3])  # PREFIX/share/shaken/python
    if program := shutil.which("shaken"):
        found.append(Path(program).resolve().parents[1])
    return found


def programs_folder() -> Path:
    """Where the programs are that this package came with."""
    folders = [place / "bin" for place in _installations()]
    return next((folder for folder in folders if (folder / "shaken").exists()), folders[0])


@functools.cache
def native() -> Any:
    """The module `shaken._native`. Raises ShakenError where it is not there, or is of another Python."""
    places = [_PACKAGE, *(place / folder for place in _installations() for folder in ("lib", "lib/shaken"))]
    spec = importlib.machinery.PathFinder.find_spec("_native", list(map(str, places)))
    if spec is None or spec.loader is None:
        name = "_native" + importlib.machinery.EXTENSION_SUFFIXES[0]
        raise ShakenError(f"the compiled half of the package is missing: there is no {name} in "
                          f"{', '.join(map(str, places))}. `./dev build programs` builds it, and the Debian package "
                          "and the wheel have it, each for one version of Python")
    spec.name = "shaken._native"
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules["shaken._native"] = module
    return module
