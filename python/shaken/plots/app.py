# SPDX-License-Identifier: MIT
"""What `shaken plot` and `shaken-bench` call to have their figures drawn: python3 -m shaken.plots."""
from __future__ import annotations

import argparse
import io
import json
import math
import os
import sys
import urllib.parse
from pathlib import Path
from typing import Any, Mapping, Sequence

from ..errors import ShakenError
from .save import origin_list

NOTHING, BAD_INPUT = 1, 2


class Nothing(Exception):
    """There is nothing to draw, and why."""


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


def _path(text: str) -> str:
    return os.fsdecode(urllib.parse.unquote_to_bytes(text))


def draw_runs(wanted: Mapping[str, Any]) -> None:
    """Draws the runs and the numbers that a description names, and prints the pictures' paths.

    runs:    [{directory, parameters, state}]; each in the figures of its observables
    points:  [{parameters, version, x, y, error, steady}] or null; the figure of a number against a parameter
    x, y:    of that figure; x empty: the longest parameter
    over:    {x, y}: the times over which these are taken [s], each a list
    rows:    [{id, version}]: what the points are made of
    renderer: the program that draws rods; if given, the figure is a map of the runs' pictures
    folder, name, format, width: of the command line; name: of the one figure, where it has one
    Paths (directory, folder, name, renderer) are percent-encoded: their bytes may be no UTF-8.
    software, sweep: what asks, and the sweep's name
    """
    from . import pictures, runs, sweeps
    width, one_figure = wanted.get("width") or None, not wanted.get("runs")
    x, y = wanted.get("x") or "", wanted.get("y") or "order.mean"
    figures, left_out, renderer = [], {}, wanted.get("renderer")
    if renderer:
        sheet, missing = pictures.picture_map([(_path(of["directory"]), of["parameters"]) for of in wanted["runs"]],
                                              _path(renderer), width)
        figures, left_out = [("map", sheet)], {reason: missing.count(reason) for reason in missing}
        if not any(panel.has_picture for panel in sheet):
            raise Nothing(missing[0])
    elif wanted.get("points") is not None:
        points = [sweeps.PlottedPoint(of["parameters"], _number(of.get("y")), _number(of.get("error")),
                                      of.get("steady", True), _number(of.get("x")), of.get("version") or "")
                  for of in wanted["points"]]
        figure = sweeps.sweep_figure(points, x, y, width, wanted.get("over") or {})
        if figure is not None:
            figures.append(figure)
        elif one_figure:
            path = x or sweeps.longest_parameter(points)
            raise Nothing(f"no point has both {path} and {y} as numbers" if path else
                          "no numeric parameter is swept: --x names a field to plot against")
    drawn = []
    for of in [] if renderer else wanted.get("runs") or []:
        try:
            drawn.append(runs.read_run(_path(of["directory"]), of["parameters"], of.get("state", "")))
        except runs.Unreadable as reason:
            left_out[str(reason)] = left_out.get(str(reason), 0) + 1
    for reason, n in left_out.items():
        print(f"left out: {f'{n} runs, ' if n > 1 else ''}{reason}", flush=True)
    rows = wanted.get("rows") or []
    versions = {run.version for run in drawn} | {row.get("version") or "" for row in rows}
    ids = {run.id for run in drawn} | {row.get("id") or "" for row in rows}
    origin = {"Software": wanted.get("software", "shaken"),
              "Computed by": origin_list(sorted(versions - {""})), "Sweep": wanted.get("sweep") or "",
              "Runs": origin_list(sorted(ids - {""}))}
    origin = {keyword: text for keyword, text in origin.items() if text}
    folder, suffix = Path(_path(wanted["folder"])), "." + (wanted.get("format") or "png")
    n = 0
    for name, sheet in [*figures, *(runs.run_figures(drawn, width) if drawn else [])]:
        path = folder / ((_path(wanted.get("name") or "") or name) + suffix)
        print(sheet.save(path, origin, data=any(panel.drawn for panel in sheet)), flush=True)
        n += 1
    if n == 0:
        raise Nothing("there is nothing to plot yet")


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m shaken.plots", description="Draws figures by matplotlib.")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("runs", help="runs and sweeps, as a description in JSON on stdin says (`shaken plot`)")
    commands.add_parser("check", help="whether figures can be drawn here: says by what")
    bench = commands.add_parser("bench", help="what shaken-bench has measured")
    bench.add_argument("report", help="NAME.json, as it has written")
    bench.add_argument("-o", "--out", default=".", help="folder of the pictures")
    bench.add_argument("--width", default="", help="89mm, 120mm or 183mm")
    verdict = commands.add_parser("verdict", help="what the rows of `shaken-bench accuracy` come to, in words")
    verdict.add_argument("report", help="NAME.json, as it has written; - is stdin")
    options = parser.parse_args(arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="surrogateescape")  # names of files, whatever their bytes
    try:
        if options.command == "runs":
            draw_runs(json.load(sys.stdin))
        elif options.command == "check":
            import h5py  # noqa: F401, which must go with the same numpy
            import matplotlib
            print(f"matplotlib {matplotlib.__version__} of {sys.executable}")
        elif options.command == "verdict":
            from .bench import read_report
            from .verdicts import verdict_text
            print(verdict_text(read_report(Path(options.report))), end="", flush=True)
        else:
            from .bench import draw_report
            for path in draw_report(Path(options.report), Path(options.out), options.width or None):
                print(path, flush=True)
    except BrokenPipeError:  # whoever read has gone, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NOTHING
    except Nothing as reason:
        print(reason)
        return NOTHING
    except ShakenError as problem:
        print(problem)
        return BAD_INPUT
    return 0
