"""What is measured of recorded frames and of tracks, as the programs leave it and the package reads it."""
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import shaken
from conftest import PROGRAMS

ROOT = PROGRAMS.parents[2]
SCENE = {"rods": {"length": 4.5, "area_fraction": 0.65}, "box": {"side": 20}, "time": {"steady": 0.1, "measure": 0.3},
         "measure": {"order": {"every": "10 ms"}, "msd": {"every": "10 ms"}, "g2": {"every": "20 ms"}},
         "trajectory": {"every": "10 ms"}}


def said(*command, code=0):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "PYTHONPATH": str(ROOT / "python")})
    assert done.returncode == code, done.stderr + done.stdout
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    if not (PROGRAMS / "shaken-worker").exists():
        pytest.skip(f"no programs in {PROGRAMS}")
    folder = tmp_path_factory.mktemp("measured")
    (folder / "lab.json").write_text(json.dumps(SCENE))
    said(PROGRAMS / "shaken-worker", folder / "lab.json", "--out", folder / "sim", "--no-lcm", "--quiet")
    return folder


def measure(folder, *words, code=0):
    return said(PROGRAMS / "shaken", "measure", *words, "-o", folder / "out", "--json", code=code)


def test_frames_give_what_the_run_gives(folder):
    answer = json.loads(measure(folder, folder / "sim"))
    assert answer["n_frames"] == 41 and answer["remarks"] == []
    run, again = shaken.open(folder / "sim"), shaken.open(answer["directory"])
    assert again.numbers["S"].value == pytest.approx(run.numbers["S"].value, abs=1e-7)
    for name, array in run.arrays.items():
        np.testing.assert_allclose(again.arrays[name], array, rtol=1e-3, atol=1e-5, err_msg=name)
    assert again.summary["frames"]["n"] == 41 and again.summary["collisions"] is None
    assert again.summary["why_null"]["collisions"] == "measured on recorded frames, not simulated"
    assert again.summary["versions"]["physics"] is None and "versions.physics" in again.summary["why_null"]
    assert len(list(again.frames())) == 41, "they can be drawn"
    assert "finer" not in measure(folder, folder / "sim", "-s", "measure.g2.bins=100"), "the folder may be filled anew"


def test_tracks_with_noise_and_holes_give_the_run_s_numbers_within_the_bias(folder):
    # as docs/experiment.md has it: S falls by exp(-2 turn^2), the MSD rises by 4 shift^2
    shift, turn = 0.02, math.radians(1)
    said(sys.executable, ROOT / "docs/tracks_of_a_run.py", folder / "sim", folder / "tracks.csv", 0.05, shift, 1)
    words = [folder / "tracks.csv", "--scene", folder / "lab.json", "--scale", 0.05, "--interval", "10ms", "--flip-y"]
    run = shaken.open(folder / "sim")
    holes = json.loads(measure(folder, *words))
    seen = shaken.open(holes["directory"])
    assert any("lags are of the rods that are in both frames" in remark for remark in holes["remarks"])
    lag = run.arrays["/msd/lag_s"] > 0.05
    np.testing.assert_allclose(seen.arrays["/msd/total_mm2"][lag], run.arrays["/msd/total_mm2"][lag] + 4 * shift**2,
                               rtol=0.1)
    assert seen.numbers["S"].value == pytest.approx(run.numbers["S"].value * math.exp(-2 * turn**2), abs=0.003)
    np.testing.assert_allclose(seen.arrays["/g2/g2"], run.arrays["/g2/g2"], atol=0.05)

    whole = json.loads(measure(folder, *words, "--fill", 4, "--complete"))
    assert any("tracks are in every frame: the others are left out" in remark for remark in whole["remarks"])
    followed = shaken.open(whole["directory"])
    np.testing.assert_allclose(followed.arrays["/msd/total_mm2"][lag], run.arrays["/msd/total_mm2"][lag] + 4 * shift**2,
                               rtol=0.15)


def test_rods_that_are_missed_are_drawn_exported_and_measured_in_the_frames_that_have_them(folder):
    said(sys.executable, ROOT / "docs/tracks_of_a_run.py", folder / "sim", folder / "few.csv", 0.1, 0, 0)
    holes = json.loads(measure(folder, folder / "few.csv", "--scene", folder / "lab.json", "--scale", 0.05,
                               "--interval", "10ms", "--flip-y"))
    seen = shaken.open(holes["directory"])
    frames = list(seen.frames())
    there = np.array([frame.is_seen for frame in frames])
    assert there.shape == (41, len(next(iter(shaken.open(folder / "sim").frames())).positions))
    assert 0.85 < there.mean() < 0.95 and there.any(axis=0).all()
    np.testing.assert_allclose([frame.order for frame in frames], seen.arrays["/order/order"], atol=1e-6)
    of_arrays = shaken.measure(frames, scene=seen.scene)
    for name in ("/msd/total_mm2", "/g2/g2", "/order/order"):
        np.testing.assert_allclose(of_arrays.arrays[name], seen.arrays[name], rtol=1e-5, atol=1e-7, err_msg=name)

    for form in ("extxyz", "xyz"):
        said(PROGRAMS / "shaken", "export", holes["directory"], "-o", folder / f"few.{form}", "--last")
        lines = (folder / f"few.{form}").read_text().splitlines()
        n_each = 1 if form == "extxyz" else 15
        assert int(lines[0]) == there[-1].sum() * n_each == len(lines) - 2
        assert not any("nan" in line.split()[1:4] for line in lines[2:])
    of_degrees = json.loads(measure(folder, folder / "few.csv", "--scene", folder / "lab.json", "--scale", 0.05,
                                    "--interval", "10ms", "--flip-y", "--radians"))
    assert of_degrees["run_id"] != holes["run_id"] and any("give --degrees" in one for one in of_degrees["remarks"])
    holes = json.loads(measure(folder, folder / "few.csv", "--scene", folder / "lab.json", "--scale", 0.05,
                               "--interval", "10ms", "--flip-y"))
    assert frames[-1]._repr_png_().startswith(b"\x89PNG")
    said(PROGRAMS / "shaken", "movie", holes["directory"], "-o", folder / "few.mp4", "--size", "320x240")


def test_tracks_of_a_mixture_give_the_numbers_of_each_species(folder):
    scene = {**SCENE, "rods_2": {"length": 2.5, "count": 30}, "measure": {**SCENE["measure"], "of": "each"}}
    scene["rods"] = {"length": 4.5, "area_fraction": 0.5}
    (folder / "mixed.json").write_text(json.dumps(scene))
    said(PROGRAMS / "shaken-worker", folder / "mixed.json", "--out", folder / "mixture", "--no-lcm", "--quiet")
    said(sys.executable, ROOT / "docs/tracks_of_a_run.py", folder / "mixture", folder / "mixed.csv", 0, 0, 0)
    answer = json.loads(measure(folder, folder / "mixed.csv", "--scene", folder / "mixed.json", "--scale", 0.05,
                                "--interval", "10ms", "--flip-y"))
    run, seen = shaken.open(folder / "mixture"), shaken.open(answer["directory"])
    for name in ("S", "rods_2.S"):
        assert seen.numbers[name].value == pytest.approx(run.numbers[name].value, abs=1e-3)
    for name in ("/msd/total_mm2", "/rods_2/msd/total_mm2"):
        np.testing.assert_allclose(seen.arrays[name][3:], run.arrays[name][3:], rtol=0.02)
    first = shaken.measure(run.frames(), scene=run.scene)
    assert first.numbers["S"].value == pytest.approx(run.numbers["S"].value, abs=1e-6)
    frame, same = next(iter(run.frames())), next(iter(seen.frames()))
    assert (np.bincount(frame.species) == np.bincount(same.species)).all(), "they can be drawn"


def test_a_folder_of_tracks_that_is_measured_anew_knows_what_they_lack(folder):
    rows = [f"{frame},{2 + 3 * rod},{4 + rod},{10 * rod}" for frame in range(3) for rod in range(4)]
    (folder / "few.csv").write_text("\n".join(["frame,x,y,angle", *rows]))
    once = json.loads(measure(folder, folder / "few.csv", "--scene", folder / "lab.json", "--interval", "10ms"))
    tracks = said(PROGRAMS / "shaken", "measure", once["directory"], "-o", folder / "anew", "--json",
                  *(word for name in ("polar", "layers", "msd") for word in ("-s", f"measure.{name}=true")))
    for name in ("polar is left out: it needs velocities", "layers is left out: it needs tilts", "msd is left out"):
        assert name in tracks
    assert np.isnan(next(iter(shaken.open(once["directory"]).frames())).velocities).all()
    said(PROGRAMS / "shaken", "export", once["directory"], "-o", folder / "few.extxyz", "--last")
    assert (folder / "few.extxyz").read_text().splitlines()[2].split()[15:18] == ["nan"] * 3, "nothing is made up"

    rows = [f"{frame},{rod},{2 + 3 * rod + frame},{4 + rod},{95 * rod}" for frame in range(3) for rod in range(4)]
    (folder / "few.csv").write_text("\n".join(["frame,id,x,y,angle", *rows]))
    for again in (folder / "few.csv", folder / "out"):
        answer = said(PROGRAMS / "shaken", "measure", again, "-o", folder / "out", *["--json"][:again.is_dir()],
                      *(["--scene", folder / "lab.json", "--interval", "10ms"] if again.is_file() else []))
        assert "velocities are displacements from the frame before to the one after, over 0.02 s" in answer


def test_heads_of_a_run_are_known_where_all_point_one_way_and_those_of_arrays_are_not(folder):
    rods = [(2 + 3 * k, 4 + k, 10 * k) for k in range(4)]
    frames = [(np.array([(x, y) for x, y, _ in rods]), np.radians([angle for *_, angle in rods])) for _ in range(3)]
    seen = shaken.measure(frames, interval="10 ms", box=20, polar=True, order=True)
    said = seen.summary["frames"]["remarks"]
    assert any("polar is left out: it needs heads" in remark for remark in said)
    assert any("velocities are displacements" in remark for remark in said)
    as_of_a_run = [shaken.Frame(0.01 * k, k, np.c_[x, np.ones(4)], np.c_[np.cos(a), np.sin(a), np.zeros(4)],
                                np.zeros((4, 3)), np.zeros((4, 3), int), np.zeros(4, int), np.array([20, 20, 1.2]))
                   for k, (x, a) in enumerate(frames)]
    polar = shaken.measure(as_of_a_run, box=20, polar=True).numbers["P"].value
    assert polar == pytest.approx(math.sin(math.radians(20)) / (4 * math.sin(math.radians(5))), abs=1e-6)


def test_a_measurement_in_a_parcel_is_not_said_to_run_again(folder):
    measured = json.loads(measure(folder, folder / "sim"))["directory"]
    for run, words in ((measured, "measured, not simulated"), (folder / "sim", "with the same bits")):
        said(PROGRAMS / "shaken", "pack", run, "-o", folder / "one.tar.xz")
        unpacked = folder / f"unpacked-{Path(run).name}"
        assert words in said(PROGRAMS / "shaken", "unpack", folder / "one.tar.xz", "-o", unpacked)


def test_what_is_wrong_is_said_with_code_2(folder):
    said(PROGRAMS / "shaken", "measure", folder / "sim", "-s", "box.gap=1.3", "-o", folder / "new", code=2)
    assert not (folder / "new").exists()
    problems = json.loads(measure(folder, folder / "sim", "-s", "box.gap=1.3", code=2))["problems"]
    assert {problem["path"] for problem in problems} >= {"/box/gap"}
    (folder / "t.csv").write_text("frame,x,y,angle\n0,1,2,3\n")
    assert "there is no nowhere.csv" in measure(folder, "nowhere.csv", code=2)
    assert "--scene is missing" in measure(folder, folder / "t.csv", code=2)
    measure(folder, folder / "sim")
    text = said(PROGRAMS / "shaken-worker", folder / "out" / "scene.json", "--out", folder / "out", "--no-lcm", code=1)
    assert "holds what was measured on recorded frames; choose another one" in text, "a run does not take its place"
    text = said(PROGRAMS / "shaken", "measure", folder / "sim", "-o", folder, code=2)
    assert "holds no whole measurement of frames" in text
