"""The sets of runs of the study: their sweeps, in order of worth, at three scales."""
import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator

from ..errors import ShakenError
from ..units import leading_number

#: Every set, those first that decide most for their price. The letters are those of docs/validation.md.
ORDER: tuple[tuple[str, str], ...] = (
    ("A", "long-rods"), ("B", "dilute"), ("G", "layers"), ("C", "mechanism"), ("D", "shaking"), ("E", "crossings"),
    ("F", "size"), ("H", "gaps"), ("J", "diffusion-along"), ("AA", "strip"), ("I", "layer-trends"), ("K", "short-rods"),
    ("Q", "long-range"), ("M", "larger-box"), ("S", "turned"), ("AB", "fluid-start"), ("U", "frequency"),
    ("V", "phases"), ("X", "beads"), ("R", "elasticity"), ("L", "no-order"), ("W", "density"), ("T", "diffusion"),
    ("AC", "taper"), ("AD", "response"), ("AE", "neighbours"), ("AF", "short-step"), ("AG", "inertia"),
    ("AH", "forgetting"), ("AI", "defect-flow"), ("Y", "equilibrium"), ("Z", "movies"))

#: Side [mm] of the boxes of those sets that give a number of rods in place of a side.
SIDE_OF_COUNTS = 41.865


@dataclass(frozen=True)
class Scale:
    """What is done to the sweeps, which are written for a desk, at another scale.

    accuracy: of all points but the controls, which are left out where it is the paper's
    side:     factor on the sides of the boxes; no side becomes less than `least_side` [mm], and no box smaller than a
              square of side `least_square` [mm]
    time:     factor on all times; replicas: the most of a point
    """

    name: str
    accuracy: str
    side: float = 1.0
    least_side: float = 0.0
    least_square: float = 0.0
    time: float = 1.0
    replicas: int = 1000


SCALES = {scale.name: scale for scale in (
    Scale("tiny", "draft", side=0.3, least_side=16.5, time=0.01, replicas=2),  # minutes: to see that all is there
    Scale("desk", "desk"),  # some 50 hours of one core: what decides the statements
    Scale("paper", "paper", side=2.0, least_square=83.73, time=3.0))}  # the paper's box, times and step: a cluster's


def sweep_file(folder: Path, name: str) -> dict[str, Any]:
    """The sweep of a set, as configs/figures/desk/NAME.json has it."""
    path = folder / f"{name}.json"
    try:
        text = re.sub(r"^\s*//.*$", "", path.read_text(), flags=re.M)
        return json.loads(text)
    except (OSError, ValueError) as error:
        raise ShakenError(f"{path}: {error}") from None


def scaled(sweep: dict[str, Any], scale: Scale) -> dict[str, Any]:
    """The sweep at another scale, with its name."""
    if scale.name == "desk":
        return sweep
    found = json.loads(json.dumps(sweep))
    found["name"] = found["name"].rpartition("-")[0] + "-" + scale.name
    scene = found["scene"]
    box = scene.get("box", {})
    aspect, side = box.get("aspect", 1.0), box.get("side", SIDE_OF_COUNTS)
    area = (leading_number(_side(side, scale, aspect)) / leading_number(side)) ** 2
    for block, of_scene in (("box.", box), ("time.", scene.get("time", {})), ("", scene)):
        for key in ("side", "steady", "measure", "accuracy"):
            if key in of_scene:
                of_scene[key] = _scaled_values(block + key, [of_scene[key]], scale, aspect, area)[0]
    if scale.name == "tiny" and "movie" in scene:
        scene["trajectory"]["every"] = scene["movie"]["every"] = "20 ms"
    parts = []
    for part in found["sweep"]:
        if part["grid"].get("accuracy") == ["paper"]:
            continue  # the controls
        for factor in (part["grid"], part.get("zip", {}), *part.get("stages", [])):
            for key, values in factor.items():
                factor[key] = _scaled_values(key, values, scale, aspect, area)
            if "box.side" in factor and factor is part["grid"]:
                factor["box.side"] = list(dict.fromkeys(factor["box.side"]))
        if "replicas" in part:
            part["replicas"] = min(part["replicas"], scale.replicas)
        parts.append(part)
    found["sweep"] = parts
    return found


def _scaled_values(key: str, values: list[Any] | str, scale: Scale, aspect: float, area: float) -> list[Any] | str:
    """The values of a swept key at another scale, at which the boxes have `area` times their area."""
    if isinstance(values, str):
        return values  # a range
    if key == "accuracy":
        return [scale.accuracy]
    if key == "box.side":
        return [None if value is None else _side(value, scale, aspect) for value in values]
    if key in ("time.steady", "time.measure"):
        return [f"{leading_number(value) * scale.time:g} s" for value in values]
    if key == "time.seed":
        return values[:scale.replicas]
    return [round(value * area) for value in values] if key == "rods.count" else values


def _side(value: str | float, scale: Scale, aspect: float) -> str:
    """The side along x of a box whose other side is `aspect` times as long."""
    least = max(scale.least_side, scale.least_square / math.sqrt(aspect))
    return f"{max(leading_number(value) * scale.side, least):g} mm"


def sweeps(folder: Path, scale: Scale, names: list[str] | None = None) -> Iterator[tuple[str, dict[str, Any]]]:
    """(name of the set, its sweep) in order of worth; all whose file is there if `names` is None."""
    for _, name in ORDER:
        if (names is None and (folder / f"{name}.json").exists()) or (names is not None and name in names):
            yield name, scaled(sweep_file(folder, name), scale)
