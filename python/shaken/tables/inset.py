# SPDX-License-Identifier: MIT
"""What the inset `sweep` of pictures shows: S over a sweep, and where some of its jobs are."""
from __future__ import annotations

import argparse
import json
import math

from ..daemon import Daemon
from ..errors import ShakenError
from .rows import Row, aggregated, axes_of, target_of


def inset(options: argparse.Namespace) -> None:
    """Prints {x, y, points: [[x, y, S]], here: [[x, y]]} by the first two numbers that are swept, for shaken-render; y
    is empty where there is one, and null what is not known."""
    rows = target_of(Daemon(options.root), options.id).rows
    axes = axes_of(rows)

    def place(row: Row, *more: str) -> list[float | None]:
        found = [row.number(name) for name in (*axes, *more)]
        known = [value if math.isfinite(value) else None for value in found]
        return known if len(axes) > 1 else [known[0], None, *known[1:]]

    of_jobs = {row.fields["job"]: row for row in rows}
    foreign = [job[:8] for job in options.job if job not in of_jobs]
    if foreign:
        raise ShakenError(f"job {foreign[0]} does not belong to sweep {options.id}")
    print(json.dumps({"x": axes[0], "y": axes[1] if len(axes) > 1 else "",
                      "points": [place(point, "order.mean") for point in aggregated(rows)],
                      "here": [place(of_jobs[job]) for job in options.job]}))
