# SPDX-License-Identifier: MIT
"""Shaken in Python: results of runs, sweeps, the daemon, live state, and plots.

    import shaken
    run = shaken.open("1f0c59d16ab8b7d7")        # a directory, a job's id, or a file of an archive
    run["S"].value, run["S"].error, run["S"].steady
    lag = run["/msd/total_mm2"].axis
    for frame in run.frames(every="0.1 s"): print(frame.time, frame.order)
"""
from .about import FieldAbout, field_about
from .archive import ArchivedRun, Snapshot, archived_runs
from .bus import LiveFrame, LiveObservables, live
from .daemon import Daemon
from .errors import NoDaemon, ShakenError, UnknownName
from .estimate import Estimate, replica_mean
from .frames import Frame, Trajectory
from .run import Array, DirectoryRun, Run
from .run import open_run as open  # noqa: A001, as in numpy's and h5py's own names
from .sweep import Point, Sweep, results

__version__ = "0.1.0"
__all__ = ["ArchivedRun", "Array", "Daemon", "DirectoryRun", "Estimate", "FieldAbout", "Frame", "LiveFrame",
           "LiveObservables", "NoDaemon", "Point", "Run", "ShakenError", "Snapshot", "Sweep", "Trajectory",
           "UnknownName", "archived_runs", "field_about", "live", "open", "replica_mean", "results"]
