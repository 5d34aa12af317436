"""The look of all figures: sizes, fonts, colours."""
import functools
from typing import TYPE_CHECKING, Any, Callable, Sequence

import matplotlib

if TYPE_CHECKING:
    from .sheet import Sheet

#: Named curves, of Okabe & Ito's colours that are told apart with any eyes (*Color Universal Design*, 2008).
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000")
#: A mark for each of them, so that they can be told apart without colours too.
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
#: What is no data of ours: numbers and lines of others, laws, zero.
GREY = "#8c8c8c"
#: Words about points, of the same colour as what they are about.
DARK_GREY = "#5a5a5a"

_RC: dict[str, Any] = {
    "font.family": "DejaVu Sans", "font.size": 7, "mathtext.fontset": "dejavusans",
    "axes.titlesize": 7, "axes.labelsize": 7, "xtick.labelsize": 6.5, "ytick.labelsize": 6.5, "legend.fontsize": 6.5,
    "axes.linewidth": 0.6, "axes.titlepad": 4.0, "axes.labelpad": 2.5, "axes.titlelocation": "left",
    "text.hinting": "no_hinting", "axes.unicode_minus": True, "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 5),
    "axes.axisbelow": True, "axes.xmargin": 0.05, "axes.ymargin": 0.06,
    "xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6, "xtick.minor.width": 0.4, "ytick.minor.width": 0.4,
    "xtick.major.size": 2.6, "ytick.major.size": 2.6, "xtick.minor.size": 1.5, "ytick.minor.size": 1.5,
    "xtick.major.pad": 3.0, "ytick.major.pad": 2.5,
    "lines.linewidth": 1.0, "lines.markersize": 3.6, "lines.markeredgewidth": 0.8, "errorbar.capsize": 0,
    "legend.frameon": False, "legend.borderaxespad": 0.6, "legend.handlelength": 1.6, "legend.handletextpad": 0.5,
    "legend.labelspacing": 0.3, "legend.columnspacing": 1.2, "legend.numpoints": 1, "legend.borderpad": 0.2,
    "image.cmap": "viridis", "figure.facecolor": "white", "savefig.facecolor": "white", "figure.dpi": 300,
    "pdf.fonttype": 42, "svg.fonttype": "none", "svg.hashsalt": "shaken", "path.simplify": True,
}


_inside = False


def styled(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function that makes or draws artists: they come out in this style, whatever the caller's settings are."""
    @functools.wraps(function)
    def wrapped(*arguments: Any, **options: Any) -> Any:
        global _inside
        if _inside:
            return function(*arguments, **options)
        _inside = True
        try:
            with matplotlib.rc_context({**matplotlib.rcParamsDefault, **_RC}):  # and then what they were
                return function(*arguments, **options)
        finally:
            _inside = False
    return wrapped


def inches(size: str | float) -> float:
    """A size "89mm", "12 cm", "2in", or a number of millimetres."""
    if not isinstance(size, str):
        return float(size) / 25.4
    text = size.strip()
    for unit, factor in (("mm", 1 / 25.4), ("cm", 1 / 2.54), ("in", 1.0)):
        if text.endswith(unit):
            return float(text[:-2]) * factor
    return float(text) / 25.4


class ColourScale:
    """Colours for the values of a parameter: dark for the least, light green for the largest, along viridis without its
    palest end. `scale(value)` is a colour; `Sheet.colourbar` draws the scale.

    values: those that occur; they get the ticks if there are few
    title:  of the bar, with the unit
    log:    whether equal ratios, not equal differences, are equal steps of colour
    """

    def __init__(self, values: Sequence[float], title: str = "", log: bool = False) -> None:
        import matplotlib.colors as colours
        from matplotlib import colormaps
        self.values = sorted(set(float(value) for value in values))
        self.title = title
        low, high = self.values[0], self.values[-1]
        if low == high:
            low, high = (low / 2, high * 2) if log else (low - 0.5, high + 0.5)
        self.norm = colours.LogNorm(low, high) if log else colours.Normalize(low, high)
        self.map = colours.ListedColormap(colormaps["viridis"](
            [0.92 * k / 255 for k in range(256)]), name="viridis_without_yellow")

    def __call__(self, value: float) -> Any:
        return self.map(self.norm(value))


def sheet(width: str | float = "89mm", rows: int = 1, columns: int = 1, panel_height: str | float | None = None,
          title: str = "", letters: bool | None = None) -> "Sheet":
    """An empty figure of rows * columns panels, `sheet.panels` row by row.

    width:        "89mm", "120mm", "183mm", or any other
    panel_height: of a row, with the titles of its axes; if left out, so that panels have a good shape
    letters:      whether panels are called (a), (b), ...; if left out, where there are several
    """
    from .sheet import Sheet
    return Sheet(width, rows, columns, panel_height, title, letters)
