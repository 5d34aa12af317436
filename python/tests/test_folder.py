"""Folders of runs as sweeps."""
import json

import pytest
import shaken
from conftest import made_up_run
from shaken.folder import jobs_in, parameters_of
from shaken.tables.app import main


def scene(fraction, count, seed=1, **more):
    return {"rods": {"length": 4.5, "area_fraction": fraction, "count": count}, "time": {"seed": seed, **more}}


def test_parameters_are_what_tells_scenes_apart():
    assert parameters_of([scene(0.5, 80), scene(0.5, 80, 2, measure=9), scene(0.6, 96)]) == [
        {"rods.area_fraction": 0.5}, {"rods.area_fraction": 0.5}, {"rods.area_fraction": 0.6}]
    assert parameters_of([scene(0.5, 80), scene(0.5, 81)]) == [{"rods.count": 80}, {"rods.count": 81}]
    grid = [scene(f, 80, steady=s) for f in (0.5, 0.6) for s in (1, 2)]
    assert parameters_of(grid)[3] == {"rods.area_fraction": 0.6, "time.steady": 2}
    lacking = [{"rods": {"length": 4.5}}, {"rods": {"length": 4.5}, "box": {"gap": 1.2}}]
    assert parameters_of(lacking) == [{"box.gap": None}, {"box.gap": 1.2}], "one says it, one does not"
    assert parameters_of([scene(0.5, 80)]) == [{}]


@pytest.fixture
def folder(tmp_path):
    for k, (fraction, seed) in enumerate([(0.5, 1), (0.5, 2), (0.6, 1)]):
        made_up_run(tmp_path / "fetched" / f"node{k}" / "run", run_id=f"{k:016x}", order=fraction, seed=seed,
                    scene=scene(fraction, 80, seed))
    (tmp_path / "fetched" / "begun").mkdir()
    (tmp_path / "fetched" / "begun" / "scene.json").write_text(json.dumps(scene(0.7, 80)))
    return tmp_path / "fetched"


def test_runs_are_found_at_any_depth_and_replicas_are_numbered(folder):
    assert [(job["parameters"], job["replica"]) for job in jobs_in(folder)] == [
        ({"rods.area_fraction": 0.5}, 1), ({"rods.area_fraction": 0.5}, 2), ({"rods.area_fraction": 0.6}, 1)]
    with pytest.raises(shaken.ShakenError, match="there are no runs in .*begun that have ended"):
        jobs_in(folder / "begun")


def test_damaged_runs_are_all_named(folder):
    (folder / "node0" / "run" / "summary.json").write_text('{"run_id": "1"')
    (folder / "node2" / "run" / "summary.json").write_text("[]")
    with pytest.raises(shaken.ShakenError) as said:
        jobs_in(folder)
    assert [line.split(":")[0][-9:] for line in str(said.value).splitlines()] == ["node0/run", "node2/run"]


def test_a_folder_is_a_sweep(folder):
    sweep = shaken.sweep_of(folder)
    assert sweep.name == "fetched"
    assert [(point.parameters, len(point.runs)) for point in sweep.points] == [
        ({"rods.area_fraction": 0.5}, 2), ({"rods.area_fraction": 0.6}, 1)]


def test_results_of_a_folder_need_no_daemon(folder, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(folder.parent)
    for word in (str(folder), "./fetched", "fetched"):
        assert main(["results", word, "--root", str(tmp_path / "none"), "--aggregate", "--json"]) == 0
        rows = json.loads(capsys.readouterr().out)["rows"]
        assert [(row["rods.area_fraction"], row["n_replicas"], row["order.mean"]) for row in rows] == [
            (0.5, 2, 0.5), (0.6, 1, 0.6)]
    assert main(["results", "elsewhere", "--root", str(tmp_path / "none")]) == 3
    assert "no daemon runs" in capsys.readouterr().err
