"""Nematic order: where it sets in, how it fluctuates, on which box and start it depends."""
import numpy as np

from ..plots import names
from ..plots.sheet import Sheet
from .evidence import GAMMA, LENGTH, PACKING, SIDE, Runs, by, key_of, points_of
from .layer_checks import two_peaks
from .late_lags import long_time_diffusion
from .material import (Material, draw_against, draw_curves, draw_points, draw_rods, draw_snapshots, labelled,
                       packing_scale, shows)
from .order_checks import ORDERED, phase_diagram, pooled_density, transition
from .scaling import LEAST_STIFFNESS, STEEPEST, boxes, power, predicted, reading_of_g2, stiffness
from .structure_checks import far_g2


@shows("2", "long-rods", "forgetting", c="steady-state")
def start(material: Material) -> Sheet:
    """Rods as they lie, and S(t) from the aligned start"""
    runs = material.evidence["long-rods"]
    sheet = material.sheet(3, height=58)
    draw_snapshots(sheet, [(runs.at(packing=packing), f"φ = {packing:g}") for packing in (0.45, 0.75)])
    panel = sheet[2].titles(names.axis_title("/order/time_s"), names.axis_title("/order/order"), "S(t)")
    scale = packing_scale(runs)
    for packing in runs.values(PACKING):
        order = runs.at(packing=packing)[0]["/order/order"]
        panel.curve(order.axis, order, colour=scale and scale(packing), look="line")
    panel.range(y=(0, 1)).reference(x=400, label="the paper: steady")
    sheet.colourbar(scale, [panel])
    return sheet


@shows("3", "long-rods", "short-rods", "crossings", "phases", "layers", "layer-trends", a="ordered saturates",
       b="transition short")
def order(material: Material) -> Sheet:
    """Mean order against area fraction, and the phase diagram"""
    runs = phase_diagram(material.evidence)
    sheet = material.sheet(2, height=62, columns=2)
    draw_against(sheet[0], PACKING, "S", labelled(runs, LENGTH), "mean order")
    sheet[0].range(y=(0, 1)).reference(y=ORDERED, label="0.5")
    panel = sheet[1].titles(names.axis_title(PACKING), names.axis_title(LENGTH), "phase diagram")
    lengths, packings = runs.values(LENGTH), runs.values(PACKING)
    grid = np.array([[runs.at(length, packing).number("S").value if runs.at(length, packing) else np.nan
                      for packing in packings] for length in lengths])
    if runs:
        panel.map(packings, lengths, grid, names.axis_title("S"), limits=(0, 1), square=False)
    passed = [(transition(runs.at(length)), length) for length in lengths]
    passed = [(phi, length) for phi, length in passed if phi.is_known]
    if passed:
        x, y = [phi.value for phi, _ in passed], [length for _, length in passed]
        for width, colour in ((3.5, "black"), (1.8, "white")):
            panel.axes.errorbar(x, y, xerr=[phi.error for phi, _ in passed], color=colour, linewidth=width, marker="o",
                                markersize=width + 1.5, zorder=5)
        panel.record("<S> = 0.5", x, y, [phi.error for phi, _ in passed])
        panel.axes.text(0.06, 0.9, "I", transform=panel.axes.transAxes, color="white", fontsize=9, fontweight="bold")
        panel.axes.text(0.9, 0.9, "N", transform=panel.axes.transAxes, color="black", fontsize=9, fontweight="bold")
    layered = [(packing, length) for length in lengths for packing in packings
               if two_peaks(material.evidence.joined("phases", "long-rods", "layers", "layer-trends", "crossings")
                            .at(length, packing, end=0.4)).word]
    if layered:
        panel.axes.scatter(*zip(*layered), marker="p", s=34, facecolor="#0072b2", edgecolor="white", linewidths=0.8,
                           zorder=6)
        panel.record("layers: P(θ) has two peaks", *zip(*layered))
    panel.note("line: ⟨S⟩ = 0.5; pentagons: layers")
    return sheet


@shows("4", "long-rods", "short-rods", a="unimodal", b="broadest")
def order_statistics(material: Material) -> Sheet:
    """Fluctuations of the order: P[S], standard deviation, Binder cumulant"""
    runs, both = material.evidence["long-rods"], material.both[::-1]
    scale = packing_scale(runs)
    sheet = material.sheet(3)
    panel = sheet[0].titles(names.axis_title("/order/pdf/order"), "P[S] / max P[S]", "distribution")
    for packing in runs.values(PACKING):
        here = runs.at(packing=packing)
        places, density, samples = pooled_density(here)
        if samples:
            panel.curve(places, density / density.max(), colour=scale and scale(packing), look="line",
                        steady=here.number("S").steady)
    panel.range((0, 1), (0, 1.05))
    sheet.colourbar(scale, [panel])
    panel = draw_against(sheet[1], PACKING, "S_std", both, "how far S fluctuates", "standard deviation of S")
    phi = transition(runs)
    if phi.is_known:
        panel.reference(x=phi.value, label="⟨S⟩ = 0.5")
    panel.range(y=(0, None))
    draw_against(sheet[2], PACKING, "binder", both, "Binder cumulant")
    sheet[2].reference(y=0, label="disorder").reference(y=1, label="order")
    return sheet


@shows("", "layer-trends", "turned", d="oblique")
def steady(material: Material) -> Sheet:
    """The axis along which rods of 3.5 mm order"""
    straight, turned = (material.evidence[name].at(3.5, 0.85) for name in ("layer-trends", "turned"))
    sheet = material.sheet(4, columns=2, height=58)
    draw_snapshots(sheet, [(straight, "started along a side"), (turned, "started at 30°")])
    for panel, name, title in ((sheet[2], "/order/order", "order"), (sheet[3], "/order/director_rad", "director")):
        panel.titles(names.axis_title("/order/time_s"),
                     "director (° from a side)" if "director" in name else names.axis_title(name), title)
        for k, (runs, label) in enumerate(((straight, "along a side"), (turned, "turned"))):
            for j, run in enumerate(runs):
                array = run[name]
                values = np.degrees(np.asarray(array)) if "director" in name else np.asarray(array)
                panel.curve(array.axis, values, label=label if j == 0 else "", colour=k, look="line")
    sheet[2].range(y=(0, 1))
    return sheet


@shows("", "shaking", b="activity")
def shaking(material: Material) -> Sheet:
    """Order and motion against the strength of shaking"""
    runs = material.evidence["shaking"].beyond(GAMMA, 0)
    sheet = material.sheet(3)
    for panel, name in zip(sheet, ("S", "diffusion_mm2_s", "rotational_diffusion_rad2_s")):
        of = {"diffusion_mm2_s": long_time_diffusion}.get(name, name)
        draw_against(panel, GAMMA, of, labelled(runs, LENGTH), y=names.axis_title(name))
        panel.range(y=(0, 1 if name == "S" else None)).reference(x=7, label="the paper's")
    return sheet


@shows("", "long-rods", "size", "dilute", "elasticity", "long-range", a="transition-size", c="long-range")
def scaling(material: Material) -> Sheet:
    """Order against the size of the box, and what the director's waves predict of it"""
    runs = boxes(material.evidence)
    sheet = material.sheet(6)
    for panel, name, title in ((sheet[0], "S", "several boxes"), (sheet[1], "binder", "Binder cumulant")):
        several = [(here if len(here.values(PACKING)) > 1 else Runs(), label) for here, label in labelled(runs, SIDE)]
        draw_against(panel, PACKING, name, several, title)
    sheet[0].range(y=(0, 1)).reference(y=ORDERED, label="0.5")

    panel = sheet[2].titles(names.axis_title(SIDE), names.axis_title("S"), "lines: waves").scale("log", "log")
    far = sheet[5].titles(names.axis_title(SIDE), "G₂ at half the box", "far away")
    stiff = sheet[4].titles(names.axis_title(SIDE), "√(K₁K₃)", "stiffness of the director").scale("log", "log")
    for k, packing in enumerate(runs.values(PACKING)):
        here, label = runs.at(packing=packing), names.value_label(PACKING, packing)
        order = here.points(SIDE, "S")
        draw_points(panel, order, label, k)
        draw_points(far, here.points(SIDE, far_g2), label, k)
        if packing < 0.54:
            continue  # no director
        draw_points(stiff, points_of(here, SIDE, stiffness), label, k)
        (first, s), x = order[0], predicted(here.largest(SIDE)).value
        sides = np.array([side for side, _ in order])
        panel.curve(sides, s.value * (sides / first) ** x, colour=k)
    stiff.reference(y=LEAST_STIFFNESS, label="8/π")
    far.zero()

    panel = sheet[3].titles(names.axis_title(PACKING), "x of S ~ Lˣ", "three readings of the power")
    ordered = [here for here in by(runs, PACKING) if key_of(here[0], PACKING) > 0.54]
    readings = (("S(L)", power), ("−1/(π√(K₁K₃))", lambda here: predicted(here.largest(SIDE))),
                ("half the power of G₂", reading_of_g2))
    for k, (label, of) in enumerate(readings):
        points = [(key_of(here[0], PACKING), of(here)) for here in ordered]
        draw_points(panel, [(at, x) for at, x in points if x.is_known], label, k)
    panel.reference(y=STEEPEST, label="−1/8").zero()
    return sheet


@shows("", "equilibrium", "short-rods", "long-rods", "crossings", "phases")
def equilibrium(material: Material) -> Sheet:
    """The equilibrium reference: e = 1, no friction"""
    quiet, shaken = material.evidence["equilibrium"], phase_diagram(material.evidence)
    sheet = material.sheet(3)
    panel = sheet[0].titles(names.axis_title(PACKING), names.axis_title("S"), "order")
    for k, length in enumerate(quiet.values(LENGTH)):
        label = names.value_label(LENGTH, length)
        draw_points(panel, quiet.at(length).points(PACKING, "S"), f"{label}, at equilibrium", 2 * k)
        draw_points(panel, shaken.at(length).points(PACKING, "S"), f"{label}, shaken", 2 * k + 1)
    panel.range(y=(0, 1))
    scale = packing_scale(quiet)
    for panel, length in zip(sheet.panels[1:], quiet.values(LENGTH)):
        draw_curves(panel, quiet.at(length), "/g2/g2", scale,
                    title=f"at equilibrium, {names.value_label(LENGTH, length)}").range(y=(0, 1)).zero()
    sheet.colourbar(scale, sheet.panels[1:])
    return sheet


@shows("", "movies")
def movies(material: Material) -> Sheet:
    """Films S1 to S7, as they are made"""
    runs = material.evidence["movies"]
    sheet = material.sheet(max(len(runs), 1), columns=4)
    for panel, run in zip(sheet, runs):
        draw_rods(panel, [run], f"ℓ = {key_of(run, LENGTH):g} mm, φ = {key_of(run, PACKING):g}, "
                  f"w = {key_of(run, 'box.gap'):g} mm", timed=False)
    return sheet
