"""Runs, measurements of an experiment, and curves of a paper over each other, and how far they agree."""
import csv
from dataclasses import replace
from pathlib import Path
from typing import Any, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ..errors import ShakenError
from ..run import error_name
from .runs import OBSERVABLES, PlottedRun, Unreadable, curve_of, read_run
from .series import WAY


def read_beside(paths: Sequence[str]) -> list[PlottedRun]:
    """Of each path, a run's directory or a table in CSV, what figures need; its name is what tells it from the others.

    A table has columns named as `shaken export --format csv` names those of an observable: "r_mm", "g2", and perhaps
    "g2_sem". Raises ShakenError with everything that is no such thing.
    """
    found, problems = [], []
    for path in map(Path, paths):
        try:
            one = read_run(path, {}) if path.is_dir() else _read_table(path)
            name = path.stem if path.is_file() else path.resolve().name
            found.append(replace(one, parameters={WAY: name}, version=""))
        except (ShakenError, Unreadable) as problem:
            problems.append(f"{path}: {problem}")
    if problems:
        raise ShakenError("\n".join(problems))
    return found


def _read_table(path: Path) -> PlottedRun:
    try:
        rows = [row for row in csv.reader(path.read_text().splitlines()) if row and not row[0].startswith("#")]
        columns = {name.strip(): [float(row[k] or "nan") for row in rows[1:]] for k, name in enumerate(rows[0])}
    except (OSError, ValueError, IndexError) as problem:
        raise ShakenError(f"neither a run directory nor a table of numbers ({problem})") from None
    arrays: dict[str, NDArray[Any]] = {}
    for of in OBSERVABLES:
        base = [array.rpartition("/")[2] for array in (of.x, of.y, error_name(of.y))]
        if base[0] in columns and base[1] in columns:
            order = np.argsort(columns[base[0]])
            arrays |= {array: np.array(columns[name])[order]
                       for array, name in zip((of.x, of.y, error_name(of.y)), base) if name in columns}
    if not arrays:
        raise ShakenError(f"no figure has two of its columns ({', '.join(columns)}) against each other; `shaken "
                          "export` shows what columns are called")
    return PlottedRun({}, arrays, True)


def agreement(runs: Sequence[PlottedRun]) -> Iterator[str]:
    """How far each curve is from that of the first, in a line each: chi2 = sum of (difference / error)^2 at the places
    of the other curve, where the first is interpolated and an error is known."""
    for of in OBSERVABLES:
        first = curve_of(runs[0], of)
        for other in runs[1:]:
            curve = curve_of(other, of)
            if first is None or curve is None:
                continue
            inside = (curve.x >= first.x.min()) & (curve.x <= first.x.max())
            y = np.interp(curve.x, first.x, first.y)
            squares = np.zeros(len(y))
            for one in (first, curve):
                squares += 0 if one.error is None else np.interp(curve.x, one.x, one.error) ** 2
            known = inside & np.isfinite(y) & np.isfinite(curve.y) & (squares > 0)
            if known.any():
                chi2 = float(np.sum((curve.y - y)[known] ** 2 / squares[known]))
                yield f"{of.name}: {other.parameters[WAY]} against {runs[0].parameters[WAY]}: chi2 = {chi2:.3g} at " \
                      f"{int(known.sum())} places"
