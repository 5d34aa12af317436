"""Swimming, diffusion, rotation, correlations in time, defects."""
import math
from typing import Any

import numpy as np

from ..estimate import Estimate
from ..run import Run
from . import late_lags
from .evidence import PACKING, SIDE, Evidence, Runs, key_of, mean_over, number_of, points_of
from .late_lags import long_time_diffusion
from .rules import (NO, YES, Answer, Finding, above, below, close_to, conclude, doubt, larger, listed, needed, text,
                   trend, unknown)
from .statement import CALIBRATES, HARDLY_FAILS, states

#: Change of the slope of the MSD from one octave of lags to the next, as a part of it, below which motion is diffusive.
SAME_SLOPE = 0.1
#: The least C2 at late times that counts as near 1: it is the square of S there, whose least "about 1" is 0.85.
NEAR_ONE = 0.85 ** 2
#: Change of C2 from one octave of lags to the next below which it has levelled off.
LEVEL = 0.05
#: D0 [mm2/s], C [mm2/s] and phi0 of the paper's fit D0 + C (phi - phi0)^2 to D of rods of 2.5 mm.
PAPERS_PARABOLA = (1.7, 480.0, 0.64)


def papers_diffusion(packing: Any) -> Any:
    """The paper's fit to D of rods of 2.5 mm [mm2/s]."""
    d0, c, phi0 = PAPERS_PARABOLA
    return d0 + c * (packing - phi0) ** 2


def short_rods(evidence: Evidence) -> Runs:
    """Rods of 2.5 mm at each packing, in the largest box of the sets that follow them for long."""
    runs = evidence.joined("diffusion", "short-rods", "mechanism").at(length=2.5)
    return Runs(run for packing in runs.values(PACKING) for run in runs.at(packing=packing).largest(SIDE))


def long_rods(evidence: Evidence) -> Runs:
    """Rods of 4.5 mm at each packing, of the set that follows them along the director where it has them."""
    followed, others = evidence["diffusion-along"], evidence["long-rods"]
    return Runs([*followed, *(run for run in others if key_of(run, PACKING) not in followed.values(PACKING))])


def beyond_reversal(run: Run) -> Estimate:
    """Weighted mean of v along the rod [mm/s] over tilts beyond 0.31, both hands taken together: above 0 where it is
    reversed, as the paper draws it."""
    v = run["/tilt/folded/v_along_mm_s"]
    n_z, errors = np.asarray(v.axis), np.asarray(v.error)
    good = (n_z >= 0.31) & (n_z <= 0.40) & (errors > 0) & np.isfinite(v)
    if not good.any():
        return Estimate(reason="no rod tilts so far")
    weights = 1 / errors[good]**2
    return Estimate(float((np.asarray(v)[good] * weights).sum() / weights.sum()), float(weights.sum()**-0.5),
                    number_of(run, "tilt_fastest_mm_s").steady)


@states("tilt", "10", "Rods swim against their tilt, fastest near n_z = ±0.2")
def tilt_and_velocity(evidence: Evidence) -> Finding:
    runs = needed(evidence["mechanism"].at(packing=0.60))
    speed = runs.number("tilt_fastest_mm_s")

    def place_in(run: Run) -> Estimate:
        return Estimate(abs(number_of(run, "tilt_fastest_n_z").value), 0.0, True)

    n_z = np.asarray(runs[0]["/tilt/folded/n_z"])
    place = runs.of(place_in).with_further_error(float(n_z[1] - n_z[0]))  # to a bin, which all runs have in common
    return conclude([below(speed, 0).placed("against the tilt"), close_to(place, 0.2, 0.06).placed("fastest near 0.2")],
                    f"fastest at n_z = ±{text(place)}, {text(speed)} mm/s along the tilt")


@states("reversal", "10", "Beyond n_z = ±0.3 they swim the other way",
        "one of the two reasons for which 200 Hz is assumed", CALIBRATES)
def velocity_reverses(evidence: Evidence) -> Finding:
    runs = evidence["mechanism"].at(packing=0.60)
    beyond = runs.of(beyond_reversal)
    return conclude([above(beyond, 0)] if runs else [], f"{text(beyond)} mm/s along the tilt beyond ±0.31")


@states("no-tilt", "10", "A rod without tilt does not swim", "by symmetry", HARDLY_FAILS)
def no_velocity_without_tilt(evidence: Evidence) -> Finding:
    runs = needed(evidence["mechanism"].at(packing=0.60))

    def at_rest(run: Run) -> Estimate:  # in the bins on either side of 0
        return mean_over(run, "/tilt/v_along_mm_s", lambda n_z: np.argsort(abs(n_z))[:2])

    speed, fastest = runs.of(at_rest), abs(runs.number("tilt_fastest_mm_s").value)
    return conclude([close_to(speed, 0, 0.1 * fastest)],
                    f"{text(speed)} mm/s at n_z = 0, where the fastest is {fastest:.2f} mm/s")


@states("sideways", "10", "Across the rod ⟨v⟩ = 0 at every tilt", "by symmetry", HARDLY_FAILS)
def no_motion_sideways(evidence: Evidence) -> Finding:
    runs = needed(evidence["mechanism"].at(packing=0.60))
    chi2, noise, n = 0.0, 0.0, 0
    for run in runs:
        v = run["/tilt/v_across_mm_s"]
        good = (np.asarray(v.error) > 0) & np.isfinite(v)
        chi2 += float((np.asarray(v)[good] ** 2 / np.asarray(v.error)[good] ** 2).sum())
        noise += float((np.asarray(v.error)[good] ** 2).sum())
        n += int(good.sum())
    needed(range(n))
    excess = Estimate(chi2 / n, math.sqrt(2 / n), True)  # chi2 of n independent bins at zero is n +- sqrt(2 n)
    error, speed = math.sqrt(noise / n), abs(runs.number("tilt_fastest_mm_s").value)
    if above(excess, 1).word:
        answer = NO
    else:
        answer = YES if error < 0.2 * speed else unknown("the errors are too large")
    return conclude([answer], f"χ² per bin {text(excess)} about 0, errors of {error:.2f} mm/s; fastest along the rod "
                              f"{speed:.2f} mm/s")


@states("switching", "10", "The tilt of a rod switches from one sign to the other",
        "the paper follows rods for 30 s, hundreds of times as long", HARDLY_FAILS)
def tilt_switches(evidence: Evidence) -> Finding:
    points = evidence["mechanism"].points(PACKING, "n_z_switching_time_s")
    # several times within the 30 s over which the paper follows a rod
    return conclude([below(estimate, 10).placed(f"{packing:g}") for packing, estimate in points],
                    f"n_z keeps its sign for {listed(points, 'φ', ' s')}")


@states("persistence", "11", "Ways of single rods persist longer at 0.85 than at 0.65",
        "0.2 s below φ = 0.70 is half the window of 400 ms over which velocities are averaged: no memory is seen there")
def persists_when_dense(evidence: Evidence) -> Finding:
    answers, found = [], []
    for name, unit in (("persistence_time_s", " s"), ("persistence_length_mm", " mm")):
        points = [(at, e) for at, e in evidence["mechanism"].points(PACKING, name) if at > 0.64]
        if len(points) > 1:
            answers.append(trend(points, rising=True).placed("time" if unit == " s" else "length"))
            found.append(listed(points, "φ", unit))
    return conclude(answers, ". ".join(found))


@states("persistence-noise", "11", "They persist because rotational noise is less",
        "rods of 4.5 mm, which turn still less, are asked too. That neighbours move together is another cause")
def persists_for_want_of_noise(evidence: Evidence) -> Finding:
    """Whether ways could persist because rods turn less: not if they persist longer than directions are kept, 1/D_r."""
    turning = dict(points_of(evidence["short-rods"], PACKING, lambda here: here.number("rotational_diffusion_rad2_s")))
    ways = dict(evidence["mechanism"].points(PACKING, "persistence_time_s"))
    answers, found = [], []
    for at in (0.65, 0.85):
        if at in turning and at in ways:
            answers.append(below(turning[at] * ways[at].value, 1).placed(f"{at:g}"))
            found.append(f"ways persist for {text(ways[at])} s, 1/D_r = {1 / turning[at].value:.2g} s at φ = {at:g}")
    needed(answers, 2)
    answers.append(larger(turning[0.65], turning[0.85]).placed("less noise when denser"))
    long_ = evidence["long-rods"].at(4.5, 0.75)
    if long_:  # which turn still less
        time = long_.number("persistence_time_s")
        answers.append(larger(time, ways[0.85]).placed("rods with less noise persist longer"))
        d_r = long_.number("rotational_diffusion_rad2_s").value
        found.append(f"{text(time)} s, 1/D_r = {1 / d_r:.0f} s at ℓ = 4.5 mm, φ = 0.75")
    return conclude(answers, "; ".join(found))


def _grows_linearly(runs: Runs, curve: str, exponent: str) -> tuple[Answer, str]:
    """Whether a square displacement grows linearly in time, and the number behind it: its exponent is 1 at the lags at
    which single runs have an error, or its slope no longer changes at the longest ones."""
    early, change = runs.number(exponent), runs.of(late_lags.change_of_slope(curve))
    answer = close_to(early, 1, 0.1)
    if answer.word or not math.isfinite(change.error):
        return answer, f"exponent {text(early)}" if early.is_known else ""
    return close_to(change, 1, SAME_SLOPE), f"slope {text(change)}"


def _linear_growth(runs: Runs, curve: str, exponent: str) -> tuple[list[Answer], list[str]]:
    """The same at each packing that knows a number, with its place."""
    found = [(packing, *_grows_linearly(runs.at(packing=packing), curve, exponent)) for packing in runs.values(PACKING)]
    known = [(f"{packing:g}", answer, numbers) for packing, answer, numbers in found if numbers]
    return [answer.placed(at) for at, answer, _ in known], [f"{numbers} at φ = {at}" for at, _, numbers in known]


@states("diffusion-both", "9", "Rods diffuse normally in both the disordered and the ordered phase (ℓ = 4.5 mm)",
        "that C_v stays above 0 for seconds, as the paper's figure 12 has it at 0.85, is an exponent above 1")
def normal_in_both_phases(evidence: Evidence) -> Finding:
    answers, found = [], []
    for phase, name, disordered in (("disorder", "total", True), ("along the director", "along", False),
                                    ("across it", "across", False)):
        runs = Runs(run for run in long_rods(evidence)  # but at the transition
                    if (key_of(run, PACKING) < 0.52 if disordered else key_of(run, PACKING) >= 0.59))
        own = "alpha_long" if disordered else f"alpha_{name}_long"
        grows, late = _linear_growth(runs, f"/msd/{name}_mm2", own)
        answers += [answer.placed(f"{phase}, {answer.at}") for answer in grows]
        if late:
            found.append(f"{phase}: {'; '.join(late)}")
    return conclude(answers, "at long times, as exponent or as slope over that at half the lag, " + ". ".join(found))


@states("diffusion-rises", "9", "Short rods diffuse faster when denser", "the paper's own fit has its minimum at 0.64")
def diffusion_rises(evidence: Evidence) -> Finding:
    points = points_of(short_rods(evidence), PACKING, long_time_diffusion)
    parts = [(where, [(at, e) for at, e in points if low < at < high])
             for where, low, high in (("up to 0.65", 0, 0.66), ("from 0.65 on", 0.64, 1))]
    return conclude([trend(part, rising=True).placed(where) for where, part in parts if len(part) > 1],
                    f"D = {listed(points, 'φ')} mm²/s")


@states("diffusion-level", "9", "At 0.65 D is what the paper's fit has there, 1.7 mm²/s (ℓ = 2.5 mm)",
        "the other reason for which 200 Hz, and MSD = 4Dt, are assumed", CALIBRATES)
def diffusion_level(evidence: Evidence) -> Finding:
    runs = short_rods(evidence).at(packing=0.65)
    d = long_time_diffusion(runs)
    return conclude([close_to(d, papers_diffusion(0.65), 0.2 * papers_diffusion(0.65))] if runs else [],
                    f"D = {text(d)} mm²/s (the paper's fit: {papers_diffusion(0.65):.1f})")


@states("diffusion-law", "9", "D = 1.7 + 480 (φ − 0.64)² mm²/s for ℓ = 2.5 mm",
        "from 0.70 on. The paper prints MSD = 2Dt; the verdict is for 4Dt, which is D in the plane")
def diffusion_law(evidence: Evidence) -> Finding:
    points = [(at, e) for at, e in points_of(short_rods(evidence), PACKING, long_time_diffusion) if at > 0.66]

    def holds(d: Estimate, at: float) -> Answer:
        return close_to(d, papers_diffusion(at), 0.2 * papers_diffusion(at)).placed(f"{at:g}")

    printed = [f"{at:g}" for at, e in points if holds(e * 2, at).word]
    found = "; ".join(f"{text(e)} or {text(e * 2)} ({papers_diffusion(at):.1f}) at {at:g}" for at, e in points)
    return conclude([holds(e, at) for at, e in points],
                    f"D in mm²/s from MSD = 4Dt, or from MSD = 2Dt as printed (the paper's fit): {found}; as printed "
                    f"it holds at {', '.join(printed) or 'none of them'}")


@states("diffusion-normal", "9", "Short rods diffuse normally at short and at long times",
        "the paper contradicts itself: C_v above 0 beyond its averaging window is an exponent above 1")
def diffusion_is_normal(evidence: Evidence) -> Finding:
    runs = short_rods(evidence)
    points = runs.points(PACKING, "alpha_short")
    answers = [close_to(e, 1, 0.1).placed(f"short times, {at:g}") for at, e in points]
    found = [f"exponents at short times: {listed(points, 'φ')}"] if points else []
    grows, late = _linear_growth(runs, "/msd/total_mm2", "alpha_long")
    if late:
        found.append("at long times, as exponent or as slope over that at half the lag: " + "; ".join(late))
    return conclude([*answers, *(answer.placed(f"long times, {answer.at}") for answer in grows)], ". ".join(found))


@states("diffusion-along", "9",
        "Along the director D rises up to 0.80, then falls; across it D falls, and is smaller (ℓ = 4.5 mm)",
        "along it D is half the slope of the MSD, which is not linear: it depends on the lag, and so does whether it "
        "falls beyond 0.80")
def diffusion_along_the_director(evidence: Evidence) -> Finding:
    runs = evidence["diffusion-along"]
    across = dict(points_of(runs, PACKING, lambda here: long_time_diffusion(here, "across")))
    along = dict(points_of(runs, PACKING, lambda here: long_time_diffusion(here, "along")))
    longest = late_lags.longest_lag(runs[0], "/msd/along_mm2") if runs else math.nan
    at_20_s = late_lags.diffusion_at("along", lambda run, name: 20.48)
    late = f"lags of {longest:.0f} s" if math.isfinite(longest) else "the longest lags"
    answers, found = [], []
    for label, at in ((late, along), ("lags of 20 s", dict(runs.points(PACKING, at_20_s)))):
        if not {0.70, 0.80, 0.85} <= set(at):
            continue
        answers += [larger(at[0.80], at[0.70]).placed(f"rises to 0.80 ({label})"),
                    larger(at[0.80], at[0.85]).placed(f"falls beyond ({label})")]
        found.append(f"along, {label}: {listed(list(at.items()), 'φ')}")
    if not answers or not {0.70, 0.80} <= set(across):
        return Finding()
    answers += [larger(across[0.70], across[0.80]).placed("across it falls"),
                larger(along[0.80], across[0.80]).placed("across it is smaller")]
    return conclude(answers, ". ".join(found) + f". Across: {listed(list(across.items()), 'φ')} (mm²/s)")


@states("diffusion-across", "9",
        "Across the director nothing is super-diffusive, and dense rods are sub-diffusive at short times")
def no_superdiffusion_across(evidence: Evidence) -> Finding:
    runs = long_rods(evidence).beyond(PACKING, 0.59)
    short = runs.points(PACKING, "alpha_across_short")
    # in the widest box: in a narrow one rods glide along two or three turned layers for long
    everywhere = Runs([*runs, *evidence.joined("layers", "strip").at(4.5, end=0.4)])
    late = [(packing, late_lags.best(everywhere.at(packing=packing).widest(), late_lags.exponent("/msd/across_mm2"),
                                     "alpha_across_long")) for packing in runs.values(PACKING)]
    late = [(packing, estimate) for packing, estimate in late if estimate.is_known]
    answers, found = [], []
    for when, points in (("short", short), ("long", late)):
        answers += [below(e, 1.05).placed(f"{when} times, {at:g}") for at, e in points]
        if points:
            found.append(f"{when}: {listed(points, 'φ')}")
    answers += [below(e, 1).placed(f"sub-diffusive at {at:g}") for at, e in short if at > 0.69]
    return conclude(answers, "exponents across at times that are " + "; ".join(found))


@states("memory", "12", "C₂ and C_v decay more slowly when denser (ℓ = 2.5 mm)",
        "C_v from 0.65 on: below, its decay is that of the averaging window")
def slower_when_denser(evidence: Evidence) -> Finding:
    runs = short_rods(evidence)
    c2 = needed(runs.points(PACKING, "c2_decay_s"), 2)
    # below that it is the window over which velocities are averaged
    c_v = needed([(at, e) for at, e in runs.points(PACKING, "velocity_correlation_s") if at > 0.64], 2)
    return conclude([trend(c2, rising=True).placed("C₂"), trend(c_v, rising=True).placed("C_v from 0.65 on"),
                     *[unknown("it is that of the averaging window").placed("C_v below 0.65")
                       for _ in [at for at, _ in c2 if at < 0.64][:1]]],
                    f"C₂ falls to 1/e in {listed(c2, 'φ', ' s')}. C_v: {listed(c_v, 'φ', ' s')}")


def late_c2(runs: Runs) -> Estimate:
    """C2 at the longest lags of these runs."""
    return late_lags.best(runs, late_lags.level("/rotation/c2"), "c2_plateau")


@states("c2-decay", "12", "C₂ of short rods decays to 0 (ℓ = 2.5 mm)")
def c2_forgets(evidence: Evidence) -> Finding:
    points = points_of(short_rods(evidence), PACKING, late_c2)
    return conclude([close_to(e, 0, LEVEL).placed(f"{at:g}") for at, e in points],
                    f"C₂ at the longest lags: {listed(points, 'φ')}")


@states("c2-plateau", "12", "C₂ of long rods levels off, near 1 when dense",
        "whatever the dynamics C₂ is S² at late times: near 1 is from the square of 0.85 on, the least S that is about "
        "1")
def c2_levels_off(evidence: Evidence) -> Finding:
    runs = long_rods(evidence).beyond(PACKING, 0.59)
    points = needed(points_of(runs, PACKING, late_c2), 2)
    changes = runs.points(PACKING, late_lags.change_of_level("/rotation/c2"))
    return conclude([trend(points, rising=True).placed("grows with packing"),
                     *(close_to(e, 0, LEVEL).placed(f"level at {at:g}") for at, e in changes),
                     *(above(e, NEAR_ONE).placed(f"near 1 at {at:g}") for at, e in points if at > 0.79)],
                    f"{listed(points, 'φ')}" + (f"; over the last octave of lags it changes by {listed(changes, 'φ')}"
                                                if changes else ""))


#: Over which velocities are averaged, as in the paper [s]. Where rods have no memory beyond it, correlations
#: fall to 0 over it in about a straight line, and half of it comes out as the persistence time.
VELOCITY_WINDOW = 0.4
#: Lags of C_v that the average does not reach [s].
FREE_OF_THE_WINDOW = (0.8, 2.8)


def late_velocity_correlation(run: Run) -> Estimate:
    """C_v(t) along the director [mm2/s2], its mean over lags beyond the averaging window."""
    first, last = FREE_OF_THE_WINDOW
    return mean_over(run, "/velocity/product_along_mm2_s2", lambda lag: (lag >= first - 1e-9) & (lag <= last + 1e-9))


@states("velocity-along", "12", "C_v along the director grows with packing up to 0.80 (ℓ = 4.5 mm)",
        "of lags beyond the 400 ms over which velocities are averaged, from which the paper concludes D; C_v(0), the "
        "rattling in the cage, falls")
def velocity_along_grows(evidence: Evidence) -> Finding:
    runs = long_rods(evidence)
    points = [(at, e) for at, e in runs.points(PACKING, late_velocity_correlation) if at > 0.59]
    growing = needed([(at, e) for at, e in points if at < 0.81], 2)
    at_zero = [(at, e) for at, e in runs.points(PACKING, "velocity_variance_along_mm2_s2") if at > 0.59]
    return conclude([trend(growing, rising=True).placed("lags of 0.8 to 2.8 s"),
                     *([trend(at_zero, rising=True).placed("C_v(0)")] if len(at_zero) > 1 else [])],
                    f"C_v along, lags of 0.8 to 2.8 s: {listed(points, 'φ', ' mm²/s²')}. "
                    f"C_v(0): {listed(at_zero, 'φ')}")


@states("rotation", "13", "The rotational diffusion constant falls with packing (ℓ = 2.5 mm)")
def rotation_slows(evidence: Evidence) -> Finding:
    points = needed(evidence["short-rods"].points(PACKING, "rotational_diffusion_rad2_s"), 2)
    return conclude([trend(points, rising=False)], f"D_r = {listed(points, 'φ')} rad²/s")


@states("rotation-short", "13", "At short times rotation is sub-diffusive, the more so the denser")
def rotation_subdiffusive(evidence: Evidence) -> Finding:
    points = needed(evidence["short-rods"].points(PACKING, "alpha_rotation_short"), 2)
    return conclude([trend(points, rising=False).placed("falls with packing"),
                     *(below(e, 1).placed(f"{at:g}") for at, e in points)], f"exponent {listed(points, 'φ')}")


@states("rotation-normal", "13", "At long times rotation is diffusive (ℓ = 2.5 mm)")
def turning_diffuses(evidence: Evidence) -> Finding:
    answers, found = _linear_growth(short_rods(evidence), "/rotation/msad_rad2", "alpha_rotation_long")
    return conclude(answers, "at long times: " + "; ".join(found))


@states("rotation-saturates", "13",
        "The angle turned levels off in the nematic and grows linearly in disorder (ℓ = 4.5 mm)")
def turning_saturates(evidence: Evidence) -> Finding:
    runs, curve, own = long_rods(evidence), "/rotation/msad_rad2", "alpha_rotation_long"
    answers, found = [], []
    for packing in runs.values(PACKING):
        here = runs.at(packing=packing)
        if packing < 0.46:
            answer, numbers = _grows_linearly(here, curve, own)
        elif packing > 0.74:
            late = late_lags.best(here, late_lags.exponent(curve), own)
            answer, numbers = below(late, 0.25), f"exponent {text(late)}" if late.is_known else ""
        else:
            continue
        if numbers:
            answers.append(answer.placed(f"{packing:g}"))
            found.append(f"{numbers} at φ = {packing:g}")
    return conclude(answers, "at long times: " + "; ".join(found))


@states("defects", "14", "Defects of a system that is ordered here and there move by themselves (ℓ = 3.0 mm at 0.85)",
        "the paper's text has ℓ = 0.3 mm, its caption 3.0 mm")
def defects_move(evidence: Evidence) -> Finding:
    runs = needed(evidence["no-order"].at(3.0, 0.85))
    plus, minus, along = (runs.number(f"lasting_defect_speed_{name}_mm_s") for name in ("plus", "minus", "plus_along"))
    found = (f"ℓ = 3 mm, φ = 0.85: +1/2 move at {text(plus)} mm/s, −1/2 at {text(minus)} mm/s; +1/2 towards their own "
             f"tail: {text(along)} mm/s")
    # Which way is not said: along its own axis, either way. That it does not is known where that is less than a tenth
    # of the speed at which the other kind jitters.
    if why := doubt(along):
        return conclude([unknown(why)], found)
    either_way = along if along.value >= 0 else along * -1
    moves = above(either_way, 0)
    if not moves.word and below(either_way, 0.1 * minus.value).word:
        return conclude([NO], found)
    return conclude([moves], found)
