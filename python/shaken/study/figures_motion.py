"""Motion: how rods swim, diffuse and turn, and their defects."""
import math
from functools import partial
from typing import Callable

import numpy as np

from ..estimate import Estimate
from ..plots import names
from ..plots.panel import Panel
from ..plots.sheet import Sheet
from ..run import Run
from .beyond_paper import dense_diffusion, more_rods, parabola, swimming_defects
from .evidence import FREQUENCY, LENGTH, PACKING, Evidence, Runs, number_of, place_on, points_of
from .late_lags import long_time_diffusion
from .material import Material, draw_against, draw_curve, draw_curves, draw_points, draw_snapshots, packing_scale, shows
from .motion_checks import (FREE_OF_THE_WINDOW, VELOCITY_WINDOW, beyond_reversal, late_c2, late_velocity_correlation,
                            long_rods, papers_diffusion, short_rods)
from .order_checks import phase_diagram
from .time_step import scene_of


@shows("10", "mechanism", a="tilt", b="sideways", d="switching")
def tilt(material: Material) -> Sheet:
    """How a rod swims: velocity against tilt"""
    runs = material.evidence["mechanism"]
    first = runs.at(packing=0.60)
    sheet = material.sheet(4, columns=2, height=52)
    for panel, way in zip(sheet, ("along", "across")):
        panel.titles(names.axis_title("/tilt/n_z"), names.axis_title(f"/tilt/v_{way}_mm_s"), f"{way} the rod, φ = 0.6")
        draw_curve(panel, first, f"/tilt/v_{way}_mm_s", look="points", seen=lambda e: e < 3 * np.nanmedian(e))
        panel.zero(x=True)
    for place in (-0.2, 0.2):
        sheet[0].reference(x=place, label="the paper: fastest" if place > 0 else "")
    panel = sheet[2].titles(names.axis_title("/tilt/n_z"), "$P(n_z)$", "how often a tilt occurs")
    for k, packing in enumerate(runs.values(PACKING)):
        found = runs.at(packing=packing).curve("/tilt/density")
        if found:
            panel.curve(found[0], found[1], label=names.value_label(PACKING, packing), colour=k, look="line")
    panel.range(y=(0, None))
    panel = sheet[3].titles(names.axis_title("/order/time_s"), names.axis_title("/tilt/n_z"),
                            "tilt of one rod, φ = 0.6")
    for run in first[:1]:
        n_z, time = run["/rods/trace/0/n_z"], run["/rods/trace/time_s"]
        n = min(len(n_z), len(time))
        early = np.asarray(time)[:n] < float(time[0]) + 2
        panel.curve((np.asarray(time)[:n] - float(time[0]))[early], np.asarray(n_z)[:n][early], look="line")
    panel.zero()
    return sheet


@shows("11", "mechanism", c="persistence")
def paths(material: Material) -> Sheet:
    """Paths of single rods, and how long they persist; 0.2 s, below 0.70, is half the window of 400 ms over which
    velocities are averaged"""
    runs = material.evidence["mechanism"]
    sheet = material.sheet(3, height=56)
    for panel, packing in zip(sheet, (0.65, 0.85)):
        here = runs.at(packing=packing)
        panel.titles("x (mm)", "y (mm)", f"30 s, φ = {packing:g}")
        for run in here[:1]:
            for k in range(4):
                if f"/rods/trace/{k}/x_mm" in run:
                    x, y = (np.asarray(run[f"/rods/trace/{k}/{axis}_mm"]) for axis in "xy")
                    panel.curve(x - x[0], y - y[0], colour=k, look="line")
        panel.axes.set_aspect("equal", adjustable="datalim")
    panel = sheet[2].titles(names.axis_title(PACKING), "time (s)", "how long")
    draw_points(panel, runs.points(PACKING, "persistence_time_s"), "a way persists", 0)
    draw_points(panel, runs.points(PACKING, "n_z_switching_time_s"), "a tilt keeps its sign", 1)
    panel.range(y=(0, None)).reference(y=VELOCITY_WINDOW / 2, label="half the window of 400 ms")
    return sheet


def _short_limit(name: str, kind: str, like: str) -> Callable[[Run], Estimate]:
    """Half of what a mean square rises by over the lags that are short for the run, over the time between: D in one
    direction. These are the lags of the short limit of this kind, "diffusion" or "rotation"; `like`: a number that is
    as steady."""
    def of(run: Run) -> Estimate:
        curve = run[name]
        t, values, errors = np.asarray(curve.axis), np.asarray(curve), np.asarray(curve.error)
        first, last = (place_on(t, number_of(run, f"{kind}_short_lag_{end}_s").value) for end in ("from", "to"))
        if first is None or last is None or first == last:
            return Estimate(reason="no short lags")
        twice = 2 * (t[last] - t[first])
        return Estimate((values[last] - values[first]) / twice,
                        float(np.hypot(errors[first], errors[last])) / twice, number_of(run, like).steady)

    return of


def _draw_readings(panel: Panel, evidence: Evidence, late: list[tuple[float, Estimate]]) -> None:
    """D of short rods at the longest lags by both readings of the paper's formula, at the frequency that is assumed and
    at its rival, with the parabolas of both and that of the paper."""
    rival = points_of(evidence["frequency"].where(FREQUENCY, 280), PACKING, long_time_diffusion)
    draw_points(panel, late, "longest lags, MSD = 4Dt", 1, joined=False)
    draw_points(panel, [(at, e * 2) for at, e in late if at > 0.59], "longest lags, MSD = 2Dt", 2, joined=False)
    draw_points(panel, [(at, e * 2) for at, e in rival], "280 Hz, MSD = 2Dt", 3, joined=False)
    phi = np.linspace(0.60, 0.85, 40)
    panel.reference(phi, papers_diffusion(phi), "the paper: 1.7 + 480 (φ − 0.64)²")
    if fitted := parabola(dense_diffusion(evidence)):
        d0, c, phi0 = (e.value for e in fitted[0])
        phi = phi[phi >= 0.65]
        for factor in (1, 2):
            panel.curve(phi, factor * (d0 + c * (phi - phi0) ** 2), colour=factor, look="line",
                        name=f"parabola, MSD = {4 // factor}Dt")


@shows("9", "diffusion", "short-rods", "diffusion-along", "long-rods", a="diffusion-normal", b="diffusion-law",
       d="diffusion-along", f="diffusion-across")
def diffusion(material: Material) -> Sheet:
    """Mean square displacement, D at short and at long times"""
    short, long_ = short_rods(material.evidence), long_rods(material.evidence)
    scale = packing_scale(short, long_)
    sheet = material.sheet(6, columns=2, height=50)
    rows = ((short, "total", "ℓ = 2.5 mm, in the plane"), (long_, "along", "ℓ = 4.5 mm, along the director"),
            (long_, "across", "ℓ = 4.5 mm, across"))
    for k, (runs, direction, title) in enumerate(rows):
        msd = f"/msd/{direction}_mm2"
        draw_curves(sheet[2 * k].scale("log", "log"), runs, msd, scale, title=title)
        panel = sheet[2 * k + 1].titles(names.axis_title(PACKING), "D (mm²/s)", title)
        draw_points(panel, runs.points(PACKING, "diffusion_short_mm2_s" if direction == "total" else
                                       _short_limit(msd, "diffusion", "diffusion_mm2_s")), "t → 0", 0)
        late = points_of(runs, PACKING, partial(long_time_diffusion, direction=direction))
        if direction == "total":
            _draw_readings(panel, material.evidence, late)
        else:
            draw_points(panel, late, "longest lags", 1)
        if direction == "across":
            panel.scale(y="log")
        else:
            panel.range(y=(0, None))
    sheet.colourbar(scale, [sheet[0], sheet[2], sheet[4]])
    return sheet


@shows("", "diffusion", "short-rods", "diffusion-along", "long-rods")
def diffusion_more(material: Material) -> Sheet:
    """Whether MSD/t levels off, and exponents"""
    short, long_ = short_rods(material.evidence), long_rods(material.evidence)
    scale = packing_scale(short, long_)
    sheet = material.sheet(4, columns=2, height=50)
    for panel, runs, name, title, d in ((sheet[0], short, "total", "ℓ = 2.5 mm", 4), (sheet[1], long_, "along",
                                        "ℓ = 4.5 mm, along", 2), (sheet[2], long_, "across", "ℓ = 4.5 mm, across", 2)):
        panel.titles(names.axis_title("/msd/lag_s"), f"MSD/{d}t (mm²/s)", title).scale("log", "linear")
        draw_curves(panel, runs, f"/msd/d_{name}_mm2_s", scale, keep=lambda t, d: t > 0.1).range(y=(0, None))
    sheet.colourbar(scale, sheet.panels[:3])
    panel = sheet[3].titles(names.axis_title(PACKING), "exponent of the MSD, short times", "normal diffusion: 1")
    draw_points(panel, short.points(PACKING, "alpha_short"), "ℓ = 2.5 mm", 0)
    draw_points(panel, long_.points(PACKING, "alpha_along_short"), "ℓ = 4.5 mm, along", 1)
    draw_points(panel, long_.points(PACKING, "alpha_across_short"), "ℓ = 4.5 mm, across", 2)
    panel.reference(y=1)
    return sheet


@shows("12", "short-rods", "long-rods", "diffusion-along", a="memory", b="c2-plateau", f="velocity-along")
def memory(material: Material) -> Sheet:
    """Correlations in time: orientation C₂, velocity C_v"""
    short, long_ = material.evidence["short-rods"], material.evidence["long-rods"]
    scale = packing_scale(short, long_)
    sheet = material.sheet(6)
    for panel, (runs, title) in zip(sheet, material.both):
        draw_curves(panel.scale("log"), runs, "/rotation/c2", scale, title=title).range(y=(0, 1)).zero()
    panel = sheet[2].titles(names.axis_title(PACKING), names.axis_title("c2_plateau"), "what stays, ℓ = 4.5 mm")
    draw_points(panel, points_of(long_rods(material.evidence), PACKING, late_c2)).range(y=(0, 1))
    for panel, runs, name, title in ((sheet[3], short, "c_v", "velocity, ℓ = 2.5 mm"),
                                     (sheet[4], long_, "c_v_along", "along, ℓ = 4.5 mm")):
        draw_curves(panel, runs, f"/velocity/{name}", scale, keep=lambda t, c: t < 2.05, title=title)
        panel.zero().reference(x=VELOCITY_WINDOW, label="window of the velocities")
    sheet.colourbar(scale, [sheet[0], sheet[1], sheet[3], sheet[4]])
    low, high = FREE_OF_THE_WINDOW
    panel = sheet[5].titles(names.axis_title(PACKING), "$C_v$ along (mm²/s²)", f"lags of {low:g} to {high:g} s")
    draw_points(panel, [(at, e) for at, e in long_rods(material.evidence).points(PACKING, late_velocity_correlation)
                        if at > 0.59])
    panel.zero()
    return sheet


@shows("13", "short-rods", "long-rods", b="rotation-saturates", c="rotation", d="rotation-short")
def rotation(material: Material) -> Sheet:
    """Mean square angular displacement and rotational diffusion"""
    short, long_ = material.evidence["short-rods"], material.evidence["long-rods"]
    scale = packing_scale(short, long_)
    sheet = material.sheet(4, columns=2, height=52)
    for panel, (runs, title) in zip(sheet, material.both):
        draw_curves(panel.scale("log", "log"), runs, "/rotation/msad_rad2", scale, title=title)
    sheet.colourbar(scale, sheet.panels[:2])
    panel = sheet[2].titles(names.axis_title(PACKING), names.axis_title("rotational_diffusion_rad2_s"), "ℓ = 2.5 mm")
    draw_points(panel.scale(y="log"), short.points(PACKING, _short_limit("/rotation/msad_rad2", "rotation", "S")),
                "t → 0", 0)
    draw_points(panel, short.points(PACKING, "rotational_diffusion_rad2_s"), "t → ∞", 1)
    draw_against(sheet[3], PACKING, "alpha_rotation_short", [(short, "")], "ℓ = 2.5 mm",
                 "exponent $α_r$, short times").reference(y=1)
    return sheet


@shows("14", "no-order", c="defects")
def defects(material: Material) -> Sheet:
    """Defects of rods that are ordered here and there"""
    runs = material.evidence["no-order"].at(3.0, 0.85)
    sheet = material.sheet(4, columns=2, height=66)
    draw_snapshots(sheet, [(runs, "ℓ = 3 mm, φ = 0.85")], k=1, defects=True)
    panel = sheet[1].titles(names.axis_title("/defects/time_s"), "defects of charge +1/2", "as many of −1/2")
    for run in runs:
        if "/defects/n_plus" in run:
            panel.curve(run["/defects/n_plus"].axis, run["/defects/n_plus"], look="line")
    panel.range(y=(0, None))
    panel = sheet[2].titles("time over which a way is taken (s)", "mean speed (mm/s)", "of those that last")
    panel.scale("log", "linear")
    for k, (name, label) in enumerate((("speed_plus", "+1/2"), ("speed_minus", "−1/2"),
                                       ("speed_plus_along", "+1/2, towards its tail"))):
        draw_curve(panel, runs, f"/defects/tracks/lasting/{name}_mm_s", label, k, "points")
    panel.zero()
    draw_curves(sheet[3], runs, "/g2/g2", None, title="orientation").zero()
    return sheet


@shows("", "long-rods", "short-rods", "crossings", "phases")
def melting(material: Material) -> Sheet:
    """Defects against packing and order, and how +1/2 defects move"""
    runs = phase_diagram(material.evidence)
    sheet = material.sheet(3, height=55)
    three = sheet[2].titles(names.axis_title(PACKING), "velocity of +1/2 (mm/s)", "head first where > 0")
    one = sheet[0].titles(names.axis_title(PACKING), names.axis_title("defect_density_per_mm2"), "defects")
    two = sheet[1].titles(names.axis_title("S"), names.axis_title("defect_density_per_mm2"), "against order")
    for k, length in enumerate(runs.values(LENGTH)):
        here, label = runs.at(length), names.value_label(LENGTH, length)
        points = here.points(PACKING, "defect_density_per_mm2")
        draw_points(one, points, label, k)
        draw_points(two, [(here.at(packing=at).number("S").value, e) for at, e in points], label, k, joined=False)
        draw_points(three, swimming_defects(here), label, k)
    for panel in (one, two):
        panel.range(y=(0, None))
    three.zero()
    return sheet


@shows("", "frequency", "density", "beads", "diffusion", "short-rods", "inertia")
def model(material: Material) -> Sheet:
    """What the paper leaves open: frequency, number of rods, beads, moments of inertia"""
    evidence = material.evidence
    shaken = evidence["frequency"].at(packing=0.60)
    sheet = material.sheet(6)
    panel = sheet[0].titles(names.axis_title("/tilt/n_z"), "velocity along the rod (mm/s)", "φ = 0.6, ℓ = 2.5 mm")
    for k, frequency in enumerate((100, 150, 200, 250, 300)):
        draw_curve(panel, shaken.where(FREQUENCY, frequency), "/tilt/folded/v_along_mm_s",
                   names.value_label(FREQUENCY, frequency), k, seen=lambda e: e < 0.25)
    panel.zero()
    draw_against(sheet[1], FREQUENCY, lambda here: here.of(beyond_reversal), [(shaken, "")], "reversed where > 0",
                 "velocity beyond $n_z$ = 0.31 (mm/s)").zero()
    panel = draw_against(sheet[2], FREQUENCY, "diffusion_mm2_s", [(shaken, "measured")], "φ = 0.6",
                         "D, as MSD/4t (mm²/s)")
    panel.reference(y=papers_diffusion(0.60), label="the paper's fit, MSD = 4Dt")
    panel.reference(y=papers_diffusion(0.60) / 2, label="the paper's fit, MSD = 2Dt")
    panel.range(y=(0, None))
    usual = [(at, e) for at, e in points_of(short_rods(evidence), PACKING, long_time_diffusion) if at > 0.59]
    beads = points_of(evidence["inertia"], PACKING, long_time_diffusion)
    phi = np.linspace(0.60, 0.85, 40)
    for panel, title, one, points, another in (
            (sheet[3], "moments of inertia", "a uniform solid's", beads, "those of the beads"),
            (sheet[4], "3.3 % more rods", "N of the area fraction", more_rods(evidence), "N × 1.033")):
        panel.titles(names.axis_title(PACKING), "D (mm²/s)", title)
        draw_points(panel, usual, one, 0)
        draw_points(panel, points, another, 1)
        panel.reference(phi, papers_diffusion(phi), "the paper's fit").range(y=(0, None))
    panel = sheet[5].titles("beads of a rod", "D (mm²/s)", "φ = 0.75").range(y=(0, None))
    draw_points(panel, evidence["beads"].points("rods.beads", "diffusion_mm2_s"))
    panel.reference(y=papers_diffusion(0.75), label="the paper's fit")
    return sheet


@shows("", "long-rods")
def accuracy(material: Material) -> Sheet:
    """The same points at the paper's time step and at the desk's"""
    numbers = ("S", "diffusion_mm2_s", "rotational_diffusion_rad2_s", "theta_m_deg", "velocity_rms_mm_s", "c2_decay_s")
    sheet = material.sheet(2, columns=1, height=70)
    panel = sheet[0].titles("", "4 µs over 16 µs", "ratio of the same number")
    other = sheet[1].titles("", "difference / its error", "how significant")
    for k, name in enumerate(numbers):
        points = []
        for place, (set_name, controls) in enumerate(sorted(material.evidence.controls.items())):
            for control in controls:
                twin = Runs(run for run in material.evidence[set_name] if scene_of(run) == scene_of(control))
                a, b = twin.number(name), number_of(control, name)
                if not (twin and a.is_known and b.is_known and a.value):
                    continue
                error = math.hypot(a.error, b.error)
                points.append((place + (k - 2.5) * 0.1, b.value / a.value, abs(error / a.value),
                               (b.value - a.value) / error if error else math.nan))
        if points:
            x, ratios, errors, sigmas = zip(*points)
            title = names.symbol(name)
            panel.curve(x, ratios, errors, label=title, colour=k, look="points", joined=False)
            other.curve(x, sigmas, label=title, colour=k, look="points", joined=False)
    for one in (panel, other):
        one.axes.set_xticks(range(len(material.evidence.controls)), sorted(material.evidence.controls), rotation=30,
                            ha="right")
    panel.reference(y=1)
    other.reference(y=-2).reference(y=2)
    return sheet
