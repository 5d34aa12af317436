"""A sweep in one figure: numbers against what was swept, and pictures of its runs over that."""
import math
import subprocess
from pathlib import Path
from typing import Any, Mapping, Sequence

from ..system import scratch_folder
from ..rows import Row, error_field, has_several_versions
from ..units import leading_number
from . import names, style
from .series import VERSION, WAY, Arrangement, grouped, label_of
from .sheet import Sheet

#: The parameter that numbers the runs of a protocol, from 1.
STAGE = "stage"
_OF_COURSE = {STAGE, "time.steady", "time.measure"}


def longest_parameter(points: Sequence[Row]) -> str:
    """The swept key with the most values that are numbers; empty if none has two. The number of a stage and
    how long it lasts come last: what the stages of a protocol change says more."""
    values: dict[str, set[float]] = {}
    for point in points:
        for key, value in point.parameters.items():
            if math.isfinite(leading_number(value)):
                values.setdefault(key, set()).add(leading_number(value))
    several = {key: len(found) for key, found in values.items() if len(found) > 1}
    return max(several, key=lambda key: (key not in _OF_COURSE, several[key])) if several else ""


def set_by_stages(points: Sequence[Row]) -> set[str]:
    """The keys of a protocol: those that are the same in all points of a stage."""
    values: dict[tuple[str, float], set[str]] = {}
    for point in points:
        for key, value in point.parameters.items():
            values.setdefault((key, leading_number(point.parameters.get(STAGE))), set()).add(repr(value))
    keys = {key for key, _ in values}
    return {key for key in keys if all(len(found) == 1 for (name, _), found in values.items() if name == key)}


def ways_of(along: Sequence[float]) -> list[str]:
    """Of each value in turn, whether it lies on a way up or down; where it stays, as before."""
    ways = ["up" if next((b > a for a, b in zip(along, along[1:]) if a != b), True) else "down"]
    for before, now in zip(along, along[1:]):
        ways.append(ways[-1] if now == before else "up" if now > before else "down")
    return ways


def file_name(field_name: str) -> str:
    for part in ("measured.", ".value", ".mean"):
        field_name = field_name.replace(part, "", 1)
    return field_name.replace(".", "_")


Group = tuple[dict[str, Any], list[tuple[float, Row]]]


def _by_way(others: dict[str, Any], group: list[tuple[float, Row]]) -> list[Group]:
    """The stages of a protocol, in their order, as those on ways up and those on ways down."""
    ways = ways_of([at for at, _ in group])
    return [({**others, WAY: way}, [pair for pair, its in zip(group, ways) if its == way])
            for way in dict.fromkeys(ways)]


def sweep_figure(points: Sequence[Row], x: str = "", y: str = "order.mean",
                 width: str | None = None, over: Mapping[str, Sequence[float]] = {}) -> tuple[str, Sheet] | None:
    """(name, figure): `y` against `x`, the longest swept parameter if left out; `over`: the times over which they are
    taken, as axis_title has them. Other parameters, and versions, are
    told by colours and panels as Arrangement does, and so are the ways up and down of a protocol. None where no
    parameter is swept, or no point has both."""
    path = x or longest_parameter(points)
    if not path:
        return None
    of_protocol: set[str] = set()
    if path != STAGE and any(STAGE in point.parameters for point in points):
        of_protocol = set_by_stages(points) | {STAGE}
        points = sorted(points, key=lambda point: leading_number(point.parameters.get(STAGE)))
    several_versions = has_several_versions(points)
    placed: list[tuple[dict[str, Any], tuple[float, Row]]] = []
    for point in points:
        at = point.number(x) if x and math.isfinite(point.number(x)) else leading_number(point.parameters.get(path))
        if not math.isfinite(at) or not math.isfinite(point.number(y)):
            continue
        others = {key: value for key, value in point.parameters.items() if key != path and key not in of_protocol}
        if several_versions and point.made_by:
            others[VERSION] = point.made_by
        placed.append((others, (at, point)))
    groups: list[Group] = grouped(placed)
    if not groups:
        return None
    if of_protocol:
        groups = [part for group in groups for part in _by_way(*group)]
    arrangement = Arrangement([others for others, _ in groups])
    sheet = arrangement.sheet(width, names.axis_title(path, over=over.get("x", ())),
                              names.axis_title(y, over=over.get("y", ())))
    error = error_field(y)
    any_error = any(math.isfinite(point.number(error)) for _, group in groups for _, point in group)
    for panel, k in arrangement.each(sheet):
        group = sorted(groups[k][1], key=lambda pair: pair[0])
        panel.curve([at for at, _ in group], [point.number(y) for _, point in group],
                    [point.number(error) for _, point in group] if any_error else None,
                    [point.steady(y) for _, point in group], look="points", name=arrangement.label(k),
                    **arrangement.look(k))
    for panel, _ in arrangement.panels_of(sheet):
        if y == "order.mean":
            panel.range(y=(0, 1)).reference(y=0.5)
    return f"{file_name(y)}_{file_name(path)}", sheet


def picture_map(runs: Sequence[tuple[str, Mapping[str, Any]]], axes: Sequence[str], renderer: str,
                width: str | None = None) -> tuple[Sheet, list[str]]:
    """The map, and why some of its places have no picture. Of replicas, and of runs that differ in more than the axes,
    the first is shown.

    runs:     (directory, parameters): the swept keys as they were asked for
    axes:     one or two of them that are numbers
    renderer: the program shaken-render
    """
    from matplotlib.image import imread
    x, y = ([leading_number(parameters[key]) if key else 0.0 for _, parameters in runs] for key in (*axes, "")[:2])
    across, up = sorted(set(x)), sorted(set(y), reverse=True)
    size = style.inches(width or "183mm") * 25.4 / len(across)
    sheet = style.sheet(width or "183mm", len(up), len(across), size + 4, letters=False)
    missing = []
    with scratch_folder("shaken-map-") as scratch:
        for (directory, parameters), column, row in zip(runs, map(across.index, x), map(up.index, y)):
            panel, picture = sheet[len(across) * row + column], scratch / "rods.png"
            if panel.is_used:
                continue
            panel.titles(title=label_of({key: parameters[key] for key in axes}))
            side = round(min(max(size, 10), 60) * 12)  # 300 dots per inch
            problem = _draw([renderer, "picture", directory, "--bare", "--colour=angle", "--no-defects",
                             f"--size={side}x{side}", "-o", str(picture)])
            if not problem:
                panel.picture(imread(picture))
                continue
            panel.absent = "no frame"
            missing.append(problem)
    return sheet, missing


def _draw(command: Sequence[str]) -> str:
    """Runs shaken-render; why there is no picture, or nothing."""
    if not Path(command[2], "trajectory.h5").exists():
        return "nothing was recorded"
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.stdout.decode(errors="replace").strip() if done.returncode else ""
