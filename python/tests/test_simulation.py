"""The simulation in Python against the programs: the same bits; and what it alone can do."""
import copy
import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import shaken
from conftest import PROGRAMS

SCENE = {"rods": {"length": "4.5 mm", "area_fraction": 0.6}, "box": {"side": "16 mm"},
         "time": {"steady": 0, "measure": "60 ms", "seed": 3},
         "measure": {"order": {"every": "1 ms"}, "msd": {"every": "1 ms"}, "collisions": {"every": "5 ms"},
                     "stress": {"every": "5 ms"}, "g2": {"every": "5 ms"}},
         "trajectory": {"every": "5 ms"}}
PERIOD = 1 / 200  # of the plates [s]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """What `shaken run` makes of SCENE."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "scene.json").write_text(json.dumps(SCENE))
    subprocess.run([PROGRAMS / "shaken", "run", folder / "scene.json", "--out", folder / "run"], check=True,
                   capture_output=True, timeout=120)
    return shaken.open(folder / "run")


@pytest.fixture
def simulation():
    return shaken.Simulation(SCENE)


def same(a, b):
    return all(np.array_equal(np.asarray(a[name]), np.asarray(b[name]), equal_nan=True) for name in b)


def test_is_the_run_of_the_programs_bit_by_bit(simulation, run):
    rng = np.random.default_rng(1)
    while simulation.time < 0.06 - 1e-9:  # in pieces of any length
        simulation.advance(ticks=min(int(rng.integers(1, 400)), round((0.06 - simulation.time) / simulation.step)))
    found = simulation.results()
    assert simulation.state_hash == run.summary["state_hash"]
    assert found.id == run.id and found.scene == run.scene
    assert set(found.arrays) == set(run.arrays) and same(found.arrays, run.arrays)
    assert found["/msd/total_mm2"].unit == "mm2" and len(found["/g2/g2"].axis) == len(found["/g2/g2"])
    clocks = ("cpu_seconds", "wall_seconds", "rod_seconds_per_cpu_second", "started", "finished", "files", "effects")
    assert ({name: value for name, value in found.summary.items() if name not in clocks} ==
            {name: value for name, value in run.summary.items() if name not in clocks})


def test_threads_do_not_change_a_bit(simulation):
    other = shaken.Simulation(SCENE, threads=3)
    for each in (simulation, other):
        each.advance("10 ms")
    assert other.state_hash == simulation.state_hash


def test_arrays_are_those_of_the_recorded_frames(simulation, run):
    for frame in run.frames():
        simulation.advance(ticks=frame.tick - simulation.tick)
        now = simulation.snapshot
        assert (now.tick, now.time) == (frame.tick, pytest.approx(frame.time))
        assert np.allclose(simulation.positions, frame.positions, rtol=0, atol=2e-6)
        assert np.allclose(simulation.directors, frame.directors, rtol=0, atol=1e-6)
        assert np.allclose(simulation.velocities, frame.velocities, rtol=1e-6, atol=1e-5)
        assert np.array_equal(now.images, frame.images) and np.array_equal(now.species, frame.species)
        assert np.allclose(now.box, frame.box) and now.periodic == frame.periodic
        assert simulation.order == pytest.approx(frame.order, abs=1e-6)
    assert frame.tick > 0 and simulation.angular_velocities.shape == (len(simulation.positions), 3)


def test_goes_on_from_a_checkpoint_a_pickle_and_a_copy(simulation, run):
    simulation.advance("20 ms")
    others = [shaken.Simulation.resume(simulation.checkpoint()), pickle.loads(pickle.dumps(simulation)),
              copy.deepcopy(simulation)]
    simulation.advance("40 ms")
    for other in others:
        other.advance("40 ms")
        assert other.state_hash == simulation.state_hash == run.summary["state_hash"]
        assert same(other.results().arrays, run.arrays)
    damaged = bytearray(simulation.checkpoint())
    damaged[-5] ^= 1
    with pytest.raises(shaken.ShakenError, match="damaged"):
        shaken.Simulation.resume(bytes(damaged))


def test_stages_are_those_of_a_protocol(programs):
    two = {"scene": {**SCENE, "time": {"steady": 0, "measure": "10 ms"}},
           "sweep": {"stages": [{"plates.gamma": 7}, {"plates.gamma": 4, "time.measure": "15 ms"}]}}
    daemon = programs.start_daemon("--no-lcm", "--slots", "1")
    daemon.wait(daemon.submit(two, name="two"), timeout="100 s")
    runs = {point.key("plates.gamma"): point.runs[0] for point in shaken.results(daemon, "two")}
    simulation = shaken.Simulation(two["scene"], {"plates.gamma": 7})
    simulation.advance("10 ms")
    assert simulation.state_hash == runs[7].summary["state_hash"]
    simulation.set_all({"plates.gamma": 4, "time.measure": "15 ms"})
    assert (simulation.tick, simulation.time) == (0, pytest.approx(0.01))
    simulation.advance("15 ms")
    assert simulation.state_hash == runs[4].summary["state_hash"]
    found = simulation.results()
    assert (found.id, found.summary["start"]) == (runs[4].id, runs[4].summary["start"])
    assert same(found.arrays, runs[4].arrays) and simulation.scene["plates"]["gamma"] == 4


def test_a_stage_begins_with_the_next_vibration(simulation):
    simulation.advance("7 ms")
    simulation.set("plates.gamma", 5)
    assert simulation.tick == 0 and simulation.time == pytest.approx(0.01, abs=simulation.step)
    with pytest.raises(shaken.ShakenError, match="plates.gamma"):
        simulation.set("plates.gamma", "much")
    simulation.advance(ticks=10)
    with pytest.raises(shaken.ShakenError, match="gama"):
        simulation.set("plates.gama", 5)
    assert simulation.tick == 10 and simulation.scene["plates"]["gamma"] == 5  # it was not moved, either


def test_begins_with_rods_of_ones_own(tmp_path):
    scene = {"rods": {"length": "4 mm", "count": 3}, "box": {"side": "20 mm"}, "time": {"steady": 0, "measure": "5 ms"}}
    positions, directors = [[5, 5, 0.5], [10, 10, 0.7], [15, 15, 0.6]], [[1, 0, 0], [0, 1, 0], [0.6, 0.8, 0]]
    simulation = shaken.Simulation(scene, positions=positions, directors=[[2, 0, 0], *directors[1:]])
    assert np.allclose(simulation.positions[:, :2], np.array(positions)[:, :2])
    assert np.allclose(simulation.directors[2], [0.6, 0.8, 0]) and np.all(np.any(simulation.velocities != 0, axis=1))

    # the same as `shaken import`, and a run from there
    rods = tmp_path / "rods.csv"
    rods.write_text("x,y,z,nx,ny,nz\n" + "".join(f"{x},{y},{z},{a},{b},{c}\n" for (x, y, z), (a, b, c)
                                                 in zip(positions, directors)))
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    root = ["--root", tmp_path / "root"]
    made = subprocess.run([PROGRAMS / "shaken", *root, "import", rods, "--scene", tmp_path / "scene.json",
                           "--random-velocities", "--json"], check=True, capture_output=True, text=True, timeout=60)
    (tmp_path / "from.json").write_text(json.dumps({**scene, "start": json.loads(made.stdout)["start"]}))
    subprocess.run([PROGRAMS / "shaken", *root, "run", tmp_path / "from.json", "--out", tmp_path / "run"], check=True,
                   capture_output=True, timeout=60, env={**os.environ, "SHAKEN_ROOT": str(tmp_path / "root")})
    simulation.advance("5 ms")
    assert simulation.state_hash == shaken.open(tmp_path / "run").summary["state_hash"]
    assert simulation.results().id == shaken.open(tmp_path / "run").id

    without_heights = np.array(positions) * [1, 1, np.nan]
    still = shaken.Simulation(scene, positions=without_heights, directors=directors, velocities=np.zeros((3, 3)))
    assert np.all(still.velocities == 0) and np.all((0 < still.positions[:, 2]) & (still.positions[:, 2] < 0.5))
    with pytest.raises(shaken.ShakenError, match="overlap|in each other"):
        shaken.Simulation(scene, positions=[[5, 5, 0.5], [5, 5, 0.5], [9, 9, 0.5]], directors=directors)
    with pytest.raises(shaken.ShakenError, match="positions and directors"):
        shaken.Simulation(scene, positions=positions)
    for wrong, said in (({"species": [0, 0, 200]}, "species 200"), ({"species": [0, 0, 256]}, "species 256"),
                        ({"directors": [[np.inf, 0, 0], *directors[1:]]}, "rod 0: a number is none"),
                        ({"settings": {"rods.length_spread": 0.1}}, "differ in size")):
        with pytest.raises(shaken.ShakenError, match=said):
            shaken.Simulation(scene, **{"positions": positions, "directors": directors, **wrong})


def test_says_all_that_is_wrong_with_a_scene():
    with pytest.raises(shaken.ShakenError) as problem:
        shaken.Simulation({"rods": {"lenght": 4}, "box": {"side": -1}})
    assert "lenght" in str(problem.value) and "side" in str(problem.value)
    with pytest.raises(shaken.ShakenError, match="advance by a time"):
        shaken.Simulation(SCENE).advance()
    with pytest.raises(shaken.ShakenError, match="0 s or more"):
        shaken.Simulation(SCENE).advance(-1.0)


def test_other_threads_go_on_and_look(simulation):
    seen = []
    end = threading.Event()

    def look():
        while not end.is_set():
            seen.append((simulation.tick, simulation.state_hash))
            time.sleep(0.001)

    watcher = threading.Thread(target=look)
    watcher.start()
    n = 0
    half_a_second = round(0.5 / simulation.step)
    while len({tick for tick, _ in seen if tick % half_a_second}) < 4 and n < 500:
        simulation.advance("0.5 s")
        n += 1
    end.set()
    watcher.join()
    assert n < 500, "nobody could look while it was on its way"
    alone = shaken.Simulation(SCENE)
    alone.advance(0.5 * n)
    assert alone.state_hash == simulation.state_hash


def test_ctrl_c_ends_it_between_two_ticks(simulation):
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.advance("1000 s")
    assert 0 < simulation.tick * simulation.step < 100
    rest = simulation.tick + 100
    simulation.advance(ticks=100)
    other = shaken.Simulation(SCENE)
    other.advance(ticks=rest)
    assert other.state_hash == simulation.state_hash


def cpu_seconds_of(work):
    begin = time.process_time()
    try:
        return work() and time.process_time() - begin
    except KeyboardInterrupt:
        return time.process_time() - begin


def test_ctrl_c_ends_a_compressed_start_and_a_measurement():
    rng = np.random.default_rng(1)
    frames = [(rng.uniform(0, 100, (2000, 2)), rng.uniform(0, 3, 2000)) for _ in range(150)]
    every = {"every": 0.01}
    dense = {"rods": {"area_fraction": 0.75, "start": "compressed"}, "box": {"side": "60 mm"}}
    for work in (lambda: shaken.Simulation(dense),
                 lambda: shaken.measure(frames, interval=0.01, box=100.0, g2=every, pairs=every, defects=every)):
        whole = cpu_seconds_of(work)
        timer = threading.Timer(0.2 * whole, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        interrupted = cpu_seconds_of(work)
        timer.join()
        assert interrupted < 0.6 * whole  # it is not told at the end


def test_trouble_names_tick_and_rods():
    # rods that are thrown so hard that they pass through each other within a tick
    scene = {"rods": {"length": "4 mm", "count": 2}, "box": {"side": "20 mm"}, "time": {"measure": "1 s"}}
    simulation = shaken.Simulation(scene, positions=[[5, 10, 0.6], [15, 10, 0.6]], directors=[[1, 0, 0], [1, 0, 0]],
                                   velocities=[[1e5, 0, 0], [-1e5, 0, 0]])
    with pytest.raises(shaken.NumericalTrouble) as trouble:
        simulation.advance("10 ms")
    assert trouble.value.tick == simulation.tick > 0 and trouble.value.rods and isinstance(trouble.value.rods[0], int)
    with pytest.raises(shaken.NumericalTrouble):  # and stays
        simulation.advance(ticks=1)
    assert simulation.results().summary["exit"]["state"] == "failed"
    with pytest.raises(shaken.ShakenError, match="nothing goes on"):
        copy.copy(simulation)


def _wrong_and_troubled(number):
    """What a pool's worker meets."""
    if number == 0:
        shaken.Simulation({"rods": {"lenght": 4}})
    raise shaken.NumericalTrouble("two rods overlap", 7, [1, 2])


def test_errors_come_through_a_pool_of_processes():
    with multiprocessing.Pool(1) as pool:
        with pytest.raises(shaken.ShakenError, match="lenght"):
            pool.apply_async(_wrong_and_troubled, (0,)).get(timeout=60)
        with pytest.raises(shaken.NumericalTrouble) as trouble:
            pool.apply_async(_wrong_and_troubled, (1,)).get(timeout=60)
    assert (trouble.value.tick, trouble.value.rods) == (7, [1, 2])


def test_arrays_are_measured_as_the_run_measures(run):
    found = shaken.measure(run.frames(), scene=run.scene,
                           settings={"measure.msd": False, "measure.order.every": "5 ms"})
    assert found["S"].value == pytest.approx(np.mean([frame.order for frame in run.frames()]), rel=1e-6)
    # in single precision few pairs change their bins
    differ = np.abs(found["/g2/g2"] - run["/g2/g2"])[np.isfinite(run["/g2/g2"])]
    assert np.max(differ) < 2e-3 and np.sum(differ > 1e-5) <= 4
    assert "measure.stress is left out: it needs impacts" in found.summary["frames"]["remarks"]
    with pytest.raises(shaken.ShakenError, match="a box of 16 by 16 mm, and the scene has one of 17 by 17 mm"):
        shaken.measure(run.frames(), box=17.0, order=True)
    plain = shaken.measure([(frame.positions, frame.directors) for frame in run.frames()], interval="5 ms",
                           box=16.0, g2={"every": "5 ms"}, msd={"every": "5 ms"})
    assert plain["/msd/total_mm2"].axis[0] == pytest.approx(0.005) and plain["/msd/total_mm2"][0] > 0


def test_known_answers_of_arrays():
    rng = np.random.default_rng(2)
    angles = rng.normal(0.3, 0.2, (40, 500))  # S = exp(-2 * 0.2**2)
    places = rng.uniform(0, 60, (500, 2))
    paths = [(places + [0.3 * k, 0.0], angle) for k, angle in enumerate(angles)]
    found = shaken.measure(paths, interval="20 ms", box=(60.0, 60.0), order={"every": "20 ms"}, msd=True)
    assert found["S"].value == pytest.approx(np.exp(-2 * 0.2**2), abs=0.005)
    lag = found["/msd/total_mm2"].axis
    assert np.allclose(found["/msd/total_mm2"], (0.3 / 0.02 * lag) ** 2, rtol=1e-4)  # across the border, too

    holes = [(at[k:], angle[k:]) for k, (at, angle) in enumerate(paths)]
    found = shaken.measure(holes, interval="20 ms", box=(60.0, 60.0), order=True, msd=True)
    assert found["S"].value == pytest.approx(np.exp(-2 * 0.2**2), abs=0.005)
    assert any("measure.msd is left out" in remark for remark in found.summary["frames"]["remarks"])

    missed = [(np.where(rng.random((500, 1)) < 0.1, np.nan, at), angle) for at, angle in paths]
    found = shaken.measure(missed, interval="20 ms", box=(60.0, 60.0), order=True, msd=True, drift=True)
    assert np.allclose(found["/msd/total_mm2"], (0.3 / 0.02 * lag) ** 2, rtol=1e-4), "followed across the gaps"
    assert "measure.drift is left out: it needs every rod in every frame" in found.summary["frames"]["remarks"]
    assert found.summary["n_rods"] == pytest.approx(450, abs=20)


@pytest.mark.parametrize("given, said", [
    (dict(frames=[], box=10), "no frames"), (dict(frames=[([[1, 1]], [0.0])], interval=1.0), "box"),
    (dict(frames=[([[1, 1]], [0.0])], box=10), "interval"),
    (dict(frames=[([[1, 1]], [0.0, 1.0])], box=10, interval=1.0), "1 positions and 2 directors"),
    (dict(frames=[([[1, 1]], [0.0])], box=20, interval=1.0, g3=True), "g3"),
    (dict(frames=[([1, 1], [0.0])], box=20, interval=1.0, order=True), "shape"),
    *((dict(frames=[([[1, 1], [9, at]], [0.0, 0.1])] * 2, box=20, interval=1.0, order=True), "frame 0, rod 1")
      for at in (np.inf, 1e15)),
    (dict(frames=[([[1, 1], [9, 1]], [0.0, np.nan])] * 2, box=20, interval=1.0, order=True), "frame 0, rod 1"),
    (dict(frames=[([[1, 1]], [0.0]), ([[np.nan, 1]], [0.0])], box=20, interval=1.0, order=True), "frame 1 has no rod"),
    (dict(frames=[([[1, 1]], [0.0])], box=20, scene={}), "leave out box=")])
def test_says_what_is_wrong_with_arrays(given, said):
    with pytest.raises(shaken.ShakenError, match=said):
        shaken.measure(**given)


def test_frames_in_gsd_are_those_that_were_exported(run, tmp_path):
    gsd = pytest.importorskip("gsd.hoomd")
    file = tmp_path / "run.gsd"
    subprocess.run([PROGRAMS / "shaken", "export", run.directory, "--format", "gsd", "-o", file], check=True,
                   capture_output=True, timeout=60)
    dt = run.key("time.step")
    frames = list(shaken.gsd_frames(file, step=dt))
    for frame, own in zip(frames, run.frames(), strict=True):
        assert frame.tick == own.tick and frame.time == pytest.approx(own.time)
        assert np.allclose(frame.positions, own.positions, atol=1e-5)
        assert np.allclose(frame.directors, own.directors, atol=1e-6)
        assert np.allclose(frame.velocities, own.velocities) and np.array_equal(frame.images, own.images)
    assert shaken.measure(frames, box=16.0, settings={"time.steady": 0},
                          order={"every": "5 ms"})["S"].value == pytest.approx(
        np.mean([frame.order for frame in run.frames()]), abs=1e-6)

    other = gsd.Snapshot() if hasattr(gsd, "Snapshot") else gsd.Frame()  # along x, in units of 10 mm, in the plane
    other.particles.N, other.particles.types, other.particles.typeid = 2, ["A", "rod"], [0, 1]
    other.particles.position, other.configuration.box = [[0, 0, 0], [-1, 0.5, 0]], [4, 4, 0, 0, 0, 0]
    other.particles.orientation, other.configuration.dimensions = [[1, 0, 0, 0], [0.8**0.5, 0, 0, 0.2**0.5]], 2
    with gsd.open(str(tmp_path / "other.gsd"), "wb") as written:
        written.append(other)
    frame, = shaken.gsd_frames(tmp_path / "other.gsd", step=1.0, scale=10, axis=(1, 0, 0), kind="rod")
    assert np.allclose(frame.positions[:, :2], [[10, 25]]) and np.isnan(frame.positions[0, 2])
    assert np.allclose(frame.directors, [[0.6, 0.8, 0]], atol=1e-6)
    with pytest.raises(shaken.ShakenError, match="no particles 'B' but A, rod"):
        next(shaken.gsd_frames(tmp_path / "other.gsd", step=1.0, kind="B"))
    (tmp_path / "none.gsd").write_text("no GSD")
    with pytest.raises(shaken.ShakenError, match="none.gsd is damaged, or no file of GSD"):
        next(shaken.gsd_frames(tmp_path / "none.gsd", step=1.0))
