"""Sweeps: a row for each state point, with its replicas put together."""
import json
from pathlib import Path
from typing import Any, Iterable, Iterator, Mapping, Sequence

import numpy as np

from .archive import archived_runs
from .catalogue import KEYS, UNITS
from .daemon import Daemon, quoted
from .errors import ShakenError, UnknownName, imported
from .estimate import Estimate, replica_mean
from .notebook import numbers_html, points_html
from .folder import parameters_of, run_directories
from .units import number_of, unit_in
from .run import DirectoryRun, Run
from .rows import has_results, newness, swept, version_text


class Point:
    """A state point of a sweep: runs that differ in their seeds only, all of one version of the physics.

    parameters: the swept keys as they were asked for, {"rods.area_fraction": 0.75}
    runs:       those that are done, each once
    n_replicas: how many there are, done or not
    """

    def __init__(self, parameters: Mapping[str, Any], runs: Sequence[Run], n_replicas: int | None = None) -> None:
        self.parameters = dict(parameters)
        self.runs = list(runs)
        self.n_replicas = len(self.runs) if n_replicas is None else n_replicas

    def names(self) -> list[str]:
        """The names of the numbers that at least one run has."""
        return list(dict.fromkeys(name for run in self.runs for name in run.numbers))

    def __getitem__(self, name: str) -> Estimate:
        """A number, the mean over the replicas (`replica_mean`). Raises UnknownName where no run has it."""
        found = [run.numbers[name] for run in self.runs if name in run.numbers]
        if not found:
            raise UnknownName(f"'{name}' was not measured at {self.label or 'this point'}", name, self.names())
        return replica_mean(found)

    @property
    def version(self) -> str:
        """What computed its runs, "shaken 0.1.0, physics 3"; "" where that is not known, or none is done."""
        return version_text(self.runs[0].summary.get("versions")) if self.runs else ""

    def key(self, path: str) -> Any:
        """A key of the scene, "rods.length", as it was asked for if it was swept; None where the runs do not have it or
        differ in it. Raises UnknownName for what looks like a slip of the pen (Run.key)."""
        if path in self.parameters:
            return self.parameters[path]
        values = {json.dumps(run.key(path)) for run in self.runs}
        return json.loads(values.pop()) if len(values) == 1 else None

    @property
    def label(self) -> str:
        """The parameters in one line, "rods.area_fraction = 0.75, rods.length = 4.5"."""
        return ", ".join(f"{path} = {value}" for path, value in self.parameters.items())

    def _repr_html_(self) -> str:
        return numbers_html({name: self[name] for name in self.names()}, repr(self).strip("<>"))

    def __repr__(self) -> str:
        s = self["S"] if any("S" in run.numbers for run in self.runs) else "-"
        return f"<point {self.label}: S = {s}, {len(self.runs)} of {self.n_replicas} runs done>"


class Sweep:
    """The results of a sweep, or of any runs: a sequence of its state points.

    name:   of the sweep
    points: list of Point, in the order of the sweep
    """

    def __init__(self, points: Sequence[Point], name: str = "") -> None:
        self.points, self.name = list(points), name

    def __iter__(self) -> Iterator[Point]:
        return iter(self.points)

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, k: "int | slice | str") -> Any:
        """Point k; of a slice a Sweep; of a name its column."""
        if isinstance(k, str):
            return self.column(k)
        return Sweep(self.points[k], self.name) if isinstance(k, slice) else self.points[k]

    def _names(self) -> list[str]:
        """Of the numbers that at least one point has."""
        return list(dict.fromkeys(name for point in self.points for name in point.names()))

    @property
    def parameters(self) -> list[str]:
        """The swept keys that have more than one value."""
        return swept(point.parameters for point in self.points)

    def where(self, **conditions: Any) -> "Sweep":
        """The points whose keys have these values: `sweep.where(**{"rods.length": 4.5})`, or with a part of the name
        that fits one swept key, `sweep.where(length="4.5 mm")`; `version` is that of Point. Raises ShakenError for a
        key that no point has and for a value that none has, with those that there are."""
        found = self.points
        for word, wanted in conditions.items():
            path = word if word == "version" else self._path(word)
            unit, own = unit_in(wanted), KEYS.get(path, {}).get("unit")
            if unit and own in UNITS and UNITS[own]["of"] != UNITS[unit]["of"]:
                raise ShakenError(f"'{wanted}' is a {UNITS[unit]['of']}, and {path} is in {own}")
            values = [point.version if word == "version" else point.key(path) for point in found]
            left = [point for point, value in zip(found, values) if _equal(value, wanted)]
            if found and not left:
                there = ", ".join(dict.fromkeys(map(str, values)))
                raise ShakenError(f"no point has {path} = {wanted}; there are {there}")
            found = left
        return Sweep(found, self.name)

    def _swept(self) -> list[str]:
        return list(dict.fromkeys(path for point in self.points for path in point.parameters))

    def _path(self, word: str) -> str:
        """The key that a word stands for."""
        swept = self._swept()
        if word in swept:
            return word
        found = [path for path in swept if path.rpartition(".")[2] == word]
        if len(found) == 1:
            return found[0]
        if found:
            raise ShakenError(f"'{word}' fits several of {', '.join(found)}")
        if "." not in word or all(point.key(word) is None for point in self.points):
            raise UnknownName(f"'{word}' is no key of these points", word, swept, "swept are")
        return word

    def column(self, name: str) -> list[Any]:
        """A number (Estimate) or a key of the scene at each point; an Estimate without a value where it is missing.
        Raises UnknownName for what no point has."""
        measured = self._names()
        if name in measured:
            return [point[name] if name in point.names() else Estimate(reason="not measured") for point in self.points]
        try:
            path = self._path(name)
        except UnknownName:
            if "." not in name and not measured:
                return [Estimate(reason="no run is done") for _ in self.points]
            raise UnknownName(f"'{name}' was measured at no point and is no key of theirs", name,
                              [*measured, *self._swept()]) from None
        return [point.key(path) for point in self.points]

    def to_frame(self) -> Any:
        """A pandas DataFrame: a row for each point; the swept keys, then for each number NAME, NAME:error and
        NAME:steady (True, False, or missing where that cannot be told). Units are in `attrs["units"]`. Needs pandas
        (Debian: python3-pandas)."""
        frame = imported("pandas", "; `records()` does without").DataFrame(self.records())
        frame = frame.astype({name: "boolean" for name in frame if name.endswith(":steady")})
        units = {name: point[name].unit for point in self for name in point.names()}
        frame.attrs["units"] = {**{key: KEYS.get(key, {}).get("unit", "1") for key in self._swept()}, **units,
                                **{name + ":error": unit for name, unit in units.items()}}
        return frame

    def records(self) -> list[dict[str, Any]]:
        """The same as a list of dicts, for which pandas is not needed."""
        several = len({point.version for point in self.points if point.runs}) > 1
        records, names = [], self._names()
        for point in self.points:
            record: dict[str, Any] = {**point.parameters, **({"version": point.version} if several else {}),
                                      "n_done": len(point.runs), "n_replicas": point.n_replicas}
            for name in filter(set(point.names()).__contains__, names):
                estimate = point[name]
                record |= {name: estimate.value, name + ":error": estimate.error, name + ":steady": estimate.steady}
            records.append(record)
        return records

    def pivot(self, rows: str, columns: str, name: str = "S") -> Any:
        """A DataFrame of a number, with the values of one key down and of another across. Raises ShakenError where a
        cell would have several points, of a third key or of several versions: nothing is averaged over them; `where`
        chooses."""
        down, across = self._path(rows), self._path(columns)
        cells: dict[str, tuple[Point, float]] = {}
        for point, value in zip(self.points, self.column(name)):
            if isinstance(value, Estimate) and not value.is_known:
                continue
            other, _ = cells.setdefault(json.dumps([point.key(down), point.key(across)]), (point, float(value)))
            if other is not point:
                raise ShakenError(f"{rows} = {point.key(down)}, {columns} = {point.key(across)} has several points, "
                                  f"which differ in {self._differing(other, point)}: choose one, as in "
                                  f"sweep.where(...).pivot(...)")
        found = [(point.key(down), point.key(across), value) for point, value in cells.values()]
        frame = imported("pandas", "; `records()` does without").DataFrame(found, columns=["down", "across", name])
        return frame.pivot(index="down", columns="across", values=name).rename_axis(index=rows, columns=columns)

    def _differing(self, a: Point, b: Point) -> str:
        """The keys in which two points differ, with all values that there are."""
        found = [(path, [str(point.key(path)) for point in self.points]) for path in self.parameters
                 if not _equal(a.key(path), b.key(path))]
        if a.version != b.version:
            found.append(("version", [point.version for point in self.points]))
        return " and ".join(f"{path} ({', '.join(dict.fromkeys(values))})" for path, values in found) or "nothing"

    def compared(self, other: "Sweep", name: str = "S") -> list[tuple[dict[str, Any], Estimate, Estimate, float]]:
        """The points that both sweeps have: (parameters, this, other, difference in standard errors). Raises
        ShakenError where one of them has a point of several versions (`where(version=...)` chooses), and UnknownName
        for a number that no point has."""
        measured = dict.fromkeys([*self._names(), *other._names()])
        if name not in measured:
            raise UnknownName(f"'{name}' was measured at no point", name, measured)
        ours, theirs = self._by_parameters(), other._by_parameters()
        found = []
        for key, point in ours.items():
            twin = theirs.get(key)
            if twin is None or name not in point.names() or name not in twin.names():
                continue
            a, b = point[name], twin[name]
            found.append((point.parameters, a, b, (b.value - a.value) / (a.error**2 + b.error**2) ** 0.5))
        return found

    def _by_parameters(self) -> dict[str, Point]:
        found: dict[str, Point] = {}
        for point in self.points:
            other = found.setdefault(json.dumps(point.parameters, sort_keys=True), point)
            if other is not point:
                raise ShakenError(f"{point.label} was computed by several versions, which differ in "
                                  f"{self._differing(other, point)}: choose one, as in sweep.where(version=...)")
        return found

    def to_xarray(self) -> Any:
        """An xarray Dataset (Debian: python3-xarray) whose dimensions are the swept keys that are numbers: NAME and
        NAME_error of each number, NaN where there is no point; units are in `attrs`. Raises ShakenError where a place
        would have several points, as `pivot` does."""
        xarray = imported("xarray", "; `records()` does without")
        keys = [key for key in self.parameters
                if all(isinstance(number_of(point.key(key)), (int, float)) for point in self)]
        axes = [sorted({number_of(point.key(key)) for point in self}) for key in keys]
        taken: dict[tuple[int, ...], Point] = {}
        for point in self:
            place = tuple(axis.index(number_of(point.key(key))) for axis, key in zip(axes, keys))
            if taken.setdefault(place, point) is not point:
                raise ShakenError(f"{point.label} has several points, which differ in "
                                  f"{self._differing(taken[place], point)}: choose one, as in sweep.where(...)")
        data = xarray.Dataset(coords={key: (key, axis, {"units": KEYS.get(key, {}).get("unit", "1")})
                                      for key, axis in zip(keys, axes)})
        for name in self._names():
            found = {place: point[name] for place, point in taken.items() if name in point.names()}
            units = {"units": next(iter(found.values())).unit or ""}
            for end, part in (("", "value"), ("_error", "error")):
                values = np.full([len(axis) for axis in axes], np.nan)
                for place, estimate in found.items():
                    values[place] = getattr(estimate, part)
                data[name + end] = (keys, values, units)
        return data

    def _repr_html_(self) -> str:
        return points_html(self.points, self.parameters, repr(self).strip("<>"))

    def __repr__(self) -> str:
        return f"<sweep {self.name or '-'}: {len(self.points)} points over {', '.join(self.parameters) or 'nothing'}>"


def _equal(a: Any, b: Any) -> bool:
    a, b = number_of(a), number_of(b)
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return abs(a - b) <= 1e-9 * max(abs(a), abs(b), 1e-300)
    return bool(a == b)


def grouped(runs: Iterable[tuple[Mapping[str, Any], Run | None]], name: str = "") -> Sweep:
    """Runs, each with the parameters of its point, put together: what different versions of the program or of the
    physics computed is never averaged, and a run counts once. None stands for one that is not done."""
    of_points: dict[str, tuple[Mapping[str, Any], list[Run | None]]] = {}
    for parameters, run in runs:
        of_points.setdefault(json.dumps(parameters, sort_keys=True), (parameters, []))[1].append(run)
    points: list[Point] = []
    for parameters, found in of_points.values():
        versions: dict[tuple[str, int], dict[str, Run]] = {}
        for run in (run for run in found if run is not None):
            made_by = run.summary.get("versions") or {}
            version = (str(made_by.get("shaken")), int(made_by.get("physics") or 0))
            versions.setdefault(version, {}).setdefault(run.id or run.where, run)
        waiting, newest = sum(run is None for run in found), max(versions, default=None, key=newness)
        points += [Point(parameters, list(done.values()), len(done) + (waiting if version == newest else 0))
                   for version, done in versions.items()]
        if not versions:
            points.append(Point(parameters, [], waiting))
    return Sweep(points, name)


def sweep_of(folder: str | Path) -> Sweep:
    """The runs in a folder, at any depth, or the files of an archive there: what tells their scenes apart are the
    parameters. Raises ShakenError where there are none."""
    runs: list[Run] = [*archived_runs(folder)]
    runs = runs or [DirectoryRun(directory) for directory in run_directories(folder)]
    parameters = parameters_of([run.scene for run in runs])
    done = [run if has_results("", run.summary) else None for run in runs]
    return grouped(zip(parameters, done), Path(folder).resolve().name)


def results(source: "Daemon | str | Path | None" = None, sweep: str | None = None) -> Sweep:
    """The results of a sweep, by its id or name; of the newest one if `sweep` is left out.

    source: a Daemon, the root folder of one (its socket is asked), or None for the usual one

    Raises ShakenError where no daemon answers or there is no such sweep. Only numbers are read; curves and frames are
    read when they are asked for.
    """
    daemon = source if isinstance(source, Daemon) else Daemon(source)
    if sweep is None:
        sweeps = daemon.sweeps()
        if not sweeps:
            raise ShakenError(f"the daemon at {daemon.root} has no sweeps")
        sweep = sweeps[-1]["id"]
    name = daemon.ask("GET", "/v1/sweeps/" + quoted(sweep))["sweep"]["name"]

    def runs() -> Iterator[tuple[Mapping[str, Any], Run | None]]:
        for row in daemon.rows(str(sweep)):
            summary = row.get("summary") or {}
            done = summary and has_results(row["state"], summary)
            yield row["parameters"], DirectoryRun(row["directory"], row["parameters"]) if done else None

    return grouped(runs(), name)
