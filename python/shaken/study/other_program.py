# SPDX-License-Identifier: MIT
"""What another program finds for the same rods: the table of `./dev validate other-program`."""
from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from ..estimate import Estimate
from .rules import SIGMAS, text


def tables(path: Path) -> str:
    """The numbers of the file that the command wrote, for each kind of rod; tables of Markdown."""
    cases = json.loads(path.read_text())
    return "\n".join(_table([case for case in cases if case["rods"] == rods])
                     for rods in dict.fromkeys(case["rods"] for case in cases))


def _table(cases: list[dict[str, Any]]) -> str:
    found = [{name: Estimate(*number) for name, number in case["numbers"].items()} for case in cases]
    soft = [(case["softness"], numbers) for case, numbers in zip(cases, found) if case["softness"]]
    ours, *others = found
    others.append({name: _limit([(x, numbers[name]) for x, numbers in soft if name in numbers]) for name in ours})
    titles = " | ".join([*(case["title"] for case in cases), "rigid, extrapolated"])
    lines = [f"| {cases[0]['rods']} | {titles} |", "|---" * (2 + len(others)) + "|"]
    known, beyond = [0] * len(others), [0] * len(others)
    for name, our in ours.items():
        cells = [text(our)]
        for k, number in enumerate(numbers.get(name, Estimate()) for numbers in others):
            apart = (number.value - our.value) / math.hypot(number.error, our.error)
            known[k] += number.is_known
            beyond[k] += abs(apart) > SIGMAS
            cells.append(f"{text(number)} ({apart:+.1f})".replace("-", "−") if number.is_known else "–")
        lines.append(f"| {name} | {' | '.join(cells)} |")
    lines.append("| beyond two errors | | " + " | ".join(map("{} of {}".format, beyond, known)) + " |")
    times = " | ".join(f"{case['seconds']:.0f}, {case['cpu_s'] / 3600:.2f}" for case in cases)
    return "\n".join([*lines, f"| simulated s, CPU-h | {times} | |"]) + "\n"


def _limit(points: list[tuple[float, Estimate]]) -> Estimate:
    """The value at 0 of the line through the points that weighs them by their errors; unknown of one point."""
    if len(points) < 2:
        return Estimate()
    where, values, errors = zip(*((x, number.value, number.error) for x, number in points))
    line, covariance = np.polyfit(where, values, 1, w=1 / np.array(errors), cov="unscaled")
    return Estimate(line[1], math.sqrt(covariance[1, 1]))
