# SPDX-License-Identifier: MIT
"""Quantities as scenes and command lines have them: "0.1 s", "20 ms", "2.5mm"."""
from __future__ import annotations

import math
import re
from decimal import Decimal
from typing import Any

from .catalogue import UNITS
from .errors import ShakenError, nearest

#: Times of people and of their computers, too.
_SECONDS = {**{unit: row["scale"] for unit, row in UNITS.items() if row["of"] == "time"}, "d": 86400.0}
NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)", re.ASCII)
_QUANTITY = re.compile(NUMBER.pattern + r"\s*(\S*)\s*", re.ASCII)


def unit_in(value: Any) -> str:
    """The unit in a text of a quantity; "" where there is none."""
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    return match[2] if match and match[2] in UNITS else ""


def number_of(value: Any) -> Any:
    """A number, or a text of one with or without a unit, as a number in the default unit; all else as it is."""
    if not isinstance(value, str):
        return value
    match = _QUANTITY.fullmatch(value)
    if not match or (match[2] and match[2] not in UNITS):
        return value
    return float(match[1]) * (UNITS[match[2]]["scale"] if match[2] else 1.0)


def quantity(text: str, dimension: str) -> float:
    """A text of a number in the default unit of what it measures: "length", "time", ..., or "plain number", which takes
    no unit. Raises ShakenError with what is wrong with it."""
    match = _QUANTITY.fullmatch(text)
    if not match:
        raise ShakenError(f'"{text}" is not a number')
    unit = match[2]
    if math.isinf(float(match[1])):
        raise ShakenError(f"{match[1]} is too large")
    if not unit:
        return float(match[1])
    if unit in UNITS and UNITS[unit]["of"] == dimension:
        # 4.1 us is what a scene with 4.1e-6 s has
        return float(Decimal(match[1]) * Decimal(repr(UNITS[unit]["scale"])))
    if dimension == "plain number":
        raise ShakenError(f'"{unit}": a plain number takes no unit')
    if decimals := re.match(r",(\d+)", unit):
        raise ShakenError(f'"{text}": a decimal comma; write {match[1]}.{decimals[1]}')
    use = [name for name, row in UNITS.items() if row["of"] == dimension and name.isascii()]
    of = UNITS[unit]["of"] if unit in UNITS else ""
    other = f"a unit of {of}, not of {dimension}" if of else f"not a unit of {dimension}"
    raise ShakenError(f'"{unit}" is {other}; use {", ".join(use)}{"" if unit in UNITS else nearest(unit, use)}')


def seconds(time: float | str) -> float:
    """A time [s] given as a number of seconds, or as a text with its unit (us, ms, s, min, h, d)."""
    if not isinstance(time, str):
        return float(time)
    match = _QUANTITY.fullmatch(time)
    if not match or (match[2] and match[2] not in _SECONDS):
        raise ShakenError(f"'{time}' is no time: write a number and a unit, as in \"0.1 s\" (us, ms, s, min, h, d)")
    return float(match[1]) * _SECONDS[match[2] or "s"]
