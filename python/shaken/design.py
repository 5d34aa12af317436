"""Points that fill a space of keys, as the entries of a sweep's "list"."""
import math
from typing import Any, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .errors import ShakenError

METHODS = ("random", "latin", "sobol")


def entries(n: int, intervals: Mapping[str, Sequence[Any]], method: str = "sobol",
            seed: int = 1) -> list[dict[str, Any]]:
    """n points spread over the intervals of some keys: {"sweep": {"list": entries(...)}}.

    intervals: {"rods.length": (2.5, 4.5), "contacts.rod_rod.friction": (0.001, 1, "log")}, in the scene's units. Where
               both ends are int the values are whole numbers, on a linear scale each with the same share; others are
               rounded to 9 digits. "log" spreads the logarithms evenly.
    method:    "random": independent of each other; "latin": of n equal parts of each interval each holds one point
               (McKay, Beckman & Conover 1979); "sobol": Sobol's sequence, scrambled (Owen 1998), even in all keys
               together, best with n = 16, 32, 64, ... More random or Sobol points begin with the fewer ones.
    seed:      equal seeds give equal points

    Raises ShakenError with all that is wrong.
    """
    problems = [] if method in METHODS else [f"method is one of {', '.join(METHODS)}, not {method!r}"]
    problems += [] if n >= 1 else [f"n is the number of points, not {n}"]
    problems += [] if intervals else ["no key has an interval"]
    for path, (low, high, *scale) in intervals.items():
        if not low < high:
            problems.append(f"{path}: an interval is (from, to) with from < to, not ({low}, {high})")
        elif scale not in ([], ["log"]) or (scale and low <= 0):
            problems.append(f"{path}: the third is \"log\", of an interval above 0")
    if problems:
        raise ShakenError("\n".join(problems))
    shares = _shares(n, len(intervals), method, seed)
    return [{path: _value(share, *interval) for share, (path, interval) in zip(point, intervals.items())}
            for point in shares]


def _shares(n: int, dimensions: int, method: str, seed: int) -> NDArray[Any]:
    """Points in the unit cube (n, dimensions)."""
    from scipy.stats import qmc
    if method == "random":
        return np.random.default_rng(seed).random((n, dimensions))
    if method == "latin":
        return qmc.LatinHypercube(dimensions, seed=seed).random(n)
    whole = 1 << max(n - 1, 0).bit_length()  # of a power of two, of which scipy warns otherwise
    return qmc.Sobol(dimensions, scramble=True, seed=seed).random(whole)[:n]


def _value(share: float, low: Any, high: Any, scale: str = "linear") -> int | float:
    """What lies at that share of an interval. A whole number stands for the interval up to the next one."""
    whole = isinstance(low, int) and isinstance(high, int)
    end = high + 1 if whole else high
    value = low * (end / low) ** share if scale == "log" else low + (end - low) * share
    kept = math.floor(value) if whole else float(f"{value:.9g}")
    return min(max(kept, low), high)
