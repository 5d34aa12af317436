"""What the runs have that the paper does not: the tables of docs/findings.md."""
import math
from typing import Callable, Iterable, Sequence

import numpy as np

from ..estimate import Estimate, derived
from ..plots import names
from ..run import Run
from . import late_lags, response, scaling
from .evidence import (BEADS, END, FREQUENCY, GAMMA, LENGTH, PACKING, SIDE, Evidence, Runs, box_of, box_text,
                       by, is_from_a_fluid, key_of, number_of, place_on, points_of)
from .late_lags import long_time_diffusion
from .layer_checks import layered, theta_m
from .layer_wavelength import mean_wavelength
from .motion_checks import (PAPERS_PARABOLA, beyond_reversal, late_velocity_correlation, long_rods, papers_diffusion,
                            short_rods)
from .rules import markdown, text
from .structure_checks import mean_waves, ordered_in_large_boxes

#: A column of a table: its heading, and what it says of the runs at one state point, in words or as a number.
Column = tuple[str, Callable[[Runs], str | Estimate]]


def table(points: Iterable[Runs], columns: Sequence[Column]) -> str:
    """A table of Markdown with a row for the runs at each state point; state points without runs are left out."""
    headings, cells = zip(*columns)
    rows = [[cell(runs) for cell in cells] for runs in points if runs]
    return markdown(headings, [[text(said) if isinstance(said, Estimate) else said for said in row] for row in rows])


def key(heading: str, path: str, unit: str = "") -> Column:
    """A key of the scene."""
    return heading, lambda runs: f"{key_of(runs[0], path):.3g}{unit}"


def number(heading: str, of: str | Callable[[Run], Estimate], factor: float = 1.0) -> Column:
    """A number with its error, the mean over the replicas."""
    return heading, lambda runs: (runs.number(of) if isinstance(of, str) else runs.of(of)) * factor


def seeds(runs: Runs) -> str:
    """How many runs, and for how long each was simulated."""
    return f"{len(runs)} × {runs[0].summary['sim_seconds']:.0f} s"


PACKED, LONG, BOX = key("φ", PACKING), key("ℓ", LENGTH, " mm"), ("box", lambda runs: box_text(runs[0]))
SEEDS: Column = ("runs", seeds)
START: Column = ("start", lambda runs: "a fluid" if is_from_a_fluid(runs[0]) else "rows")
STEP = "time.step"


def rods_per_area(runs: Runs) -> float:
    """Number of rods per area of the box [1/mm2]."""
    return runs[0].summary["n_rods"] / math.prod(box_of(runs[0]))


def log_interpolated(points: Sequence[tuple[float, Estimate]], x: float) -> Estimate:
    """A positive number at x, on the straight line of its logarithm between the neighbours of x; not known outside."""
    for (x0, low), (x1, high) in zip(points, points[1:]):
        if x0 <= x <= x1:
            part = (x - x0) / (x1 - x0)
            value = low.value ** (1 - part) * high.value ** part
            return derived(value, [((1 - part) * value / low.value, low), (part * value / high.value, high)])
    return Estimate(reason="outside")


def beads(evidence: Evidence) -> str:
    """D against the number of beads at one area fraction, and beside D of the usual rods where as many lie in an area,
    in which the set `density` gives its neighbours."""
    runs = evidence["beads"]
    usual = runs.where(BEADS, 9)
    neighbours = [*by(evidence["density"], PACKING), *by(usual, PACKING)]
    reference = sorted(((rods_per_area(here), here.number("diffusion_mm2_s")) for here in neighbours),
                       key=lambda point: point[0])

    def at_same_number(here: Runs) -> Estimate:
        return log_interpolated(reference, rods_per_area(here))

    def compared(here: Runs) -> Estimate:
        other = at_same_number(here)
        return here.number("diffusion_mm2_s") / other if key_of(here[0], BEADS) != 9 else Estimate()

    found = table(by(runs, BEADS), [
        key("beads", BEADS), PACKED, BOX, SEEDS, ("rods per cm²", lambda here: f"{100 * rods_per_area(here):.1f}"),
        number("D (mm²/s)", "diffusion_mm2_s"), number("v beyond n_z = 0.31 (mm/s)", beyond_reversal),
        ("D of 9 beads, as many rods", at_same_number), ("ratio", compared)])
    if runs:
        fewest, most = (runs.where(BEADS, runs.values(BEADS)[k]) for k in (0, -1))
        found += f"\nD of the fewest beads over D of the most, at the same area fraction: " \
                 f"{text(fewest.number('diffusion_mm2_s') / most.number('diffusion_mm2_s'))}.\n"
    return found


#: Number of rods in the paper's larger box over that of their area fraction here.
MORE_RODS = 1.033


def parabola(points: Sequence[tuple[float, Estimate]]) -> tuple[list[Estimate], float] | None:
    """(D0, C, phi0) of D0 + C (phi - phi0)^2, fitted to (phi, D) with the weights of the errors, and chi square per
    degree of freedom, by whose root the errors are larger where it is above 1. None of fewer than four points.

    Errors of the three go to first order through the covariance of the polynomial's coefficients.
    """
    known = [(at, found.value, found.error) for at, found in points if found.error > 0]
    if len(known) < 4:
        return None
    at, value, error = np.array(known).T
    middle = at.mean()
    (c, b, a), covariance = np.polyfit(at - middle, value, 2, w=1 / error, cov="unscaled")
    chi2 = float((((np.polyval((c, b, a), at - middle) - value) / error) ** 2).sum()) / (len(known) - 3)
    slopes = np.array([[b * b / (4 * c * c), -b / (2 * c), 1], [1, 0, 0], [b / (2 * c * c), -1 / (2 * c), 0]])
    errors = np.sqrt(np.diag(slopes @ covariance @ slopes.T) * max(1.0, chi2))
    values = (a - b * b / (4 * c), c, middle - b / (2 * c))
    return [Estimate(float(v), float(e), True) for v, e in zip(values, errors)], chi2


def dense_diffusion(evidence: Evidence) -> list[tuple[float, Estimate]]:
    """(area fraction, D of MSD = 4Dt) of rods of 2.5 mm from 0.65 on, where the paper's fit rises."""
    return [(at, found) for at, found in points_of(short_rods(evidence), PACKING, long_time_diffusion) if at > 0.64]


def more_rods(evidence: Evidence) -> list[tuple[float, Estimate]]:
    """The same with 3.3 % more rods, at the area fraction that they stand for."""
    return [(round(at / MORE_RODS, 3), found)
            for at, found in points_of(evidence["density"], PACKING, long_time_diffusion)]


def readings(evidence: Evidence) -> str:
    """D of rods of 2.5 mm by both readings of the paper's formula beside its fit, and the fits to both."""
    rival = dict(points_of(evidence["frequency"].where(FREQUENCY, 280), PACKING, long_time_diffusion))
    usual = points_of(short_rods(evidence), PACKING, long_time_diffusion)
    rows = []
    for at, d, rods, other in (*((at, d, "N", rival.get(at)) for at, d in usual if at > 0.59),
                               *((at, d, f"{MORE_RODS} N", None) for at, d in more_rods(evidence))):
        fit = papers_diffusion(at)
        cells = [d, d / fit, d * 2, d * 2 / fit,
                 *([other * 2, other * 2 / fit] if other else [Estimate(), Estimate()])]
        rows.append([f"{at:.3g}", rods, f"{fit:.1f}", *map(text, cells)])
    found = markdown(["φ", "rods", "the paper's fit", "200 Hz, MSD = 4Dt", "over the fit", "200 Hz, MSD = 2Dt",
                      "over the fit", "280 Hz, MSD = 2Dt", "over the fit"], rows)
    fits = [(name, fitted) for name, points in (("N rods", dense_diffusion(evidence)),
                                                (f"{MORE_RODS} N rods", more_rods(evidence)))
            if (fitted := parabola(points))]
    if fits:
        d0, c, phi0 = PAPERS_PARABOLA
        found += "\nThe parabola D₀ + C (φ − φ₀)², fitted from 0.65 on:\n\n" + markdown(
            ["of", "D₀ (mm²/s)", "C (mm²/s)", "φ₀", "χ² per degree of freedom"],
            [["the paper", f"{d0:g}", f"{c:g}", f"{phi0:g}", "–"],
             *([f"{name}, MSD = {4 // factor}Dt", text(values[0] * factor), text(values[1] * factor), text(values[2]),
                f"{chi2:.2g}"] for name, (values, chi2) in fits for factor in (1, 2))])
    return found


def inertia(evidence: Evidence) -> str:
    """D of rods of 2.5 mm whose mass is that of their beads added up, beside that of uniform solids."""
    usual = short_rods(evidence)

    def solid(here: Runs) -> Estimate:
        return long_time_diffusion(usual.at(packing=key_of(here[0], PACKING), side=key_of(here[0], SIDE)))

    return table(by(evidence["inertia"], PACKING), [
        PACKED, BOX, SEEDS, ("D, uniform solid (mm²/s)", solid), ("D, beads added up (mm²/s)", long_time_diffusion),
        ("ratio", lambda here: long_time_diffusion(here) / solid(here)),
        number("tilt keeps its sign (ms)", "n_z_switching_time_s", 1000),
        number("v beyond n_z = 0.31 (mm/s)", beyond_reversal)])


def frequency(evidence: Evidence) -> str:
    """Swimming and D of rods of 2.5 mm at 0.60 against the frequency; the paper's fit has 2.5 mm2/s there."""
    runs = evidence["frequency"].at(packing=0.60)
    return table(by(runs, FREQUENCY), [
        key("f (Hz)", FREQUENCY), BOX, SEEDS, number("D, MSD = 4Dt (mm²/s)", "diffusion_mm2_s"),
        number("tilt keeps its sign (ms)", "n_z_switching_time_s", 1000),
        number("v beyond n_z = 0.31 (mm/s)", beyond_reversal)])


def rival_frequency(evidence: Evidence) -> str:
    """Whether rods of 2.5 mm diffuse normally and swim as the paper draws it at 280 Hz."""
    runs = evidence["frequency"].where(FREQUENCY, 280)
    return table(by(runs, PACKING), [
        PACKED, BOX, SEEDS, ("D at long lags over that at short ones",
                             lambda here: here.number("diffusion_mm2_s") / here.number("diffusion_short_mm2_s")),
        number("exponent, long lags", "alpha_long"),
        number("v beyond n_z = 0.31 (mm/s)", beyond_reversal)])


def shaking(evidence: Evidence) -> str:
    """Order and motion at area fraction 0.75 against the strength of shaking."""
    shaken = evidence["shaking"].beyond(GAMMA, 0)
    return table(by(shaken, LENGTH, GAMMA), [
        LONG, key("Γ", GAMMA), BOX, SEEDS, number("S", "S"), longest_lag("total"),
        ("D (mm²/s)", long_time_diffusion), number("exponent there", late_lags.exponent("/msd/total_mm2")),
        number("D_r (rad²/s)", "rotational_diffusion_rad2_s")])


def longest_lag(direction: str) -> Column:
    """The lag at the end of the octave over which D is read; a dash where it is the runs' own."""
    def of(here: Runs) -> str:
        is_late = math.isfinite(here.of(late_lags.diffusion_at(direction)).error)
        return f"{late_lags.longest_lag(here[0], f'/msd/{direction}_mm2'):.0f}" if is_late else "–"

    return "lag (s)", of


def diffusion_minimum(evidence: Evidence) -> str:
    """D of rods of 2.5 mm against packing, with the persistence of their ways and of their tilt."""
    def switching(here: Runs) -> Estimate:
        same = evidence["mechanism"].at(packing=key_of(here[0], PACKING))
        return same.number("n_z_switching_time_s") * 1000

    runs = evidence.joined("short-rods", "mechanism").at(length=2.5)
    return table(by(runs, PACKING, SIDE), [
        PACKED, BOX, SEEDS, longest_lag("total"), ("D (mm²/s)", long_time_diffusion),
        number("slope, over that at half the lag", late_lags.change_of_slope("/msd/total_mm2")),
        number("exponent, short lags", "alpha_short"),
        number("persistence time (s)", "persistence_time_s"), number("length (mm)", "persistence_length_mm"),
        ("tilt keeps its sign (ms)", switching)])


def way_in_boxes(run: Run) -> Estimate:
    """Root mean square displacement along the director at the longest lag, in sides of the box, the common drift of all
    rods included."""
    msd = run["/msd/along_mm2"]
    last = float(np.asarray(msd)[-1])
    error = float(np.asarray(msd.error)[-1]) if msd.error is not None else math.nan
    way = math.sqrt(last) / key_of(run, SIDE)
    return Estimate(way, 0.5 * way * error / last, number_of(run, "S").steady)


def drift_part(run: Run) -> Estimate:
    """The part of the mean square displacement at the longest lag that is the common drift of all rods."""
    total, relative = (float(np.asarray(run[f"/msd/{name}_mm2"])[-1]) for name in ("total", "relative_total"))
    return Estimate(1 - relative / total, steady=True)


def streaming(evidence: Evidence) -> str:
    """Motion of rods of 4.5 mm along the director, dense."""
    points = [here for name in ("long-rods", "diffusion-along", "layers")
              for here in by(evidence[name].beyond(PACKING, 0.59), PACKING, SIDE)]
    points.sort(key=lambda here: (key_of(here[0], PACKING), key_of(here[0], SIDE), here[0].summary["sim_seconds"]))

    def longest(here: Runs) -> str:
        return f"{np.asarray(here[0]['/msd/along_mm2'].axis)[-1]:.0f}" if "/msd/along_mm2" in here[0] else "–"

    def drift(here: Runs) -> str:
        mean = here.of(drift_part)
        return f"{100 * mean.value:.1f} %" if mean.is_known else "–"

    return table(points, [
        PACKED, BOX, SEEDS, longest_lag("along"),
        ("D along (mm²/s)", lambda here: long_time_diffusion(here, "along")),
        number("slope, over that at half the lag", late_lags.change_of_slope("/msd/along_mm2")),
        number("exponent", late_lags.exponent("/msd/along_mm2")),
        number("C_v along, 0.8 to 2.8 s (mm²/s²)", late_velocity_correlation), ("longest lag (s)", longest),
        number("way along by then, in boxes", way_in_boxes), ("of it common drift", drift)])


def neighbours(evidence: Evidence) -> str:
    """How alike neighbours move, beside how long a rod keeps its direction."""
    return table(by(evidence["neighbours"], PACKING), [
        PACKED, BOX, SEEDS, number("C of neighbours", "flow_of_neighbours"),
        number("C falls to 1/e at (mm)", "flow_length_mm"), number("persistence time (s)", "persistence_time_s"),
        number("length (mm)", "persistence_length_mm")])


def linear_response(evidence: Evidence) -> str:
    """How fast rods drift that a constant force pulls, and how their centre of mass wanders."""
    runs = evidence["response"]
    rods = {2.5: short_rods(evidence), 4.5: long_rods(evidence)}

    def own_diffusion(here: Runs, way: str) -> Estimate:
        known = rods.get(key_of(here[0], LENGTH), Runs()).at(packing=key_of(here[0], PACKING))
        return long_time_diffusion(known, way) if known else Estimate(reason="not measured")

    rows = []
    for here in by(runs, LENGTH, PACKING):
        both = key_of(here[0], LENGTH) > 4
        for degrees in response.directions(here):
            down = response.pulled(here, degrees)
            way = ("across" if degrees else "along") if both else "total"
            tau, kinetic = down.of(response.damping_time), here.of(response.kinetic)
            wide = (response.pulled(here, 90 - degrees) if both else down).of(response.wandering)
            own = own_diffusion(here, way)
            taus = [text(down.where("plates.inclination", angle).of(response.damping_time)) for angle in (0.1, 0.25)]
            rows.append([f"{key_of(here[0], LENGTH):g} mm", f"{key_of(here[0], PACKING):g}",
                         {"total": "either way"}.get(way, way + " the director"), seeds(down), *taus,
                         *(text(cell) for cell in (down.of(response.later_over_earlier), kinetic, wide,
                                                   wide / (tau * kinetic), own, own / (tau * kinetic)))])
    return markdown(["ℓ", "φ", "pulled", "runs", "τ at 0.1° (s)", "τ at 0.25° (s)", "later half over earlier",
                     "T/m (mm²/s²)", "N D_c (mm²/s)", "over τT/m", "D of a rod (mm²/s)", "over τT/m"], rows)


#: Fewer lasting defects than this [1/mm2], of both signs, are one in a box of 33 mm at a time.
_ENOUGH_DEFECTS = 0.0009


def defect_runs(evidence: Evidence) -> Runs:
    """Runs in which defects are followed, with those at the paper's time step."""
    names = ("long-rods", "short-rods", "crossings", "phases", "dilute", "no-order")
    controls = [run for name in names for run in evidence.controls.get(name, Runs())]
    return Runs([*evidence.joined(*names), *controls])


def swim_head_first(here: Runs) -> Estimate:
    """Velocity of lasting +1/2 defects along their axis [mm/s], above 0 where the head of the comet is ahead; not known
    where there are too few of them, or no error."""
    along = here.number("lasting_defect_speed_plus_along_mm_s")
    if not math.isfinite(along.error) or here.number("lasting_defect_density_per_mm2").value < _ENOUGH_DEFECTS:
        return Estimate(reason="too few defects")
    return along * -1


def swimming_defects(runs: Runs) -> list[tuple[float, Estimate]]:
    """(area fraction, velocity head first) where it is known."""
    found = [(packing, swim_head_first(runs.at(packing=packing))) for packing in runs.values(PACKING)]
    return [(packing, velocity) for packing, velocity in found if velocity.is_known]


def over_one_sample(run: Run) -> Estimate:
    """The velocity of `swim_head_first` over one sample in place of four [mm/s]: jitter alone would be four times as
    fast there."""
    curve = run.arrays.get("/defects/tracks/lasting/speed_plus_along_mm_s")
    if curve is None or curve.error is None:
        return Estimate(reason="not measured")
    return Estimate(-float(curve[0]), float(curve.error[0]), number_of(run, "lasting_defect_density_per_mm2").steady)


def defects(evidence: Evidence) -> str:
    """How lasting defects move: +1/2 along their own axis, head of the comet first or tail first."""
    return table([here for here in by(defect_runs(evidence), LENGTH, PACKING, SIDE, STEP)
                  if swim_head_first(here).is_known], [
        LONG, PACKED, BOX, ("step", lambda here: f"{1e6 * key_of(here[0], STEP):.0f} µs"), SEEDS, number("S", "S"),
        number("defects per cm²", "lasting_defect_density_per_mm2", 100),
        number("speed of −½ (mm/s)", "lasting_defect_speed_minus_mm_s"), ("+½ head first (mm/s)", swim_head_first),
        number("over one sample (mm/s)", over_one_sample),
        number("across (mm/s)", "lasting_defect_speed_plus_across_mm_s")])


def carried(evidence: Evidence) -> str:
    """How +1/2 defects move along their axis, and the rods in their cores."""
    return table(by(evidence["defect-flow"], LENGTH, PACKING), [
        LONG, PACKED, BOX, SEEDS, number("rods in the core, of the mean density", "core_density_plus"),
        number("they move head first (mm/s)", "core_flow_along_mm_s", -1), ("+½ head first (mm/s)", swim_head_first),
        number("rods across (mm/s)", "core_flow_across_mm_s")])


def wave_ratio(length: float, *, with_noise: bool = False) -> Callable[[Runs], Estimate]:
    """Power of splay over that of bend, of the opposite waves whose length is nearest to this one [mm]; with_noise: as
    measured, before the noise level of uncorrelated rods is subtracted from both."""
    def of(here: Runs) -> Estimate:
        waves = sorted(mean_waves(here), key=lambda wave: -wave.q)
        place = place_on(np.array([2 * math.pi / wave.q for wave in waves]), length)
        if place is None:
            return Estimate(reason="no wave of this length")
        near = waves[place]
        return (near.with_noise(here.number("frank_floor_mm2").value) if with_noise else near).ratio

    return of


def elastic(evidence: Evidence) -> str:
    """Splay against bend of rods of 4.5 mm: the powers of their waves, the constants, and whether their law fits."""
    return table(by(ordered_in_large_boxes(evidence), PACKING, SIDE), [
        PACKED, BOX, SEEDS, number("S", "S"), ("splay/bend, waves of 22 mm", wave_ratio(22.3)),
        ("of 13 mm", wave_ratio(13.4)), ("of 13 mm, noise included", wave_ratio(13.4, with_noise=True)),
        number("K₃/K₁", "frank_ratio"), number("χ² per point", "frank_chi2")])


def sizes(evidence: Evidence) -> str:
    """Order of rods of 4.5 mm against the side of the box, and its power as three readings have it."""
    runs = scaling.boxes(evidence)

    def power(here: Runs) -> Estimate:
        alike = runs.at(packing=key_of(here[0], PACKING))
        narrower = [side for side in alike.values(SIDE) if side < key_of(here[0], SIDE) - 1]
        return scaling.power(Runs([*alike.at(side=narrower[-1]), *here]) if narrower else here)

    return table(by(runs, PACKING, SIDE), [
        PACKED, BOX, SEEDS, number("S", "S"), ("x of S ~ Lˣ, from the box before", power),
        ("−1/(π√(K₁K₃))", scaling.predicted), number("half the power of G₂", scaling.half_power_of_g2),
        ("√(K₁K₃)", scaling.stiffness), number("χ² per point", "frank_chi2")])


def blunt(evidence: Evidence) -> str:
    """Rods of 4 mm with ends of several diameters: crystalline order and P(theta), from rows and from a fluid."""
    points = [here for name in ("layer-trends", "fluid-start", "strip")
              for here in by(evidence[name].at(4.0).beyond(PACKING, 0.78), END, PACKING)]
    points.sort(key=lambda here: (key_of(here[0], END), key_of(here[0], PACKING)))
    return table(points, [
        key(names.plain(names.symbol(END)), END, " mm"), PACKED, BOX, START, SEEDS, number("S", "S"),
        number("ψ₆", "psi_6"), number("Bragg peak", "bragg_peak"), number("P(0)/maximum", "dip"),
        number("layer order", "layer_order"), number("D along (mm²/s)", "diffusion_along_mm2_s")])


def strip(evidence: Evidence) -> str:
    """Layers in a strip that is long across the rods beside those in the square box; nothing where none was run."""
    strips = evidence["strip"].at(end=0.4).beyond(PACKING, 0.78)
    if not strips:
        return ""

    def step(here: Runs) -> str:
        _, across = box_of(here[0])
        found = mean_wavelength(layered(here))
        n = round(across / found.value) if found.is_known else 0
        return f"{across / n - across / (n + 1):.2g}" if n else "–"

    squares = evidence.joined("layers", "layer-trends")
    both = [runs for there in by(strips, LENGTH, PACKING)
            for runs in (squares.at(key_of(there[0], LENGTH), key_of(there[0], PACKING), end=0.4), there)]
    return "The same rods in a strip, along whose length more wavelengths fit:\n\n" + table(both, [
        LONG, PACKED, BOX, START, SEEDS, number("S", "S"), number("θ_m (°)", theta_m),
        ("λ (mm)", lambda here: mean_wavelength(layered(here))), ("step of λ (mm)", step),
        number("layer order", "layer_order")])


#: What makes each table of docs/findings.md, by the names of its marks.
SECTIONS: dict[str, Callable[[Evidence], str]] = {
    "beads": beads, "two readings": readings, "inertia": inertia, "frequency": frequency,
    "rival frequency": rival_frequency, "shaking": shaking, "diffusion": diffusion_minimum, "neighbours": neighbours,
    "streaming": streaming, "linear response": linear_response, "defects": defects, "carried": carried,
    "elastic constants": elastic, "order and box": sizes, "blunt rods": blunt}
