"""Arrays and numbers of a run as tables in CSV, named as users name them."""
import json
import os
from typing import Any, Iterable, Iterator, Mapping, Sequence

import numpy as np

from ..catalogue import ARRAYS, KEYS
from ..errors import ShakenError
from ..folder import flattened
from ..run import Array, Arrays, described
from ..text import csv_line, printable, shortest
from ..units import split_species

_ORDER = {name: k for k, name in enumerate(ARRAYS)}


def _group(path: str) -> str:
    return path.rpartition("/")[0]


def _in_order(paths: Iterable[str]) -> list[str]:
    """As the catalogue has them, errors behind their values; what it has not comes last."""
    def rank(path: str) -> tuple[float, bool]:
        own = "/" + split_species(path)[1].lstrip("/")
        return _ORDER.get(described(own), np.inf), described(own) != own

    return sorted(paths, key=rank)


def _called(arrays: Arrays, word: str) -> list[str]:
    """The arrays that a word stands for: one, or those of a group."""
    name = "/" + word.strip("/")
    return [name] if name in arrays else _in_order(path for path in arrays if _group(path) == name)


def _with_maps(arrays: Arrays, called: list[str]) -> list[str]:
    """With the maps below a group that has nothing but their axes."""
    below = [path for path in arrays if len(called) > 1 and path.startswith(_group(called[0]) + "/")]
    return called + _in_order(path for path in below if {axis.name for axis in _axes(arrays[path])} == set(called))


def _axes(array: Array) -> Sequence[Array]:
    """Of a map, the slowest first."""
    return array.axis if isinstance(array.axis, tuple) else ()


def _why_not(arrays: Arrays, word: str) -> str:
    block = word.strip("/").partition("/")[0]
    if any(key.startswith(f"measure.{block}.") for key in KEYS) and not any(
            path.startswith(f"/{block}/") for path in arrays):
        return (f"'{word}' was not measured in this run: its scene has no measure.{block}, or its rods no axis")
    return f"no array or group of observables is called '{word}'"


def _spread(columns: Mapping[str, Array]) -> dict[str, Any]:
    """A line for each point of a map, if there is one and all are of its axes: the fastest of these first."""
    axes = max(map(_axes, columns.values()), key=len, default=())
    names = [axis.name for axis in axes]
    values = {path: array for path, array in columns.items() if path not in names}
    own = {path: _axes(array) or (array.axis,) for path, array in values.items()}
    if not names or not all(map(len, axes)) or not all(
            axis is not None and axis.name in names for found in own.values() for axis in found):
        return dict(columns)
    shape = [axis.shape[-1] for axis in axes]
    own |= {axis.name: axes[:k + 1] if axis.ndim > 1 else (axis,) for k, axis in enumerate(axes)}

    def spread(path: str) -> Any:
        known = [axis.name for axis in own[path]]
        sizes = [size if name in known else 1 for name, size in zip(names, shape)]
        return np.broadcast_to(np.reshape(arrays[path], sizes), shape).ravel()

    arrays = {**columns, **{axis.name: axis for axis in axes}}
    return {path: spread(path) for path in (*reversed(names), *values)}


def observables_csv(arrays: Arrays, words: Sequence[str]) -> str:
    """The arrays that the words name, under their names below the folder that they share; NaN is an empty field. Raises
    ShakenError with all problems."""
    called = {word: _with_maps(arrays, _called(arrays, word)) for word in words}
    problems = [_why_not(arrays, word) for word, paths in called.items() if not paths]
    columns = _spread({path: arrays[path] for paths in called.values() for path in paths})
    if len({np.size(column) for column in columns.values()}) > 1:
        problems += ["arrays of different lengths make no table; name those of one length:",
                     *(f"  {path[1:]} has {np.size(column)}" for path, column in columns.items())]
    if problems:
        raise ShakenError("\n".join(problems))
    shared = os.path.commonpath(list(map(_group, columns)))
    cells = [["" if value != value else shortest(value) for value in np.ravel(column)] for column in columns.values()]
    heads = [path[len(shared.rstrip("/")) + 1:] for path in columns]
    return "".join(map(csv_line, (heads, *zip(*cells))))


def observables_list(arrays: Arrays) -> Iterator[str]:
    """The groups and arrays that a word may stand for, one a line, with lengths and units."""
    for group in sorted({_group(path) for path in arrays} - {""}):
        yield printable(group[1:])
        for path in _called(arrays, group):
            unit = "" if arrays[path].unit == "1" else f" in {arrays[path].unit}"
            yield f"  {printable(path[1:]):40} {arrays[path].size:>8} values{unit}"


def summary_csv(summary: Mapping[str, Any]) -> str:
    """The numbers of a summary.json: those of `measured` by their own names, the average of S(t) as "order", all others
    by their paths; what is not known is an empty field."""
    heads = ("sem", "n_effective", "steady", "over_s")

    def row(name: str, value: Any, estimate: Mapping[str, Any]) -> list[str]:
        return [name, *("" if said is None else shortest(said) if isinstance(said, float) else json.dumps(said)
                        for said in (value, *map(estimate.get, heads)))]

    def rows() -> Iterator[list[str]]:
        for key, value in summary.items():
            if key == "measured":
                yield from (row(name, number.get("value"), number) for name, number in value.items()
                            if isinstance(number, dict))
                continue
            value = None if key == "order" and not isinstance(value, dict) else value
            below = {"order." + name: value[name] for name in ("std", "tau_s", "t_steady_s") if name in value} if (
                key == "order" and value) else {key: value}
            if key == "order" and value:
                yield row("order", value.get("mean"), value)
            yield from (row(name, number, {}) for name, number in flattened(below)
                        if isinstance(number, (int, float)) and not isinstance(number, bool))

    return "".join(map(csv_line, (["name", "value", *heads], *rows())))
