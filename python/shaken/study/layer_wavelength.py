"""The wavelength of the layers, from the spectrum of the director across itself."""
import functools
import math
from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from ..estimate import Estimate
from ..run import Run
from .evidence import Runs, box_of, number_of

#: P(0) over the maximum of P(theta): below it there are two peaks, above it there is one.
TWO_PEAKS = 0.95
#: A box that is wider than this across the director [mm] has steps of the wave number that are small beside the peak of
#: the layers.
WIDE = 96.0
#: Standard deviation of the peak of the layers, in ln q: the least and the most that it can be.
PEAK_WIDTHS = (0.1, 0.35)
#: By how much a peak must raise the logarithm of the likelihood: of spectra without one three in a hundred do so.
LEAST_GAIN = 4.0
#: What a width of the peak near an end of those does to its place [mm].
OF_THE_WIDTH = 1.0
#: Waves that are looked at [mm], and those that layers can have.
WAVES, OF_LAYERS = (5.0, 63.0), (8.0, 32.0)


def expected_power(q: NDArray[Any], floor: float, bending: float, layers: float, peak: float,
                   width: float) -> NDArray[Any]:
    """The spectrum of a layered nematic: `floor` of single rods, `bending` / q^2 of the director's own waves, and a
    peak of height `layers` and standard deviation `width` (in ln q) at the wave number `peak`."""
    return floor + bending / q**2 + layers * np.exp(-(np.log(q / peak) / width) ** 2 / 2)


def _width(logit: float) -> float:
    """A width between the least and the most, of any number."""
    low, high = PEAK_WIDTHS
    return low + (high - low) / (1 + math.exp(-min(max(logit, -30), 30)))


def peak_of(q: NDArray[Any], power: NDArray[Any]) -> float:
    """The wavelength of the peak in a spectrum [in 2 pi / q]; NaN where there is none.

    The powers scatter about what is expected as those of a Gaussian field do, each by as much as it is itself, and the
    fit is the one that is likeliest then: Whittle, *Arkiv foer Matematik* **2**, 423 (1953). The highest wave would be
    chance, and the mean over a band is pulled to its middle by the waves that are none of the layers.
    """
    wave = 2 * math.pi / q
    chosen = (wave > WAVES[0]) & (wave < WAVES[1]) & (power > 0)
    q, wave, power = q[chosen], wave[chosen], power[chosen] / np.median(power[chosen])

    def expected(fitted: NDArray[Any]) -> NDArray[Any]:
        floor, bending, layers, peak = np.exp(np.minimum(np.maximum(fitted[:4], -30), 30))
        return expected_power(q, floor, bending, layers, peak, _width(fitted[4]))

    def best(start: Sequence[float], model: Callable[[NDArray[Any]], NDArray[Any]]) -> tuple[float, NDArray[Any]]:
        def unlikeliness(fitted: NDArray[Any]) -> float:
            expected = model(fitted)
            return float(np.sum(np.log(expected) + power / expected))

        fit = minimize(unlikeliness, start, method="Nelder-Mead",
                       options={"maxiter": 4000, "xatol": 1e-4, "fatol": 1e-4})
        return float(fit.fun), fit.x

    low, high = np.percentile(power, 10), power[np.argmax(wave)]
    plain = [math.log(low), math.log(max(high - low, 0.1 * low) * (2 * math.pi / 30) ** 2)]
    without, _ = best(plain, lambda fitted: expected(np.array([*fitted, -30.0, 0.0, 0.0])))
    fits = [best([*plain, math.log(power.max() / 2), math.log(2 * math.pi / start), 0.0], expected)
            for start in (10.0, 12.5, 16.0, 20.0, 25.0)]
    found = [(unlikely, 2 * math.pi / math.exp(min(max(fitted[3], -30), 30))) for unlikely, fitted in fits
             if without - unlikely > LEAST_GAIN]
    inside = [(unlikely, peak) for unlikely, peak in found if OF_LAYERS[0] < peak < OF_LAYERS[1]]
    return min(inside)[1] if inside else math.nan


@functools.lru_cache(maxsize=1024)
def _cached_peak(_id: str, q: bytes, power: bytes) -> float:
    return peak_of(np.frombuffer(q), np.frombuffer(power))


def _is_wide(run: Run) -> bool:
    return box_of(run)[1] > WIDE and "/layers/spectrum_across" in run


def wavelength(run: Run) -> Estimate:
    """The wavelength of the layers [mm] of a run that has two peaks in P(theta).

    In a box that is much wider than they are it is that of the peak in the spectrum, and its error is left to the
    replicas. In a narrower box it is that of the highest wave and its neighbours, as the run has it.
    """
    found = number_of(run, "wavelength_mm")
    if not found.is_known:
        return found
    if not number_of(run, "dip").value < TWO_PEAKS:
        return Estimate(reason="no second peak")
    if not _is_wide(run):
        return found
    spectrum = [np.ascontiguousarray(run[f"/layers/{name}"], dtype=float).tobytes()
                for name in ("q_per_mm", "spectrum_across")]
    peak = _cached_peak(run.id, *spectrum)
    return Estimate(peak, steady=number_of(run, "S").steady, reason="" if math.isfinite(peak) else "no peak")


def mean_wavelength(runs: Runs) -> Estimate:
    """The wavelength of the layers [mm] of the runs of a state point.

    The waves that fit into a box are L/n, L being its side across the rods, so that in a narrow one what lies between
    two of them is not seen: a uniform error over that step is added to that of the mean, for the replicas share it. In
    a wide one it is what an unlucky width of the peak does to the fit.
    """
    found = runs.of(wavelength)
    if not found.is_known:
        return found
    if all(_is_wide(run) for run in runs):
        return found.with_further_error(OF_THE_WIDTH)
    _, across = box_of(runs[0])
    n = max(round(across / found.value), 1)
    step = across / max(n - 0.5, 0.5) - across / (n + 0.5)
    return found.with_further_error(step / math.sqrt(12))
