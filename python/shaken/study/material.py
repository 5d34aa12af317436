"""What figures are made of: the runs, the verdicts, and the pieces that several figures share."""
import functools
import math
from dataclasses import dataclass
from typing import Any, Callable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..archive import Snapshot
from ..estimate import Estimate
from ..plots import names, style
from ..plots.panel import Panel
from ..plots.sheet import Sheet
from ..run import Run, axes_of
from .evidence import PACKING, Evidence, Runs, points_of
from .rules import Finding
from .statements import STATEMENTS


class Material:
    """The runs of a study, what they say to each statement, and the width [mm] of the figures to be drawn."""

    def __init__(self, evidence: Evidence, width: float = 183.0) -> None:
        self.evidence, self.width = evidence, width

    @property
    def both(self) -> list[tuple[Runs, str]]:
        """Short and long rods at all packings, with their lengths."""
        return [(self.evidence["short-rods"], "ℓ = 2.5 mm"), (self.evidence["long-rods"], "ℓ = 4.5 mm")]

    @functools.cached_property
    def findings(self) -> dict[str, Finding]:
        return {statement.id: statement.check(self.evidence) for statement in STATEMENTS}

    def sheet(self, n_panels: int, height: float = 46.0, columns: int | None = None) -> Sheet:
        """An empty figure of so many panels: three beside each other on a page, two in a narrower column."""
        across = min(n_panels, columns or (3 if self.width > 150 else 2), 2 if self.width < 100 else n_panels)
        return style.sheet(f"{self.width:g}mm", math.ceil(n_panels / across), across,
                           f"{height * (0.9 if self.width < 100 else 1):g}mm")

    def stamp(self, panel: Panel, *statements: str) -> None:
        """Puts the verdicts on statements above a panel, each once."""
        words = [self.findings[name].verdict for name in statements]
        words = [word for word in dict.fromkeys(words) if word != "no data"]
        if words:
            panel.verdict(", ".join(words))


@dataclass(frozen=True)
class Figure:
    """A figure of the paper, or one beyond it.

    number: in the paper, "14"; empty for all others
    name:   "defects"
    title:  what it shows
    sets:   what it is drawn from (sets.ORDER)
    """

    number: str
    name: str
    title: str
    sets: tuple[str, ...]
    draw: Callable[[Material], Sheet]

    @property
    def id(self) -> str:
        return self.number or self.name

    @property
    def file(self) -> str:
        """The name of its files without the suffix: "fig14-defects", or "gap"."""
        return f"fig{int(self.number):02d}-{self.name}" if self.number else self.name


def shows(number: str, *sets: str, **verdicts: str) -> Callable[[Callable[[Material], Sheet]], Figure]:
    """Makes of the function below it the figure of that number, which is drawn from these sets. Its name is that of the
    function, its title the text. verdicts: of a panel, by its letter, the statements whose verdicts stand above it."""
    def figure(draw: Callable[[Material], Sheet]) -> Figure:
        def stamped(material: Material) -> Sheet:
            sheet = draw(material)
            for letter, statements in verdicts.items():
                material.stamp(next(panel for panel in sheet if panel.letter == letter), *statements.split())
            return sheet

        return Figure(number, draw.__name__.replace("_", "-"), " ".join(str(draw.__doc__).split()), sets, stamped)

    return figure


def packing_scale(*sets: Runs) -> style.ColourScale | None:
    """Colours for the area fractions of some runs."""
    values = sorted({value for runs in sets for value in runs.values(PACKING)})
    return style.ColourScale(values, names.axis_title(PACKING)) if values else None


def draw_curves(panel: Panel, runs: Runs, array: str, scale: style.ColourScale | None, path: str = PACKING, *,
                keep: Callable[[NDArray[Any], NDArray[Any]], NDArray[Any]] | None = None,
                made: Callable[..., tuple[NDArray[Any], ...]] = lambda x, y, error: (x, y, error),
                labels: bool = False, errors: bool = True, title: str | None = None) -> Panel:
    """An array against its axis, the mean over replicas, a curve for each value of a key, or what is `made` of (x, y,
    error). What `keep` leaves out within it is a gap. With a title the axes have theirs, too."""
    if title is not None:
        panel.titles(names.axis_title(axes_of(array)[-1]), names.axis_title(array), title)
    for k, value in enumerate(runs.values(path)):
        here = runs.where(path, value)
        found = here.curve(array)
        if found is None:
            continue
        x, y, error = made(*found)
        shown = keep(x, y) if keep else np.ones(len(x), dtype=bool)
        if not shown.any():
            continue
        part = slice(np.argmax(shown), len(shown) - np.argmax(shown[::-1]))
        panel.curve(x[part], np.where(shown, y, np.nan)[part], error[part] if errors else None,
                    here.number("S").steady if "S" in here[0] else True,
                    label=names.value_label(path, value) if labels else "",
                    colour=scale(value) if scale else k, look="line")
    return panel


def draw_curve(panel: Panel, runs: Runs, array: str, label: str = "", colour: Any = None, look: str = "line",
               seen: Callable[[NDArray[Any]], NDArray[Any]] | None = None, **more: Any) -> Panel:
    """An array against its axis, the mean over these runs, if one has it; `seen`: where its errors let it be seen."""
    found = runs.curve(array)
    if found is not None:
        x, y, error = found
        chosen: Any = seen(error) if seen else slice(None)
        panel.curve(x[chosen], y[chosen], error[chosen], label=label, colour=colour, look=look, **more)
    return panel


def draw_points(panel: Panel, points: Sequence[tuple[float, Estimate]], label: str = "", colour: Any = None,
                **more: Any) -> Panel:
    """Numbers against a key, with their errors; hollow where they are not known to be steady."""
    return panel.curve([at for at, _ in points], [e.value for _, e in points], [e.error for _, e in points],
                       [e.steady for _, e in points], label=label, colour=colour, look="points", **more)


def labelled(runs: Runs, path: str) -> list[tuple[Runs, str]]:
    """The runs at each value of a key, with that in print."""
    return [(runs.where(path, value), names.value_label(path, value)) for value in runs.values(path)]


def draw_against(panel: Panel, path: str, of: str | Callable[[Runs], Estimate],
                 series: Iterable[tuple[Runs, str]], title: str = "", y: str = "") -> Panel:
    """A number of the runs at each value of a key, of several series, each with its label; y: its title in place of its
    name."""
    panel.titles(names.axis_title(path), y or names.axis_title(str(of)), title)
    for k, (runs, label) in enumerate(series):
        draw_points(panel, runs.points(path, of) if isinstance(of, str) else points_of(runs, path, of), label, k)
    return panel


#: Angles to the director [degrees] and their colours: grey along it, orange and blue to its sides, dark across it.
_ANGLE_COLOURS = ((-90, "#262626"), (-45, "#08306b"), (-14, "#3f8fd2"), (0, "#dcdcdc"), (14, "#ef8a1d"),
                  (45, "#7f2704"), (90, "#262626"))


@functools.lru_cache(maxsize=1)
def angle_colours() -> Any:
    """matplotlib's ScalarMappable of angles to the director [degrees]; the two ends have one colour."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize
    colours = LinearSegmentedColormap.from_list("angle", [((a + 90) / 180, c) for a, c in _ANGLE_COLOURS], N=360)
    return ScalarMappable(Normalize(-90, 90), colours)


def draw_rods(panel: Panel, runs: Sequence[Run], title: str = "", k: int = 0, timed: bool = True,
              defects: bool = False) -> None:
    """The rods of the k-th snapshot of the first of these runs that has one, tapered as they are, coloured by their
    angle to the director, with a scale bar; `timed`: the time stands behind the title."""
    from matplotlib.collections import PolyCollection
    known = [found for run in runs if (found := getattr(run, "snapshots", []))]
    if not known:
        return
    snapshot, rods = known[0][min(k, len(known[0]) - 1)], runs[0].scene["rods"]
    if timed:
        title += f", t = {snapshot.time:.0f} s"
    width, height = snapshot.box
    images = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]) * snapshot.box
    place = (snapshot.positions[None] + images[:, None]).reshape(-1, 2)
    theta = np.tile(snapshot.theta, len(images))
    near = ((place > -rods["length"] / 2) & (place < snapshot.box + rods["length"] / 2)).all(axis=1)
    place, theta = place[near], theta[near]
    director = np.angle(np.exp(2j * snapshot.theta).mean()) / 2
    half, mid, end = rods["length"] / 2, rods["mid_diameter"] / 2, rods["end_diameter"] / 2
    along = np.array([-half, -half + end * 0.4, 0, half - end * 0.4, half, half - end * 0.4, 0, -half + end * 0.4])
    across = np.array([0, end * 0.85, mid, end * 0.85, 0, -end * 0.85, -mid, -end * 0.85])
    c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
    shapes = np.stack([place[:, :1] + c * along - s * across, place[:, 1:] + s * along + c * across], axis=-1)
    turned = np.degrees((theta - director + np.pi / 2) % np.pi - np.pi / 2)
    axes = panel.axes
    axes.add_collection(PolyCollection(list(shapes), facecolors=angle_colours().to_rgba(turned), edgecolors="#ffffff",
                                       linewidths=0.1, rasterized=len(shapes) > 2500))
    panel.titles(title=title)
    panel.has_picture = True
    axes.set(aspect="equal", xlim=(0, width), ylim=(0, height), xticks=[], yticks=[])
    if defects:
        _draw_defects(panel, snapshot, rods["length"] / 2)
    bar = next(length for length in (50, 20, 10, 5, 2, 1) if length <= width / 3)
    axes.plot([width * 0.04, width * 0.04 + bar], [width * 0.05] * 2, color="black", linewidth=2, solid_capstyle="butt",
              path_effects=_rim(4))
    axes.text(width * 0.04 + bar / 2, width * 0.07, f"{bar} mm", ha="center", va="bottom", fontsize=6,
              path_effects=_rim(2))
    panel.record("rods", snapshot.positions[:, 0], snapshot.positions[:, 1])
    panel.is_used = True


def _rim(width: float) -> list[Any]:
    from matplotlib import patheffects
    return [patheffects.withStroke(linewidth=width, foreground="white")]


def defects_of(snapshot: Snapshot, smoothing: float) -> NDArray[Any]:
    """(n, 3) x, y [mm] and charge (+-1/2) of the defects of the director field: exp(2i theta) of the rods, smoothed by
    a Gaussian of width `smoothing` [mm] on a periodic grid, turns by +-pi around them."""
    from scipy.ndimage import gaussian_filter
    per_mm = max(8, int(snapshot.box[0] / smoothing * 4)) / snapshot.box[0]
    n = np.rint(snapshot.box * per_mm).astype(int)
    at = np.minimum((snapshot.positions / snapshot.box * n).astype(int), n - 1)
    field = np.zeros(n, dtype=complex)
    np.add.at(field, (at[:, 0], at[:, 1]), np.exp(2j * snapshot.theta))
    width = smoothing / snapshot.box * n
    field = gaussian_filter(field.real, width, mode="wrap") + 1j * gaussian_filter(field.imag, width, mode="wrap")
    corner = [field, np.roll(field, -1, 0), np.roll(np.roll(field, -1, 0), -1, 1), np.roll(field, -1, 1)]
    turn = sum(np.angle(corner[(k + 1) % 4] / corner[k]) for k in range(4)) / (4 * np.pi)
    nodes = np.argwhere(np.abs(turn) > 0.25)
    places = (nodes + 1.0) / n * snapshot.box % snapshot.box
    return np.column_stack([places, np.round(2 * turn[tuple(nodes.T)]) / 2])


def _draw_defects(panel: Panel, snapshot: Snapshot, smoothing: float) -> None:
    found = defects_of(snapshot, smoothing)
    for charge, marker, colour, label in ((0.5, "o", "#d4006a", "+1/2"), (-0.5, "^", "#00a0a0", "−1/2")):
        here = found[found[:, 2] == charge]
        panel.axes.scatter(here[:, 0], here[:, 1], s=26, marker=marker, facecolor=colour, edgecolor="white",
                           linewidths=0.8, zorder=4)
        panel.record(f"defects {label}", here[:, 0], here[:, 1])


def draw_snapshots(sheet: Sheet, shown: Sequence[tuple[Sequence[Run], str]], **how: Any) -> None:
    """The rods of several runs, each with its title, as draw_rods has them, in the first panels of a figure, and what
    their colours mean."""
    for panel, (runs, title) in zip(sheet, shown):
        draw_rods(panel, runs, title, **how)
    if panels := [panel for panel in sheet.panels[:len(shown)] if panel.is_used]:
        bar = sheet.colourbar(angle_colours(), panels, "angle to the director (°)")
        bar.set_ticks([-90, -45, 0, 45, 90])
