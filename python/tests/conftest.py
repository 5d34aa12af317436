"""What tests share: made-up runs, and the real programs."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import shaken  # noqa: E402  (the package of this tree, whatever is installed)
from shaken.hdf5 import hash_of  # noqa: E402

#: Where the programs are; tests that need them are skipped where there are none.
PROGRAMS = Path(os.environ.get("SHAKEN_PROGRAMS", Path(__file__).resolve().parents[2] / "build" / "release" / "bin"))

#: Whether all that takes long is tried as well.
NIGHT = bool(os.environ.get("SHAKEN_NIGHT"))
night = pytest.mark.skipif(not NIGHT, reason="./dev test all")


def made_up_run(directory, *, run_id="0123456789abcdef", seed=1, order=0.8, sem=0.01, steady=True, state="done",
                seconds=10.0, arrays=None, frames=0, measured=None, scene=None, version=("0.1.0", 3), aspect=1):
    """A run's directory as the worker leaves it, with what a test gives."""
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    the_scene = {"rods": {"length": 4.5, "area_fraction": 0.7486}, "box": {"side": 20.0, "gap": 1.2},
                 "time": {"seed": seed, "step": 1.6e-5}}
    for path, value in (scene or {}).items():
        block = the_scene
        *blocks, key = path.split(".")
        for name in blocks:
            block = block.setdefault(name, {})
        block[key] = value
    (directory / "scene.json").write_text(json.dumps(the_scene))
    numbers = {"diffusion_mm2_s": {"value": 2.0, "sem": 0.1, "n_effective": 5.0, "steady": None,
                                   "drift": {"value": None, "sem": None}}}
    numbers.update(measured or {})
    summary = {"run_id": run_id, "n_rods": 100, "sim_seconds": seconds, "t_steady_s": 1.0, "steady": steady,
               "order": {"mean": order, "std": 0.05, "sem": sem, "n_effective": 40.0, "steady": steady,
                         "drift": {"value": 0.001, "sem": 0.02}},
               "measured": numbers, "exit": {"state": state, "reason": ""},
               "versions": {"shaken": version[0], "physics": version[1]}, "why_null": {"a": "b"}}
    (directory / "summary.json").write_text(json.dumps(summary))
    with h5py.File(directory / "observables.h5", "w") as file:
        for name, (values, unit) in (arrays or {}).items():
            file[name] = np.asarray(values, dtype=float)
            file[name].attrs["unit"] = unit
    if frames:
        _write_frames(directory / "trajectory.h5", frames, aspect)
    return directory


def _write_frames(path, n_frames, aspect, n_rods=50, side=20.0):
    rng = np.random.default_rng(1)
    theta = rng.uniform(-np.pi, np.pi, (n_frames, n_rods))
    # the shortest turn of the z axis into (cos theta, sin theta, 0) is about (-sin theta, cos theta, 0), by a quarter
    half = np.sqrt(0.5)
    quaternion = np.stack([np.full_like(theta, half), -half * np.sin(theta), half * np.cos(theta),
                           np.zeros_like(theta)], axis=-1)
    with h5py.File(path, "w") as file:
        rods = file.create_group("particles/trajectory")
        rods["position/value"] = (rng.uniform(0, side, (n_frames, n_rods, 3)) * [1, aspect, 1]).astype("f4")
        rods["position/step"] = np.arange(n_frames) * 1000
        rods["position/time"] = np.arange(n_frames) * 0.5
        rods["orientation/value"] = quaternion.astype("f4")
        rods["velocity/value"] = rng.normal(0, 20, (n_frames, n_rods, 3)).astype("f4")
        rods["image/value"] = np.zeros((n_frames, n_rods, 3), dtype="i4")
        file["parameters/bead_offset_mm"] = np.linspace(-2, 2, 5)
        file["parameters/bead_radius_mm"] = np.full(5, 0.25)
        file["parameters"].attrs.update(n_rods=n_rods, box_side_mm=side, box_side_y_mm=side * aspect, gap_mm=1.2,
                                        dt_s=5e-4)
        rods["box/edges/value"] = np.tile(np.diag([side, side * aspect, 1.2]), (n_frames, 1, 1))
    np.save(path.with_suffix(".npy"), theta)


#: The header of a trajectory.part: rods of three beads and of two, which has no middle.
FRAMES = {"n_rods": 2, "box_side_mm": 10.0, "box_side_y_mm": 5.0, "gap_mm": 1.5, "dt_s": 0.0625,
          "species_of_rod": [0, 1], "scene": '{"plates": {"amplitude": 0.25}}', "run_id": "0123456789abcdef", "seed": 7,
          "beads": [{"offset_mm": [-1, 0, 1], "radius_mm": [0.25, 0.5, 0.25]},
                    {"offset_mm": [-0.5, 0.75], "radius_mm": [0.5, 0.25]}]}


def log_at(path, n_frames=21, orientation=((0.5**0.5, 0, 0.5**0.5, 0), (1, 0, 0, 0)), **header):
    """A trajectory.part: of the rods, the first lies along x and the second stands."""
    text = json.dumps({**FRAMES, **header}).encode()
    content = b"SHKNFRAM" + struct.pack("<II", 1, len(text)) + text + struct.pack("<Q", hash_of(text))
    for k in range(n_frames):
        frame = struct.pack("<qd", 4 * k, 0.25 * k)
        for values, kind in (([1, 2, 0.5, 9.5, 0.25, 1], "<f4"), ([1.5, -2, 0, 0, 0, 4], "<f4"), (orientation, "<f4"),
                             ([0, -1, 0, 3, 0, k], "<i4")):
            frame += np.array(values, kind).tobytes()
        content += frame + struct.pack("<Q", hash_of(frame))
    path.write_bytes(content)
    return path


@pytest.fixture
def run_at(tmp_path):
    """Makes runs below a folder of the test: run_at("a", order=0.5) is the Run."""
    return lambda name, **given: shaken.open(made_up_run(tmp_path / name, **given))


class Programs:
    """The real programs on a root of their own."""

    def __init__(self, root):
        self.root = Path(root)
        self._daemon = None

    def shaken(self, *arguments, check=True):
        done = subprocess.run([PROGRAMS / "shaken", "--root", self.root, *map(str, arguments)], capture_output=True,
                              text=True, timeout=120)
        assert done.returncode == 0 or not check, done.stderr
        return done

    def start_daemon(self, *options):
        self._daemon = subprocess.Popen([PROGRAMS / "shakend", "--root", self.root, *map(str, options)],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            try:
                return shaken.Daemon(self.root) if shaken.Daemon(self.root).status() else None
            except shaken.ShakenError:
                assert self._daemon.poll() is None, self._daemon.stderr.read()
                time.sleep(0.05)
        raise AssertionError("the daemon did not answer within a minute")

    def kill(self):
        self._daemon.kill()
        self._daemon.wait(60)

    def stop(self):
        if self._daemon:
            self._daemon.terminate()
            self._daemon.wait(60)
            self._daemon.stderr.close()


@pytest.fixture
def programs():
    if not (PROGRAMS / "shakend").exists():
        pytest.skip(f"no programs in {PROGRAMS}: build them, or set SHAKEN_PROGRAMS")
    root = tempfile.mkdtemp(prefix="shaken")  # a short path: a socket's has 107 bytes at most
    used = Programs(root)
    yield used
    used.stop()
    shutil.rmtree(root, ignore_errors=True)
