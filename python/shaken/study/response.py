"""Linear response: rods that a constant force pulls along the plates, and how they wander without it.

Plates that are inclined by alpha pull at every rod with m g sin(alpha). In a steady state all rods drift at v, so that
they lose their momentum within tau = v / (g sin(alpha)), and their mobility is tau / m. The same loss keeps the centre
of mass of N rods wandering with a diffusion constant D_c. In equilibrium Einstein's relation has N D_c m / tau = T.
"""
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..estimate import Estimate, mean_of_samples
from ..run import Run
from .evidence import Runs, key_of, number_of

#: Lags between which the wandering of the centre of mass is read [s]: long against tau, so that it is diffusion.
LAGS = (1.0, 2.0)


def slope(run: Run) -> float:
    """Direction down the slope, in degrees to the x axis."""
    angle = key_of(run, "plates.inclination_angle")
    return angle if math.isfinite(angle) else 0.0


def pull(run: Run) -> float:
    """The acceleration g sin(alpha) of a rod that nothing else acts on [mm/s2]."""
    return key_of(run, "gravity") * math.sin(math.radians(key_of(run, "plates.inclination")))


def _components(degrees: float) -> tuple[float, float]:
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def damping_time(run: Run) -> Estimate:
    """tau [s], from the mean velocity of all rods down the slope."""
    c, s = _components(slope(run))
    return (number_of(run, "drift_x_mm_s") * c + number_of(run, "drift_y_mm_s") * s) / pull(run)


def _way(run: Run, degrees: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Times [s] from the steady state on, and the way of the centre of mass in a direction [mm]."""
    time = np.asarray(run["/drift/x_mm"].axis)
    c, s = _components(degrees)
    way = np.asarray(run["/drift/x_mm"]) * c + np.asarray(run["/drift/y_mm"]) * s
    late = time >= float(run.summary.get("t_steady_s") or 0.0)
    return time[late], way[late]


def later_over_earlier(run: Run) -> Estimate:
    """The velocity down the slope over the later half of the time, over that of the earlier half."""
    _, way = _way(run, slope(run))
    middle = len(way) // 2
    return Estimate((way[-1] - way[-1 - middle]) / (way[middle] - way[0]), steady=True)


def wandering(run: Run) -> Estimate:
    """N D_c [mm2/s] across the slope, where nothing pulls: half the slope of the mean square way about the mean
    velocity, over `LAGS`. The error is from ten stretches of the time."""
    time, way = _way(run, slope(run) + 90)
    total = time[-1] - time[0]
    if total < 10 * LAGS[1]:
        return Estimate(reason="too short")
    velocity, step = (way[-1] - way[0]) / total, total / (len(way) - 1)
    short, long_ = (round(lag / step) for lag in LAGS)

    def square(steps: int) -> NDArray[Any]:
        return (way[steps:] - way[:-steps] - velocity * steps * step) ** 2

    # the mean velocity is that of the same way, which takes lag / total of each square
    expected = 2 * step * (long_ * (1 - long_ * step / total) - short * (1 - short * step / total))
    parts = [run.summary["n_rods"] * part.mean() / expected
             for part in np.array_split(square(long_) - square(short)[:len(way) - long_], 10)]
    value, error = mean_of_samples(parts)
    return Estimate(value, error, True)


def kinetic(run: Run) -> Estimate:
    """T / m in the plane [mm2/s2]: half the mean square velocity about the drift."""
    rms = number_of(run, "speed_rms_mm_s")
    drift = math.hypot(number_of(run, "drift_x_mm_s").value, number_of(run, "drift_y_mm_s").value)
    return Estimate((rms.value**2 - drift**2) / 2, rms.value * rms.error, rms.steady)


def directions(runs: Runs) -> list[float]:
    """The directions down the slope of these runs, rising [degrees]."""
    return sorted({slope(run) for run in runs})


def pulled(runs: Runs, degrees: float) -> Runs:
    return Runs(run for run in runs if slope(run) == degrees)
