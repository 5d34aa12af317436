# SPDX-License-Identifier: MIT
"""Numbers of a sweep against what was swept."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from . import names
from .series import VERSION, Arrangement, number_of
from .sheet import Sheet


@dataclass
class PlottedPoint:
    """A state point: its replicas together.

    x, y:  NaN where not known; x is that of the parameter where it is not said
    error: standard error of y; NaN where not known
    runs:  ids of what it is made of
    """

    parameters: Mapping[str, Any]
    y: float
    error: float = math.nan
    steady: bool | None = True
    x: float = math.nan
    version: str = ""
    runs: Sequence[str] = field(default_factory=tuple)


def longest_parameter(points: Sequence[PlottedPoint]) -> str:
    """The swept key with the most values that are numbers; empty if none has two."""
    values: dict[str, set[float]] = {}
    for point in points:
        for key, value in point.parameters.items():
            if math.isfinite(number_of(value)):
                values.setdefault(key, set()).add(number_of(value))
    several = {key: len(found) for key, found in values.items() if len(found) > 1}
    return max(several, key=lambda key: several[key]) if several else ""


def file_name(field_name: str) -> str:
    for part in ("measured.", ".value", ".mean"):
        field_name = field_name.replace(part, "", 1)
    return field_name.replace(".", "_")


def sweep_figure(points: Sequence[PlottedPoint], x: str = "", y: str = "order.mean",
                 width: str | None = None) -> tuple[str, Sheet] | None:
    """(name, figure): `y` against `x`, the longest swept parameter if left out. Other parameters, and versions, are
    told by colours and panels as Arrangement does. None where no parameter is swept, or no point has both."""
    path = x or longest_parameter(points)
    if not path:
        return None
    several_versions = len({point.version for point in points if point.version}) > 1
    groups: list[tuple[dict[str, Any], list[tuple[float, PlottedPoint]]]] = []
    for point in points:
        at = point.x if x and math.isfinite(point.x) else number_of(point.parameters.get(path))
        if not math.isfinite(at) or not math.isfinite(point.y):
            continue
        others = {key: value for key, value in point.parameters.items() if key != path}
        if several_versions and point.version:
            others[VERSION] = point.version
        group = next((found for known, found in groups if known == others), None)
        if group is None:
            group = []
            groups.append((others, group))
        group.append((at, point))
    if not groups:
        return None
    arrangement = Arrangement([others for others, _ in groups])
    sheet = arrangement.sheet(width, names.axis_title(path), names.axis_title(y))
    any_error = any(math.isfinite(point.error) for _, group in groups for _, point in group)
    for panel, k in arrangement.each(sheet):
        group = sorted(groups[k][1], key=lambda pair: pair[0])
        panel.curve([at for at, _ in group], [point.y for _, point in group],
                    [point.error for _, point in group] if any_error else None,
                    [point.steady for _, point in group], look="points", name=arrangement.label(k),
                    **arrangement.look(k))
    for panel, _ in arrangement.panels_of(sheet):
        if y == "order.mean":
            panel.range(y=(0, 1)).reference(y=0.5)
    return f"{file_name(y)}_{file_name(path)}", sheet
