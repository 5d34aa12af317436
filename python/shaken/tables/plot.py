"""`shaken plot`: figures of a sweep, a job or a run directory."""
import argparse
import os
import sys
from collections import Counter
from pathlib import Path
from typing import Any, Mapping, Sequence

from .. import __version__
from ..daemon import Daemon
from ..errors import Failed, ShakenError
from ..plots import runs, sweeps
from ..plots.beside import agreement, read_beside
from ..plots.save import origin_list
from ..rows import Row, Target, aggregated, axes_of, resolved, target_of
from .conditions import read, selected

_FORMATS, _WIDTHS = ("png", "pdf", "svg"), ("89mm", "120mm", "183mm")


class Nothing(Failed):
    """There is nothing to draw, and why."""


def _picture(options: argparse.Namespace) -> Path | None:
    """Sets the format and `is_one`, whether one figure is asked for; returns the picture that --out names, if it names
    one. Raises ShakenError with all that is wrong."""
    suffix, is_one = Path(options.out).suffix[1:], bool(options.map or options.x or options.y)
    are_runs = len(options.ids) > 1 or os.path.exists(f"{options.id}/scene.json")  # no sweep or job of the daemon
    options.is_one = is_one
    is_picture = suffix in _FORMATS
    problems = [problem for problem, is_wrong in (
        (f"--format takes png, pdf or svg, not '{options.format}'", options.format not in ("", *_FORMATS)),
        (f"--width takes 89mm, 120mm or 183mm, not '{options.width}'", options.width not in ("", *_WIDTHS)),
        (f"{options.out} is one picture, and this draws several: give a folder, or --x and --y, or --map",
         is_picture and not is_one and not are_runs),
        ("--map goes with neither --x nor --y", options.map and (options.x or options.y)),
        (f"{options.out}: a plot is a .png, .pdf or .svg",
         is_one and suffix and not is_picture and not Path(options.out).is_dir()),
        (f"--format {options.format} does not go with {options.out}",
         is_picture and options.format in _FORMATS and suffix != options.format)) if is_wrong]
    if problems:
        raise ShakenError("\n".join(problems))
    options.format = options.format or (suffix if is_picture else "png")
    return Path(options.out) if is_picture else None


def _times_over(points: Sequence[Row], name: str) -> list[float]:
    """The times over which a number is taken in the points [s]; none if it depends on none."""
    over = name[:-len("value")] + "over_s"
    times = {point.number(over) for point in points} if name.endswith(".value") else set()
    return sorted(time for time in times if time == time)


def _sweep_figure(points: Sequence[Row], options: argparse.Namespace) -> list[tuple[str, Any]]:
    """(name, sheet) of a number against a parameter, if there is one to draw."""
    figure = sweeps.sweep_figure(points, options.x, options.y, options.width or None,
                                 {"x": _times_over(points, options.x), "y": _times_over(points, options.y)})
    if figure is None and options.is_one:
        path = options.x or sweeps.longest_parameter(points)
        raise Nothing(f"no point has both {path} and {options.y} as numbers" if path else
                      "no numeric parameter is swept: --x names a field to plot against")
    return [figure] if figure else []


def _runs(wanted: Sequence[tuple[Path, Mapping[str, Any], str]]) -> list[runs.PlottedRun]:
    """The runs of these directories, with their parameters and the states of their jobs, as far as they have been
    measured."""
    drawn, left_out = [], []
    for directory, parameters, state in wanted:
        try:
            drawn.append(runs.read_run(directory, parameters, state))
        except runs.Unreadable as reason:
            left_out.append(str(reason))
    _say_left_out(left_out)
    return drawn


def _say_left_out(reasons: Sequence[str]) -> None:
    for why, n in Counter(reasons).items():
        print(f"left out: {f'{n} runs, ' if n > 1 else ''}{why}", file=sys.stderr, flush=True)


def _map(jobs: Sequence[Mapping[str, Any]], rows: Sequence[Row], options: argparse.Namespace) -> list[tuple[str, Any]]:
    """(name, sheet) of the last frames of runs."""
    renderer = Path(os.environ["SHAKEN_PROGRAM"]).with_name("shaken-render")
    sheet, missing = sweeps.picture_map([(job["directory"], job["parameters"]) for job in jobs],
                                          axes_of(rows), str(renderer), options.width or None)
    if not any(panel.has_picture for panel in sheet):
        raise Nothing(missing[0])
    _say_left_out(missing)
    return [("map", sheet)]


def _asked(options: argparse.Namespace) -> tuple[Target, list[Row]]:
    """A sweep or a job, and its points for which --where holds; x and y become fields of theirs."""
    conditions = read(options.where)
    target = target_of(Daemon(options.root), options.id)
    everything = aggregated(target.rows)
    options.x = resolved(everything, options.x) if options.x else ""
    options.y = resolved(everything, options.y) if options.y else "order.mean"
    points = selected(target, conditions, True)
    if conditions and not points:
        raise Nothing("there is nothing to plot: no point matches --where")
    return target, points


def plot(options: argparse.Namespace) -> None:
    picture, origin = _picture(options), {"Software": f"shaken plot {__version__}"}
    figures: list[tuple[str, Any]] = []
    rows: list[Row] = []
    if len(options.ids) > 1:
        if options.is_one or options.where:
            raise ShakenError("--x, --y, --map and --where are for sweeps, not for runs beside each other")
        folder, drawn = Path("plots-beside"), read_beside(options.ids)
        for line in agreement(drawn):
            print(line, file=sys.stderr)
    elif options.id and os.path.exists(f"{options.id}/scene.json"):
        if options.is_one or options.where:
            raise ShakenError("--x, --y, --map and --where are for sweeps, not for a run directory")
        folder, drawn = Path(options.id) / "plots", _runs([(Path(options.id), {}, "")])
    else:
        target, points = _asked(options)
        folder, drawn = Path("plots-" + target.id[:8]), []
        if target.is_sweep:  # by its name: its number says when it was submitted, and equal runs make equal files
            origin["Sweep"] = target.name
        kept = {point.key for point in points}
        rows = [row for row in target.rows if row.key in kept]
        ids = {row.fields["job"] for row in rows}  # a run that several points of a sweep ask for is one run
        jobs = [job for job in {job["id"]: job for job in target.jobs}.values() if job["id"] in ids]
        figures = _map(jobs, rows, options) if options.map else _sweep_figure(points, options)
        if not options.is_one:
            drawn = _runs([(Path(job["directory"]), job["parameters"], job["state"]) for job in jobs
                           if job["state"] != "queued"])
    for name, of in (("Computed by", {run.version for run in drawn} | {row.made_by for row in rows}),
                     ("Runs", {run.id for run in drawn} | {row.fields["job"] for row in rows})):
        if of - {""}:
            origin[name] = origin_list(sorted(of - {""}))
    folder = picture.parent if picture else Path(options.out) if options.out else folder
    if picture and not options.is_one:
        of_all = runs.run_sheet(drawn, options.width or None)
        figures += [(picture.stem, of_all)] if of_all else []
    elif drawn:
        figures += runs.run_figures(drawn, options.width or None)
    for name, sheet in figures:
        path = folder / f"{picture.stem if picture else name}.{options.format}"
        print(sheet.save(path, origin, data=any(panel.drawn for panel in sheet)), flush=True)
    if not figures:
        raise Nothing("there is nothing to plot yet")
