"""Many curves in one figure: which of them share a panel, and what colours tell them apart."""
import json
import operator
from typing import Any, Callable, Iterable, Mapping, Sequence, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..estimate import Estimate, replica_mean
from ..units import leading_number
from . import names, style
from .panel import Panel
from .sheet import Sheet

#: A key under which points carry what computed them, where that differs: {"": "shaken 0.1.0, physics 3"}.
VERSION = ""
#: A key under which a curve carries which way a protocol goes along it: {"way": "up"}.
WAY = "way"
_MOST_NAMED = len(style.PALETTE)
_Key = TypeVar("_Key")
_Value = TypeVar("_Value")


def label_of(parameters: Mapping[str, Any]) -> str:
    """Parameters as they are called in print, "$φ$ = 0.6, $ℓ$ = 2.5 mm"; the version as it is."""
    return ", ".join(str(value) if key in (VERSION, WAY) else names.value_label(key, value)
                     for key, value in parameters.items())


class Arrangement:
    """Points of a sweep as curves in panels. Up to seven are named in one panel. Of more one parameter is told by
    colours, with a bar where it has more than seven values, and each combination of the others has a panel.

    panels: list of (title, numbers of the points in it)
    scale:  the ColourScale, where colours are not named
    """

    def __init__(self, points: Sequence[Mapping[str, Any]]) -> None:
        self.points = [dict(point) for point in points]
        keys = list(dict.fromkeys(key for point in self.points for key in point))
        swept = [key for key in keys if len({_text(point.get(key)) for point in self.points}) > 1]
        self.scale: style.ColourScale | None = None
        self._labels: list[str] = []
        self._colours: list[Any] = []
        if len(self.points) <= _MOST_NAMED:
            self.panels = [("", list(range(len(self.points))))]
            self._labels = [label_of({key: point[key] for key in swept if key in point}) for point in self.points]
            self._colours = list(range(len(self.points)))
            return
        by_colour = self._key_of_colours(swept)
        others = [key for key in swept if key != by_colour]
        self.panels = grouped((label_of({key: point[key] for key in others if key in point}), k)
                              for k, point in enumerate(self.points))
        self._colour_by(by_colour)

    def _key_of_colours(self, swept: Sequence[str]) -> str:
        """The key with the most values among those that are numbers, or among all."""
        numeric = [key for key in swept if all(np.isfinite(leading_number(point.get(key))) for point in self.points)]
        return max(numeric or swept, key=lambda key: len({_text(point.get(key)) for point in self.points}))

    def _colour_by(self, key: str) -> None:
        values = [point.get(key) for point in self.points]
        distinct = sorted({_text(value): value for value in values}.values(),
                          key=lambda value: (leading_number(value), _text(value)))
        rank = {_text(value): k for k, value in enumerate(distinct)}
        if len(distinct) <= _MOST_NAMED:
            self._labels = [label_of({key: value}) for value in values]
            self._colours = [rank[_text(value)] for value in values]
            return
        numbers = [leading_number(value) for value in values]
        if not np.all(np.isfinite(numbers)):
            numbers = [float(rank[_text(value)]) for value in values]
        log = min(numbers) > 0 and max(numbers) / min(numbers) >= 30
        self.scale = style.ColourScale(numbers, names.axis_title(key) if key else "version", log)
        self._labels = ["" for _ in values]
        self._colours = [self.scale(number) for number in numbers]

    @property
    def is_crowded(self) -> bool:
        """Whether a panel has so many curves that marks with bars would hide each other."""
        return max(len(points) for _, points in self.panels) > 3

    def look(self, k: int) -> dict[str, Any]:
        """Label and colour of a point, as Panel.curve takes them."""
        return {"label": self._labels[k], "colour": self._colours[k]}

    def label(self, k: int) -> str:
        """All that a point is, for the data."""
        return self._labels[k] or label_of(self.points[k])

    def sheet(self, width: str | None, x: str, y: str) -> Sheet:
        """An empty figure with all panels, their titles and the colour bar; they share their axes."""
        n = len(self.panels)
        width = width or ("89mm" if n == 1 else "183mm")
        columns = min(n, max(1, int(style.inches(width) * 25.4 // 42)))
        rows = -(-n // columns)
        columns = -(-n // rows)
        sheet = style.sheet(width, rows, columns)
        for panel, (title, _) in zip(sheet.panels, self.panels):
            panel.titles(x, y, title)
        if n > 1:
            sheet.share_axes()
        if self.scale is not None:
            sheet.colourbar(self.scale, sheet.panels[:n])
        return sheet

    def panels_of(self, sheet: Sheet) -> Sequence[tuple[Panel, str]]:
        """(panel, title) of all panels that have points."""
        return [(panel, title) for panel, (title, _) in zip(sheet.panels, self.panels)]

    def each(self, sheet: Sheet) -> Sequence[tuple[Panel, int]]:
        """(panel, number of the point) of all curves, in their order."""
        return [(panel, k) for panel, (_, points) in zip(sheet.panels, self.panels) for k in points]


def grouped(pairs: Iterable[tuple[_Key, _Value]], alike: Callable[[_Key, _Key], bool] = operator.eq
            ) -> list[tuple[_Key, list[_Value]]]:
    """(key, values) of what has alike keys, the first of which stands for them, in the order in which they are met."""
    groups: list[tuple[_Key, list[_Value]]] = []
    for key, value in pairs:
        group = next((values for known, values in groups if alike(known, key)), None)
        if group is None:
            groups.append((key, [value]))
        else:
            group.append(value)
    return groups


def _text(value: Any) -> str:
    return json.dumps(value, sort_keys=True)


def mean_curve(values: Sequence[NDArray[Any]],
               errors: Sequence[NDArray[Any] | None]) -> tuple[NDArray[Any], NDArray[Any] | None]:
    """The mean of the curves of replicas over the same x, and its errors, point by point as estimate.replica_mean does;
    of one curve its own. The errors are None where none are known."""
    if len(values) == 1:
        return values[0], errors[0]
    unknown = np.full(len(values[0]), np.nan)
    own = [unknown if error is None else error for error in errors]
    means = [replica_mean(map(Estimate, *at)) for at in zip(zip(*values), zip(*own))]
    return np.array([mean.value for mean in means]), np.array([mean.error for mean in means])
