"""A run that has been done: its scene, its numbers with their errors, its curves, and its recorded frames."""
import contextlib
import difflib
import functools
import json
import re
from pathlib import Path
from typing import Any, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from .catalogue import ARRAYS
from .errors import ShakenError, UnknownName
from .estimate import NAN, Estimate
from .frames import Frame, Trajectory
from .hdf5 import h5py_module, object_in, open_file
from .notebook import numbers_html
from .units import split_species, split_unit, unit_of

#: What an array is called in the catalogue: that of standard errors as what they are of, that of one rod as of any.
_DESCRIBED = ((re.compile("^/rods/trace/[0-9]+/"), "/rods/trace/K/"), (re.compile("_sem(?=_|$)"), ""))
_SPECIES = re.compile("rods_[0-9]+")
_TABLE = "/van_hove/displacement_mm"  # a row for each lag


def described(array: str) -> str:
    """The name under which the catalogue describes an array of the first species."""
    for part, name in _DESCRIBED:
        array = part.sub(name, array)
    return array


def axes_of(array: str) -> list[str]:
    """The names of the axes of an array of the first species, the slowest first: ["/msd/lag_s"] of
    "/msd/total_mm2"."""
    return ARRAYS.get(described(array), {}).get("axes", [])


class Array(np.ndarray[Any, Any]):
    """Numbers of an observable: a numpy array that knows what it is, and so do its slices, copies and pickles. What is
    computed from it is an Array whose unit is not known, or a number.

    name:   its path in observables.h5, "/msd/total_mm2"; "" of what was computed
    unit:   "mm2"; "1" for a plain number; None where it is not known
    axis:   the Array that it is measured at (lags, distances, times); None where it has none; a pair (of the rows, of
            the columns) for what has two dimensions: (across, along) of the maps of `pairs` and `defect_maps`,
            (q, lag) of F_s(q, t), (lag, displacement) of the van Hove function, whose displacements are a row for each
            lag too; three of the maps of `density`, (time, y, x)
    error:  the Array of its standard errors, or None
    """

    name: str
    unit: str | None
    axis: Any
    error: "Array | None"

    def __new__(cls, values: Any, name: str = "", unit: str | None = None) -> "Array":
        array = np.asarray(values, dtype=float).view(cls)
        array.name, array.unit = name, unit_of(name) if unit is None and name else unit
        return array

    def __array_finalize__(self, other: Any) -> None:
        is_view = isinstance(other, Array) and self.base is not None and (self.base is other or self.base is other.base)
        self.name, self.unit = (other.name, other.unit) if is_view else ("", None)
        self.axis = self.error = None  # a view may be turned, or a part: __getitem__ and copy know

    def __array_wrap__(self, values: Any, context: Any = None) -> Any:
        made = np.asarray(values)
        return made.view(Array) if made.ndim else made[()]

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        if isinstance(found, Array):
            found.name, found.unit = self.name, self.unit
            found.error = None if self.error is None else self.error[key]
            has_place = isinstance(self.axis, Array) and self.axis.shape == self.shape
            found.axis = self.axis[key] if has_place else self.axis if key is Ellipsis else None
        return found

    def copy(self, order: Any = "C") -> "Array":
        """A copy with the same name, unit, axis and error; `order` as of numpy."""
        made = super().copy(order)
        made.name, made.unit, made.axis, made.error = self.name, self.unit, self.axis, self.error
        return made

    def __deepcopy__(self, memo: Any) -> "Array":
        return self.copy()

    def sort(self, *arguments: Any, **options: Any) -> None:
        """Sorts in place, as numpy does; axis and error are None then."""
        super().sort(*arguments, **options)
        self.axis = self.error = None

    def __reduce__(self) -> Any:
        return _array_of, (np.asarray(self), self.name, self.unit, self.axis, self.error)


def _array_of(values: NDArray[Any], name: str, unit: str | None, axis: Any, error: Any) -> Array:
    array = Array(values, name, unit)
    array.axis, array.error = axis, error
    return array


def error_name(name: str) -> str:
    """The name of the standard errors of an array: "/msd/total_sem_mm2" of "/msd/total_mm2"."""
    group, _, last = name.rpartition("/")
    stem, unit = split_unit(last)
    return f"{group}/{stem}_sem" + (f"_{unit}" if unit else "")


class Arrays(Mapping[str, Array]):
    """The curves and maps of a run by their names, "/g2/g2" or "g2/g2"; each is read when it is first asked for. Raises
    UnknownName for others."""

    def __init__(self, names: list[str], read: Any) -> None:
        self._names = {name: None for name in names}
        self._read = read
        self._known: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        path = "/" + str(name).removeprefix("/")
        if path not in self._names:
            raise UnknownName(f"{path} was not measured", path, self._names, "the run has")
        return self._fetch(path)

    def _fetch(self, path: str) -> Array:
        if path not in self._known:
            self._known[path] = self._fetched(path)
        return self._known[path]

    def _fetched(self, path: str) -> Array:
        values, unit = self._read(path)
        array = Array(values, path, unit)
        species, own = split_species(path)
        species = f"/{species}" if species else ""
        at = [species + axis for axis in axes_of(own)]
        if len(at) > 1:
            *rows, columns = axes = tuple(self._fetch(axis) for axis in at)
            array = Array(np.asarray(array).reshape(*map(len, rows), columns.shape[-1]), path, unit)
            array.axis = axes
        elif own == _TABLE:
            array = Array(np.asarray(array).reshape(len(self._fetch(f"{species}/van_hove/lag_s")), -1), path, unit)
        elif at and at[0] in self._names:
            array.axis = self._fetch(at[0])
        if error_name(path) in self._names:
            array.error = self._fetch(error_name(path))
        return array

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<{len(self)} arrays: {', '.join(self._names)}>"


class Numbers(dict[str, Estimate]):
    """The numbers of a run by their names, as in summary.json: "S" (the mean order), "diffusion_mm2_s", ...
    Raises UnknownName for others."""

    def __missing__(self, name: str) -> Estimate:
        raise UnknownName(f"'{name}' was not measured", name, self, "the run has")

    def __repr__(self) -> str:
        return "\n".join(f"{name} = {estimate}" for name, estimate in self.items())


def numbers_of(summary: Mapping[str, Any]) -> Numbers:
    """The numbers in a summary.json."""
    numbers: dict[str, Estimate] = {}
    order = summary.get("order")
    if order:
        numbers["S"] = _estimate({**order, "value": order.get("mean")}, "1")
        numbers["S_std"] = Estimate(_float(order.get("std")), steady=order.get("steady"))
    for name, measured in (summary.get("measured") or {}).items():
        own = measured.get("steady")  # as in tables, one that does not know is as steady as its run
        numbers[name] = _estimate({**measured, "steady": summary.get("steady") if own is None else own}, unit_of(name))
    return Numbers(numbers)


def _float(value: Any) -> float:
    return NAN if value is None else float(value)


def _estimate(of: Mapping[str, Any], unit: str) -> Estimate:
    drift = of.get("drift") or {}
    return Estimate(_float(of.get("value")), _float(of.get("sem")), of.get("steady"), _float(of.get("n_effective")),
                    _float(drift.get("value")), _float(drift.get("sem")), unit, of.get("reason") or "")


class Run:
    """A run, whether in a directory of its own or in an archive.

    scene:       the resolved scene, as scene.json has it (docs/scene.md)
    parameters:  the swept keys as they were asked for, {"rods.area_fraction": 0.75}, where that is known
    summary:     summary.json, as it is (docs/files.md)
    numbers:     name -> Estimate, `run.numbers["S"].value`; `run["S"]` is the same
    arrays:      name -> Array, `run.arrays["/msd/total_mm2"]`; `run["/msd/total_mm2"]` is the same
    """

    def __init__(self, scene: dict[str, Any], summary: dict[str, Any], arrays: Arrays,
                 parameters: Mapping[str, Any] | None = None, where: str = "") -> None:
        self.scene, self.summary, self.arrays = scene, summary, arrays
        self.where = where
        try:
            if not isinstance(scene, dict) or not isinstance(summary, dict):
                raise TypeError("the scene or the summary is no object")
            self.parameters = dict(parameters or {})
            self.numbers = numbers_of(summary)
        except (TypeError, ValueError, AttributeError, OverflowError) as error:
            raise ShakenError(f"{where} holds what no run has written: {error}") from None

    @property
    def id(self) -> str:
        """What names it, 16 hexadecimal digits; "" where its summary does not say."""
        return str(self.summary.get("run_id") or "")

    @property
    def steady(self) -> bool | None:
        """Whether the averages are of a steady state; None where that cannot be told."""
        return self.summary.get("steady")

    def key(self, path: str) -> Any:
        """A key of the scene, "rods.length", in its default unit: as it was asked for if it was swept, else as
        resolved. None where the scene does not say it. Raises UnknownName for a name that is nearly one of its keys."""
        if path in self.parameters:
            value = self.parameters[path]
            if not isinstance(value, str):
                return value
        value = self.scene
        for part in path.split("."):
            if not isinstance(value, dict):
                return None
            if part not in value:
                if not _SPECIES.fullmatch(part) and difflib.get_close_matches(part, value, 1, 0.8):
                    raise UnknownName(f"the scene has no '{path}'", part, value, "there it has")
                return None
            value = value[part]
        return value

    def __getitem__(self, name: str) -> Any:
        return self.arrays[name] if "/" in str(name) else self.numbers[name]

    def __contains__(self, name: str) -> bool:
        return ("/" + name.lstrip("/") in self.arrays) if "/" in name else name in self.numbers

    def frames(self, every: float | str | None = None) -> Iterator[Frame]:
        """The recorded frames one by one, `every` that much time [s] ("0.1 s"); all if left out."""
        return self.trajectory.frames(every)

    @property
    def trajectory(self) -> Trajectory:
        """The recorded frames. Raises ShakenError where there are none, as of a run from an archive."""
        raise ShakenError(f"run {self.id} has no frames: it comes from an archive, which keeps the last state only")

    def _repr_html_(self) -> str:
        return numbers_html(self.numbers, repr(self).strip("<>"))

    def __repr__(self) -> str:
        if not self.summary:
            return f"<run in {self.where}, which has not ended>"
        time = self.summary.get("sim_seconds")
        return f"<run {self.id[:8]}: {self.summary.get('n_rods')} rods, {time:g} s, S = {self.numbers.get('S', '-')}>"


def _present_state(directory: Path) -> str:
    """What progress.json says of a run that is not done."""
    progress = object_in(directory / "progress.json")
    if progress.get("state") == "failed":
        return "the run has failed" + (f": {why}" if (why := progress.get("message")) else "")
    return "the run was stopped before its end" if progress.get("state") == "stopped" else "the run has not ended yet"


def arrays_in(directory: Path, opened: Any = None) -> Arrays:
    """Those of the observables.h5 of a run; none where there is no such file. All are of one checkpoint if `opened` is
    that file, which stays open: a run at work replaces it."""
    path, names = directory / "observables.h5", list[str]()

    def read(name: str) -> tuple[NDArray[Any], str]:
        with contextlib.nullcontext(opened) if opened else open_file(path) as file:
            data = file[name]
            unit = data.attrs.get("unit", "1")
            return data[()], unit.decode() if isinstance(unit, bytes) else str(unit)

    if path.exists():
        h5py = h5py_module()
        with contextlib.nullcontext(opened) if opened else open_file(path) as file:
            file.visititems(lambda name, item: names.append("/" + name) if isinstance(item, h5py.Dataset) else None)
    return Arrays(names, read)


def frames_in(directory: Path) -> Path:
    """Where all frames are that there are so far."""
    log = directory / "trajectory.part"
    return log if log.exists() else directory / "trajectory.h5"


class DirectoryRun(Run):
    """A run in its directory. Nothing but scene.json and summary.json is read until it is asked for.

    With `so_far` the run may be at work if it has recorded frames: it has these only, and its summary is empty. Raises
    ShakenError where the directory is none of a run, or else the run has not ended."""

    def __init__(self, directory: str | Path, parameters: Mapping[str, Any] | None = None,
                 so_far: bool = False) -> None:
        self.directory = Path(directory)
        try:
            scene = json.loads((self.directory / "scene.json").read_text())
            so_far = so_far and (self.directory / "trajectory.part").exists()
            summary = {} if so_far and not (self.directory / "summary.json").exists() else json.loads(
                (self.directory / "summary.json").read_text())
        except FileNotFoundError as error:
            missing = Path(error.filename).name
            raise ShakenError(f"{self.directory} has no {missing}: " + (
                "it holds imported rods, which have not been simulated; open a run that starts from them"
                if (self.directory / "imported.json").exists() else
                f"{_present_state(self.directory)} (see `shaken status`)" if missing == "summary.json" else
                "it is no directory of a run")) from None
        except (OSError, ValueError, RecursionError) as error:
            raise ShakenError(f"{self.directory}: {error}") from None
        super().__init__(scene, summary, arrays_in(self.directory), parameters, str(self.directory))

    def __getitem__(self, name: str) -> Any:
        if not self.summary:
            raise ShakenError(f"{self.directory} has no '{name}' yet: {_present_state(self.directory)}")
        return super().__getitem__(name)

    @functools.cached_property
    def trajectory(self) -> Trajectory:
        """The frames so far. Raises ShakenError where the scene has no `trajectory`."""
        path = frames_in(self.directory)
        if not path.exists():
            raise ShakenError(f"{self.directory} has no trajectory.h5: the scene has no `trajectory`, which records "
                              "frames")
        return Trajectory(path)
