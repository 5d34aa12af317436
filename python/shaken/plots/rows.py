# SPDX-License-Identifier: MIT
"""Rows of a report of shaken-bench: the numbers in them, and those that belong together."""
from __future__ import annotations

import json
import math
from typing import Any, Mapping, Sequence

import numpy as np

Row = Mapping[str, Any]


def number(row: Any, path: str) -> float:
    """The number at "scheduled/spread" in a row; NaN if there is none."""
    for part in path.split("/"):
        row = row.get(part) if isinstance(row, Mapping) else None
    return float(row) if isinstance(row, (int, float)) and not isinstance(row, bool) else math.nan


def column(rows: Sequence[Row], path: str, factor: float = 1.0) -> np.ndarray:
    return factor * np.array([number(row, path) for row in rows])


def series_of(rows: Sequence[Row], *members: str) -> list[list[Row]]:
    """Rows that are alike in some members, as one list each, in the order in which these begin."""
    series: dict[str, list[Row]] = {}
    for row in rows:
        series.setdefault(json.dumps([row.get(member) for member in members]), []).append(row)
    return list(series.values())


def like(rows: Sequence[Row], row: Row, *members: str) -> Row | None:
    """The one of the rows that is like `row` in these members."""
    return next((other for other in rows if all(other.get(m) == row.get(m) for m in members)), None)
