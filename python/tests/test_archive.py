import json
import lzma
import os

import numpy as np
import pytest

import shaken
from conftest import made_up_run
from shaken import archive

BINS = 41


def curves(rng):
    r = np.linspace(-5, 5, BINS)
    symmetric = np.exp(-(r[:, None] ** 2 + 0.5 * r[None, :] ** 2) / 4)
    n = 5000
    return {"order/time_s": (np.arange(n) * 0.02, "s"), "order/order": (0.8 + 0.05 * rng.normal(size=n), "1"),
            "order/director_rad": (np.angle(-np.exp(0.02j * rng.normal(size=n))) / 2, "rad"),
            "pairs/across_mm": (r, "mm"), "pairs/along_mm": (r, "mm"), "pairs/g2": (symmetric.ravel(), "1"),
            "pairs/g": (symmetric.ravel(), "1"), "msd/lag_s": ([0.1, 1, 10], "s"),
            "msd/total_mm2": ([0.5, 6, np.nan], "mm2"), "defects/time_s": (np.arange(0, 5, 0.5), "s"),
            "defects/n_plus": ([0, 1, 2, 3, 9, 1, 1, 1, 0, 0], "1")}


def test_an_archived_run_says_what_the_run_says(tmp_path):
    made_up_run(tmp_path / "run", arrays=curves(np.random.default_rng(2)), frames=9)
    run = shaken.open(tmp_path / "run")
    path = archive.add_run(tmp_path / "run", tmp_path / "archive", {"rods.area_fraction": 0.75}, ["long"])
    kept = shaken.open(path)
    assert path.stat().st_size <= archive.LARGEST
    assert kept.id == run.id and kept.scene == run.scene and kept.sweeps == ["long"]
    assert kept.key("rods.area_fraction") == 0.75
    assert kept["S"] == run["S"] and kept["diffusion_mm2_s"] == run["diffusion_mm2_s"]
    assert np.allclose(kept["/msd/total_mm2"], run["/msd/total_mm2"], rtol=2e-4, equal_nan=True)
    assert kept["/msd/total_mm2"].unit == "mm2" and list(kept["/msd/total_mm2"].axis) == pytest.approx([0.1, 1, 10],
                                                                                                       rel=2e-4)
    assert np.allclose(kept["/pairs/g2"], run["/pairs/g2"], rtol=2e-4)
    assert kept["/pairs/g2"].shape == (BINS, BINS) and len(kept["/order/order"]) <= 1050
    assert kept["/order/order"].mean() == pytest.approx(run["/order/order"].mean(), abs=1e-3)
    assert np.allclose(np.exp(2j * np.asarray(kept["/order/director_rad"])), -1, atol=0.1), "no mean of both ends"
    with pytest.raises(shaken.ShakenError, match="comes from an archive"):
        next(kept.frames())


def test_snapshots_are_of_the_end_and_of_most_defects(tmp_path):
    made_up_run(tmp_path / "run", arrays=curves(np.random.default_rng(2)), frames=9)
    last, most = shaken.open(archive.add_run(tmp_path / "run", tmp_path / "archive")).snapshots
    frames = list(shaken.open(tmp_path / "run").frames())
    assert last.time == 4.0 and most.time == 2.0 and list(last.box) == [20, 20]
    order = np.lexsort((frames[4].positions[:, 1], frames[4].positions[:, 0]))
    assert np.abs(most.positions - frames[4].positions[order, :2]).max() < 20 / 65536 + 1e-6
    assert np.allclose(np.exp(2j * most.theta), np.exp(2j * frames[4].theta[order]), atol=1e-4)


def test_the_rods_of_a_box_that_is_not_square_lie_where_they_lay(tmp_path):
    made_up_run(tmp_path / "run", frames=2, aspect=6, scene={"box.aspect": 6})
    kept = shaken.open(archive.add_run(tmp_path / "run", tmp_path / "archive"))
    [snapshot] = kept.snapshots
    last = list(shaken.open(tmp_path / "run").frames())[-1]
    order = np.lexsort((last.positions[:, 1], last.positions[:, 0]))
    assert kept.key("box.aspect") == 6 and list(snapshot.box) == [20, 120]
    assert snapshot.positions[:, 1].max() > 60, "they fill all of its length"
    assert (np.abs(snapshot.positions - last.positions[order, :2]) < snapshot.box / 65536 + 1e-6).all()


def test_a_run_that_was_cut_is_not_archived(tmp_path):
    made_up_run(tmp_path / "run", state="stopped")
    with pytest.raises(shaken.ShakenError, match="only finished runs"):
        archive.add_run(tmp_path / "run", tmp_path / "archive")
    assert not (tmp_path / "archive").exists()


def test_of_one_run_the_longer_is_kept(tmp_path):
    folder = tmp_path / "archive"
    path = archive.add_run(made_up_run(tmp_path / "run", seconds=10), folder)
    assert archive.add_run(made_up_run(tmp_path / "run", seconds=10), folder) is None
    assert archive.add_run(made_up_run(tmp_path / "longer", seconds=20, order=0.9), folder) == path
    assert archive.add_run(made_up_run(tmp_path / "run", seconds=10), folder) is None
    assert shaken.open(path)["S"].value == 0.9


def test_archives_are_merged_by_copying(tmp_path):
    archive.add_run(made_up_run(tmp_path / "a", run_id="a" * 16, seconds=10), tmp_path / "one")
    archive.add_run(made_up_run(tmp_path / "a2", run_id="a" * 16, seconds=30), tmp_path / "two")
    archive.add_run(made_up_run(tmp_path / "b", run_id="b" * 16), tmp_path / "two")
    assert [path.name[0] for path in archive.merge(tmp_path / "two", tmp_path / "one")] == ["a", "b"]
    assert [run.summary["sim_seconds"] for run in shaken.archived_runs(tmp_path / "one")] == [30, 10]
    assert archive.merge(tmp_path / "two", tmp_path / "one") == []


def test_equal_runs_give_equal_files(tmp_path):
    for name in ("one", "two"):
        made_up_run(tmp_path / name, arrays=curves(np.random.default_rng(2)), frames=3)
    assert (archive.archive_file(shaken.open(tmp_path / "one")) == archive.archive_file(shaken.open(tmp_path / "two")))


def test_a_file_that_would_be_too_large_leaves_out_what_matters_least(tmp_path, monkeypatch):
    made_up_run(tmp_path / "run", arrays=curves(np.random.default_rng(2)), frames=9)
    whole = len(archive.archive_file(shaken.open(tmp_path / "run")))
    monkeypatch.setattr(archive, "LARGEST", whole - 1)
    small = shaken.open(archive.add_run(tmp_path / "run", tmp_path / "archive"))
    assert len(small.snapshots) == 1 and "/pairs/g2" in small


def test_a_long_run_with_curves_against_time_fits(tmp_path):
    rng, n = np.random.default_rng(4), 12000
    time, noise = (np.arange(n) * 0.01, "s"), rng.normal(size=n)
    made_up_run(tmp_path / "run", arrays={
        "drift/time_s": time, "drift/x_mm": (np.cumsum(0.01 * noise), "mm"), "temperatures/time_s": time,
        **{f"temperatures/{name}_pJ": (900 + rng.normal(size=n), "pJ") for name in ("along", "across", "turning")},
        **{f"{group}/time_s": time for group in ("stress", "polar", "collisions", "clusters")},
        **{f"stress/{name}": (rng.normal(size=n), "1") for name in ("xx", "yy", "xy", "yx")}})
    path = archive.add_run(tmp_path / "run", tmp_path / "archive")
    way = shaken.open(path)["/drift/x_mm"]
    assert path.stat().st_size <= archive.LARGEST and len(way) <= 1050
    assert way[-1] == pytest.approx(np.cumsum(0.01 * noise)[-12:].mean(), abs=0.02), "a mean of twelve"


@pytest.mark.parametrize("damage", [lambda data: data[:-20], lambda data: b"junk", lambda data: b"",
                                    lambda data: lzma.compress(b"{}\n"), lambda data: lzma.compress(b"[1]\n"),
                                    lambda data: data[:100] + bytes([data[100] ^ 1]) + data[101:]])
def test_damaged_files_are_refused(tmp_path, damage):
    path = archive.add_run(made_up_run(tmp_path / "run"), tmp_path / "archive")
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(shaken.ShakenError, match="no file of an archive"):
        shaken.open(path)


def hostile(change):
    """A file of an archive whose header is changed."""
    def made(data):
        text, _, numbers = lzma.decompress(data).partition(b"\n")
        header = json.loads(text)
        changed = change(header)
        return lzma.compress((changed if isinstance(changed, str) else json.dumps(header)).encode() + b"\n" + numbers)
    return made


def changed(name, value):
    return hostile(lambda header: header.__setitem__(name, value))


def first(name, key, value):
    return hostile(lambda header: header[name][0].__setitem__(key, value))


def end_of(header):
    """Where the numbers end: every snapshot has two bytes for an angle."""
    return max([entry["at"] + 4 * entry["n"] for entry in header["arrays"]] +
               [entry["at"] + 6 * entry["n"] for entry in header["snapshots"]])


@pytest.mark.parametrize("damage", [
    hostile(lambda header: header.pop("arrays") and None), hostile(lambda header: header.pop("scene") and None),
    changed("arrays", None), changed("arrays", {"a": 1}), changed("arrays", [1]), changed("snapshots", None),
    changed("summary", [1]), changed("summary", {}), changed("scene", 7), changed("parameters", 7),
    changed("sweeps", None), changed("sweeps", [1]), hostile(lambda header: "[" * 100_000),
    hostile(lambda header: header["summary"].update(order=[1])), hostile(lambda header: header["summary"].update(
        measured={"a": 7})), hostile(lambda header: header["summary"].update(sim_seconds="long")),
    hostile(lambda header: header["summary"].update(run_id="f" * 16)),
    hostile(lambda header: header["summary"]["order"].update(mean=10**400)),
    first("arrays", "n", -1), first("arrays", "n", 10**9), first("arrays", "n", 2.5), first("arrays", "at", -4),
    first("arrays", "name", ["a"]), first("snapshots", "n", -1), first("snapshots", "side", None),
    first("snapshots", "n", 10**6), hostile(lambda header: header["arrays"][0].update(n=end_of(header) // 4 + 1, at=0)),
    hostile(lambda header: header["snapshots"][0].update(at=end_of(header) - 5 * header["snapshots"][0]["n"])),
    hostile(lambda header: next(entry for entry in header["arrays"] if entry["name"] == "/pairs/g").update(n=7))])
def test_hostile_files_are_refused_in_words(tmp_path, damage):
    path = archive.add_run(made_up_run(tmp_path / "run", arrays=curves(np.random.default_rng(2)), frames=2),
                           tmp_path / "archive")
    path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(shaken.ShakenError, match="is damaged, or no file of an archive: .* remove it"):
        shaken.open(path)


def test_damaged_files_are_neither_merged_nor_in_the_way(tmp_path):
    path = archive.add_run(made_up_run(tmp_path / "run"), tmp_path / "one")
    archive.add_run(made_up_run(tmp_path / "b", run_id="b" * 16), tmp_path / "one")
    whole = path.read_bytes()
    path.write_bytes(whole[:-20])
    with pytest.raises(shaken.ShakenError, match=path.name):
        archive.merge(tmp_path / "one", tmp_path / "two")
    assert [kept.name[0] for kept in (tmp_path / "two").iterdir()] == ["b"]
    assert archive.add_run(tmp_path / "run", tmp_path / "one") == path and path.read_bytes() == whole
    path.write_bytes(whole[:-20])
    said = []
    assert [run.id[0] for run in shaken.archived_runs(tmp_path / "one", said.append)] == ["b"]
    assert f"It is now {path.name}.damaged" in said[0] and not path.exists()
    assert path.with_name(path.name + ".damaged").read_bytes() == whole[:-20]


def test_files_of_an_archive_are_on_the_disk_before_they_have_their_names(tmp_path, monkeypatch):
    calls = []
    for name in ("fsync", "replace"):
        real = getattr(os, name)
        monkeypatch.setattr(os, name, lambda *of, name=name, real=real: (calls.append((name, of)), real(*of)))
    (tmp_path / "archive").mkdir()
    path = archive.add_run(made_up_run(tmp_path / "run"), tmp_path / "archive")
    assert [name for name, _ in calls] == ["fsync", "replace", "fsync"]
    beside = calls[1][1][0]
    assert beside.parent == path.parent and beside.name not in (path.name, path.with_suffix(".tmp").name)
    archive.add_run(made_up_run(tmp_path / "run", seconds=20), tmp_path / "archive")
    assert calls[4][1][0] != beside, "two writers have a file each"
    assert list(path.parent.iterdir()) == [path]


def test_of_an_archive_all_damaged_files_are_named(tmp_path):
    archive.add_run(made_up_run(tmp_path / "run"), tmp_path / "archive")
    for name in ("1", "2"):
        (tmp_path / "archive" / (name + archive.SUFFIX)).write_text("junk")
    with pytest.raises(shaken.ShakenError, match="nowhere is no folder"):
        next(archive.archived_runs(tmp_path / "nowhere"))
    found = []
    with pytest.raises(shaken.ShakenError, match="1.run.xz is damaged.*\n.*2.run.xz is damaged"):
        found.extend(archive.archived_runs(tmp_path / "archive"))
