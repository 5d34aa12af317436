"""Where rods order, how sharply, from which start and in which box."""
import math
from collections import Counter
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from ..estimate import Estimate
from ..run import Run
from . import scaling
from .evidence import (GAMMA, LENGTH, PACKING, PAPERS_BOX, SIDE, SMALL_DRIFT, Evidence, Runs, by, crossing,
                       hardly_drifts, key_of, points_of)
from .late_lags import long_time_diffusion
from .rules import (NO, NOT_RUN, YES, Answer, Finding, above, all_of, below, close_to, conclude, doubt, larger, listed,
                   needed, refutable, text, trend, unknown)
from .statement import HARDLY_FAILS, states
from .structure_checks import far_g2

#: <S> above which a state counts as ordered, as the paper draws the line.
ORDERED = 0.5
#: Packings from which on the end of a rise is judged.
DENSE = 0.8


def phase_diagram(evidence: Evidence) -> Runs:
    """The runs of the phase diagram: all lengths and packings, in the box that most of these runs have."""
    runs = evidence.joined("long-rods", "short-rods", "crossings", "phases")
    sides = Counter(key_of(run, SIDE) for run in runs)
    return runs.at(side=sides.most_common(1)[0][0]) if sides else runs


def transition(runs: Runs) -> Estimate:
    """The area fraction at which <S> passes 0.5."""
    return crossing(runs.points(PACKING, "S"), ORDERED)


@states("steady-state", "2", "Rods start aligned, S(0) = 1, and are steady after 400 to 600 s (ℓ = 4.5 mm)")
def steady_after_the_start(evidence: Evidence) -> Finding:
    longest_wait = 600.0  # [s], the paper's
    runs = evidence["long-rods"]
    answers, steady, wait = [], 0, 0.0
    for packing in runs.values(PACKING):
        here = runs.at(packing=packing)
        aligned = all(float(run["/order/order"][0]) > 0.95 for run in here if "/order/order" in run)
        s = here.number("S")
        start = max(float(run.summary.get("t_steady_s") or 0) for run in here)
        if not aligned:
            answer = NO
        elif s.steady and hardly_drifts(s):
            answer = YES if start <= longest_wait else NO
            steady, wait = steady + 1, max(wait, start)
        elif s.steady:
            answer = unknown(f"a drift of {SMALL_DRIFT:g} cannot be excluded")
        else:
            followed = max(float(run.summary["sim_seconds"]) for run in here)
            answer = NO if followed > 1000 and s.steady is False else unknown("a run still relaxes")
        answers.append(answer.placed(f"{packing:g}"))
    return conclude(answers, f"S(0) = 1; no drift of S by {SMALL_DRIFT:g} or more from the first half of what was "
                    f"measured to the second at {steady} of {len(answers)} packings; measured from {wait:.0f} s on at "
                    "the latest", everywhere=True)


@states("ordered", "3", "Long rods (ℓ = 4.5 mm) at area fraction 0.75 are ordered, S about 0.9",
        "in a box narrower than the paper's, which orders more easily")
def ordered_when_dense(evidence: Evidence) -> Finding:
    runs = needed(evidence["long-rods"].at(packing=0.75))
    s = runs.number("S")
    return conclude([close_to(s, 0.9, 0.05)], f"S = {text(s)}")


@states("disordered", "3", "At 0.45 they are not: ⟨S⟩ < 0.5, and nothing of it far away or in larger boxes")
def disordered_when_dilute(evidence: Evidence) -> Finding:
    everywhere = evidence.joined("long-rods", "dilute").at(length=4.5, packing=0.45)
    runs = needed(everywhere.largest(SIDE))
    s, far, power = runs.number("S"), runs.of(far_g2), scaling.power(everywhere)
    # Whatever its correlations, a disordered state of N >> 1 independent regions has S ~ 1/sqrt(N), that is 1/L; an
    # ordered one has the same S in every box.
    larger = below(power, -0.5) if len(everywhere.values(SIDE)) > 1 else unknown(NOT_RUN)
    return conclude([below(s, ORDERED).placed("S"), close_to(far, 0, 0.05).placed("G₂ far away"),
                     larger.placed("larger boxes")],
                    f"S = {text(s)} in {key_of(runs[0], SIDE):.1f} mm; G₂ at half a box {text(far)}; S ~ Lˣ with "
                    f"x = {text(power)} (disorder: −1)")


@states("short", "3", "Rods shorter than 3.5 mm do not order at any packing",
        "a narrow box orders its rods: there only disorder counts")
def short_rods_do_not_order(evidence: Evidence) -> Finding:
    runs = evidence.joined("short-rods", "phases", "no-order", "diffusion", "mechanism")
    answers, found = [], []
    for length in (2.5, 3.0):
        largest: tuple[Estimate, float, float] | None = None
        widest = largest
        if runs and not runs.at(length):
            answers.append(unknown(NOT_RUN).placed(f"ℓ = {length:g} mm"))
        for packing in runs.at(length).values(PACKING):
            here = runs.at(length, packing).largest(SIDE)
            s, side = here.number("S"), key_of(here[0], SIDE)
            answer = below(s, ORDERED)
            if answer.word is False and side < PAPERS_BOX:
                answer = unknown("order in a box narrower than the paper's")
            answers.append(answer.placed(f"ℓ = {length:g} mm, φ = {packing:g}"))
            if largest is None or s.value > largest[0].value:
                largest = (s, packing, side)
            if side >= PAPERS_BOX:
                widest = (s, packing, side)
        for which, of in (("largest S", largest), ("densest in the paper's box: S", widest)):
            if of:
                found.append(f"ℓ = {length:g} mm, {which} = {text(of[0])} at φ = {of[1]:g}, in {of[2]:.1f} mm")
    return conclude(answers, "; ".join(found), everywhere=True)


@states("transition", "3", "The area fraction at which order sets in falls with the length")
def transition_falls_with_length(evidence: Evidence) -> Finding:
    runs = phase_diagram(evidence)
    points = [(length, transition(runs.at(length))) for length in (3.5, 4.0, 4.5) if runs.at(length)]
    passed = needed([(length, phi) for length, phi in points if phi.is_known])
    return conclude([trend(points, rising=False)], "S = 0.5 is passed at φ = " + listed(passed, "ℓ", ""))


@states("saturates", "3", "⟨S⟩ of rods longer than 3.5 mm rises with packing to about 1",
        "whether it rises continuously takes runs from disorder too, which these are not; the box is narrower than the "
        "paper's")
def saturates(evidence: Evidence) -> Finding:
    answers, found = [], []
    for length in (4.0, 4.5):
        points = phase_diagram(evidence).at(length).points(PACKING, "S")
        if len(points) < 2:
            if phase_diagram(evidence):
                answers.append(unknown(NOT_RUN).placed(f"ℓ = {length:g} mm"))
            continue
        answers.append(trend(points, rising=True).placed(f"rises, ℓ = {length:g} mm"))
        # the crossings' runs end where order has hardly begun
        last = close_to(points[-1][1], 0.95, 0.1) if points[-1][0] >= DENSE else unknown(NOT_RUN)
        answers.append(last.placed(f"to about 1, ℓ = {length:g} mm"))
        found.append(f"ℓ = {length:g} mm: from {text(points[0][1])} at {points[0][0]:g} to {text(points[-1][1])} at "
                     f"{points[-1][0]:g}")
    return conclude(answers, "; ".join(found))


@states("longer-order", "3", "At the same area fraction rods order when they are made longer",
        "S grows by a factor of ten; the box is narrower than the paper's", HARDLY_FAILS)
def longer_rods_order(evidence: Evidence) -> Finding:
    answers, found = [], []
    for packing in (0.60, 0.70):
        points = phase_diagram(evidence).at(packing=packing).points(LENGTH, "S")
        if len(points) < 2:
            continue
        answers += [trend(points, rising=True).placed(f"S grows with length at φ = {packing:g}"),
                    below(points[0][1], ORDERED).placed(f"disorder of the shortest at φ = {packing:g}"),
                    above(points[-1][1], ORDERED).placed(f"order of the longest at φ = {packing:g}")]
        found.append(f"φ = {packing:g}: S = {listed(points, 'ℓ')}")
    return conclude(answers, "; ".join(found))


@states("transition-size", "scaling", "The area fraction at which order sets in rises with the box",
        "S of a finite system always falls with the box", HARDLY_FAILS)
def transition_rises_with_size(evidence: Evidence) -> Finding:
    runs = evidence.joined("long-rods", "size").at(length=4.5)
    points = [(side, transition(runs.at(side=side))) for side in runs.values(SIDE)
              if len(runs.at(side=side).values(PACKING)) > 1]
    needed(points, 2)
    passed = [(side, phi) for side, phi in points if phi.is_known]
    return conclude([trend(points, rising=True)], "S = 0.5 is passed at φ = " + listed(passed, "L", ""))


@states("long-range", "scaling", "The order is long-range",
        "S(L) against what the waves of the director make of it without a free parameter. That S falls so in these "
        "boxes does not show that it never levels off in wider ones")
def long_range(evidence: Evidence) -> Finding:
    """Whether S stays as the box grows and does not fall as the director's waves would make it fall (yes), or does fall
    (no), at the packings at which rods are ordered in the largest box."""
    everything = scaling.boxes(evidence)
    answers, found = [], []
    for packing in everything.values(PACKING):
        runs = Runs(run for run in everything.at(packing=packing) if key_of(run, SIDE) > scaling.WIDE)
        sides = runs.values(SIDE)
        if len(sides) < 2 or above(runs.largest().number("S"), ORDERED).word is False or packing < 0.54:
            continue
        power, predicted = scaling.power(runs), scaling.predicted(runs.largest())
        falls, stays = below(power, 0), larger(power, predicted)
        # over one octave a fall that ends looks like one that goes on
        too_few = "" if sides[-1] > 3.9 * sides[0] else "boxes of one octave only"
        answers.append((unknown(too_few) if too_few else NO if falls.word else YES if stays.word else unknown(
            doubt(power) or "the errors are too large")).placed(f"{packing:g}"))
        found.append(f"x = {text(power)} at φ = {packing:g}, {sides[0]:.0f} to {sides[-1]:.0f} mm (by the waves: "
                     f"{text(predicted)})")
    return conclude(answers, "S ~ Lˣ with " + "; ".join(found))


def pooled_density(runs: Runs) -> tuple[NDArray[Any], NDArray[Any], float]:
    """P[S] of several runs together, weighted by their independent samples: (S, density, samples)."""
    known = [(run["/order/pdf/density"], run["S"].n_eff) for run in runs
             if "/order/pdf/density" in run and math.isfinite(run["S"].n_eff)]
    samples = sum(weight for _, weight in known)
    if not samples:
        return np.zeros(0), np.zeros(0), 0.0
    total = sum(np.asarray(density) * weight for density, weight in known)
    return np.asarray(known[0][0].axis), total / samples, samples


def n_peaks(density: NDArray[Any]) -> int:
    """Maxima of a density, smoothed over five places, that stand at least a third of the largest one above the valleys
    beside them."""
    if not len(density):
        return 0
    smooth = np.convolve(density, np.ones(5) / 5, mode="same")
    ranked = smooth * (1 + 1e-9 * np.arange(len(smooth)))  # of equal maxima each would stand above the valley between
    return len(find_peaks(np.pad(ranked, 1), prominence=smooth.max() / 3)[0])


@states("unimodal", "4", "P[S] has one peak at every packing (ℓ = 4.5 mm)",
        "independent samples of all replicas are added up; 50 are asked for")
def one_peak(evidence: Evidence) -> Finding:
    answers, found = [], []
    runs = evidence["long-rods"]
    for packing in runs.values(PACKING):
        here = runs.at(packing=packing)
        _, density, samples = pooled_density(here)
        if not samples and doubt(here.number("S")):
            answer = unknown(doubt(here.number("S")))
        elif here.number("S").steady is False:
            answer = unknown("a run still relaxes")
        elif samples < 50:
            answer = unknown("too few independent samples for the shape of P[S]")
        else:
            answer = YES if n_peaks(density) == 1 else NO
        answers.append(answer.placed(f"{packing:g}"))
        found.append(f"{n_peaks(density)} ({samples:.0f}) at {packing:g}")
    return conclude(answers, "peaks (independent samples): " + ", ".join(found), everywhere=True)


@states("broadest", "4", "S fluctuates most near the transition")
def broadest_at_the_transition(evidence: Evidence) -> Finding:
    runs = evidence["long-rods"]
    points, phi = needed(runs.points(PACKING, "S_std"), 3), transition(runs)
    if not phi.is_known:
        return Finding()
    place, widest = max(points, key=lambda point: point[1].value)
    farther = [larger(widest, estimate) for at, estimate in points if abs(at - place) > 0.051]
    open_ = [answer for answer in farther if answer.word is None]
    # as near as the steps of the sweep allow
    return conclude(open_[:1] or [close_to(phi, place, 0.055)],
                    f"S scatters most, by {text(widest)}, at φ = {place:g}; the transition is at {text(phi)}")


def angle_to_side(run: Run) -> Estimate:
    """Angle between the director and the nearest side of the box [degrees], the mean of eight blocks of the steady
    state. Its drift is that of a straight line through them, and its error comes from their scatter about it."""
    angle, n = run["/order/director_rad"], 8
    late = np.asarray(angle)[np.asarray(angle.axis) >= float(run.summary.get("t_steady_s") or 0)]
    if len(late) < n:
        return Estimate(reason="too short")
    mean = np.angle(np.exp(2j * late).mean()) / 2
    around = [np.degrees(np.angle(np.exp(2j * (block - mean)).mean()) / 2) for block in np.array_split(late, n)]
    place = np.arange(n) - (n - 1) / 2
    slope = float(np.dot(place, around) / np.dot(place, place))
    scatter = math.sqrt(float(np.sum((around - np.mean(around) - slope * place) ** 2)) / (n - 2))
    away = abs(math.degrees(mean)) % 90
    sign = math.copysign(1, math.degrees(mean)) * (1 if away < 45 else -1)
    drift, drift_error = sign * slope * n / 2, scatter / math.sqrt(float(np.dot(place, place))) * n / 2
    return Estimate(min(away, 90 - away), scatter / math.sqrt(n), abs(drift) < 2 * drift_error, drift=drift,
                    drift_error=drift_error, unit="deg")


@states("oblique", "steady", "ℓ = 3.5 mm at 0.85 orders along an oblique axis",
        "asked of runs that start turned by 30 degrees: whether such an axis lasts. Those that start along a side stay "
        "along it, so that none is seen to come about")
def oblique_axis(evidence: Evidence) -> Finding:
    turned = evidence["turned"].at(length=3.5, packing=0.85)
    straight = evidence["layer-trends"].at(length=3.5, packing=0.85)
    if not turned:
        needed(straight)
        return conclude([unknown(NOT_RUN)],
                        f"started along a side: S = {text(straight.number('S'))}, director "
                        f"{text(straight.of(angle_to_side))}° from it")
    s, angle = turned.number("S"), turned.of(angle_to_side)
    found = f"started at 30°: S = {text(s)}, director {text(angle)}° from the nearest side"
    along_a_side = below(straight.of(angle_to_side), 10) if straight else unknown(NOT_RUN)
    if straight:
        found += f"; started along a side: {text(straight.of(angle_to_side))}°"
    comes_about = "; none comes about in rods that start along a side" if along_a_side.word else ""
    return refutable(all_of([above(s, ORDERED), above(angle, 10)]), found, "such an axis lasts" + comes_about)


@states("activity", "shaking", "Γ is a measure of the activity, and at Γ = 0 there is none",
        "at Γ = 0: that the plates give no energy and what the rods had at the start falls; rolling rods go on",
        HARDLY_FAILS)
def activity(evidence: Evidence) -> Finding:
    runs = evidence["shaking"].at(length=2.5)
    still = runs.where(GAMMA, 0.0)
    d = needed(points_of(runs.beyond(GAMMA, 0), GAMMA, long_time_diffusion), 2)
    answers: list[Answer] = [trend(d, rising=True).placed("D grows with Γ")]
    found = f"D = {listed(d, 'Γ', ' mm²/s')}"
    if not still:
        answers.append(unknown(NOT_RUN).placed("Γ = 0"))
    else:
        energy = still[0].summary["energy_pJ"]
        answers.append((YES if energy["given_by_plates"] == 0 and energy["left"] < energy["start"] else NO)
                       .placed("Γ = 0"))
        found += (f"; at Γ = 0 the plates give {energy['given_by_plates']:g} pJ, and "
                  f"{100 * energy['left'] / energy['start']:.2g} % of the energy of the start is left")
    return conclude(answers, found)


@states("forgetting", "2", "Velocities forget the start within about a period of the plates",
        "asked of the velocities in the plane, from one to three periods after the start")
def forgets_the_start(evidence: Evidence) -> Finding:
    """Whether the kinetic temperature in the plane is, within a tenth, what it is in the end, from one to three periods
    of the plates after the start."""
    answers, found = [], []

    def over_the_end(run: Run, name: str) -> Estimate:
        t = run[name]
        time, values = np.asarray(t.axis), np.asarray(t)
        first = values[(time >= 0.005) & (time < 0.015)]
        late = values[time >= time[-1] / 2]
        return Estimate(float(first.mean() / late.mean()), steady=True) if len(first) else Estimate(reason="too rare")

    for runs in by(evidence["forgetting"], LENGTH, PACKING):
        plane, vertical = (runs.of(partial(over_the_end, name=f"/temperatures/{name}_pJ"))
                           for name in ("horizontal", "vertical"))
        where = f"ℓ = {key_of(runs[0], LENGTH):g} mm, φ = {key_of(runs[0], PACKING):g}"
        answers.append(close_to(plane, 1, 0.1).placed(where))
        found.append(f"{text(plane)} in the plane and {text(vertical)} across it at {where}")
    return conclude(answers, "kinetic temperature over that of the end: " + "; ".join(found))
