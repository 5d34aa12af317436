"""The rotational diffusion coefficient D_r from mean square angular displacements (MSAD) of independent runs.

A rod whose angular velocity is forgotten after the time tau turns ballistically at first; its MSAD is then
2 D_r (t - tau (1 - exp(-t / tau))) (Uhlenbeck & Ornstein, Phys. Rev. 36, 823 (1930), of a velocity). A straight line
through long lags has the slope 2 D_r and meets zero at the lag tau.
"""
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..estimate import Estimate, student_factor

#: A window of lags reaches from its shortest lag to so many times that.
OCTAVES = 4.0
#: Its shortest lag is at least so many times the memory tau: what is left of the memory there, exp(-4), makes the slope
#: less than 1 % too small.
MEMORIES = 4.0
#: Slopes of windows at longer lags must agree with it within this part, or within so many standard errors; the longest
#: lags are at least so many times those of the window.
AGREE, ERRORS, BEYOND = 0.1, 2.0, 4.0


@dataclass(frozen=True)
class Diffusion:
    """d_r: [rad^2/s], its error from the scatter of runs
    lag_from, lag_to: window of lags of the line [s]
    memory: lag at which that line meets zero [s]
    """

    d_r: Estimate
    lag_from: float
    lag_to: float
    memory: float


def _line(lag: NDArray[Any], msad: NDArray[Any]) -> NDArray[Any]:
    """(intercept, slope) of each row of `msad` (runs, lags). The error of a MSAD is nearly a fixed part of the lag."""
    design = np.stack([np.ones_like(lag), lag])
    weighted = design / lag**2
    return np.linalg.solve(weighted @ design.T, weighted @ msad.T).T


def _windows(lag: NDArray[Any], longest: float) -> list[NDArray[Any]]:
    """The numbers of the lags in each window that ends by `longest`."""
    found = [np.flatnonzero((lag >= first * (1 - 1e-9)) & (lag <= OCTAVES * first * (1 + 1e-9))) for first in lag
             if OCTAVES * first <= longest * (1 + 1e-9)]
    return [window for window in found if window.size >= 3]


def diffusion(lag: NDArray[Any], msad: NDArray[Any], longest: float) -> Diffusion | None:
    """D_r of independent runs, at least two: `lag` (lags) [s], `msad` (runs, lags) [rad^2]. None where no window of
    lags up to `longest` [s] is diffusive. The window is the one at the shortest lags whose line meets zero at a quarter
    of its shortest lag or before (MEMORIES), and with whose slope all windows at longer lags agree, up to lags at least
    four times as long (BEYOND)."""
    windows = _windows(lag, longest)
    slopes = [_line(lag[window], msad[:, window])[:, 1] for window in windows]
    n = len(msad)

    def error(values: NDArray[Any]) -> float:
        return student_factor(n) * float(np.std(values, ddof=1)) / math.sqrt(n)

    def agrees(slope: NDArray[Any], later: NDArray[Any]) -> bool:
        apart = later - slope
        return abs(apart.mean()) <= max(AGREE * slope.mean(), ERRORS * error(apart))

    for k, (window, slope) in enumerate(zip(windows, slopes)):
        intercept, mean_slope = _line(lag[window], msad[:, window].mean(axis=0, keepdims=True))[0]
        if not mean_slope > 0 or MEMORIES * abs(intercept) > mean_slope * lag[window[0]]:
            continue
        if BEYOND * lag[window[-1]] > longest:
            break
        if all(agrees(slope, later) for later in slopes[k + 1:]):
            return Diffusion(Estimate(value=float(slope.mean()) / 2, error=error(slope) / 2, steady=True,
                                      unit="rad2 s-1"),
                             float(lag[window[0]]), float(lag[window[-1]]), float(-intercept / mean_slope))
    return None


def exponent(lag: NDArray[Any], msad: NDArray[Any], longest: float) -> float:
    """d ln MSAD / d ln t over the last two octaves up to `longest` [s]: 2 of rods that keep turning, 1 of diffusion."""
    mean = msad.mean(axis=0)
    shown = (lag <= longest * (1 + 1e-9)) & (lag * OCTAVES >= longest) & (mean > 0)
    return float(np.polyfit(np.log(lag[shown]), np.log(mean[shown]), 1)[0]) if shown.sum() > 1 else math.nan
