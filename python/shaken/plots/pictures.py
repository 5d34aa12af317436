# SPDX-License-Identifier: MIT
"""A sweep in pictures: the last frames of its runs, each at its place over the numbers that are swept."""
from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any, Mapping, Sequence

from matplotlib.image import imread

from ..children import scratch_folder
from . import style
from .series import label_of, number_of
from .sheet import Sheet


def picture_map(runs: Sequence[tuple[str, Mapping[str, Any]]], axes: Sequence[str], renderer: str,
                width: str | None = None) -> tuple[Sheet, list[str]]:
    """The map, and why some of its places have no picture. Of replicas, and of runs that differ in more than the axes,
    the first is shown.

    runs:     (directory, parameters): the swept keys as they were asked for
    axes:     one or two of them that are numbers
    renderer: the program shaken-render
    """
    x, y = ([number_of(parameters[key]) if key else 0.0 for _, parameters in runs] for key in (*axes, "")[:2])
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
