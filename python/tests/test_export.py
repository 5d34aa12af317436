"""`shaken export` of made-up runs; tests/e2e/export_test.cpp has real ones, read by other programs."""
import json
import os
import re
import signal

import h5py
import numpy as np
import pytest

from conftest import FRAMES, log_at
from shaken import recorded
from shaken import run as run_module
from shaken.frame_formats import angles_to_director, beads_xyz, extended_xyz, swept_height
from shaken.tables import app, columns

COMMENT = ' pbc="T T F" Time=2 Step=32 units="mm s" source="Shaken run 0123456789abcdef seed 7"'


@pytest.fixture
def of(tmp_path):
    """Of a trajectory.part what other programs get: of(beads=...) is (what it holds, its frame 8)."""
    def opened(**given):
        found = recorded.recorded(log_at(tmp_path / "made.part", **given))
        return found, found.checked(8)
    return opened


@pytest.fixture
def export(tmp_path, monkeypatch, capfd):
    """export("--format=xyz") is (exit code, stdout, stderr) for a run of 21 frames, in the folder of results."""
    (tmp_path / "shaken-worker").symlink_to("/bin/true")  # which tries files
    monkeypatch.setenv("SHAKEN_PROGRAM", str(tmp_path / "shaken"))
    run = tmp_path / "first"
    run.mkdir()
    (run / "scene.json").write_text("{}")
    (run / "summary.json").write_text(json.dumps({"n_rods": 2, "exit": {"state": "done"}, "measured": {
        "alpha": {"value": 2, "sem": 0.5, "steady": None}}}))
    with h5py.File(run / "observables.h5", "w") as file:
        for name, values in {"msd/total_mm2": [0.5, 0.75], "msd/lag_s": [1, 2], "g2/r_mm": [np.nan],
                             "pairs/along_mm": [1, 2, 3], "pairs/across_mm": [4, 5], "pairs/g": range(6)}.items():
            file[name] = np.array(values, float)
    log_at(run / "trajectory.part")
    (tmp_path / "out").mkdir()
    monkeypatch.chdir(tmp_path / "out")
    kept = [signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP)]

    def exported(*words):
        code = 0
        try:
            code = app.main(["export", f"--root={tmp_path}", f"--run={run}", *words])
        except SystemExit as end:
            code = end.code
        return (code, *capfd.readouterr())
    yield exported
    for number, handler in zip((signal.SIGTERM, signal.SIGHUP), kept):
        signal.signal(number, handler)


def numbers_in(text):
    """A text with every number in one form."""
    return re.sub(r"(?<![\w.])-?\d+(\.\d+)?(e[-+]\d+)?(?![\w.])", lambda found: f"{float(found[0]):.7g}", text)


def test_text_has_a_line_for_each_rod_or_bead(of):
    box = 'Lattice="10 0 0 0 5 0 0 0 2" Properties='
    assert numbers_in(extended_xyz(of()[0])(of()[1]).decode()) == (
        f"2\n{box}type:I:1:pos:R:3:id:I:1:orientation:R:4:aspherical_shape:R:3:map_shift:I:3:velo:R:3:director:R:3:"
        f"theta:R:1{COMMENT}\n"
        "1 1 2 0.5 0 0 0.7071068 0 0.7071068 0.5 0.5 1.25 0 -1 0 1.5 -2 0 1 0 0 0\n"
        "2 9.5 0.25 1 1 0 0 0 1 0.5 0.5 1 3 0 8 0 0 4 0 0 1 nan\n")
    beads = numbers_in(beads_xyz(of()[0])(of()[1]).decode())
    assert beads == (f"5\n{box}species:S:1:pos:R:3:radius:R:1:molecule:I:1{COMMENT}\n"
                     "A1 0 2 0.5 0.25 0\nA2 1 2 0.5 0.5 0\nA3 2 2 0.5 0.25 0\nB1 9.5 0.25 0.5 0.5 1\n"
                     "B2 9.5 0.25 1.75 0.25 1\n")
    sizes = beads_xyz(of(species_of_shape=[0, 0])[0])(of()[1])
    assert numbers_in(sizes.decode()) == beads.replace("B", "A"), "sizes are of one species"


@pytest.mark.parametrize("walls, said, pbc", [
    ({"arena": "annulus", "size_mm": 8, "inner_mm": 2.5}, "annulus arena_size=8 arena_inner=2.5", "F F F"),
    ({"arena": "wedge", "size_mm": 6, "inner_mm": 0, "length_mm": 2.5, "narrow_mm": 1.5},
     "wedge arena_size=6 arena_length=2.5 arena_narrow=1.5", "F F F"),
    ({"arena": "channel", "size_mm": 6, "inner_mm": 0}, "channel arena_size=6", "T F F")])
def test_walls_are_named_and_nothing_is_periodic_within_them(of, walls, said, pbc):
    held, frame = of(walls=walls, run_id='01\n23" x="\x1b')
    comment = extended_xyz(held)(frame).decode().splitlines()[1]
    assert f' pbc="{pbc}" ' in comment and comment.endswith(f' source="Shaken run 0123x seed 7" arena={said}')


@pytest.mark.parametrize("scene, height", [
    ({"amplitude": 0.25, "second": {"amplitude": 0.05}, "lid_motion": {"amplitude": 0.1}}, 1.9),
    ({"amplitude": 0.25, "second": {"amplitude": 0.05}}, 2.1), ({"amplitude": "much"}, 1.5), (None, 1.5)])
def test_the_box_is_as_high_as_plates_get(of, scene, height):
    text = json.dumps({"plates": scene}) if scene else "no JSON"
    assert swept_height(of(scene=text)[0]) == pytest.approx(height)


@pytest.mark.parametrize("degrees, header, expected", [
    ((75, 105), {"species_of_shape": [0, 0]}, (-15, 15)), ((75, 285), {"species_of_shape": [0, 0]}, (-15, 15)),
    ((75, 105), {}, (0, 30)), ((75, 105), {"beads": [FRAMES["beads"][0], {"offset_mm": [0], "radius_mm": [0.5]}]},
                               (0, np.nan)),
    ((75, 105), {"beads": [{"offset_mm": [0], "radius_mm": [0.5]}, FRAMES["beads"][0]]}, (np.nan, np.nan))])
def test_angles_are_to_the_director_of_the_first_species(of, degrees, header, expected):
    at = np.radians(degrees)
    turned = 0.5**0.5 * np.stack([np.ones(2), -np.sin(at), np.cos(at), np.zeros(2)], axis=1)
    held, frame = of(orientation=turned, **header)
    found = np.degrees(angles_to_director(held, frame))
    assert np.allclose(found, expected, atol=1e-4, equal_nan=True)


def test_gsd_counts_from_the_middle_and_stays_in_the_box(export, tmp_path):
    hoomd = pytest.importorskip("gsd.hoomd")
    log_at(tmp_path / "first/trajectory.part", box_side_mm=9.5 + 1e-9, species_of_shape=[0, 0])
    assert export("--out=a.gsd", "--from=2 s")[0] == 0
    with hoomd.open("a.gsd", "rb") as frames:
        assert len(frames) == 13 and frames[0].log["time_s"] == [2.0] and frames[0].configuration.step == 32
        rods = frames[0].particles
        assert rods.types == ["A1", "A2"] and list(rods.typeid) == [0, 1]
        assert np.allclose(rods.position, [[-3.75, -0.5, -0.5], [4.75, -2.25, 0]]), rods.position
        assert rods.position[1, 0] < np.float32(9.5 / 2) and rods.image[1, 2] == 8
        assert rods.type_shapes[1] == {"type": "SphereUnion", "diameters": [1, 0.5],
                                       "centers": [[0, 0, -0.5], [0, 0, 0.75]]}


@pytest.mark.parametrize("words, expected", [
    ([], range(21)), (["--from=4.25"], range(17, 21)), (["--to=500 ms"], range(3)),
    (["--from=2.1s", "--to=2.6s"], [9, 10]), (["--from=2.5s", "--every=4"], [10, 14, 18]), (["--every=1000"], [0]),
    (["--to=3.75s", "--every=10", "--last"], [10]), (["--from=-1", "--to=1e9", "--every=7"], [0, 7, 14])])
def test_frames_are_chosen_by_time_and_number(export, words, expected):
    code, out, err = export("--format=xyz", "--out=-", *words)
    steps = [int(step) for step in re.findall("Step=([0-9]+)", out)]
    assert (code, err) == (0, "") and steps == [4 * k for k in expected]


def test_tables_have_what_was_named(export):
    assert export("--format=csv", "--observable=msd", "--out=-") == (0, "lag_s,total_mm2\n1,0.5\n2,0.75\n", "")
    assert export("--format=csv", "--observable=pairs", "--out=-")[1] == (
        "along_mm,across_mm,g\n1,4,0\n2,4,1\n3,4,2\n1,5,3\n2,5,4\n3,5,5\n")
    assert export("--observable=g2", "--out=g.csv") == (0, "g.csv\n", "") and open("g.csv").read() == "r_mm\n\n"
    assert export("--observable=summary", "--format=csv", "--out=-")[1] == (
        "name,value,sem,n_effective,steady,over_s\nn_rods,2,,,,\nalpha,2,0.5,,,\n")
    assert export("--list")[1].startswith("summary\ng2\n  g2/r_mm                       ")
    for words, why in ((["msd", "g2"], "different lengths make no table"), (["mds"], "is called 'mds'"),
                       (["flow"], "'flow' was not measured in this run: its scene has no measure.flow")):
        code, out, err = export("--format=csv", "--out=-", *(f"--observable={word}" for word in words))
        assert (code, out) == (2, "") and why in err


@pytest.mark.parametrize("words, said", [
    ([], "shaken: --format is missing: extxyz, gsd, xyz or csv\n"),
    (["--format=pdb\x1b"], "--format takes extxyz, gsd, xyz or csv, not 'pdb\\u001b'"),
    (["--format=gsd", "--out=-"], "gsd is no text"), (["--format=csv"], "csv takes --observable NAME; `shaken export "),
    (["--format=csv", "--observable=msd", "--last"], "choose frames, not csv"),
    (["--observable=summary", "--observable=msd", "--out=x.csv"], "--observable summary stands by itself"),
    (["--list", "--last"], "--list prints names and takes no other option"),
    (["--format=gsd", "--out=."], ". is no file that could be replaced: give a name in it"),
    (["--format=xyz", "--out=/dev/null"], "--out - writes to stdout"),
    (["--format=xyz", "--from=3 s", "--to=2 s"], "--from is later than --to"),
    (["--format=xyz", "--from=9 s"], "there is no such frame: the 21 frames are from 0 s to 5 s"),
    (["--format=xyz", "--from=0.3", "--to=0.35"], "there is no such frame"),
    *((["--out=a.xyz", "--format=gsd", "--from=2 m", "--every=0", "--observable=msd"], problem) for problem in (
        '--from: "m" is a unit of length', "--every takes a number from 1, not 0",
        "--format gsd does not go with a.xyz", "--observable goes with --format csv"))])
def test_all_that_is_wrong_is_said_and_nothing_written(export, words, said):
    code, out, err = export(*words)
    assert (code, out) == (2, "") and said in err and not os.listdir(".")


def test_what_a_run_does_not_have_is_said(export, tmp_path):
    for name in ("trajectory.part", "observables.h5", "summary.json"):
        (tmp_path / "first" / name).unlink()
    for words, why in ((["--format=gsd"], 'trajectory.h5: the run records no frames: its scene needs a "trajectory"'),
                       (["--list"], "observables.h5: the run has measured nothing yet"),
                       (["--format=csv", "--observable=summary"], "summary.json: the run has not ended")):
        code, _, err = export(*words)
        assert code == 2 and why in err


@pytest.mark.parametrize("name", ["a.gsd", "a.xyz"])
def test_damage_and_interruption_leave_the_former_file(export, tmp_path, monkeypatch, name):
    log = tmp_path / "first/trajectory.part"
    whole = bytearray(log.read_bytes())
    whole[-300] ^= 1
    open(name, "w").write("old")
    log.write_bytes(whole)
    code, _, err = export(f"--out={name}")
    assert code == 1 and "frame 18 is damaged" in err
    log_at(log)
    read = recorded.Recorded.checked
    monkeypatch.setattr(recorded.Recorded, "checked",
                        lambda of, k: signal.raise_signal(signal.SIGTERM) if k == 3 else read(of, k))
    code, _, err = export(f"--out={name}")
    assert code == 130 and "interrupted after 3 of 21 frames: no file is written" in err
    assert os.listdir(".") == [name] and open(name).read() == "old"
    assert export("--out=no/such/a.xyz")[::2] == (1, "shaken: cannot write no/such/a.xyz: No such file or directory\n")


def test_a_table_is_of_one_checkpoint_though_the_run_writes_another(export, tmp_path, monkeypatch):
    class Replaced(columns.Arrays):
        def __getitem__(self, name):
            with h5py.File(tmp_path / "next.h5", "w") as file:
                file["msd/total_mm2"] = file["msd/lag_s"] = np.full(2, 1000.0)
            os.replace(tmp_path / "next.h5", tmp_path / "first/observables.h5")
            return super().__getitem__(name)

    monkeypatch.setattr(run_module, "Arrays", Replaced)
    assert export("--format=csv", "--observable=msd", "--out=-")[1].splitlines()[1:] == ["1,0.5", "2,0.75"]
    assert export("--format=csv", "--observable=msd", "--out=-")[1].splitlines()[1:] == ["1000,1000"] * 2


def test_what_is_no_run_is_said_in_its_own_words(export, tmp_path):
    for path, words in ((tmp_path / "none.h5", "No such file"), (tmp_path, "Is a directory")):
        with pytest.raises(recorded.ShakenError, match=words):
            recorded.recorded(path)
    (tmp_path / "first/summary.json").write_text('{"measured": {"x": 3}, "order": 5, "n_rods": 2}')
    assert export("--format=csv", "--observable=summary", "--out=-")[1].splitlines()[1:] == ["n_rods,2,,,,"]
    with pytest.raises(recorded.Failed, match="are not of 2 rods"):
        with h5py.File(tmp_path / "one.h5", "w") as file:
            parameters, rods = file.create_group("parameters"), file.create_group("particles/trajectory")
            parameters.attrs.update(n_rods=2, box_side_mm=9.0, gap_mm=1.0, dt_s=1e-5)
            parameters["bead_offset_mm"] = parameters["bead_radius_mm"] = [0.5]
            rods["position/step"] = rods["position/time"] = [0]
            for name, width in (("position", 3), ("velocity", 3), ("orientation", 4), ("image", 3)):
                rods[name + "/value"] = np.zeros((1, 1, width))
        recorded.recorded(tmp_path / "one.h5")
