import json
import math
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import shaken
from conftest import made_up_run
from shaken.sweep import grouped


def made(tmp_path, name, phi, **given):
    parameters = {"rods.area_fraction": phi, "rods.length": given.pop("length", 4.5)}
    return parameters, shaken.DirectoryRun(made_up_run(tmp_path / name, run_id=name.ljust(16, "0"), **given),
                                           parameters)


def test_replicas_are_put_together_and_a_run_counts_once(tmp_path):
    a, b = made(tmp_path, "a", 0.5, order=0.2), made(tmp_path, "b", 0.5, order=0.4)
    c = made(tmp_path, "c", 0.6, order=0.8)
    sweep = grouped([a, b, a, c, (c[0], None)])
    assert len(sweep) == 2 and len(sweep[0].runs) == 2 and sweep[1].n_replicas == 2
    assert sweep[0]["S"].value == pytest.approx(0.3) and sweep[0]["S"].error == pytest.approx(0.1)
    assert sweep.parameters == ["rods.area_fraction"]


def test_versions_are_never_averaged(tmp_path):
    old = made(tmp_path, "a", 0.5, version=("0.1.0", 2))
    new = made(tmp_path, "b", 0.5, version=("0.1.0", 3))
    sweep = grouped([old, new, (old[0], None)])
    assert [(len(point.runs), point.n_replicas) for point in sweep] == [(1, 1), (1, 2)]


def test_choosing_columns_frames_and_pivots(tmp_path):
    sweep = grouped([made(tmp_path, f"{i}{j}", phi, length=length, order=phi) for i, phi in enumerate((0.5, 0.6))
                     for j, length in enumerate((2.5, 4.5))])
    assert len(sweep.where(length=4.5)) == 2 and len(sweep.where(**{"rods.area_fraction": 0.5,
                                                                    "rods.length": 2.5})) == 1
    assert [e.value for e in sweep.column("S")] == [0.5, 0.5, 0.6, 0.6]
    assert sweep.column("rods.length") == [2.5, 4.5, 2.5, 4.5]
    assert sweep["S"] == sweep.column("S") and sweep.column("length") == sweep.column("rods.length")
    assert len(sweep[1:]) == 3 and sweep[-1].parameters == sweep.points[3].parameters
    pytest.importorskip("pandas")
    assert sweep.to_frame()["S"].tolist() == [0.5, 0.5, 0.6, 0.6]
    assert sweep.pivot("area_fraction", "length").loc[0.6, 2.5] == 0.6
    assert sweep.pivot("area_fraction", "length", "rods.length").loc[0.6, 2.5] == 2.5
    assert sweep[:1].pivot("length", "length").loc[2.5, 2.5] == 0.5


def test_what_nothing_has_is_an_error_with_what_there_is(tmp_path):
    sweep = grouped([made(tmp_path, str(k), 0.5, length=length) for k, length in enumerate((2.5, "3.5 mm"))])
    for length in (3.5, "3.5 mm", "3.5mm", "3500 um", "0.35 cm"):
        assert sweep.where(length=length).points == [sweep[1]], length
    assert len(sweep.where(**{"box.gap": "1.2 mm"})) == 2, "a key that was not swept"
    for ask, said in ((lambda: sweep.where(width=1), "'width' is no key.*swept are rods.area_fraction, rods.length"),
                      (lambda: sweep.where(**{"rods.lenght": 3.5}), "no 'rods.lenght'; did you mean length"),
                      (lambda: sweep.where(**{"no.such": 3.5}), "'no.such' is no key"),
                      (lambda: sweep.where(length=9), "no point has rods.length = 9; there are 2.5, 3.5 mm"),
                      (lambda: sweep.where(length="3.5 s"), "'3.5 s' is a time, and rods.length is in mm"),
                      (lambda: sweep.where(version="0.2"), "no point has version = 0.2; there are shaken 0.1.0, phys"),
                      (lambda: sweep.column("difusion_mm2_s"), "did you mean diffusion_mm2_s"),
                      (lambda: sweep.column("rods.lenght"), "did you mean rods.length"),
                      (lambda: sweep.column("box.aspect"), "'box.aspect' was measured at no point and is no key"),
                      (lambda: sweep.compared(sweep, "T"), "'T' was measured at no point"),
                      (lambda: sweep.compared(sweep, "rods.length"), "'rods.length' was measured at no point"),
                      (lambda: sweep.pivot("length", "fraction"), "'fraction' is no key"),
                      (lambda: sweep[0]["T"], "'T' was not measured at"),
                      (lambda: list(sweep[0]), "'0' was not measured at"),  # a point is no list of runs
                      (lambda: sweep[0].runs[0][0], "/?0'? was not measured"),
                      (lambda: sweep[0].key("rod.length"), "no 'rod.length'; did you mean rods"),
                      (lambda: sweep[0].runs[0]["/order/oder"], "/order/oder was not measured")):
        with pytest.raises(shaken.ShakenError, match=said):
            ask()
    assert not grouped([({"rods.length": 2}, None)]).column("S")[0].is_known, "no run is done: nobody knows its names"


def test_a_pivot_never_averages_points(tmp_path):
    pytest.importorskip("pandas")
    three = grouped([made(tmp_path, f"{i}{j}", phi, length=length, order=phi + length / 100, version=("0.1.0", physics))
                     for i, phi in enumerate((0.5, 0.6)) for j, (length, physics) in enumerate(
                         ((2.5, 3), (4.5, 3), (4.5, 4)))])
    with pytest.raises(shaken.ShakenError, match=r"differ in version \(shaken 0.1.0, physics 3, .* 4\): choose one"):
        three.pivot("area_fraction", "length")
    with pytest.raises(shaken.ShakenError, match=r"differ in rods.length \(2.5, 4.5\)"):
        three.pivot("area_fraction", "box.gap")
    new = three.where(version="shaken 0.1.0, physics 4")
    assert new.pivot("area_fraction", "length").loc[0.6, 4.5] == pytest.approx(0.645)
    with pytest.raises(shaken.ShakenError, match="several versions.*where"):
        three.compared(new)
    assert len(new.compared(three.where(version="shaken 0.1.0, physics 3"))) == 2
    assert set(three.to_frame()["version"]) == {"shaken 0.1.0, physics 3", "shaken 0.1.0, physics 4"}


def test_a_run_under_two_paths_counts_once(tmp_path):
    parameters = {"rods.area_fraction": 0.5}
    twice = [(parameters, shaken.DirectoryRun(made_up_run(tmp_path / name), parameters)) for name in ("a", "copy")]
    assert len(grouped(twice)[0].runs) == 1


def test_two_sweeps_are_compared_point_by_point(tmp_path):
    one = grouped([made(tmp_path, "a", 0.5, order=0.30, sem=0.03), made(tmp_path, "b", 0.6)])
    two = grouped([made(tmp_path, "c", 0.5, order=0.40, sem=0.04), made(tmp_path, "d", 0.7)])
    [(parameters, a, b, sigmas)] = one.compared(two)
    assert parameters["rods.area_fraction"] == 0.5 and sigmas == pytest.approx(2.0)


SWEEP = {"name": "small", "scene": {"box": {"side": "14 mm"}, "accuracy": "draft",
                                    "time": {"steady": "0.1 s", "measure": "0.5 s"},
                                    "measure": {"order": {"every": "10 ms"}, "msd": {"every": "10 ms"}}},
         "sweep": {"grid": {"rods.area_fraction": [0.4, 0.6]}, "replicas": 2}}


def test_the_daemon_and_its_results_are_those_of_the_program(programs):
    daemon = programs.start_daemon("--no-lcm", "--slots", "1")
    sweep_id = daemon.submit(SWEEP)
    seen = []
    assert daemon.wait(sweep_id, timeout="100 s", progress=seen.append, every=0.1) == {"done": 4}
    assert seen[-1]["progress"] == 1
    sweep = shaken.results(programs.root, "small")
    rows = json.loads(programs.shaken("results", sweep_id, "--aggregate", "--json").stdout)["rows"]
    assert len(sweep) == len(rows) == 2
    for point, row in zip(sweep, rows):
        fields = row.get("fields", row)
        assert point["S"].value == pytest.approx(fields["order.mean"], rel=1e-12)
        for name in ("diffusion_mm2_s", "alpha_short"):
            ours, theirs = point[name], fields.get(f"measured.{name}.value")
            assert (not ours.is_known and theirs is None) or ours.value == pytest.approx(theirs, rel=1e-12)
            error = fields.get(f"measured.{name}.sem")
            assert (error is None and math.isnan(ours.error)) or ours.error == pytest.approx(error, rel=1e-9)
    # what is done is not done again; what is refused is refused in the daemon's words
    assert daemon.submit(SWEEP) == sweep_id
    with pytest.raises(shaken.ShakenError) as refused:
        daemon.submit({"rods": {"lenght": 2}})
    assert str(refused.value).count("rods.length") == 1 and str(refused.value).startswith("request:1:11: /rods/lenght")
    assert daemon.submit({"time": {"measure": "1 h"}, "box": {"side": "14 mm"}}, name="long") != sweep_id
    assert daemon.cancel("long") == 1
    # values are JSON's, and names anything
    name = "näme with #?% & space"
    daemon.submit(SWEEP, name=name, settings={"trajectory": None, "measure.msd": {}, "rods.length": np.array([2.5, 3])})
    assert len(shaken.results(daemon, name)) == 4 and daemon.cancel(name) > 0
    (programs.root / "file.json").write_text(json.dumps(SWEEP["scene"]))
    daemon.submit(str(programs.root / "file.json"), name="of a file",
                  settings={"posts.places": [[4, 4], [8, 8]], "rods.area_fraction": 0.4})
    assert daemon.jobs("of a file")[0]["parameters"] == {}
    daemon.cancel("of a file")
    with pytest.raises(shaken.ShakenError, match="flie.json is no text of a scene, and no file of one"):
        daemon.submit("flie.json")
    with pytest.raises(shaken.ShakenError, match="'nothing'|no sweep"):
        shaken.results(daemon, "nothing")


def test_waiting_goes_on_for_what_is_held_and_through_a_restart(programs):
    daemon = programs.start_daemon("--no-lcm", "--slots", "1")
    daemon.submit({"time": {"measure": "1 h"}, "box": {"side": "14 mm"}}, name="long")
    daemon.ask("POST", "/v1/sweeps/long/hold")
    with pytest.raises(shaken.ShakenError, match="has not ended after 0.1"):
        daemon.wait("long", timeout=0.1)
    with ThreadPoolExecutor(1) as pool:
        waiting = pool.submit(daemon.wait, "long", every=0.05, timeout=60)
        time.sleep(0.3)
        programs.kill()
        time.sleep(0.5)
        assert not waiting.done()
        programs.start_daemon("--no-lcm", "--slots", "1").cancel("long")
        assert waiting.result() == {"cancelled": 1}
    programs.kill()
    with pytest.raises(shaken.ShakenError, match="start one with `shakend"):
        daemon.wait("long")


def test_without_a_daemon_it_says_how_to_start_one(tmp_path):
    with pytest.raises(shaken.ShakenError, match="start one with `shakend"):
        shaken.results(tmp_path)
