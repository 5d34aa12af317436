#!/usr/bin/env python3
"""Holds exported files against the run that they are of: export_reader.py RUN FILE... [--frames FIRST:STEP].

trajectory.h5 and observables.h5 are read by h5py, GSD by the package gsd of HOOMD-blue's authors, and text here, by what
the formats say. With --ase or --mdanalysis these programs read the text. Prints one line for each file; exits 1 if
anything differs."""
import argparse
import csv
import json
import shlex
import sys

import h5py
import numpy as np

CLOSE = {"rtol": 0, "atol": 5e-6}  # mm: float32 of some 30 mm, shifted and turned


class Run:
    """The recorded frames FIRST, FIRST + STEP ..."""

    def __init__(self, folder, frames):
        self.folder = folder
        with h5py.File(folder + "/trajectory.h5") as file:
            rods = file["particles/trajectory"]
            self.step = rods["position/step"][:][frames]
            self.time = rods["position/time"][:][frames]
            self.position = rods["position/value"][:][frames]
            self.velocity = rods["velocity/value"][:][frames]
            self.image = rods["image/value"][:][frames]
            self.quaternion = rods["orientation/value"][:][frames]  # (w, x, y, z)
            parameters = file["parameters"]
            self.side = parameters.attrs["box_side_mm"]
            self.beads = [(parameters["bead_offset_mm"][:], parameters["bead_radius_mm"][:])]
            for name in ("species_2", "species_3"):
                if name in parameters:
                    self.beads.append((parameters[name]["bead_offset_mm"][:], parameters[name]["bead_radius_mm"][:]))
            n_rods = self.position.shape[1]
            self.kind = rods["species"][:] if "species" in rods else np.zeros(n_rods, int)
            scene = json.loads(parameters["scene_json"][()])
            self.height = parameters.attrs["gap_mm"] + 2 * scene["plates"]["amplitude"]
            self.walls = "walls" in parameters
        w, x, y, z = np.moveaxis(self.quaternion.astype(float), -1, 0)
        self.director = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), w**2 - x**2 - y**2 + z**2], axis=-1)

    def bead_table(self, frame):
        """Name, place, radius and rod of every bead."""
        for rod, kind in enumerate(self.kind):
            for k, (offset, radius) in enumerate(zip(*self.beads[kind]), 1):
                place = self.position[frame, rod] + offset * self.director[frame, rod]
                yield "ABC"[kind] + str(k), place, radius, rod


def same(what, found, expected):
    assert np.array_equal(found, expected), f"{what} differs"


def close(what, found, expected):
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape, f"{what}: {found.shape} instead of {expected.shape}"
    assert np.allclose(found, expected, **CLOSE), f"{what} differs by {np.abs(found - expected).max()}"


def check_theta(run, f, found):
    """Angles in the plane to the director of the first species, whose sines are compared: -90 and 90 degrees are one."""
    z = run.director[f] @ [1, 1j, 0]
    director = np.sqrt(((z / np.abs(z)) ** 2)[run.kind == 0].mean())
    expected = z / np.abs(z) * (director / abs(director)).conjugate()
    assert (np.abs(found) <= np.pi / 2).all()
    assert np.abs(np.sin(found) * np.cos(found) - expected.real * expected.imag).max() < 1e-5, "theta differs"
    assert np.abs(np.cos(found) ** 2 - expected.real ** 2).max() < 1e-5, "theta differs"


def check_gsd(run, path):
    import gsd.hoomd
    with gsd.hoomd.open(path, "rb") as frames:
        assert len(frames) == len(run.step), f"{len(frames)} frames instead of {len(run.step)}"
        half = np.array([run.side, run.side, run.height]) / 2
        for f, frame in enumerate(frames):
            rods = frame.particles
            same("step", frame.configuration.step, run.step[f])
            close("box", frame.configuration.box, [*(2 * half), 0, 0, 0])
            same("time", frame.log["time_s"], [run.time[f]])
            same("N", rods.N, len(run.kind))
            same("types", rods.types, list("ABC")[:len(run.beads)])
            same("typeid", rods.typeid, run.kind)
            close("position", rods.position + half, run.position[f])
            inside = np.abs(rods.position) <= half.astype(np.float32)
            assert inside.all(), f"rods {np.argwhere(~inside)} are outside of the box"
            same("orientation", rods.orientation, run.quaternion[f])
            same("velocity", rods.velocity, run.velocity[f])
            same("image", rods.image, run.image[f])
            check_theta(run, f, frame.log["particles/theta"])
            assert len(rods.type_shapes) == len(run.beads)
            for shape, (offset, radius) in zip(rods.type_shapes, run.beads):
                assert shape["type"] == "SphereUnion"
                same("centers", shape["centers"], [[0, 0, z] for z in offset])
                same("diameters", shape["diameters"], 2 * radius)


def xyz_frames(path):
    """The comment's values and the columns by name, for each frame."""
    with open(path) as file:
        while line := file.readline():
            n_rows = int(line)
            info = dict(pair.split("=", 1) for pair in shlex.split(file.readline()))
            rows = [file.readline().split() for _ in range(n_rows)]
            columns, first = {}, 0
            fields = info["Properties"].split(":")
            for name, kind, width in zip(fields[::3], fields[1::3], map(int, fields[2::3])):
                values = np.array([row[first:first + width] for row in rows])
                columns[name] = values if kind == "S" else values.astype(np.float32 if kind == "R" else int)
                first += width
            assert all(len(row) == first for row in rows), "rows of another length than Properties says"
            yield info, columns


def check_comment(run, f, info):
    close("Lattice", np.array(info["Lattice"].split(), float).reshape(3, 3),
          np.diag([run.side, run.side, run.height]))
    same("pbc", info["pbc"], "F F F" if run.walls else "T T F")
    same("Time", float(info["Time"]), run.time[f])
    same("Step", int(info["Step"]), run.step[f])


def check_extxyz(run, path):
    n_frames = 0
    for f, (info, rods) in enumerate(xyz_frames(path)):
        check_comment(run, f, info)
        same("type", rods["type"][:, 0], run.kind + 1)
        same("id", rods["id"][:, 0], np.arange(len(run.kind)))
        same("pos", rods["pos"], run.position[f])
        same("orientation", np.roll(rods["orientation"], 1, axis=1), run.quaternion[f])
        same("velo", rods["velo"], run.velocity[f])
        same("map_shift", rods["map_shift"], run.image[f])
        close("director", rods["director"], run.director[f])
        check_theta(run, f, rods["theta"][:, 0])
        for rod, kind in enumerate(run.kind):
            offset, radius = run.beads[kind]
            close("aspherical_shape", rods["aspherical_shape"][rod],
                  [radius.max(), radius.max(), (np.abs(offset) + radius).max()])
        n_frames += 1
    assert n_frames == len(run.step), f"{n_frames} frames instead of {len(run.step)}"


def check_xyz(run, path):
    n_frames = 0
    for f, (info, beads) in enumerate(xyz_frames(path)):
        check_comment(run, f, info)
        names, places, radii, rods = map(list, zip(*run.bead_table(f)))
        same("species", beads["species"][:, 0], names)
        close("pos", beads["pos"], places)
        same("radius", beads["radius"][:, 0], np.float32(radii))
        same("molecule", beads["molecule"][:, 0], rods)
        n_frames += 1
    assert n_frames == len(run.step), f"{n_frames} frames instead of {len(run.step)}"


def check_csv(run, path):
    """A file NAME-GROUP.csv, of one group."""
    group = path.rsplit("-", 1)[1][:-len(".csv")]
    with open(path, newline="") as file, h5py.File(run.folder + "/observables.h5") as arrays:
        heads, *rows = csv.reader(file)
        names = [name for name, array in arrays[group].items() if isinstance(array, h5py.Dataset)]
        assert sorted(heads) == sorted(names), f"{heads} instead of {names}"
        for head, column in zip(heads, zip(*rows)):
            found = np.array([float(value or "nan") for value in column])
            assert np.array_equal(found, arrays[group][head][:], equal_nan=True), head


def check_extxyz_by_ase(run, path):
    import ase.io
    frames = ase.io.read(path, index=":", format="extxyz")
    assert len(frames) == len(run.step), f"{len(frames)} frames instead of {len(run.step)}"
    for f, frame in enumerate(frames):
        close("cell", frame.cell[:], np.diag([run.side, run.side, run.height]))
        same("pbc", frame.pbc, [not run.walls, not run.walls, False])
        same("Time", frame.info["Time"], run.time[f])
        same("Step", frame.info["Step"], run.step[f])
        close("positions", frame.positions, run.position[f])
        close("orientation", np.roll(frame.arrays["orientation"], 1, axis=1), run.quaternion[f])
        close("velo", frame.arrays["velo"], run.velocity[f])
        same("map_shift", frame.arrays["map_shift"], run.image[f])
        same("type", frame.arrays["type"], run.kind + 1)


def check_xyz_by_mdanalysis(run, path):
    import MDAnalysis
    universe = MDAnalysis.Universe(path, format="XYZ", topology_format="XYZ")
    assert len(universe.trajectory) == len(run.step)
    for f, _ in enumerate(universe.trajectory):
        names, places, _, _ = map(list, zip(*run.bead_table(f)))
        same("names", universe.atoms.names, names)
        close("positions", universe.atoms.positions, places)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("run")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--frames", default="0:1", metavar="FIRST:STEP")
    parser.add_argument("--ase", action="store_true")
    parser.add_argument("--mdanalysis", action="store_true")
    options = parser.parse_args()
    first, step = map(int, options.frames.split(":"))
    run = Run(options.run, slice(first, None, step))
    checks = {"gsd": [check_gsd], "extxyz": [check_extxyz], "xyz": [check_xyz], "csv": [check_csv]}
    if options.ase:
        checks["extxyz"].append(check_extxyz_by_ase)
    if options.mdanalysis:
        checks["xyz"].append(check_xyz_by_mdanalysis)
    failed = False
    for path in options.files:
        for check in checks[path.rsplit(".", 1)[1]]:
            try:
                check(run, path)
                print(f"{path}: {check.__name__}: as in the run, {len(run.step)} frames")
            except AssertionError as error:
                print(f"{path}: {check.__name__}: {error}")
                failed = True
    return failed


if __name__ == "__main__":
    sys.exit(main())
