import copy
import json
import pickle
import subprocess
import sys
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest

import shaken
from conftest import log_at, made_up_run
from shaken import archive, hdf5, units
from shaken.plots import runs
from shaken.run import error_name
from shaken.units import split_species, unit_of

CURVES = {"msd/lag_s": ([1, 2, 4], "s"), "msd/total_mm2": ([4, 8, 16], "mm2"), "msd/total_sem_mm2": ([1, 1, 2], "mm2"),
          "g2/r_mm": ([1, 2], "mm"), "g2/g2": ([1, 0], "1"), "g2/g2_sem": ([0.1, 0.2], "1"),
          "pairs/across_mm": ([-1, 0, 1], "mm"), "pairs/along_mm": ([-2, 0, 2], "mm"), "pairs/g": (range(9), "1")}


@pytest.mark.parametrize("name, unit", [("diffusion_mm2_s", "mm2 s-1"), ("/layers/q_per_mm", "mm-1"), ("dip", "1"),
                                        ("defect_creation_rate_per_mm2_s", "mm-2 s-1"), ("tau_s", "s"),
                                        ("rotational_diffusion_rad2_s", "rad2 s-1"), ("theta_m_deg", "deg"),
                                        ("/angles/density_per_rad", "rad-1"), ("psi_6", "1"),
                                        ("slowness_s_per_mm", "s mm-1"), ("frank_floor_mm2", "mm2")])
def test_units_are_read_off_names(name, unit):
    assert unit_of(name) == unit


@pytest.mark.parametrize("name, error", [("/msd/total_mm2", "/msd/total_sem_mm2"), ("/g2/g", "/g2/g_sem"),
                                         ("/msd/d_along_mm2_s", "/msd/d_along_sem_mm2_s"),
                                         ("/structure/factor", "/structure/factor_sem")])
def test_errors_of_arrays_have_names_of_their_own(name, error):
    assert error_name(name) == error


def test_numbers_carry_error_unit_and_steadiness(run_at):
    run = run_at("a", order=0.8, sem=0.01, steady=False)
    assert (run["S"].value, run["S"].error, run["S"].steady, run["S"].n_eff) == (0.8, 0.01, False, 40.0)
    assert run["diffusion_mm2_s"].unit == "mm2 s-1"
    assert run["diffusion_mm2_s"].steady is False, "it does not know, and its run is not"
    assert run_at("b", steady=None)["diffusion_mm2_s"].steady is None
    own = {"value": 1.0, "steady": True}
    assert run_at("c", steady=False, measured={"layer_order": own})["layer_order"].steady is True
    assert "S" in run and "theta_m_deg" not in run
    with pytest.raises(KeyError, match="diffusion_mm2_s"):
        run["difusion"]


def test_arrays_know_axis_error_and_unit(run_at):
    run = run_at("a", arrays=CURVES)
    msd = run["/msd/total_mm2"]
    assert repr(run.arrays).startswith("<9 arrays: /g2/g2, ")
    assert msd.unit == "mm2" and list(msd.axis) == [1, 2, 4] and msd.axis.unit == "s" and list(msd.error) == [1, 1, 2]
    assert list(run["g2/g2"].error) == [0.1, 0.2]
    g = run["/pairs/g"]
    assert g.shape == (3, 3) and g[1, 2] == 5 and list(g.axis[1]) == [-2, 0, 2]
    with pytest.raises(KeyError, match="was not measured"):
        run["/msd/along_mm2"]


def test_parts_and_copies_of_arrays_know_what_they_are(run_at):
    msd = run_at("a", arrays=CURVES)["/msd/total_mm2"]
    for made, x, error in ((msd[1:], [2, 4], [1, 2]), (msd[::-1], [4, 2, 1], [2, 1, 1]), (msd[msd > 4], [2, 4], [1, 2]),
                           (msd.copy(), [1, 2, 4], [1, 1, 2]), (copy.deepcopy(msd), [1, 2, 4], [1, 1, 2]),
                           (pickle.loads(pickle.dumps(msd)), [1, 2, 4], [1, 1, 2])):
        assert (made.name, made.unit) == ("/msd/total_mm2", "mm2") and list(made.error) == error
        assert list(made.axis) == x and made.axis.unit == "s"
    assert msd.reshape(3, 1).unit == "mm2" and msd.reshape(3, 1).axis is None
    for made in (msd * 2, msd / msd.axis, np.sqrt(msd), msd.cumsum(), np.diff(msd)):
        assert (made.name, made.unit, made.axis, made.error) == ("", None, None, None)
    for reduced in (msd.mean(), msd.sum(), np.max(msd), np.median(msd), msd[0]):
        assert type(reduced) is np.float64
    msd.sort()
    assert msd.axis is None, "in another order"
    assert shaken.Array([1, 2]).unit is None and shaken.Array([1, 2], "/g2/g2").unit == "1"


def test_texts_of_quantities_are_numbers_in_default_units():
    assert units.seconds("1.5 min") == 90 and units.number_of("20ms") == pytest.approx(0.02)
    assert units.number_of("high") == "high" and units.number_of("3 apples") == "3 apples"
    for text in ("x", "3 mm", "", "1.2.3 s"):
        with pytest.raises(shaken.ShakenError, match="is no time"):
            units.seconds(text)


@pytest.mark.parametrize("name, parts", [("/rods_2/msd/lag_s", ("rods_2", "/msd/lag_s")),
                                         ("rods_2.S", ("rods_2", "S")),
                                         ("rods_3.diffusion_mm2_s", ("rods_3", "diffusion_mm2_s")),
                                         ("/msd/lag_s", ("", "/msd/lag_s")), ("/rods/trace/x_mm",
                                                                              ("", "/rods/trace/x_mm")),
                                         ("S", ("", "S")), ("rods.length", ("", "rods.length"))])
def test_names_are_split_by_their_species(name, parts):
    assert split_species(name) == parts


def test_arrays_of_another_species_have_their_own_axis(run_at):
    slower = {"rods_2/" + name: (np.multiply(values, 10), unit) for name, (values, unit) in CURVES.items()}
    polar = {"rods_2/polar/time_s": ([0, 1], "s"), "rods_2/polar/order": ([0.5, 0.7], "1")}
    run = run_at("a", arrays={**CURVES, **slower, **polar})
    msd = run["/rods_2/msd/total_mm2"]
    assert msd.axis.name == "/rods_2/msd/lag_s" and list(msd.axis) == [10, 20, 40] and list(msd.error) == [10, 10, 20]
    assert msd.unit == "mm2" and list(run["/msd/total_mm2"].axis) == [1, 2, 4]
    assert list(run["/rods_2/pairs/g"].axis[1]) == [-20, 0, 20]
    assert run["/rods_2/polar/order"].axis.name == "/rods_2/polar/time_s"


def test_arrays_of_two_dimensions_have_two_axes(run_at):
    measured = {"scattering/q_per_mm": ([1, 2], "mm-1"), "scattering/lag_s": ([1, 2, 4], "s"),
                "scattering/f": ([6, 5, 4, 3, 2, 1], "1"), "scattering/f_sem": ([1, 2, 3, 4, 5, 6], "1"),
                "scattering/alpha_2": ([1, 2, 3], "1"),
                "van_hove/lag_s": ([1, 4], "s"), "van_hove/displacement_mm": ([1, 3, 2, 6], "mm"),
                "van_hove/along_per_mm": ([4, 3, 2, 1], "mm-1"), "van_hove/along_sem_per_mm": ([1, 1, 2, 2], "mm-1")}
    measured["defect_maps/along_mm"] = measured["defect_maps/across_mm"] = ([-1, 0, 1], "mm")
    measured["defect_maps/plus/v_along_mm_s"] = measured["defect_maps/plus/v_along_sem_mm_s"] = (range(9), "mm s-1")
    measured["density/time_s"] = measured["density/x_mm"] = ([1, 2, 3], "mm")
    measured["density/y_mm"] = ([5, 6], "mm")
    measured["density/area_fraction"] = (range(18), "1")
    run = run_at("a", arrays={**measured, **{"rods_2/" + name: of for name, of in measured.items()}})
    for species in ("", "/rods_2"):
        f_s = run[species + "/scattering/f"]
        assert f_s.tolist() == [[6, 5, 4], [3, 2, 1]] and f_s.error.tolist() == [[1, 2, 3], [4, 5, 6]]
        assert f_s.axis[0].name == species + "/scattering/q_per_mm" and f_s.axis[1].tolist() == [1, 2, 4]
        assert list(run[species + "/scattering/alpha_2"].axis) == [1, 2, 4]
        g_s = run[species + "/van_hove/along_per_mm"]
        assert g_s.tolist() == [[4, 3], [2, 1]] and g_s.error.tolist() == [[1, 1], [2, 2]]
        assert g_s.axis[0].tolist() == [1, 4] and g_s.axis[1].tolist() == [[1, 3], [2, 6]]
        maps = run[species + "/density/area_fraction"]
        assert maps.shape == (3, 2, 3) and maps[1, 1, 0] == 9 and maps.axis[1].tolist() == [5, 6]
        v = run[species + "/defect_maps/plus/v_along_mm_s"]
        assert v.shape == v.error.shape == (3, 3) and v.axis[1].name == species + "/defect_maps/along_mm"


def test_keys_are_those_asked_for(tmp_path):
    run = shaken.DirectoryRun(made_up_run(tmp_path / "a"), {"rods.area_fraction": 0.75})
    assert run.key("rods.area_fraction") == 0.75 and run.key("rods.length") == 4.5 and run.key("rods_2.length") is None


def test_frames_come_lazily_and_at_multiples(run_at, tmp_path):
    run = run_at("a", frames=9)
    theta = np.load(tmp_path / "a" / "trajectory.npy")
    frames = list(run.frames())
    assert len(frames) == 9 and frames[2].positions.shape == (50, 3)
    assert np.allclose(frames[3].theta, theta[3], atol=1e-6) and np.allclose(frames[3].directors[:, 2], 0, atol=1e-6)
    assert frames[3].order == pytest.approx(abs(np.exp(2j * theta[3]).mean()), abs=1e-6)
    assert [frame.time for frame in run.frames(every="1 s")] == [0, 1, 2, 3, 4]
    assert [frame.time for frame in run.frames(every=0.75)] == [0, 1, 1.5, 2.5, 3, 4]
    for every in (0, -1, float("nan")):
        with pytest.raises(shaken.ShakenError, match="must be above 0"):
            next(run.frames(every=every))
    assert repr(run.trajectory) == "<trajectory: 9 frames of 50 rods, 0 to 4 s>"
    assert repr(frames[1]).startswith("<frame at 0.5 s: 50 rods, S = 0.") and len(repr(frames[1])) < 50
    box, points, orientations = frames[0].to_freud()
    assert points.dtype == np.float32 and points[:, 2].max() == 0 and abs(points[:, :2]).max() <= 10
    turned = 2 * np.arctan2(orientations[:, 3], orientations[:, 0])
    assert np.allclose(np.exp(2j * turned), np.exp(2j * theta[0]), atol=1e-5)


def test_spheres_have_no_order_and_walls_no_images(programs):
    scene = {"rods": {"beads": 1, "mid_diameter": "0.8 mm", "area_fraction": 0.3}, "box": {"side": "14 mm"},
             "accuracy": "draft", "time": {"steady": 0, "measure": "10 ms"}, "trajectory": {"every": "10 ms"}}
    walls = {"channel": {"arena": "channel", "size": "12 mm"}, "disc": {"arena": "disc", "size": "12 mm"}}
    for arena, periodic in (("none", (True, True)), ("channel", (True, False)), ("disc", (False, False))):
        made = {**scene, **({"walls": walls[arena], "box": {"side": "14 mm"} if arena == "channel" else {}}
                            if arena in walls else {})}
        (programs.root / "scene.json").write_text(json.dumps(made))
        programs.shaken("run", programs.root / "scene.json", "--out", programs.root / arena)
        trajectory = shaken.open(programs.root / arena).trajectory
        frame = trajectory[0]
        assert np.isnan(frame.order) and np.isnan(frame.director_angle) and frame.spheres == (0,)
        assert frame.periodic == periodic and np.allclose(trajectory.lengths, 0.8)
        with h5py.File(trajectory.path, "r") as file:
            words = [word if isinstance(word, str) else word.decode()
                     for word in file["particles/trajectory/box"].attrs["boundary"]]
        assert words == ["periodic" if each else "none" for each in (*periodic, False)]


def test_mdanalysis_reads_the_frames_of_a_real_run(programs):
    pytest.importorskip("MDAnalysis")
    scene = {"box": {"side": "14 mm"}, "accuracy": "draft", "time": {"steady": 0, "measure": "0.2 s"},
             "measure": {"order": {}}, "trajectory": {"every": "50 ms"}}
    (programs.root / "scene.json").write_text(json.dumps(scene))
    programs.shaken("run", programs.root / "scene.json", "--out", programs.root / "run")
    run = shaken.open(programs.root / "run")
    universe = run.trajectory.to_mdanalysis()
    assert len(universe.trajectory) == len(run.trajectory) >= 4
    assert universe.trajectory.dt * 1e-12 == pytest.approx(run.trajectory.times[1] - run.trajectory.times[0])
    for theirs, ours in zip(universe.trajectory, run.frames()):
        assert np.allclose(universe.atoms.positions * 1e-7, ours.positions, rtol=1e-5, atol=1e-5)
        assert np.allclose(universe.atoms.velocities * 1e5, ours.velocities, rtol=1e-4, atol=1e-3)
        assert theirs.time * 1e-12 == pytest.approx(ours.time)


def test_rods_of_one_species_have_lengths_of_their_own(programs):
    scene = {"rods": {"length": "3 mm", "length_spread": 0.1, "count": 90, "start": "random"}, "box": {"side": "40 mm"},
             "rods_2": {"beads": 1, "mid_diameter": "0.9 mm", "count": 20}, "accuracy": "draft",
             "time": {"steady": 0, "measure": "10 ms"}, "trajectory": {"every": "10 ms"}}
    for spread, run in ((0.1, "run"), (0, "alike")):
        scene["rods"]["length_spread"] = spread
        (programs.root / "scene.json").write_text(json.dumps(scene))
        programs.shaken("run", programs.root / "scene.json", "--out", programs.root / run)
        trajectory = shaken.open(programs.root / run).trajectory
        rods = trajectory.lengths[trajectory.species == 0]
        assert len(rods) == 90 and rods.mean() == pytest.approx(3) and rods.std() == pytest.approx(3 * spread)
        assert np.allclose(trajectory.lengths[trajectory.species == 1], 0.9)


def test_frames_of_a_run_at_work_are_those_so_far(tmp_path):
    (tmp_path / "scene.json").write_text("{}")
    log = log_at(tmp_path / "trajectory.part")
    with log.open("ab") as file:
        file.write(b"half a frame" * 4)
    run = shaken.open(tmp_path)
    assert [frame.tick for frame in run.frames(every=2)] == [0, 32, 64] and len(run.trajectory) == 21
    frame = run.trajectory[-1]
    assert frame.time == 5 and np.allclose(frame.directors, [[1, 0, 0], [0, 0, 1]]) and list(frame.species) == [0, 1]
    assert np.allclose(frame.box, [10, 5, 1.5]) and np.allclose(run.trajectory.lengths, [2.5, 2])
    with pytest.raises(shaken.ShakenError, match="has no 'S' yet: the run has not ended"):
        print(run["S"])
    with pytest.raises(shaken.ShakenError, match="has not ended"):
        shaken.DirectoryRun(tmp_path)
    log.write_bytes(log.read_bytes()[:-48 - 8 - 104] + b"\0" * 112)
    assert len(shaken.open(tmp_path).trajectory) == 20, "the last one is not whole"
    log.write_bytes(log.read_bytes().replace(b"0.25", b"0.26", 1))
    with pytest.raises(shaken.ShakenError, match="header is not whole"):
        next(shaken.open(tmp_path).frames())


def test_what_is_no_run_is_said_to_be_none(tmp_path, run_at):
    with pytest.raises(shaken.ShakenError, match="neither a directory"):
        shaken.open("nothing-here", root=tmp_path)
    (tmp_path / "empty").mkdir()
    with pytest.raises(shaken.ShakenError, match="no directory of a run"):
        shaken.open(tmp_path / "empty")
    (made_up_run(tmp_path / "early") / "summary.json").unlink()
    with pytest.raises(shaken.ShakenError, match="has not ended yet"):
        shaken.open(tmp_path / "early")
    for state, why, said in (("failed", "rods overlap", "has failed: rods overlap"),
                             ("stopped", "asked to stop", "was stopped before its end"),
                             ("running", "", "has not ended yet")):
        (tmp_path / "early/progress.json").write_text(json.dumps({"state": state, "message": why}))
        with pytest.raises(shaken.ShakenError, match=said):
            shaken.open(tmp_path / "early")
    (tmp_path / "early/imported.json").write_text("{}")
    with pytest.raises(shaken.ShakenError, match="imported rods, which have not been simulated"):
        shaken.open(tmp_path / "early")
    with pytest.raises(shaken.ShakenError, match="does not record|records frames"):
        next(run_at("a").frames())


def with_hashes(directory):
    """Puts into summary.json what the worker says of its files."""
    summary = json.loads((directory / "summary.json").read_text())
    summary["files"] = {}
    for path in directory.glob("*.h5"):
        summary["files"][path.name] = {"bytes": path.stat().st_size, "xxh3": hdf5._xxh3(path, 0)}
    (directory / "summary.json").write_text(json.dumps(summary))


def flip(path, at):
    data = bytearray(path.read_bytes())
    data[at] ^= 1
    path.write_bytes(data)


def test_damaged_files_are_refused_before_they_are_read(tmp_path):
    folder = made_up_run(tmp_path / "a", arrays=CURVES, frames=2)
    with_hashes(folder)
    run = shaken.open(folder)
    assert run["/msd/total_mm2"].sum() == 28 and len(run.trajectory) == 2
    for name, read in (("observables.h5", lambda: shaken.open(folder)), ("trajectory.h5", lambda: run_of().trajectory)):
        run_of = lambda: shaken.open(folder)  # noqa: E731
        flip(folder / name, -1)
        with pytest.raises(shaken.ShakenError, match=f"{name} is damaged.*Put a copy of it back"):
            read()
        with pytest.raises(shaken.ShakenError, match="is damaged"):
            archive.add_run(folder, tmp_path / "archive")
        (folder / "progress.json").write_text('{"state": "running"}')
        assert read(), "a worker that makes it longer writes the summary last"
        (folder / "progress.json").unlink()
        flip(folder / name, -1)
        assert read()
    with pytest.raises(runs.Unreadable, match="observables.h5 is damaged"):
        flip(folder / "observables.h5", -1)
        runs.read_run(folder, {})
    for broken in ("[1]", "[" * 100_000, '{"order": [1]}', '{"measured": {"a": 7}}'):
        (folder / "summary.json").write_text(broken)
        with pytest.raises(shaken.ShakenError):
            shaken.open(folder)


def test_the_hash_is_that_of_the_worker(programs):
    scene = {"box": {"side": "14 mm"}, "accuracy": "draft", "time": {"steady": 0, "measure": "20 ms"},
             "measure": {"order": {}}, "trajectory": {"every": "10 ms"}}
    (programs.root / "scene.json").write_text(json.dumps(scene))
    programs.shaken("run", programs.root / "scene.json", "--out", programs.root / "run")
    assert shaken.open(programs.root / "run").trajectory, "what it has written is whole"
    with h5py.File(programs.root / "run/observables.h5", "a") as file:
        file["order/order"][0] = 0.5
    with pytest.raises(shaken.ShakenError, match="observables.h5 is damaged"):
        shaken.open(programs.root / "run")
    drawn = programs.shaken("plot", programs.root / "run", "-o", programs.root / "plots", check=False)
    assert drawn.returncode == 1 and "observables.h5 is damaged" in drawn.stdout + drawn.stderr


def test_a_prefix_of_an_id_is_enough(tmp_path):
    made_up_run(tmp_path / "runs" / "0123456789abcdef")
    assert shaken.open("0123", root=tmp_path).id == "0123456789abcdef"
    made_up_run(tmp_path / "runs" / "0123999999abcdef")
    with pytest.raises(shaken.ShakenError, match="fits 2 runs"):
        shaken.open("0123", root=tmp_path)


def test_the_wheel_has_all_that_the_package_reads(tmp_path):
    source = Path(__file__).resolve().parents[1]
    make = "import build_backend; print(build_backend.build_wheel('.'))"
    env = {"PYTHONPATH": str(source), "PYTHONDONTWRITEBYTECODE": "1"}
    wheel = subprocess.run([sys.executable, "-c", make], cwd=tmp_path, env=env, stdout=subprocess.PIPE, text=True,
                           check=True)
    use = "from shaken.plots import names; print(names.axis_title('rods.length'))"
    with zipfile.ZipFile(tmp_path / wheel.stdout.strip()) as archive_of_it:
        archive_of_it.extractall(tmp_path / "site")
    env = {"PYTHONPATH": str(tmp_path / "site"), "PYTHONIOENCODING": "utf-8"}
    used = subprocess.run([sys.executable, "-c", use], cwd=tmp_path, env=env, capture_output=True, text=True)
    assert used.returncode == 0, used.stderr
