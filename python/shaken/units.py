# SPDX-License-Identifier: MIT
"""Units as Shaken's names carry them: `diffusion_mm2_s` is in mm2 s-1, `q_per_mm` in mm-1."""
from __future__ import annotations

import re

_UNIT = re.compile(r"(mm|s|rad|deg|mg|pJ|Hz)([0-9]?)$")


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
    n = len(words)
    while n > 1 and _UNIT.match(words[n - 1]):
        n -= 1
    if n > 1 and n < len(words) and words[n - 1] == "per":
        n -= 1
    return "_".join(words[:n]), "_".join(words[n:])


def unit_of(name: str) -> str:
    """The unit that a name ends in, as the attribute `unit` of a data set has it: "mm2 s-1"; "1" for a plain number.
    `name` may be a path, "/msd/total_sem_mm2".
    """
    words = split_unit(name.rsplit("/", 1)[-1])[1].split("_")
    per = words[0] == "per"
    units = [(match[1], int(match[2] or 1)) for word in words if (match := _UNIT.match(word))]
    return " ".join(_power(unit, -power if per or k > 0 else power) for k, (unit, power) in enumerate(units)) or "1"


def _power(unit: str, power: int) -> str:
    return unit if power == 1 else f"{unit}{power}"
