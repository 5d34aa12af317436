"""Units as Shaken's names carry them (`diffusion_mm2_s` is in mm2 s-1, `q_per_mm` in mm-1), and as quantities of scenes
and command lines have them: "0.1 s", "20 ms", "2.5mm"."""
import math
import re
from decimal import Decimal
from typing import Any

from .catalogue import SUMMARY, SYMBOLS, UNITS
from .errors import ShakenError, nearest

_UNIT = re.compile(f"({'|'.join(SYMBOLS)})([0-9]?)$")
_OF_VALUE = re.compile(r"\.(value|sem)$")
_SPECIES = re.compile(r"^/?(rods_[0-9]+)(?=[./])")


def split_species(name: str) -> tuple[str, str]:
    """Of what is found of another species than the first, its name and the rest: ("rods_2", "/msd/lag_s") of
    "/rods_2/msd/lag_s", ("rods_2", "S") of "rods_2.S"; ("", name) of all else."""
    found = _SPECIES.match(name)
    return (found[1], name[found.end():].removeprefix(".")) if found else ("", name)


def split_unit(name: str) -> tuple[str, str]:
    """The name without its unit, and the words of the unit: ("d_total", "mm2_s") of "d_total_mm2_s", ("g2", "") of
    "g2"."""
    words = name.split("_")

    def units_before(n: int) -> int:
        while n > 1 and _UNIT.match(words[n - 1]):
            n -= 1
        return n

    n = units_before(len(words))
    if 1 < n < len(words) and words[n - 1] == "per":
        n = units_before(n - 1)
    return "_".join(words[:n]), "_".join(words[n:])


def unit_of(name: str) -> str:
    """The unit that a name ends in, as the attribute `unit` of a data set has it: "mm2 s-1"; "1" for a plain number.
    `name` may be a path, "/msd/total_sem_mm2", or one of a summary, "cpu_seconds", "measured.theta_m_deg.value".
    """
    if "unit" in SUMMARY.get(name, {}):
        return str(SUMMARY[name]["unit"])
    words = split_unit(_OF_VALUE.sub("", name.rsplit("/", 1)[-1]))[1].split("_")
    per = words[0] == "per"
    units = [(match[1], int(match[2] or 1)) for word in words if (match := _UNIT.match(word))]
    powers = [(unit, -power if per or k > 0 else power) for k, (unit, power) in enumerate(units)]
    return " ".join(unit if power == 1 else f"{unit}{power}" for unit, power in powers) or "1"


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


def leading_number(value: Any) -> float:
    """A number, or the one at the beginning of a text ("4.5 mm"); NaN if there is none."""
    if isinstance(value, str):
        match = NUMBER.match(value)
        return float(match[0]) if match else math.nan
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else math.nan


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
    of = UNITS[unit]["of"] if unit in UNITS else ""
    if of == dimension:
        # 4.1 us is what a scene with 4.1e-6 s has
        return float(Decimal(match[1]) * Decimal(repr(UNITS[unit]["scale"])))
    if dimension == "plain number":
        raise ShakenError(f'"{unit}": a plain number takes no unit')
    if decimals := re.match(r",(\d+)", unit):
        raise ShakenError(f'"{text}": a decimal comma; write {match[1]}.{decimals[1]}')
    use = [name for name, row in UNITS.items() if row["of"] == dimension and name.isascii()]
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
