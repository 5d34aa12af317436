"""Structure: correlations in space, layers and what they depend on, the gap, elasticity."""
from typing import Any, Sequence

import numpy as np
from numpy.typing import NDArray

from ..plots import names
from ..plots.panel import Panel
from ..plots.sheet import Sheet
from ..plots.style import ColourScale
from .layer_checks import layered, mean_angle
from .layer_wavelength import mean_wavelength
from .evidence import END, GAP, LENGTH, PACKING, SIDE, Runs, box_text, key_of
from .material import Material, draw_against, draw_curve, draw_curves, draw_points, draw_snapshots, packing_scale, shows
from .structure_checks import mean_waves, ordered_in_large_boxes


@shows("5", "short-rods", "long-rods", a="g2")
def g2(material: Material) -> Sheet:
    """Orientational correlation G₂(r) on logarithmic axes"""
    sheet = material.sheet(2, height=58, columns=2)
    scale = packing_scale(*(runs for runs, _ in material.both))
    for panel, (runs, title) in zip(sheet, material.both):
        draw_curves(panel.scale("log", "log"), runs, "/g2/g2", scale, keep=lambda r, g: r > 0.5, title=title)
        panel.range(y=(3e-3, 1.1), exactly=True)
    sheet.colourbar(scale)
    return sheet


def _mean_map(runs: Runs, name: str) -> NDArray[Any] | None:
    found = [np.asarray(run[name]) for run in runs if name in run]
    return np.mean(found, axis=0) if found else None


def _maps(sheet: Sheet, panels: Sequence[Panel], sets: Sequence[tuple[Runs, str]], name: str) -> None:
    """Maps side by side in the same colours, with one bar for all."""
    means = [(panel, runs, title, _mean_map(runs, name)) for panel, (runs, title) in zip(panels, sets)]
    seen = [mean[np.isfinite(mean)] for *_, mean in means if mean is not None]
    if not seen:
        return
    low, high = np.percentile(np.concatenate(seen), (1, 99))
    drawn = None
    for panel, runs, title, mean in means:
        panel.titles("along (mm)", "across (mm)", title)
        if mean is not None:
            across, along = next(run for run in runs if name in run)[name].axis
            drawn = panel.map(along, across, mean, names.axis_title(name), limits=(min(low, 0.0), high), bar=False)
    sheet.colourbar(drawn, list(panels), names.axis_title(name))


def _cuts(panel: Panel, runs: Runs, name: str, title: str, level: float) -> None:
    panel.titles("distance (mm)", names.axis_title(f"/pairs/{name}"), title)
    for k, way in enumerate(("along", "across")):
        draw_curve(panel, runs, f"/pairs/cut/{name}_{way}", way, k, steady=runs.number("S").steady)
    panel.zero() if level == 0 else panel.reference(y=level)


@shows("6", "dilute", "layers")
def g2_map(material: Material) -> Sheet:
    """G₂ along and across the director: disorder, nematic, layers"""
    chosen = [(material.evidence[name].at(packing=packing), packing, statement) for name, packing, statement in (
        ("dilute", 0.45, "isotropic"), ("layers", 0.75, "anisotropy"), ("layers", 0.85, "g2-oscillates"))]
    n = len(chosen)
    sheet = material.sheet(2 * n, columns=n)
    # where the page is narrow there are two panels a row, and a map lies beside its cuts
    narrow = sheet.columns < n
    upper = [sheet[2 * k] if narrow else sheet[k] for k in range(n)]
    lower = [sheet[2 * k + 1] if narrow else sheet[n + k] for k in range(n)]
    _maps(sheet, upper, [(runs, f"φ = {packing:g}") for runs, packing, _ in chosen], "/pairs/g2")
    for panel, (runs, packing, statement) in zip(lower, chosen):
        if runs:
            _cuts(panel, runs, "g2", f"cuts, φ = {packing:g}", 0.0)
            material.stamp(panel, statement)
    return sheet


@shows("7", "short-rods", "long-rods", "layers", e="g-flattens")
def distances(material: Material) -> Sheet:
    """Pair correlation g: against distance, along and across the director"""
    evidence = material.evidence
    sheet = material.sheet(6)
    scale = packing_scale(*(runs for runs, _ in material.both))
    for panel, (runs, title) in zip((sheet[0], sheet[3]), material.both):
        draw_curves(panel, runs, "/g2/g", scale, keep=lambda r, g: r < 10, title=title).reference(y=1)
    sheet.colourbar(scale, [sheet[0], sheet[3]])
    dense = [(evidence["layers"].at(packing=packing), f"φ = {packing:g}") for packing in (0.75, 0.85)]
    _maps(sheet, [sheet[1], sheet[2]], dense, "/pairs/g")
    for panel, (runs, title) in zip((sheet[4], sheet[5]), dense):
        if runs:
            _cuts(panel, runs, "g", f"cuts, {title}", 1.0)
    return sheet


def _angles(panel: Panel, runs: Runs, path: str, title: str, scale: ColourScale | None = None) -> None:
    def folded(theta: NDArray[Any], density: NDArray[Any], error: NDArray[Any]) -> tuple[NDArray[Any], ...]:
        return np.degrees(theta), np.radians((density + np.interp(-theta, theta, density)) / 2), error

    panel.titles("angle to the director (°)", "P(θ) (1/°)", title)
    draw_curves(panel, runs, "/angles/density_per_rad", scale, path, keep=lambda angle, density: abs(angle) <= 45,
                made=folded, labels=scale is None, errors=False).range(y=(0, None))


def _against(panel: Panel, series: list[tuple[Runs, str]], path: str, name: str, title: str) -> None:
    of = {"theta_m_deg": mean_angle, "wavelength_mm": mean_wavelength}[name]
    formed = [(layered(runs), label) for runs, label in series]
    draw_against(panel, path, of, formed, title, names.axis_title(name)).range(y=(0, None))


@shows("8", "layers", "layer-trends", "long-rods", "strip", "fluid-start", b="layers", c="peaks-end", d="angle-length",
       e="angle-end", f="g2-oscillates", g="wavelength-length", h="wavelength-end")
def layers(material: Material) -> Sheet:
    """Layers turned by ±θ, their angle and their wavelength"""
    evidence = material.evidence
    trends = evidence.joined("layers", "layer-trends")
    sheet = material.sheet(9, height=48)
    long_ = evidence["layers"].at(4.5)
    dense = long_.at(packing=0.85) or evidence["long-rods"].at(packing=0.85)
    draw_snapshots(sheet, [(dense, "φ = 0.85")])
    everything = evidence["long-rods"]
    scale = packing_scale(everything)
    _angles(sheet[1], everything, PACKING, "ℓ = 4.5 mm", scale)
    sheet.colourbar(scale, [sheet[1]])
    sheet[1].reference(x=10, label="10°").reference(x=-10)
    by_end = evidence["layer-trends"].at(4.0, 0.85)
    fluid = evidence["fluid-start"].at(4.0, 0.85)
    _angles(sheet[2], by_end, END, "ℓ = 4 mm, φ = 0.85")
    by_length = [(trends.at(packing=packing, end=0.4), f"φ = {packing:g}, L = 42 mm") for packing in (0.80, 0.85)]
    strips = evidence["strip"].at(packing=0.85, end=0.4)
    by_length += [(strips, f"φ = 0.85, {box_text(strips[0])}")] if strips else []
    blunt = evidence["strip"].at(4.0, 0.85)
    starts = [(by_end, "from rows"), (fluid, "from a fluid"), (blunt, "from a fluid, strip")]
    _against(sheet[3], by_length, LENGTH, "theta_m_deg", "angle")
    sheet[3].reference(y=10, label="the paper: about 10°")
    _against(sheet[4], starts, END, "theta_m_deg", "angle, ℓ = 4 mm")
    _cuts_across(sheet[5], long_, scale)
    _against(sheet[6], by_length, LENGTH, "wavelength_mm", "wavelength")
    _against(sheet[7], starts, END, "wavelength_mm", "wavelength, ℓ = 4 mm")
    panel = sheet[8].titles("wave number $q_⊥$ (1/mm)", "spectrum of sin 2(θ − θ$_N$)", "across the director")
    draw_curves(panel.scale(y="log"), long_, "/layers/spectrum_across", scale, keep=lambda q, s: q < 2, errors=False)
    return sheet


def _cuts_across(panel: Panel, runs: Runs, scale: ColourScale | None, path: str = PACKING) -> None:
    panel.titles("distance across the director (mm)", names.axis_title("/pairs/g2"), "across")
    draw_curves(panel, runs, "/pairs/cut/g2_across", scale, path, labels=scale is None)


@shows("", "layers", "layer-trends", "strip", a="angle-packing", b="wavelength-packing")
def layer_trends(material: Material) -> Sheet:
    """Angle, wavelength and order of the layers against packing"""
    trends = material.evidence.joined("layers", "layer-trends")
    series = [(trends.at(length, end=0.4), names.value_label(LENGTH, length)) for length in (4.0, 4.5)]
    for length in (4.0, 4.5):
        strips = material.evidence["strip"].at(length, end=0.4).beyond(PACKING, 0.78)
        series += [(strips, f"{names.value_label(LENGTH, length)}, {box_text(strips[0])}")] if strips else []
    sheet = material.sheet(3)
    _against(sheet[0], series, PACKING, "theta_m_deg", "angle")
    _against(sheet[1], series, PACKING, "wavelength_mm", "wavelength")
    draw_against(sheet[2], PACKING, "layer_order", series, "order of the layers").range(y=(0, None))
    return sheet


@shows("", "layer-trends", "larger-box", d="larger-box")
def larger_box(material: Material) -> Sheet:
    """Layers in a larger box"""
    small, large = (material.evidence[name].at(4.0, 0.85, end=0.4) for name in ("layer-trends", "larger-box"))
    both = Runs([*small, *large])
    sheet = material.sheet(4, columns=2, height=58)
    draw_snapshots(sheet, [(runs, f"L = {key_of(runs[0], SIDE):.1f} mm" if runs else "") for runs in (small, large)],
                   timed=False)
    for panel, title in zip(sheet, ("the desk's box", "twice as wide")):
        if not panel.is_used:
            panel.titles(title=title).absent = "no runs yet"
    _angles(sheet[2], both, SIDE, "P(θ)")
    _cuts_across(sheet[3], both, None, SIDE)
    return sheet


@shows("", "layer-trends", "fluid-start", "strip", f="peaks-end")
def ends(material: Material) -> Sheet:
    """Blunt rods, from rows and from a fluid"""
    rows, fluid = (material.evidence[name].at(4.0, 0.85) for name in ("layer-trends", "fluid-start"))
    sheet = material.sheet(6, columns=3, height=58)
    shown = [(rows.at(end=end), f"{names.plain(names.value_label(END, end))}, from rows") for end in (0.4, 0.5)]
    shown += [(fluid.at(end=end), f"{names.plain(names.value_label(END, end))}, from a fluid") for end in (0.5, 0.6)]
    draw_snapshots(sheet, shown, timed=False)
    for panel, runs, title in ((sheet[4], rows, "P(θ), from rows"), (sheet[5], fluid, "P(θ), from a fluid")):
        _angles(panel, runs, END, title)
    return sheet


@shows("", "strip", "layers", "taper", c="taper")
def taper(material: Material) -> Sheet:
    """Tapered and untapered rods, from a fluid"""
    tapered, plain = material.evidence["layers"].at(4.5, 0.80), material.evidence["taper"].at(4.5, 0.80)
    sheet = material.sheet(3, height=58)
    draw_snapshots(sheet, [(tapered, "tapered, φ = 0.80"), (plain, "untapered, φ = 0.80")], timed=False)
    _angles(sheet[2], Runs([*tapered, *plain]), END, "P(θ)")
    return sheet


@shows("", "gaps", "layers", e="gap", h="crystal")
def gap(material: Material) -> Sheet:
    """The gap between the plates: crystal, layers, no layers"""
    runs = Runs([*material.evidence["gaps"], *material.evidence["layers"].at(4.5, 0.80)])
    gaps = runs.values(GAP)
    sheet = material.sheet(8, columns=4 if material.width > 150 else 2, height=44)
    _maps(sheet, sheet.panels[:4], [(runs.at(gap=value), f"w = {value:g} mm") for value in gaps], "/pairs/g2")
    _cuts_across(sheet[4], runs, None, GAP)
    _angles(sheet[5], runs, GAP, "P(θ)")
    draw_curves(sheet[6], runs, "/g2/g", None, GAP, keep=lambda r, g: r < 8, labels=True,
                title="distances").reference(y=1)
    panel = sheet[7].titles(names.axis_title(GAP), "crystalline order", "crystal")
    draw_points(panel, runs.points(GAP, "bragg_peak"), "Bragg peak", 0)
    draw_points(panel, runs.points(GAP, "psi_6"), "ψ₆", 1)
    panel.range(y=(0, None))
    return sheet


@shows("", "elasticity", "size", "long-range", b="splay-bend")
def elasticity(material: Material) -> Sheet:
    """Director fluctuations: bend against splay"""
    runs = ordered_in_large_boxes(material.evidence)
    sheet = material.sheet(2, columns=2, height=55)
    panel = sheet[0].titles("wave number q (1/mm)", "power of the director (mm²)", "φ = 0.65").scale("log", "log")
    waves = mean_waves(runs.at(packing=0.65))
    for k, label in enumerate(("along: bend", "across: splay")):
        powers = [(wave.bend, wave.splay)[k] for wave in waves]
        panel.curve([wave.q for wave in waves], [power.value for power in powers], [power.error for power in powers],
                    label=label, colour=k, look="points", joined=False)
    panel = sheet[1].titles("wave number q (1/mm)", "power of splay over bend", "ratio").scale("log", "log")
    for k, packing in enumerate(runs.values(PACKING)):
        waves = mean_waves(runs.at(packing=packing))
        panel.curve([wave.q for wave in waves], [wave.ratio.value for wave in waves],
                    [wave.ratio.error for wave in waves], label=f"φ = {packing:g}", colour=k, look="points")
    panel.reference(y=1)
    return sheet


@shows("", "short-rods", "long-rods")
def fluctuations(material: Material) -> Sheet:
    """Number fluctuations"""
    sheet = material.sheet(2, columns=2, height=55)
    scale = packing_scale(*(runs for runs, _ in material.both))
    for panel, (runs, title) in zip(sheet, material.both):
        panel.titles("mean number ⟨N⟩", "ΔN / √⟨N⟩", title).scale("log", "linear")
        draw_curves(panel, runs, "/fluctuations/std_n", scale, made=lambda n, std, error: (
            n, std / np.sqrt(n), error / np.sqrt(n))).range(y=(0, None))
    sheet.colourbar(scale)
    return sheet
