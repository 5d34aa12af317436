"""Order against the size of the box, beside what the waves of the director in it predict.

In a nematic in two dimensions the director's waves alone make S fall as L^x, x = -1 / (pi sqrt(K1 K3)), K1 and K3
being the constants of splay and bend in units of the (effective) temperature, and G2 as r^(2x). Where x would be
steeper than -1/8 pairs of defects come apart and there is no order: sqrt(K1 K3) is at least 8/pi (Kosterlitz &
Thouless, J. Phys. C 6, 1181 (1973)). Where order is long-range x is 0 in large boxes.
"""
import math

import numpy as np

from ..estimate import Estimate, derived
from ..run import Run
from .evidence import PACKING, SIDE, Evidence, Runs, key_of, mean_of_places

#: sqrt(K1 K3) and x at the transition of Kosterlitz and Thouless.
LEAST_STIFFNESS, STEEPEST = 8 / math.pi, -1 / 8
#: Boxes from here on are judged [mm]: narrower ones have less than seven rods across.
WIDE = 33.0
#: Distances between which the power of G2 is read: from a rod's length on [mm], up to a part of the box, beyond which
#: the images of the box flatten it.
FROM, UP_TO = 5.0, 0.25


def boxes(evidence: Evidence) -> Runs:
    """Rods of 4.5 mm at the packings that are there in more than one box."""
    everything = evidence.joined("long-rods", "size", "dilute", "elasticity", "long-range").at(4.5)
    return Runs(run for run in everything if len(everything.at(packing=key_of(run, PACKING)).values(SIDE)) > 1)


def power(runs: Runs) -> Estimate:
    """x of S ~ L^x between the smallest and the largest box."""
    points = runs.points(SIDE, "S")
    if len(points) < 2:
        return Estimate(reason="one box only")
    (l0, small), (l1, large) = points[0], points[-1]
    scale = math.log(l1 / l0)
    return derived(math.log(large.value / small.value) / scale,
                   [(-1 / (small.value * scale), small), (1 / (large.value * scale), large)])


def stiffness(runs: Runs) -> Estimate:
    """sqrt(K1 K3) of the director's waves in these runs, in units of the effective temperature."""
    splay, bend = runs.number("frank_splay"), runs.number("frank_bend")
    if not (splay.is_known and bend.is_known):
        return Estimate(reason="too few rods for the noise level of the waves")
    value = math.sqrt(splay.value * bend.value)
    return derived(value, [(value / (2 * splay.value), splay), (value / (2 * bend.value), bend)])


def predicted(runs: Runs) -> Estimate:
    """x = -1 / (pi sqrt(K1 K3)), which the waves in these runs alone would make."""
    known = stiffness(runs)
    return derived(-1 / (math.pi * known.value), [(1 / (math.pi * known.value**2), known)]) if known.is_known else known


def half_power_of_g2(run: Run) -> Estimate:
    """Half the power of r with which G2 falls: x, if S and G2 fall by the same waves."""
    g2 = run["/g2/g2"]
    r, values, errors = np.asarray(g2.axis), np.asarray(g2), np.asarray(g2.error)
    far = (r >= FROM) & (r <= UP_TO * key_of(run, SIDE)) & (values > 0)
    if far.sum() < 3 or r[far][-1] < 1.5 * FROM:
        return Estimate(reason="the box is too narrow")
    x, weight = np.log(r[far]), (values[far] / errors[far]) ** 2
    away = x - np.average(x, weights=weight)
    slope = float(np.sum(weight * away * np.log(values[far])) / np.sum(weight * away**2))
    # as uncertain as if the errors at all distances went up and down together
    error = math.sqrt(float(np.mean((errors[far] / values[far]) ** 2))) / math.log(r[far][-1] / r[far][0])
    return Estimate(slope / 2, error / 2, mean_of_places(values[far], errors[far], run).steady)


def reading_of_g2(runs: Runs) -> Estimate:
    """Half the power of G2 in the largest box that knows it."""
    known = [found for side in runs.values(SIDE) if (found := runs.at(side=side).of(half_power_of_g2)).is_known]
    return known[-1] if known else Estimate(reason="the boxes are too narrow")
