"""Correlations in time at their longest lags.

A run gives a number such as D an error of its own only at lags of up to about a sixth of its length, over which six
independent stretches of it are compared. Here the same is read over the octave of lags that ends at half of the
measured time, and the replicas give the error: each run has two independent stretches of that length.
"""
import math
from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

from ..estimate import Estimate
from ..run import Run
from .evidence import Runs, number_of, place_on

#: The longest lag that is used, in measured times: a half, with room for the lags that runs have, such as 41 s of 80.
LONGEST = 0.52

Reading = Callable[[Run], Estimate]


def longest_lag(run: Run, name: str) -> float:
    """The end of the last octave of lags of a curve [s]; NaN where the run has none."""
    if name not in run:
        return math.nan
    lags = np.asarray(run[name].axis)
    measured = float(run.summary["sim_seconds"]) - float(run.summary.get("t_steady_s") or 0.0)
    inside = lags[lags <= LONGEST * measured]
    return float(inside[-1]) if len(inside) else math.nan


@dataclass(frozen=True)
class Octave:
    """A stretch of a curve from one lag to twice that one, both ends included."""

    lags: NDArray[Any]
    values: NDArray[Any]
    errors: NDArray[Any]

    @property
    def slope(self) -> float:
        return float((self.values[-1] - self.values[0]) / (self.lags[-1] - self.lags[0]))

    @property
    def slope_error(self) -> float:
        """Of a square displacement, whose steps are independent."""
        first, last = float(self.errors[0]), float(self.errors[-1])
        return math.sqrt(max(last**2 - first**2, first**2)) / float(self.lags[-1] - self.lags[0])


def octave(run: Run, name: str, end: float) -> Octave | None:
    """The octave of a curve that ends at a lag [s]; None where the curve does not have it."""
    if name not in run:
        return None
    curve = run[name]
    lags, values = np.asarray(curve.axis), np.asarray(curve)
    first, last = place_on(lags, end / 2), place_on(lags, end)
    if first is None or last is None or end > lags[-1] * 1.01:
        return None
    chosen = slice(first, last + 1)
    if not lags[first] > 0 or abs(lags[first] / lags[last] - 0.5) > 0.1 or not np.isfinite(values[chosen]).all():
        return None
    return Octave(lags[chosen], values[chosen], np.asarray(curve.error)[chosen])


def _reading(name: str, octaves: int, of: Callable[..., float]) -> Reading:
    """A number that is made of the last octaves of a curve, the last one first. It has no error of its own."""
    def read(run: Run) -> Estimate:
        end = longest_lag(run, name)
        found = [octave(run, name, end / 2**back) for back in range(octaves)]
        if any(one is None for one in found):
            return Estimate(reason="no long lags")
        return Estimate(of(*found), steady=number_of(run, "S").steady)

    return read


def diffusion_at(direction: str, lag: Callable[[Run, str], float] = longest_lag) -> Reading:
    """D [mm2/s] from the slope of the MSD over the octave that ends at a lag: a quarter of it in the plane ("total"),
    half of it "along" or "across" the director."""
    name, dimensions = f"/msd/{direction}_mm2", 2 if direction == "total" else 1

    def read(run: Run) -> Estimate:
        found = octave(run, name, lag(run, name))
        if found is None:
            return Estimate(reason="no lags as long")
        return Estimate(found.slope / (2 * dimensions), found.slope_error / (2 * dimensions),
                        number_of(run, "diffusion_mm2_s").steady)

    return read


def change_of_slope(name: str) -> Reading:
    """The slope of a curve over the last octave divided by that over the octave before: 1 of an MSD where D is a
    constant, whatever came before; t^a has 2^(a - 1)."""
    return _reading(name, 2, lambda last, before: last.slope / before.slope)


def exponent(name: str) -> Reading:
    """That of a curve between the ends of the last octave."""
    def of(last: Octave) -> float:
        risen = last.values[-1] / last.values[0]
        return math.log(risen) / math.log(last.lags[-1] / last.lags[0]) if risen > 0 else 0.0

    return _reading(name, 1, of)


def level(name: str) -> Reading:
    """The mean of a curve over the last octave."""
    return _reading(name, 1, lambda last: float(last.values.mean()))


def change_of_level(name: str) -> Reading:
    """The mean of a curve over the last octave less that over the octave before."""
    return _reading(name, 2, lambda last, before: float(last.values.mean() - before.values.mean()))


def best(runs: Runs, late: Reading, own: str) -> Estimate:
    """The mean of a late reading over replicas; where these are too few for an error that of the number `own`, which
    the runs give at shorter lags."""
    found = runs.of(late)
    return found if math.isfinite(found.error) else runs.number(own)


def long_time_diffusion(runs: Runs, direction: str = "total") -> Estimate:
    """D [mm2/s] over the longest lags of these runs, in the plane or in one direction."""
    own = "diffusion_mm2_s" if direction == "total" else f"diffusion_{direction}_mm2_s"
    return best(runs, diffusion_at(direction), own)
