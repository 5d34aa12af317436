"""What the time step does to the numbers that the paper reports, and what these cost: from the study's controls.

Some of the study's sets have, beside the runs at `accuracy` = "desk" (16 us), one run of the same scene at "paper"
(4 us). Their differences say what the longer step does; the errors and CPU times of both say how long a run must be.
"""
import math
from dataclasses import dataclass
from typing import Any, Callable, Iterable

from ..estimate import NAN, Estimate, derived
from ..plots.series import grouped
from ..run import Run
from .evidence import BEADS, END, FREQUENCY, GAMMA, GAP, LENGTH, PACKING, SIDE, Evidence, Runs, key_of, number_of
from .rules import judged_error, markdown, text

_SCENE = (LENGTH, PACKING, SIDE, END, GAP, GAMMA, FREQUENCY, BEADS, "plates.inclination")
_WHERE = ("ℓ", "φ", "box", "gap", "Γ", "runs")


@dataclass(frozen=True)
class Pair:
    """The same scene at both steps; `paper` may be without runs."""

    desk: Runs
    paper: Runs

    @property
    def where(self) -> list[str]:
        """The scene, as cells of a table: length, area fraction, side of the box, gap, strength of shaking; runs."""
        run = self.desk[0]
        return [f"{run.key(LENGTH):g} mm", f"{key_of(run, PACKING):.3g}", f"{run.key(SIDE):g} mm",
                f"{key_of(run, GAP):g} mm", f"{run.key(GAMMA):g}", f"{len(self.desk)} + {len(self.paper)}"]


def pairs(evidence: Evidence) -> list[Pair]:
    """Each scene that was run at both steps, for equally long, by length and area fraction."""
    controls = _by_scene(run for runs in evidence.controls.values() for run in runs)
    usual = _by_scene(evidence.joined(*evidence.sets))
    found = []
    for scene, paper in sorted(controls.items()):
        time = paper[0].summary["sim_seconds"]
        desk = Runs(run for run in usual.get(scene, Runs())
                    if math.isclose(run.summary["sim_seconds"], time, rel_tol=0.05))
        if desk:
            found.append(Pair(desk, paper))
    return found


def layered(evidence: Evidence) -> list[Pair]:
    """Each scene whose runs at 16 us know theta_m with its error, which none at 4 us does so far."""
    known = {scene: Runs(run for run in runs if number_of(run, "theta_m_deg").error > 0)
             for scene, runs in _by_scene(evidence.joined(*evidence.sets)).items()}
    return [Pair(runs, Runs()) for _, runs in sorted(known.items()) if runs]


def _by_scene(runs: Iterable[Run]) -> dict[tuple[Any, ...], Runs]:
    return {scene: Runs(found) for scene, found in grouped((scene_of(run), run) for run in runs)}


def scene_of(run: Run) -> tuple[Any, ...]:
    values = [key_of(run, path) for path in _SCENE]
    return (*(round(value, 6) if math.isfinite(value) else 0.0 for value in values),
            run.key("rods.inertia") or "solid")  # keys that older runs have not are at their defaults


@dataclass(frozen=True)
class Quantity:
    """A number that the paper reports, and the error [of its unit, or as a part of it] that is good enough."""

    heading: str
    name: str
    unit: str = ""
    wanted: float = NAN
    is_part: bool = False

    def target(self, of: Estimate) -> float:
        return self.wanted * abs(of.value) if self.is_part else self.wanted

    @property
    def goal(self) -> str:
        return f"± {100 * self.wanted:g} %" if self.is_part else f"± {self.wanted:g}{self.unit}"


COMPARED = (Quantity("S", "S"), Quantity("D, long lags", "diffusion_mm2_s"),
            Quantity("D, short lags", "diffusion_short_mm2_s"), Quantity("persistence length", "persistence_length_mm"),
            Quantity("θ_m", "theta_m_deg"), Quantity("fastest along the tilt", "tilt_fastest_mm_s"))
PRICED = (Quantity("S", "S", wanted=0.005), Quantity("θ_m", "theta_m_deg", "°", 0.2),
          Quantity("D at long lags", "diffusion_mm2_s", wanted=0.05, is_part=True))


def differences(evidence: Evidence) -> str:
    """Numbers at 16 us less those at 4 us, as a table of Markdown.

    S stands as it is, all others in per cent of the magnitude at 4 us. The errors are those of both
    together; where a control knows no error, that of the runs at 16 us is taken for it, for as many seconds.
    """
    return markdown([*_WHERE, *(q.heading for q in COMPARED)],
                    [[*pair.where, *(_difference(pair, q) for q in COMPARED)] for pair in pairs(evidence)])


def _difference(pair: Pair, quantity: Quantity) -> str:
    desk, paper = pair.desk.number(quantity.name), pair.paper.number(quantity.name)
    if not (desk.is_known and paper.is_known):
        return "–"
    error = judged_error(paper)
    if not math.isfinite(error):
        error = judged_error(desk) * math.sqrt(len(pair.desk) / len(pair.paper))
    found = derived(desk.value - paper.value, [(1.0, Estimate(desk.value, judged_error(desk))),
                                               (-1.0, Estimate(paper.value, error))])
    if quantity.name == "S":
        return text(found)
    return f"{text(found * (100 / abs(paper.value)))} %"


def prices(evidence: Evidence) -> str:
    """CPU-hours of one core that a steady run takes until a number is known to what `PRICED` wants, at both steps, as a
    table of Markdown. The square of an error falls with the length of a run; what a run did not get so far is
    extrapolated from the errors that it had."""
    heads = [f"{q.heading} {q.goal}: {step}" for q in PRICED for step in ("16 us", "4 us")]
    of_pairs = pairs(evidence)
    compared = {scene_of(pair.desk[0]) for pair in of_pairs}
    of_pairs += [one for one in layered(evidence) if scene_of(one.desk[0]) not in compared]
    return markdown([*_WHERE, *heads], [[*pair.where, *(_hours(runs, q) for q in PRICED
                                                        for runs in (pair.desk, pair.paper))] for pair in of_pairs])


def _hours(runs: Runs, quantity: Quantity) -> str:
    found = [hours_until(run, number_of(run, quantity.name), quantity.target) for run in runs]
    known = [hours for hours in found if math.isfinite(hours)]
    if not known:
        return "–"
    mean = sum(known) / len(known)
    return f"{mean:.1f}" if mean >= 10 else f"{mean:.2g}"


def hours_until(run: Run, found: Estimate, target: Callable[[Estimate], float]) -> float:
    """CPU-hours after which the run's number has the error that is wanted; NaN where its error is not known."""
    if not found.is_known or not found.error > 0:
        return NAN
    return run.summary["cpu_seconds"] / 3600 * (found.error / target(found)) ** 2
