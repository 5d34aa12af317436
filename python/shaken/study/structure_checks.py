# SPDX-License-Identifier: MIT
"""Correlations in space, isotropic and along and across the director, and what they say of elasticity."""
from __future__ import annotations

import numpy as np

from ..estimate import Estimate, derived
from ..run import Run
from .evidence import LENGTH, PACKING, PAPERS_BOX, SIDE, Evidence, Runs, key_of, mean_of_places
from .rules import (CONTRADICTS, NOT_RUN, Finding, above, close_to, conclude, larger, listed, text, unknown)

#: G2 that counts as none at half a box.
NO_CORRELATION = 0.05
#: G2 levels off at S^2: that of S = 0.5.
PLATEAU = 0.25
#: tan of the most that a wave which bends the director may be away from it: 8.5 degrees.
OBLIQUE = 0.15


def far_g2(runs: Runs) -> Estimate:
    """G2 far away: its mean over the last quarter of the distances, up to half the box."""
    def of(run: Run) -> Estimate:
        if "/g2/g2" not in run:
            return Estimate(reason="not measured")
        g2 = run["/g2/g2"]
        first = 3 * len(g2) // 4
        return mean_of_places(np.asarray(g2)[first:], np.asarray(g2.error)[first:], run)

    return runs.of(of)


def far_anisotropy(runs: Runs) -> Estimate:
    """G2 along less G2 across the director, in the farther half of the cuts through the map."""
    def of(run: Run) -> Estimate:
        if "/pairs/cut/g2_along" not in run:
            return Estimate(reason="not measured")
        along, across = run["/pairs/cut/g2_along"], run["/pairs/cut/g2_across"]
        first = len(along) // 2
        return mean_of_places(np.asarray(along - across)[first:], np.hypot(along.error, across.error)[first:], run)

    return runs.of(of)


def unevenness(runs: Runs, cut: str) -> Estimate:
    """Mean of (g - 1)^2 from one rod's length on, less what its errors put there."""
    def of(run: Run) -> Estimate:
        if f"/pairs/cut/{cut}" not in run:
            return Estimate(reason="not measured")
        g = run[f"/pairs/cut/{cut}"]
        away, error = np.asarray(g) - 1, np.asarray(g.error)
        far = np.asarray(g.axis) >= key_of(run, LENGTH)
        return mean_of_places((away**2 - np.nan_to_num(error)**2)[far], (2 * abs(away) * error)[far], run)

    return runs.of(of)


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
            far = far_g2(here)
            answer = above(far, PLATEAU) if dense else close_to(far, 0, NO_CORRELATION)
            if not dense and answer.word is False and key_of(here[0], SIDE) < PAPERS_BOX:
                answer = unknown("half the box is less far than the paper's")
            answers.append(answer.placed(f"ℓ = {length:g} mm, φ = {packing:g}"))
            points.append((packing, far))
        if points:
            found.append(f"ℓ = {length:g} mm: {listed(points, 'φ')}")
    return conclude(answers, "G₂ at half a box, " + ". ".join(found) if found else "")


def g2_isotropic_when_dilute(evidence: Evidence) -> Finding:
    runs = evidence["dilute"].at(packing=0.45)
    if not runs:
        return Finding()
    difference = far_anisotropy(runs)
    return conclude([close_to(difference, 0, NO_CORRELATION)],
                    f"along − across, far out at φ = 0.45: {text(difference)}")


def g2_anisotropic(evidence: Evidence) -> Finding:
    runs = evidence["layers"].at(packing=0.75)
    if not runs:
        return Finding()
    difference = far_anisotropy(runs)
    return conclude([above(difference, 0)], f"along − across, far out at φ = 0.75: {text(difference)}")


def g_flattens(evidence: Evidence) -> Finding:
    runs = evidence["layers"].at(packing=0.75)
    if not runs:
        return Finding()
    along, across = unevenness(runs, "g_along"), unevenness(runs, "g_across")
    sooner = {True: "along", False: "across", None: "neither, within the errors"}[larger(across, along).word]
    return Finding(CONTRADICTS, f"mean (g − 1)² from one rod length on, φ = 0.75: {text(along)} along, {text(across)} "
                                f"across", f"here it flattens sooner {sooner}")


def opposite_waves(run: Run) -> list[tuple[float, Estimate, Estimate]]:
    """(wave number [1/mm], power of bend, power of splay) of the director's fluctuations, of each wave along the
    director and its mirror image across it, which has the same length; by rising wave number."""
    if "/frank/power_mm2" not in run:
        return []
    power = run["/frank/power_mm2"]
    along, across = abs(np.asarray(run["/frank/q_along_per_mm"])), abs(np.asarray(run["/frank/q_across_per_mm"]))
    q = np.hypot(along, across)
    order = run.numbers.get("S", Estimate())
    found = []
    for bend in np.flatnonzero(across < OBLIQUE * along):
        away = np.hypot(along - across[bend], across - along[bend])
        splay = int(np.argmin(away))
        if away[splay] < 0.05 * q[bend]:
            found.append((float(q[bend]), *(Estimate(float(power[k]), float(power.error[k]), order.steady)
                                            for k in (bend, splay))))
    return sorted(found, key=lambda wave: wave[0])


def splay_stiffer_than_bend(evidence: Evidence) -> Finding:
    runs = evidence["elasticity"].at(packing=0.65)
    waves = [opposite_waves(run) for run in runs]
    n = min(map(len, waves), default=0)
    if runs and n == 0:
        return conclude([unknown("no wave along the director has one of its length across it")], "")
    answers, ratios = [], []
    for k in range(n):
        bend, splay = (runs.of(lambda run: opposite_waves(run)[k][which]) for which in (1, 2))
        wavelength = round(2 * np.pi / float(np.mean([each[k][0] for each in waves])), 1)
        answers.append(larger(bend, splay).placed(f"λ = {wavelength:g} mm"))  # what costs more fluctuates less
        ratios.append((wavelength, derived(splay.value / bend.value, [
            (1 / bend.value, splay), (-splay.value / bend.value**2, bend)])))
    return conclude(answers, "power of splay over that of bend at φ = 0.65, of waves of λ mm: "
                    + listed(ratios, "λ"))
