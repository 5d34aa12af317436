"""Shaken in Python: results of runs, sweeps, the daemon, live state, and plots.

    import shaken
    run = shaken.open("1f0c59d16ab8b7d7")        # a directory, a job's id, or a file of an archive
    run["S"].value, run["S"].error, run["S"].steady
    lag = run["/msd/total_mm2"].axis
    for frame in run.frames(every="0.1 s"): print(frame.time, frame.order)

docs/python.md is the guide.
"""
import importlib
from typing import Any

#: Module -> what it has for users. They are imported when they are asked for: most need numpy, some programs do not.
_PARTS = {"about": "FieldAbout field_about", "archive": "ArchivedRun Snapshot archived_runs",
          "bus": "LiveFrame LiveObservables live", "daemon": "Daemon",
          "errors": "NoDaemon NumericalTrouble ShakenError UnknownName",
          "estimate": "Estimate replica_mean", "frames": "Frame Trajectory",
          "gsd_frames": "gsd_frames", "measuring": "measure",
          "opening": "open_run", "run": "Array DirectoryRun Run", "simulation": "Simulation",
          "sweep": "Point Sweep results sweep_of"}
_HOMES = {"open" if name == "open_run" else name: (module, name)
          for module, names in _PARTS.items() for name in names.split()}

__version__ = "0.1.0"
__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'shaken' has no attribute '{name}'")
    module, its_name = _HOMES[name]
    found = globals()[name] = getattr(importlib.import_module("." + module, __name__), its_name)
    return found


def __dir__() -> list[str]:
    return [*globals(), *__all__]
