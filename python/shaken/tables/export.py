"""`shaken export`: frames or curves of a run as files of other programs."""
import argparse
import contextlib
import json
import math
import os
import shlex
import signal
import sys
import time
from pathlib import Path
from typing import BinaryIO, Callable

import numpy as np

from ..daemon import Daemon
from ..errors import Failed, ShakenError, imported
from ..frame_formats import beads_xyz, extended_xyz, gsd_snapshots
from ..hdf5 import open_file, try_to_read
from ..program import INTERRUPTED
from ..recorded import Recorded, recorded
from ..rows import target_of
from ..run import arrays_in, frames_in
from ..system import whole_file
from ..text import bytes_text, printable
from ..units import quantity
from .columns import observables_csv, observables_list, summary_csv

_FORMATS = ("extxyz", "gsd", "xyz", "csv")
_ANY_FORMAT = " or ".join((", ".join(_FORMATS[:-1]), _FORMATS[-1]))


class _Interrupted(ShakenError):
    exit_code = INTERRUPTED


def _settle(options: argparse.Namespace) -> None:
    """Sets format, begin, end [s] and step. Raises ShakenError with all that is wrong with the options."""
    problems, words = [], vars(options)
    options.begin, options.end, options.step = -math.inf, math.inf, 1
    for option, name in (("from", "begin"), ("to", "end")):
        try:
            words[name] = quantity(words[option], "time") if words[option] else words[name]
        except ShakenError as error:
            problems.append(f"--{option}: {error}")
    if options.begin > options.end:
        problems.append("--from is later than --to")
    if options.every:
        options.step = int(options.every) if options.every.isdecimal() else 0
        if options.step < 1:
            problems.append(f"--every takes a number from 1, not {options.every}")
    out, names = Path(options.out), options.observable
    suffix, of_frames = out.suffix[1:], words["from"] or options.to or options.every or options.last
    form = options.format = options.format or (suffix if suffix in _FORMATS else "")
    if options.list:
        if form or options.out or names or of_frames:
            problems.append("--list prints names and takes no other option")
    elif form not in _FORMATS:
        problems.append(f"--format takes {_ANY_FORMAT}, not '{form}'" if form else
                        f"--format is missing: {_ANY_FORMAT}")
    else:
        command = f"shaken export {shlex.quote(printable(options.run))} --list"
        problems += [problem for problem, is_wrong in (
            (f"--format {form} does not go with {options.out}", suffix in _FORMATS and suffix != form),
            ("gsd is no text: --out takes a file for it", form == "gsd" and options.out == "-"),
            ("--from, --to, --every and --last choose frames, not csv", form == "csv" and of_frames),
            (f"csv takes --observable NAME; `{command}` lists the names", form == "csv" and not names),
            ("--observable goes with --format csv", form != "csv" and names),
            ("--observable summary stands by itself", "summary" in names and len(names) > 1)) if is_wrong]
    if options.out not in ("", "-") and out.exists() and not out.is_file():
        problems.append(f"{options.out} is no file that could be replaced" +
                        (": give a name in it" if out.is_dir() else ": --out - writes to stdout"))
    if problems:
        raise ShakenError("\n".join(problems))


def _directory_of(options: argparse.Namespace) -> tuple[Path, str]:
    """That of the run, and a name for what is made of it."""
    path = Path(options.run)
    if path.is_file():
        raise ShakenError(f"{options.run} is a file: name the directory of the run, {path.parent}")
    if (path / "scene.json").exists():
        return path, path.resolve().name
    jobs = target_of(Daemon(options.root), options.run).jobs
    if len(jobs) != 1:
        raise ShakenError(f"'{options.run}' is a sweep of {len(jobs)} jobs, and this needs one job: `shaken status "
                          f"{options.run}` lists them")
    return Path(jobs[0]["directory"]), jobs[0]["id"][:8]


def _required(path: Path, remedy: str) -> Path:
    if not path.exists():
        raise ShakenError(f"there is no {path}: {remedy}")
    try_to_read(path, Path(os.environ["SHAKEN_PROGRAM"]).with_name("shaken-worker"))
    return path


def _table(directory: Path, options: argparse.Namespace) -> str:
    """What --list or csv asks for."""
    has_summary = (directory / "summary.json").exists()
    if "summary" in options.observable:
        path = _required(directory / "summary.json", "the run has not ended")
        try:
            return summary_csv(json.loads(path.read_text()))
        except (ValueError, AttributeError, TypeError) as error:
            raise Failed(f"{path} is damaged: {error}") from None
    if options.list and has_summary and not (directory / "observables.h5").exists():
        return "summary\n"
    _required(directory / "observables.h5", "the run has measured nothing yet, or its scene asks for nothing")
    with open_file(directory / "observables.h5") as opened:
        arrays = arrays_in(directory, opened)
        if options.list:
            return "".join(line + "\n" for line in (*["summary"] * has_summary, *observables_list(arrays)))
        return observables_csv(arrays, options.observable)


def _frames(directory: Path) -> Recorded:
    """Of a run that may end meanwhile, when trajectory.part becomes trajectory.h5."""
    remedy = 'the run records no frames: its scene needs a "trajectory" or "movie" block'
    path = frames_in(directory)
    try:
        return recorded(_required(path, remedy))
    except ShakenError:
        if path.exists() or not frames_in(directory).exists():
            raise
        return recorded(_required(frames_in(directory), remedy))


def _chosen(of: Recorded, options: argparse.Namespace) -> range:
    """Of the frames, by whole ticks, so that 0.2 s finds the frame of that tick."""
    if not len(of.ticks):
        raise ShakenError("no frame is recorded yet")
    begin = np.searchsorted(of.ticks, options.begin / of.dt - 0.5)
    found = range(int(begin), int(np.searchsorted(of.ticks, options.end / of.dt + 0.5, "right")), options.step)
    if not found:
        raise ShakenError(f"there is no such frame: the {len(of.ticks)} frames are from {of.times[0]:.6g} s to "
                          f"{of.times[-1]:.6g} s")
    return found[-1:] if options.last else found


def _write_frames(of: Recorded, chosen: range, form: str, file: BinaryIO) -> None:
    """One by one; a terminal shows how far they are."""
    made = {"gsd": gsd_snapshots, "xyz": beads_xyz, "extxyz": extended_xyz}[form](of)
    n, shown = 0, 0.0
    try:
        with contextlib.ExitStack() as open_files:
            write = file.write if form != "gsd" else open_files.enter_context(
                imported("gsd.hoomd").open(f"/proc/self/fd/{file.fileno()}", "wb")).append
            for n, k in enumerate(chosen):
                write(made(of.checked(k)))
                if sys.stderr.isatty() and time.monotonic() > shown + 0.2:
                    shown = time.monotonic()
                    print(f"\r{100 * n / len(chosen):3.0f} %, {n}/{len(chosen)} frames", end="", file=sys.stderr,
                          flush=True)
    except KeyboardInterrupt:
        raise _Interrupted(f"interrupted after {n} of {len(chosen)} frames: no file is written") from None
    except RuntimeError as error:  # of gsd
        raise Failed(f"{form} cannot be written: {error}") from None
    finally:
        if shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def _put(out: str, fill: Callable[[BinaryIO], object]) -> None:
    """Has a file filled, or stdout."""
    if out == "-":
        fill(sys.stdout.buffer)
        return
    try:
        with whole_file(Path(out), sync=True) as file:
            fill(file)
    except OSError as error:
        raise Failed(f"cannot write {out}: {error.strerror or error}") from None


def export(options: argparse.Namespace) -> None:
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)  # so that nothing is left over
    _settle(options)
    directory, name = _directory_of(options)
    if options.list or options.format == "csv":
        text = _table(directory, options).encode(errors="surrogateescape")
        named = options.observable[0].rstrip("/").rpartition("/")[2] if options.observable else ""
        out, said = "-" if options.list else options.out or f"{name}-{named}.csv", ""
        _put(out, lambda file: file.write(text))
    else:
        of = _frames(directory)
        chosen, out = _chosen(of, options), options.out or f"{name}.{options.format}"
        _put(out, lambda file: _write_frames(of, chosen, options.format, file))
        n, rods = len(chosen), len(of.shapes)
        said = f": {n} frame{'s' * (n != 1)} of {rods} rod{'s' * (rods != 1)}"
    if out != "-":
        print(printable(out) + said + (f", {bytes_text(Path(out).stat().st_size)}" if said else ""))
