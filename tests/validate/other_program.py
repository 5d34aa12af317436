#!/usr/bin/python3
"""Shaken's rods in LAMMPS: both programs go on from one state of Shaken's, and what is measured on them is compared.

LAMMPS runs in stretches of 2.5 seconds, each of which goes on where the one before ended; what is done stays in
build/other-program, so that the command continues where it was stopped. Numbers go to docs/data/other-program.json."""
import argparse
import itertools
import json
import os
import pathlib
import subprocess
import sys
from dataclasses import replace
from typing import NamedTuple

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK, BIN, RESULTS = ROOT / "build/other-program", ROOT / "build/release/bin", ROOT / "docs/data/other-program.json"
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "bench/peers"), str(ROOT / "python")]
import lammps  # noqa: E402
import shaken  # noqa: E402
import system as peers  # noqa: E402
from shaken.study.report import other_program as tables  # noqa: E402

EVERY = 0.02008  # [s]; frames see all phases of the plates' period of 5 ms
SHAKEN_FRAMES = 12000  # of its run
FRAMES, SETTLE = 125, 25  # of a stretch, which is a whole number of vibrations; those of the first to leave out
LAGS = 1, 5, 25, 50, 250  # in frames
TILTS = 6
POWER = "power that plates give a rod (µJ/s)"
PRESSURE = "pressure of contacts in the plane (pJ/mm²)"


class Rods(NamedTuple):
    """What both programs run."""
    name: str
    length: float  # [mm]
    area_fraction: float
    warm_up: float  # of Shaken, before the state from which LAMMPS goes on [s]


class Springs(NamedTuple):
    """LAMMPS's contacts, and how long it runs with them."""
    stiffness: float  # [N/m]
    dt: float  # of which the briefest contact lasts 7 [s]
    each_arm: bool  # lammps.write_contacts
    stretches: int

    @property
    def title(self):
        return f"{self.stiffness} N/m" + ("" if self.each_arm else ", one dashpot")

    def folder(self, rods):
        return WORK / (f"{rods.name}-{self.stiffness}" + ("" if self.each_arm else "-central"))


SIDE = 25.119  # [mm]
RODS = [Rods("short", 2.5, 0.60, 20), Rods("long", 4.5, 0.75, 60)]
SPRINGS = [Springs(500, 16e-6, True, 12), Springs(2000, 8e-6, True, 12), Springs(500, 16e-6, False, 4),
           Springs(8000, 4e-6, True, 8), Springs(32000, 2e-6, True, 4)]


# ---- running ----


def start_of(rods):
    path = WORK / f"{rods.name}.json"
    if not path.exists():
        subprocess.run([BIN / "shaken-bench", "export", "--length", str(rods.length), "--area-fraction",
                        str(rods.area_fraction), "--side", str(SIDE), "--warm-up", str(rods.warm_up), "--out", path],
                       check=True)
    return peers.read(path.read_text())[0]


def shaken_run(rods):
    """Shaken's own run, which begins to measure where LAMMPS begins to simulate; made where it is not done."""
    folder, scene = WORK / f"{rods.name}-shaken", WORK / f"{rods.name}-scene.json"
    if not (folder / "summary.json").exists():
        often = {"every": EVERY}
        locked = {"every": EVERY, "phases": "locked"}
        scene.write_text(json.dumps({
            "rods": {"length": rods.length, "area_fraction": rods.area_fraction}, "box": {"side": SIDE},
            "accuracy": "paper", "time": {"steady": rods.warm_up, "measure": SHAKEN_FRAMES * EVERY},
            "measure": {"order": often, "temperatures": locked, "msd": often, "collisions": {}, "stress": {}},
            "trajectory": often}))
        subprocess.run([BIN / "shaken", "run", scene, "--out", folder], check=True)
    return shaken.open(folder)


def simulate_stretch(system, springs, folder, number):
    """One stretch, into a file; it begins where the one before ended."""
    start = system.start
    if number:
        with np.load(folder / f"{number - 1}.npz") as before:
            time = round(before["time"][-1] * system.frequency) / system.frequency
            start = peers.Frame(time, 0.0, *before["state"][-1].astype(float))
    here = replace(system, start=start)
    folder.mkdir(exist_ok=True)
    lammps.write_start(here, folder)
    cpu = -sum(os.times()[2:4])
    lammps.simulate(here, folder, springs.dt, 0, 0, FRAMES, EVERY, springs.stiffness, springs.each_arm)
    cpu += sum(os.times()[2:4])
    frames = list(lammps.read_dump(here, folder / "frames.dump", springs.dt))
    np.savez(folder / "new.npz", time=[f.time for f in frames], cpu=cpu,
             state=np.array([[f.position, f.director, f.velocity, f.angular_velocity] for f in frames], np.float32),
             **{mean: np.loadtxt(folder / f"frames.dump.{mean}")[:, 1] for mean in ("given", "virial")})
    (folder / "new.npz").rename(folder / f"{number}.npz")
    (folder / "frames.dump").unlink()
    return cpu


def simulate(hours):
    """The first stretch of all cases, then the second, until LAMMPS has had so many CPU-hours."""
    spent = 0.0
    rounds = range(max(springs.stretches for springs in SPRINGS))
    for number, springs, rods in itertools.product(rounds, SPRINGS, RODS):
        folder = springs.folder(rods)
        if spent < 3600 * hours and number < springs.stretches and not (folder / f"{number}.npz").exists():
            cpu = simulate_stretch(start_of(rods), springs, folder, number)
            spent += cpu
            print(f"{folder}: {number + 1} of {springs.stretches}, {cpu:.0f} CPU-s", flush=True)


# ---- measuring ----


def means_of(system, states):
    """What is compared, as {name: (sums, counts)} over instants, of which the number is one ratio. `states` are places
    [mm], directors, velocities [mm/s] and angular velocities [rad/s]: (instants, 4, rods, 3), EVERY apart. T is m v²
    or I ω² of one degree of freedom [pJ], v is along the rod in the plane, positive towards the raised end."""
    place, director, velocity, spin = np.moveaxis(states, 1, 0)
    n_rods = place.shape[1]
    flat = np.hypot(director[..., 0], director[..., 1])
    along = np.stack([director[..., 0] / flat, director[..., 1] / flat, 0 * flat], -1)
    across = np.stack([-along[..., 1], along[..., 0], 0 * flat], -1)
    dot = lambda a, b: np.einsum("tnc,tnc->tn", a, b)
    own = velocity - velocity.mean(1, keepdims=True)
    translation = system.mass * n_rods / (n_rods - 1)
    axes = np.mean((along[..., 0] + 1j * along[..., 1])**2, 1)
    instants = np.ones(len(states))
    square = lambda of: np.mean(of**2, 1)
    found = {"S": np.abs(axes), "rms n_z": square(director[..., 2]),
             "T along (pJ)": translation * square(dot(own, along)),
             "T across (pJ)": translation * square(dot(own, across)),
             "T vertical (pJ)": translation * square(own[..., 2]),
             "T turning (pJ)": system.inertia_perp * square(dot(spin, np.cross(director, across))),
             "T tipping (pJ)": system.inertia_perp * square(dot(spin, across)),
             "T spinning (pJ)": system.inertia_par * square(dot(spin, director))}
    found = {name: (values, instants) for name, values in found.items()}
    tilt, speed = np.abs(director[..., 2]), dot(velocity, along) * np.sign(director[..., 2])
    edges = np.linspace(0, system.largest_tilt, TILTS + 1)
    for low, high in zip(edges, edges[1:]):
        inside = (low <= tilt) & (tilt < high)
        found[f"v at n_z {low:.2f} to {high:.2f} (mm/s)"] = np.sum(speed * inside, 1), np.sum(inside, 1)
    for lag in LAGS:
        way = place[lag:, :, 0] + 1j * place[lag:, :, 1] - place[:-lag, :, 0] - 1j * place[:-lag, :, 1]
        way = way * np.exp(-0.5j * np.angle(axes[:-lag, None]))
        found[f"MSD along, {lag * EVERY:.2g} s (mm²)"] = square(way.real), instants[lag:]
        found[f"MSD across, {lag * EVERY:.2g} s (mm²)"] = square(way.imag), instants[lag:]
    return found


def number(name, sums, counts):
    with np.errstate(invalid="ignore"):  # where nothing was found
        mean = sums.sum() / counts.sum()
    return np.sqrt(mean) if name.startswith("rms") else mean


def numbers_of(found, seconds, reference):
    """Values of what was found in so many seconds, with standard errors as Shaken's run, the reference, has them:
    the scatter of its stretches as long as that, or of a twelfth of its time, less in proportion to the root."""
    whole = len(reference["S"][0]) * EVERY
    blocks = max(12, round(whole / seconds))
    numbers = {}
    for name, sums in found.items():
        parts = zip(*(np.array_split(of, blocks) for of in reference[name]))
        scatter = np.std([number(name, *part) for part in parts], ddof=1)
        numbers[name] = number(name, *sums), scatter * np.sqrt(whole / blocks / seconds)
    return {name: [float(f"{x:.6g}") for x in of] for name, of in numbers.items() if np.isfinite(of).all()}


def of_lammps(system, folder, reference):
    """What is measured in the stretches that are done; nothing without any."""
    parts = []
    while (path := folder / f"{len(parts)}.npz").exists():
        with np.load(path) as part:
            parts.append(dict(part))
    if not parts:
        return {}
    states, given, virial = (np.concatenate([part[name] for part in parts])[skip:] for name, skip in (
        ("state", SETTLE), ("given", SETTLE // 25), ("virial", SETTLE // 25)))
    found = means_of(system, states.astype(float))
    found[POWER] = given * 1e6 / system.n_rods, np.ones(len(given))
    found[PRESSURE] = virial * 1e12 / (2 * system.side**2), np.ones(len(virial))
    seconds = len(states) * EVERY
    return {"seconds": seconds, "cpu_s": sum(part["cpu"] for part in parts),
            "numbers": numbers_of(found, seconds, reference)}


def of_shaken(system, run):
    """What is measured in Shaken's run. Its trajectory knows no angular velocities: temperatures of rotation, and what
    impacts carry, are its own observables. Those that are measured here are to be its own as well."""
    begin = run.summary["t_steady_s"] - 1e-9
    frames = [frame for frame in run.frames() if frame.time >= begin]
    unknown = np.full_like(frames[0].directors, np.nan)
    found = means_of(system, np.array([[f.positions + f.box * f.images, f.directors, f.velocities, unknown]
                                       for f in frames]))
    curve = run["/msd/along_mm2"]
    series = lambda name: np.asarray(run[name])[np.asarray(run[name].axis) >= begin]
    for name, own in {"S": series("/order/order").mean(), "T along (pJ)": series("/temperatures/along_pJ").mean(),
                      "MSD along, 0.1 s (mm²)": np.interp(5 * EVERY, curve.axis, curve)}.items():
        np.testing.assert_allclose(number(name, *found[name]), own, rtol=1e-4, err_msg=name)
    own = {f"T {kind} (pJ)": series(f"/temperatures/{kind}_pJ") for kind in ("turning", "tipping", "spinning")}
    own[POWER] = series("/collisions/power_given_pJ_s") * 1e-6
    own[PRESSURE] = (series("/stress/collisional_xx_pJ_mm2") + series("/stress/collisional_yy_pJ_mm2")) / 2
    found.update({name: (values, np.ones(len(values))) for name, values in own.items()})
    return found


def write_results():
    """What is done so far, into the file that the page's tables are drawn from."""
    cases = []
    for rods in RODS:
        system = start_of(rods)
        words = f"{rods.length:g} mm, φ = {rods.area_fraction:g}, {system.n_rods} rods"
        run = shaken_run(rods)
        reference = of_shaken(system, run)
        seconds = len(reference["S"][0]) * EVERY
        cases.append({"rods": words, "title": "Shaken", "softness": 0, "seconds": seconds,
                      "cpu_s": run.summary["cpu_seconds"], "numbers": numbers_of(reference, seconds, reference)})
        for springs in SPRINGS:
            if measured := of_lammps(system, springs.folder(rods), reference):
                softness = springs.stiffness**-0.5 if springs.each_arm else 0
                cases.append({"rods": words, "title": springs.title, "softness": softness, **measured})
    RESULTS.write_text("[\n" + ",\n".join(json.dumps(case, ensure_ascii=False) for case in cases) + "\n]\n")
    print(tables(RESULTS))


def main():
    parser = argparse.ArgumentParser(prog="./dev validate other-program", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cpu", type=float, default=6.0, metavar="HOURS",
                        help="after which LAMMPS begins no further stretch; 6. With 0 what is done is measured")
    hours = parser.parse_args().cpu
    WORK.mkdir(parents=True, exist_ok=True)
    simulate(hours)
    write_results()


if __name__ == "__main__":
    main()
