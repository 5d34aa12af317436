"""Text for a terminal: what it may obey is escaped, tables fit its width."""
import json
import math
import os
import re
import sys
from dataclasses import dataclass
from typing import Any, Iterable, Sequence

#: Control characters, those that turn the direction of writing, and bytes that were no UTF-8.
_OBEYED = re.compile("[\x00-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
_COLOUR = re.compile("\x1b\\[[0-9]*m")
_GAP, _NARROWEST = 2, 4


def _escaped(found: "re.Match[str]") -> str:
    code = ord(found[0])
    return f"\\x{code - 0xdc00:02x}" if 0xdc80 <= code <= 0xdcff else f"\\u{code:04x}"


def printable(text: str, lines: bool = False) -> str:
    """The text without anything that a terminal would obey; with `lines` it may have line breaks and tabs."""
    return _OBEYED.sub(lambda found: found[0] if lines and found[0] in "\n\t" else _escaped(found), text)


def value_text(value: Any) -> str:
    """A number, a text, true or false as JSON has them; empty for None."""
    return "" if value is None else printable(value if isinstance(value, str) else json.dumps(value))


def json_text(value: Any) -> str:
    """As `--json` prints it: indented; what a terminal would obey is escaped."""
    text = json.dumps(value, indent=2, ensure_ascii=False)
    return _OBEYED.sub(lambda found: found[0] if found[0] == "\n" else f"\\u{ord(found[0]):04x}", text)


def number_text(value: float) -> str:
    """Up to four significant digits; of whole numbers, which are counts, all."""
    if value != value:
        return "-"
    return f"{value:.0f}" if value == round(value) and abs(value) < 1e6 else f"{value:.4g}"


def shortest(value: Any) -> str:
    """A number with as many digits as tell it apart; of whole ones no point."""
    return repr(float(value)).removesuffix(".0")


def csv_line(texts: Iterable[str]) -> str:
    return ",".join('"' + text.replace('"', '""') + '"' if set(text) & set(',"\r\n') else text for text in texts) + "\n"


def bytes_text(n: float) -> str:
    """"62.6 MB"."""
    power = min(4, int(math.log10(max(n, 1) * 1.0005) / 3))
    return f"{n / 1000**power:.3g} {('B', 'kB', 'MB', 'GB', 'TB')[power]}"


def terminal_width() -> int:
    """Columns of the terminal on stdout; 0 where there is none, and lines may be of any length."""
    if not sys.stdout.isatty() or os.environ.get("TERM", "dumb") == "dumb":
        return 0
    try:
        return os.get_terminal_size(sys.stdout.fileno()).columns or 80
    except OSError:
        return 80


def in_yellow(text: str) -> str:
    """In colour, where the terminal has colours and NO_COLOR is not set."""
    return f"\x1b[33m{text}\x1b[0m" if terminal_width() and not os.environ.get("NO_COLOR") else text


def _width(text: str) -> int:
    return len(_COLOUR.sub("", text))


@dataclass
class Column:
    """title, cells: a text for each row; right: whether numbers stand below each other; rank: where there is no room
    the column with the highest goes first, 0 stays"""

    title: str
    cells: list[str]
    right: bool = False
    rank: int = 0

    @property
    def width(self) -> int:
        return max(map(_width, [self.title, *self.cells]))


def table(columns: Sequence[Column], room: int) -> tuple[str, list[str]]:
    """(lines, titles of what has no room). Of columns that are too wide for `room` (0: any) whole ones go by their
    rank, then texts are shortened, the widest first; numbers and the first column never are."""
    shown = list(columns)
    widths = {id(column): column.width for column in columns}

    def is_too_wide() -> bool:
        return 0 < room < sum(widths[id(column)] + _GAP for column in shown) - _GAP

    while is_too_wide() and any(column.rank for column in shown):
        shown.remove(max(reversed(shown), key=lambda column: column.rank))
    while is_too_wide():
        texts = [column for column in shown[1:] if not column.right and widths[id(column)] > _NARROWEST]
        if not texts:
            break
        widths[id(max(texts, key=lambda column: widths[id(column)]))] -= 1

    def cell(column: Column, text: str) -> str:
        width = widths[id(column)]
        if _width(text) > width:
            text = text[:width - 1] + "…"
        blank = " " * (width - _width(text))
        return blank + text if column.right else text + blank

    lines = [[column.title for column in shown], *zip(*(column.cells for column in shown))]
    text = "".join((" " * _GAP).join(map(cell, shown, line)).rstrip(" ") + "\n" for line in lines)
    return text, [column.title for column in columns if column not in shown]
