"""The noise with which D_r is as wanted. D_r grows with the noise, at most as its square; measured values scatter."""
import math
from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np

from .rods import Level, NotDiffusive, Unmet

#: Noise that is tried first, the least that is tried, and the largest that a scene may have [rad/mm].
FIRST, LEAST, MOST = 0.01, 1e-5, 10.0
#: How far the search goes by rough levels, of this relative error: until D_r is within this factor.
ROUGH, NEAR = 0.15, 1.4
#: The growth beyond what rods do without noise, as a power of the noise: what is thought of it, and how surely, before
#: levels tell; and what it is taken to be at least and at most.
POWER, POWER_ERROR, POWERS = 1.5, 0.7, (0.3, 3.0)
_MOST_LEVELS, _MOST_ROUNDS = 14, 5


class BelowOwn(Unmet):
    """D_r that rods exceed without any noise."""


@dataclass(frozen=True)
class Calibrated:
    """noise:  [rad/mm], of three digits; with it D_r was measured as `level` says
    error:  of the noise, from that of D_r and how far D_r is from what was wanted
    own:    the level without noise; None where rods do not diffuse without any
    is_met: whether D_r is as wanted within two standard errors or the precision asked for, and as well known
    """

    wanted: float
    noise: float
    error: float
    level: Level
    own: Level | None
    is_met: bool


def three_digits(noise: float) -> float:
    return float(f"{noise:.3g}")


def power_law(levels: Sequence[Level], own: float, near: float) -> tuple[float, float]:
    """ln(D_r - own) = a + p ln(noise): (a, p), by the errors of the levels, of which those count most whose
    ln(D_r - own) is near `near`."""
    above = [level for level in levels if level.d_r > own]
    if not above:
        raise Unmet("no noise that was tried gives a D_r that could be told from that without noise")
    x = np.log([level.noise for level in above])
    y = np.log([level.d_r - own for level in above])
    errors = np.array([max(level.error / (level.d_r - own), 1e-3) for level in above])
    weights = 1 / (errors**2 + 0.04 * (y - near)**2)  # no law holds far off
    middle = np.average(x, weights=weights)
    known = POWER_ERROR**-2
    p = (np.sum(weights * (x - middle) * y) + known * POWER) / (np.sum(weights * (x - middle)**2) + known)
    p = float(np.clip(p, *POWERS))
    return float(np.average(y, weights=weights) - p * middle), p


def noise_for(wanted: float, measure: Callable[[float, float], Level], precision: float,
              known: Sequence[Level] = ()) -> Calibrated:
    """The noise with which rods have D_r = `wanted` [rad^2/s] within the relative `precision`. `measure(noise,
    precision)` gives a level, or raises NotDiffusive; `known` are levels with noise of which it was asked before.

    Raises BelowOwn where rods without noise have as much or more, Unmet where none up to MOST gives as much.
    """
    own = _own(wanted, measure, precision)
    d_own = own.d_r if own is not None else 0.0
    aim = math.log(wanted - d_own)
    levels = {level.noise: level for level in known if level.noise > 0}

    def guess() -> float:
        a, p = power_law(list(levels.values()), d_own, aim)
        return math.exp((aim - a) / p)

    noise = FIRST if not any(level.d_r > d_own for level in levels.values()) else _within(levels, guess())
    for _ in range(_MOST_LEVELS):
        level = levels[noise] = measure(noise, ROUGH)
        added = level.d_r - d_own
        if added > 0 and abs(math.log(added) - aim) < math.log(NEAR):
            break
        if noise <= LEAST and added > math.exp(aim):
            raise BelowOwn(f"D_r = {wanted:.4g} rad^2/s is below what these rods have with next to no noise, "
                           f"{level.found.d_r} at {noise:g} rad/mm")
        if noise >= MOST and added < math.exp(aim):
            raise Unmet(f"D_r = {wanted:.4g} rad^2/s is more than the largest noise, {MOST:g} rad/mm, gives: "
                        f"{level.found.d_r}")
        if added > 2 * level.error:
            noise = _within(levels, guess())
        else:  # not to be told from what rods do without
            noise = min(4 * noise, MOST)

    best: Calibrated | None = None
    for _ in range(_MOST_ROUNDS):
        noise = three_digits(min(guess(), MOST))
        if best is not None and noise == best.noise:
            break
        level = levels[noise] = measure(noise, precision)
        _, p = power_law(list(levels.values()), d_own, aim)
        error = noise * math.hypot(level.error, level.d_r - wanted) / (p * (wanted - d_own))
        off, is_known = abs(level.d_r - wanted), level.error <= precision * level.d_r
        is_met = is_known and off <= max(2 * level.error, precision * wanted)
        found = Calibrated(wanted, noise, error, level, own, is_met)
        if best is None or abs(level.d_r - wanted) < abs(best.level.d_r - wanted):
            best = found
        if is_known and off <= 2 * level.error:
            break
    assert best is not None
    return best


def _own(wanted: float, measure: Callable[[float, float], Level], precision: float) -> Level | None:
    """The level without noise, known as well as it must be to say that `wanted` is above it."""
    try:
        own = measure(0.0, ROUGH)
        if wanted < 2 * own.d_r:
            own = measure(0.0, precision)
    except NotDiffusive:
        return None
    if wanted <= own.d_r + 2 * own.error:
        raise BelowOwn(f"D_r = {wanted:.4g} rad^2/s is not above what these rods have without any noise, "
                       f"{own.found.d_r}: noise only adds to that")
    return own


def _within(levels: dict[float, Level], noise: float) -> float:
    """A noise to try next, at most ten times farther than any tried."""
    return three_digits(min(max(noise, min(levels) / 10, LEAST), max(levels) * 10, MOST))
