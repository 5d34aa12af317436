"""What runs have measured, a figure for each observable: S(t), P(S), P(θ), G₂(r), MSD and others."""
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..catalogue import ARRAYS
from ..errors import ShakenError
from ..hdf5 import object_in, open_file
from ..run import axes_of, error_name
from ..rows import newness, version_text
from . import maps, names
from .panel import Panel
from .series import VERSION, Arrangement, grouped, label_of, mean_curve
from .sheet import Sheet

_DEGREES = 180 / np.pi
_MOST_OF_TRACE = 1500  # points of what is recorded over time
Range = tuple[float | None, float | None]


@dataclass(frozen=True)
class Observable:
    """A figure of an array against its axis.

    name:      of the files
    y, also:   the array, and another one that is added to it
    factors:   that x and y are multiplied with; units: in print, if not those of the arrays
    rows:      what y (and x, perhaps) has a row for each value of, one behind the other: that of `row` is drawn
    log, zero, x_range, y_range: of the axes; ranges begin at 0 if left out, unless they are logarithmic or have a zero
    species:   "rods_2" of another one than the first
    """

    name: str
    y: str
    also: str = ""
    y_title: str = ""
    factors: tuple[float, float] = (1.0, 1.0)
    units: tuple[str | None, str | None] = (None, None)
    rows: str = ""
    row: int = 0
    log: tuple[bool, bool] = (False, False)
    zero: bool = False
    x_range: Range | None = None
    y_range: Range | None = None
    x_ticks: tuple[float, ...] = ()
    species: str = ""

    def array(self, name: str) -> str:
        return f"/{self.species}{name}" if self.species and name else name

    @property
    def x(self) -> str:
        return self.array(axes_of(self.y)[-1])

    @property
    def is_trace(self) -> bool:
        """Recorded over time, and no average: it says nothing about steadiness."""
        return self.x.endswith("/time_s")

    @property
    def ys(self) -> list[str]:
        return [self.array(name) for name in (self.y, self.also) if name]

    @property
    def titles(self) -> tuple[str, str]:
        y = self.y_title or names.axis_title(self.y, self.units[1])
        return names.axis_title(axes_of(self.y)[-1], self.units[0]), f"{self.species}: {y}" if self.species else y

    @property
    def ranges(self) -> tuple[Range, Range]:
        return (self.x_range or (_ANY if self.log[0] else _FROM_ZERO),
                self.y_range or (_ANY if self.log[1] or self.zero else _FROM_ZERO))


_FROM_ZERO, _ANY = (0.0, None), (None, None)
_LISTED = (
    Observable("order_time", "/order/order", y_range=(0, 1)),
    Observable("order_pdf", "/order/pdf/density", x_range=(0, 1)),
    Observable("angles", "/angles/density_per_rad", factors=(_DEGREES, 1 / _DEGREES), units=("°", "1/°"),
               x_range=(-90, 90), x_ticks=(-90, -45, 0, 45, 90)),
    Observable("tilt", "/tilt/v_along_mm_s", zero=True, x_range=_ANY),
    Observable("defects", "/defects/n_plus", "/defects/n_minus", y_title=names.axis_title("/defects/n")),
    Observable("g2", "/g2/g2", zero=True),
    Observable("g", "/g2/g"),
    Observable("g2_across", "/pairs/cut/g2_across", zero=True),
    Observable("polar_time", "/polar/order", y_range=(0, 1)),
    Observable("temperature_time", "/temperatures/horizontal_pJ"),
    Observable("scattering", "/scattering/f", rows="/scattering/q_per_mm",
               y_title=names.axis_title("/scattering/f") + ", smallest $q$", log=(True, False), zero=True),
    Observable("non_gaussian", "/scattering/alpha_2", log=(True, False), zero=True),
    Observable("van_hove", "/van_hove/along_per_mm", rows="/van_hove/lag_s", row=-1,
               y_title="van Hove function $G_s(x, t)$, longest $t$ (1/mm)", log=(False, True)),
    Observable("flow", "/flow/c", zero=True),
    Observable("clusters_time", "/clusters/largest", y_range=(0, 1)),
    Observable("cluster_sizes", "/clusters/sizes/density", log=(True, True)),
    Observable("power_time", "/collisions/power_given_pJ_s"),
    Observable("pressure_time", "/stress/collisional_xx_pJ_mm2", "/stress/collisional_yy_pJ_mm2",
               y_title="pressure of impacts (pJ/mm²)"),
    Observable("g_between", "/mixing/g_12"),
    Observable("density_memory", "/density/memory/correlation", zero=True),
    Observable("drift", "/drift/x_mm", "/drift/y_mm", y_title="displacement of all rods (mm)", zero=True),
    Observable("msd", "/msd/total_mm2", log=(True, True)),
    Observable("orientation_memory", "/rotation/c2", log=(True, False), zero=True),
    Observable("velocity_memory", "/velocity/c_v", log=(True, False), zero=True),
    Observable("number_fluctuations", "/fluctuations/std_n", log=(True, True)),
)
#: Of each observable that is not listed, the first array that has a title and one axis.
_REST = {path.split("/")[1]: path for path in reversed(ARRAYS)
         if ARRAYS[path]["title"] and len(ARRAYS[path]["axes"]) == 1}
OBSERVABLES = (*_LISTED, *(Observable(name, path) for name, path in _REST.items()
                           if not any(one.y.startswith(f"/{name}/") for one in _LISTED)))
#: The same of the species that `measure.of` = "each" adds.
OF_EVERY_SPECIES = (*OBSERVABLES, *(replace(of, name=f"{species}_{of.name}", species=species)
                                    for species in ("rods_2", "rods_3") for of in OBSERVABLES))


@dataclass
class PlottedRun:
    """A run that is to be drawn, perhaps one that still runs.

    parameters: the swept keys as they were asked for, the same for all replicas
    arrays:     path -> values, of those that the figures need
    steady:     whether its averages are of a steady state; None where that is not known
    """

    parameters: Mapping[str, Any]
    arrays: Mapping[str, NDArray[Any]]
    steady: bool | None = None
    version: str = ""
    id: str = ""


class Unreadable(Exception):
    """A run that cannot be drawn, and why, in words."""


def read_run(directory: str | Path, parameters: Mapping[str, Any], state: str = "") -> PlottedRun:
    """What a run's directory has for figures. Raises Unreadable where nothing was measured."""
    folder = Path(directory)
    path = folder / "observables.h5"
    if not path.exists():
        raise Unreadable(f"no observables.h5 there: {folder}" if state in ("", "done") else
                         f"{state} before anything was measured")
    summary = object_in(folder / "summary.json")
    wanted = {name for one in OF_EVERY_SPECIES
              for name in (one.x, *one.ys, error_name(one.ys[0]), one.array(one.rows)) if name}
    wanted |= {species + name for species in ("", "/rods_2", "/rods_3") for name in maps.ARRAYS + maps.DENSITY}
    try:
        with open_file(path) as file:
            arrays = {name: np.asarray(file[name][()], dtype=float).ravel() for name in wanted if name in file}
    except OSError:
        raise Unreadable(f"{path} is no file of HDF5, or is damaged") from None
    except ShakenError as problem:
        raise Unreadable(str(problem)) from None
    steady = summary.get("steady")
    return PlottedRun(parameters, arrays, steady if isinstance(steady, bool) else None,
                      version_text(summary.get("versions")), str(summary.get("run_id") or ""))


@dataclass
class Curve:
    """What is drawn of an observable of a run."""

    x: NDArray[Any]
    y: NDArray[Any]
    error: NDArray[Any] | None
    steady: bool | None


def _row(run: PlottedRun, of: Observable, name: str) -> NDArray[Any] | None:
    """An array, or that of its rows that is drawn."""
    values = run.arrays.get(name)
    n_rows = len(run.arrays.get(of.array(of.rows), ()))
    if values is None or not n_rows or (name == of.x and len(values) < len(run.arrays.get(of.ys[0], ()))):
        return values
    length = len(values) // n_rows
    first = of.row % n_rows * length
    return values[first:first + length]


def curve_of(run: PlottedRun, of: Observable) -> Curve | None:
    """None where the run lacks it."""
    parts = [part for name in of.ys if (part := _row(run, of, name)) is not None]
    x = _row(run, of, of.x)
    if x is None or not parts:
        return None
    # A file that is still being written may have one array longer than the other.
    n = min(len(part) for part in (x, *parts))
    if n == 0:
        return None
    x, y = x[:n] * of.factors[0], sum(part[:n] for part in parts) * of.factors[1]
    error = _row(run, of, error_name(of.ys[0])) if not of.also else None
    if error is not None:
        error = np.concatenate([error[:n], np.full(max(0, n - len(error)), np.nan)]) * of.factors[1]
    for value, log in ((x, of.log[0]), (y, of.log[1])):
        if log:
            y = np.where(value > 0, y, np.nan)  # logarithms: zero lag has no place
    return Curve(x, np.asarray(y), error, True if of.is_trace else run.steady)


def _averaged(curves: Sequence[Curve]) -> Iterator[Curve]:
    """One curve for all replicas at the same places; others as they are. It is steady if all of them are. Places that
    were measured, as the number of rods in a box, differ a little, and are averaged too."""
    for x, group in grouped(((curve.x, curve) for curve in curves), lambda known, x: known.shape == x.shape and
                            np.allclose(known, x, rtol=0.02, atol=1e-9)):
        y, error = mean_curve([curve.y for curve in group], [curve.error for curve in group])
        states = [curve.steady for curve in group]
        x = np.mean([curve.x for curve in group], axis=0) if len(group) > 1 else x
        yield Curve(x, y, error, False if False in states else None if None in states else True)


def _thinned(curve: Curve) -> Curve:
    """Every k-th point of what is long: more than that cannot be seen."""
    each = -(-len(curve.x) // _MOST_OF_TRACE)
    return Curve(curve.x[::each], curve.y[::each], None if curve.error is None else curve.error[::each], curve.steady)


def run_figures(runs: Sequence[PlottedRun], width: str | None = None) -> Iterator[tuple[str, Sheet]]:
    """(name, figure) of each observable that at least one run has, and of the maps of each point. Of replicas by one
    version the mean is drawn, with the standard error of replica_mean; what differs in parameters or version are
    different curves."""
    points, of_point = _points(runs)
    for of, curves in _measured(of_point):
        known = [k for k, found in enumerate(curves) if found]
        arrangement = Arrangement([points[k] for k in known])
        sheet = arrangement.sheet(width, *of.titles)
        _draw(of, [curves[k] for k in known], arrangement, arrangement.each(sheet),
              [panel for panel, _ in arrangement.panels_of(sheet)])
        yield of.name, sheet
    labels = [label_of(point) if len(points) > 1 else "" for point in points]
    yield from maps.map_figures([(label, [run.arrays for run in of_one]) for label, of_one in zip(labels, of_point)],
                                width)


def run_sheet(runs: Sequence[PlottedRun], width: str | None = None) -> Sheet | None:
    """All these figures but the maps as panels of one sheet, with one key; None where nothing is measured. Raises
    ShakenError where the runs are more than one panel can name."""
    points, of_point = _points(runs)
    measured = list(_measured(of_point))
    arrangement = Arrangement(points)
    if len(arrangement.panels) > 1 or arrangement.scale is not None:
        raise ShakenError(f"{len(points)} curves in each panel are too many for one picture: give a folder")
    if not measured:
        return None
    columns = min(len(measured), 3)
    sheet = Sheet(width or ("89mm", "120mm", "183mm")[columns - 1], -(-len(measured) // columns), columns)
    for panel, (of, curves) in zip(sheet.panels, measured):
        panel.titles(*of.titles)
        _draw(of, curves, arrangement, [(panel, k) for k, found in enumerate(curves) if found], [panel])
    return sheet.share_key()


def _points(runs: Sequence[PlottedRun]) -> tuple[list[dict[str, Any]], list[list[PlottedRun]]]:
    """What different curves are of, and the runs of each."""
    versions = sorted({run.version for run in runs if run.version}, key=newness)
    # what different versions computed are different points; a run that is not done yet is of the newest
    found = grouped(({**run.parameters, **({VERSION: run.version or versions[-1]} if len(versions) > 1 else {})}, run)
                    for run in runs)
    return [point for point, _ in found], [of_one for _, of_one in found]


def _measured(of_point: Sequence[Sequence[PlottedRun]]) -> Iterator[tuple[Observable, list[list[Curve]]]]:
    """Each observable that at least one run has, with the curves of each point."""
    for of in OF_EVERY_SPECIES:
        curves = [[curve for run in of_one if (curve := curve_of(run, of)) is not None] for of_one in of_point]
        if any(curves):
            yield of, curves


def _draw(of: Observable, curves: Sequence[Sequence[Curve]], arrangement: Arrangement,
          each: Sequence[tuple[Panel, int]], panels: Sequence[Panel]) -> None:
    """Draws curves (points) into the panel of each."""
    # one look for all: the curves of shorter runs have fewer lags
    longest = max(len(curve.x) for found in curves for curve in found)
    is_line = of.is_trace or longest > (12 if arrangement.is_crowded else 40)
    for panel, at in each:
        look = arrangement.look(at)
        for k, curve in enumerate(_averaged(curves[at])):
            shown = _thinned(curve) if of.is_trace else curve
            panel.curve(shown.x, shown.y, shown.error, shown.steady,
                        look="line" if is_line else "points", name=arrangement.label(at),
                        **(look if k == 0 else {"colour": look["colour"]}))
    for panel in panels:
        panel.scale(*("log" if log else "linear" for log in of.log))
        panel.range(*of.ranges)
        if of.zero:
            panel.zero()
        if of.x_ticks:
            panel.axes.set_xticks(of.x_ticks)
