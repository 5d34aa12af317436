"""Correlations in space, isotropic and along and across the director, and what they say of elasticity."""
import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..estimate import Estimate, derived
from ..run import Run
from .evidence import LENGTH, PACKING, PAPERS_BOX, SIDE, Evidence, Runs, key_of, mean_of_places, mean_over
from .rules import (CONTRADICTS, NOT_RUN, Finding, above, close_to, conclude, larger, listed, needed, text, unknown)
from .statement import states

#: G2 that counts as none at half a box.
NO_CORRELATION = 0.05
#: G2 levels off at S^2: that of S = 0.5.
PLATEAU = 0.25
#: G2 at which its contours are compared, and by which part their reach along and across the director may differ.
CONTOUR, ROUND = 0.2, 0.15
#: tan of the most that a wave which bends the director may be away from it: 8.5 degrees.
OBLIQUE = 0.15
#: Part of a wave number within which two waves are of the same length.
SAME_LENGTH = 0.05


def far_g2(run: Run) -> Estimate:
    """G2 far away: its mean over the last quarter of the distances, up to half the box."""
    return mean_over(run, "/g2/g2", lambda r: slice(3 * len(r) // 4, None))


def far_anisotropy(run: Run) -> Estimate:
    """G2 along less G2 across the director, in the farther half of the cuts through the map."""
    along, across = run["/pairs/cut/g2_along"], run["/pairs/cut/g2_across"]
    first = len(along) // 2
    return mean_of_places(np.asarray(along - across)[first:], np.hypot(along.error, across.error)[first:], run)


def contour_ratio(run: Run) -> Estimate:
    """How far G2 reaches along the director over how far it does so across it: to where it falls to CONTOUR."""
    reach, error = [], []
    for name in ("g2_along", "g2_across"):
        g2 = run[f"/pairs/cut/{name}"]
        r, values, errors = np.asarray(g2.axis), np.asarray(g2), np.asarray(g2.error)
        below = np.flatnonzero(values < CONTOUR)
        if not len(below) or not below[0]:
            return Estimate(reason=f"G₂ does not fall to {CONTOUR:g}")
        i = below[0]
        slope = (values[i] - values[i - 1]) / (r[i] - r[i - 1])
        reach.append(float(r[i] + (CONTOUR - values[i]) / slope))
        error.append(float(errors[i] / abs(slope)) / reach[-1])
    return Estimate(reach[0] / reach[1], reach[0] / reach[1] * math.hypot(*error), run["S"].steady)


def unevenness(run: Run, cut: str) -> Estimate:
    """Mean of (g - 1)^2 from one rod's length on, less what its errors put there."""
    g = run[f"/pairs/cut/{cut}"]
    away, error = np.asarray(g) - 1, np.asarray(g.error)
    far = np.asarray(g.axis) >= key_of(run, LENGTH)
    return mean_of_places((away**2 - np.nan_to_num(error)**2)[far], (2 * abs(away) * error)[far], run)


@states("g2", "5", "G₂(r) decays to 0 for ℓ = 2.5 mm at every packing, and levels off for ℓ = 4.5 mm when dense")
def g2_decays_or_levels(evidence: Evidence) -> Finding:
    answers, found = [], []
    short = evidence.joined("short-rods", "no-order", "diffusion").at(length=2.5)
    long_ = evidence.joined("long-rods", "layers").at(length=4.5)
    for length, runs, dense in ((2.5, short, 0.0), (4.5, long_, 0.74)):
        points = []
        if (short or long_) and not runs:
            answers.append(unknown(NOT_RUN).placed(f"ℓ = {length:g} mm"))
        for packing in runs.values(PACKING):
            if packing < dense:
                continue
            here = runs.at(packing=packing).largest(SIDE)
            far = here.of(far_g2)
            answer = above(far, PLATEAU) if dense else close_to(far, 0, NO_CORRELATION)
            if not dense and answer.word is False and key_of(here[0], SIDE) < PAPERS_BOX:
                answer = unknown("half the box is less far than the paper's")
            answers.append(answer.placed(f"ℓ = {length:g} mm, φ = {packing:g}"))
            points.append((packing, far))
        if points:
            found.append(f"ℓ = {length:g} mm: {listed(points, 'φ')}")
    return conclude(answers, "G₂ at half a box, " + ". ".join(found) if found else "", everywhere=True)


@states("isotropic", "6", "G₂ is isotropic at 0.45 (ℓ = 4.5 mm)",
        "asked of its contour at 0.2, in the frame of the director of the same rods, which finds some order in any "
        "number of them: the ratio less 1 goes as S, and its value at S = 0 counts")
def g2_isotropic_when_dilute(evidence: Evidence) -> Finding:
    runs = evidence.joined("dilute", "long-rods").at(4.5, 0.45)
    boxes = [(side, here.number("S"), here.of(contour_ratio)) for side in runs.values(SIDE)
             for here in [runs.at(side=side)]]
    known = [(side, s, ratio) for side, s, ratio in boxes if ratio.is_known]
    if not known:
        return Finding() if not runs else conclude([unknown(f"G₂ does not fall to {CONTOUR:g}")], "")
    ratios = "; ".join(f"{text(ratio)} in {side:.3g} mm, where S = {text(s)}" for side, s, ratio in known)
    found = f"at φ = 0.45 G₂ falls to {CONTOUR:g} at distances along and across the director whose ratio is {ratios}"
    round_ = known[-1][2]
    if len(known) > 1:
        # The director is that of the same few rods, along which they are correlated by choice: the more, the higher S.
        (_, s0, r0), (_, s1, r1) = known[0], known[-1]
        slope = (r0.value - r1.value) / (s0.value - s1.value)
        round_ = derived(r1.value - slope * s1.value, [(1 + s1.value / (s0.value - s1.value), r1),
                                                       (-s1.value / (s0.value - s1.value), r0)])
        found += f"; {text(round_)} at S = 0, on the straight line"
    return conclude([close_to(round_, 1, ROUND)], found)


@states("anisotropy", "6", "G₂ falls faster across the director than along it")
def g2_anisotropic(evidence: Evidence) -> Finding:
    runs = needed(evidence["layers"].at(packing=0.75))
    difference = runs.of(far_anisotropy)
    return conclude([above(difference, 0)], f"along − across, far out at φ = 0.75: {text(difference)}")


@states("g-flattens", "7", "g(r) flattens sooner along the director than across it",
        "the sentence says the contrary in its second half")
def g_flattens(evidence: Evidence) -> Finding:
    runs = needed(evidence["layers"].at(packing=0.75))
    along, across = (runs.of(partial(unevenness, cut=cut)) for cut in ("g_along", "g_across"))
    sooner = {True: "along", False: "across", None: "neither, within the errors"}[larger(across, along).word]
    return Finding(CONTRADICTS, f"mean (g − 1)² from one rod length on, φ = 0.75: {text(along)} along, {text(across)} "
                                f"across", f"here it flattens sooner {sooner}")


@dataclass(frozen=True)
class OppositeWaves:
    """A wave of the director along it and its mirror image across it, which has the same length.

    q: wave number [1/mm]; bend, splay: the power of the one along and of the one across [mm2]
    """

    q: float
    bend: Estimate
    splay: Estimate

    @property
    def ratio(self) -> Estimate:
        """Power of splay over that of bend."""
        return self.splay / self.bend

    def with_noise(self, level: float) -> "OppositeWaves":
        """The powers as they were measured: with the noise level of uncorrelated rods [mm2] in both."""
        return OppositeWaves(self.q, *(replace(power, value=power.value + level) for power in (self.bend, self.splay)))


def opposite_waves(run: Run) -> list[OppositeWaves]:
    """Those of the spectrum of a run, by rising wave number, none as long as another within SAME_LENGTH."""
    if "/frank/power_mm2" not in run:
        return []
    power = run["/frank/power_mm2"]
    along, across = abs(np.asarray(run["/frank/q_along_per_mm"])), abs(np.asarray(run["/frank/q_across_per_mm"]))
    q = np.hypot(along, across)
    found: list[OppositeWaves] = []
    for bend in sorted(np.flatnonzero(across < OBLIQUE * along), key=lambda k: q[k]):
        away = np.hypot(along - across[bend], across - along[bend])
        splay = int(np.argmin(away))
        if away[splay] < SAME_LENGTH * q[bend] and (not found or q[bend] > (1 + SAME_LENGTH) * found[-1].q):
            found.append(OppositeWaves(float(q[bend]), *(
                Estimate(float(power[k]), float(power.error[k]), run.numbers.get("S", Estimate()).steady)
                for k in (bend, splay))))
    return found


def mean_waves(runs: Runs) -> list[OppositeWaves]:
    """The opposite waves that all runs have, averaged over them."""
    def at(run: Run, q: float) -> OppositeWaves:
        none = OppositeWaves(q, *[Estimate(reason="no wave of this length")] * 2)
        near = min(opposite_waves(run), key=lambda wave: abs(wave.q - q), default=none)
        return near if abs(near.q - q) < SAME_LENGTH * q else none

    lengths = [wave.q for wave in (opposite_waves(runs[0]) if runs else [])]
    return [OppositeWaves(q, runs.of(lambda run: at(run, q).bend), runs.of(lambda run: at(run, q).splay))
            for q in lengths if all(at(run, q).bend.is_known for run in runs)]


def ordered_in_large_boxes(evidence: Evidence) -> Runs:
    """Runs of rods of 4.5 mm that have a director, in boxes whose spectrum has a measured noise level; of each packing
    those in the largest box."""
    runs = Runs(run for run in evidence.joined("size", "elasticity", "long-range").at(length=4.5)
                if 0.54 < key_of(run, PACKING) < 0.71 and key_of(run, SIDE) > 60)
    return Runs(run for packing in runs.values(PACKING) for run in runs.at(packing=packing).largest(SIDE))


@states("splay-bend", "elasticity", "Splay costs more than bend, K₁ > K₃",
        "the paper concludes it from G₂ falling faster across the director; in linear theory, ⟨δθ²⟩ ~ 1/(K₁q_across² + "
        "K₃q_along²), that means the reverse. Asked of waves of the director along and across it, of the same length: "
        "if both are driven alike, what costs more fluctuates less")
def splay_stiffer_than_bend(evidence: Evidence) -> Finding:
    runs = ordered_in_large_boxes(evidence)
    answers, found = [], []
    for packing in runs.values(PACKING):
        for wave in mean_waves(runs.at(packing=packing)):
            length = 2 * math.pi / wave.q
            answers.append(larger(wave.bend, wave.splay).placed(f"φ = {packing:g}, λ = {length:.0f} mm"))
            if 20 < length < 24:  # not the longest, which are few in a run, nor those near the noise level
                found.append((packing, wave.ratio))
    if runs and not answers:
        answers.append(unknown("no wave along the director has one of its length across it"))
    return conclude(answers, f"power of splay over that of bend, of waves of 22 mm: {listed(found, 'φ')}")
