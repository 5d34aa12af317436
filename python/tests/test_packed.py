"""Runs in a file, to be handed on."""
import io
import json
import lzma
import tarfile

import numpy as np
import pytest

import shaken
from conftest import made_up_run
from shaken import packed

ID = "0123456789abcdef"
OTHER = "fedcba9876543210"
CURVE = {"/g2/g2": (np.linspace(1, 0.123456789, 50), "1")}


@pytest.fixture
def runs(tmp_path):
    return [made_up_run(tmp_path / name, run_id=run_id, arrays=CURVE, frames=3)
            for name, run_id in (("a", ID), ("b", OTHER))]


def contents(directory):
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def test_files_come_out_as_they_went_in(runs, tmp_path):
    file = tmp_path / "both.tar.xz"
    assert packed.pack([*runs, runs[0]], file, frames=True) == [ID, OTHER]
    directories = packed.unpack(file, tmp_path / "out")
    assert directories == [tmp_path / "out" / ID, tmp_path / "out" / OTHER]
    for directory, before in zip(directories, runs):
        names = set(packed._FILES)
        assert contents(directory) == {name: data for name, data in contents(before).items() if name in names}
        assert len(shaken.open(directory).trajectory) == 3
    assert [len(point.runs) for point in shaken.sweep_of(tmp_path / "out")] == [2]
    again = file.read_bytes()
    packed.pack(runs[::-1], file, frames=True)
    assert file.read_bytes() == again  # the same runs, the same file
    packed.unpack(file, tmp_path / "out")  # what is there stays


def test_frames_are_left_out_unless_they_are_asked_for(runs, tmp_path):
    packed.pack(runs[:1], tmp_path / "one.tar.xz")
    directory, = packed.unpack(tmp_path / "one.tar.xz", tmp_path / "out")
    assert set(contents(directory)) == {"scene.json", "observables.h5", "summary.json"}
    assert np.array_equal(shaken.open(directory)["/g2/g2"], CURVE["/g2/g2"][0])


def test_other_results_are_not_written_over(runs, tmp_path):
    packed.pack(runs, tmp_path / "both.tar.xz")
    directories = packed.unpack(tmp_path / "both.tar.xz", tmp_path / "out")
    (directories[1] / "scene.json").write_text("{}")
    before = contents(directories[1])
    with pytest.raises(shaken.ShakenError, match=f"{OTHER}/scene.json is there, and is another file"):
        packed.unpack(tmp_path / "both.tar.xz", tmp_path / "out")
    assert contents(directories[1]) == before


def member(name, data=b"{}", kind=tarfile.REGTYPE, pax=()):
    entry = tarfile.TarInfo(name)
    entry.pax_headers = dict(pax)
    entry.size, entry.type, entry.linkname = len(data), kind, "/etc/passwd"
    return entry, data


@pytest.mark.parametrize("members, said", [
    ([member("../../etc/cron.d/x")], "has a member '../../etc/cron.d/x'"),
    ([member(f"{ID}/checkpoint.bin")], "has a member"), ([member(f"/{ID}/scene.json")], "has a member"),
    ([member(f"{ID}/scene.json", b"", tarfile.SYMTYPE)], "has a member"),
    ([member(f"{ID}/scene.json")], "has no summary.json"), ([], "has no runs"),
    ([member(f"{ID}/scene.json"), member(f"{ID}/summary.json", b"[]")], "what no run has written"),
    ([member(f"{ID}/scene.json", pax={"GNU.sparse.map": "a,b"})], "."),
    ([member(f"{ID}/scene.json", pax={"GNU.sparse.realsize": "99999999999", "GNU.sparse.name": f"{ID}/a"})], "."),
    ([member(f"{ID}/scene.json"), member(f"{ID}/summary.json", json.dumps({"run_id": OTHER}).encode())],
     "is another run")])
def test_a_file_that_is_not_ours_is_refused(members, said, tmp_path):
    content = io.BytesIO()
    with tarfile.open(fileobj=content, mode="w") as tar:
        for entry, data in members:
            tar.addfile(entry, io.BytesIO(data))
    (tmp_path / "x.tar.xz").write_bytes(lzma.compress(content.getvalue()))
    with pytest.raises(shaken.ShakenError, match=said):
        packed.unpack(tmp_path / "x.tar.xz", tmp_path / "out")
    assert not list(tmp_path.glob("out/**/*")), "nothing of a refused file is left"


def test_a_damaged_file_is_named(runs, tmp_path):
    file = tmp_path / "both.tar.xz"
    packed.pack(runs, file)
    whole = file.read_bytes()
    for damaged in (whole[:len(whole) // 2], whole[:200] + bytes(50) + whole[250:], b"not xz"):
        file.write_bytes(damaged)
        with pytest.raises(shaken.ShakenError, match="both.tar.xz is damaged"):
            packed.unpack(file, tmp_path / "damaged")
        assert not (tmp_path / "damaged").exists()


def test_what_is_not_done_is_not_packed(tmp_path):
    with pytest.raises(shaken.ShakenError, match="none of them is done"):
        packed.pack([], tmp_path / "x.tar.xz")
    with pytest.raises(shaken.ShakenError, match="no scene.json"):
        packed.pack([tmp_path], tmp_path / "x.tar.xz")
    assert not (tmp_path / "x.tar.xz").exists()


def test_from_one_machine_to_another(programs, tmp_path):
    scene = {"box": {"side": "14 mm"}, "accuracy": "draft", "time": {"steady": 0, "measure": "20 ms"},
             "measure": {"order": {"every": "1 ms"}}, "trajectory": {"every": "5 ms"}}
    daemon = programs.start_daemon("--no-lcm", "--slots", "2")
    daemon.wait(daemon.submit(scene, settings={"rods.area_fraction": [0.3, 0.5]}, name="two"), timeout="100 s")
    file, folder = tmp_path / "two.tar.xz", tmp_path / "theirs"
    said = json.loads(programs.shaken("pack", "two", "--frames", "-o", file, "--json").stdout)
    assert said["bytes"] == file.stat().st_size and len(said["runs"]) == 2
    said = programs.shaken("unpack", file, "-o", folder).stdout
    assert said.startswith("2 runs in ")
    table = json.loads(programs.shaken("results", f"{folder}/", "--json").stdout)
    packings = sorted(row["parameters"]["rods.area_fraction"] for row in table["rows"])
    assert packings == pytest.approx([0.3, 0.5], abs=0.01)
    one = next(folder.iterdir())
    programs.shaken("run", one / "scene.json", "--out", tmp_path / "again")
    assert shaken.open(tmp_path / "again").summary["state_hash"] == shaken.open(one).summary["state_hash"]
