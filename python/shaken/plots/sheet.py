"""A figure of one or several panels: where everything goes, so that nothing is cut and nothing is covered."""
import itertools
import math
import re
from pathlib import Path
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from . import panel as panels_of
from . import save as saving
from .names import number_text
from .panel import Panel
from .style import DARK_GREY, ColourScale, inches, styled

_EDGE = 2.5 / 72          # [inches] that stays white at the border of a figure
_CORNERS = ("upper right", "upper left", "lower right", "lower left", "center right", "center left", "upper center",
            "lower center")
_BELOW_AXES = 25.0        # [points] from the axes to below the title of x


class Sheet:
    """A figure. `panels` are its panels, row by row; those that are not used stay white.

    figure: matplotlib's
    """

    @styled
    def __init__(self, width: str | float = "89mm", rows: int = 1, columns: int = 1,
                 panel_height: str | float | None = None, title: str = "", letters: bool | None = None) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        self.width = inches(width)
        each = inches(panel_height) if panel_height is not None else min(
            max(0.74 * self.width / columns, 38 / 25.4), 75 / 25.4)
        self.height = rows * each
        self.figure = Figure(figsize=(self.width, self.height), layout="constrained")
        FigureCanvasAgg(self.figure)
        self.title = title
        lettered = rows * columns > 1 if letters is None else letters
        axes = self.figure.subplots(rows, columns, squeeze=False).ravel()
        self.rows, self.columns = rows, columns
        self.panels = [Panel(self, one, _letter(k) if lettered else "") for k, one in enumerate(axes)]
        for one in self.panels:
            if one.letter:
                one.axes.set_title(f"({one.letter})", loc="left")
        self._is_finished = self._shares_axes = self._shares_key = False

    def __getitem__(self, k: int) -> Panel:
        return self.panels[k]

    def __iter__(self) -> Iterator[Panel]:
        return iter(self.panels)

    @styled
    def colourbar(self, scale: Any, panels: Sequence[Panel] | None = None, title: str = "") -> Any:
        """The bar of a ColourScale, or of what Panel.map returned, to the right of `panels` (all, if left out); none
        of None, where nothing was drawn."""
        if scale is None:
            return None
        from matplotlib.cm import ScalarMappable
        from matplotlib.ticker import FixedLocator, NullLocator
        mappable = ScalarMappable(scale.norm, scale.map) if isinstance(scale, ColourScale) else scale
        group = list(panels if panels is not None else self.panels)
        each = self.height / self.rows
        bar = self.figure.colorbar(mappable, ax=[one.axes for one in group], pad=0.02,
                                   aspect=max(12, 22 * each * (1 if len(group) <= self.columns else self.rows) / 2),
                                   fraction=0.06 if len(group) == 1 else 0.03)
        bar.outline.set_linewidth(0.5)
        bar.ax.tick_params(direction="out", length=2, width=0.5)
        if isinstance(scale, ColourScale):
            title = title or scale.title
            if len(scale.values) <= 10:
                bar.ax.yaxis.set_major_locator(FixedLocator(scale.values))
                bar.ax.yaxis.set_minor_locator(NullLocator())
                bar.ax.set_yticklabels(_even_texts(scale.values))
        bar.set_label(title)
        return bar

    def share_axes(self) -> "Sheet":
        """All panels get the same ranges, titles stand at the left and below only, and there is one key: small
        multiples."""
        self._shares_axes = True
        return self.share_key()

    def share_key(self) -> "Sheet":
        """One key for all panels, above them."""
        self._shares_key = True
        return self

    @styled
    def finish(self) -> "Sheet":
        """Gives everything its place. `save` does it; nothing is to be drawn behind."""
        if self._is_finished:
            return self
        self._is_finished = True
        for one in self.panels:
            if one.is_used:
                one.finish_axes()
            else:
                one.axes.set_axis_off()
                one.axes.set_title("", loc="left")
        renderer = self.figure.canvas.get_renderer()
        top = self._draw_title(renderer)
        if self._shares_axes:
            self._share()
        if self._shares_key:
            top += self._one_key(renderer, top)
        self._share_keys()
        bottom = self._explain(renderer)
        self.height += top + bottom
        self.figure.set_size_inches(self.width, self.height)
        self._arrange(top, bottom)
        for _ in range(3):  # lines above each other leave less room for others
            if not any([_fit_titles(one, renderer) for one in self.panels]):
                break
            self._arrange(top, bottom)
        keys = [self._key(one, renderer) for one in self.panels]
        below = [key[1] if key is not None else 0.0 for key in keys]
        if any(below):  # keys below the axes: each row needs room for its highest
            self.height += sum(max(below[k:k + self.columns]) for k in range(0, len(below), self.columns))
            self.figure.set_size_inches(self.width, self.height)
        if any(key is not None and key[2] for key in keys):
            self._arrange(top, bottom)
        for one in self.panels:
            self._place_labels(one, renderer)
        self.figure.set_layout_engine("none")
        return self

    def _arrange(self, top: float, bottom: float) -> None:
        engine = self.figure.get_layout_engine()
        x, y = _EDGE / self.width, (bottom + _EDGE) / self.height
        engine.set(w_pad=_EDGE, h_pad=_EDGE, wspace=0.03, hspace=0.04,
                   rect=(x, y, 1 - 2 * x, 1 - (top + _EDGE) / self.height - y))
        engine.execute(self.figure)

    def _draw_title(self, renderer: Any) -> float:
        """Height that the title takes [inches]."""
        if not self.title:
            return 0.0
        text = self.figure.text(0.5, 1.0, self.title, ha="center", va="top", fontsize=8)
        text.set_in_layout(False)
        _wrap(text, self.width * self.figure.dpi, renderer)
        height = text.get_window_extent(renderer).height / self.figure.dpi
        text.set_position((0.5, 1 - 2 * _EDGE / (self.height + height)))
        return height + 4 * _EDGE

    def _explain(self, renderer: Any) -> float:
        """What bars and marks mean, at the bottom. Height that it takes [inches]."""
        said = set().union(*(one.explained for one in self.panels)) if self.panels else set()
        handles = _explanations(said)
        if not handles:
            return 0.0
        _, height = self._key_of_all([handle for handle, _ in handles], [text for _, text in handles], renderer,
                                     loc="lower left", borderaxespad=0, fontsize=6, labelcolor=DARK_GREY,
                                     handlelength=1.4, bbox_to_anchor=(2 * _EDGE / self.width, 0))
        return height

    def _key_of_all(self, handles: Sequence[Any], texts: Sequence[str], renderer: Any,
                    **look: Any) -> tuple[Any, float]:
        """A key of the figure in as many columns as there is room for, and its height [inches]."""
        for n in range(len(handles), 0, -1):
            legend = self.figure.legend(handles, texts, ncol=n, **look)
            legend.set_in_layout(False)
            extent = legend.get_window_extent(renderer)
            if n == 1 or extent.width / self.figure.dpi < self.width - 4 * _EDGE:
                break
            legend.remove()
        return legend, extent.height / self.figure.dpi

    def _share(self) -> None:
        shown = [one.axes for one in self.panels if one.is_used and one.has_data]
        for name in ("x", "y"):
            limits = [getattr(axes, f"get_{name}lim")() for axes in shown]
            for axes in shown:
                getattr(axes, f"set_{name}lim")(min(low for low, _ in limits), max(high for _, high in limits))
        for k, one in enumerate(self.panels):
            below = k + self.columns < len(self.panels) and self.panels[k + self.columns].is_used
            if k % self.columns:
                one.axes.set_ylabel("")
                one.axes.tick_params(labelleft=False)
            if below:
                one.axes.set_xlabel("")
                one.axes.tick_params(labelbottom=False)

    def _one_key(self, renderer: Any, top: float) -> float:
        """One key for all panels, above them. Height that it takes [inches]."""
        entries = {label: handle for one in self.panels if one.has_data for handle, label in one.entries}
        for one in self.panels:
            one.entries = []
        if not entries:
            return 0.0
        from matplotlib.transforms import ScaledTranslation
        legend, height = self._key_of_all(list(entries.values()), list(entries), renderer, loc="upper center",
                                          borderaxespad=0, bbox_to_anchor=(0.5, 1))
        legend.set_bbox_to_anchor((0.5, 1), self.figure.transFigure + ScaledTranslation(
            0, -top - _EDGE, self.figure.dpi_scale_trans))
        return height + 2 * _EDGE

    def _share_keys(self) -> None:
        """Of two panels with the same key the later one needs none."""
        met: list[Any] = []
        for one in self.panels:
            looks = [(str(handle.get_color()), handle.get_marker(), str(handle.get_markerfacecolor()), label)
                     for handle, label in one.entries]
            one.keyless = not looks or any(all(look in other for look in looks) for other in met)
            met.append(looks)

    def _key(self, one: Panel, renderer: Any) -> tuple[Any, float, bool] | None:
        """Draws the key of a panel. Returns it, how much higher the figure must be for it [inches], and whether it is
        outside of the axes."""
        if one.keyless or not one.has_data:
            return None
        axes, dpi = one.axes, self.figure.dpi
        box = axes.get_window_extent(renderer)
        handles, texts = [handle for handle, _ in one.entries], [text for _, text in one.entries]
        obstacles = one.obstacles()

        def legend(loc: str, n: int = 1, **more: Any) -> tuple[Any, Any]:
            made = axes.legend(handles, texts, loc=loc, ncol=n, **more)
            return made, made.get_window_extent(renderer)

        def n_columns(room: float) -> int:
            return next(n for n in range(len(texts), 0, -1) if n == 1 or legend("upper center", n)[1].width <= room)

        if not one.has_picture:
            for n in range(1, min(3, len(texts)) + 1):
                made, extent = legend("upper right", n)
                if extent.width > 0.97 * box.width or extent.height > 0.8 * box.height:
                    continue
                for loc in _CORNERS:
                    made, extent = legend(loc, n)
                    if not _covered(extent, obstacles, 3 * dpi / 72):
                        return made, 0.0, False
            if one.can_grow:
                made, extent = legend("upper center", n_columns(0.97 * box.width))
                share = (extent.height + 6 * dpi / 72) / box.height
                if extent.width < 0.99 * box.width and share < 0.35:
                    _reach_higher(axes, share)
                    return made, 0.0, False
        slot = self.width / self.columns * dpi
        made, extent = legend("upper left", 1, bbox_to_anchor=(1.01, 1.02))
        if extent.width < 0.33 * slot and extent.height < 1.1 * box.height:
            return made, 0.0, True
        from matplotlib.transforms import ScaledTranslation
        n_lines = one.axes.get_xlabel().count("\n")
        below = axes.transAxes + ScaledTranslation(0, -(_BELOW_AXES + 9 * n_lines) / 72, self.figure.dpi_scale_trans)
        made, extent = legend("upper center", n_columns(0.98 * slot), bbox_to_anchor=(0.5, 0), bbox_transform=below)
        return made, extent.height / dpi, True

    def _place_labels(self, one: Panel, renderer: Any) -> None:
        """The names of references, where they cover least."""
        if not one.labels:
            return
        axes, dpi = one.axes, self.figure.dpi
        box = axes.get_window_extent(renderer).padded(-2 * dpi / 72)
        taken = [axes.get_legend().get_window_extent(renderer)] if axes.get_legend() else []
        obstacles = one.obstacles()
        for label, xs, ys in one.labels:
            text = axes.text(0, 0, label, fontsize=6, color=DARK_GREY, transform=None, zorder=3)
            if text.get_window_extent(renderer).width > 0.9 * box.width:
                _wrap(text, 0.8 * box.width, renderer)
            size = text.get_window_extent(renderer)
            best, least = (box.x0, box.y0), math.inf
            for place in _places_beside(axes, xs, ys, box, size, 2.5 * dpi / 72):
                moved = size.translated(place[0] - size.x0, place[1] - size.y0)
                out = (max(0, box.x0 - moved.x0) + max(0, moved.x1 - box.x1) + max(0, box.y0 - moved.y0) +
                       max(0, moved.y1 - box.y1))
                cost = 50 * out + _covered(moved, obstacles, 0.5 * dpi / 72) + 500 * sum(
                    bool(moved.overlaps(other)) for other in taken)
                if cost < least:
                    best, least = place, cost
            to_best = (best[0] - size.x0, best[1] - size.y0)
            taken.append(size.translated(*to_best))
            text.set(transform=axes.transAxes, position=axes.transAxes.inverted().transform(to_best))

    @styled
    def save(self, path: str | Path, origin: Mapping[str, str] | None = None, data: bool = True) -> Path:
        """Writes the picture, PNG, PDF or SVG by its suffix, and with `data` NAME.csv with all that it shows. Returns
        the path."""
        self.finish()
        if not data:
            return saving.save(self.figure, path, origin)
        used = [one for one in self.panels if one.is_used]
        text = saving.csv_text(origin or {}, [(one.letter, one.x_title, one.y_title) for one in used],
                               [drawn for one in used for drawn in one.drawn])
        return saving.save(self.figure, path, origin, text)


def _even_texts(values: Sequence[float]) -> list[str]:
    """Numbers with as many decimals as the one that needs most."""
    texts = [number_text(value) for value in values]
    if any(set(text) & set("⁰¹²³⁴⁵⁶⁷⁸⁹") for text in texts):
        return texts
    n = max(len(text.partition(".")[2]) for text in texts)
    return [f"{value:.{n}f}".replace("-", "−") for value in values]


def _letter(k: int) -> str:
    return chr(ord("a") + k) if k < 26 else _letter(k // 26 - 1) + _letter(k % 26)


def _explanations(said: set[Any]) -> list[tuple[Any, str]]:
    """A handle and words for all that has been said of marks (Panel.explained)."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    def drawn(**look: Any) -> Any:
        return Line2D([], [], color=DARK_GREY, **look)

    bar, line = drawn(marker="|", linestyle="none", markersize=6, markeredgewidth=0.8), drawn(linewidth=0.8)
    band, grey = Patch(color=DARK_GREY, alpha=0.25, linewidth=0), Patch(color="#ececec", linewidth=0)
    crossed = tuple(drawn(marker=marker, linestyle="none", markersize=size, markeredgewidth=0.7)
                    for marker, size in (("o", 3.6), ("x", 5.5)))
    known = {"bars": (bar, panels_of.BARS), "bands": (band, panels_of.BANDS),
             panels_of.HOLLOW: (drawn(marker="o", markerfacecolor="white", linestyle="none"), panels_of.HOLLOW),
             panels_of.DASHED: (drawn(linestyle=panels_of._FINE_DASHES), panels_of.DASHED),
             panels_of.NO_ERROR: (crossed, panels_of.NO_ERROR)}
    shapes = {"grey": grey, "band": band, "line": line}
    return [found for what, found in known.items() if what in said] + [
        (shapes[kind], words) for kind, words in sorted(one for one in said if isinstance(one, tuple))]


def _covered(extent: Any, places: NDArray[Any], pad: float) -> int:
    """How many of the places are under an extent, or nearly so."""
    x, y = places.T
    return int(np.count_nonzero((x > extent.x0 - pad) & (x < extent.x1 + pad) & (y > extent.y0 - pad) &
                                (y < extent.y1 + pad)))


def _reach_higher(axes: Any, share: float) -> None:
    """Makes the y axis reach so far that the given share at its top is free."""
    low, high = axes.get_ylim()
    if axes.get_yscale() == "log":
        axes.set_ylim(low, low * (high / low) ** (1 / (1 - share)))
    else:
        axes.set_ylim(low, low + (high - low) / (1 - share))


def _places_beside(axes: Any, xs: NDArray[Any], ys: NDArray[Any], box: Any, size: Any,
                   gap: float) -> Iterator[tuple[float, float]]:
    """Lower left corners of a text of this size above and below a line, or beside a place of x, in pixels."""
    gaps = (gap, 3 * gap, 6 * gap, 12 * gap)
    if not len(xs) or not len(ys):
        at = axes.transData.transform((xs[0] if len(xs) else axes.get_xlim()[0],
                                       ys[0] if len(ys) else axes.get_ylim()[0]))
        if not len(xs):
            for x in (box.x1 - size.width - gap, box.x0 + gap, (box.x0 + box.x1 - size.width) / 2):
                yield x, at[1] + gap
                yield x, at[1] - gap - size.height
        else:
            for y in (box.y1 - size.height - gap, box.y0 + gap, (box.y0 + box.y1 - size.height) / 2):
                yield at[0] + gap, y
                yield at[0] - gap - size.width, y
        return
    with np.errstate(all="ignore"):
        line = axes.transData.transform(np.column_stack([xs, ys]))
    inside = line[np.all(np.isfinite(line), axis=1) & (line[:, 0] >= box.x0 - 1) & (line[:, 0] <= box.x1 + 1) &
                  (line[:, 1] >= box.y0 - 1) & (line[:, 1] <= box.y1 + 1)]
    for share in (1.0, 0.85, 0.7, 0.5, 0.3, 0.15, 0.0):
        if not len(inside):
            return
        x, y = inside[int(share * (len(inside) - 1))]
        for left in (x - share * size.width, x + gap, x - gap - size.width):
            for distance in gaps:
                yield left, y + distance
                yield left, y - distance - size.height


def _fit_titles(one: Panel, renderer: Any) -> bool:
    """Breaks titles that are longer than their axes; says whether this has changed any."""
    axes = one.axes
    box = axes.get_window_extent(renderer)
    stamp = axes._right_title
    room = box.width - (stamp.get_window_extent(renderer).width + 6 * renderer.dpi / 72 if stamp.get_text() else 0)
    return any([_wrap(axes.xaxis.label, 1.02 * box.width, renderer),
                _wrap(axes.yaxis.label, (1.15 if one.sheet.rows == 1 else 1.0) * box.height, renderer, upright=True),
                _wrap(axes._left_title, room, renderer)])


def _wrap(text: Any, most: float, renderer: Any, upright: bool = False) -> bool:
    """Breaks a text into lines no longer than `most` pixels, between words, not within mathtext; says whether this has
    changed it."""
    before = text.get_text()
    content = text.shaken_whole = getattr(text, "shaken_whole", before)

    def length() -> float:
        extent = text.get_window_extent(renderer)
        return float(extent.height if upright else extent.width)

    text.set_text(content)
    if not content or "\n" in content or length() <= most:
        return before != content
    words = _words(content)
    for n_lines in (2, 3):
        best: tuple[float, str] | None = None
        for cut in itertools.combinations(range(1, len(words)), n_lines - 1) if len(words) < 15 else ():
            lines = [" ".join(words[a:b]) for a, b in zip((0, *cut), (*cut, len(words)))]
            text.set_text("\n".join(lines))
            if best is None or length() < best[0]:
                best = (length(), text.get_text())
        if best is None:
            break
        text.set_text(best[1])
        if best[0] <= most:
            break
    return before != text.get_text()


def _words(content: str) -> list[str]:
    """Words; a space within $...$, beside "=" or between a number and its unit does not part them, and a unit stays
    with other words only by its brackets."""
    parts = content.split("$")
    parts[::2] = [re.sub(r" (?==)|(?<==) |(?<=[0-9]) (?=(?:mm|s|Hz|µs)\b)", "\u00a0", part) for part in parts[::2]]
    return re.findall(r"(?:[^ $]|\$[^$]*(?:\$|$))+", "$".join(parts))
