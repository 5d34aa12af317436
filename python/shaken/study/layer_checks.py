"""Layers at +-theta_m: whether there are any, and how angle and wavelength depend on rods, packing, gap and box."""
import math
from dataclasses import replace
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ..estimate import Estimate, mean_of_samples, student_factor
from ..plots import names
from ..run import Run
from .evidence import (END, GAP, LENGTH, PACKING, SIDE, Evidence, Runs, box_text, by, is_from_a_fluid, key_of,
                       number_of, place_on, points_of)
from .layer_wavelength import TWO_PEAKS, mean_wavelength, wavelength
from .order_checks import ORDERED
from .rules import (AGREES, CONSISTENT, NO, NOT_RUN, YES, Answer, Finding, above, all_of, below, close_to, conclude,
                   larger, listed, needed, refutable, text, trend, unknown)
from .statement import states

#: Change of the dip from one half of the time to the other below which layers count as formed.
STILL = 0.1
_DENSITY = "/angles/density_per_rad"  # P(theta)


def dip(runs: Runs) -> Estimate:
    """P(0) over the maximum of P(theta). It is at most 1: where all runs have just that, the scatter of P(0) among them
    stands in for its error."""
    found, densities = runs.number("dip"), [run[_DENSITY] for run in runs if _DENSITY in run]
    heights = [float(np.interp(0.0, np.asarray(p.axis), np.asarray(p))) for p in densities]
    if found.error == 0 and len(heights) > 1:
        mean, error = mean_of_samples(heights)
        return replace(found, error=student_factor(len(heights)) * error / mean, dof=len(heights) - 1)
    return found


def kurtosis(run: Run) -> Estimate:
    """<theta^4> / <theta^2>^2 of P(theta): 3 of a normal distribution, less of one that is flatter or has two peaks."""
    p = run[_DENSITY]
    theta, weight = np.asarray(p.axis), np.asarray(p) / np.sum(p)
    theta = theta - np.angle(np.sum(weight * np.exp(2j * theta))) / 2
    theta = (theta + math.pi / 2) % math.pi - math.pi / 2
    return Estimate(float(np.sum(weight * theta**4) / np.sum(weight * theta**2) ** 2),
                    steady=number_of(run, "S").steady)


def two_peaks(runs: Runs) -> Answer:
    """Whether P(theta) has two peaks. That none was found is no answer: the dip must be known to be shallow."""
    return below(dip(runs), TWO_PEAKS)


def layered(runs: Runs) -> Runs:
    """The runs at those state points that have layers: rods are ordered, at least half of the runs have two peaks in
    P(theta), and the dip between these does not change by more than STILL any more."""
    found = Runs()
    for here in by(runs, LENGTH, END, PACKING, SIDE, GAP):
        depth = here.number("dip")
        relaxes = depth.steady is False and not abs(depth.drift) < STILL
        if here.number("S").value > ORDERED and 2 * _n_layered(here) >= len(here) and not relaxes:
            found += here
    return found


def _n_layered(runs: Runs) -> int:
    """How many of the runs have two peaks in P(theta)."""
    return sum(number_of(run, "dip").value < TWO_PEAKS for run in runs)


def theta_m(run: Run) -> Estimate:
    """The angle of the layers [degrees] of a run that has two peaks in P(theta).

    The run knows it only where it knows the error of the dip between them, for which it may be too short. Elsewhere it
    is from the same fit, of two Gaussians at +-theta_m and a background, and without an error.
    """
    known = number_of(run, "theta_m_deg")
    if known.is_known or not number_of(run, "dip").value < TWO_PEAKS or _DENSITY not in run:
        return known
    density = run[_DENSITY]
    theta, p = np.asarray(density.axis), (np.asarray(density) + np.asarray(density)[::-1]) / 2
    spread = math.sqrt(float(np.sum(p * theta**2) / np.sum(p)))

    def away(parameters: NDArray[Any]) -> NDArray[Any]:
        peak, width, height, background = parameters
        sides = (np.arctan2(np.sin(2 * (theta - side * peak)), np.cos(2 * (theta - side * peak))) / 2
                 for side in (-1, 1))
        return height * sum(np.exp(-(side / width)**2 / 2) for side in sides) + background - p

    best = min((least_squares(away, [part * spread, spread * math.sqrt(1 - part**2), p.max() / 2, 0])
                for part in (0.3, 0.6, 0.8, 0.95)), key=lambda fit: float(fit.cost))
    if abs(best.x[0]) < abs(best.x[1]) / 2:
        return Estimate(reason="one side of the director only, or too few rods on the other")
    return Estimate(math.degrees(abs(best.x[0])), steady=number_of(run, "S").steady, unit="deg")


def mean_angle(runs: Runs) -> Estimate:
    return runs.of(theta_m)


def _angle_text(runs: Runs) -> str:
    theta, n = runs.of(theta_m), _n_layered(runs)
    if not theta.is_known:
        return f"no second peak, dip to {text(dip(runs))}"
    return f"θ_m = ±{text(theta)}°" + (f" in {n} of {len(runs)} runs" if n < len(runs) else "")


def _start_text(runs: Runs) -> str:
    """What is said of runs of which some do not start in rows."""
    n = sum(is_from_a_fluid(run) for run in runs)
    return " (from a fluid)" if n == len(runs) else " (in part from a fluid)" if n else ""


def _gap_text(runs: Runs) -> str:
    return (f"w = {key_of(runs[0], GAP):g} mm: {_angle_text(runs)}, kurtosis of P(θ) {text(runs.of(kurtosis))}, "
            f"Bragg peak {text(runs.number('bragg_peak'))}")


@states("layers", "8", "Layers at ±θ_m, about 10°, for ℓ = 4.5 mm from 0.80 on, and none at 0.75")
def layers_when_dense(evidence: Evidence) -> Finding:
    answers, found = [], []
    for packing in (0.75, 0.80, 0.85):
        runs = evidence.joined("layers", "strip").at(4.5, packing).widest()
        if not runs:
            if evidence["layers"]:
                answers.append(unknown(NOT_RUN).placed(f"{packing:g}"))
            continue
        two = two_peaks(runs)
        answer = two.negated() if packing < 0.78 else close_to(runs.of(theta_m), 10, 4) if two.word else two
        answers.append(answer.placed(f"{packing:g}"))
        found.append(f"φ = {packing:g}: {_angle_text(runs)} in {box_text(runs[0])}{_start_text(runs)}")
    return conclude(answers, "; ".join(found))


def _crest(run: Run) -> Estimate:
    """G2 across the director a wavelength away less that half a wavelength away."""
    lam = wavelength(run).value
    if not math.isfinite(lam) or "/pairs/cut/g2_across" not in run:
        return Estimate(reason="no layers")
    g2 = run["/pairs/cut/g2_across"]
    r, values, errors = np.asarray(g2.axis), np.asarray(g2), np.asarray(g2.error)
    known = np.isfinite(values)
    r, values, errors = r[known], values[known], errors[known]
    crest, trough = place_on(r, lam), place_on(r, lam / 2)
    if crest is None or trough is None:
        return Estimate(reason="G₂ is not known a wavelength away")
    return Estimate(values[crest] - values[trough], math.hypot(errors[crest], errors[trough]),
                    number_of(run, "S").steady)


@states("g2-oscillates", "8", "Where there are layers, G₂ oscillates across the director")
def g2_oscillates(evidence: Evidence) -> Finding:
    answers, found, short = [], [], []
    for name in ("layers", "layer-trends", "strip"):
        # where layers still form or melt G2 is asked for all the same: they need not have their last depth for it
        peaked = Runs(run for run in evidence[name].at(end=0.4) if number_of(run, "dip").value < TWO_PEAKS)
        for runs in by(peaked, LENGTH, PACKING):
            if key_of(runs[0], PACKING) < 0.79 or runs.number("S").value < ORDERED:
                continue
            where = f"{key_of(runs[0], PACKING):g}, ℓ = {key_of(runs[0], LENGTH):g} mm in {box_text(runs[0])}"
            rise = runs.of(_crest)
            if not rise.is_known:
                short.append(where)
                continue
            answers.append(above(rise, 0).placed(where))
            found.append(f"{text(rise)} at φ = {where}")
    finding = conclude(answers or [unknown("G₂ ends before a wavelength").placed(where) for where in short],
                       "G₂ across the director, a wavelength away less half a wavelength away: " + "; ".join(found))
    if answers and short:
        finding.why += ("; " if finding.why else "") + f"not asked at {'; '.join(short)}: G₂ ends before a wavelength"
    return finding


@states("gap", "gap", "No layers at gaps of 1.4 and 1.6 mm",
        "asked of P(θ): whether it has one peak, and is less flat there than at 1.2 mm")
def no_layers_at_wide_gaps(evidence: Evidence) -> Finding:
    reference = needed(evidence["layers"].at(4.5, 0.80))
    answers, found = [], [_gap_text(reference)]
    plain = evidence["layers"].at(4.5, 0.75)
    if plain:
        found.append(f"at φ = 0.75, without layers: kurtosis {text(plain.of(kurtosis))}")
    for gap in (1.4, 1.6):
        wide = evidence["gaps"].at(gap=gap)
        if not wide:
            answers.append(unknown(NOT_RUN).placed(f"w = {gap:g} mm"))
            continue
        answers.append(two_peaks(wide).negated().placed(f"one peak, w = {gap:g} mm"))
        answers.append(larger(wide.of(kurtosis), reference.of(kurtosis)).placed(f"less flat, w = {gap:g} mm"))
        found.append(_gap_text(wide))
    return conclude(answers, "; ".join(found))


@states("gap-order", "gap", "At a gap of 1.4 mm the system is ordered still", "in a box narrower than the paper's")
def ordered_at_a_wider_gap(evidence: Evidence) -> Finding:
    runs = evidence["gaps"].at(gap=1.4)
    s = runs.number("S")
    return conclude([above(s, ORDERED)] if runs else [], f"S = {text(s)} at w = 1.4 mm")


def taper_angle(run: Run) -> float:
    """Twice the angle between the flank and the axis of a rod [degrees]: that between two rods, flank on flank."""
    length, middle, end = (key_of(run, path) for path in (LENGTH, "rods.mid_diameter", END))
    return 2 * math.degrees(math.atan((middle - end) / (length - end)))


@states("taper", "taper", "The layers are due to the tapered shape",
        "asked of θ_m: whether it is the same part of the angle between two tapered flanks at every length")
def taper_makes_layers(evidence: Evidence) -> Finding:
    """Whether theta_m is the same part of the angle of the taper at every length, as where flanks lie on flanks."""
    parts = []
    for length in (3.5, 4.0, 4.5):
        runs = layered(evidence.joined("layers", "layer-trends", "strip").at(length, 0.85, end=0.4).widest())
        if runs and (theta := mean_angle(runs)).is_known:
            parts.append((length, theta * (1 / taper_angle(runs[0]))))
    needed(parts, 2)
    mean = math.fsum(part.value for _, part in parts) / len(parts)
    found = f"θ_m over the angle of two tapered flanks at φ = 0.85: {listed(parts, 'ℓ')}"
    answers, how = [close_to(part, mean, 0.15) for _, part in parts], "θ_m follows the taper"
    untapered = by(evidence["taper"].beyond(PACKING, 0.78), PACKING)
    for plain in untapered:
        found += (f"; rods without a taper at {key_of(plain[0], PACKING):g}: S = {text(plain.number('S'))}, "
                  f"dip to {text(dip(plain))}")
    words = [_two_peaks_in_order(plain).word for plain in untapered]
    answers += [NO] if True in words else []
    if untapered:
        how += ("; rods without one have layers" if True in words else "; rods without one have no layers"
                if False in words else "; rods without one have no nematic in which layers could be missing")
    return refutable(all_of(answers), found, how)


@states("crystal", "gap", "At a gap of 0.9 mm a crystal, without layers",
        "all runs start as a crystal: one that melts would refute it")
def crystal_at_a_narrow_gap(evidence: Evidence) -> Finding:
    reference, narrow = needed(evidence["layers"].at(4.5, 0.80)), needed(evidence["gaps"].at(gap=0.9))
    found = f"{_gap_text(reference)}; {_gap_text(narrow)}"
    more = larger(narrow.number("bragg_peak"), reference.number("bragg_peak"))
    if two_peaks(narrow).word or more.word is False:
        return refutable(NO, found, "")
    if more.word is None:
        return refutable(more, found, "")
    ratio = narrow.number("bragg_peak").value / reference.number("bragg_peak").value
    return refutable(YES, found, f"its Bragg peak is {ratio:.1f} times that of the layers, and P(θ) has one peak")


def _goes_far(runs: Runs) -> bool:
    """Whether rods go two of their lengths along the director while they are measured, as in a fluid; what is frozen
    does not."""
    measured = min(float(run.summary["sim_seconds"]) - float(run.summary.get("t_steady_s") or 0) for run in runs)
    way = math.sqrt(max(2 * runs.number("diffusion_along_mm2_s").value * measured, 0))
    return not way < 2 * key_of(runs[0], LENGTH)


def _symbol(path: str) -> str:
    return names.plain(names.symbol(path))


def _trend(series: list[tuple[Runs, str]], of: Callable[[Runs], Estimate], rising: bool, unit: str) -> Finding:
    """A trend of the layers in series of one key each. It is one question of steady states: a series that cannot tell,
    or that compares a fluid with what is frozen, is named beside those that can, and leaves no more than
    consistency."""
    answers, found = [], []
    for runs, key in series:
        formed = layered(runs)
        points = points_of(formed, key, of)
        if len(runs.values(key)) < 2:
            continue
        others = [other for other in (LENGTH, PACKING) if other != key]
        where = ", ".join(f"{_symbol(other)} = {key_of(runs[0], other):g}" for other in others)
        where += f", {box_text(runs[0])}{_start_text(runs)}"
        if len({_goes_far(formed.where(key, value)) for value, _ in points}) > 1:
            answer = unknown("a fluid against a frozen state")
        else:
            answer = trend(points, rising) if len(points) > 1 else unknown("layers at fewer than two points")
        answers.append(answer.placed(where))
        found.append(f"{where}: " + (listed(points, _symbol(key), unit) or "no layers"))
    able = [answer for answer in answers if answer.word is not None]
    finding = conclude(able or answers, ". ".join(found))
    unable = "; ".join(f"{answer.at} ({answer.why})" for answer in answers if answer.word is None)
    if able and unable:
        finding = replace(finding, verdict=CONSISTENT if finding.verdict == AGREES else finding.verdict,
                          why=finding.why + ("; " if finding.why else "") + f"cannot tell: {unable}", answers=answers)
    return finding


def by_packing(evidence: Evidence) -> list[tuple[Runs, str]]:
    square = evidence.joined("layers", "layer-trends")
    return [(runs.at(length, end=0.4).beyond(PACKING, 0.78), PACKING)
            for length in (4.0, 4.5) for runs in (square, evidence["strip"])]


def by_length(evidence: Evidence) -> list[tuple[Runs, str]]:
    return [(runs.at(packing=0.85, end=0.4), LENGTH)
            for runs in (evidence.joined("layers", "layer-trends"), evidence["strip"])]


def by_end(evidence: Evidence) -> list[tuple[Runs, str]]:
    """At 0.85, where rods with blunt ends freeze, and at 0.825, where those with ends of 0.5 mm may still flow. At 0.80
    the usual rods of this length have no layers with which those of others could be compared."""
    dense = [evidence[name].at(4.0, 0.85) for name in ("layer-trends", "fluid-start", "strip")]
    return [(runs, END) for runs in (*dense, evidence["strip"].at(4.0, 0.825))]


angle_packing = states("angle-packing", "layer-trends", "θ_m grows with packing")(
    lambda evidence: _trend(by_packing(evidence), mean_angle, rising=True, unit="°"))
angle_length = states("angle-length", "layer-trends", "θ_m falls with rod length")(
    lambda evidence: _trend(by_length(evidence), mean_angle, rising=False, unit="°"))
angle_end = states("angle-end", "layer-trends", "θ_m falls with the end radius")(
    lambda evidence: _trend(by_end(evidence), mean_angle, rising=False, unit="°"))


def _two_peaks_in_order(runs: Runs) -> Answer:
    """As two_peaks, of rods that have an order to which layers could be turned."""
    return two_peaks(runs) if runs.number("S").value > ORDERED else unknown("the rods froze without order")


def _whatever_the_start(answers: list[Answer]) -> Answer:
    """The answer of runs from several starts and packings, where they say the same."""
    open_ = [answer for answer in answers if answer.word is None]
    same = len({answer.word for answer in answers}) == 1
    return open_[0] if open_ else answers[0] if same else unknown("it depends on start and packing")


@states("peaks-end", "layer-trends", "P(θ) has two peaks at every end radius")
def two_peaks_at_every_end(evidence: Evidence) -> Finding:
    answers, found = [], []
    series = [runs for runs, _ in by_end(evidence)]
    ends = sorted({end for runs in series for end in runs.values(END)})
    for end in ends if len(ends) > 1 else []:
        starts = [here for runs in series if (here := runs.at(end=end))]
        ends_of = names.plain(names.value_label(END, end))
        answers.append(_whatever_the_start([_two_peaks_in_order(here) for here in starts]).placed(ends_of))
        found.append(f"{ends_of}: " + ", ".join(
            f"{_angle_text(here)} at φ = {key_of(here[0], PACKING):g} in {box_text(here[0])}{_start_text(here)}"
            for here in starts))
    return conclude(answers, "; ".join(found), everywhere=True)


wavelength_packing = states("wavelength-packing", "layer-trends", "The wavelength grows from 0.85 to 0.80")(
    lambda evidence: _trend(by_packing(evidence), mean_wavelength, rising=False, unit=" mm"))
wavelength_length = states("wavelength-length", "layer-trends", "The wavelength grows with rod length")(
    lambda evidence: _trend(by_length(evidence), mean_wavelength, rising=True, unit=" mm"))
wavelength_end = states("wavelength-end", "layer-trends", "The wavelength grows with the end radius")(
    lambda evidence: _trend(by_end(evidence), mean_wavelength, rising=True, unit=" mm"))


@states("larger-box", "larger-box", "In a larger box the wavelength is larger and θ_m smaller")
def larger_box(evidence: Evidence) -> Finding:
    small, large = (needed(evidence[name].at(4.0, 0.85, end=0.4)) for name in ("layer-trends", "larger-box"))
    lam = [mean_wavelength(layered(runs)) for runs in (small, large)]
    theta = [mean_angle(layered(runs)) for runs in (small, large)]
    boxes = [box_text(runs[0]) for runs in (small, large)]
    return conclude([larger(lam[1], lam[0]).placed("λ larger"), larger(theta[0], theta[1]).placed("θ_m smaller")],
                    f"ℓ = 4 mm, φ = 0.85: λ = {text(lam[0])} mm and {text(lam[1])} mm, θ_m = {text(theta[0])}° and "
                    f"{text(theta[1])}°, in {boxes[0]} and {boxes[1]}")
