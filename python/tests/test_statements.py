"""Every statement on made-up runs that must give yes, no, and open."""
import itertools
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from conftest import night
from shaken.estimate import Estimate, replica_mean
from shaken.run import Arrays, Run
from shaken.study import (figures_motion, figures_order, late_lags, layer_checks, order_checks, report, rules, scaling,
                          structure_checks)
from shaken.study.evidence import PACKING, Evidence, Runs, crossing, key_of, place_on
from shaken.study.material import Material
from shaken.study.order_checks import n_peaks
from shaken.study.statements import STATEMENTS, judged
from shaken.units import unit_of

CHECKS = {statement.id: statement for statement in STATEMENTS}
_ids = itertools.count()


def measured(value, error=None, steady=True, drift=0.0):
    error = 0.01 * abs(value) if error is None else error
    return {"value": value, "sem": None if math.isnan(error) else error, "steady": steady, "n_effective": 40.0,
            "drift": {"value": drift, "sem": error if not math.isnan(error) else None}}


def runs(sweep, packing, numbers=None, arrays=None, *, length=4.5, side=33.492, end=0.4, gap=1.2, gamma=7.0, S=0.9,
         error=0.005, steady=True, drift=0.0, n=3, seconds=210.0, std=0.05, step=1.6e-5, energy=None):
    """n replicas of a state point of a set, with these numbers (NAME -> value, or (value, error)) and arrays."""
    made = []
    for seed in range(n):
        scene = {"rods": {"length": length, "end_diameter": end, "area_fraction": packing, "beads": 15},
                 "box": {"side": side, "gap": gap}, "plates": {"gamma": gamma, "frequency": 200.0},
                 "time": {"step": step, "seed": seed + 1}}
        known = {name: measured(*value) if isinstance(value, tuple) else measured(value)
                 for name, value in (numbers or {}).items()}
        order = measured(S, error, steady, drift)
        scene["rods"]["mid_diameter"] = 0.8
        summary = {"run_id": f"{next(_ids):016x}", "n_rods": 300, "sim_seconds": seconds, "t_steady_s": 30.0,
                   "steady": steady, "order": {**order, "mean": order["value"], "std": std}, "measured": known,
                   "energy_pJ": energy or {"given_by_plates": 1.0, "start": 1.0, "left": 0.5},
                   "versions": {"shaken": "0.1.0", "physics": 3, "compiler": "-"}}
        contents = {"/order/time_s": [0.0, 50.0, 100.0, 150.0, 210.0], "/order/order": [1.0, S, S, S, S],
                    **(arrays or {})}
        run = Run(scene, summary, Arrays(list(contents), lambda name, c=contents: (np.asarray(c[name], float),
                                                                                  unit_of(name))))
        run.sweeps = [sweep + "-desk"]
        made.append(run)
    return made


def by_packing(sweep, values, name, **more):
    """Points (packing, value) of one number."""
    return [run for packing, value in values for run in runs(sweep, packing, {name: value}, **more)]


def g2(far, error=0.005, n=40):
    r = np.linspace(0.5, 16, n)
    return {"/g2/r_mm": r, "/g2/g2": np.full(n, far), "/g2/g2_sem": np.full(n, error)}


def cuts(along, across, error=0.005, g_along=1.05, g_across=1.3, n=40):
    r = np.linspace(0.3, 13, n)
    found = {"/pairs/cut/r_mm": r}
    for name, value in (("g2_along", along), ("g2_across", across), ("g_along", g_along), ("g_across", g_across)):
        found[f"/pairs/cut/{name}"] = np.broadcast_to(value, n)
        found[f"/pairs/cut/{name}_sem"] = np.full(n, error)
    return found


def decay(length, n=40):
    return np.exp(-np.linspace(0.3, 13, n) / length)


def waves(bend, splay, error=0.05, turned=0.1):
    """Power of the director's fluctuations at the waves of a square box whose sides the director is `turned` from."""
    m, n = (axis.ravel() for axis in np.meshgrid(np.arange(-3, 4), np.arange(0, 4)))
    along, across = m * np.cos(turned) + n * np.sin(turned), n * np.cos(turned) - m * np.sin(turned)
    chosen = along**2 + across**2 > 0
    along, across = along[chosen], across[chosen]
    power = 1 / (along**2 / bend + across**2 / splay)
    return {"/frank/q_along_per_mm": 0.1 * along, "/frank/q_across_per_mm": 0.1 * across, "/frank/power_mm2": power,
            "/frank/power_sem_mm2": error * power}


def wave(amplitude, error=0.005):
    r = np.linspace(0.3, 13, 40)
    return cuts(0.5, 0.5 + amplitude * np.cos(2 * np.pi * r / 5), error)


def pdf(*peaks):
    s = np.linspace(0.005, 0.995, 100)
    return {"/order/pdf/order": s, "/order/pdf/density": sum(np.exp(-((s - p) / 0.05) ** 2 / 2) for p in peaks)}


def tilts(peak=-0.9, beyond=0.25, error=0.02, across=0.0, error_across=0.02, at_rest=0.0):
    n_z = np.linspace(0.01, 0.39, 20)
    v = np.where(n_z > 0.31, beyond, peak * np.exp(-((n_z - 0.2) / 0.08) ** 2))
    both = np.concatenate([-n_z[::-1], n_z])
    return {"/tilt/n_z": both, "/tilt/v_across_mm_s": across + 0.01 * (-1.0) ** np.arange(40),
            "/tilt/v_across_sem_mm_s": np.full(40, error_across), "/tilt/v_along_mm_s": at_rest + v[0] * np.sign(both),
            "/tilt/v_along_sem_mm_s": np.full(40, error), "/tilt/folded/n_z": n_z,
            "/tilt/folded/v_along_mm_s": v, "/tilt/folded/v_along_sem_mm_s": np.full(20, error)}


def swim(speed=-0.9, at=0.2, error=0.02, **more):
    return runs("mechanism", 0.60, {"tilt_fastest_mm_s": (speed, error), "tilt_fastest_n_z": at}, tilts(speed,
                                                                                                        error=error,
                                                                                                        **more),
                length=2.5)


def late(value, error=0.01):
    lag = np.arange(0, 4, 0.1)
    return {"/velocity/lag_s": lag, "/velocity/product_along_mm2_s2": np.where(lag < 0.4, 10.0, value),
            "/velocity/product_along_sem_mm2_s2": np.full(40, error)}


def ways(d, error=0.5):
    t = 0.02 * 2.0 ** np.arange(13)
    return {"/msd/lag_s": t, "/msd/along_mm2": 2 * d * t, "/msd/along_sem_mm2": error * t}


NINE = [round(0.45 + 0.05 * k, 2) for k in range(9)]
S_OF = dict(zip(NINE, (0.2, 0.32, 0.64, 0.78, 0.84, 0.88, 0.91, 0.93, 0.95)))


def diagram(length, shift=0.0, sweep="phases", **more):
    """<S> against packing, which passes 0.5 at 0.528 + shift."""
    points = [p for p in NINE]
    return [run for p in points for run in runs(sweep, p, length=length, S=float(np.interp(p - shift, NINE,
                                                                                           list(S_OF.values()))),
                                                                                           **more)]


def directors(degrees):
    """The angle of the director in the steady state, and the order at the same times."""
    n = len(degrees)
    return {"/order/time_s": np.linspace(30.0, 210.0, n), "/order/order": np.full(n, 0.9),
            "/order/director_rad": np.radians(degrees)}


def turned(angle, S=0.9, **more):
    wandering = angle + 0.1 * np.cos(np.arange(40))
    return runs("turned", 0.85, arrays=directors(wandering), length=3.5, side=41.865, S=S, **more)


LAYERED = {"theta_m_deg": (9.5, 0.3), "dip": (0.7, 0.02), "layer_order": (0.5, 0.02), "bragg_peak": (0.1, 0.004),
           "wavelength_mm": (5.2, 0.05)}
PLAIN = {"dip": (0.998, 0.004), "layer_order": (0.2, 0.02), "bragg_peak": (0.1, 0.004)}
VAGUE = {"dip": (0.95, 0.2), "layer_order": (0.4, 0.3), "bragg_peak": (0.1, 0.2)}


def p_theta(peak, width=7.0):
    """P(theta) with peaks at both sides, in degrees."""
    theta = np.radians(np.linspace(-89.5, 89.5, 180))
    p = sum(np.exp(-((np.degrees(theta) - side * peak) / width) ** 2 / 2) for side in (-1, 1))
    return {"/angles/theta_rad": theta, "/angles/density_per_rad": p / (p.sum() * (theta[1] - theta[0]))}


def layers(packing, numbers, sweep="layers", arrays=None, **more):
    return runs(sweep, packing, numbers, arrays, side=more.pop("side", 41.865), **more)


def layer_series(name, values, key, error=None):
    """Layers whose number `name` has these values along packing, length or end."""
    made = []
    for at, value in values:
        given = {**LAYERED, name: value if error is None else (value, error)}
        made += layers(at if key == "packing" else 0.85, given, "layer-trends", length=at if key == "length" else 4.0,
                       end=at if key == "end" else 0.4)
    return made


def trend_cases(name, key, places, up, noise):
    """Yes, no and open for a number that must go up (or down) along a key."""
    low, high = (8.0, 12.0) if up else (12.0, 8.0)
    n = len(places)
    rise = [(place, low + (high - low) * k / (n - 1)) for k, place in enumerate(places)]
    fall = [(place, high - (high - low) * k / (n - 1)) for k, place in enumerate(places)]
    return (layer_series(name, rise, key, 0.2), layer_series(name, fall, key, 0.2),
            layer_series(name, rise, key, noise))


def packing_cases(sweep, name, places, up, **more):
    low, high = (1.0, 2.0) if up else (2.0, 1.0)
    n = len(places)
    rise = [(place, (low + (high - low) * k / (n - 1), 0.02)) for k, place in enumerate(places)]
    fall = [(place, (high - (high - low) * k / (n - 1), 0.02)) for k, place in enumerate(places)]
    vague = [(place, (value, 3.0)) for place, (value, _) in rise]
    return tuple(by_packing(sweep, points, name, **more) for points in (rise, fall, vague))


def shaken_at(values, energy):
    return [run for gamma, d in values for run in runs("shaking", 0.75, {"diffusion_mm2_s": d}, length=2.5,
                                                       gamma=gamma)] + runs(
        "shaking", 0.75, {}, length=2.5, gamma=0.0, n=1, energy=energy)


STILL = {"given_by_plates": 0.0, "start": 5.0, "left": 0.01}
WILD = {"given_by_plates": 3.0, "start": 5.0, "left": 7.0}
DENSE = (0.65, 0.75, 0.85)


def law(factor, error=0.05):
    return by_packing("diffusion", [(p, (factor * (1.7 + 480 * (p - 0.64) ** 2), error)) for p in DENSE],
                      "diffusion_mm2_s", length=2.5, side=60.0)


def along(values, across=(0.3, 0.2, 0.1), error=0.05):
    return [run for (packing, d), other in zip(values, across) for run in runs(
        "diffusion-along", packing, {"diffusion_along_mm2_s": (d, error), "diffusion_across_mm2_s": (other, 0.01)},
        ways(d, error))]


def defect(along_tail, error=0.02):
    return runs("no-order", 0.85, {"lasting_defect_speed_plus_mm_s": 1.0, "lasting_defect_speed_minus_mm_s": (1.0,
                                                                                                              0.02),
                                   "lasting_defect_speed_plus_along_mm_s": (along_tail, error)}, length=3.0, side=83.73)


def in_two_boxes(small, large, error=0.005, wide=133.968):
    """S in boxes of which the one that is four times as wide has waves that make S fall as L^-0.1."""
    stiff = {"frank_splay": (1.0, 0.05), "frank_bend": ((10 / math.pi) ** 2, 0.5)}
    return [run for s, side in ((small, 33.492), (large, wide))
            for run in runs("long-range", 0.60, stiff, S=s, side=side, error=error)]


def warm(first):
    """Kinetic temperatures that begin at `first` times what they are in the end, in the plane alone."""
    t = np.arange(1, 201) * 0.005
    return {"/temperatures/time_s": t, "/temperatures/horizontal_pJ": 800 * (1 + (first - 1) * np.exp(-t / 0.1)),
            "/temperatures/vertical_pJ": np.full(200, 6000.0)}


def tapered(*parts, error=0.1):
    """Layers turned by so many parts of the angle of the taper, of rods of three lengths."""
    return [run for length, part in zip((3.5, 4.0, 4.5), parts) for run in layers(
        0.85, LAYERED | {"theta_m_deg": (part * 2 * math.degrees(math.atan(0.4 / (length - 0.4))), error)},
        "layer-trends", length=length)]


CASES = {
    "steady-state": ([r for p in NINE for r in runs("long-rods", p)],
                     [r for p in NINE for r in runs("long-rods", p, steady=False, drift=0.3, seconds=1200.0)],
                     [r for p in NINE for r in runs("long-rods", p, steady=False, drift=0.3)]),
    "ordered": (runs("long-rods", 0.75, S=0.91), runs("long-rods", 0.75, S=0.7),
                runs("long-rods", 0.75, S=0.91, error=0.2)),
    "disordered": (runs("long-rods", 0.45, S=0.2) + runs("dilute", 0.45, arrays=g2(0.01), S=0.1, side=66.984),
                   runs("long-rods", 0.45, S=0.8) + runs("dilute", 0.45, arrays=g2(0.6), S=0.8, side=66.984),
                   runs("long-rods", 0.45, S=0.45, error=0.2) +
                   runs("dilute", 0.45, arrays=g2(0.05, 0.2), S=0.4, error=0.2, side=66.984)),
    "short": (runs("short-rods", 0.85, S=0.3, length=2.5) + runs("phases", 0.85, S=0.3, length=3.0),
              runs("no-order", 0.85, S=0.8, length=2.5, side=83.73) + runs("phases", 0.85, S=0.3, length=3.0),
              runs("short-rods", 0.85, S=0.8, length=2.5)),
    "transition": (diagram(3.5, 0.1) + diagram(4.0, 0.05) + diagram(4.5), diagram(3.5) + diagram(4.0,
                                                                                                 0.05) + diagram(4.5,
                                                                                                                 0.1),
                   diagram(3.5, 0.01, error=0.2) + diagram(4.0, 0.005, error=0.2) + diagram(4.5, error=0.2)),
    "saturates": (diagram(4.0) + diagram(4.5), [r for length in (4.0, 4.5) for p in NINE
                                                 for r in runs("phases", p, length=length, S=0.7 - 0.3 * p)],
                  diagram(4.0, error=0.5) + diagram(4.5, error=0.5)),
    "transition-size": (diagram(4.5, 0, "long-rods") + diagram(4.5, 0.05, "size", side=66.984),
                        diagram(4.5, 0.05, "long-rods") + diagram(4.5, 0, "size", side=66.984),
                        diagram(4.5, 0, "long-rods", error=0.3) + diagram(4.5, 0.05, "size", side=66.984, error=0.3)),
    "long-range": tuple(in_two_boxes(*orders) for orders in ((0.88, 0.879), (0.88, 0.76), (0.88, 0.85, 0.2))),
    "longer-order": tuple([run for length, s in zip((2.5, 3.5, 4.5), orders) for packing in (0.60, 0.70)
                           for run in runs("phases", packing, S=s, length=length, error=error)] for orders, error in (
                              ((0.1, 0.4, 0.8), 0.01), ((0.8, 0.4, 0.1), 0.01), ((0.1, 0.4, 0.8), 0.9))),
    "unimodal": ([r for p in NINE for r in runs("long-rods", p, arrays=pdf(0.6))],
                 [r for p in NINE for r in runs("long-rods", p, arrays=pdf(0.3, 0.8))],
                 [r for p in NINE for r in runs("long-rods", p, arrays=pdf(0.6), n=1)]),
    "broadest": ([r for p in NINE for r in runs("long-rods", p, S=S_OF[p], std=0.15 if p == 0.55 else 0.05)],
                 [r for p in NINE for r in runs("long-rods", p, S=S_OF[p], std=0.15 if p == 0.80 else 0.05)],
                 [r for p in NINE for r in runs("long-rods", p, S=S_OF[p], std=0.15 if p == 0.55 else 0.05,
                                                error=0.4)]),
    "oblique": (turned(28), turned(2, S=0.3), runs("layer-trends", 0.85, arrays=directors(np.zeros(40)),
                                                   length=3.5, side=41.865)),
    "activity": (shaken_at([(3, 0.5), (7, 3.0), (14, 9.0)], STILL), shaken_at([(3, 9.0), (7, 3.0), (14, 0.5)], WILD),
                 [r for g, d in ((3, (3.0, 5.0)), (7, (3.1, 5.0))) for r in runs("shaking", 0.75,
                                                                                 {"diffusion_mm2_s": d},
                                                                               length=2.5, gamma=g)]),
    "forgetting": tuple(runs("forgetting", 0.75, {}, warm(first), n=n) for first, n in ((1.02, 3), (1.7, 3), (1.0, 1))),
    "g2": (runs("short-rods", 0.75, arrays=g2(0.0), length=2.5, S=0.2) + runs("long-rods", 0.80, arrays=g2(0.8)),
           runs("no-order", 0.75, arrays=g2(0.5), length=2.5, side=83.73) + runs("long-rods", 0.80, arrays=g2(0.0)),
           runs("short-rods", 0.75, arrays=g2(0.5), length=2.5) + runs("long-rods", 0.80, arrays=g2(0.3, 0.2))),
    "isotropic": tuple(runs("dilute", 0.45, arrays=cuts(decay(3.0), decay(other), error), n=n)
                       for other, error, n in ((3.1, 0.005, 3), (2.0, 0.005, 3), (3.1, 0.1, 1))),
    "anisotropy": (runs("layers", 0.75, arrays=cuts(0.8, 0.7)), runs("layers", 0.75, arrays=cuts(0.7, 0.8)),
                   runs("layers", 0.75, arrays=cuts(0.8, 0.75, 0.2))),
    "splay-bend": tuple(runs("elasticity", 0.65, arrays=waves(*powers), side=66.984)
                        for powers in ((2.0, 1.0), (1.0, 2.0), (2.0, 1.0, 1.0))),
    "layers": (layers(0.75, PLAIN) + layers(0.80, LAYERED) + layers(0.85, LAYERED),
               layers(0.75, LAYERED) + layers(0.80, PLAIN) + layers(0.85, PLAIN),
               layers(0.75, VAGUE) + layers(0.80, VAGUE) + layers(0.85, LAYERED)),
    "g2-oscillates": (layers(0.80, LAYERED | {"wavelength_mm": 5.0}, arrays=wave(0.1)),
                      layers(0.80, LAYERED | {"wavelength_mm": 5.0}, arrays=wave(-0.1)),
                      layers(0.80, LAYERED | {"wavelength_mm": 5.0}, arrays=wave(0.01, 0.2))),
    "gap": (layers(0.80, LAYERED, arrays=p_theta(9)) + layers(0.80, PLAIN, "gaps", p_theta(0), gap=1.4) +
            layers(0.80, PLAIN, "gaps", p_theta(0), gap=1.6),
            layers(0.80, PLAIN, arrays=p_theta(0)) + layers(0.80, LAYERED, "gaps", p_theta(9), gap=1.4) +
            layers(0.80, LAYERED, "gaps", p_theta(9), gap=1.6),
            layers(0.80, LAYERED, arrays=p_theta(9)) + layers(0.80, VAGUE, "gaps", gap=1.4)),
    "gap-order": tuple(layers(0.80, PLAIN, "gaps", gap=1.4, S=s, error=error)
                       for s, error in ((0.9, 0.01), (0.3, 0.01), (0.6, 0.3))),
    "taper": (tapered(0.88, 0.9, 0.86), tapered(0.5, 0.9, 1.4), tapered(0.9, 0.9, 0.9, error=5.0)),
    "crystal": (layers(0.80, LAYERED) + layers(0.80, PLAIN | {"bragg_peak": (0.5, 0.01)}, "gaps", gap=0.9),
                layers(0.80, LAYERED) + layers(0.80, PLAIN | {"bragg_peak": (0.05, 0.001)}, "gaps", gap=0.9),
                layers(0.80, LAYERED) + layers(0.80, PLAIN | {"bragg_peak": (0.11, 0.05)}, "gaps", gap=0.9)),
    "angle-packing": trend_cases("theta_m_deg", "packing", (0.80, 0.85), True, 6.0),
    "angle-length": trend_cases("theta_m_deg", "length", (3.5, 4.0, 4.5), False, 6.0),
    "angle-end": trend_cases("theta_m_deg", "end", (0.4, 0.5, 0.6), False, 6.0),
    "peaks-end": (layer_series("dip", [(d, 0.7) for d in (0.4, 0.5, 0.6)], "end", 0.02),
                  layer_series("dip", [(d, 0.99) for d in (0.4, 0.5, 0.6)], "end", 0.005),
                  layer_series("dip", [(d, 0.9) for d in (0.4, 0.5, 0.6)], "end", 0.2)),
    "wavelength-packing": trend_cases("wavelength_mm", "packing", (0.80, 0.85), False, 6.0),
    "wavelength-length": trend_cases("wavelength_mm", "length", (3.5, 4.0, 4.5), True, 6.0),
    "wavelength-end": trend_cases("wavelength_mm", "end", (0.4, 0.5, 0.6), True, 6.0),
    "larger-box": (layers(0.85, LAYERED, "layer-trends", length=4.0) +
                   layers(0.85, LAYERED | {"theta_m_deg": (7.0, 0.3), "wavelength_mm": (8.0, 0.1)}, "larger-box",
                          length=4.0, side=83.73),
                   layers(0.85, LAYERED, "layer-trends", length=4.0) +
                   layers(0.85, LAYERED | {"theta_m_deg": (14.0, 0.3), "wavelength_mm": (3.0, 0.1)}, "larger-box",
                          length=4.0, side=83.73),
                   layers(0.85, LAYERED, "layer-trends", length=4.0) +
                   layers(0.85, LAYERED | {"theta_m_deg": (9.4, 3.0), "wavelength_mm": (5.3, 1.0)}, "larger-box",
                          length=4.0, side=83.73)),
    "tilt": (swim(), swim(0.9, 0.05), swim(-0.9, error=2.0)),
    "reversal": (swim(), swim(beyond=-0.3), swim(error=2.0)),
    "no-tilt": (swim(), swim(at_rest=0.5), swim(error=2.0)),
    "sideways": (swim(), swim(across=0.5), swim(error_across=1.0)),
    "switching": (by_packing("mechanism", [(0.6, 0.02), (0.85, 0.05)], "n_z_switching_time_s", length=2.5),
                  by_packing("mechanism", [(0.6, 40.0), (0.85, 60.0)], "n_z_switching_time_s", length=2.5),
                  by_packing("mechanism", [(0.6, (8.0, 9.0)), (0.85, (9.0, 9.0))], "n_z_switching_time_s", length=2.5)),
    "persistence": packing_cases("mechanism", "persistence_time_s", (0.65, 0.85), True, length=2.5),
    "persistence-noise": tuple(
        [run for at, d, way in zip((0.65, 0.85), turning, ways_s) for run in
         runs("short-rods", at, {"rotational_diffusion_rad2_s": (d, error)}, length=2.5) +
         runs("mechanism", at, {"persistence_time_s": way}, length=2.5)]
        for turning, ways_s, error in (((1.0, 0.1), (0.2, 1.0), 0.01), ((0.1, 1.0), (50.0, 5.0), 0.01),
                                       ((1.0, 0.1), (0.2, 1.0), 3.0))),
    "diffusion-both": tuple([run for at in (0.45, 0.75) for run in runs("long-rods", at, {
        f"alpha_{name}long": (value, error) for name in ("", "along_", "across_")})]
        for value, error in ((1.0, 0.01), (1.5, 0.01), (1.0, 0.5))),
    "diffusion-level": tuple(by_packing("diffusion", [(0.65, d)], "diffusion_mm2_s", length=2.5)
                             for d in ((1.75, 0.05), (5.0, 0.05), (1.75, 3.0))),
    "diffusion-rises": packing_cases("diffusion", "diffusion_mm2_s", DENSE, True, length=2.5, side=60.0),
    "diffusion-law": (law(1.0), law(0.4), law(1.0, 5.0)),
    "diffusion-normal": (by_packing("diffusion", [(p, (1.0, 0.01)) for p in DENSE], "alpha_long", length=2.5),
                         by_packing("diffusion", [(p, (1.5, 0.01)) for p in DENSE], "alpha_long", length=2.5),
                         by_packing("diffusion", [(p, (1.0, 0.3)) for p in DENSE], "alpha_long", length=2.5)),
    "diffusion-along": (along([(0.70, 2.0), (0.80, 3.0), (0.85, 2.0)]),
                        along([(0.70, 3.0), (0.80, 2.0), (0.85, 3.0)], (1.0, 4.0, 5.0)),
                        along([(0.70, 2.0), (0.80, 3.0), (0.85, 2.0)], error=9.0)),
    "diffusion-across": (by_packing("long-rods", [(p, (1.02 - p / 2, 0.005)) for p in DENSE], "alpha_across_short"),
                         by_packing("long-rods", [(p, (1.0 + p / 2, 0.005)) for p in DENSE], "alpha_across_short"),
                         by_packing("long-rods", [(p, (1.0, 0.4)) for p in DENSE], "alpha_across_short")),
    "memory": tuple([run for p, (a, e) in points for run in runs("short-rods", p, {
        "c2_decay_s": (a, e), "velocity_correlation_s": (a / 9, e / 9)}, length=2.5)] for points in (
            [(p, (p, 0.01)) for p in DENSE], [(p, (1 - p, 0.01)) for p in DENSE], [(p, (p, 2.0)) for p in DENSE])),
    "c2-decay": tuple(by_packing("short-rods", [(p, value) for p in DENSE], "c2_plateau", length=2.5)
                      for value in ((0.0, 0.01), (0.5, 0.01), (0.0, 0.5))),
    "c2-plateau": (by_packing("long-rods", [(0.6, 0.5), (0.7, 0.8), (0.85, 0.97)], "c2_plateau"),
                   by_packing("long-rods", [(0.6, 0.9), (0.7, 0.6), (0.85, 0.3)], "c2_plateau"),
                   by_packing("long-rods", [(0.6, (0.5, 1.0)), (0.7, (0.8, 1.0)), (0.85, (0.9, 1.0))], "c2_plateau")),
    "velocity-along": tuple([run for p, v in points for run in runs("long-rods", p, {}, late(v, e))] for points, e in (
        ([(0.65, 0.05), (0.75, 0.15), (0.80, 0.3), (0.85, 0.1)], 0.01),
        ([(0.65, 0.3), (0.75, 0.15), (0.80, 0.05), (0.85, 0.1)], 0.01),
        ([(0.65, 0.05), (0.75, 0.15), (0.80, 0.3), (0.85, 0.1)], 2.0))),
    "rotation": packing_cases("short-rods", "rotational_diffusion_rad2_s", DENSE, False, length=2.5),
    "rotation-short": (by_packing("short-rods", [(p, (1.2 - p, 0.01)) for p in DENSE], "alpha_rotation_short",
                                  length=2.5),
                       by_packing("short-rods", [(p, (1 + p, 0.01)) for p in DENSE], "alpha_rotation_short",
                                  length=2.5),
                       by_packing("short-rods", [(p, (1.0, 0.5)) for p in DENSE], "alpha_rotation_short", length=2.5)),
    "rotation-normal": tuple(by_packing("short-rods", [(p, value) for p in DENSE], "alpha_rotation_long", length=2.5)
                             for value in ((1.0, 0.01), (0.5, 0.01), (1.0, 0.5))),
    "rotation-saturates": (by_packing("long-rods", [(0.45, (1.0, 0.01)), (0.85, (0.1, 0.01))], "alpha_rotation_long"),
                           by_packing("long-rods", [(0.45, (0.3, 0.01)), (0.85, (0.9, 0.01))], "alpha_rotation_long"),
                           by_packing("long-rods", [(0.45, (1.0, 0.3)), (0.85, (0.1, 0.3))], "alpha_rotation_long")),
    "defects": (defect(0.3), defect(0.01, 0.02), defect(0.1, 0.2)),
}

GOOD = (rules.AGREES, rules.CONSISTENT)


def verdict(name, made):
    return CHECKS[name].check(Evidence(made)).verdict


@pytest.mark.parametrize("name", [statement.id for statement in STATEMENTS if statement.id != "g-flattens"])
def test_made_up_runs_give_yes_no_and_open(name):
    says_yes, says_no, open_ = CASES[name]
    assert verdict(name, says_yes) in GOOD, CHECKS[name].check(Evidence(says_yes))
    assert verdict(name, says_no) == rules.DISAGREES, CHECKS[name].check(Evidence(says_no))
    assert verdict(name, open_) == rules.OPEN, CHECKS[name].check(Evidence(open_))
    assert verdict(name, []) == rules.NO_DATA


def test_a_sentence_that_contradicts_itself_is_called_so():
    found = CHECKS["g-flattens"].check(Evidence(runs("layers", 0.75, arrays=cuts(0.8, 0.7))))
    assert found.verdict == rules.CONTRADICTS and "sooner along" in found.why
    assert verdict("g-flattens", []) == rules.NO_DATA


def test_where_a_few_places_are_open_the_runs_are_consistent():
    answers = [rules.YES] * 8 + [rules.unknown("a run still relaxes").placed("0.85")]
    found = rules.conclude(answers, "")
    assert found.verdict == rules.CONSISTENT and found.why == "at 8 of 9; open: 0.85 (a run still relaxes)"
    assert rules.conclude(answers[4:], "").verdict == rules.CONSISTENT
    assert rules.conclude(answers[-2:], "").verdict == rules.OPEN, "half of them are not more than half"


def test_what_is_open_somewhere_is_not_agreed_to_everywhere():
    made = [r for p in NINE[:-1] for r in runs("long-rods", p)] + runs("long-rods", 0.85, steady=False, drift=0.3)
    found = CHECKS["steady-state"].check(Evidence(made))
    assert found.verdict == rules.CONSISTENT and found.why == "at 8 of 9; open: 0.85 (a run still relaxes)"
    assert "at 8 of 9 packings" in found.found
    slow = [r for p in NINE for r in runs("long-rods", p, drift=0.02, error=0.02)]
    assert CHECKS["steady-state"].check(Evidence(slow)).verdict == rules.AGREES, "0.02 and two errors are below 0.05"


def test_a_dip_at_its_bound_has_the_error_of_the_heights_of_the_peak():
    exact = {"dip": (1.0, math.nan)}
    steep = [run for width in (6.0, 7.0, 8.0) for run in layers(0.80, exact, "gaps", p_theta(0, width), n=1)]
    assert 0.05 < layer_checks.dip(Runs(steep)).error < 0.2
    assert layer_checks.two_peaks(Runs(steep)).word is None
    alike = [run for width in (7.0, 7.02, 7.04) for run in layers(0.80, exact, "gaps", p_theta(0, width), n=1)]
    assert layer_checks.two_peaks(Runs(alike)).word is False


def test_the_angle_of_layers_is_fitted_where_a_run_was_too_short_for_the_error_of_its_dip():
    short = layers(0.85, {"dip": (0.6, math.nan)}, arrays=p_theta(9.4, 5.0))[0]
    assert layer_checks.theta_m(short).value == pytest.approx(9.4, abs=0.01)
    known = layers(0.85, LAYERED, arrays=p_theta(12.0))[0]
    assert layer_checks.theta_m(known).value == 9.5
    for broad in (layers(0.85, PLAIN, arrays=p_theta(0))[0], layers(0.85, {"dip": (0.7, 0.1)}, arrays=p_theta(0))[0]):
        assert not layer_checks.theta_m(broad).is_known


def test_grains_and_what_still_melts_have_no_layers():
    assert layer_checks.layered(Runs(layers(0.85, LAYERED)))
    assert not layer_checks.layered(Runs(layers(0.85, LAYERED, S=0.2)))
    for drift, n in ((-0.4, 0), (-0.06, 3)):
        melting = layers(0.85, LAYERED | {"dip": (0.7, 0.02, False, drift)})
        assert len(layer_checks.layered(Runs(melting))) == n


@pytest.mark.parametrize("width", [5.0, 9.0])
def test_kurtosis_is_that_of_normal_distributions(width):
    """Of two normal ones of variance s^2 at +-m: (3 s^4 + 6 s^2 m^2 + m^4) / (s^2 + m^2)^2."""
    for peak in (0.0, 6.0, 12.0):
        known = (3 * width**4 + 6 * width**2 * peak**2 + peak**4) / (width**2 + peak**2) ** 2
        turned = {**p_theta(peak, width)}
        turned["/angles/density_per_rad"] = np.roll(turned["/angles/density_per_rad"], 85)
        for arrays in (p_theta(peak, width), turned):
            assert layer_checks.kurtosis(layers(0.80, {}, arrays=arrays)[0]).value == pytest.approx(known, rel=2e-3)


def strip_spectrum(wavelength, seed, layers=15.0, width=0.2):
    """A frozen pattern: powers that scatter as much as they are, of layers and of the director's own waves."""
    q = 2 * math.pi * np.arange(1, 40) / 126
    expected = 0.3 + 0.1 / q**2 + layers * np.exp(-np.log(q * wavelength / (2 * math.pi)) ** 2 / (2 * width**2))
    power = expected * np.random.default_rng(seed).exponential(size=39)
    return {"/layers/q_per_mm": q, "/layers/spectrum_across": power}


def strips(wavelength, dips, **more):
    made = [run for seed, dip in enumerate(dips) for run in
            layers(0.85, dip | {"wavelength_mm": (12.6, 0.1)}, "strip", strip_spectrum(wavelength, 100 + seed, **more),
                   side=21.0, n=1)]
    for run in made:
        run.scene["box"]["aspect"] = 6.0
    return Runs(made)


@pytest.mark.parametrize("known, width, bias", [
    (14.0, 0.2, 0.0), (15.0, 0.35, 1.0), pytest.param(11.0, 0.2, 0.0, marks=night),
    pytest.param(18.0, 0.2, 0.0, marks=night), pytest.param(15.0, 0.1, 1.0, marks=night)])
def test_the_wavelength_in_a_strip_is_that_of_the_peak(known, width, bias):
    """Of layers of a usual width within its error, of others within 1 mm more."""
    of_strips = strips(known, [LAYERED] * 12, width=width)
    found = of_strips.of(layer_checks.wavelength)
    assert layer_checks.mean_wavelength(of_strips).error == pytest.approx(math.hypot(found.error, 1.0))
    assert found.value == pytest.approx(known, abs=3 * found.error + bias) and found.error < 0.06 * known


@night
def test_a_spectrum_without_a_peak_has_no_wavelength():
    of_noise = [layer_checks.wavelength(run) for run in strips(14.0, [LAYERED] * 20, layers=0.0)]
    assert sum(found.is_known for found in of_noise) <= 3
    assert of_noise[0].reason == "no peak"


def test_a_wavelength_is_that_of_runs_with_layers():
    of_strips = strips(14.0, [LAYERED, LAYERED, PLAIN])
    assert not layer_checks.wavelength(of_strips[2]).is_known, "of what has no second peak it is no layers' wavelength"
    assert len(layer_checks.layered(of_strips)) == 3, "two of three have two peaks"
    assert not layer_checks.layered(Runs(of_strips[1:] + of_strips[2:]))


def test_the_step_of_a_narrow_box_is_in_the_error_of_all_replicas():
    of_squares = Runs(layers(0.85, LAYERED | {"wavelength_mm": (14.0, 0.1)}, side=42.0, n=9))
    step = 42 / 2.5 - 42 / 3.5
    assert layer_checks.mean_wavelength(of_squares).error == pytest.approx(math.hypot(step / math.sqrt(12), 0.1 / 3))


@pytest.mark.parametrize("begins, ends, angle, drift", [(30.0, 20.0, 25.0, -5.0), (100.0, 110.0, 15.0, 5.0),
                                                        (-30.0, -20.0, 25.0, -5.0), (-100.0, -110.0, 15.0, 5.0),
                                                        (80.0, 70.0, 15.0, 5.0)])
def test_the_angle_to_a_side_knows_its_drift(begins, ends, angle, drift):
    noise = 0.2 * np.random.default_rng(3).normal(size=400)
    run, = runs("turned", 0.85, arrays=directors(np.linspace(begins, ends, 400) + noise), length=3.5, n=1)
    found = order_checks.angle_to_side(run)
    assert found.value == pytest.approx(angle, abs=0.1) and found.drift == pytest.approx(drift, abs=0.3)
    assert found.error < 0.05 and found.steady is False
    still, = runs("turned", 0.85, arrays=directors(25.0 + noise), length=3.5, n=1)
    assert order_checks.angle_to_side(still).steady is True


def test_an_oblique_axis_that_goes_is_none_whatever_the_order():
    unknown = turned(3, n=1)
    unknown[0].summary["order"]["sem"] = None
    assert verdict("oblique", unknown) == rules.DISAGREES


def test_waves_of_other_lengths_are_not_averaged_together():
    """As of runs whose directors lie differently in the box."""
    made = [runs("elasticity", 0.65, arrays=waves(1.0, 10.0, turned=angle), side=66.984, n=1)[0]
            for angle in (0.0, 0.1, 0.4)]
    assert [wave.q for wave in structure_checks.opposite_waves(made[0])] == pytest.approx([0.1, 0.2, 0.3])
    assert structure_checks.opposite_waves(made[2])[0].q > 0.15
    common = structure_checks.mean_waves(Runs(made[:2]))
    assert [wave.q for wave in common] == pytest.approx([0.1, 0.2, 0.3], rel=0.01)
    assert all(wave.ratio.value == pytest.approx(10.0, rel=0.2) for wave in common)
    assert structure_checks.mean_waves(Runs(made)) == [] or structure_checks.mean_waves(Runs(made))[0].q > 0.15


def test_noise_brings_the_powers_of_opposite_waves_nearer_to_each_other():
    waves_of_both = structure_checks.OppositeWaves(0.5, Estimate(1.0, 0.1), Estimate(10.0, 0.5))
    measured = waves_of_both.with_noise(2.0).ratio
    assert (waves_of_both.ratio.value, measured.value) == (10.0, 4.0)
    assert measured.error == pytest.approx(math.hypot(0.5 / 3, 0.1 * 4 / 3))


def persistent(d, memory, error, seconds=100.0, n=3, spread=0.02):
    """Rods that go straight for about `memory` seconds: MSD = 4D (t - memory (1 - exp(-t / memory))), in n runs, of
    which D and the slope at the longest lags differ by `spread`."""
    lag = np.concatenate([np.arange(1, 8) * 0.1, 0.8 * 2.0 ** np.arange(8)])
    made = []
    for k in range(n):
        off = spread * (k - (n - 1) / 2)
        msd = 4 * d * (1 + off) * (lag - memory * (1 - np.exp(-lag / memory)) + off * np.maximum(lag - 25.6, 0))
        made += runs("short-rods", 0.85, {"diffusion_mm2_s": (0.7 * d, 0.01 * d), "alpha_long": (1.4, 0.01),
                                          "alpha_short": (1.0, 0.01)},
                     {"/msd/lag_s": lag, "/msd/total_mm2": msd, "/msd/total_sem_mm2": np.full(len(lag), error)},
                     length=2.5, seconds=seconds + 30.0, n=1)
    return Runs(made)


def test_long_times_are_the_octave_that_ends_at_half_of_what_was_measured():
    """Not the lags at which single runs have an error, where such rods are not yet diffusive."""
    of_rods = persistent(10.0, 4.0, math.nan)
    assert late_lags.longest_lag(of_rods[0], "/msd/total_mm2") == 51.2
    found = late_lags.best(of_rods, late_lags.diffusion_at("total"), "diffusion_mm2_s")
    assert found.value == pytest.approx(10.0, rel=0.01) and found.dof == 2
    change = of_rods.of(late_lags.change_of_slope("/msd/total_mm2"))
    assert change.value == pytest.approx(1.0, abs=0.02) and change.error == pytest.approx(0.015, rel=0.1)
    assert late_lags.best(Runs(of_rods[:1]), late_lags.diffusion_at("total"),
                          "diffusion_mm2_s").value == 7.0, "one run has no error there"
    answers = {answer.at: answer.word for answer in CHECKS["diffusion-normal"].check(Evidence(of_rods)).answers}
    assert answers["long times, 0.85"] is True
    for memory, spread, word, why in ((60.0, 0.02, False, "rods go straight for longer than they are followed"),
                                      (12.0, 0.02, False, "the slope still grows by a quarter"),
                                      (4.0, 0.2, None, "replicas differ too much to tell")):
        found = CHECKS["diffusion-normal"].check(Evidence(persistent(10.0, memory, math.nan, spread=spread)))
        assert {answer.at: answer.word for answer in found.answers}["long times, 0.85"] is word, why


def test_a_memory_that_still_falls_has_not_levelled_off():
    lag = 0.1 * 2.0 ** np.arange(11)
    for c2, levels in ((0.9 + 0.05 * np.exp(-lag), True), (0.95 - 0.03 * np.log2(lag / 0.1) * 2, False)):
        made = [run for packing, height in ((0.6, 0.8), (0.85, 1.0)) for run in runs(
            "long-rods", packing, {"c2_plateau": 0.9}, {"/rotation/lag_s": lag, "/rotation/c2": height * c2,
                                                        "/rotation/c2_sem": np.full(11, np.nan)})]
        answers = {a.at: a.word for a in CHECKS["c2-plateau"].check(Evidence(made)).answers}
        assert answers["level at 0.85"] is levels and answers["grows with packing"] is True


def test_two_errors_of_few_replicas_are_as_many_as_student_has():
    """At 95 %: of three replicas 1.7 times as much as of many samples, of two 3.8 times."""
    for dof, factor in ((1, 3.80), (2, 1.71), (5, 1.19)):
        assert rules.margin(Estimate(1.0, 0.1, dof=dof)) == pytest.approx(0.2 * factor, rel=0.01)
    assert rules.margin(Estimate(1.0, 0.3), Estimate(1.0, 0.4)) == pytest.approx(1.0)
    few, many = Estimate(2.0, 0.4, True, dof=2), Estimate(1.0, 0.01, True)
    assert rules.larger(replace(few, dof=math.inf), many).word is True and rules.larger(few, many).word is None


def test_replicas_that_scatter_more_than_their_errors_allow_count_as_without_errors():
    own = Runs(runs("long-rods", 0.75, {"dip": (0.9, 0.01)}, n=2) + runs("long-rods", 0.75, {"dip": (0.8, 0.01)}, n=1))
    alone = Runs(runs("long-rods", 0.75, {"dip": (0.9, math.nan)}, n=2) + runs("long-rods", 0.75, {"dip": (
        0.8, math.nan)}, n=1))
    assert own.number("dip").error == pytest.approx(alone.number("dip").error) and own.number("dip").dof == 2
    alike = Runs(runs("long-rods", 0.75, {"dip": (0.9, 0.1)}, n=2) + runs("long-rods", 0.75, {"dip": (0.8, 0.1)}, n=1))
    assert alike.number("dip").dof == math.inf and alike.number("dip").error == pytest.approx(0.1 / math.sqrt(3))


def test_a_step_back_by_three_errors_breaks_a_trend_of_few_replicas_too():
    few = [(x, Estimate(value, 0.1, True, dof=2)) for x, value in ((1, 1.0), (2, 1.6), (3, 1.1), (4, 3.0))]
    assert rules.trend(few, rising=True).word is False
    assert rules.trend([few[0], few[1], (3, replace(few[2][1], value=1.3)), few[3]], rising=True).word is True


@night
def test_the_rule_for_few_replicas_is_wrong_as_rarely_as_that_for_many():
    """Of three replicas each of two state points that do not differ one in 22 may be told apart at two errors."""
    draw, told_apart, n = np.random.default_rng(7), 0, 4000
    for _ in range(n):
        a, b = (replica_mean([Estimate(value, steady=True) for value in draw.normal(size=3)]) for _ in range(2))
        told_apart += rules.larger(a, b).word is not None
    assert told_apart / n < 0.05, "and not one in eight, as two errors of 68 % would"
    plain = sum(abs(a.value - b.value) > 2 * math.hypot(a.error, b.error) for a, b in (
        [replica_mean([Estimate(value) for value in draw.normal(size=3)]) for _ in range(2)] for _ in range(n)))
    assert plain / n > 0.05


def test_replicas_have_an_error_where_no_run_has_one():
    alone = runs("long-rods", 0.75, S=0.9, error=math.nan, n=1)
    assert verdict("ordered", alone) == rules.OPEN
    three = [run for s in (0.90, 0.905, 0.895) for run in runs("long-rods", 0.75, S=s, error=math.nan, n=1)]
    assert verdict("ordered", three) == rules.AGREES


def test_a_known_drift_stands_in_for_an_error():
    known = Estimate(0.919, math.nan, None, drift=-0.001, drift_error=0.008)
    assert rules.judged_error(known) == pytest.approx(0.00806, abs=1e-4)
    assert rules.close_to(known, 0.9, 0.05).word is True and rules.close_to(known, 0.9, 0.01).word is None


def test_what_drifts_decides_only_what_the_drift_cannot_undo():
    drifting = Estimate(10.0, 0.1, False, drift=1.0, drift_error=0.1)
    assert rules.above(drifting, 7.0).word is True
    assert rules.above(drifting, 9.5).word is True, "it drifts away from there"
    assert rules.above(drifting, 11.0).word is None and rules.close_to(drifting, 11.0, 0.5).word is None
    back = Estimate(10.0, 0.1, False, drift=-1.0, drift_error=0.1)
    assert rules.above(back, 9.0).word is None and "relaxes" in rules.above(back, 9.0).why
    assert rules.close_to(drifting, 9.0, 0.5).word is False and rules.close_to(drifting, 11.0, 1.5).word is True


def test_a_trend_may_step_back_by_chance_but_not_more():
    points = [(k, Estimate(value, 0.1, True)) for k, value in enumerate((1.0, 2.0, 1.8, 3.0))]
    assert rules.trend(points, rising=True).word is True
    points[2] = (2, Estimate(1.0, 0.1, True))
    assert rules.trend(points, rising=True).word is False
    assert rules.trend(points[:1], rising=True).word is None


def test_some_of_both_is_in_part_and_says_where():
    found = rules.conclude([rules.YES.placed("0.75"), rules.NO.placed("0.80"),
                            rules.unknown("no error").placed("0.85")], "x")
    assert found.verdict == rules.IN_PART and found.why == "holds: 0.75; not: 0.80; open: 0.85 (no error)"
    assert rules.conclude([rules.YES, rules.NO], "x", everywhere=True).verdict == rules.DISAGREES


def test_layers_are_asked_for_in_the_widest_box():
    def in_strips(numbers):
        found = layers(0.80, numbers, "strip", side=21.0) + layers(0.85, numbers, "strip", side=21.0)
        for run in found:
            run.scene["box"]["aspect"] = 6.0
        return found

    squares = layers(0.75, PLAIN) + layers(0.80, VAGUE) + layers(0.85, VAGUE)
    assert verdict("layers", squares) == rules.OPEN
    assert verdict("layers", squares + in_strips(LAYERED)) == rules.AGREES
    layered = layers(0.75, PLAIN) + layers(0.80, LAYERED) + layers(0.85, LAYERED)
    assert verdict("layers", layered + in_strips(PLAIN)) == rules.IN_PART
    assert verdict("layers", layers(0.75, PLAIN) + layers(0.80, VAGUE) + layers(0.85, LAYERED)) == rules.CONSISTENT


def test_layers_of_blunt_rods_that_depend_on_the_start_are_open():
    def rods(end, numbers, sweep):
        found = layers(0.85, numbers, sweep, length=4.0, end=end)
        for run in found if sweep == "fluid-start" else []:
            run.summary["start"] = {"run": "0123456789abcdef", "time": 30.0}
        return found

    rows = rods(0.4, LAYERED, "layer-trends") + rods(0.6, PLAIN, "layer-trends")
    assert verdict("peaks-end", rows) == rules.DISAGREES
    assert verdict("peaks-end", rows + rods(0.6, PLAIN, "fluid-start")) == rules.DISAGREES
    found = CHECKS["peaks-end"].check(Evidence(rows + rods(0.6, LAYERED, "fluid-start")))
    assert found.verdict == rules.OPEN and found.why == "d′ = 0.6 mm (it depends on start and packing)"
    assert found.found.count("(from a fluid)") == 1
    frozen = layers(0.85, LAYERED, "fluid-start", length=4.0, end=0.6, S=0.2)
    assert "froze without order" in CHECKS["peaks-end"].check(Evidence(rows + frozen)).why
    # a trend is of one start: ends of 0.4 mm from rows and of 0.6 mm from a fluid are two points of two
    found = CHECKS["angle-end"].check(Evidence(rows + rods(0.6, LAYERED, "fluid-start")))
    assert found.verdict == rules.OPEN and "fewer than two points" in found.why


def test_a_series_that_cannot_tell_leaves_a_trend_consistent():
    """Also one that compares a fluid with what is frozen: rods of the blunter ends do not go two of their lengths."""
    up = layer_series("theta_m_deg", [(4.0, (11.0, 0.1)), (4.5, (9.0, 0.1))], "length")
    assert verdict("angle-length", up) == rules.AGREES
    vague = layers(0.85, LAYERED | {"theta_m_deg": (10.0, 5.0)}, "strip", length=4.0, side=21.0) + layers(
        0.85, LAYERED | {"theta_m_deg": (9.0, 5.0)}, "strip", length=4.5, side=21.0)
    found = CHECKS["angle-length"].check(Evidence(up + vague))
    assert found.verdict == rules.CONSISTENT and found.why.startswith("cannot tell: φ = 0.85, 21 mm")
    assert len(found.answers) == 2, "a question that is open counts as one"
    for packing, d, expected in ((0.85, 5.0, rules.AGREES), (0.825, 5.0, rules.AGREES), (0.85, 0.01, rules.OPEN)):
        ends = [run for end, angle, along_it in ((0.4, 11.0, 10.0), (0.5, 9.0, d)) for run in layers(
            packing, LAYERED | {"theta_m_deg": (angle, 0.1), "diffusion_along_mm2_s": along_it}, "strip", length=4.0,
            end=end)]
        assert verdict("angle-end", ends) == expected


def test_where_g2_ends_before_a_wavelength_nothing_is_asked():
    near = layers(0.80, LAYERED | {"wavelength_mm": 5.0}, arrays=wave(0.1))
    far = layers(0.80, LAYERED | {"wavelength_mm": 30.0}, "strip", arrays=wave(0.1), side=21.0)
    assert verdict("g2-oscillates", far) == rules.OPEN
    found = CHECKS["g2-oscillates"].check(Evidence(near + far))
    assert found.verdict == rules.AGREES and "not asked at 0.8, ℓ = 4.5 mm in 21 mm" in found.why


def test_isotropy_is_judged_where_no_order_is_left():
    """The frame of the same rods makes a ratio of 1 + S: round at S = 0."""
    made = [run for s, side, sweep in ((0.2, 33.492, "long-rods"), (0.1, 66.984, "dilute")) for run in runs(
        sweep, 0.45, arrays=cuts(decay(3.0 * (1 + s)), decay(3.0), 0.001), S=s, side=side)]
    found = CHECKS["isotropic"].check(Evidence(made))
    assert found.verdict == rules.AGREES and "1.001 ± 0.006" in found.found.partition("; ")[2]


def test_layers_of_rods_without_a_taper_refute_the_taper_as_their_cause():
    assert CHECKS["taper"].check(Evidence(tapered(0.9, 0.9, 1.2))).verdict == rules.DISAGREES, "a fifth more"
    for numbers, S, expected, how in ((LAYERED, 0.9, rules.DISAGREES, ""), (PLAIN, 0.9, rules.CONSISTENT, "no layers"),
                                      (PLAIN, 0.1, rules.CONSISTENT, "no nematic")):
        for packing in (0.80, 0.85):
            found = CHECKS["taper"].check(Evidence(CASES["taper"][0] + layers(packing, numbers, "taper", end=0.8, S=S)))
            assert found.verdict == expected and how in found.why


def test_one_octave_of_boxes_says_nothing_of_long_range_order():
    found = CHECKS["long-range"].check(Evidence(in_two_boxes(0.88, 0.80, wide=66.984)))
    assert found.verdict == rules.OPEN and "one octave only" in found.why


@pytest.mark.parametrize("x", [-0.02, -0.1, -0.25])
def test_the_power_of_size_is_read_three_ways(x):
    """S ~ L^x, the waves' x = -1 / (pi sqrt(K1 K3)) and G2 ~ r^2x, planted."""
    stiff = -1 / (math.pi * x)
    r = np.linspace(0.5, 33, 66)
    arrays = {"/g2/r_mm": r, "/g2/g2": 0.7 * r ** (2 * x), "/g2/g2_sem": np.full(66, 0.002)}
    made = Runs(run for side in (33.492, 66.984, 133.968) for run in runs(
        "long-range", 0.60, {"frank_splay": (stiff / 2, 0.01), "frank_bend": (2 * stiff, 0.01)}, arrays, side=side,
        S=0.8 * (side / 33.492) ** x))
    assert scaling.power(made).value == pytest.approx(x, abs=1e-9)
    assert scaling.predicted(made.largest()).value == pytest.approx(x, abs=1e-9)
    assert made.largest().of(scaling.half_power_of_g2).value == pytest.approx(x, abs=1e-3)
    narrow = Runs(runs("long-range", 0.60, {}, arrays, side=16.746))
    assert not narrow.of(scaling.half_power_of_g2).is_known, "there are no distances between its own and the images'"


def test_what_chose_the_model_is_not_counted_and_what_could_hardly_fail_is_named():
    verdicts = judged(Evidence(swim() + runs("long-rods", 0.75, S=0.91)), [CHECKS[name] for name in (
        "ordered", "tilt", "reversal", "sideways", "memory")])
    assert " ".join(report.tally(verdicts).split()) == (
        "Of the paper's 5 statements 1 was used to choose the model; of the other 4, 3 agree (1 of them could hardly "
        "fail) and 1 has no runs yet.")
    assert [v.words for v in verdicts[2:4]] == ["agrees (used for calibration)", "agrees (could hardly fail)"]


def test_the_end_of_a_rise_is_judged_where_rods_are_dense():
    crossings = [r for p, value in ((0.55, 0.32), (0.60, 0.66), (0.65, 0.79))
                 for r in runs("crossings", p, S=value, length=4.0)]
    found = CHECKS["saturates"].check(Evidence(crossings + diagram(4.5)))
    assert found.verdict == rules.OPEN and "to about 1, ℓ = 4 mm (not run yet)" in found.why


def test_crossing_lies_on_the_line_and_has_its_errors():
    points = [(0.5, Estimate(0.3, 0.02, True)), (0.55, Estimate(0.7, 0.04, True))]
    found = crossing(points, 0.5)
    assert found.value == pytest.approx(0.525) and found.error == pytest.approx(math.hypot(0.5 * 0.02, 0.5 * 0.04) / 8)
    assert not crossing(points, 0.9).is_known


@pytest.mark.parametrize("found, asked", [(0.7481, 0.75), (0.742, 0.742)])
def test_the_area_fraction_of_whole_rods_is_what_was_asked_for(found, asked):
    assert key_of(SimpleNamespace(key=lambda path: found, parameters={}), PACKING) == pytest.approx(asked)


def test_where_rods_swim_fastest_is_known_to_a_bin():
    assert "±0.200 ± 0.020" in CHECKS["tilt"].check(Evidence(swim())).found


def test_plates_at_rest_that_give_energy_are_counted_beside_the_trend():
    found = CHECKS["activity"].check(Evidence(shaken_at([(3, 0.5), (7, 3.0), (14, 9.0)], WILD)))
    assert [answer.word for answer in found.answers] == [rules.YES.word, rules.NO.word]


def test_controls_are_told_from_the_points():
    evidence = Evidence(runs("long-rods", 0.75) + runs("long-rods", 0.75, n=1, step=4e-6))
    assert len(evidence["long-rods"]) == 3 and len(evidence.controls["long-rods"]) == 1


def test_peaks_are_counted():
    s = np.linspace(0, 1, 100)
    assert n_peaks(np.exp(-((s - 0.5) / 0.1) ** 2)) == 1 and n_peaks(np.zeros(0)) == 0
    assert n_peaks(np.exp(-((s - 0.2) / 0.05) ** 2) + np.exp(-((s - 0.8) / 0.05) ** 2)) == 2
    assert n_peaks(np.repeat([0, 1, 0.9, 1, 0], [5, 6, 3, 6, 5])) == 1


def test_every_statement_has_made_up_runs():
    assert set(CASES) | {"g-flattens"} == set(CHECKS) and len(CHECKS) >= 52
    assert len(judged(Evidence([]))) == len(STATEMENTS)


def test_numbers_are_means_over_replicas():
    made = Runs(runs("a", 0.5, {"dip": 0.5}) + runs("a", 0.6, {"dip": 0.7}))
    assert made.points("rods.area_fraction", "dip")[1][1].value == pytest.approx(0.7)
    assert made.largest("rods.area_fraction").values("rods.area_fraction") == [0.6]


def test_a_verdict_tells_the_samples_seeds_boxes_and_times_that_it_stands_on():
    short = runs("long-rods", 0.45, length=4.5, S=0.1, n=3, seconds=210.0)
    wide = runs("dilute", 0.45, length=4.5, S=0.05, n=2, side=67.0, seconds=100.0, arrays=g2(0.0))
    [verdict] = judged(Evidence(short + wide), [CHECKS["disordered"]])
    assert verdict.finding.verdict == "agrees"
    # 40 independent samples of each run
    assert verdict.basis.cells() == ["80 to 120", "2 to 3", "33.5 to 67 mm", "100 to 210 s"]
    # without a verdict it stands on nothing, and one check does not read for another
    assert judged(Evidence(short), [CHECKS["long-range"]])[0].basis.cells() == ["–"] * 4


@pytest.mark.parametrize("evidence", [
    [*runs("long-rods", 0.45, {"defect_density_per_mm2": 0.01}, side=83.73, S=0.1),
     *runs("phases", 0.75, side=83.73, S=0.9),
     *runs("phases", 0.75, side=167.46, n=1)],
    runs("layers", 0.80)], ids=["in the paper's box", "without a run of its own"])
def test_the_phase_diagram_is_drawn_in_the_box_that_most_runs_have(evidence):
    evidence = Evidence(evidence)
    sheet = figures_order.order.draw(Material(evidence, 183.0))
    assert {run.key("box.side") for run in order_checks.phase_diagram(evidence)} <= {83.73}
    assert sheet[1].has_picture == bool(order_checks.phase_diagram(evidence))
    melting = figures_motion.melting.draw(Material(evidence, 183.0))
    assert bool(melting[0].drawn) == bool(order_checks.phase_diagram(evidence))


@pytest.mark.parametrize("x, place", [(1.0, 0), (0.6, 0), (0.4, None), (1.9, 1), (3.4, 2), (3.6, None),
                                      (math.nan, None)])
def test_a_curve_says_nothing_of_places_beyond_its_ends(x, place):
    assert place_on(np.array([1.0, 2.0, 3.0]), x) == place
    assert place_on(np.array([]), x) is None


@pytest.mark.parametrize("wavelength, is_known", [(5.0, True), (12.9, True), (14.0, False), (20.0, False)])
def test_no_crest_is_read_where_the_cut_of_g2_has_ended(wavelength, is_known):
    run, = layers(0.80, LAYERED | {"wavelength_mm": wavelength}, arrays=wave(0.1), n=1)
    assert math.isfinite(layer_checks._crest(run).value) == is_known
