"""`shaken calibrate`: D_r of known walks, the search of made-up laws, and the command itself on real rods."""
import json
import math
import subprocess

import numpy as np
import pytest

from shaken.calibration import app
from shaken.calibration.diffusion import Diffusion, diffusion, exponent
from shaken.calibration.rods import Level, Measuring, NotDiffusive, Species, rods_at, scene_of
from shaken.calibration.search import BelowOwn, noise_for, power_law
from shaken.errors import ShakenError
from shaken.estimate import Estimate
from shaken.opening import open_run

from conftest import PROGRAMS, night

LAGS = np.array(sorted({k * 2**j for j in range(16) for k in (4, 5, 6, 7)} | {1, 2, 3})) * 5e-3
SCENE = {"rods": {"length": 4.5, "count": 9, "area_fraction": 0.7}, "box": {"side": 10.0, "gap": 1.2},
         "plates": {"gamma": 7.0, "noise": 0.3}, "time": {"step": 1.6e-5, "seed": 7, "steady": "auto", "measure": 10.0},
         "measure": {"order": {}}, "stream": {"rate": 20.0}}


def persistent(d_r, memory, lag=LAGS):
    """MSAD of a rod whose angular velocity is forgotten exponentially (Uhlenbeck & Ornstein 1930)."""
    return 2 * d_r * (lag - memory * (1 - np.exp(-lag / memory)))


# --- D_r of runs

def walks(runs, d_r, memory, length, seed):
    """Lags and MSAD of independent walks of an angle whose velocity is an Ornstein-Uhlenbeck process, exact in each
    step, averaged over 40 rods a run."""
    rng = np.random.default_rng(seed)
    step = memory / 20
    n, keep = int(length / step), math.exp(-1 / 20)
    sigma = math.sqrt(d_r / memory)
    rate = sigma * rng.standard_normal((runs, 40))
    angle = np.zeros((n, runs, 40))
    for k in range(1, n):
        after = keep * rate + sigma * math.sqrt(1 - keep**2) * rng.standard_normal(rate.shape)
        angle[k] = angle[k - 1] + 0.5 * step * (rate + after)
        rate = after
    lags = np.unique(np.round(np.geomspace(1, n // 2, 40)).astype(int))
    return lags * step, np.array([((angle[lag:] - angle[:-lag])**2).mean(axis=(0, 2)) for lag in lags]).T


def test_d_r_of_walks_is_theirs_and_its_error_is_the_scatter():
    found = [diffusion(*walks(12, d_r=3.0, memory=0.5, length=128, seed=seed), 64.0) for seed in range(12)]
    found = [one for one in found if one is not None]  # of a few, chance has a window at longer lags disagree
    assert len(found) >= 10
    pulls = [(one.d_r.value - 3.0) / one.d_r.error for one in found]
    assert np.mean([one.d_r.error for one in found]) < 0.2
    assert abs(np.mean(pulls)) < 4 / math.sqrt(len(found))
    assert 0.5 < np.std(pulls) < 1.7
    for one in found:
        assert one.lag_from >= 4 * 0.9 * one.memory
        assert one.memory == pytest.approx(0.5, abs=0.2)


def test_the_slope_of_a_persistent_walk_is_within_a_percent():
    for memory in (0.05, 0.3, 2.0):
        found = diffusion(LAGS, np.array([persistent(5.0, memory)] * 3), 1000.0)
        assert found.d_r.value == pytest.approx(5.0, rel=0.01)
        assert found.memory == pytest.approx(memory, rel=0.1)
        assert 4 * 0.9 * memory < found.lag_from < 8 * memory


def test_turning_that_is_not_diffusive_has_no_d_r():
    for power in (2.0, 1.3, 0.6):
        curve = np.array([LAGS**power] * 3)
        assert diffusion(LAGS, curve, 100.0) is None
        assert exponent(LAGS, curve, 100.0) == pytest.approx(power)
    assert diffusion(LAGS, np.array([persistent(5.0, 30.0)] * 3), 64.0) is None  # the lags are too short
    assert diffusion(LAGS, np.zeros((3, LAGS.size)), 100.0) is None
    # a first regime that looks diffusive, and a faster one later
    later = 2 * 0.5 * LAGS + np.where(LAGS > 4, 2 * 20.0 * (LAGS - 4), 0)
    found = diffusion(LAGS, np.array([later] * 3), 1000.0)
    assert found.d_r.value == pytest.approx(20.5, rel=0.02) and found.lag_from > 8


# --- the search

def level(noise, d_r, error=0.0):
    return Level(noise, Diffusion(Estimate(value=d_r, error=error, steady=True), 1.0, 4.0, 0.1), 8.0, 100.0, 0)


class Law:
    """D_r = own + growth * noise**power, with a scatter of what is asked for."""

    def __init__(self, own, growth, power, seed=0):
        self.own, self.growth, self.power, self.rng = own, growth, power, np.random.default_rng(seed)
        self.asked = []

    def __call__(self, noise, precision):
        self.asked.append(noise)
        true = self.own + self.growth * noise**self.power
        return level(noise, true * (1 + 0.8 * precision * self.rng.standard_normal()), 0.8 * precision * true)


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0])
def test_the_noise_of_a_power_law_is_found(power):
    for seed in range(20):
        law = Law(own=2.0, growth=30 * 0.05**-power, power=power, seed=seed)
        found = noise_for(20.0, law, 0.05)
        true = 0.05 * (18 / 30)**(1 / power)
        assert found.is_met and found.own.noise == 0
        assert abs(found.noise - true) < 5 * found.error + 0.07 * true / power
        assert found.level.noise == found.noise == float(f"{found.noise:.3g}"), "measured with the noise that is given"
        assert len(law.asked) < 16


def test_known_levels_shorten_the_search():
    law = Law(0.0, 1000.0, 1.0)
    first = noise_for(20.0, law, 0.05)
    n = len(law.asked)
    second = noise_for(25.0, law, 0.05, [first.level, level(0.03, 30.0, 1.0)])
    assert second.noise == pytest.approx(0.025, rel=0.1)
    assert len(law.asked) - n < n


def test_less_than_rods_have_by_themselves_is_refused_with_both_figures():
    with pytest.raises(BelowOwn, match=r"D_r = 5 rad\^2/s is not above .* 1[12]\.\d+ ± 0\.\d+: noise only adds"):
        noise_for(5.0, Law(12.0, 1000.0, 2.0), 0.05)
    with pytest.raises(BelowOwn):
        noise_for(12.1, lambda noise, precision: level(noise, 12 + noise, 0.5), 0.05)
    with pytest.raises(BelowOwn, match="next to no noise"):  # rods that do not diffuse without any
        noise_for(5.0, no_own(lambda noise, precision: level(noise, 20 + noise, 0.5)), 0.05)
    with pytest.raises(ShakenError, match="more than the largest noise, 10 rad/mm"):
        noise_for(500.0, Law(1.0, 2.0, 1.0), 0.05)


def no_own(measure):
    def measured(noise, precision):
        if noise == 0:
            raise NotDiffusive(0.0, 16.0, 2.0)
        return measure(noise, precision)
    return measured


def test_rods_that_do_not_diffuse_without_noise_are_calibrated_with_it():
    found = noise_for(20.0, no_own(Law(0.0, 1000.0, 1.0)), 0.05)
    assert found.own is None and found.noise == pytest.approx(0.02, rel=0.1)

    def never(noise, precision):
        raise NotDiffusive(noise, 128.0, 1.98)
    with pytest.raises(NotDiffusive, match=r"at noise 0.01 rad/mm .* up to lags of 128 s .* lag\^1.98"):
        noise_for(20.0, never, 0.05)


def test_a_power_law_goes_through_its_levels():
    a, p = power_law([level(0.01, 7.0, 0.1), level(0.02, 22.0, 0.1)], 2.0, math.log(10))
    assert p == pytest.approx(2.0, abs=0.1) and a + p * math.log(0.0126) == pytest.approx(math.log(8.0), abs=0.05)
    assert power_law([level(0.01, 7.0, 0.1)], 2.0, 1.0)[1] == 1.5


# --- runs

def species(**more):
    return Species(**{"name": "rods", "has_axis": True, "rod_area_mm2": 2.5, "least_side_mm": 9.9, "scene": SCENE,
                      **more})


def test_scenes_differ_in_noise_seed_and_length_only():
    first, second = (scene_of(species(), 0.02, 0.1, 16, run, 20.0, 5e-3) for run in (0, 1))
    assert first["time"].pop("seed") == 7 and second["time"].pop("seed") == 8
    assert first == second
    assert first["plates"] == {"gamma": 7.0, "noise": 0.02}
    assert first["rods"] == {"length": 4.5, "count": 16, "start": "random"}
    assert 16 * 2.5 / first["box"]["side"]**2 == pytest.approx(0.1, rel=1e-4)
    every = first["measure"]["rotation"]["every"]
    for time in (every, first["time"]["steady"], first["time"]["measure"]):
        assert time / 1.6e-5 == pytest.approx(round(time / 1.6e-5), abs=1e-6)
    assert first["time"]["measure"] == pytest.approx(20.0, abs=every)
    assert scene_of(species(), 0.02, None, 16, 0, 20.0, 5e-3)["box"]["side"] == 2000.0
    assert scene_of(species(), 0.02, 0.5, 16, 0, 20.0, 5e-3)["rods"]["start"] == "compressed"
    assert SCENE["plates"]["noise"] == 0.3, "the species' own scene stays as it is"


def test_dense_rods_are_as_many_as_the_smallest_box_takes():
    assert rods_at(0.1, species()) == 16
    for area_fraction in (0.45, 0.6, 0.7):
        scene = scene_of(species(), 0.02, area_fraction, rods_at(area_fraction, species()), 0, 20.0, 5e-3)
        assert scene["box"]["side"] >= 9.9
        assert scene["rods"]["count"] * 2.5 / scene["box"]["side"]**2 == pytest.approx(area_fraction, rel=1e-4)


class MadeUp(Measuring):
    """Curves of a law in place of runs: D_r = 1000 noise, with a memory of 0.2 s; rods meet so often."""

    meetings, turns = 0, 0.0

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.lengths, self.asked = [], []

    def _run(self, folder, noise, length, run):
        self.lengths.append(length)
        self.asked.append((noise, self.every, self.rods))
        rng = np.random.default_rng(run)
        lag = LAGS * self.every / 5e-3
        scatter = 1 + 0.5 * rng.standard_normal() / math.sqrt(length)
        turns = self.turns if self.every > 2e-3 else 0.0
        return lag, persistent(1000 * noise, 0.2, lag) * scatter, self.meetings, turns


def test_runs_become_longer_until_they_are_precise():
    measuring = MadeUp(species(), 0.1, "shaken", 1)
    rough, fine = measuring.level(0.02, 0.2), measuring.level(0.02, 0.02)
    assert fine.error <= 0.02 * fine.d_r < rough.error and fine.length > rough.length
    assert fine.d_r == pytest.approx(20.0, rel=0.06)
    assert measuring.level(0.02, 0.1) is fine
    assert fine.rod_seconds == pytest.approx(1.25 * fine.length * 12 * 16)


def test_rods_that_turn_fast_are_sampled_more_often_and_too_fast_ones_refused():
    measuring = MadeUp(species(), 0.1, "shaken", 1)
    measuring.turns = 3.0
    measuring.level(0.02, 0.2)
    assert {every for _, every, _ in measuring.asked} == {5e-3, 2.5e-3, 1.25e-3}
    measuring.__class__ = type("Faster", (MadeUp,), {
        "_run": lambda self, *a: (*MadeUp._run(self, *a)[:3], 1.0)})
    with pytest.raises(ShakenError, match="more than 60 degrees"):
        measuring.level(0.03, 0.2)


def test_rods_that_should_be_alone_but_meet_become_fewer():
    measuring = MadeUp(species(), None, "shaken", 1)
    measuring.meetings = 100
    measuring.level(0.02, 0.2)
    assert [rods for _, _, rods in measuring.asked][0] == 16 and measuring.rods < 16
    crowded = MadeUp(species(), 0.1, "shaken", 1)
    crowded.meetings = 100
    crowded.level(0.02, 0.2)
    assert crowded.rods == 16


# --- the command

def test_everything_wrong_with_the_options_is_said_at_once(capsys):
    sphere = {"name": "rods_2", "has_axis": False, "rod_area_mm2": 1.0, "least_side_mm": 2.0, "scene": SCENE}
    both = "--species=" + json.dumps([vars(species()), sphere])
    code = app.main([both, "--rotational-diffusion=fast", "--of=rods_3", "--of=rods_2", "--area-fraction=2",
                     "--precision=0.001", "--threads=0", "--plot=noise.txt"])
    said = capsys.readouterr().err
    assert code == 2 and len(said.splitlines()) == 7
    for words in ("not 'fast'", "--of rods_3: the scene has rods, rods_2", "these are spheres", "0.01 to 0.7, not 2",
                  "0.005 to 0.3", "1 to 256", "a .png, .pdf or .svg"):
        assert words in said
    assert app.main([both]) == 2
    assert "--rotational-diffusion D is missing" in capsys.readouterr().err


def test_the_table_names_the_key_and_the_plot_has_every_level(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(app, "Measuring", MadeUp)
    two = "--species=" + json.dumps([vars(species()), {**vars(species()), "name": "rods_2"}])
    wanted = ["--rotational-diffusion=30", "--rotational-diffusion=20", "--area-fraction=0.1"]
    plot = tmp_path / "noise.svg"
    assert app.main([two, *wanted, f"--plot={plot}"]) == 0
    shown = capsys.readouterr()
    rows = shown.out.splitlines()
    assert rows[0].split()[0] == "SPECIES" and [row.split()[:2] for row in rows[1:]] == [
        ["rods", "20"], ["rods", "30"], ["rods_2", "20"], ["rods_2", "30"]]
    assert " plates.noise = 0.0" in rows[1] and " plates.rods_2.noise = 0.0" in rows[3]
    assert "12 runs of" in shown.err
    assert plot.exists() and len(plot.with_suffix(".csv").read_text().splitlines()) > 6

    assert app.main([two, *wanted, "--of=rods_2", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["refused"] == [] and [one["key"] for one in found["species"]] == ["plates.rods_2.noise"]
    first = found["species"][0]["calibrated"][0]
    assert first["wanted_rad2_s"] == 20 and first["is_met"]
    assert first["noise_rad_per_mm"] == pytest.approx(0.02, rel=0.15)
    assert first["rotational_diffusion_rad2_s"] == pytest.approx(20, rel=0.05)


def test_what_was_found_is_kept_where_another_d_r_cannot_be_had(capsys, monkeypatch):
    monkeypatch.setattr(app, "Measuring", MadeUp)
    wanted = ["--rotational-diffusion=20", "--rotational-diffusion=20000", "--area-fraction=0.1"]
    assert app.main(["--species=" + json.dumps([vars(species())]), *wanted]) == 2
    shown = capsys.readouterr()
    assert "plates.noise = 0.0" in shown.out and "more than the largest noise" in shown.err


def test_what_does_not_diffuse_is_measured_once():
    class Free(MadeUp):
        def _run(self, *arguments):
            lag, _, *more = super()._run(*arguments)
            return (lag, lag**1.9, *more)
    measuring = Free(species(), 0.1, "shaken", 1)
    for _ in range(2):
        with pytest.raises(NotDiffusive, match=r"lag\^1.90"):
            measuring.level(0.0, 0.1)
    assert len(measuring.lengths) == 12 * 4 and max(measuring.lengths) == 32  # of 4, 8, 16 and 32 s


def test_rods_alone_that_keep_turning_are_refused_with_a_way_out(capsys, monkeypatch):
    class Free(MadeUp):
        def _run(self, *arguments):
            lag, _, *more = super()._run(*arguments)
            return (lag, lag**2, *more)
    monkeypatch.setattr(app, "Measuring", Free)
    assert app.main(["--species=" + json.dumps([vars(species())]), "--rotational-diffusion=30"]) == 2
    said = capsys.readouterr().err
    assert "grows as lag^2.00" in said and "--area-fraction 0.3" in said


needs_programs = pytest.mark.skipif(not (PROGRAMS / "shaken").exists(), reason="no programs")


# More rods, one seed, and D_r as the run's own analysis has it.
@night
@needs_programs
def test_a_plain_run_with_the_noise_that_was_found_has_the_wanted_d_r(tmp_path):
    settings = ["-s", "rods.length=2.5", "-s", "time.step=16us"]
    done = subprocess.run([PROGRAMS / "shaken", "calibrate", "-d", "20", "--area-fraction", "0.3", "--precision", "0.1",
                           "--json", *settings], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)["species"][0]["calibrated"][0]
    assert found["is_met"] and found["rotational_diffusion_rad2_s"] == pytest.approx(20, rel=0.2)
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps({
        "rods": {"length": 2.5, "area_fraction": 0.3, "start": "compressed"}, "box": {"side": 20},
        "plates": {"noise": found["noise_rad_per_mm"]}, "time": {"step": "16 us", "steady": "1 s", "measure": "10 s"},
        "measure": {"rotation": {"every": "4 ms"}}}))
    subprocess.run([PROGRAMS / "shaken", "run", scene, "--out", tmp_path / "run"], check=True, capture_output=True)
    run = open_run(tmp_path / "run")
    assert run.numbers["large_turns"].value == 0
    assert run.numbers["rotational_diffusion_rad2_s"].value == pytest.approx(20, rel=0.25)


@needs_programs
def test_bad_scenes_and_options_are_refused_with_exit_code_2(tmp_path):
    def refused(*arguments):
        command = [PROGRAMS / "shaken", "calibrate", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 2, done.stdout + done.stderr
        return done.stderr
    assert "--rotational-diffusion D is missing" in refused()
    assert "rods.lenth" in refused("-d", "40", "-s", "rods.lenth=3")
    assert refused("-d", "40", "--area-fraction", "x") == "shaken: --area-fraction: invalid float value: 'x'\n"
    assert "--of rods_2: the scene has rods" in refused("-d", "40", "--of", "rods_2")
    assert "spheres" in refused("-d", "40", "-s", "rods.beads=1", "-s", "rods.mid_diameter=0.8")
    assert "nowhere.json" in refused(str(tmp_path / "nowhere.json"), "-d", "40")
    for words in (["-d", "x"], ["-d", "40", "--threads", "x"]):  # wherever it is refused
        done = subprocess.run([PROGRAMS / "shaken", "calibrate", "--json", *words], capture_output=True, text=True)
        said = json.loads(done.stdout)
        assert said["exit_code"] == done.returncode == 2 and done.stderr == f"shaken: {said['error']}\n"
