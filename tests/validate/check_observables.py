#!/usr/bin/python3
"""Works out a run's observables again by other programs, from its trajectory, and compares.

    tests/validate/check_observables.py --scene > SCENE
    tests/validate/check_observables.py RUN_DIR [--all] [--only NAME...] [--observables FILE]

RUN_DIR holds trajectory.h5, observables.h5 and summary.json of a run without side walls, of one species, whose
measurements fall on instants that were recorded (`--scene` prints such a scene). Every number of
observables.h5 and summary.json is worked out from positions and directors: by MDAnalysis (reading the file, pairs,
mean square displacements), emcee and pymbar (autocorrelation, steady state), scipy (fits, neighbours) where they have
it, otherwise by twins: the shortest numpy that follows the definitions of docs/physics.md and of the headers in
analysis/. Prints a table; of a curve, the point furthest from agreement. Exit code 1 if anything disagrees.

What is allowed follows from the file's single precision: single numbers RELATIVE of themselves; histograms the samples
so near an edge that rounding may have put them into the next bin. Where the other program has another definition, its
row says so and what is allowed is a statistical error.

Debian packages: python3-numpy, -scipy, -h5py, -mdanalysis, -pymbar, -emcee. `./dev validate` installs them."""
import argparse
import json
import os
import sys
import warnings
from dataclasses import dataclass, field

import h5py
import numpy as np
import scipy.integrate
import scipy.ndimage
import scipy.optimize
import scipy.sparse.csgraph
import scipy.spatial

warnings.filterwarnings("ignore")
__import__("xdrlib")  # MDAnalysis does, with a warning that it lets through
import emcee.autocorr  # noqa: E402
import MDAnalysis  # noqa: E402
import MDAnalysis.analysis.msd  # noqa: E402
import MDAnalysis.analysis.rdf  # noqa: E402
from MDAnalysis.coordinates.H5MD import H5MDReader  # noqa: E402
import pymbar.timeseries  # noqa: E402

RELATIVE = 2e-5  # of numbers made of single-precision positions and directors
EDGE = 1e-5  # a sample this near a bin's edge, in mm or rad, may be in either bin

CHECKS = {}  # observable -> its check
#: With every observable, of which each check says when it is measured here, and the trajectory at the same instants.
#: 360 rods, since the director's fluctuations take account of the places of 336 or more.
SCENE = {"rods": {"length": "2.5 mm", "area_fraction": 0.65, "count": 360}, "box": {"gap": "1.2 mm"},
         "time": {"steady": "auto", "measure": "2 s", "seed": 3}, "measure": {}, "trajectory": {"every": "10 ms"}}


def observable(**settings):
    """Of check_NAME: `measure.NAME` in SCENE."""
    def added(check):
        name = check.__name__.removeprefix("check_")
        CHECKS[name], SCENE["measure"][name] = check, settings
        return check
    return added


# ---- the table ----


@dataclass
class Table:
    rows: list = field(default_factory=list)
    compared: set = field(default_factory=set)  # paths and names of ours

    def add(self, name, by, ours, theirs, allowed=None, remark=""):
        """Numbers or curves. `allowed` in units of the values; without it RELATIVE of the curve's largest value."""
        self.compared.add(name)
        ours, theirs = np.atleast_1d(np.asarray(ours, float)), np.atleast_1d(np.asarray(theirs, float))
        label = name if ours.size == 1 else f"{name} [{ours.size}]"
        if ours.shape != theirs.shape:
            self.rows.append((label, by, f"{ours.size} values", f"{theirs.size} values", "", "", False, remark))
            return
        known = np.isfinite(ours) & np.isfinite(theirs)
        if allowed is None:
            allowed = RELATIVE * np.max(np.abs(theirs[known]), initial=0) + 1e-12
        allowed = np.broadcast_to(np.asarray(allowed, float), ours.shape)
        difference = np.where(np.isnan(ours) & np.isnan(theirs), 0, np.abs(ours - theirs))
        difference = np.where(np.isfinite(difference), difference, np.inf)
        if ours.size == 0:
            return
        excess = np.where(difference > 0, difference / np.maximum(allowed, 1e-300), 0)
        worst = int(np.argmax(excess))
        if not known.any() and (excess <= 1).all():
            remark = remark or "neither has one"
        elif excess.max() == 0:
            worst = int(np.flatnonzero(known)[np.argmax(np.abs(theirs[known]))]) if known.any() else 0
        number = "{:.7g}".format
        self.rows.append((label, by, number(ours[worst]), number(theirs[worst]), f"{difference[worst]:.1e}",
                          f"{allowed[worst]:.1e}", bool((excess <= 1).all()), remark))

    def show(self, everything):
        head = ("observable", "other implementation", "ours", "theirs", "difference", "allowed", "verdict")
        lines = [head]
        for *cells, agrees, remark in self.rows:
            if agrees and not everything and cells[0].startswith("sem of "):
                continue
            lines.append((*cells, ("agrees" if agrees else "DISAGREES") + (f" ({remark})" if remark else "")))
        widths = [max(len(line[k]) for line in lines) for k in range(len(head))]
        for line in lines:
            print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())
        errors = [row for row in self.rows if row[0].startswith("sem of ")]
        failed = [row for row in self.rows if not row[-2]]
        hidden = "" if everything else ", those that agree not shown"
        print(f"\n{len(self.rows)} comparisons, {len(errors)} of them of errors (sem{hidden}); {len(failed)} disagree")
        return not failed


# ---- the run ----


class Run:
    """Trajectory, results and scene of a run; arrays of shape (frames, rods, ...) [mm, s]. `box` are its two sides."""

    def __init__(self, directory, observables):
        self.scene = json.load(open(os.path.join(directory, "scene.json")))
        self.summary = json.load(open(os.path.join(directory, "summary.json")))
        self.scalars = self.summary["measured"]
        self.arrays = {}
        with h5py.File(observables) as file:
            file.visititems(lambda name, item: self.arrays.__setitem__("/" + name, item[()])
                            if isinstance(item, h5py.Dataset) else None)
        self.path = os.path.join(directory, "trajectory.h5")
        with h5py.File(self.path) as file:
            particles = file["particles/trajectory"]
            self.tick = particles["position/step"][()]
            self.time = particles["position/time"][()]
            self.position = particles["position/value"][()].astype(float)
            self.image = particles["image/value"][()]
            self.velocity = particles["velocity/value"][()].astype(float)
            w, x, y, z = np.moveaxis(particles["orientation/value"][()].astype(float), -1, 0)
            parameters = file["parameters"]
            side = float(parameters.attrs["box_side_mm"])
            self.box = np.array([side, parameters.attrs.get("box_side_y_mm", side)])
            self.gap = float(parameters.attrs["gap_mm"])
            self.dt = float(parameters.attrs["dt_s"])
            offset, radius = parameters["bead_offset_mm"][()], parameters["bead_radius_mm"][()]
            if "species" in particles or "shape" in particles or "walls" in parameters:
                sys.exit("rods of several species or sizes and side walls are not dealt with here")
        director = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z], axis=-1)
        self.director = director / np.linalg.norm(director, axis=-1, keepdims=True)
        self.theta = np.arctan2(self.director[..., 1], self.director[..., 0])
        self.shorter, self.longer, self.area = self.box.min(), self.box.max(), self.box.prod()
        self.unwrapped = self.position[..., :2] + self.box * self.image[..., :2]
        self.place = self.position[..., :2] % self.box
        self.n = self.position.shape[1]
        self.beads = offset, radius
        self.length = np.max(offset + radius) - np.min(offset - radius)
        self.width = 2 * np.max(radius)
        self.n_z_max = min(max((self.gap / 2 - radius[-1]) / np.max(offset), 0), 1)
        # the director of all rods from the larger eigenvalue of the order tensor
        plane = self.director[..., :2] / np.linalg.norm(self.director[..., :2], axis=-1, keepdims=True)
        tensor = 2 * np.einsum("tia,tib->tab", plane, plane) / self.n - np.eye(2)
        values, vectors = np.linalg.eigh(tensor)
        self.order = values[:, 1]
        self.axis = fold(np.arctan2(vectors[:, 1, 1], vectors[:, 0, 1]))
        self.steady_given = None if self.scene["time"]["steady"] == "auto" else self.scene["time"]["steady"]
        self.t_steady = self.summary["t_steady_s"]

    def frames(self, name):
        """Frames at which measure.NAME took its samples."""
        period = max(1, round(self.scene["measure"][name]["every"] / self.dt))
        frames = np.flatnonzero(self.tick % period == 0)
        if not np.array_equal(self.tick[frames], np.arange(len(frames)) * period) or (
                len(frames) != self.summary["effects"]["measure_" + name]["samples"]):
            sys.exit(f"not every sample of measure.{name} was recorded: let trajectory.every divide its `every`")
        return frames

    def measured(self, name):
        """Value of a number of the summary; NaN for null."""
        value = self.scalars[name]["value"]
        return np.nan if value is None else value

    def sem(self, name):
        sem = self.scalars[name]["sem"]
        return np.nan if sem is None else sem

    def sem_if_steady(self, name):
        """The error that a number has, or would have if what it averages over were steady: that of jackknife()."""
        sem = self.scalars[name].get("sem_if_steady", self.scalars[name]["sem"])
        return np.nan if sem is None else sem


def fold(angle):
    """Of an axis, into [-pi/2, pi/2)."""
    return (angle + np.pi / 2) % np.pi - np.pi / 2


def is_steady(time, t_steady):
    return time >= t_steady - 1e-9 * max(1, abs(t_steady))


def nearest(difference, box):
    """The shortest of a difference and its periodic images; (..., 2) with both sides, or one component with its own."""
    return difference - box * np.round(difference / box)


def most_blocks(n, limit=64):
    """Samples in a block when at most `limit` blocks are kept and their length doubles."""
    length = 1
    while n > limit * length:
        length *= 2
    return length


def steady_parts(run, frames):
    """What analysis/errors/blocked.h says counts: sample numbers in whole blocks from the steady time on, block by block."""
    length = most_blocks(len(frames))
    return [np.arange(i, min(i + length, len(frames))) for i in range(0, len(frames), length)
            if is_steady(run.time[frames[i]], run.t_steady)]


FEWEST_PARTS = 10  # that have any part in a number, or it has no error: analysis/errors/parts.h


def sem_of_parts(parts):
    """Error of the mean of successive numbers (parts, ...) as of an autoregressive series: analysis/errors/parts.h."""
    n = len(parts)
    if n < FEWEST_PARTS:
        return np.full(parts.shape[1:], np.nan)
    rest = parts - parts.mean(0)
    squares = np.sum(rest ** 2, axis=0)
    with np.errstate(all="ignore"):
        raw = np.where(squares > 0, np.sum(rest[1:] * rest[:-1], axis=0) / squares, 0)
        rho = np.clip(raw + (1 + 3 * raw) / n, 0, 0.97)
        independent = n * (1 - rho) / (1 + rho)
        sem = np.sqrt(squares / (n - 1) / independent)
        varies = np.max(np.abs(rest), axis=0) > 1e-11 * np.max(np.abs(parts), axis=0)
    return np.where(varies & (independent >= 5) & np.isfinite(sem), sem, np.nan)


def worth(values):
    """Independent samples that the mean of a series is worth, from the means of 64 parts of it."""
    n = len(values)
    k = min(64, n)
    edges = np.arange(k + 1) * n // k
    parts = np.add.reduceat(values, edges[:-1]) / np.diff(edges)
    rest = parts - parts.mean()
    squares = np.sum(rest ** 2)
    if k < 2 or squares == 0:
        return n
    raw = np.sum(rest[1:] * rest[:-1]) / squares
    rho = np.clip(raw + (1 + 3 * raw) / k, 0, 0.97)
    return min(n, values.var(ddof=1) / (squares / (k - 1) * (1 + rho) / (1 - rho) / k))


def jackknife(parts, function):
    """function(samples) of all, and its error from what leaving out one part at a time changes (pseudo-values)."""
    value = np.asarray(function(np.concatenate(parts)), float)
    if len(parts) < 2:
        return value, np.full(value.shape, np.nan)
    left = np.array([function(np.concatenate([p for k, p in enumerate(parts) if k != leave]))
                     for leave in range(len(parts))], float)
    with np.errstate(invalid="ignore"):
        pseudo = value + (len(parts) - 1) * (value - left)
        takes_part = np.sum(~(np.abs(pseudo - value) <= 1e-11 * np.abs(value)), axis=0)
        return value, np.where((takes_part > 0) & (takes_part < FEWEST_PARTS), np.nan, sem_of_parts(pseudo))


def references(n, sample):
    """Rods that are the first of a pair in a sample: at most 1024, of more every k-th, another set each time."""
    stride = -(-n // 1024)
    return np.arange(sample % stride, n, stride)


def drawn(n, sample):
    """Rods that LatticeOrder takes: of each k successive ones the one that base/core/rng.h draws."""
    stride = -(-n // 1024)
    if stride == 1:
        return np.arange(n)
    mask, stream = (1 << 64) - 1, 7

    def mix(z):
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 & mask
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB & mask
        return z ^ (z >> 31)

    def uniform(index):
        return (mix((mix(mix(mix(mix(int(sample)) ^ stream)) ^ index) + 0x9E3779B97F4A7C15) & mask) >> 11) * 2.0**-53

    return np.array([first + int(uniform(first) * min(stride, n - first)) for first in range(0, n, stride)])


def scalar(run, table, name, by, value, sem=None, allowed=None, remark="", allowed_sem=1e-3):
    table.add(name, by, run.measured(name), value, allowed if allowed is not None else RELATIVE * abs(value) + 1e-12,
              remark)
    if sem is not None:
        table.add("sem of " + name, by, run.sem_if_steady(name), sem, allowed_sem * abs(sem) + 1e-9)


# ---- reading ----


MM_PER_ANGSTROM = 1e-7
MM_S_PER_ANGSTROM_PS = 1e5


def teach_millimetres():
    """MDAnalysis knows no length above the nanometre (docs/files.md)."""
    MDAnalysis.units.conversion_factor["length"]["mm"] = MM_PER_ANGSTROM
    MDAnalysis.units.conversion_factor["speed"]["mm/s"] = MM_S_PER_ANGSTROM_PS
    H5MDReader._unit_translation["length"]["mm"] = "mm"
    H5MDReader._unit_translation["velocity"]["mm s-1"] = "mm/s"


def check_reading(run, table):
    teach_millimetres()
    universe = MDAnalysis.Universe.empty(run.n, trajectory=True, velocities=True)
    universe.load_new(run.path, format="H5MD")
    positions, velocities, times, boxes = [], [], [], []
    for step in universe.trajectory:
        positions.append(step.positions * MM_PER_ANGSTROM)
        velocities.append(step.velocities * MM_S_PER_ANGSTROM_PS)
        times.append(step.time * 1e-12)
        boxes.append(step.dimensions * ([MM_PER_ANGSTROM] * 3 + [1] * 3))
    table.add("trajectory: frames", "MDAnalysis H5MDReader", len(run.time), len(universe.trajectory), 0)
    table.add("trajectory: times", "MDAnalysis H5MDReader", run.time, times, 1e-9)
    table.add("trajectory: positions", "MDAnalysis H5MDReader", run.position.ravel(), np.ravel(positions), 4e-7 * run.longer)
    table.add("trajectory: velocities", "MDAnalysis H5MDReader", run.velocity.ravel(), np.ravel(velocities),
              4e-7 * np.max(np.abs(run.velocity)))
    box = np.array([*run.box, run.gap, 90, 90, 90])
    table.add("trajectory: box", "MDAnalysis H5MDReader", box, boxes[-1], 1e-5)
    followed = np.cumsum(nearest(np.diff(positions, axis=0)[..., :2].astype(float), run.box), axis=0)
    table.add("trajectory: image", "shortest steps", (run.unwrapped[1:] - run.unwrapped[0]).ravel(), followed.ravel(), 1e-4)


def universe_of(run, frames, coordinates, box):
    """MDAnalysis' view of coordinates (frames, rods, 2) in the plane."""
    flat = np.concatenate([coordinates, np.zeros((*coordinates.shape[:2], 1))], axis=-1).astype(np.float32)
    universe = MDAnalysis.Universe.empty(run.n, trajectory=True)
    universe.load_new(flat, dimensions=np.tile([*box, 10 * max(box), 90, 90, 90], (len(frames), 1)))
    return universe


# ---- order ----


@observable(every="10 ms")
def check_order(run, table):
    frames = run.frames("order")
    order, times = run.order[frames], run.time[frames]
    ours = run.arrays["/order/order"]
    table.add("/order/time_s", "trajectory", run.arrays["/order/time_s"], times)
    table.add("/order/order", "eigenvalue of Q", ours, order, 1e-6)
    turned = fold(run.arrays["/order/director_rad"] - run.axis[frames])
    table.add("/order/director_rad", "eigenvector of Q", turned, 0 * turned, 1e-6 / order)

    summary = run.summary["order"]
    first = int(np.flatnonzero(is_steady(times, summary["t_steady_s"]))[0])
    steady = ours[first:]
    tau = emcee.autocorr.integrated_time(steady, c=5, tol=0)[0]
    tau = max(tau, 1)  # ours is not below independence
    n = len(steady)
    interval = times[1] - times[0]
    table.add("order: mean", "numpy", summary["mean"], steady.mean(), 1e-9)
    table.add("order: std", "numpy", summary["std"], steady.std(ddof=1), 1e-9)
    table.add("order: tau_s", "emcee.autocorr", summary["tau_s"], (tau - 1) / 2 * interval, 1e-9)
    independent = n / tau if n / tau > 500 else min(n / tau, worth(steady))
    table.add("order: n_effective", "emcee.autocorr, or parts", summary["n_effective"], independent, 1e-6 * independent)
    if summary["sem"] is not None:
        table.add("order: sem", "emcee.autocorr, or parts", summary["sem"], steady.std(ddof=1) / np.sqrt(independent), 1e-9)
    # another window: to the first rho < 0. Either g has an error of sqrt(20 / n_effective) of itself (Sokal 1997).
    g = pymbar.timeseries.statisticalInefficiency(steady)
    table.add("order: ln g", "pymbar", np.log(tau), np.log(g), 2 * np.sqrt(20 * tau / n), "another window; 2 errors")
    if run.steady_given is None:
        # the first start that leaves nine tenths of the most effective samples, or the last quarter of what drifts
        effective = [worth(ours[t:]) for t in range(0, 3 * len(ours) // 4 + 1, max(1, len(ours) // 512))]
        if 4 * first < 3 * len(ours) - 4 * max(1, len(ours) // 512):
            table.add("order: n_effective of 'auto'", "parts, every start", worth(steady), max(effective),
                      0.15 * max(effective), "ours takes the first start that leaves nine tenths")
        t0, g, _ = pymbar.timeseries.detectEquilibration(ours)
        mean = ours[t0:].mean()
        error = np.hypot(ours[t0:].std(ddof=1) * np.sqrt(g / len(ours[t0:])), steady.std(ddof=1) / np.sqrt(independent))
        if summary["steady"]:
            table.add("order: mean of 'auto'", "pymbar detectEquilibration", summary["mean"], mean, 4 * error,
                      f"its t0 {times[t0]:.2f} s, ours {summary['t_steady_s']:.2f} s; 4 errors")
    else:
        table.add("t_steady_s", "scene", run.t_steady, run.steady_given, 1e-9)

    parts = steady_parts(run, frames)
    kept = np.concatenate(parts)
    bins = len(run.arrays["/order/pdf/order"])
    expected, doubt = histogram(order[kept] * bins, bins, 1e-6 * bins)
    table.add("/order/pdf/order", "definition", run.arrays["/order/pdf/order"], (np.arange(bins) + 0.5) / bins)
    table.add("/order/pdf/density", "numpy", run.arrays["/order/pdf/density"], expected * bins / len(kept),
              doubt * bins / len(kept) + 1e-9)
    numbers, sems = jackknife(parts, lambda some: [2 - np.mean(order[some] ** 4) / np.mean(order[some] ** 2) ** 2,
                                                   run.n * order[some].var()])
    scalar(run, table, "binder", "numpy", numbers[0], sems[0], allowed=1e-5)
    scalar(run, table, "susceptibility", "numpy", numbers[1], sems[1], allowed=1e-4 * numbers[1])


def histogram(place, bins, edge):
    """Counts of places [bins] in [0, bins), and how many of those nearby lie within `edge` of a bin's edge."""
    inside = (place > -edge) & (place < bins + edge)
    place = place[inside]
    bin_of = np.floor(np.clip(place, 0, bins - 1e-9)).astype(int)
    counts = np.bincount(bin_of[(place >= 0) & (place < bins)], minlength=bins).astype(float)
    doubt = np.bincount(bin_of[np.abs(place - np.round(place)) < edge], minlength=bins).astype(float)
    return counts, np.convolve(doubt, np.ones(3), mode="same")


# ---- angles ----


def two_gaussians(theta, density):
    """theta_m [degrees], dip and maximum [degrees] of analysis/angles.h, by scipy; NaN without samples."""
    none = (np.nan, np.nan, np.nan)
    width = np.pi / len(theta)
    if len(theta) < 8 or not density.max() > 0:
        return none

    def model(x, at, sigma, height, background):
        return height * (np.exp(-(fold(x - at) / sigma) ** 2 / 2) + np.exp(-(fold(x + at) / sigma) ** 2 / 2)) + background

    spread = np.sqrt(np.sum(density * theta ** 2) * width)
    best = None
    for share in (0.3, 0.6, 0.8, 0.95):
        try:
            found, _ = scipy.optimize.curve_fit(
                model, theta, density, [share * spread, spread * np.sqrt(1 - share ** 2), density.max() / 2, 0],
                xtol=1e-12, ftol=1e-12, maxfev=4000)
        except RuntimeError:
            continue
        misfit = np.sum((model(theta, *found) - density) ** 2)
        if best is None or misfit < best[0]:
            best = (misfit, found)
    if best is None:
        return none
    at, sigma = np.abs(best[1][:2])
    reach = min(max(1, int(np.floor(sigma / 4 / width + 0.5))), len(theta) // 2)
    both = density + density[::-1]
    length = (len(theta) % 2) + 2 * reach
    sums = np.convolve(np.concatenate([both, both[:length - 1]]), np.ones(length), mode="valid")
    dip = sums[len(theta) // 2 - reach] / sums.max()
    # highest place: of a weighted cubic about it, from that of the two Gaussians on
    reach = min(max(sigma / 2, 2 * width), np.pi / 8)
    top = at
    for _ in range(200):
        top = at * np.tanh(top * at / sigma ** 2)
    for _ in range(100):
        x = fold(theta - top) / reach
        cubic = np.polynomial.Polynomial.fit(x, both, 3, w=np.exp(-x ** 2 / 4), domain=[-1, 1])
        flat = cubic.deriv().roots()
        flat = flat[np.isreal(flat)].real
        flat = flat[cubic.deriv(2)(flat) < 0]
        if not flat.size:
            top = np.nan
            break
        top += reach * np.clip(flat[0], -1, 1)
        if abs(flat[0]) < 1e-9:
            break
    return np.degrees(at), dip, abs(np.degrees(fold(top)))


@observable(every="10 ms", bins=90)
def check_angles(run, table):
    frames = run.frames("angles")
    parts = steady_parts(run, frames)
    kept = np.concatenate(parts)
    centres = run.arrays["/angles/theta_rad"]
    bins = len(centres)
    width = np.pi / bins
    angle = fold(run.theta[frames] - run.axis[frames][:, None])
    counts = np.array([np.histogram(a, bins, (-np.pi / 2, np.pi / 2))[0] for a in angle])
    _, doubt = histogram((angle[kept].ravel() + np.pi / 2) / width, bins, EDGE / width)
    norm = len(kept) * run.n * width
    table.add("/angles/theta_rad", "definition", centres, -np.pi / 2 + (np.arange(bins) + 0.5) * width)
    table.add("/angles/density_per_rad", "numpy", run.arrays["/angles/density_per_rad"], counts[kept].sum(0) / norm,
              doubt / norm + 1e-9)
    numbers, sems = jackknife(parts, lambda some: two_gaussians(centres, counts[some].sum(0) / (len(some) * run.n * width)))
    for name, value, sem in zip(("theta_m_deg", "dip", "theta_m_maximum_deg"), numbers, sems):
        if name != "dip" and not numbers[1] + 2 * sems[1] < 1:
            value = sem = np.nan
        scalar(run, table, name, "scipy curve_fit", value, None, allowed=1e-3 * abs(value))
        table.add("sem of " + name, "scipy curve_fit", run.sem(name), sem, 0.05 * abs(sem))


# ---- tilt ----


@observable(every="10 ms", phases="locked")
def check_tilt(run, table):
    frames = run.frames("tilt")
    parts = steady_parts(run, frames)
    kept = np.concatenate(parts)
    bins = len(run.arrays["/tilt/n_z"])
    width = 2 * run.n_z_max / bins
    n_z, plane = run.director[frames][..., 2], run.director[frames][..., :2]
    plane = plane / np.linalg.norm(plane, axis=-1, keepdims=True)
    v = run.velocity[frames][..., :2]
    moved = {"along": np.einsum("tia,tia->ti", v, plane), "across": plane[..., 0] * v[..., 1] - plane[..., 1] * v[..., 0]}
    place = (n_z + run.n_z_max) / width
    inside = (place >= 0) & (place <= bins)
    cell = np.minimum(place.astype(int), bins - 1) + bins * np.arange(len(frames))[:, None]

    def by_sample(weights=None):
        return np.bincount(cell[inside], None if weights is None else weights[inside],
                           minlength=bins * len(frames)).reshape(len(frames), bins).astype(float)

    counts, sums = by_sample(), {name: by_sample(w) for name, w in moved.items()}
    total = counts[kept].sum(0)
    _, doubt = histogram(place[kept].ravel(), bins, 1e-6 / width)
    centres = -run.n_z_max + (np.arange(bins) + 0.5) * width
    table.add("/tilt/n_z", "definition", run.arrays["/tilt/n_z"], centres)
    norm = n_z[kept].size * width
    table.add("/tilt/density", "numpy", run.arrays["/tilt/density"], total / norm, doubt / norm + 1e-9)
    doubt_v = doubt * np.abs(v).max() / np.maximum(total, 1) * 2 + 1e-4
    met = sum((counts[part].sum(0) > 0).astype(int) for part in parts)
    for name in moved:
        with np.errstate(all="ignore"):
            curve, sem = jackknife(parts, lambda some: sums[name][some].sum(0) / counts[some].sum(0))
        sem[met < 8] = np.nan
        table.add(f"/tilt/v_{name}_mm_s", "numpy", run.arrays[f"/tilt/v_{name}_mm_s"], curve, doubt_v)
        table.add(f"sem of /tilt/v_{name}", "numpy", run.arrays[f"/tilt/v_{name}_sem_mm_s"], sem, 0.05 * sem + doubt_v)
        table.compared.add(f"/tilt/v_{name}_sem_mm_s")

    # which side each rod is tilted to, and how often that changes
    frames_z = run.director[frames][..., 2]
    side, lived, switched = np.zeros(run.n), [], []
    for k in range(len(frames)):
        lived.append(np.sum(side != 0) * (run.time[frames[k]] - run.time[frames[k - 1]] if k else 0))
        now = np.where(np.abs(frames_z[k]) > run.n_z_max / 2, np.sign(frames_z[k]), side)
        switched.append(np.sum(now * side < 0))
        side = now
    lived, switched = np.array(lived), np.array(switched)
    value, sem = jackknife(parts, lambda some: lived[some].sum() / switched[some].sum())
    scalar(run, table, "n_z_switching_time_s", "numpy", float(value), float(sem), allowed=1e-3 * float(value))

    # both halves together, and what that comes down to
    up = np.arange((bins + 1) // 2, bins)
    down = bins - 1 - up

    def folded(some):
        with np.errstate(all="ignore"):
            return ((sums["along"][some][:, up].sum(0) - sums["along"][some][:, down].sum(0))
                    / (counts[some][:, up].sum(0) + counts[some][:, down].sum(0)))

    value, error = jackknife(parts, folded)
    error[np.maximum(met[up], met[down]) < 8] = np.nan
    weight, doubt_v = total[up] + total[down], np.maximum(doubt_v[up], doubt_v[down])
    some = weight > 0
    x, value, error, weight, doubt_v = (curve[some] for curve in (centres[up], value, error, weight, doubt_v))
    table.add("/tilt/folded/n_z", "definition", run.arrays["/tilt/folded/n_z"], x)
    table.add("/tilt/folded/v_along_mm_s", "numpy", run.arrays["/tilt/folded/v_along_mm_s"], value, doubt_v)
    table.add("/tilt/folded/v_along_sem_mm_s", "numpy", run.arrays["/tilt/folded/v_along_sem_mm_s"], error,
              0.05 * error + doubt_v)
    fastest = fastest_sem = at = at_sem = reversal = reversal_sem = sigmas = np.nan
    enough = weight >= 0.01 * weight.sum()
    sure = np.flatnonzero(enough & (np.abs(value) > 3 * np.nan_to_num(error, nan=np.inf)))
    if sure.size:
        top = sure[np.argmax(np.abs(value[sure]))]
        fastest, fastest_sem, at, sign = value[top], error[top], x[top], np.sign(value[top])
        alike = x[enough & (np.abs(fastest) - sign * value < 2 * np.hypot(fastest_sem, error))]
        at_sem = (max(at, alike.max(initial=at)) - min(at, alike.min(initial=at)) + width) / np.sqrt(12)
        for i in range(top, len(x) - 1):
            if not (sign * value[i] > 0 and sign * value[i + 1] <= 0):
                continue

            def crossing(part):
                curve, n = folded(part), counts[part][:, up].sum(0) + counts[part][:, down].sum(0)
                here = np.flatnonzero(centres[up] >= x[i] * (1 - 1e-9))[0]
                later = np.arange(here + 1, len(up))
                later = later[n[later] > 0]
                if not later.size:
                    return [np.nan, np.nan]
                share = curve[here] / (curve[here] - curve[later[0]])
                return [centres[up][here] + share * (centres[up][later[0]] - centres[up][here]),
                        -sign * np.sum(n[later] * curve[later]) / np.sum(n[later])]

            found, found_sem = jackknife(parts, crossing)
            sigma = found[1] / found_sem[1]
            if not np.isnan(sigma) and not sigma <= sigmas:
                reversal, reversal_sem, sigmas = found[0], found_sem[0], sigma
    near = 2 * doubt_v.max()
    scalar(run, table, "tilt_fastest_mm_s", "numpy", fastest, None, allowed=near)
    scalar(run, table, "tilt_fastest_n_z", "definition", at, at_sem)
    scalar(run, table, "tilt_reversal_n_z", "numpy", reversal, None, allowed=0.02 * width)
    scalar(run, table, "tilt_reversal_sigmas", "numpy", sigmas, None, allowed=0.05 * abs(sigmas))
    for name, sem in (("tilt_fastest_mm_s", fastest_sem), ("tilt_reversal_n_z", reversal_sem)):
        table.add("sem of " + name, "numpy", run.sem_if_steady(name), sem, 0.05 * sem)


@observable(every="10 ms", phases="locked")
def check_polar(run, table):
    frames = run.frames("polar")
    heads = np.exp(1j * run.theta[frames])
    mean = heads.mean(1)
    order = np.abs(mean)
    table.add("/polar/time_s", "trajectory", run.arrays["/polar/time_s"], run.time[frames])
    table.add("/polar/order", "complex numbers", run.arrays["/polar/order"], order, 1e-6)
    turned = np.angle(np.exp(1j * run.arrays["/polar/direction_rad"]) * np.conj(mean))
    table.add("/polar/direction_rad", "complex numbers", turned, 0 * turned, 1e-6 / order)
    v = run.velocity[frames][..., 0] + 1j * run.velocity[frames][..., 1]
    relative = v * np.conj(heads)
    flight = np.abs(v.mean(1)) / np.abs(v).mean(1)
    numbers, sems = jackknife(steady_parts(run, frames), lambda some: [
        order[some].mean(), run.n * order[some].var(), relative[some].real.mean(),
        np.sqrt(np.mean(relative[some].real ** 2)), np.sqrt(np.mean(relative[some].imag ** 2)), flight[some].mean()])
    names = ("P", "polar_susceptibility", "v_forward_mm_s", "v_along_rms_mm_s", "v_across_rms_mm_s",
             "velocity_polarity")
    speed = RELATIVE * np.abs(v).max()
    allowed = (1e-6, 1e-4 * numbers[1], speed, speed, speed, RELATIVE)
    for name, value, sem, one in zip(names, numbers, sems, allowed):
        scalar(run, table, name, "complex numbers", value, sem, allowed=one)


def mass_of(run):
    """Of a rod [mg]: the profile of the union of its beads, turned about the axis, by Simpson's rule."""
    offset, radius = run.beads
    x = np.linspace(np.min(offset - radius), np.max(offset + radius), 2_000_001)
    squares = np.max([r ** 2 - (x - s) ** 2 for s, r in zip(offset, radius)], axis=0)
    return run.scene["rods"]["density"] * np.pi * scipy.integrate.simpson(squares, x)


@observable(every="10 ms", phases="locked")
def check_temperatures(run, table):
    frames = run.frames("temperatures")
    parts = steady_parts(run, frames)
    v = run.velocity[frames] - run.velocity[frames].mean(1, keepdims=True)
    in_plane = (v[..., 0] + 1j * v[..., 1]) * np.exp(-1j * run.theta[frames])
    one = mass_of(run) * run.n / (run.n - 1)
    found = {"horizontal": np.mean(v[..., 0] ** 2 + v[..., 1] ** 2, 1) / 2, "vertical": np.mean(v[..., 2] ** 2, 1),
             "along": np.mean(in_plane.real ** 2, 1), "across": np.mean(in_plane.imag ** 2, 1)}
    table.add("/temperatures/time_s", "trajectory", run.arrays["/temperatures/time_s"], run.time[frames])
    for name, squares in found.items():
        path = f"/temperatures/{name}_pJ"
        table.add(path, "numpy.var", run.arrays[path], one * squares, 5 * RELATIVE * np.max(one * squares))
    # Trajectories have no angular velocities: what is known of these is how they go together.
    parts_of = [run.arrays[f"/temperatures/{name}_pJ"] for name in ("turning", "tipping", "spinning")]
    table.add("/temperatures/rotation_pJ", "the three others", run.arrays["/temperatures/rotation_pJ"],
              np.mean(parts_of, axis=0), remark="by definition")
    for name, values in zip(("turning", "tipping", "spinning"), parts_of):
        table.add(f"/temperatures/{name}_pJ", "sign", np.sign(values.min()) >= 0, True, remark="only that")
    for name in (*found, "turning", "tipping", "spinning", "rotation"):
        series = run.arrays[f"/temperatures/{name}_pJ"]
        (value,), (sem,) = jackknife(parts, lambda some: [series[some].mean()])
        scalar(run, table, f"temperature_{name}_pJ", "numpy", value, sem)
    speeds = np.hypot(run.velocity[frames][..., 0], run.velocity[frames][..., 1])
    for name, of in (("rms", lambda some: np.sqrt(np.mean(speeds[some] ** 2))),
                     ("mean", lambda some: np.mean(speeds[some]))):
        (value,), (sem,) = jackknife(parts, lambda some, of=of: [of(some)])
        scalar(run, table, f"speed_{name}_mm_s", "numpy", value, sem)


@observable(every="10 ms")
def check_collisions(run, table):
    frames = run.frames("collisions")
    step = run.time[frames[1]] - run.time[frames[0]]
    energy, collisions = run.summary["energy_pJ"], run.summary["collisions"]
    table.add("/collisions/time_s", "trajectory", run.arrays["/collisions/time_s"], run.time[frames[1:]])
    totals = {"impacts_rods_Hz": 2 * collisions["rod_rod"], "impacts_base_Hz": collisions["rod_base"],
              "impacts_lid_Hz": collisions["rod_lid"], "impacts_walls_Hz": 0,
              "power_given_pJ_s": energy["given_by_plates"] + energy["given_by_noise"],
              "power_lost_rods_pJ_s": energy["lost_rod_rod"], "power_lost_surfaces_pJ_s": energy["lost_surfaces"]}
    parts = steady_parts(run, frames[:-1])
    for name, total in totals.items():
        rates = run.arrays["/collisions/" + name]
        table.add("/collisions/" + name, "totals of summary.json", rates.sum() * step * run.n, total,
                  1e-9 * abs(total) + 1e-9)
        (value,), (sem,) = jackknife(parts, lambda some: [rates[some].mean()])
        scalar(run, table, name, "numpy", value, sem, allowed=1e-9 * abs(value) + 1e-12)
    rates = run.arrays["/collisions/impacts_rods_Hz"]
    (value,), (sem,) = jackknife(parts, lambda some: [1 / rates[some].mean()])
    scalar(run, table, "mean_free_time_s", "numpy", value, sem)


@observable(every="10 ms", phases="locked")
def check_stress(run, table):
    frames = run.frames("stress")
    area = run.box[0] * run.box[1] if np.ndim(run.box) else run.box ** 2
    v = run.velocity[frames] - run.velocity[frames].mean(1, keepdims=True)
    at_once = run.n / (run.n - 1) * mass_of(run) * np.einsum("tna,tnb->tab", v[..., :2], v[..., :2]) / area
    kinetic = (at_once[1:] + at_once[:-1]) / 2
    table.add("/stress/time_s", "trajectory", run.arrays["/stress/time_s"], run.time[frames[1:]])
    collisional = np.zeros_like(kinetic)
    for a, first in enumerate("xy"):
        for b, second in enumerate("xy"):
            path = f"/stress/kinetic_{first}{second}_pJ_mm2"
            table.add(path, "numpy.einsum", run.arrays[path], kinetic[:, a, b], 5 * RELATIVE * kinetic.max())
            # Trajectories have no impulses: known answers for these are in tests/physics/pressure_test.cpp.
            path = f"/stress/collisional_{first}{second}_pJ_mm2"
            collisional[:, a, b] = run.arrays[path]
    mean = collisional.mean(0)
    for a, first in enumerate("xy"):
        for b, second in enumerate("xy"):
            low, high = (0, np.inf) if a == b else (-np.trace(mean) / 2, np.trace(mean) / 2)
            table.add(f"/stress/collisional_{first}{second}_pJ_mm2", "rods push", low < mean[a, b] < high, True,
                      remark="only that")
    director = np.angle(np.exp(2j * run.theta[frames[1:]]).mean(1)) / 2
    n = np.stack([np.cos(director), np.sin(director)], -1)
    both = kinetic + collisional
    along = np.einsum("ta,tab,tb->t", n, both, n)
    trace = np.trace(both, axis1=1, axis2=2)
    values = {"pressure": trace / 2, "pressure_collisional": np.trace(collisional, axis1=1, axis2=2) / 2,
              "pressure_along": along, "pressure_across": trace - along}
    parts = steady_parts(run, frames[:-1])
    for name, series in values.items():
        (value,), (sem,) = jackknife(parts, lambda some: [series[some].mean()])
        scalar(run, table, name + "_pJ_mm2", "numpy", value, sem, allowed=1e-5 * abs(value))


@observable(every="20 ms", bins=100)
def check_mixing(run, table):
    """Of one species, whose pairs are those of g2 where both sample alike; of several: tests/unit/analysis."""
    same = run.scene["measure"]["g2"]
    assert {key: run.scene["measure"]["mixing"][key] for key in same} == same
    table.add("/mixing/r_mm", "/g2/r_mm", run.arrays["/mixing/r_mm"], run.arrays["/g2/r_mm"])
    for sem in ("", "_sem"):
        known = np.isfinite(run.arrays["/g2/g" + sem])
        table.add("/mixing/g_11" + sem, "/g2/g" + sem, run.arrays["/mixing/g_11" + sem][known],
                  run.arrays["/g2/g" + sem][known], 1e-9)


@observable(every="10 ms")
def check_drift(run, table):
    frames = run.frames("drift")
    centre = run.unwrapped[frames].mean(1)
    steps, times = np.diff(centre, axis=0), np.diff(run.time[frames])
    velocity, sems = jackknife(steady_parts(run, frames[:-1]), lambda some: list(steps[some].sum(0) / times[some].sum()))
    table.add("/drift/time_s", "trajectory", run.arrays["/drift/time_s"], run.time[frames])
    for c, axis in enumerate("xy"):
        table.add(f"/drift/{axis}_mm", "numpy", run.arrays[f"/drift/{axis}_mm"], centre[:, c] - centre[0, c], 1e-4)
    for name, value, sem in zip(("drift_x_mm_s", "drift_y_mm_s"), velocity, sems):
        scalar(run, table, name, "numpy", value, sem, allowed=1e-3, allowed_sem=1e-2)


def axes_apart(places, director, tail, head, box):
    """Distances of the axes of all pairs (n, n): of crossing lines where that lies on both, or from an end."""
    n = len(places)
    way = places[None] - places[:, None]
    way[..., :2] = nearest(way[..., :2], box)
    length = tail + head
    u, w = director[:, None], director[None]
    start = way - tail * w + tail * u  # from the tail of the first to that of the second
    dot = np.clip(np.einsum("ika,kja->ij", np.broadcast_to(u, (n, 1, 3)), np.broadcast_to(w, (1, n, 3))), -1, 1)
    along_u, along_w = np.sum(start * u, -1), np.sum(start * w, -1)

    def apart(s, t):
        return np.linalg.norm(start + t[..., None] * w - s[..., None] * u, axis=-1)

    least = np.full((n, n), np.inf)
    for end in (np.zeros((n, n)), np.full((n, n), length)):
        least = np.minimum(least, apart(end, np.clip(end * dot - along_w, 0, length)))
        least = np.minimum(least, apart(np.clip(end * dot + along_u, 0, length), end))
    with np.errstate(all="ignore"):
        s = (along_u - along_w * dot) / (1 - dot ** 2)
        t = (along_u * dot - along_w) / (1 - dot ** 2)
        inside = (s >= 0) & (s <= length) & (t >= 0) & (t <= length) & (np.abs(dot) < 1 - 1e-9)
    return np.where(inside, np.minimum(least, apart(np.where(inside, s, 0), np.where(inside, t, 0))), least), np.abs(dot)


@observable(every="20 ms", angle=20)
def check_clusters(run, table):
    frames = run.frames("clusters")
    plan = run.scene["measure"]["clusters"]
    offset, _ = run.beads
    octaves = len(run.arrays["/clusters/sizes/size"])
    largest, mean_size, counted = [], [], []
    doubtful = 0
    for frame in frames:
        apart, cosine = axes_apart(run.position[frame], run.director[frame], -offset[0], offset[-1], run.box)
        joined = (apart < plan["distance"]) & (cosine >= np.cos(np.radians(plan["angle"])) * (plan["angle"] < 90))
        near = (np.abs(apart - plan["distance"]) < EDGE) | (np.abs(cosine - np.cos(np.radians(plan["angle"]))) < 1e-6)
        doubtful += bool((near & (apart < plan["distance"] + EDGE)).any())
        _, label = scipy.sparse.csgraph.connected_components(joined, directed=False)
        sizes = np.bincount(label)
        largest.append(sizes.max() / run.n)
        mean_size.append(np.sum(sizes ** 2) / run.n)
        octave = np.floor(np.log2(sizes) + 1e-9).astype(int)
        counted.append(np.concatenate([[np.sum(sizes == 1), len(sizes)], np.bincount(octave, minlength=octaves),
                                       np.bincount(octave, sizes, minlength=octaves)]))
    largest, mean_size, counted = np.array(largest), np.array(mean_size), np.array(counted, float)
    by = "scipy connected_components"
    remark = f"{doubtful} samples with a pair at the edge" if doubtful else ""
    table.add("/clusters/time_s", "trajectory", run.arrays["/clusters/time_s"], run.time[frames])
    # A pair at the edge may split a cluster in two.
    for path, values in (("largest", largest), ("size", mean_size)):
        ours = run.arrays["/clusters/" + path]
        table.add("/clusters/" + path, by, np.sort(np.abs(ours - values))[:len(ours) - doubtful], 0 * values[doubtful:],
                  1e-9 * values.max(), remark)
    table.add("/clusters/sizes/size", "definition", run.arrays["/clusters/sizes/size"], 2.0 ** np.arange(octaves))

    def numbers(some):
        sums = counted[some].sum(0) / (run.n * len(some))
        return np.concatenate([[largest[some].mean(), mean_size[some].mean(), sums[0], sums[1]],
                               sums[2 + octaves:], sums[2:2 + octaves] / 2.0 ** np.arange(octaves)])

    values, sems = jackknife(steady_parts(run, frames), numbers)
    loose = 1e-9 + 2 * doubtful / len(frames)
    for k, name in enumerate(("largest_cluster", "cluster_size", "rods_alone", "clusters_per_rod")):
        scalar(run, table, name, by, values[k], sems[k], loose * values[k] + 1e-9, allowed_sem=0.1 if doubtful else 1e-3)
    for path, some in (("rods", slice(4, 4 + octaves)), ("density", slice(4 + octaves, None))):
        table.add(f"/clusters/sizes/{path}", by, run.arrays[f"/clusters/sizes/{path}"], values[some],
                  1e-9 + loose * values[some].max())
        known = np.isfinite(run.arrays[f"/clusters/sizes/{path}_sem"])
        table.add(f"/clusters/sizes/{path}_sem", by, run.arrays[f"/clusters/sizes/{path}_sem"][known], sems[some][known],
                  1e-9 + (0.1 if doubtful else 1e-3) * sems[some][known])


# ---- pairs ----


def pair_sums(run, frames, samples, visit):
    """visit(displacements (references, rods, 2), cos 2 (theta_i - theta_j), not itself, frame) of every sample."""
    for sample in samples:
        frame = frames[sample]
        first = references(run.n, sample)
        d = nearest(run.place[frame][None] - run.place[frame][first][:, None], run.box)
        value = np.cos(2 * (run.theta[frame][None] - run.theta[frame][first][:, None]))
        other = np.ones(value.shape, bool)
        other[np.arange(len(first)), first] = False
        yield visit(d, value, other, frame)


@observable(every="20 ms")
def check_g2(run, table):
    frames = run.frames("g2")
    parts = steady_parts(run, frames)
    kept = np.concatenate(parts)
    bins = len(run.arrays["/g2/r_mm"])
    width = run.shorter / 2 / bins

    def visit(d, value, other, _):
        place = np.hypot(d[..., 0], d[..., 1])[other] / width
        count, uncertain = histogram(place, bins, EDGE / width)
        near = place < bins
        return count, uncertain, np.bincount(place[near].astype(int), value[other][near], minlength=bins)

    found = dict(zip(kept, pair_sums(run, frames, kept, visit)))
    pairs, doubt, sums = (sum(one[k] for one in found.values()) for k in range(3))
    n_references = sum(len(references(run.n, s)) for s in kept)
    ring = np.pi * width ** 2 * (2 * np.arange(bins) + 1)
    expected = n_references * (run.n - 1) / run.area * ring
    table.add("/g2/r_mm", "definition", run.arrays["/g2/r_mm"], (np.arange(bins) + 0.5) * width)
    table.add("/g2/g", "numpy O(N^2)", run.arrays["/g2/g"], pairs / expected, doubt / expected + 1e-9)
    table.add("/g2/g2", "numpy O(N^2)", run.arrays["/g2/g2"], np.where(pairs > 0, sums / np.maximum(pairs, 1), np.nan),
              2 * doubt / np.maximum(pairs, 1) + 1e-6)

    def curves(some):
        count, value = (sum(found[k][part] for k in some) for part in (0, 2))
        gas = sum(len(references(run.n, k)) for k in some) * (run.n - 1) / run.area * ring
        return np.concatenate([np.where(count > 0, value / np.maximum(count, 1), np.nan), count / gas])

    _, sems = jackknife(parts, curves)
    for name, sem in (("g2", sems[:bins]), ("g", sems[bins:])):
        many = pairs > 1000  # of few pairs, one on the edge of a bin matters
        table.add(f"sem of /g2/{name}", "numpy O(N^2)", run.arrays[f"/g2/{name}_sem"][many], sem[many], 0.1 * sem[many] + 1e-9)
        table.compared.add(f"/g2/{name}_sem")
    if run.n <= 1024:
        universe = universe_of(run, frames, run.place[frames], run.box)
        rdf = MDAnalysis.analysis.rdf.InterRDF(universe.atoms, universe.atoms, bins, (0, run.shorter / 2),
                                               exclusion_block=(1, 1), norm="none")
        rdf.run(frames=[int(k) for k in kept])
        table.add("/g2/g", "MDAnalysis InterRDF, its counts", run.arrays["/g2/g"], rdf.results.count / expected,
                  doubt / expected + 1e-9)


@observable(every="20 ms")
def check_pairs(run, table):
    frames = run.frames("pairs")
    parts = steady_parts(run, frames)
    kept = np.concatenate(parts)
    along = run.arrays["/pairs/along_mm"]
    bins = len(along)
    reach = min(run.scene["measure"]["pairs"]["range"], run.shorter / 2)
    width, strip = 2 * reach / bins, min(run.width, run.shorter / 2)
    cut_bins = len(run.arrays["/pairs/cut/r_mm"])
    half = run.box / 2 * np.ones(2)

    def filled(frame):
        """Bins of the cuts along and across that nearest images fill; in a square all."""
        c, s = abs(np.cos(run.axis[frame])), abs(np.sin(run.axis[frame]))
        if half[0] == half[1]:
            return cut_bins, cut_bins
        with np.errstate(divide="ignore"):
            return tuple(min(cut_bins, int(min((half[0] - strip / 2 * b) / a, (half[1] - strip / 2 * a) / b) / width))
                         for a, b in ((c, s), (s, c)))

    edges = np.linspace(-reach, reach, bins + 1)

    def visit(d, value, other, frame):
        c, s = np.cos(run.axis[frame]), np.sin(run.axis[frame])
        x, y = (d[..., 0] * c + d[..., 1] * s)[other], (d[..., 1] * c - d[..., 0] * s)[other]
        value = value[other]
        near = np.zeros(len(x), bool)
        for place in ((x + reach) / width, (y + reach) / width):
            near |= np.abs(place - np.round(place)) < EDGE / width
        inside = (np.abs(x) < reach) & (np.abs(y) < reach)
        bin_of = (np.floor((y + reach) / width) * bins + np.floor((x + reach) / width)).astype(int)
        count, total, doubt = (np.bincount(bin_of[some], weight[some], bins * bins).reshape(bins, bins)
                               for some, weight in ((inside, np.ones(len(x))), (inside, value),
                                                    (inside & near, np.ones(len(x)))))
        cuts = []
        for (r, off), n_filled in zip(((np.abs(x), np.abs(y)), (np.abs(y), np.abs(x))), filled(frame)):
            close = (off < strip) & (r < n_filled * width)
            r, off, cosine = r[close], off[close], value[close]
            inside = off < strip / 2
            cuts.append(np.histogram(r[inside], cut_bins, (0, cut_bins * width))[0])
            cuts.append(np.histogram(r[inside], cut_bins, (0, cut_bins * width), weights=cosine[inside])[0])
            unsure = (np.abs(off - strip / 2) < EDGE) | (inside & (np.abs(r / width - np.round(r / width)) < EDGE / width))
            cuts.append(np.convolve(np.histogram(r[unsure], cut_bins, (0, cut_bins * width))[0], np.ones(3), "same"))
        return count, total, doubt, np.array(cuts)

    sampled = list(pair_sums(run, frames, kept, visit))
    counts, sums, doubt = (sum(s[k] for s in sampled) for k in range(3))
    doubt = 9 * scipy.ndimage.uniform_filter(doubt, 3, mode="constant")
    density = (run.n - 1) / run.area * np.array([len(references(run.n, s)) for s in kept])
    expected = density.sum() * width ** 2
    # either rod may be the first: the map and its point reflection
    counts, sums, doubt = (a + a[::-1, ::-1] for a in (counts, sums, doubt))
    corner = np.hypot(np.abs(along)[:, None] + width / 2, np.abs(along)[None] + width / 2)
    known = corner <= run.shorter / 2
    g = np.where(known, counts / (2 * expected), np.nan)
    g2 = np.where(known & (counts > 0), sums / np.maximum(counts, 1), np.nan)
    table.add("/pairs/along_mm", "definition", along, (edges[1:] + edges[:-1]) / 2)
    table.add("/pairs/across_mm", "definition", run.arrays["/pairs/across_mm"], (edges[1:] + edges[:-1]) / 2)
    table.add("/pairs/g", "numpy O(N^2)", run.arrays["/pairs/g"], g.ravel(), doubt.ravel() / (2 * expected) + 1e-9)
    # bins that rounding may have given their only pair are left out
    ours = np.where((counts <= doubt).ravel() & (counts < 4).ravel(), g2.ravel(), run.arrays["/pairs/g2"])
    table.add("/pairs/g2", "numpy O(N^2)", ours, g2.ravel(), (2 * doubt / np.maximum(counts, 1)).ravel() + 1e-6)

    r = (np.arange(cut_bins) + 0.5) * width
    table.add("/pairs/cut/r_mm", "definition", run.arrays["/pairs/cut/r_mm"], r)
    cuts = np.array([s[3] for s in sampled])
    total = cuts.sum(0)
    in_bins = np.array([filled(frames[s]) for s in kept])[..., None] > np.arange(cut_bins)
    expected = 2 * width * strip * density[:, None, None] * in_bins  # of each sample, along and across, in each bin
    for k, name in ((0, "along"), (3, "across")):
        with np.errstate(invalid="ignore"):
            known = expected.sum(0)[k // 3] / (expected.sum(0)[k // 3] > 0)
        table.add(f"/pairs/cut/g_{name}", "numpy O(N^2)", run.arrays[f"/pairs/cut/g_{name}"], total[k] / known,
                  total[k + 2] / known + 1e-9)
        table.add(f"/pairs/cut/g2_{name}", "numpy O(N^2)", run.arrays[f"/pairs/cut/g2_{name}"],
                  np.where(total[k] > 0, total[k + 1] / np.maximum(total[k], 1), np.nan),
                  2 * total[k + 2] / np.maximum(total[k], 1) + 1e-6)

    place_of = {sample: i for i, sample in enumerate(kept)}

    def wavelength(some):
        cut = cuts[[place_of[s] for s in some]].sum(0)
        with np.errstate(invalid="ignore"):
            return [first_period(r, cut[4] / cut[3], run.scene["rods"]["length"])]

    def curves(some):
        chosen = [place_of[s] for s in some]
        cut = cuts[chosen].sum(0)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.array([cut[0], cut[3]] / expected[chosen].sum(0)).tolist() + \
                [(cut[1] / cut[0]).tolist(), (cut[4] / cut[3]).tolist()]

    for name, sem in zip(("g_along", "g_across", "g2_along", "g2_across"), jackknife(parts, curves)[1]):
        table.add(f"/pairs/cut/{name}_sem", "numpy O(N^2)", run.arrays[f"/pairs/cut/{name}_sem"], sem,
                  0.02 * np.nan_to_num(sem) + 1e-6)

    value, sem = jackknife(parts, wavelength)
    scalar(run, table, "wavelength_g2_mm", "numpy polyfit", value[0], None, allowed=1e-3 * abs(value[0]))
    table.add("sem of wavelength_g2_mm", "numpy polyfit", run.sem_if_steady("wavelength_g2_mm"), sem[0], 0.05 * abs(sem[0]))


def first_period(r, values, smoothing):
    """First maximum after the first minimum, of analysis/oscillation.h."""
    known = np.isfinite(values)
    x, y = r[known], values[known]
    window = max(1, round(smoothing / (r[1] - r[0])))
    if len(x) < max(5, window + 4):
        return np.nan
    smooth = np.convolve(y, np.full(window, 1 / window), "valid")
    centre = (x[:len(smooth)] + x[window - 1:]) / 2
    far = y[len(y) // 2:]
    step = max(6 * np.sqrt(np.mean(np.diff(far) ** 2 / 2) / window), 1e-9)
    # down from the first maximum, up from the minimum, down from the maximum that is looked for
    extremes, start, sign = [], 0, 1
    while len(extremes) < 3 or sign > 0 or centre[extremes[-1]] < 2 * smoothing:
        rest = sign * smooth[start:]
        left = np.flatnonzero(rest < np.maximum.accumulate(rest) - step)
        if not left.size:
            return np.nan
        extremes.append(start + int(np.argmax(rest[:left[0]])))
        start += int(left[0])
        sign = -sign
    *_, lowest, highest = extremes
    below = smooth <= smooth[highest] - 0.3 * (smooth[highest] - smooth[lowest])
    before, after = np.flatnonzero(below[:highest]), np.flatnonzero(below[highest:])
    first = before[-1] + 1 if before.size else 0
    last = highest + after[0] - 1 if after.size else len(smooth) - 1
    reach = min(highest - first, last - highest)
    if reach == 0:
        return centre[highest]
    a, b, _ = np.polyfit(np.arange(-reach, reach + 1), smooth[highest - reach:highest + reach + 1], 2)
    if not a < 0 or abs(b / (2 * a)) > reach:
        return centre[highest]
    return centre[highest] - b / (2 * a) * (r[1] - r[0])


# ---- waves ----


def wave_sums(places, weights, m, n, box):
    """sum w exp(-i q . r) for q = 2 pi (m / L_x, n / L_y)."""
    waves = [np.arange(k.min(), k.max() + 1) for k in (m, n)]
    of_x, of_y = (np.exp(-2j * np.pi / box[k] * np.multiply.outer(places[:, k], waves[k])) for k in (0, 1))
    return ((of_x * np.asarray(weights)[:, None]).T @ of_y)[m - m.min(), n - n.min()]


def half_plane(box, most, everything=False):
    """m and n of one of each pair +-q of waves, and q in units of 2 pi over the longer side (waves, 2): none of them
    longer than `most` along either side, nor, but for `everything`, altogether."""
    most_m, most_n = np.floor(most * box / box.max() * (1 + 1e-12)).astype(int)
    m, n = np.meshgrid(np.arange(0, most_m + 1), np.arange(-most_n, most_n + 1), indexing="ij")
    m, n = m.ravel(), n.ravel()
    q = np.stack([m, n], axis=1) * (box.max() / box)
    keep = (m > 0) | (n > 0)
    if not everything:
        keep &= np.linalg.norm(q, axis=1) <= most
    return m[keep], n[keep], q[keep]


@observable(every="20 ms")
def check_layers(run, table):
    frames = run.frames("layers")
    parts = steady_parts(run, frames)
    kept = np.concatenate(parts)
    waves = max(1, int(min(40 * np.sqrt(run.longer / run.shorter), run.longer / (run.length / 2))))
    m, n, q = half_plane(run.box, waves)
    size = np.linalg.norm(q, axis=1)
    shell = np.floor(size + 0.5).astype(int) - 1
    shells = waves
    power = np.zeros((len(frames), len(m)))
    across = np.zeros((len(frames), len(m)), bool)
    along = np.zeros((len(frames), len(m)), bool)
    for sample in kept:
        f = frames[sample]
        s = np.sin(2 * (run.theta[f] - run.axis[f]))
        power[sample] = np.abs(wave_sums(run.place[f], s, m, n, run.box)) ** 2
        to_director = fold(np.arctan2(q[:, 1], q[:, 0]) - run.axis[f])
        along[sample] = np.abs(to_director) <= np.pi / 6
        across[sample] = np.abs(to_director) >= np.pi / 3
    table.add("/layers/q_per_mm", "definition", run.arrays["/layers/q_per_mm"],
              2 * np.pi / run.longer * np.arange(1, shells + 1))
    for name, cone in (("across", across), ("along", along)):
        sums = np.array([(power[kept][:, shell == k] * cone[kept][:, shell == k]).sum() for k in range(shells)])
        terms = np.array([cone[kept][:, shell == k].sum() for k in range(shells)])
        table.add(f"/layers/spectrum_{name}", "direct sums", run.arrays[f"/layers/spectrum_{name}"],
                  np.where(terms > 0, sums / np.maximum(terms, 1) / run.n, np.nan))
    amplitude = 4 * power * across / run.n ** 2
    best = int(np.argmax(amplitude[kept].mean(0)))
    side = run.box[0] if abs(q[best, 0]) > abs(q[best, 1]) else run.box[1]  # across the layers
    number = {}
    for k in range(len(m)):
        number[m[k], n[k]] = number[-m[k], -n[k]] = k

    def peak(some):
        mean = amplitude[some].mean(0)
        times = across[some].sum(0)
        often = max(1, (times[best] + 1) // 2)

        def within(a, b):  # mean while it is within the cone
            k = number.get((a, b))
            return amplitude[some][:, k].sum() / times[k] if k is not None and times[k] >= often else None

        weight = within(m[best], n[best]) or 0.0
        to_q = run.longer / run.box
        centre = weight * q[best]
        for dm, dn in ((1, 0), (0, 1), (1, 1), (1, -1)):
            ends = [(m[best] + s * dm, n[best] + s * dn) for s in (1, -1)]
            powers = [within(*end) for end in ends]
            if (0, 0) in ends or None in powers:
                continue
            weight += sum(powers)
            centre += sum(power * np.array(end) * to_q for power, end in zip(powers, ends))
        waves_to_box = np.linalg.norm(centre) / weight if weight > 0 else size[best]
        return run.longer / waves_to_box, side * waves_to_box / run.longer, np.sqrt(mean[best])

    value, sem = jackknife(parts, peak)
    floor = 2 * np.sqrt(np.mean([np.mean(np.sin(2 * (run.theta[frames[k]] - run.axis[frames[k]])) ** 2)
                                 for k in kept]) / run.n)
    if value[2] > 2 * floor:  # waves fit the box in steps of one
        sem[0] = np.hypot(sem[0], value[0] ** 2 / side / np.sqrt(12))
        sem[1] = np.hypot(sem[1], 1 / np.sqrt(12))
    else:
        value[:2] = sem[:2] = np.nan
    for k, name in enumerate(("wavelength_mm", "layers_per_box", "layer_order")):
        scalar(run, table, name, "direct sums", value[k], sem[k])


@observable(every="20 ms", waves=24)
def check_structure(run, table):
    frames = run.frames("structure")
    parts = steady_parts(run, frames)
    kept = np.concatenate(parts)
    shells = run.scene["measure"]["structure"]["waves"]
    m, n, q = half_plane(run.box, shells, everything=True)
    shell = np.floor(np.linalg.norm(q, axis=1) + 0.5).astype(int) - 1
    m, n, q, shell = (x[shell < shells] for x in (m, n, q, shell))
    power = np.zeros((len(frames), len(m)))
    cones = {"": np.ones((len(frames), len(m)), bool)}
    cones["_along"], cones["_across"] = (np.zeros((len(frames), len(m)), bool) for _ in range(2))
    for sample in kept:
        f = frames[sample]
        power[sample] = np.abs(wave_sums(run.place[f], np.ones(run.n), m, n, run.box)) ** 2 / run.n
        to_director = np.abs(fold(np.arctan2(q[:, 1], q[:, 0]) - run.axis[f]))
        cones["_along"][sample] = to_director <= np.pi / 6
        cones["_across"][sample] = to_director >= np.pi / 3

    def curve(cone):
        def means(some):
            terms = np.array([cone[some][:, shell == k].sum() for k in range(shells)])
            sums = np.array([(power[some] * cone[some])[:, shell == k].sum() for k in range(shells)])
            return np.where(terms > 0, sums / np.maximum(terms, 1), np.nan)
        return means

    table.add("/structure/q_per_mm", "definition", run.arrays["/structure/q_per_mm"],
              2 * np.pi / run.longer * np.arange(1, shells + 1))
    for name, cone in cones.items():
        value, sem = jackknife(parts, curve(cone))
        table.add(f"/structure/factor{name}", "direct sums", run.arrays[f"/structure/factor{name}"], value)
        table.add(f"/structure/factor{name}_sem", "jackknife", run.arrays[f"/structure/factor{name}_sem"], sem,
                  allowed=1e-3 * np.nanmax(sem, initial=1e-12))
        if not name:
            scalar(run, table, "structure_longest_wave", "direct sums", value[0], sem[0])


@observable(every="20 ms")
def check_lattice(run, table):
    frames = run.frames("lattice")
    parts = steady_parts(run, frames)
    found = np.full((len(frames), 4), np.nan)
    most = min(128 * np.sqrt(run.longer / run.shorter), run.longer / (run.width / 2))
    m, n, q = half_plane(run.box, max(1, int(most)), everything=True)
    size = np.linalg.norm(q, axis=1)
    keep = (size >= run.longer / (2 * run.length)) & (size <= run.longer / (run.width / 2))
    m, n = m[keep], n[keep]
    for sample in np.concatenate(parts):
        f = frames[sample]
        first = drawn(run.n, sample)
        c, s = np.cos(run.axis[f]), np.sin(run.axis[f])
        turned = np.array([[c, s], [-s, c]])
        psi = []
        for squeeze in (np.diag([run.width / run.length, 1]) @ turned, turned):
            # neighbours among all images of the box next to it, in the squeezed frame
            images = np.concatenate([run.place[f] + run.box * np.array([a, b]) for a in (-1, 0, 1) for b in (-1, 0, 1)])
            # only an image that is nearest in the plane counts
            tree = scipy.spatial.cKDTree(images @ squeeze.T)
            distance, other = tree.query(run.place[f][first] @ squeeze.T, 7)
            bond = (images[other[:, 1:]] - run.place[f][first][:, None]) @ squeeze.T
            psi.append(np.exp(6j * np.arctan2(bond[..., 1], bond[..., 0])).mean(1))
        bragg = np.abs(wave_sums(run.place[f][first], np.ones(len(first)), m, n, run.box)) ** 2
        found[sample] = (abs(psi[0].mean()), np.abs(psi[0]).mean(), abs(psi[1].mean()), bragg.max() / len(first) ** 2)
    values, sems = jackknife(parts, lambda some: found[some].mean(0))
    for name, by, value, sem in zip(("psi_6", "psi_6_local", "psi_6_raw", "bragg_peak"),
                                    ("scipy cKDTree",) * 3 + ("direct sums",), values, sems):
        # two neighbours as good as equally far may change places by the rounding of the trajectory: a third of a bond's worth
        flips = 0 if name == "bragg_peak" else 2 / 3 / (len(first) * sum(map(len, parts)))
        scalar(run, table, name, by, value, sem, allowed=1e-4 * value + flips)


# ---- against lag ----


class Lags:
    """All pairs of samples that analysis/lags/lag_average.h takes, O(T) origins of each lag at once.

    kernel(origins, ends) gives rods (pairs) and sums (pairs, quantities); samples are numbered from the first."""

    def __init__(self, run, times, n_samples, kernel, zero=False, levels=16):
        interval = times[1] - times[0]
        last_origin = n_samples - 1 if zero else n_samples - 2
        per_stretch = 1
        while last_origin // per_stretch >= 64:
            per_stretch *= 2
        from_time = run.steady_given if run.steady_given is not None else run.t_steady
        starts = np.arange(0, last_origin + 1, per_stretch)
        starts = starts[is_steady(times[starts], from_time)]
        self.first, self.per_stretch, self.interval = int(starts[0]), per_stretch, interval
        self.stretches = len(starts)
        self.lags, self.strides, self.rods, self.sums, self.looks = [], [], [], [], []
        wanted = [(0, 1)] * zero + [(lag << k, 1 << k) for k in range(levels) for lag in range(1 if k == 0 else 5, 9)]
        for lag, stride in wanted:
            origins = np.arange(-(-self.first // stride) * stride, n_samples - lag, stride)
            if not origins.size:
                continue
            rods, sums = kernel(origins, origins + lag)
            if not rods.sum() > 0:
                continue
            stretch = (origins - self.first) // per_stretch
            self.lags.append(lag * interval)
            self.strides.append(stride)
            self.looks.append(len(origins) * stride / max(lag, stride))
            self.rods.append(np.bincount(stretch, rods, minlength=self.stretches))
            self.sums.append(np.array([np.bincount(stretch, s, minlength=self.stretches) for s in sums.T]))
        self.lags, self.looks = np.array(self.lags), np.array(self.looks)
        self.rods, self.sums = np.array(self.rods), np.array(self.sums)  # (lags, stretches), (lags, quantities, stretches)
        self.mean = self.sums.sum(-1) / self.rods.sum(-1)[:, None]  # (lags, quantities)

    def sem(self, terms):
        """Of sum coefficient * mean; terms are (lag number, quantity, coefficient)."""
        longest = max(t[0] for t in terms)
        group = self.groups(longest)
        if not group.size or group[-1] < 4:
            return np.nan
        deviation = sum(c * (self.sums[lag, q] - self.mean[lag, q] * self.rods[lag]) / self.rods[lag].sum()
                        for lag, q, c in terms)
        n = group[-1] + 1
        shared = 1 - 1 / (4 * max(1, self.looks[longest] / n))
        return np.sqrt(np.sum(np.bincount(group, deviation) ** 2) * n / (n - 3) / shared)

    def groups(self, lag):
        """To which of the joined stretches each one belongs: of two lags, if there are eight, or of one lag or more."""
        looks = self.looks[lag] * (1 + 1e-9)
        wanted = int(looks / 2) if looks >= 16 else min(8, int(looks))
        if wanted < 1:
            return np.array([], int)
        rods = self.rods[lag]
        wanted = min(wanted, int(rods.sum() / rods.max() + 0.5))
        middle = (np.cumsum(rods) - rods / 2) / rods.sum()
        return np.unique(np.minimum((middle * wanted).astype(int), wanted - 1), return_inverse=True)[1]

    def curve(self, weights):
        value = self.mean @ weights
        return value, np.array([self.sem([(k, q, w) for q, w in enumerate(weights)]) for k in range(len(self.lags))])

    def last_octave(self):
        sure = [k for k in range(len(self.lags)) if (group := self.groups(k)).size and group[-1] >= 4]
        if not sure:
            return np.array([], int)
        longest = self.lags[sure[-1]]
        window = np.flatnonzero((self.lags >= longest / 2 * (1 - 1e-9)) & (self.lags <= longest * (1 + 1e-9)) & (self.lags > 0))
        return window if len(window) >= 3 else np.array([], int)

    def fit(self, weights, window, log=False):
        """Slope by numpy's polyfit, and its error through the coefficients that it is linear in."""
        value = self.mean @ weights
        if len(window) < 3 - log or (log and not (value[window] > 0).all()):
            return np.nan, np.nan
        x, y = (np.log(self.lags[window]), np.log(value[window])) if log else (self.lags[window], value[window])
        slope = np.polyfit(x, y, 1)[0]
        c = (x - x.mean()) / np.sum((x - x.mean()) ** 2)
        if log:
            c = c / value[window]
        return slope, self.sem([(lag, q, ci * w) for lag, ci in zip(window, c) for q, w in enumerate(weights)])

    def growth(self, weights):
        """(from, to, slope, its error, exponent, its error) at short and at long lags, of analysis/lags/lag_fits.h."""
        value = self.mean @ weights
        first = int(self.lags[0] == 0)
        long = self.last_octave()
        end = long[0] if long.size else len(self.lags)
        if end > first:
            latest = max(self.lags[first], self.lags[end - 1] / 4)
            exponents = np.diff(np.log(value[first:end])) / np.diff(np.log(self.lags[first:end]))
            slow = np.flatnonzero((exponents < 1.1) & (self.lags[first:end - 1] < latest))
            start = self.lags[first + slow[0]] if slow.size else latest
            some = np.arange(first, end)
            short = some[(self.lags[some] >= start * (1 - 1e-9)) & (self.lags[some] <= 4 * start * (1 + 1e-9))]
        else:
            short = np.array([], int)
        result = []
        for window in (short, long):
            if len(window) < 3:
                result.append([np.nan] * 6)
            else:
                result.append([self.lags[window[0]], self.lags[window[-1]], *self.fit(weights, window),
                               *self.fit(weights, window, log=True)])
        return result


def lag_frames(run, name):
    frames = run.frames(name)
    if run.steady_given is not None:
        frames = frames[is_steady(run.time[frames], run.steady_given)]
    return frames


def decay_time(lags, value, sem):
    """Where a correlation falls to 1/e, its logarithm interpolated, and the error: that of the value over the slope."""
    t, c = np.concatenate([[0], lags]), np.concatenate([[1], value])
    below = np.flatnonzero(c <= np.exp(-1))
    if not below.size:
        return np.nan, np.nan
    k = below[0]
    error = np.maximum(([0, *sem])[k - 1], sem[k - 1])  # unknown if either is
    step = t[k] - t[k - 1]
    if c[k] > 0:
        return (np.interp(1, -np.log(c[k - 1:k + 1]), t[k - 1:k + 1]),
                error / (np.exp(-1) * np.log(c[k - 1] / c[k]) / step))
    return np.interp(-np.exp(-1), -c[k - 1:k + 1], t[k - 1:k + 1]), error / ((c[k - 1] - c[k]) / step)


@observable(every="10 ms")
def check_msd(run, table):
    frames = lag_frames(run, "msd")
    r, axis, n = run.unwrapped[frames], run.axis[frames], run.n

    def kernel(origins, ends):
        d = r[ends] - r[origins]
        c, s = np.cos(axis[origins])[:, None], np.sin(axis[origins])[:, None]
        along, across = d[..., 0] * c + d[..., 1] * s, d[..., 1] * c - d[..., 0] * s
        return np.full(len(origins), float(n)), np.stack(
            [np.sum(along ** 2, 1), np.sum(across ** 2, 1), n * n / (n - 1) * along.var(1),
                                                 n * n / (n - 1) * across.var(1)], axis=1)

    lags = Lags(run, run.time[frames], len(frames), kernel)
    table.add("/msd/lag_s", "definition", run.arrays["/msd/lag_s"], lags.lags)
    weights = {"total": [1, 1, 0, 0], "along": [1, 0, 0, 0], "across": [0, 1, 0, 0], "relative_total": [0, 0, 1, 1],
               "relative_along": [0, 0, 1, 0], "relative_across": [0, 0, 0, 1]}
    for name, w in weights.items():
        value, sem = lags.curve(w)
        table.add(f"/msd/{name}_mm2", "numpy O(T^2)", run.arrays[f"/msd/{name}_mm2"], value, RELATIVE * value + 1e-9)
        table.add(f"sem of /msd/{name}", "numpy O(T^2)", run.arrays[f"/msd/{name}_sem_mm2"], sem, 1e-3 * sem + 1e-9)
        table.compared.add(f"/msd/{name}_sem_mm2")
    for name, dimensions in (("total", 2), ("along", 1), ("across", 1)):
        for sem in ("", "_sem"):
            table.add(f"/msd/d_{name}{sem}_mm2_s", "definition", run.arrays[f"/msd/d_{name}{sem}_mm2_s"],
                      run.arrays[f"/msd/{name}{sem}_mm2"] / (2 * dimensions * lags.lags))
    # every 2^k-th sample: MDAnalysis' windowed algorithm with that step
    for name, moved in (("total", r),
                        ("relative_total", (r - r.mean(1, keepdims=True)) * np.sqrt(run.n / (run.n - 1)))):
        universe = universe_of(run, frames, moved - moved[:1], run.box)
        theirs = np.empty(len(lags.lags))
        for stride in sorted(set(lags.strides)):
            msd = MDAnalysis.analysis.msd.EinsteinMSD(universe, select="all", msd_type="xy", fft=False)
            msd.run(start=-(-lags.first // stride) * stride, step=stride)
            for k in np.flatnonzero(np.array(lags.strides) == stride):
                theirs[k] = msd.results.timeseries[round(lags.lags[k] / lags.interval) // stride]
        table.add(f"/msd/{name}_mm2", "MDAnalysis EinsteinMSD", run.arrays[f"/msd/{name}_mm2"], theirs,
                  RELATIVE * theirs + 1e-9)

    exponents = np.array([lags.fit(weights["total"], np.arange(max(k - 1, 0), min(k + 2, len(lags.lags))), log=True)
                          for k in range(len(lags.lags))])
    table.add("/msd/exponent", "numpy polyfit", run.arrays["/msd/exponent"], exponents[:, 0], 1e-4)
    table.add("/msd/exponent_sem", "numpy polyfit", run.arrays["/msd/exponent_sem"], exponents[:, 1],
              1e-3 * exponents[:, 1] + 1e-9)
    short, long = zip(*(lags.growth(weights[name]) for name in ("total", "along", "across", "relative_total")))
    for name, fit, dimensions in (("diffusion_mm2_s", long[0], 2), ("diffusion_short_mm2_s", short[0], 2),
                                  ("diffusion_along_mm2_s", long[1], 1), ("diffusion_across_mm2_s", long[2], 1),
                                  ("diffusion_relative_mm2_s", long[3], 2)):
        scalar(run, table, name, "numpy polyfit", fit[2] / (2 * dimensions), fit[3] / (2 * dimensions),
               allowed=1e-4 * abs(fit[2]))
    for name, fit in (("alpha_short", short[0]), ("alpha_long", long[0]), ("alpha_along_short", short[1]),
                      ("alpha_along_long", long[1]), ("alpha_across_short", short[2]), ("alpha_across_long", long[2])):
        scalar(run, table, name, "numpy polyfit", fit[4], fit[5], allowed=1e-4)
    for name, value in zip(("diffusion_lag_from_s", "diffusion_lag_to_s"), long[0]):
        scalar(run, table, name, "definition", value)
    for name, value in zip(("diffusion_short_lag_from_s", "diffusion_short_lag_to_s"), short[0]):
        scalar(run, table, name, "definition", value)


@observable(every="10 ms")
def check_rotation(run, table):
    frames = lag_frames(run, "rotation")
    angle = np.unwrap(run.theta[frames], period=np.pi, axis=0)

    def kernel(origins, ends):
        turn = angle[ends] - angle[origins]
        return np.full(len(origins), float(run.n)), np.stack([np.sum(turn ** 2, 1), np.cos(2 * turn).sum(1)], axis=1)

    lags = Lags(run, run.time[frames], len(frames), kernel)
    table.add("/rotation/lag_s", "definition", run.arrays["/rotation/lag_s"], lags.lags)
    (msad, msad_sem), (c2, c2_sem) = lags.curve([1, 0]), lags.curve([0, 1])
    table.add("/rotation/msad_rad2", "numpy.unwrap O(T^2)", run.arrays["/rotation/msad_rad2"], msad, RELATIVE * msad)
    table.add("/rotation/msad_sem_rad2", "numpy.unwrap O(T^2)", run.arrays["/rotation/msad_sem_rad2"], msad_sem)
    table.add("/rotation/c2", "numpy O(T^2)", run.arrays["/rotation/c2"], c2, 1e-6)
    table.add("/rotation/c2_sem", "numpy O(T^2)", run.arrays["/rotation/c2_sem"], c2_sem)
    short, long = lags.growth([1, 0])
    scalar(run, table, "rotational_diffusion_rad2_s", "numpy polyfit", long[2] / 2, long[3] / 2, allowed=1e-4 * abs(long[2]))
    scalar(run, table, "alpha_rotation_short", "numpy polyfit", short[4], short[5], allowed=1e-4)
    scalar(run, table, "alpha_rotation_long", "numpy polyfit", long[4], long[5], allowed=1e-4)
    for name, value in zip(("rotation_short_lag_from_s", "rotation_short_lag_to_s", "rotation_lag_from_s",
                            "rotation_lag_to_s"), (*short[:2], *long[:2])):
        scalar(run, table, name, "definition", value)
    window = lags.last_octave()
    plateau = (c2[window].mean(), lags.sem([(k, 1, 1 / len(window)) for k in window])) if window.size else (np.nan, np.nan)
    scalar(run, table, "c2_plateau", "numpy", *plateau)
    scalar(run, table, "c2_decay_s", "numpy interp", *decay_time(lags.lags, c2, c2_sem))
    steps = np.abs(np.diff(angle, axis=0))
    scalar(run, table, "large_turns", "numpy", float(np.sum(steps > np.pi / 3)),
           allowed=np.sum(np.abs(steps - np.pi / 3) < 1e-5))


@observable(every="10 ms", window="100 ms")
def check_velocity(run, table):
    frames = lag_frames(run, "velocity")
    times = run.time[frames]
    steps = max(1, round(run.scene["measure"]["velocity"]["window"] / (times[1] - times[0])))
    window = steps * (times[1] - times[0])
    v = (run.unwrapped[frames][steps:] - run.unwrapped[frames][:-steps]) / window
    axis = run.axis[frames]

    def kernel(origins, ends):
        c, s = np.cos(axis[origins])[:, None], np.sin(axis[origins])[:, None]
        turned = [(u[..., 0] * c + u[..., 1] * s, u[..., 1] * c - u[..., 0] * s) for u in (v[origins], v[ends])]
        unit = [u / np.linalg.norm(u, axis=-1, keepdims=True) for u in (v[origins], v[ends])]
        return np.full(len(origins), float(run.n)), np.stack(
            [np.sum(turned[0][k] * turned[1][k], 1) for k in (0, 1)]
            + [np.einsum("tia,tia->t", unit[0], u) for u in (unit[1], v[ends])], axis=1)

    lags = Lags(run, times, len(v), kernel, zero=True)
    table.add("/velocity/lag_s", "definition", run.arrays["/velocity/lag_s"], lags.lags)
    for name, of, weights in (("c_v", "", [1, 1, 0, 0]), ("c_v_along", "_along", [1, 0, 0, 0]),
                              ("c_v_across", "_across", [0, 1, 0, 0])):
        product, product_sem = lags.curve(weights)
        for path, found in ((f"/velocity/product{of}_mm2_s2", product), (f"/velocity/product{of}_sem_mm2_s2", product_sem)):
            table.add(path, "numpy O(T^2)", run.arrays[path], found, RELATIVE * product[0] + 1e-3 * (found is product_sem) * found)
        if of:
            scalar(run, table, f"velocity_variance{of}_mm2_s2", "numpy", product[0], product_sem[0])
        value = product / product[0]
        sem = [lags.sem([(k, q, w / product[0]) for q, w in enumerate(weights)]
                        + [(0, q, -value[k] * w / product[0]) for q, w in enumerate(weights)]) for k in range(len(value))]
        table.add(f"/velocity/{name}", "numpy O(T^2)", run.arrays[f"/velocity/{name}"], value, RELATIVE)
        table.add(f"/velocity/{name}_sem", "numpy O(T^2)", run.arrays[f"/velocity/{name}_sem"], sem, 1e-3 * np.nanmax(sem))
        if name == "c_v":
            c_v, c_v_sem = value, sem
    direction, direction_sem = lags.curve([0, 0, 1, 0])
    table.add("/velocity/direction", "numpy O(T^2)", run.arrays["/velocity/direction"], direction, RELATIVE)
    table.add("/velocity/direction_sem", "numpy O(T^2)", run.arrays["/velocity/direction_sem"], direction_sem,
              1e-3 * np.nanmax(direction_sem) + 1e-9)
    rms = np.sqrt(lags.mean[0, :2].sum())
    scalar(run, table, "velocity_rms_mm_s", "numpy", rms, lags.sem([(0, 0, 1), (0, 1, 1)]) / (2 * rms))

    def integral(mean, weights, normalised, share):
        c = mean @ weights
        level = share * c[0]
        k = np.flatnonzero(c <= level)[0]  # trapezia, the last one cut off where the level is met
        met = np.interp(-level, [-c[k - 1], -c[k]], lags.lags[k - 1:k + 1])
        area = np.trapz([*c[:k], level], [*lags.lags[:k], met]) / (1 - share)
        return area / c[0] if normalised else area

    for name, weights, normalised, share in (("velocity_correlation_s", np.array([1, 1, 0, 0]), True, 0),
                                             ("persistence_time_s", np.array([0, 0, 1, 0]), False, np.exp(-2)),
                                             ("persistence_length_mm", np.array([0, 0, 0, 1]), False, np.exp(-2))):
        value = sem = np.nan
        products = lags.mean @ weights
        if (products <= share * products[0]).any():
            value, terms = integral(lags.mean, weights, normalised, share), []
            for lag in range(np.flatnonzero(products <= share * products[0])[0] + 1):
                for q in np.flatnonzero(weights):  # derivatives by differences
                    step = np.zeros(lags.mean.shape)
                    step[lag, q] = 1e-6 * products[0]
                    slope = (integral(lags.mean + step, weights, normalised, share)
                             - integral(lags.mean - step, weights, normalised, share)) / (2 * step[lag, q])
                    terms.append((lag, q, slope))
            sem = lags.sem(terms)
        scalar(run, table, name, "numpy trapz", value, sem)
    scalar(run, table, "velocity_decay_s", "numpy interp", *decay_time(lags.lags[1:], c_v[1:], c_v_sem[1:]))


@observable(every="10 ms", wavelength="4 mm")
def check_scattering(run, table):
    frames = lag_frames(run, "scattering")
    r, axis = run.unwrapped[frames], run.axis[frames]
    waves = 2 * np.pi / run.scene["measure"]["scattering"]["wavelength"] * 2.0 ** np.arange(4)

    def kernel(origins, ends):
        d = r[ends] - r[origins]
        c, s = np.cos(axis[origins])[:, None], np.sin(axis[origins])[:, None]
        a, b = d[..., 0] * c + d[..., 1] * s, d[..., 1] * c - d[..., 0] * s
        return np.full(len(origins), float(run.n)), np.stack(
            [np.real(np.exp(1j * q * x)).sum(1) for x in (a, b) for q in waves]
            + [np.sum(x, 1) for x in (a ** 2, b ** 2, a ** 4, b ** 4, a ** 2 * b ** 2)], axis=1)

    lags = Lags(run, run.time[frames], len(frames), kernel)
    table.add("/scattering/q_per_mm", "definition", run.arrays["/scattering/q_per_mm"], waves)
    table.add("/scattering/lag_s", "definition", run.arrays["/scattering/lag_s"], lags.lags)
    n_lags = len(lags.lags)
    for name, of_waves in (("f", (0.5, 0.5)), ("f_along", (1, 0)), ("f_across", (0, 1))):
        for wave in range(4):
            weights = np.zeros(13)
            weights[wave], weights[4 + wave] = of_waves
            value, sem = lags.curve(weights)
            row = slice(wave * n_lags, (wave + 1) * n_lags)
            table.add(f"/scattering/{name}", "numpy O(T^2)", run.arrays[f"/scattering/{name}"][row], value, 1e-5)
            ours = run.arrays[f"/scattering/{name}_sem"][row]
            table.add(f"/scattering/{name}_sem", "numpy O(T^2)", ours, sem, 2e-3 * np.nanmax(sem, initial=0) + 1e-8)
            if name == "f":
                scalar(run, table, f"relaxation_q{wave + 1}_s", "numpy interp", *decay_time(lags.lags, value, sem),
                       allowed=1e-4)
    for name, second, fourth, c in (("alpha_2", (1, 1, 0, 0, 0), (0, 0, 1, 1, 2), 2),
                                    ("alpha_2_along", (1, 0, 0, 0, 0), (0, 0, 1, 0, 0), 3),
                                    ("alpha_2_across", (0, 1, 0, 0, 0), (0, 0, 0, 1, 0), 3)):
        moments = lags.mean[:, 8:]

        def alpha(mean):
            return mean @ np.array(fourth) / (c * (mean @ np.array(second)) ** 2) - 1

        value = alpha(moments)
        slopes = np.stack([(alpha(moments * (1 + 1e-6 * unit)) - alpha(moments * (1 - 1e-6 * unit)))
                           / (2e-6 * moments[:, k]) for k, unit in enumerate(np.eye(5))], axis=1)
        sem = np.array([lags.sem([(lag, 8 + k, slopes[lag, k]) for k in range(5)]) for lag in range(n_lags)])
        table.add(f"/scattering/{name}", "numpy O(T^2)", run.arrays[f"/scattering/{name}"], value, 1e-3)
        table.add(f"/scattering/{name}_sem", "numpy O(T^2)", run.arrays[f"/scattering/{name}_sem"], sem,
                  5e-3 * np.nanmax(sem, initial=0))
        if name == "alpha_2":
            peak = np.nanargmax(np.where(np.isfinite(sem), value, np.nan))
            scalar(run, table, "alpha_2_peak", "numpy", value[peak], sem[peak], allowed=1e-3)
            scalar(run, table, "alpha_2_peak_lag_s", "numpy", lags.lags[peak])


@observable(every="10 ms", lag="160 ms", range="2 mm")
def check_van_hove(run, table):
    frames = lag_frames(run, "van_hove")
    plan = run.scene["measure"]["van_hove"]
    r, axis = run.unwrapped[frames], run.axis[frames]
    interval = run.time[frames[1]] - run.time[frames[0]]
    lags, ranges = [], []
    for k in range(3, -1, -1):
        steps = max(1, int(np.floor(plan["lag"] / interval / 4 ** k + 0.5)))
        if steps not in lags:
            lags.append(steps)
            ranges.append(plan["range"] / 2 ** k)
    bins = plan["bins"]
    table.add("/van_hove/lag_s", "definition", run.arrays["/van_hove/lag_s"], np.array(lags) * interval)
    for row, (steps, end) in enumerate(zip(lags, ranges)):
        here = slice(row * bins, (row + 1) * bins)
        width = end / bins
        table.add("/van_hove/displacement_mm", "definition", run.arrays["/van_hove/displacement_mm"][here],
                  (np.arange(bins) + 0.5) * width)
        origins = np.arange(0, len(frames) - steps, steps)
        d = r[origins + steps] - r[origins]
        turned = (d[..., 0] + 1j * d[..., 1]) * np.exp(-1j * axis[origins])[:, None]
        parts = steady_parts(run, frames[origins])
        kept = np.concatenate(parts)
        columns = {"along": (np.abs(turned.real), 2), "across": (np.abs(turned.imag), 2), "distance": (np.abs(turned), 1)}
        for name, (size, sides) in columns.items():
            counts = np.array([np.histogram(x, bins, (0, end))[0] for x in size])
            _, doubt = histogram(size[kept].ravel() / width, bins, EDGE / width)

            def density(some):
                return counts[some].sum(0) / (len(some) * run.n * width * sides)

            value, sem = jackknife(parts, density)
            path = f"/van_hove/{name}_per_mm"
            table.add(path, "numpy.histogram", run.arrays[path][here], value,
                      doubt / (len(kept) * run.n * width * sides) + 1e-9)
            ours = run.arrays[f"/van_hove/{name}_sem_per_mm"][here]
            many = (counts[kept].sum(0) > 1000) & np.isfinite(ours)
            table.add(f"/van_hove/{name}_sem_per_mm", "numpy.histogram", ours[many], sem[many], 0.1 * sem[many] + 1e-9)
        value, sem = jackknife(parts, lambda some: [np.mean(columns["distance"][0][some] >= end)])
    scalar(run, table, "van_hove_beyond", "numpy", value[0], sem[0], 1e-4, allowed_sem=0.05)


@observable(every="20 ms")
def check_flow(run, table):
    frames = lag_frames(run, "flow")
    bins = run.scene["measure"]["flow"]["bins"]
    width = run.shorter / 2 / bins
    step = run.time[frames[1]] - run.time[frames[0]]
    origins = np.arange(len(frames) - 1)
    parts = steady_parts(run, frames[:-1])
    sums = []
    for sample in origins:
        frame = frames[sample]
        v = (run.unwrapped[frames[sample + 1]] - run.unwrapped[frame]) / step
        turned = (v[:, 0] + 1j * v[:, 1]) * np.exp(-1j * run.axis[frame])
        first = references(run.n, sample)
        apart = np.linalg.norm(nearest(run.place[frame][None] - run.place[frame][first][:, None], run.box), axis=-1)
        apart[np.arange(len(first)), first] = np.inf
        products = [np.outer(x[first], x) for x in (turned.real, turned.imag)]
        place = np.minimum(apart / width, bins).astype(int).ravel()
        near = apart < 2 * run.width
        sums.append(np.concatenate(
            [np.bincount(place, minlength=bins + 1)[:bins]]
            + [np.bincount(place, x.ravel(), minlength=bins + 1)[:bins] for x in products]
            + [[near.sum(), products[0][near].sum() + products[1][near].sum(), run.n, np.sum(turned.real ** 2),
                np.sum(turned.imag ** 2)]]))
    sums = np.array(sums)

    def curves(some):
        total = sums[some].sum(0)
        pairs, along, across = total[:3 * bins].reshape(3, bins)
        near, product, rods, square_along, square_across = total[3 * bins:]
        square = square_along + square_across
        with np.errstate(all="ignore"):
            c = (along + across) / pairs * rods / square
            met = np.isfinite(c)
            length = decay_time((np.flatnonzero(met) + 0.5) * width, c[met], np.zeros(met.sum()))[0]
            return np.concatenate([c, along / pairs * rods / square_along, across / pairs * rods / square_across,
                                   [product / near * rods / square, length]])

    values, sems = jackknife(parts, curves)
    table.add("/flow/r_mm", "definition", run.arrays["/flow/r_mm"], (np.arange(bins) + 0.5) * width)
    pairs = sums[np.concatenate(parts)].sum(0)[:bins]
    many = pairs > 1000  # of few pairs, one on the edge of a bin matters
    for k, name in enumerate(("c", "c_along", "c_across")):
        here = slice(k * bins, (k + 1) * bins)
        table.add(f"/flow/{name}", "numpy O(N^2)", run.arrays[f"/flow/{name}"][many], values[here][many], 2e-3)
        table.compared.add(f"/flow/{name}_sem")
        table.add(f"sem of /flow/{name}", "numpy O(N^2)", run.arrays[f"/flow/{name}_sem"][many], sems[here][many],
                  0.1 * sems[here][many] + 1e-9)
    scalar(run, table, "flow_of_neighbours", "numpy O(N^2)", values[-2], sems[-2], 2e-3, allowed_sem=0.05)
    scalar(run, table, "flow_length_mm", "numpy interp", values[-1], sems[-1], 2e-2 * abs(values[-1]), allowed_sem=0.1)


@observable(every="10 ms", count=4, duration="1.5 s")
def check_rods(run, table):
    frames = run.frames("rods")
    start = run.steady_given or 0
    duration = run.scene["measure"]["rods"]["duration"]
    frames = frames[is_steady(run.time[frames], start) & (run.time[frames] <= start + duration + 1e-9)]
    count = min(run.scene["measure"]["rods"]["count"], run.n)
    table.add("/rods/trace/time_s", "trajectory", run.arrays["/rods/trace/time_s"], run.time[frames])
    for k in range(count):
        rod = k * run.n // count
        for name, value, allowed in (("x_mm", run.unwrapped[frames, rod, 0], 1e-5), ("y_mm", run.unwrapped[frames, rod, 1], 1e-5),
                                     ("n_z", run.director[frames, rod, 2], 1e-6)):
            table.add(f"/rods/trace/{k}/{name}", "trajectory", run.arrays[f"/rods/trace/{k}/{name}"], value, allowed)
        turned = run.arrays[f"/rods/trace/{k}/theta_rad"] - run.theta[frames, rod]
        table.add(f"/rods/trace/{k}/theta_rad", "trajectory", np.abs(np.exp(1j * turned) - 1), 0 * turned, 1e-5)


# ---- numbers in boxes ----


@observable(every="20 ms")
def check_fluctuations(run, table):
    frames = run.frames("fluctuations")
    parts = steady_parts(run, frames)
    divisions = [2, 3, 4, 5, 6, 8, 10, 12, 16, 20]
    counts = {m: np.array([np.histogram2d(*p.T, m, [[0, side] for side in run.box])[0].T.ravel() for p in run.place[frames]])
              for m in divisions}
    share = np.array([1 / m ** 2 for m in divisions])
    fit = run.shorter / np.array(divisions) >= 2 * run.length * (1 - 1e-6)

    def numbers(some):
        mean = [counts[m][some].mean() for m in divisions]
        std = [counts[m][some].std() for m in divisions]
        own = [np.sqrt(np.mean(counts[m][some].var(0, ddof=1))) for m in divisions]
        slopes = []
        for spread in (std, own):
            if fit.sum() < 3:
                slopes.append(np.nan)
                continue
            y = np.log(np.array(spread) / np.sqrt(1 - share))[fit]
            slopes.append(np.polyfit(np.log(mean)[fit], y, 1, w=np.array(divisions)[fit])[0])  # w multiplies residuals
        return np.array([*mean, *std, *own, *slopes])

    values, sems = jackknife(parts, numbers)
    k = len(divisions)
    by = "numpy histogram2d"
    table.add("/fluctuations/area_fraction", "definition", run.arrays["/fluctuations/area_fraction"], share)
    table.add("/fluctuations/mean_n", by, run.arrays["/fluctuations/mean_n"], values[:k])
    for name, some in (("std_n", slice(k, 2 * k)), ("std_n_without_map", slice(2 * k, 3 * k))):
        table.add(f"/fluctuations/{name}", by, run.arrays[f"/fluctuations/{name}"], values[some], 1e-3 * values[some])
        table.add(f"/fluctuations/{name}_sem", by, run.arrays[f"/fluctuations/{name}_sem"], sems[some], 0.02 * sems[some])
    scalar(run, table, "fluctuation_sizes", "definition", float(fit.sum()))
    scalar(run, table, "fluctuation_exponent", "numpy polyfit", values[-2], sems[-2], allowed=1e-3)
    scalar(run, table, "fluctuation_exponent_without_map", "numpy polyfit", values[-1], sems[-1], allowed=1e-3)


# ---- the director's fluctuations ----


@observable(every="20 ms")
def check_frank(run, table):
    frames = run.frames("frank")
    parts = steady_parts(run, frames)
    m, n, _ = half_plane(run.box, 6, everything=True)
    unit = 2 * np.pi / run.longer  # of a square box: there is no measure.frank in another
    q_max = max(2 * np.pi / (3 * run.scene["rods"]["length"]), 1.5 * unit)
    area = run.area
    powers, floors = np.full((len(frames), len(m)), np.nan), np.full(len(frames), np.nan)
    for sample in np.concatenate(parts):
        f = frames[sample]
        if run.order[f] < 0.3:
            continue
        s = np.sin(2 * (run.theta[f] - run.axis[f])) / (2 * run.order[f])
        power = area * np.abs(wave_sums(run.place[f], s, m, n, run.box)) ** 2 / run.n ** 2
        structure = np.mean(np.abs(wave_sums(run.place[f], np.ones(run.n), m, n, run.box)) ** 2) / run.n
        _, other = scipy.spatial.cKDTree(run.place[f], boxsize=run.box * (1 + 1e-12)).query(run.place[f], 2)
        other = other[:, 1]
        shared = np.mean(s * s[other])
        apart = 1 - np.real(wave_sums(run.place[f] - run.place[f][other], np.full(run.n, 1 / run.n), m, n, run.box))
        even = 1 - structure if run.n >= 4 * len(m) else 0

        # the floor stands on both sides of its own definition: by bisection
        def misfit(floor):
            own = np.mean(s ** 2) - shared - 2 * np.sum((power - floor) / area * apart)
            return run.n * floor - area * (even * own + (1 - even) * np.mean(s ** 2))

        floors[sample] = scipy.optimize.brentq(misfit, -10 * area, 10 * area, xtol=1e-14)
        powers[sample] = power - floors[sample]

    def spectrum(some):
        some = some[np.isfinite(floors[some])]
        rows = []
        axis = run.axis[frames[some]]
        sector = np.floor((axis / np.pi + 0.5) * 36).astype(int)
        for k in np.unique(sector):
            inside = some[sector == k]
            mean_axis = np.angle(np.mean(np.exp(2j * run.axis[frames[inside]]))) / 2
            c, s = np.cos(mean_axis), np.sin(mean_axis)
            rows.append(np.stack([np.abs(unit * (m * c + n * s)), np.abs(unit * (n * c - m * s)), powers[inside].mean(0),
                                  np.full(len(m), floors[inside].mean()), np.full(len(m), float(len(inside)))], axis=1))
        squares = np.full((100, 5), np.nan)
        if not rows:
            return np.array([np.nan] * 4 + list(squares.ravel()))
        along, across, power, floor, weight = np.concatenate(rows).T
        fitted = along ** 2 + across ** 2 <= q_max ** 2 * (1 + 1e-9)
        a, b, p, e, w = (x[fitted] for x in (along, across, power, floor, weight))

        def cost(constants):
            stiff = constants[0] * b ** 2 + constants[1] * a ** 2
            expected = 1 / stiff + e
            if not ((stiff > 0) & (expected > 0)).all():
                return np.inf
            return np.sum(w * ((p + e) / expected + np.log(expected)))

        guess = w.sum() / np.sum(w * (p + e) * (a ** 2 + b ** 2))
        found = scipy.optimize.minimize(lambda x: cost(np.exp(x)), np.log([guess, guess]), method="Nelder-Mead",
                                        options={"xatol": 1e-8, "fatol": 1e-12, "maxiter": 2000})
        splay, bend = np.exp(found.x)
        fit = 1 / (splay * across ** 2 + bend * along ** 2)
        place = np.minimum(np.floor(across / unit + 0.5), 9) * 10 + np.minimum(np.floor(along / unit + 0.5), 9)
        for k in np.unique(place.astype(int)):
            here = place == k
            squares[k] = [*(np.average(x[here], weights=weight[here]) for x in (along, across, power, fit)),
                          fitted[here].all()]
        return np.array([splay, bend, bend / splay, np.average(floor, weights=weight), *squares.ravel()])

    values, sems = jackknife(parts, spectrum)
    squares, square_sems = values[4:].reshape(100, 5), sems[4:].reshape(100, 5)
    met = np.isfinite(squares[:, 0])
    by = "direct sums, cKDTree"
    for k, name in ((0, "q_along_per_mm"), (1, "q_across_per_mm"), (2, "power_mm2")):
        table.add(f"/frank/{name}", by, run.arrays[f"/frank/{name}"], squares[met, k])
    table.add("/frank/power_sem_mm2", by, run.arrays["/frank/power_sem_mm2"], square_sems[met, 2],
              1e-4 * square_sems[met, 2])
    table.add("/frank/fit_mm2", "scipy Nelder-Mead", run.arrays["/frank/fit_mm2"], squares[met, 3], 1e-3 * squares[met, 3])
    for k, name in enumerate(("frank_splay", "frank_bend", "frank_ratio")):
        table.add(name, "scipy Nelder-Mead", run.measured(name), values[k], 1e-3 * values[k])
        table.add("sem of " + name, "scipy Nelder-Mead", run.sem_if_steady(name), sems[k], 0.01 * sems[k])
    scalar(run, table, "frank_floor_mm2", by, values[3])
    pulls = ((squares[:, 2] - squares[:, 3]) / square_sems[:, 2])[squares[:, 4] == 1]
    pulls = pulls[np.isfinite(pulls)]
    chi2 = np.sum(pulls ** 2) / (len(pulls) - 2) if len(pulls) > 2 else np.nan
    scalar(run, table, "frank_chi2", "definition", chi2, allowed=1e-3 * abs(chi2))


# ---- defects ----


def winding(q):
    """Charge of every plaquette of a periodic grid of complex Q (y, x), from phases of quotients of neighbours."""
    corners = [q, np.roll(q, -1, 1), np.roll(q, (-1, -1), (0, 1)), np.roll(q, -1, 0)]
    turn = sum(np.angle(corners[(k + 1) % 4] * np.conj(corners[k])) for k in range(4))
    return np.round(turn / (2 * np.pi)).astype(int) / 2


def coarse_field(run, frame, nodes, smoothing):
    """Mean of exp(2 i theta) with Gaussian weights at the nodes (y, x), every rod, every node; and where it is defined:
    where the weights of the rods over those of the nodes are at least half of the mean."""
    weights, room = [], 1.0
    for k in (0, 1):
        grid = np.arange(nodes[k]) * run.box[k] / nodes[k]
        reach = min(4 * smoothing, run.box[k] / 2)
        d = nearest(grid[:, None] - run.place[frame][None, :, k], run.box[k])
        weights.append(np.where(np.abs(d) <= reach, np.exp(-d ** 2 / (2 * smoothing ** 2)), 0))
        distance = np.minimum(grid, run.box[k] - grid)
        room *= np.sum(np.where(distance <= reach, np.exp(-distance ** 2 / (2 * smoothing ** 2)), 0))
    total = weights[1] @ weights[0].T
    q = (weights[1] * np.exp(2j * run.theta[frame])) @ weights[0].T
    return np.where(total > 0, q / np.where(total > 0, total, 1), 0), total / room >= 0.5 * run.n / nodes.prod()


def direction_of(q, mesh, x, y, charge, radius):
    """Ray along which the director is radial: from the phase of the winding mode on a ring of 64 points."""
    phi = 2 * np.pi * np.arange(64) / 64
    on_ring = [scipy.ndimage.map_coordinates(part, [(y + radius * np.sin(phi)) / mesh[1], (x + radius * np.cos(phi)) / mesh[0]],
                                             order=1, mode="grid-wrap") for part in (q.real, q.imag)]
    mode = np.mean((on_ring[0] + 1j * on_ring[1]) * np.exp(-2j * charge * phi))
    return np.angle(mode) / 2 / (1 - charge)


@observable(every="20 ms", list=True, min_lifetime="100 ms")
def check_defects(run, table):
    frames = run.frames("defects")
    plan = run.scene["measure"]["defects"]
    smoothing = plan.get("smoothing") or run.length / 2
    mesh = plan.get("grid") or run.length / 8
    nodes = np.maximum(4, np.ceil(run.box / mesh - 1e-9).astype(int))
    mesh = run.box / nodes
    table.add("/defects/time_s", "trajectory", run.arrays["/defects/time_s"], run.time[frames])
    n_plus, n_minus = np.zeros(len(frames)), np.zeros(len(frames))
    listed = "/defects/list/x_mm" in run.arrays
    if listed:
        ours = np.stack([run.arrays["/defects/list/" + k] for k in ("time_s", "x_mm", "y_mm", "charge", "direction_rad")], axis=1)
    apart, turned, met, missed = [], [], 0, 0
    for sample, frame in enumerate(frames):
        q, defined = coarse_field(run, frame, nodes, smoothing)
        charge = winding(q)
        charge[~(defined & np.roll(defined, -1, 1) & np.roll(defined, -1, 0) & np.roll(defined, (-1, -1), (0, 1)))] = 0
        n_plus[sample], n_minus[sample] = np.sum(charge > 0), np.sum(charge < 0)
        if not listed:
            continue
        rows = ours[np.abs(ours[:, 0] - run.time[frame]) < 1e-9]
        j, i = np.nonzero(charge)
        found = []
        for a, b in zip(j, i):
            # zero of the bilinear Q
            corner = [[q[(a + y) % nodes[1], (b + x) % nodes[0]] for x in (0, 1)] for y in (0, 1)]

            def at(p):
                value = ((1 - p[1]) * ((1 - p[0]) * corner[0][0] + p[0] * corner[0][1])
                         + p[1] * ((1 - p[0]) * corner[1][0] + p[0] * corner[1][1]))
                return [value.real, value.imag]

            for start in ([0.5, 0.5], [0.1, 0.1], [0.9, 0.1], [0.1, 0.9], [0.9, 0.9]):
                core, _, status, _ = scipy.optimize.fsolve(at, start, full_output=True)
                if status == 1 and (core > -1e-6).all() and (core < 1 + 1e-6).all():
                    break
            found.append((*((np.array([b, a]) + core) * mesh % run.box), charge[a, b]))
        found = np.array(found).reshape(-1, 3)
        taken = set()
        for x, y, c in found:
            d = np.linalg.norm(nearest(rows[:, 1:3] - [x, y], run.box), axis=1)
            d[(rows[:, 3] != c) | np.isin(np.arange(len(rows)), list(taken))] = np.inf
            if not d.size or d.min() > np.hypot(*mesh):
                missed += 1
                continue
            k = int(np.argmin(d))
            taken.add(k)
            apart.append(d[k])
            # a lone one: its ring is as wide as the smoothing
            rest = np.linalg.norm(nearest(found[:, :2] - [x, y], run.box), axis=1)
            alone = np.sort(rest)[1] if len(rest) > 1 else np.inf
            if alone >= 2 * smoothing and abs(c) == 0.5:
                period = np.pi / (1 - c)
                off = rows[k, 4] - direction_of(q, mesh, x, y, c, smoothing)
                turned.append(abs((off + period / 2) % period - period / 2) / (period / 2))
        met += len(rows)
    doubt = max(2, 1e-3 * met)
    by = "rods x nodes, phases round plaquettes"
    for name, count in (("n_plus", n_plus), ("n_minus", n_minus)):
        table.add(f"/defects/{name}", by, run.arrays[f"/defects/{name}"], count, 1, "1: rounding in one plaquette")
        table.add(f"/defects/{name}: sum", by, run.arrays[f"/defects/{name}"].sum(), count.sum(), doubt)
    charge, charge_sem = jackknife(steady_parts(run, frames), lambda some: np.mean(n_plus[some] - n_minus[some]) / 2)
    scalar(run, table, "defect_charge", by, float(charge), float(charge_sem), allowed=doubt / len(frames))
    steady = is_steady(run.time[frames], run.t_steady)
    for name, count in (("mean_plus", n_plus), ("mean_minus", n_minus)):
        table.add("defects: " + name, by, run.summary["defects"][name], count[steady].mean(), doubt / steady.sum())
    if listed and met:
        table.add("/defects/list: not found again", by, missed, 0, doubt)
        table.add("/defects/list/x_mm, y_mm: 99th percentile", "scipy fsolve", np.quantile(apart, 0.99), 0, 0.02 * mesh.min())
        if turned:
            table.add("/defects/list/direction_rad: median", "winding mode on a ring", np.median(turned), 0, 0.15,
                      f"another estimate; of half its period, {len(turned)} lone ones")
    for name in ("time_s", "x_mm", "y_mm", "charge", "direction_rad"):
        table.compared.add("/defects/list/" + name)
    if listed:
        check_tracks(run, table, frames, plan)


def check_tracks(run, table, frames, plan):
    """Tracks of the defects of our list, linked again, and what they come down to."""
    area, interval = run.area, run.time[frames[1]] - run.time[frames[0]]
    spans = (1, 2, 4, 8, 16)
    columns = [run.arrays["/defects/list/" + k] for k in ("time_s", "x_mm", "y_mm", "charge", "direction_rad", "track")]
    next_id, alive, ids = 0, [], []
    sums = [{"all": {}, "lasting": {}} for _ in frames]

    def count(sample, group, key, value=1.0):
        sums[sample][group][key] = sums[sample][group].get(key, 0.0) + value

    def pairs_of(first, second, allowed):
        """Closest pairs first: (index, index) of rows of positions, where allowed."""
        d = np.linalg.norm(nearest(first[:, None] - second[None], run.box), axis=-1)
        d = np.where(allowed & (d <= np.inf), d, np.inf)
        result = []
        while d.size and np.isfinite(d.min()):
            i, j = np.unravel_index(np.argmin(d), d.shape)
            result.append((i, j))
            d[i], d[:, j] = np.inf, np.inf
        return result

    def places(tracks):
        return np.array([t["trail"][-1][1:3] for t in tracks]).reshape(-1, 2)

    for sample, frame in enumerate(frames):
        time = run.time[frame]
        here = np.abs(columns[0] - time) < 1e-9
        now = np.stack([c[here] for c in columns], axis=1)
        step = interval if sample else 0.0
        limit = {c: min(run.length, 0.5 * np.sqrt(area / max(np.sum(now[:, 3] == c), sum(t["charge"] == c for t in alive), 1)))
                 for c in (0.5, -0.5)}
        before, charges = places(alive), np.array([t["charge"] for t in alive])
        d = np.linalg.norm(nearest(before[:, None] - now[None, :, 1:3], run.box), axis=-1)
        same = (charges[:, None] == now[None, :, 3]) if len(alive) else np.zeros((0, len(now)), bool)
        reach = np.where(now[:, 3] > 0, limit[0.5], limit[-0.5])
        links = pairs_of(before, now[:, 1:3], same & (d <= reach[None]))
        goes_on = {i for i, _ in links}
        both = limit[0.5] + limit[-0.5]
        dead = [t for i, t in enumerate(alive) if i not in goes_on]
        plus, minus = [t for t in dead if t["charge"] > 0], [t for t in dead if t["charge"] < 0]
        apart = np.linalg.norm(nearest(places(plus)[:, None] - places(minus)[None], run.box), axis=-1)
        met = pairs_of(places(plus), places(minus), apart <= both)
        met_lasting = sum(plus[i]["lasting"] and minus[j]["lasting"] for i, j in met)
        old = sum(t["lasting"] for t in dead)
        for group, n_pairs, n_dead in (("all", len(met), len(dead)), ("lasting", met_lasting, old)):
            count(sample, group, "annihilations", n_pairs)
            count(sample, group, "deaths", n_dead)
            count(sample, group, "deaths_alone", n_dead - 2 * n_pairs)
        source = {j: i for i, j in links}
        following, born = [], []
        for j, row in enumerate(now):
            ray = np.exp(1j * row[4])
            if j in source:
                track = alive[source[j]]
                last = track["trail"][-1]
                track["trail"].append((time, *(last[1:3] + nearest(row[1:3] - last[1:3], run.box)), ray))
                sign = "plus" if row[3] > 0 else "minus"
                for k in spans:
                    if len(track["trail"]) <= k:
                        break
                    path = track["trail"][-1 - k:]
                    v = complex(path[-1][1] - path[0][1], path[-1][2] - path[0][2]) / (path[-1][0] - path[0][0])
                    p = sum(place[3] for place in path)
                    relative = v * np.conj(p / abs(p))
                    for key, value in (("n", 1.0), ("speed", abs(v)), ("along", relative.real), ("across", relative.imag)):
                        count(sample, "all", (sign, k, key), value)
                        if track["lasting"]:
                            count(sample, "lasting", (sign, k, key), value)
                        else:
                            track["pending"][sign, k, key] = track["pending"].get((sign, k, key), 0.0) + value
            else:
                track = {"id": next_id, "charge": row[3], "born": time, "seen": sample > 0, "partner": None, "lasting": False,
                         "trail": [(time, row[1], row[2], ray)], "pending": {}}
                next_id += 1
                if sample:
                    born.append(track)
            following.append(track)
            count(sample, "all", "lived", step)
            if track["lasting"]:
                count(sample, "lasting", "lived", step)
            else:
                track["pending"]["lived"] = track["pending"].get("lived", 0.0) + step
        alive = following
        ids.extend(t["id"] for t in alive)
        plus, minus = [t for t in born if t["charge"] > 0], [t for t in born if t["charge"] < 0]
        apart = np.linalg.norm(nearest(places(plus)[:, None] - places(minus)[None], run.box), axis=-1)
        couples = pairs_of(places(plus), places(minus), apart <= both)
        for i, j in couples:
            plus[i]["partner"], minus[j]["partner"] = minus[j], plus[i]
        count(sample, "all", "creations", len(couples))
        count(sample, "all", "births_alone", len(born) - 2 * len(couples))
        grown = [t for t in alive if not t["lasting"] and time - t["born"] >= plan["min_lifetime"] - 1e-6 * interval]
        for track in grown:
            track["lasting"] = True
            for key, value in track["pending"].items():
                count(sample, "lasting", key, value)
        for track in grown:
            if not track["seen"]:
                continue
            together = any(track["partner"] is t for t in grown)
            if together and track["charge"] > 0:
                count(sample, "lasting", "creations")
            if not together:
                count(sample, "lasting", "births_alone")

    by = "own linking of our list"
    table.add("/defects/list/track", by, columns[5], ids, 0)
    keys = [("lived", "density_per_mm2"), ("creations", "creation_rate_per_mm2_s"), ("annihilations", "annihilation_rate_per_mm2_s"),
            ("births_alone", "lone_birth_rate_per_mm2_s"), ("deaths_alone", "lone_death_rate_per_mm2_s")]
    speeds = [("speed_plus", "plus", "speed"), ("speed_minus", "minus", "speed"), ("speed_plus_along", "plus", "along"),
              ("speed_plus_across", "plus", "across")]
    parts = steady_parts(run, frames)
    table.add("/defects/tracks/span_s", "definition", run.arrays["/defects/tracks/span_s"], np.array(spans) * interval)
    for group, prefix, folder in (("all", "defect_", ""), ("lasting", "lasting_defect_", "lasting/")):

        def total(some, key):
            return sum(sums[s][group].get(key, 0.0) for s in some)

        def numbers(some):
            room = area * interval * np.sum(some > 0)
            with np.errstate(invalid="ignore", divide="ignore"):
                result = [np.float64(total(some, key)) / room for key, _ in keys]
                deaths = total(some, "deaths")
                result.append(total(some, "lived") / deaths if deaths else np.nan)
                for _, sign, key in speeds:
                    result += [np.float64(total(some, (sign, k, key))) / total(some, (sign, k, "n")) for k in spans]
            return result

        values, errors = jackknife(parts, numbers)
        for k, (_, name) in enumerate(keys):
            scalar(run, table, prefix + name, by, values[k], errors[k])
        scalar(run, table, prefix + "lifetime_s", by, values[5], errors[5])
        for k, (name, _, _) in enumerate(speeds):
            curve, sem = values[6 + 5 * k:11 + 5 * k], errors[6 + 5 * k:11 + 5 * k]
            path = f"/defects/tracks/{folder}{name}"
            table.add(path + "_mm_s", by, run.arrays[path + "_mm_s"], curve)
            table.add(path + "_sem_mm_s", by, run.arrays[path + "_sem_mm_s"], sem)
            scalar(run, table, prefix + name + "_mm_s", by, curve[2], sem[2])


@observable(every="20 ms", bins=11, separation="1.25 mm")
def check_defect_maps(run, table):
    """About the defects of the list of measure.defects, which check_defects finds again."""
    frames = run.frames("defect_maps")
    plan, same = run.scene["measure"]["defect_maps"], ("every", "smoothing", "grid")
    assert {key: run.scene["measure"]["defects"][key] for key in same} == {key: plan[key] for key in same}
    listed = np.stack([run.arrays["/defects/list/" + k] for k in ("time_s", "x_mm", "y_mm", "charge", "direction_rad")],
                      axis=1)
    bins, reach = plan["bins"], min(plan["range"], run.shorter / 2)
    core = min(plan["smoothing"], reach)
    width = 2 * reach / bins
    names = ("density", "cos_2theta", "sin_2theta", "v_along_mm_s", "v_across_mm_s", "tilt_squared")
    size = 4 + 6 * bins ** 2
    sums, doubt = np.zeros((len(frames) - 2, 2, size)), np.zeros((2, bins ** 2))
    core_doubt = np.zeros(2)
    for sample, (before, frame, after) in enumerate(zip(frames, frames[1:], frames[2:])):
        velocity = (run.unwrapped[after] - run.unwrapped[before]) / (run.time[after] - run.time[before])
        velocity = velocity[:, 0] + 1j * velocity[:, 1]
        defects = listed[np.abs(listed[:, 0] - run.time[frame]) < 1e-9, 1:]
        for k, (x, y, charge, direction) in enumerate(defects):
            others = np.delete(defects[:, :2], k, axis=0)
            if len(others) and np.linalg.norm(nearest(others - [x, y], run.box), axis=1).min() < plan["separation"]:
                continue
            if abs(charge) != 0.5:
                continue
            way = nearest(run.place[frame] - [x, y], run.box)
            sign = 0 if charge > 0 else 1
            for psi in [direction] if charge > 0 else direction + 2 * np.pi / 3 * np.arange(3):
                turned = (way[:, 0] + 1j * way[:, 1]) * np.exp(-1j * psi)
                place = (np.stack([turned.real, turned.imag]) + reach) / width
                inside = np.abs(turned) < reach
                at = np.clip(np.floor(place), 0, bins - 1).astype(int)
                flat = (at[1] * bins + at[0])[inside]
                # a rod this near an edge may be in the next bin, or none
                near = (np.abs(place - np.round(place)) * width < EDGE).any(0) & (np.abs(turned) < reach + EDGE)
                for i in np.flatnonzero(near):
                    doubt[sign, np.unique([np.clip(np.floor(place[1, i] + b * 1e-3), 0, bins - 1) * bins +
                                           np.clip(np.floor(place[0, i] + a * 1e-3), 0, bins - 1)
                                           for a in (-1, 1) for b in (-1, 1)]).astype(int)] += 1
                flow, twice = velocity * np.exp(-1j * psi), np.exp(2j * (run.theta[frame] - psi))
                middle = np.abs(turned) < core
                core_doubt[sign] += np.sum(np.abs(np.abs(turned) - core) < EDGE)
                sums[sample, sign, :4] += [1, middle.sum(), flow.real[middle].sum(), flow.imag[middle].sum()]
                for q, values in enumerate((np.ones(run.n), twice.real, twice.imag, flow.real, flow.imag,
                                            run.director[frame, :, 2] ** 2)):
                    here = slice(4 + q * bins ** 2, 4 + (q + 1) * bins ** 2)
                    sums[sample, sign, here] += np.bincount(flat, values[inside], minlength=bins ** 2)
    density, parts = run.n / run.area, steady_parts(run, frames[1:-1])
    corners = (np.abs(np.arange(bins) - (bins - 1) / 2) + 0.5) * width
    known = (np.hypot(*np.meshgrid(corners, corners)) <= reach * (1 + 1e-9)).ravel()

    def numbers(some):
        result = []
        with np.errstate(all="ignore"):
            for sign in (0, 1):
                total = sums[some, sign].sum(0)
                rods, *others = total[4:].reshape(6, bins ** 2)
                maps = [rods / (total[0] * density * width ** 2), *(other / rods for other in others)]
                result.append(np.where(known, maps, np.nan).ravel())
                result.append([total[0] / (1, 3)[sign] / len(some), total[1] / (total[0] * density * np.pi * core ** 2),
                               total[2] / total[1], total[3] / total[1]])
        return np.concatenate(result)

    values, sems = (one.reshape(2, -1) for one in jackknife(parts, numbers))
    by = "numpy, rod by rod"
    for name in ("along_mm", "across_mm"):
        table.add(f"/defect_maps/{name}", "definition", run.arrays[f"/defect_maps/{name}"],
                  (np.arange(bins) + 0.5) * width - reach)
    steady = np.concatenate(parts)
    for sign, charge in enumerate(("plus", "minus")):
        rods, frames_of = sums[steady, sign, 4:4 + bins ** 2].sum(0), max(sums[steady, sign, 0].sum(), 1)
        fastest = np.max(np.abs(values[sign].reshape(-1)[np.isfinite(values[sign])]), initial=1)
        few = np.maximum(rods, 1)
        for q, name in enumerate(names):
            stem, unit = (name[:-5], "_mm_s") if name.endswith("_mm_s") else (name, "")
            here = slice(q * bins ** 2, (q + 1) * bins ** 2)
            allowed = (doubt[sign] / (frames_of * density * width ** 2) if q == 0 else
                       2 * doubt[sign] / few * (fastest if unit else 1))
            ours = run.arrays[f"/defect_maps/{charge}/{name}"]
            sure = (doubt[sign] == 0) | (rods > 20)
            table.add(f"/defect_maps/{charge}/{name}", by, ours[sure], values[sign, here][sure],
                      allowed[sure] + (2e-3 if unit else 2e-5))
            errors = run.arrays[f"/defect_maps/{charge}/{stem}_sem{unit}"]
            table.compared.add(f"/defect_maps/{charge}/{stem}_sem{unit}")
            sure = doubt[sign] == 0
            table.add(f"sem of /defect_maps/{charge}/{name}", by, errors[sure], sems[sign, here][sure],
                      0.02 * sems[sign, here][sure] + 1e-4)
    for sign, charge in enumerate(("plus", "minus")):
        mapped, core_density, along, across = values[sign, -4:]
        error = sems[sign, -4:]
        inside = max(sums[steady, sign, 1].sum(), 1)
        doubtful = core_doubt[sign] / inside
        scalar(run, table, f"mapped_defects_{charge}", by, mapped, error[0])
        scalar(run, table, f"core_density_{charge}", by, core_density, error[1],
               (doubtful + 1e-6) * core_density, allowed_sem=0.02)
        if sign == 0:
            scalar(run, table, "core_flow_along_mm_s", by, along, error[2], 20 * doubtful + 2e-3, allowed_sem=0.02)
            scalar(run, table, "core_flow_across_mm_s", by, across, error[3], 20 * doubtful + 2e-3, allowed_sem=0.02)


@observable(every="10 ms", duration="50 ms")
def check_density(run, table):
    frames = run.frames("density")
    plan = run.scene["measure"]["density"]
    each = max(1, round(plan["duration"] / plan["every"]))
    n = len(frames) // each
    columns, rows = np.maximum(4, np.ceil(run.box / plan["grid"] - 1e-9).astype(int))
    edges = [np.linspace(0, run.box[1], rows + 1), np.linspace(0, run.box[0], columns + 1)]
    groups = [frames[k * each:(k + 1) * each] for k in range(n)]
    counts = np.array([np.histogram2d(*run.place[some].reshape(-1, 2).T[::-1], edges)[0] for some in groups]) / each
    density = counts / (run.n / (rows * columns))
    start = np.array([run.time[some[0]] for some in groups])
    # Which cell has a rod near an edge is not known: of each map, so many in every cell, as where rods start in rows.
    mesh = run.box / [columns, rows]
    place = run.place / mesh
    near = (np.abs(place - np.round(place)) * mesh < EDGE).any(-1).sum(1)
    doubt = np.array([near[some].sum() for some in groups]) / each / (run.n / (rows * columns)) + 1e-6
    steady = is_steady(start, run.t_steady)
    shape, by = run.scene["rods"], "numpy histogram2d"
    phi = shape["area_fraction"]
    table.add("/density/time_s", "trajectory", run.arrays["/density/time_s"], [run.time[some].mean() for some in groups])
    for k, name in enumerate(("x_mm", "y_mm")):
        at = edges[1 - k]
        table.add(f"/density/{name}", "definition", run.arrays[f"/density/{name}"], (at[1:] + at[:-1]) / 2)
    ours = run.arrays["/density/area_fraction"]
    table.add("/density/area_fraction", by, ours, phi * density.ravel(), phi * np.repeat(doubt, rows * columns),
              f"{np.mean(doubt < 1e-5):.0%} of the maps without rods on edges")
    known = density[steady] if steady.any() else np.full((1, rows, columns), np.nan)
    table.add("/density/mean_area_fraction", by, run.arrays["/density/mean_area_fraction"], phi * known.mean(0).ravel(),
              phi * doubt[steady].mean() if steady.any() else 0)
    delta = (ours.reshape(n, rows, columns) / phi - 1)[steady]  # ours from here on, or edges would matter
    squares = np.mean(delta ** 2, axis=(1, 2))

    def parts(series):
        return np.array([part.mean() for part in np.array_split(series, min(64, len(series)))])

    lags = np.arange(min(512, (len(delta) + 3) // 4))
    correlation, errors = [], []
    for lag in lags:
        products = np.mean(delta[:len(delta) - lag] * delta[lag:], axis=(1, 2))
        correlation.append(products.mean() / squares.mean())
        rest = (products - correlation[-1] * squares[:len(products)]) / squares.mean()
        errors.append(float(sem_of_parts(parts(rest)[:, None])[0]))
    correlation, errors = np.array(correlation), np.array(errors)
    path = "/density/memory/"
    table.add(path + "lag_s", "definition", run.arrays[path + "lag_s"], lags * each * plan["every"])
    table.add(path + "correlation", "numpy", run.arrays[path + "correlation"], correlation, 1e-9)
    table.add(path + "correlation_sem", "numpy", run.arrays[path + "correlation_sem"], errors, 1e-2 * errors + 1e-9)
    scalar(run, table, "density_variance", "numpy", squares.mean(), float(sem_of_parts(parts(squares)[:, None])[0]),
           allowed_sem=1e-2)
    scalar(run, table, "density_variance_of_mean", "numpy", np.mean(delta.mean(0) ** 2))
    time, sem = decay_time(lags[1:] * each * plan["every"], correlation[1:], errors[1:])
    scalar(run, table, "density_correlation_s", "numpy interp", time, sem, 1e-6, allowed_sem=1e-2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("run", metavar="RUN_DIR", nargs="?")
    parser.add_argument("--scene", action="store_true", help="print the scene of such a run")
    parser.add_argument("--all", action="store_true", help="show errors (sem) that agree as well")
    parser.add_argument("--only", metavar="NAME", nargs="+", choices=CHECKS, help="these measurements only")
    parser.add_argument("--observables", metavar="FILE", help="instead of RUN_DIR/observables.h5")
    arguments = parser.parse_args()
    if arguments.scene:
        print(json.dumps(SCENE))
        return 0
    run = Run(arguments.run, arguments.observables or os.path.join(arguments.run, "observables.h5"))
    table = Table()
    check_reading(run, table)
    for name in arguments.only or CHECKS:
        if run.scene["measure"].get(name):
            CHECKS[name](run, table)
    errors = ["sem of " + name for name in run.scalars if np.isfinite(run.sem(name))]
    for name in [*run.arrays, *run.scalars, *errors]:  # nothing may go unchecked
        if not arguments.only and name not in table.compared:
            table.rows.append((name, "", "", "", "", "", False, "nothing to compare with"))
    agrees = table.show(arguments.all)
    return 0 if agrees else 1


if __name__ == "__main__":
    sys.exit(main())
