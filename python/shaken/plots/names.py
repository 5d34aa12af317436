# SPDX-License-Identifier: MIT
"""How quantities are called in figures: names, symbols and units. Symbols are in matplotlib's mathtext."""
from __future__ import annotations

import math
import re
from typing import Any, Mapping, Sequence

from ..units import split_species, split_unit, unit_of

#: What scenes, rows of results and arrays call a quantity: (its name, its symbol, its unit in print).
TABLE: dict[str, tuple[str, str, str]] = {
    # keys of the scene
    "rods.length": ("rod length", "$ℓ$", "mm"),
    "rods.mid_diameter": ("middle diameter", "$d$", "mm"),
    "rods.end_diameter": ("end diameter", "$d′$", "mm"),
    "rods.area_fraction": ("area fraction", "$φ$", ""),
    "rods.count": ("number of rods", "$N$", ""),
    "box.side": ("side of the box", "$L$", "mm"),
    "box.aspect": ("aspect of the box", "$L_y/L_x$", ""),
    "box.gap": ("gap between the plates", "$w$", "mm"),
    "plates.gamma": ("shaking strength", "$Γ$", ""),
    "plates.amplitude": ("amplitude of the plates", "$a$", "mm"),
    "plates.frequency": ("frequency of the plates", "$f$", "Hz"),
    "plates.second.amplitude": ("amplitude of the second vibration", "$a_2$", "mm"),
    "plates.second.frequency": ("frequency of the second vibration", "$f_2$", "Hz"),
    "plates.second.phase": ("phase of the second vibration", "$φ_2$", "degrees"),
    "plates.lid_motion.amplitude": ("amplitude of the lid", "$d$", "mm"),
    "plates.lid_motion.phase": ("phase of the lid", "$ψ$", "degrees"),
    "plates.inclination": ("inclination of the plates", "$α$", "degrees"),
    "plates.inclination_angle": ("direction down the slope", "", "degrees"),
    "plates.noise": ("rotational noise", "$ε$", "rad/mm"),
    "plates.rods_2.noise": ("rotational noise of rods_2", "$ε_2$", "rad/mm"),
    "plates.rods_3.noise": ("rotational noise of rods_3", "$ε_3$", "rad/mm"),
    "walls.size": ("size of the arena", "", "mm"),
    "walls.length": ("length of the arena", "", "mm"),
    "walls.narrow": ("narrow end of the wedge", "", "mm"),
    "plates.horizontal_amplitude": ("amplitude in the plane", "$b$", "mm"),
    "plates.horizontal_phase": ("phase of the vibration in the plane", "$φ$", "degrees"),
    "plates.horizontal_angle": ("direction of the vibration in the plane", "", "degrees"),
    "time.step": ("time step", "$Δt$", "s"),
    # numbers of a run
    "S": ("nematic order", r"$\langle S\rangle$", ""),
    "S_std": ("fluctuation of the nematic order", r"$σ_S$", ""),
    "theta_m_deg": ("tilt of the layers", r"$θ_\mathrm{m}$", "°"),
    "wavelength_mm": ("wavelength of the layers", "$λ$", "mm"),
    "diffusion_mm2_s": ("diffusion coefficient", "$D$", "mm²/s"),
    "rotational_diffusion_rad2_s": ("rotational diffusion", r"$D_\mathrm{r}$", "rad²/s"),
    "binder": ("Binder cumulant", "$U_2$", ""),
    "c2_plateau": ("plateau of the memory", "$C_2$", ""),
    "c2_decay_s": ("memory", "$C_2$ to 1/e", "s"),
    "layer_order": ("order of the layers", "", ""),
    "defect_density_per_mm2": ("defects per area", "", "1/mm²"),
    "P": ("polar order", r"$\langle P\rangle$", ""),
    "v_forward_mm_s": ("velocity towards the head", r"$\langle v·u\rangle$", "mm/s"),
    "velocity_rms_mm_s": ("rms speed of displacements", "", "mm/s"),
    "speed_rms_mm_s": ("rms speed", r"$v_\mathrm{rms}$", "mm/s"),
    "speed_mean_mm_s": ("mean speed", r"$\langle|v|\rangle$", "mm/s"),
    "temperature_horizontal_pJ": ("temperature in the plane", r"$T_\mathrm{h}$", "pJ"),
    "temperature_vertical_pJ": ("vertical temperature", r"$T_z$", "pJ"),
    "temperature_along_pJ": ("temperature along the rods", r"$T_∥$", "pJ"),
    "temperature_across_pJ": ("temperature across the rods", r"$T_⊥$", "pJ"),
    "temperature_rotation_pJ": ("temperature of rotation", r"$T_\mathrm{r}$", "pJ"),
    "alpha_2_peak": ("largest non-Gaussian parameter", r"$\hat{α}_2$", ""),
    "flow_of_neighbours": ("velocity correlation of neighbours", "$C$", ""),
    "flow_length_mm": ("velocity correlation length", r"$ξ_v$", "mm"),
    "largest_cluster": ("share of the largest cluster", "", ""),
    "cluster_size": ("mean cluster size", r"$\langle s^2\rangle/\langle s\rangle$", ""),
    "mean_free_time_s": ("mean free time", r"$τ_\mathrm{f}$", "s"),
    "power_given_pJ_s": ("power given to a rod", "$P$", "pJ/s"),
    "pressure_pJ_mm2": ("pressure", "$p$", "pJ/mm²"),
    "pressure_collisional_pJ_mm2": ("pressure of impacts", r"$p_\mathrm{c}$", "pJ/mm²"),
    "pressure_along_pJ_mm2": ("pressure along the director", "$p_∥$", "pJ/mm²"),
    "pressure_across_pJ_mm2": ("pressure across the director", "$p_⊥$", "pJ/mm²"),
    "segregation_12": ("segregation of the first two species", "", ""),
    "drift_x_mm_s": ("drift velocity along x", "$v_x$", "mm/s"),
    "drift_y_mm_s": ("drift velocity along y", "$v_y$", "mm/s"),
    "cpu_seconds": ("CPU time", "", "s"),
    # axes and curves of observables
    "/order/time_s": ("time", "$t$", "s"),
    "/order/order": ("nematic order", "$S$", ""),
    "/order/pdf/order": ("nematic order", "$S$", ""),
    "/order/pdf/density": ("probability density", "$P(S)$", ""),
    "/angles/theta_rad": ("angle to the director", "$θ$", "°"),
    "/angles/density_per_rad": ("probability density", "$P(θ)$", "1/°"),
    "/tilt/n_z": ("tilt of a rod", r"$n_z$", ""),
    "/tilt/v_along_mm_s": ("velocity along the rod", r"$\langle v_∥\rangle$", "mm/s"),
    "/tilt/v_across_mm_s": ("velocity across the rod", r"$\langle v_⊥\rangle$", "mm/s"),
    "/defects/time_s": ("time", "$t$", "s"),
    "/defects/n_plus": ("number of +1/2 defects", r"$N_+$", ""),
    "/defects/n_minus": ("number of −1/2 defects", r"$N_-$", ""),
    "/defects/n": ("number of ±1/2 defects", "", ""),
    "/g2/r_mm": ("distance", "$r$", "mm"),
    "/g2/g2": ("orientational correlation", "$G_2(r)$", ""),
    "/g2/g": ("pair correlation", "$g(r)$", ""),
    "/pairs/g2": ("orientational correlation", "$G_2$", ""),
    "/pairs/g": ("pair correlation", "$g$", ""),
    "/pairs/cut/r_mm": ("distance across the director", r"$r_⊥$", "mm"),
    "/pairs/cut/g2_across": ("orientational correlation", r"$G_2(r_⊥)$", ""),
    "/layers/q_per_mm": ("wave number across the director", r"$q_⊥$", "1/mm"),
    "/layers/spectrum_across": ("spectrum of the layers", r"$\langle|s(q_⊥)|^2\rangle$", ""),
    "/structure/q_per_mm": ("wave number", "$q$", "1/mm"),
    "/polar/time_s": ("time", "$t$", "s"),
    "/polar/order": ("polar order", "$P$", ""),
    "/polar/direction_rad": ("direction of the heads", "", "rad"),
    "/temperatures/time_s": ("time", "$t$", "s"),
    "/temperatures/horizontal_pJ": ("temperature in the plane", r"$T_\mathrm{h}$", "pJ"),
    "/temperatures/rotation_pJ": ("temperature of rotation", r"$T_\mathrm{r}$", "pJ"),
    "/scattering/lag_s": ("lag", "$t$", "s"),
    "/scattering/q_per_mm": ("wave number", "$q$", "1/mm"),
    "/scattering/f": ("self-intermediate scattering", "$F_s(q, t)$", ""),
    "/scattering/alpha_2": ("non-Gaussian parameter", "$α_2(t)$", ""),
    "/van_hove/displacement_mm": ("displacement along the director", "$x$", "mm"),
    "/van_hove/along_per_mm": ("van Hove function", "$G_s(x, t)$", "1/mm"),
    "/flow/r_mm": ("distance", "$r$", "mm"),
    "/flow/c": ("velocity correlation", "$C(r)$", ""),
    "/clusters/time_s": ("time", "$t$", "s"),
    "/clusters/largest": ("share of the largest cluster", "", ""),
    "/clusters/sizes/size": ("cluster size", "$s$", ""),
    "/clusters/sizes/density": ("clusters per rod", "$n(s)$", ""),
    "/collisions/time_s": ("time", "$t$", "s"),
    "/collisions/power_given_pJ_s": ("power given to a rod", "$P$", "pJ/s"),
    "/stress/time_s": ("time", "$t$", "s"),
    "/stress/collisional_xx_pJ_mm2": ("pressure of impacts, xx", r"$P_{xx}$", "pJ/mm²"),
    "/stress/collisional_yy_pJ_mm2": ("pressure of impacts, yy", r"$P_{yy}$", "pJ/mm²"),
    "/mixing/r_mm": ("distance", "$r$", "mm"),
    "/mixing/g_12": ("pair distribution between species", "$g_{12}(r)$", ""),
    "/density/x_mm": ("place", "$x$", "mm"),
    "/density/y_mm": ("place", "$y$", "mm"),
    "/density/area_fraction": ("area fraction", "$φ$", ""),
    "/density/memory/lag_s": ("lag", "$t$", "s"),
    "/density/memory/correlation": ("memory of the density", r"$C_φ(t)$", ""),
    "/defect_maps/along_mm": ("along the defect", "$x′$", "mm"),
    "/defect_maps/across_mm": ("across the defect", "$y′$", "mm"),
    "/defect_maps/plus/density": ("density of rods over its mean", "", ""),
    "/defect_maps/plus/v_along_mm_s": ("velocity of rods along $x′$", "", "mm/s"),
    "/defect_maps/plus/v_across_mm_s": ("velocity of rods along $y′$", "", "mm/s"),
    "/drift/time_s": ("time", "$t$", "s"),
    "/drift/x_mm": ("displacement along x", "$x$", "mm"),
    "/drift/y_mm": ("displacement along y", "$y$", "mm"),
    "/msd/lag_s": ("lag", "$t$", "s"),
    "/msd/total_mm2": ("mean square displacement", "MSD", "mm²"),
    "/msd/along_mm2": ("MSD along the director", "", "mm²"),
    "/msd/across_mm2": ("MSD across the director", "", "mm²"),
    "/rotation/msad_rad2": ("mean square angular displacement", "", "rad²"),
    "/rotation/lag_s": ("lag", "$t$", "s"),
    "/rotation/c2": ("orientational memory", "$C_2(t)$", ""),
    "/velocity/lag_s": ("lag", "$t$", "s"),
    "/velocity/c_v": ("velocity memory", "$C_v(t)$", ""),
    "/velocity/c_v_along": ("velocity memory along", "$C_v(t)$", ""),
    "/fluctuations/mean_n": ("mean number in a box", r"$\langle N\rangle$", ""),
    "/fluctuations/std_n": ("its standard deviation", "$ΔN$", ""),
}
#: The same under the names that rows of results have.
_ALIASES = {"order.mean": "S", "order.std": "S_std", "order": "S"}
_POWERS = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
#: The units of keys of the scene that have one and are not in the table, by the end of their names.
_KEY_UNITS = {"length": "mm", "diameter": "mm", "side": "mm", "gap": "mm", "amplitude": "mm", "frequency": "Hz",
              "duration": "s", "step": "s", "every": "s", "from": "s", "until": "s"}


def _entry(path: str) -> tuple[str, str, str] | None:
    name = path
    if name.startswith("measured."):
        name = name[len("measured."):]
    if name.endswith(".value"):
        name = name[:-len(".value")]
    found = TABLE.get(_ALIASES.get(name, name))
    species, own = split_species(name)
    if found is None and species and (entry := TABLE.get(own)):
        return f"{entry[0]} of {species}", *entry[1:]
    return found


def unit_text(unit: str) -> str:
    """A unit in print: "mm²/s" of "mm2 s-1", "1/mm" of "mm-1", nothing of "1"."""
    above, below = [], []
    for word in unit.split():
        match = re.fullmatch(r"([^0-9-]+)(-?[0-9]+)?", word)
        if match is None:
            continue
        power = int(match[2] or 1)
        symbol = {"deg": "°"}.get(match[1], match[1])
        (above if power > 0 else below).append(symbol + (str(abs(power)).translate(_POWERS) if abs(power) > 1 else ""))
    if not below:
        return " ".join(above)
    bottom = " ".join(below)
    return (" ".join(above) or "1") + "/" + (f"({bottom})" if len(below) > 1 else bottom)


def with_unit(title: str, unit: str) -> str:
    """"time $t$ (s)"."""
    return f"{title} ({unit})" if unit else title


def axis_title(path: str, unit: str | None = None, over: Sequence[float] = ()) -> str:
    """Name, symbol and unit for an axis: of a key of the scene ("box.gap"), of a number of a run ("theta_m_deg",
    "measured.theta_m_deg.value", "order.mean") or of an array ("/g2/g2"). What the table does not have goes by its own
    name, with the unit that it ends in. `unit` replaces that of the table. `over`: the times over which the number
    is taken [s], "over_s" of summaries: "speed over 0.4 s (mm/s)"."""
    entry = _entry(path)
    times = f" over {' to '.join(number_text(time) for time in sorted({min(over), max(over)}))} s" if over else ""
    if entry is not None:
        name, symbol, own = entry
        return with_unit(f"{name} {symbol}".strip() + times, own if unit is None else unit)
    name = path.removeprefix("measured.").removesuffix(".value")
    stem, _ = split_unit(name.rpartition("/")[2])
    own = unit_text(unit_of(name))
    if not own and "." in name:
        own = next((unit for end, unit in _KEY_UNITS.items() if name.endswith(end)), "")
    name = stem if "/" in name else split_unit(name)[0]
    return with_unit(name.replace("_", " ") + times, own if unit is None else unit)


def symbol(path: str) -> str:
    """The symbol of a quantity, or its name where it has none."""
    entry = _entry(path)
    return (entry[1] or entry[0]) if entry else path


def number_text(value: Any) -> str:
    """A number with as many digits as it has, up to six, and a real minus sign; anything else as it is."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        text = f"{value:.6g}"
        if "e" in text:
            mantissa, exponent = text.split("e")
            power = str(int(exponent)).translate(_POWERS)
            text = f"10{power}" if mantissa == "1" else f"{mantissa}·10{power}"
        return text.replace("-", "−")
    return str(value)


def short_number(value: float, n_digits: int = 3) -> str:
    """So many digits, without an exponent as far as that can be read: "0.0123", "1.66", "1660", "18,500"."""
    if not math.isfinite(value):
        return "–"
    if value == 0 or not 1e-4 <= abs(value) < 1e9:
        return number_text(float(f"{value:.{n_digits}g}"))
    digits = max(0, n_digits - 1 - math.floor(math.log10(abs(value))))
    rounded = float(f"{value:.{n_digits}g}")
    return (f"{rounded:,.0f}" if abs(rounded) >= 1e4 else f"{rounded:.{digits}f}").replace("-", "−")


def value_label(path: str, value: Any) -> str:
    """A value of a quantity: "$φ$ = 0.6", "$ℓ$ = 2.5 mm"."""
    entry = _entry(path)
    unit = entry[2] if entry and not isinstance(value, str) else ""
    return f"{symbol(path)} = {number_text(value)}" + (f" {unit}" if unit else "")


def point_label(parameters: Mapping[str, Any]) -> str:
    """Parameters as they are called in print: "$φ$ = 0.6, $ℓ$ = 2.5 mm"."""
    return ", ".join(value_label(path, value) for path, value in parameters.items())


_WORDS = ((r"\langle ", "⟨"), (r"\langle", "⟨"), (r"\rangle", "⟩"), (r"\mathrm", ""), (r"\hat", ""), ("$", ""), ("{",
                                                                                                                 ""),
          ("}", ""))


def plain(text: str) -> str:
    """A title without mathtext's marks: "tilt of the layers θ_m (°)"."""
    for marked, meant in _WORDS:
        text = text.replace(marked, meant)
    return " ".join(text.split())
