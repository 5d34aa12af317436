"""Maps: about topological defects (`measure.defect_maps`), the director on the density, and the flow; and of the
density in time (`measure.density`)."""
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from . import names, style
from .panel import Panel
from .sheet import Sheet

GROUP = "/defect_maps"
AXES = (f"{GROUP}/along_mm", f"{GROUP}/across_mm")
CHARGES = {"plus": "+1/2", "minus": "−1/2"}
VALUES = ("density", "cos_2theta", "sin_2theta", "v_along_mm_s", "v_across_mm_s", "tilt_squared")
#: Every array that the figure is made of.
ARRAYS = (*AXES, *(f"{GROUP}/{charge}/{value}" for charge in CHARGES for value in VALUES))
#: The same of the maps of the density.
DENSITY = ("/density/time_s", "/density/x_mm", "/density/y_mm", "/density/area_fraction", "/density/mean_area_fraction")
_MOST_MARKS = 16  # arrows or rods each way


def _mean(runs: Sequence[Mapping[str, NDArray[Any]]], name: str, shape: tuple[int, int]) -> NDArray[Any]:
    """The mean map of replicas, of those that know it at a place."""
    found = np.array([run[name].reshape(shape) for run in runs])
    there = np.isfinite(found)
    with np.errstate(all="ignore"):
        return np.where(there, found, 0).sum(axis=0) / there.sum(axis=0)


def _director(panel: Panel, x: NDArray[Any], y: NDArray[Any], cosine: NDArray[Any], sine: NDArray[Any]) -> None:
    """Short lines along the director, as long as the order is high."""
    angle, order = np.arctan2(sine, cosine) / 2, np.hypot(cosine, sine)
    _arrows(panel, x, y, order * np.cos(angle), order * np.sin(angle), 1.0, {"headwidth": 0, "headlength": 0,
                                                                            "headaxislength": 0, "pivot": "mid"})
    grid_x, grid_y = map(np.ravel, np.meshgrid(x, y))
    panel.record("angle of the director (rad)", grid_x, grid_y, z=angle.ravel())
    panel.record("nematic order", grid_x, grid_y, z=order.ravel())


def _arrows(panel: Panel, x: NDArray[Any], y: NDArray[Any], u: NDArray[Any], v: NDArray[Any], longest: float,
            look: Mapping[str, Any]) -> None:
    """Arrows on some of the places; one of the length `longest` reaches to the next."""
    each = -(-len(x) // _MOST_MARKS)
    some = slice(len(x) // 2 % each, None, each)
    between = each * (x[1] - x[0])
    panel.axes.quiver(x[some], y[some], u[some, some], v[some, some], angles="xy", scale_units="xy",
                      scale=longest / between, width=0.006, color="black", **look)


def _panels(sheet: Sheet, k: int, runs: Sequence[Mapping[str, NDArray[Any]]], prefix: str, charge: str,
            limits: Mapping[str, tuple[float, float]]) -> tuple[Any, Any]:
    x, y = (np.asarray(runs[0][prefix + axis]) for axis in AXES)
    maps = {value: _mean(runs, f"{prefix}{GROUP}/{charge}/{value}", (len(y), len(x))) for value in VALUES}
    upper, lower = sheet[k], sheet[k + 2]
    for panel in (upper, lower):
        panel.titles(names.axis_title(AXES[0]), names.axis_title(AXES[1]), f"about {CHARGES[charge]} defects")
    density = upper.map(x, y, maps["density"], names.axis_title(f"{GROUP}/plus/density"), limits=limits["density"],
                        bar=False)
    _director(upper, x, y, maps["cos_2theta"], maps["sin_2theta"])
    flow = lower.map(x, y, maps["v_along_mm_s"], names.axis_title(f"{GROUP}/plus/v_along_mm_s"), diverging=True,
                     limits=limits["v"], bar=False)
    _arrows(lower, x, y, maps["v_along_mm_s"], maps["v_across_mm_s"], limits["v"][1], {"pivot": "mid"})
    grid_x, grid_y = map(np.ravel, np.meshgrid(x, y))
    lower.record(names.axis_title(f"{GROUP}/plus/v_across_mm_s"), grid_x, grid_y, z=maps["v_across_mm_s"].ravel())
    return density, flow


def _limits(runs: Sequence[Mapping[str, NDArray[Any]]], prefix: str) -> dict[str, tuple[float, float]]:
    """What the colours reach, the same for both charges, without the few bins that say least."""
    def seen(*values: str) -> NDArray[Any]:
        found = np.concatenate([run[f"{prefix}{GROUP}/{charge}/{value}"] for run in runs for charge in CHARGES
                                for value in values])
        return found[np.isfinite(found)]

    density, v = seen("density"), np.abs(seen("v_along_mm_s", "v_across_mm_s"))
    low, high = np.percentile(density, (2, 98)) if density.size else (0.0, 1.0)
    most = float(np.percentile(v, 98)) if v.size else 1.0
    return {"density": (float(low), float(max(high, low + 1e-9))), "v": (-(most or 1.0), most or 1.0)}


def defect_figure(runs: Sequence[Mapping[str, NDArray[Any]]], width: str | None = None, title: str = "",
                  prefix: str = "") -> Sheet | None:
    """The figure of replicas, each its arrays by their names, which begin with `prefix` ("/rods_2" of another species).
    Above: the density of rods with the director, about either defect; below: the flow. None where no run has the maps,
    or no defect was met."""
    needed = [prefix + name for name in ARRAYS]
    runs = [run for run in runs if all(name in run for name in needed)]
    runs = [run for run in runs if len(run[needed[0]]) == len(runs[0][needed[0]])]
    if not runs or not any(np.isfinite(run[f"{prefix}{GROUP}/{charge}/density"]).any() for run in runs
                           for charge in CHARGES):
        return None
    sheet = style.sheet(width or "183mm", 2, 2, title=title)
    limits = _limits(runs, prefix)
    drawn = [_panels(sheet, k, runs, prefix, charge, limits) for k, charge in enumerate(CHARGES)]
    sheet.colourbar(drawn[0][0], [sheet[0], sheet[1]], names.axis_title(f"{GROUP}/plus/density"))
    sheet.colourbar(drawn[0][1], [sheet[2], sheet[3]], names.axis_title(f"{GROUP}/plus/v_along_mm_s"))
    return sheet


def density_figure(runs: Sequence[Mapping[str, NDArray[Any]]], width: str | None = None, title: str = "",
                   prefix: str = "") -> Sheet | None:
    """The figure of the first of the replicas that has maps of the density: its first, middle and last one, and the
    mean over the steady state, in the same colours. None where none has."""
    for run in runs:
        time, x, y, maps, mean = (run.get(prefix + name, np.array([])) for name in DENSITY)
        n = min(len(time), len(maps) // max(1, len(x) * len(y)))  # a file that is still being written
        if n:
            break
    else:
        return None
    maps = maps[:n * len(x) * len(y)].reshape(n, len(y), len(x))
    shown = [(f"$t$ = {time[k]:.4g} s", maps[k]) for k in sorted({0, n // 2, n - 1})]
    if np.isfinite(mean).any():
        shown.append(("mean", mean.reshape(len(y), len(x))))
    sheet = style.sheet(width or "183mm", 1, len(shown), title=title).share_axes()
    seen = np.concatenate([values[np.isfinite(values)] for _, values in shown])
    drawn = None
    for panel, (name, values) in zip(sheet, shown):
        panel.titles(names.axis_title(DENSITY[1]), names.axis_title(DENSITY[2]), name)
        drawn = panel.map(x, y, values, names.axis_title(DENSITY[3]), bar=False,
                          limits=(float(seen.min()), float(max(seen.max(), seen.min() + 1e-9))))
    sheet.colourbar(drawn, None, names.axis_title(DENSITY[3]))
    return sheet


def map_figures(points: Sequence[tuple[str, Sequence[Mapping[str, NDArray[Any]]]]],
                width: str | None = None) -> Iterator[tuple[str, Sheet]]:
    """(name, figure) of each of the points, (label, replicas), that has maps: "defect_maps" and "density_maps", with a
    number behind where there are several."""
    for species in ("", "rods_2", "rods_3"):
        prefix, before = (f"/{species}", f"{species}_") if species else ("", "")
        for name, figure in (("defect_maps", defect_figure), ("density_maps", density_figure)):
            made = [figure(runs, width, label, prefix) for label, runs in points]
            sheets = [sheet for sheet in made if sheet is not None]
            for k, sheet in enumerate(sheets):
                yield before + name + (f"_{k + 1}" if len(sheets) > 1 else ""), sheet
