"""A panel of a figure: curves with their errors, what is known of their steadiness, references, maps."""
import math
from typing import TYPE_CHECKING, Any, Sequence

import numpy as np
from numpy.typing import NDArray

from ..catalogue import STEADINESS
from ..errors import ShakenError
from .names import short_number
from .save import Drawn
from .style import DARK_GREY, GREY, MARKERS, PALETTE, styled

if TYPE_CHECKING:
    from .sheet import Sheet

_NOT_STEADY = ", or ".join(row["word"] for row in STEADINESS.values() if row["mark"])
HOLLOW, DASHED = f"hollow: {_NOT_STEADY}", f"dashed: {_NOT_STEADY}"
NO_ERROR = "crossed: no error known"
BARS, BANDS = "bars: ± one standard error, if longer than the mark", "bands: ± one standard error"

#: Curves of more points are drawn as lines with bands; of fewer as points with bars.
MOST_MARKS = 40
_FINE_DASHES = (0, (2.6, 1.1))
_VERDICTS = {"agrees": ("✓ agrees", "#00795a"), "disagrees": ("✗ disagrees", "#c04000"),
             "unresolved": ("? unresolved", DARK_GREY)}


class Panel:
    """One pair of axes. `axes` is matplotlib's, for what the methods do not offer; what is drawn there by hand goes
    into the CSV with `record`.

    letter: "a", "b", ...; "" where the figure has one panel
    """

    def __init__(self, sheet: "Sheet", axes: Any, letter: str) -> None:
        self.sheet, self.axes, self.letter = sheet, axes, letter
        self.x_title = self.y_title = self.title = ""
        self.drawn: list[Drawn] = []
        self.explained: set[Any] = set()
        self.entries: list[tuple[Any, str]] = []     # of the key: (handle, label)
        self.is_used = self.has_picture = False
        self.absent = "no data"                       # what a panel without any says
        self._lines: list[Any] = []                   # of curves
        self._outlines: list[tuple[NDArray[Any], NDArray[Any], bool]] = []   # what a key should not cover: x, y, joined
        self._reach: list[tuple[NDArray[Any], NDArray[Any], NDArray[Any], bool]] = []  # x, low, high, has marks
        self.labels: list[tuple[str, NDArray[Any], NDArray[Any]]] = []       # of references: text, x, y
        self._wanted: dict[str, tuple[float | None, float | None]] = {"x": (None, None), "y": (None, None)}
        self._exact = {"x": False, "y": False}
        self._n_named = 0
        self._levels: list[tuple[str, float]] = []   # lines through the whole panel
        self.padding = 1.0                            # times what is free about the points (bench/step_bias.py)
        self._number_room = False
        self._afterwards: list[Any] = []
        self.keyless = False

    # what a panel is told

    @styled
    def titles(self, x: str = "", y: str = "", title: str = "") -> "Panel":
        """Titles of the axes, as of names.axis_title, and of the panel, which stands behind its letter."""
        self.x_title, self.y_title, self.title, self.is_used = x, y, title, True
        self.axes.set_xlabel(x)
        self.axes.set_ylabel(y)
        head = (f"({self.letter}) " if self.letter else "") + title
        self.axes.set_title(head.strip(), loc="left")
        return self

    @styled
    def scale(self, x: str = "linear", y: str = "linear") -> "Panel":
        """"log" or "linear"."""
        self.axes.set_xscale(x)
        self.axes.set_yscale(y)
        return self

    def range(self, x: tuple[float | None, float | None] = (None, None),
              y: tuple[float | None, float | None] = (None, None), exactly: bool = False) -> "Panel":
        """What the axes reach at least; None: as far as the data. With `exactly` no farther: data beyond is not seen.
        """
        for axis, wanted in (("x", x), ("y", y)):
            if wanted != (None, None):
                self._wanted[axis], self._exact[axis] = wanted, exactly
        return self

    # what a panel shows

    @styled
    def curve(self, x: Any, y: Any, error: Any = None, steady: Any = True, label: str = "", colour: Any = None,
              marker: str | None = None, look: str = "", joined: bool = True, name: str = "") -> "Panel":
        """Points or a line, with errors.

        error:  standard errors of y; NaN where not known; None where there are none to be known
        steady: True, False or None, of all or one for each: hollow (a line: dashed) where it is not True
        label:  in the key; at most seven curves have their own colour, more take one of a ColourScale
        colour: number of a colour of the palette, or any colour; the next one of the palette if left out
        marker: the mark of the colour if left out
        look:   "points" with bars, "line" with a band; if left out, points where there are few
        joined: whether points are joined by a thin line
        name:   what the CSV calls it, where that is not its label
        """
        x, y = np.asarray(x, dtype=float).ravel(), np.asarray(y, dtype=float).ravel()
        if x.shape != y.shape:
            raise ShakenError(f"the curve '{label}' has {x.size} x and {y.size} y")
        errors = None if error is None else np.broadcast_to(np.asarray(error, dtype=float).ravel(), y.shape)
        said = list(steady) if isinstance(steady, (list, tuple, np.ndarray)) else [steady] * y.size
        sure = np.broadcast_to(np.array([word == 1 for word in said], dtype=bool), y.shape)
        self.drawn.append(Drawn(self.letter, name or label, x, y, errors, said))
        self.is_used = True
        colour, mark = self._colour(label, colour)
        if marker is not None:
            mark = marker
        finite = np.isfinite(x) & np.isfinite(y)
        as_points = look == "points" or (look == "" and np.count_nonzero(finite) <= MOST_MARKS)
        if np.any(finite):
            (self._points if as_points else self._line)(x, y, errors, sure, colour, mark, joined)
        if label and np.any(finite):
            self.entries.append((_handle(colour, mark if as_points else "", as_points and not joined,
                                         _FINE_DASHES if not as_points and not np.all(sure[finite]) else "-",
                                         hollow=as_points and not np.any(sure[finite])), label))
        return self

    def _colour(self, label: str, colour: Any) -> tuple[Any, str]:
        if colour is None or isinstance(colour, (int, np.integer)):
            k = self._n_named if colour is None else int(colour)
            if k >= len(PALETTE):
                raise ShakenError(f"'{label}' would be curve {k + 1} of a panel, and seven at most are told apart by "
                                  "their colours: give colours of a style.ColourScale")
            self._n_named = max(self._n_named, k + 1) if label or colour is None else self._n_named
            return PALETTE[k], MARKERS[k]
        return colour, "o"

    def _points(self, x: NDArray[Any], y: NDArray[Any], errors: NDArray[Any] | None, sure: NDArray[Any], colour: Any,
                mark: str, joined: bool) -> None:
        axes = self.axes
        low = high = y
        if errors is not None:
            barred = np.isfinite(errors) & np.isfinite(y)
            half = np.where(barred, errors, 0.0)
            low, high = y - half, y + half
            if np.any(barred):
                axes.errorbar(x[barred], y[barred], yerr=errors[barred], fmt="none", ecolor=colour, elinewidth=0.8,
                              zorder=2.2)
                self.explained.add("bars")
                for k in np.flatnonzero(barred):
                    self._outlines.append((x[[k, k]], np.array([low[k], high[k]]), True))
        if joined:
            self._lines += axes.plot(x, y, "-", color=colour, linewidth=0.8, zorder=2.4)
        for kind, face in ((sure, colour), (~sure, "white")):
            shown = kind & np.isfinite(x) & np.isfinite(y)
            if np.any(shown):
                axes.plot(x[shown], y[shown], linestyle="none", marker=mark, markerfacecolor=face,
                          markeredgecolor=colour, zorder=2.6)
                if face == "white":
                    self.explained.add(HOLLOW)
        self._cross_out(x, y, errors, colour)
        self._reach.append((x, low, high, True))
        self._outlines.append((x, y, joined))

    def _cross_out(self, x: NDArray[Any], y: NDArray[Any], errors: NDArray[Any] | None, colour: Any,
                   is_line: bool = False) -> None:
        """Crosses over points whose error is not known, a few of a line."""
        which = np.flatnonzero(np.isfinite(x) & np.isfinite(y) & ~np.isfinite(y if errors is None else errors))
        if which.size:
            if is_line:
                which = which[np.unique(np.linspace(0, which.size, 6)[:-1].astype(int))]
            self.axes.plot(x[which], y[which], linestyle="none", marker="x", markersize=5.5, markeredgewidth=0.7,
                           color=colour, zorder=2.7)
            self.explained.add(NO_ERROR)

    def _line(self, x: NDArray[Any], y: NDArray[Any], errors: NDArray[Any] | None, sure: NDArray[Any], colour: Any,
              mark: str, joined: bool) -> None:
        low = high = y
        if errors is not None and np.any(np.isfinite(errors) & np.isfinite(y)):
            low, high = y - errors, y + errors
            self.axes.fill_between(x, low, high, color=colour, alpha=0.25, linewidth=0, zorder=2.0)
            self.explained.add("bands")
            self._outlines += [(x, low, True), (x, high, True)]
        self._cross_out(x, y, errors, colour, is_line=True)
        unsure = not np.all(sure[np.isfinite(y)])
        self._lines += self.axes.plot(x, y, linestyle=_FINE_DASHES if unsure else "-", color=colour, zorder=2.4,
                                      linewidth=0.9 if y.size < 400 else 0.7)
        if unsure:
            self.explained.add(DASHED)
        self._reach += [(x, low, high, False), (x, y, y, False)]
        self._outlines.append((x, y, True))

    @styled
    def reference(self, x: Any = None, y: Any = None, label: str = "", dashed: bool = True,
                  colour: Any = GREY) -> "Panel":
        """What is not measured here, in grey with a small grey label: a level (y alone), a place (x alone), or a line
        or a law (arrays x and y)."""
        if x is None and y is None:
            raise ShakenError("a reference needs an x, a y, or both")
        self.is_used = True
        xs, ys = (np.array([]) if at is None else np.atleast_1d(np.asarray(at, dtype=float)) for at in (x, y))
        look = {"color": colour, "linestyle": (0, (4, 2)) if dashed else "-", "zorder": 1.5}
        if x is None or y is None:
            name, value = ("x", xs[0]) if y is None else ("y", ys[0])
            if not math.isfinite(value):
                return self
            (self.axes.axvline if y is None else self.axes.axhline)(value, linewidth=0.7, **look)
            self._levels.append((name, value))
        else:
            if not np.any(np.isfinite(xs) & np.isfinite(ys)):
                return self
            self.drawn.append(Drawn(self.letter, f"reference: {label}", xs, ys))
            self.axes.plot(xs, ys, linewidth=0.8, **look)
            self._outlines.append((xs, ys, True))
        self._reach.append((xs, ys, ys, False))
        if label:
            self.labels.append((label, xs, ys))
        return self

    @styled
    def dots(self, categories: Sequence[str], values: Any, error: Any = None, label: str = "", colour: int = 0,
             shift: float = 0.0, digits: int = 3) -> "Panel":
        """A value for each category, which stand on the y axis from the top down; with the number beside the mark
        in so many digits, none if 0.
        `shift` moves the marks up by that part of a row, where several series share them."""
        values = np.asarray(values, dtype=float)
        places = -np.arange(len(categories), dtype=float) + shift
        errors = np.zeros_like(values) if error is None else np.nan_to_num(np.asarray(error, dtype=float))
        self.is_used = True
        axes, paint = self.axes, PALETTE[colour]
        shown = np.isfinite(values)
        if error is not None:
            axes.errorbar(values[shown], places[shown], xerr=errors[shown], fmt="none", ecolor=paint, elinewidth=0.8,
                          zorder=2.2)
            self.explained.add("bars")
        axes.plot(values[shown], places[shown], linestyle="none", marker=MARKERS[colour], color=paint, zorder=2.6)
        self._cross_out(values, places, None if error is None else np.asarray(error, dtype=float), paint)
        for k in np.flatnonzero(shown):
            self.drawn.append(Drawn(self.letter, f"{label}: {categories[k]}" if label else categories[k],
                                    values[k:k + 1], places[k:k + 1], None if error is None else errors[k:k + 1]))
            if digits:
                axes.annotate(short_number(values[k], digits), (values[k] + errors[k], places[k]), xytext=(3.5, 0),
                              fontsize=6, textcoords="offset points", va="center", color=paint, zorder=3)
        axes.set_yticks(-np.arange(len(categories)), list(categories))
        axes.tick_params(axis="y", length=0, right=False)
        axes.grid(axis="y", color="#e4e4e4", linewidth=0.5)
        self.range(y=(-len(categories) + 0.4, 0.6), exactly=True)
        self._reach.append((np.concatenate([values, values - errors, values + errors]), places, places, True))
        self._outlines.append((values, places, False))
        self._number_room |= digits > 0
        if label and np.any(shown):
            self.entries.append((_handle(paint, MARKERS[colour], True, "-"), label))
        return self

    @styled
    def shares(self, categories: Sequence[str], parts: "dict[str, Any]") -> "Panel":
        """What each category consists of, in percent: bars from 0 to 100, their parts, seven at most, from the left;
        the seventh is grey, and what is missing light grey."""
        self.is_used = self.has_picture = True
        places, begin = -np.arange(len(categories), dtype=float), np.zeros(len(categories))
        for k, (name, values) in enumerate(parts.items()):
            values = np.nan_to_num(np.asarray(values, dtype=float))
            colour = PALETTE[k] if k < len(PALETTE) - 1 else GREY
            self.axes.barh(places, values, left=begin, height=0.7, color=colour, linewidth=0.4, edgecolor="white")
            self.entries.append((_handle(colour, "s", True, "-"), name))
            for at, value, category in zip(places, values, categories):
                self.drawn.append(Drawn(self.letter, f"{name}: {category}", [value], [at]))
            begin = begin + values
        self.axes.barh(places, 100 - begin, left=begin, height=0.7, color="#d9d9d9", linewidth=0)
        self.axes.set_yticks(places, list(categories))
        self.axes.tick_params(axis="y", length=0, right=False)
        self.axes.set_xlim(0, 100)
        self.axes.set_ylim(-len(categories) + 0.4, 0.6)
        return self

    def then(self, work: Any) -> "Panel":
        """Has `work(panel)` called when ranges are known."""
        self._afterwards.append(work)
        return self

    def explain(self, kind: str, text: str) -> "Panel":
        """Words at the bottom of the figure about its marks: kind "band", "line" or "grey"."""
        self.explained.add((kind, text))
        return self

    @styled
    def zero(self, x: bool = False) -> "Panel":
        """A thin line where y is nothing, and with `x` where x is."""
        for name, line in (("y", self.axes.axhline), *([("x", self.axes.axvline)] if x else [])):
            line(0, color=GREY, linewidth=0.5, zorder=1.2)
            self._levels.append((name, 0.0))
        return self

    @styled
    def verdict(self, word: str) -> "Panel":
        """What a comparison came to, at the right above the axes: "agrees", "disagrees", "unresolved", or other words.
        """
        text, colour = _VERDICTS.get(word, (word, DARK_GREY))
        self.axes.set_title(text, loc="right", color=colour, fontweight="bold", fontsize=6.5)
        return self

    @styled
    def map(self, x: Any, y: Any, z: Any, title: str = "", diverging: bool = False,
            limits: tuple[float, float] | None = None, bar: bool = True, square: bool = True) -> Any:
        """Values z (ny, nx) over the centres x, y of cells, in colours; what is not finite stays light grey. Diverging:
        blue, white, red about zero. Returns what Sheet.colourbar takes; with `bar` the panel has a colour bar of its
        own, with this title.
        """
        x, y, z = (np.asarray(values, dtype=float) for values in (x, y, z))
        if z.shape != (y.size, x.size):
            raise ShakenError(f"a map over {x.size} x {y.size} places has a shape {z.shape}, not (y, x)")
        self.is_used = self.has_picture = True
        seen = z[np.isfinite(z)]
        if limits is None and seen.size:
            most = float(np.max(np.abs(seen))) or 1.0
            limits = (-most, most) if diverging else (float(seen.min()), float(seen.max()))
        low, high = limits or (0.0, 1.0)
        drawn = self.axes.pcolormesh(_borders(x), _borders(y), z, vmin=low, vmax=high,
                                     cmap="RdBu_r" if diverging else "viridis", rasterized=True, linewidth=0)
        self.axes.set_facecolor("#e8e8e8")
        if square:
            self.axes.set_aspect("equal")
        self.axes.set_xlim(_borders(x)[[0, -1]])
        self.axes.set_ylim(_borders(y)[[0, -1]])
        grid_x, grid_y = np.meshgrid(x, y)
        self.record(title or "map", grid_x.ravel(), grid_y.ravel(), z=z.ravel())
        if bar:
            self.sheet.colourbar(drawn, [self], title)
        return drawn

    @styled
    def picture(self, pixels: Any, extent: tuple[float, float, float, float] | None = None) -> "Panel":
        """An image (rows, columns, 3 or 4) in place of a plot, without axes unless it has an `extent` (x0, x1, y0, y1).
        """
        self.is_used = self.has_picture = True
        self.axes.imshow(np.asarray(pixels), extent=extent, interpolation="antialiased", origin="upper")
        if extent is None:
            self.axes.set_axis_off()
        return self

    @styled
    def note(self, text: str) -> "Panel":
        """A few grey words in a free corner."""
        self.is_used = True
        self.entries.append((_handle("none", "", True, "-"), text))
        return self

    def record(self, curve: str, x: Any, y: Any, error: Any = None, z: Any = None) -> None:
        """Puts numbers into the CSV that were drawn with `axes`."""
        self.is_used = True
        self.drawn.append(Drawn(self.letter, curve, np.asarray(x, dtype=float), np.asarray(y, dtype=float), error,
                                z=z))

    # how it is brought into shape

    @property
    def has_data(self) -> bool:
        return self.has_picture or bool(self._outlines) or bool(self.axes.collections or self.axes.patches)

    def finish_axes(self) -> None:
        """Ranges and ticks, once everything is drawn."""
        if self.has_picture:
            return
        if not self.has_data:
            self.axes.set_xticks([])
            self.axes.set_yticks([])
            # a reference alone is drawn in the middle: the words stand clear of it
            self.axes.text(0.5, 0.25, self.absent, color=GREY, ha="center", va="center", transform=self.axes.transAxes,
                           bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5})
            return
        for name in ("x", "y"):
            if self._reach:
                self._set_limits(name)
            set_ticks(self.axes, name)
            if getattr(self.axes, f"get_{name}scale")() == "log":
                for line in self._lines:  # which must not pass over what has no logarithm
                    values = np.asarray(getattr(line, f"get_{name}data")(), dtype=float)
                    getattr(line, f"set_{name}data")(np.where(values > 0, values, np.nan))
        for work in self._afterwards:
            work(self)

    def _set_limits(self, name: str) -> None:
        log = getattr(self.axes, f"get_{name}scale")() == "log"

        def forward(number: Any) -> float:
            return math.log10(number) if log else float(number)

        found = [(part[np.isfinite(part) & (part > 0 if log else True)], has_marks)
                 for x, low, high, has_marks in self._reach for part in ((x,) if name == "x" else (low, high))]
        seen = np.concatenate([part for part, _ in found])
        if seen.size == 0:
            return
        marks = np.concatenate([np.array([]), *(part for part, has_marks in found if has_marks)])
        least, most = forward(seen.min()), forward(seen.max())
        lower, upper = (None if end is None else forward(end) for end in self._wanted[name])
        if self._exact[name]:
            self._apply(name, least if lower is None else lower, most if upper is None else upper, log)
            return
        if least == most:  # one point: axes around it
            pad = 0.3 if log else 0.1 * abs(least) or 1.0
            least, most = least - pad, most + pad
        begin = least if lower is None else min(least, lower)
        end = most if upper is None else max(most, upper)
        span = end - begin
        pad = self.padding * (0.05 if name == "x" else 0.06) * span
        # A line may begin at an axis; a mark, or the end of a bar, may not. Above and below all keep some distance.
        mark_low = forward(marks.min()) if marks.size else math.inf
        mark_high = forward(marks.max()) if marks.size else -math.inf
        if name == "x" and self._number_room:
            end += 0.16 * span  # numbers stand to the right of their marks
        soft_low = name == "y" and lower is None or mark_low < begin + pad
        soft_high = name == "y" and upper is None or mark_high > end - pad
        if name == "y" and upper is not None and most > end - 0.02 * span:
            soft_high = True
        self._apply(name, begin - pad if soft_low else begin, end + pad if soft_high else end, log)

    def _apply(self, name: str, low: float, high: float, log: bool) -> None:
        if low == high:
            low, high = low - 0.5, high + 0.5
        getattr(self.axes, f"set_{name}lim")((10**low, 10**high) if log else (low, high))

    @property
    def can_grow(self) -> bool:
        """Whether the y axis may reach higher to make room for the key."""
        return self._wanted["y"][1] is None and not self._exact["y"] and not self.has_picture

    def obstacles(self) -> NDArray[Any]:
        """(n, 2) places in pixels that what is drawn goes through, every two pixels or so."""
        places = []
        for x, y, joined in self._outlines:
            with np.errstate(all="ignore"):
                at = self.axes.transData.transform(np.column_stack([x, y]))
            at = at[np.all(np.isfinite(at), axis=1)]
            if joined and len(at) > 1:
                way = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(at, axis=0).T))])
                steps = np.linspace(0, way[-1], int(min(way[-1] / 2 + 2, 20000)))
                at = np.column_stack([np.interp(steps, way, at[:, 0]), np.interp(steps, way, at[:, 1])])
            places.append(at)
        box = self.axes.bbox
        for name, value in self._levels:
            at = self.axes.transData.transform((value, value))
            across = np.linspace(0, 1, 400)
            places.append(np.column_stack([np.full(400, at[0]), box.y0 + across * box.height]) if name == "x" else
                          np.column_stack([box.x0 + across * box.width, np.full(400, at[1])]))
        return np.concatenate(places) if places else np.empty((0, 2))


def _borders(places: NDArray[Any]) -> NDArray[Any]:
    """Where the cell of each place ends: half way to its neighbours, and as far out at the ends."""
    if places.size < 2:
        return np.concatenate([places - 0.5, places + 0.5])
    between = (places[1:] + places[:-1]) / 2
    return np.concatenate([[2 * places[0] - between[0]], between, [2 * places[-1] - between[-1]]])


def _handle(colour: Any, marker: str, lineless: bool, line: Any, hollow: bool = False) -> Any:
    from matplotlib.lines import Line2D
    return Line2D([], [], color=colour, marker=marker or "none", linestyle="none" if lineless else line,
                  linewidth=0.9, markerfacecolor="white" if hollow else colour)


def set_ticks(axes: Any, name: str) -> None:
    """Labels of an axis, once its limits are known."""
    from matplotlib import ticker
    axis = getattr(axes, f"{name}axis")
    low, high = getattr(axes, f"get_{name}lim")()
    if getattr(axes, f"get_{name}scale")() != "log":
        most = max(abs(low), abs(high))
        formatter = axis.get_major_formatter()
        if not 1e-3 < most < 1e5 and isinstance(formatter, ticker.ScalarFormatter):
            formatter.set_useMathText(True)  # ×10⁻⁶ at the end of the axis; plain numbers are drawn much faster without
        if isinstance(axis.get_major_locator(), ticker.AutoLocator):
            axis.set_major_locator(ticker.MaxNLocator("auto", steps=[1, 2, 5, 10]))
        return
    decades = math.log10(high / low)
    n_tens = math.floor(math.log10(high) + 1e-9) - math.ceil(math.log10(low) - 1e-9) + 1
    powers = high >= 1e5 or low < 1e-4 or decades > 5
    subs = (1.0,) if n_tens >= 3 else (1.0, 2.0, 5.0)
    if not isinstance(axis.get_major_locator(), ticker.FixedLocator):
        axis.set_major_locator(ticker.LogLocator(base=10, subs=subs, numticks=9 if n_tens >= 3 else 15)
                               if decades > 0.7 else ticker.MaxNLocator(4, steps=[1, 2, 5, 10]))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: log_text(value, powers and len(subs) == 1)))
    axis.set_minor_locator(ticker.LogLocator(base=10, subs=range(1, 10), numticks=50))
    axis.set_minor_formatter(ticker.NullFormatter())


def log_text(value: float, power: bool) -> str:
    if value <= 0 or not math.isfinite(value):
        return ""
    if power:
        return rf"$10^{{{round(math.log10(value))}}}$"
    if 1e4 <= value < 1e7:
        return f"{value:,.0f}"
    return f"{value:.10g}" if 1e-5 < value < 1e7 else f"{value:.0e}"
