"""What a notebook shows of results: tables with their units, and pictures of frames."""
import html
import shutil
import tempfile
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence

from .catalogue import KEYS
from .estimate import Estimate
from .native import programs_folder
from .system import output_of

_MOST_NUMBERS = 6  #: of a sweep, beside what is swept
_PIXELS = "640x640"


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    return html.escape(str(value))


def _table(head: Sequence[str], rows: Iterable[Sequence[Any]], caption: str) -> str:
    def line(cells: Iterable[str], kind: str) -> str:
        return f"<tr>{''.join(f'<{kind}>{cell}</{kind}>' for cell in cells)}</tr>"

    body = "".join(line(map(_cell, row), "td") for row in rows)
    return (f"<table><caption>{html.escape(caption)}</caption><thead>{line(map(html.escape, head), 'th')}</thead>"
            f"<tbody>{body}</tbody></table>")


def _titled(name: str) -> str:
    """A key with its unit: "rods.length [mm]"."""
    unit = KEYS.get(name, {}).get("unit") or "1"
    return name if unit in ("1", "") else f"{name} [{unit}]"


def numbers_html(numbers: Mapping[str, Estimate], caption: str) -> str:
    """A row for each number, with its unit and whether it is of a steady state."""
    return _table(("number", "value ± error", "steady"),
                  ((name, str(number), {True: "yes", False: "no", None: "not known"}[number.steady])
                   for name, number in numbers.items()), caption)


def points_html(points: Sequence[Any], keys: Sequence[str], caption: str) -> str:
    """A row for each point: what is swept, how many runs are done, and its first numbers."""
    names = list(dict.fromkeys(name for point in points for name in point.names()))
    shown = names[:_MOST_NUMBERS]
    rest = f"; {len(names) - len(shown)} more numbers, which to_frame() has" if len(names) > len(shown) else ""
    rows = [[*(point.key(key) for key in keys), f"{len(point.runs)} of {point.n_replicas}",
             *(str(point[name]) if name in point.names() else "" for name in shown)] for point in points]
    return _table([*map(_titled, keys), "done", *shown], rows, caption + rest)


def picture(trajectory: Path, frame: int) -> bytes | None:
    """The PNG that `shaken-render` draws of a frame of a trajectory.h5; None where there is no such program, so that a
    notebook shows the text."""
    program = shutil.which("shaken-render", path=str(programs_folder())) or shutil.which("shaken-render")
    if program is None:
        return None
    with tempfile.TemporaryDirectory(prefix="shaken-frame-") as folder:
        output_of([program, "picture", str(trajectory), "--frame", str(frame), "--size", _PIXELS, "--out",
                   f"{folder}/frame.png"], "shaken-render")
        return Path(folder, "frame.png").read_bytes()
