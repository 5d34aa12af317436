"""The runs of a study, by the set (the sweep) that asked for them, and numbers at their state points."""
import contextlib
import json
import math
from collections import Counter
from contextvars import ContextVar
from dataclasses import replace
from typing import Any, Callable, Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ..errors import UnknownName
from ..estimate import NAN, Estimate, derived, replica_mean
from ..plots.series import grouped, mean_curve
from ..run import Run

PACKING, LENGTH, SIDE, ASPECT = "rods.area_fraction", "rods.length", "box.side", "box.aspect"
END, GAP, GAMMA, FREQUENCY, BEADS = ("rods.end_diameter", "box.gap", "plates.gamma", "plates.frequency", "rods.beads")

#: The paper's box [mm]. A narrower box orders more easily: there order is no sign of order in the paper's; disorder is.
PAPERS_BOX = 83.7

#: A drift of S by less than this leaves the other averages of a run what they are.
SMALL_DRIFT = 0.05


def key_of(run: Run, path: str) -> float:
    """A key of the scene as a number; NaN where there is none. An area fraction that was not swept is the multiple of
    0.05 that was asked for, where whole rods come within 0.004 of it."""
    value = run.key(path)
    if not isinstance(value, (int, float)):
        return NAN
    if path == PACKING and path not in run.parameters:
        nearest = round(value * 20) / 20
        return nearest if abs(value - nearest) < 0.004 else float(value)
    return float(value)


def box_of(run: Run) -> tuple[float, float]:
    """The sides of the box along x, which the rods are along at the start, and along y [mm]."""
    side, aspect = key_of(run, SIDE), key_of(run, ASPECT)
    return side, side * (aspect if math.isfinite(aspect) else 1.0)


def box_text(run: Run) -> str:
    """The box in words: "33.5 mm" of a square, "21 × 126 mm" of another."""
    x, y = box_of(run)
    return f"{x:.3g} mm" if x == y else f"{x:.3g} × {y:.3g} mm"


def is_from_a_fluid(run: Run) -> bool:
    """Whether the run goes on from another one, in which the rows of its start have melted."""
    return run.summary.get("start") is not None


def number_of(run: Run, name: str) -> Estimate:
    """A number of a run. One that does not know whether it is steady, such as a diffusion constant, is as steady as its
    run."""
    if name not in run.numbers:
        return Estimate(reason="not measured")
    estimate = run.numbers[name]
    if estimate.steady is None and not math.isfinite(estimate.drift_error):
        return replace(estimate, steady=_is_steady(run))
    return estimate


def _is_steady(run: Run) -> bool | None:
    """Whether a run says so; where it cannot tell, True if S drifts by less than SMALL_DRIFT with two errors to spare.
    """
    return run.steady if run.steady is not None else True if hardly_drifts(run.numbers.get("S", Estimate())) else None


def hardly_drifts(order: Estimate) -> bool:
    """Whether S drifts by less than SMALL_DRIFT with two errors to spare."""
    return abs(order.drift) + 2 * order.drift_error < SMALL_DRIFT


#: Some runs, and a number that was taken from them.
Read = tuple["Runs", Estimate]
_reads: ContextVar[list[Read] | None] = ContextVar("_reads", default=None)


@contextlib.contextmanager
def reads() -> Iterator[list[Read]]:
    """All that is taken from runs meanwhile and was measured, so that a verdict can say what it stands on."""
    found: list[Read] = []
    before = _reads.set(found)
    try:
        yield found
    finally:
        _reads.reset(before)


def mean(estimates: Sequence[Estimate]) -> Estimate:
    """The mean over replicas (`replica_mean`), with an error to judge by: where they scatter by more than their own
    errors allow, by chi square at 5 %, only their scatter counts, as if they had none.

    Whether it is steady is asked of all of them together: of the mean of their drifts, where all have one, for of many
    runs some drift by chance.
    """
    known = [estimate for estimate in estimates if estimate.is_known]
    found = replica_mean(known or estimates)
    own = math.fsum(estimate.error**2 for estimate in known)
    if len(known) > 1 and math.isfinite(own):
        scatter = math.fsum((estimate.value - found.value) ** 2 for estimate in known)
        if scatter * len(known) > own * stats.chi2.ppf(0.95, len(known) - 1):
            alone = replica_mean(replace(estimate, error=NAN) for estimate in known)
            found = replace(found, error=alone.error, dof=alone.dof)
    if math.isfinite(found.drift) and math.isfinite(found.drift_error):
        return replace(found, steady=abs(found.drift) <= 2 * found.drift_error)
    return found


def _measured(value: Callable[[Run], Estimate], run: Run) -> Estimate:
    """What a function makes of a run; it need not ask whether the run has what it is made of."""
    try:
        return value(run)
    except UnknownName:
        return Estimate(reason="not measured")


class Runs(list[Run]):
    """Some runs: those of a set, of a state point."""

    def where(self, path: str, value: float) -> "Runs":
        return Runs(run for run in self if abs(key_of(run, path) - value) < 1e-6 * max(1.0, abs(value)))

    def beyond(self, path: str, value: float) -> "Runs":
        """The runs in which a key is larger than that."""
        return Runs(run for run in self if key_of(run, path) > value)

    def at(self, length: float | None = None, packing: float | None = None, side: float | None = None,
           end: float | None = None, gap: float | None = None) -> "Runs":
        """The runs with these keys [mm]."""
        found = self
        for path, value in ((LENGTH, length), (PACKING, packing), (SIDE, side), (END, end), (GAP, gap)):
            if value is not None:
                found = found.where(path, value)
        return found

    def values(self, path: str) -> list[float]:
        """The values of a key, rising."""
        return sorted({round(key_of(run, path), 9) for run in self if math.isfinite(key_of(run, path))})

    def largest(self, path: str = SIDE) -> "Runs":
        values = self.values(path)
        return self.where(path, values[-1]) if values else self

    def widest(self) -> "Runs":
        """Those in the box that is widest across the director, into which most layers fit."""
        width = max((box_of(run)[1] for run in self), default=0.0)
        return Runs(run for run in self if box_of(run)[1] > 0.99 * width)

    def number(self, name: str) -> Estimate:
        """The mean of a number over these runs; the runs in which it could not be measured do not count."""
        return self.of(lambda run: number_of(run, name))

    def of(self, value: Callable[[Run], Estimate]) -> Estimate:
        """The mean of what a function makes of each run. What does not know its own drift is as steady as S is, in all
        of these runs together."""
        found = mean([_measured(value, run) for run in self])
        noted = _reads.get()
        if noted is not None and found.is_known:
            noted.append((self, found))
        if found.is_known and found.steady is not True and not math.isfinite(found.drift):
            order = mean([run.numbers.get("S", Estimate()) for run in self])
            if math.isfinite(order.drift_error):
                return replace(found, steady=True if order.steady or hardly_drifts(order) else found.steady)
        return found

    def points(self, path: str, name: str | Callable[[Run], Estimate]) -> "list[tuple[float, Estimate]]":
        """(value of a key, number) at each value of the key that has one."""
        return points_of(self, path, lambda here: here.number(name) if isinstance(name, str) else here.of(name))

    def curve(self, name: str) -> "tuple[NDArray[Any], NDArray[Any], NDArray[Any]] | None":
        """(x, mean, error) of an array over these runs, at the places of the longest; None where none has it."""
        found = [run.arrays[name] for run in self if name in run.arrays and run.arrays[name].axis is not None]
        if not found:
            return None
        n = min(len(array) for array in found)
        x = np.asarray(found[0].axis)[:n]
        same = [array for array in found if np.allclose(np.asarray(array.axis)[:n], x, rtol=1e-3)]
        values = [np.asarray(array)[:n] for array in same]
        middle, error = mean_curve(values, [None if array.error is None else np.asarray(array.error)[:n]
                                            for array in same])
        return x, middle, np.full(n, NAN) if error is None else error


def by(runs: Runs, *paths: str) -> list[Runs]:
    """The runs at each combination of the values of some keys, in rising order."""
    if not paths:
        return [runs] if runs else []
    return [found for value in runs.values(paths[0]) for found in by(runs.where(paths[0], value), *paths[1:])]


def points_of(runs: Runs, path: str, of: Callable[[Runs], Estimate]) -> list[tuple[float, Estimate]]:
    """(value of a key, what a function makes of the runs there) at each value of the key where that is known."""
    found = [(value, of(runs.where(path, value))) for value in runs.values(path)]
    return [(value, estimate) for value, estimate in found if estimate.is_known]


def of_newest_physics(runs: Iterable[Run]) -> list[Run]:
    """Of the runs of each point those of the newest physics: what different ones computed is never averaged."""
    members = [(json.dumps(run.parameters, sort_keys=True),
                int((run.summary.get("versions") or {}).get("physics") or 0), run) for run in runs]
    newest = {point: physics for point, physics, _ in sorted(members, key=lambda member: member[1])}
    return [run for point, physics, run in members if physics == newest[point]]


class Evidence:
    """Runs by set, of each point those of the newest physics. Where a set has no more runs of a finer time step than of
    the others these are its `controls`.

    `runs` are ArchivedRuns, which know their sweeps; the scale is what stands behind the last dash of a sweep's name.
    """

    def __init__(self, runs: Iterable[Run]) -> None:
        self._sets: dict[str, Runs] = {}
        self.controls: dict[str, Runs] = {}
        for name, members in grouped((sweep.rpartition("-")[0] or sweep, run) for run in runs
                                     for sweep in getattr(run, "sweeps", [])):
            members = of_newest_physics(members)
            steps = Counter(key_of(run, "time.step") for run in members)
            usual = max(steps, key=lambda step: (steps[step], step))
            self._sets[name] = Runs(run for run in members if key_of(run, "time.step") >= usual * 0.999)
            self.controls[name] = Runs(run for run in members if key_of(run, "time.step") < usual * 0.999)

    def __getitem__(self, name: str) -> Runs:
        return self._sets.get(name, Runs())

    def joined(self, *names: str) -> Runs:
        """The runs of several sets, each trajectory once: two sets may have measured different things on the same."""
        seen: dict[str, Run] = {}
        for name in names:
            for run in self[name]:
                seen.setdefault(run.summary.get("state_hash") or run.id, run)
        return Runs(seen.values())

    @property
    def sets(self) -> list[str]:
        return list(self._sets)

    @property
    def everything(self) -> Runs:
        seen = {run.id: run for runs in (*self._sets.values(), *self.controls.values()) for run in runs}
        return Runs(seen.values())


def place_on(axis: NDArray[Any], x: float) -> int | None:
    """Index of the point of a rising axis that is nearest to x. None where x lies beyond an end of the axis by more
    than half of the step there, or is not known: a curve says nothing of places that it does not reach."""
    if not len(axis) or not math.isfinite(x):
        return None
    first, last = (abs(axis[1] - axis[0]), abs(axis[-1] - axis[-2])) if len(axis) > 1 else (0.0, 0.0)
    within = axis[0] - first / 2 <= x <= axis[-1] + last / 2
    return int(np.argmin(abs(axis - x))) if within else None


def crossing(points: list[tuple[float, Estimate]], level: float) -> Estimate:
    """Where points pass a level from below for the first time, on the straight line between the neighbours."""
    for (x0, low), (x1, high) in zip(points, points[1:]):
        if low.value < level <= high.value:
            part = (level - low.value) / (high.value - low.value)
            slope = (high.value - low.value) / (x1 - x0)
            return derived(x0 + part * (x1 - x0), [(-(1 - part) / slope, low), (-part / slope, high)])
    return Estimate(reason="not passed")


def mean_of_places(values: NDArray[Any], errors: NDArray[Any], run: Run) -> Estimate:
    """The mean of a curve over several places. Its error is the mean of theirs, as if they went up and down together,
    which is the most it can be. It is as steady as its run."""
    good = np.isfinite(values)
    if not good.any():
        return Estimate(reason="not measured")
    return Estimate(float(np.mean(values[good])), float(np.mean(errors[good])), _is_steady(run))


def mean_over(run: Run, name: str, places: Callable[[NDArray[Any]], Any]) -> Estimate:
    """The same of an array, over those places that are chosen from its axis."""
    array = run[name]
    chosen = places(np.asarray(array.axis))
    return mean_of_places(np.asarray(array)[chosen], np.asarray(array.error)[chosen], run)
