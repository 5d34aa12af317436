"""`shaken figures` with the real programs: runs, archives, goes on, draws from the archive alone."""
import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest

from conftest import PROGRAMS, made_up_run, night
from shaken.archive import Snapshot, add_run, archived_runs
from shaken.catalogue import JOB_STATES
from shaken.daemon import Daemon
from shaken.errors import ShakenError
from shaken.estimate import Estimate
from shaken.study import running, sets, time_step
from shaken.study.app import main
from shaken.study.evidence import Evidence
from shaken.study.figures import FIGURES
from shaken.study.material import defects_of
from shaken.study.report import sections, with_sections
from shaken.study.statements import STATEMENTS, of_figures

SOURCE = Path(__file__).resolve().parents[2]


def figures(programs, *arguments, check=True):
    """`shaken figures` in this process, which has read matplotlib and scipy already."""
    out, err = io.StringIO(), io.StringIO()
    given = {"SHAKEN_PROGRAM": str(PROGRAMS / "shaken"), "SHAKEN_CONFIGS": str(SOURCE / "configs")}
    with mock.patch.dict(os.environ, given), redirect_stdout(out), redirect_stderr(err):
        try:
            code = main(["--root", str(programs.root), "--scale", "tiny", *map(str, arguments)])
        except SystemExit as ended:
            code = ended.code
    done = SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=err.getvalue())
    assert done.returncode == 0 or not check, done.stderr
    return done


def test_a_figure_is_run_archived_gone_on_with_and_drawn_again(programs, tmp_path):
    out = tmp_path / "figures"
    first = figures(programs, 10, "--out", out, "--budget", "0.5s", check=False)
    assert "no daemon served" in first.stderr
    archive = out / "archive"
    archived = {path.name for path in archive.iterdir()} if archive.exists() else set()
    assert ("still open:" in first.stderr) == (len(archived) < 6), "how far it comes depends on the machine"
    second = figures(programs, 10, "--out", out, "--json")
    assert "still open" not in second.stderr
    answer = json.loads(second.stdout)
    assert [Path(path).name for path in answer["made"]] == ["fig10-tilt.png"]
    assert {entry["statement"] for entry in answer["statements"]} == {
        statement.id for statement in of_figures(["10"])}
    again = {path.name for path in (out / "archive").iterdir()}
    assert archived <= again and len(again) == 6
    # drawn again from the archive, on a machine that never ran anything
    drawn = figures(programs, 10, "--draw-only", "--archive", out / "archive", "--out", tmp_path / "again", "--format",
                    "pdf", "--width", "89mm")
    assert (tmp_path / "again" / "fig10-tilt.pdf").read_bytes()[:4] == b"%PDF" and "fig10" in drawn.stdout
    table = (out / "fig10-tilt.csv").read_text()
    assert "n_z" in table and len(table.splitlines()) > 50
    third = figures(programs, 10, "--out", out)
    assert "runs, about" not in third.stderr, "what is archived is not done again"


def test_what_it_would_cost_and_what_there_is(programs):
    plan = json.loads(figures(programs, 10, "--dry-run", "--json").stdout)
    assert plan["runs"] == plan["missing"] == 6 and plan["sets"][0]["set"] == "mechanism"
    listed = json.loads(figures(programs, "--list", "--json").stdout)
    assert [entry["number"] for entry in listed][:13] == [str(k) for k in range(2, 15)]


def test_the_shell_completes_what_there_is():
    asked = (f'source <({PROGRAMS}/shaken completion bash); PATH={PROGRAMS}:$PATH; COMP_WORDS=(shaken figures ""); '
             "COMP_CWORD=2; _shaken; echo ${COMPREPLY[@]}")
    offered = subprocess.run(["bash", "-c", asked], capture_output=True, text=True, timeout=60).stdout.split()
    assert offered == [figure.number for figure in FIGURES if figure.number] + [figure.name for figure in FIGURES]


def test_a_reader_that_goes_away_is_no_trouble(programs):
    command = f"{sys.executable} {SOURCE}/python/shaken/study/__main__.py --list | true"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=60)
    assert done.stderr == ""


def test_a_plan_for_a_computing_centre(programs, tmp_path):
    figures(programs, 10, "--executor", "slurm", "--partition", "long", "--time", "4h", "--cores", 8, "--plan",
            tmp_path / "plan.md")
    text = (tmp_path / "plan.md").read_text()
    assert re.search(r"\| mechanism \| 6 \| \d+ \| [0-9.]+ \|", text) and "on 8 cores" in text
    sweep = json.loads((tmp_path / "plan-sweeps" / "mechanism.json").read_text())
    assert sweep["executor"] == "slurm" and sweep["slurm"] == {"partition": "long", "time": "4h"}


@pytest.mark.parametrize("words, said", [
    (["99"], "no such figure: 99"), (["--format", "jpg"], "png, pdf or svg"), (["--width", "wide"], "--width takes"),
    (["--budget", "3q"], "is no time"), (["--plan", "p.md"], "--plan is for Slurm"), (["--memory", "2G"], "for Slurm"),
    (["--report", "nowhere.md"], "no such file"), (["--draw-only", "--dry-run"], "exclude each other"),
    (["--draw-only", "--collect"], "exclude each other"),
    (["--scale", "huge"], "tiny, desk, paper"), (["--width", "5mm"], "from 40mm"),
    (["--configs", "nowhere", "--dry-run"], "nowhere has no sweeps of the figures"),
    (["--archive", "nowhere", "--draw-only"], "nowhere is none")])
def test_bad_options_are_refused_before_anything_runs(programs, words, said):
    done = figures(programs, *words, check=False)
    assert done.returncode == 2 and said in done.stderr
    assert not (programs.root / "runs").exists()


def test_an_empty_archive_is_said_to_be_one(programs, tmp_path):
    done = figures(programs, "--draw-only", "--archive", tmp_path, check=False)
    assert done.returncode == 1 and "nothing to draw" in done.stderr


def test_runs_are_archived_as_those_of_the_sets_that_ask_for_them(tmp_path):
    run = made_up_run(tmp_path / "run")
    id_ = json.loads((run / "summary.json").read_text())["run_id"]
    job = {"id": id_, "state": "done", "parameters": {}, "directory": str(run)}
    daemon = SimpleNamespace(sweeps=lambda: [{"id": "s1", "name": "part-desk"}], jobs=lambda _: [job])
    for k, (known, sweeps) in enumerate((({id_: ["strip-desk"]}, ["strip-desk"]), ({}, ["part-desk"]))):
        assert len(running.collect(daemon, tmp_path / str(k), known)) == 1
        assert next(archived_runs(tmp_path / str(k))).sweeps == sweeps


def test_a_figure_without_runs_is_said_to_have_none(programs, tmp_path):
    add_run(made_up_run(tmp_path / "run"), tmp_path / "archive", sweeps=["mechanism-tiny"])
    done = figures(programs, 4, "--draw-only", "--archive", tmp_path / "archive", "--out", tmp_path / "out",
                   check=False)
    assert done.returncode == 1 and "no runs of these figures" in done.stderr


def test_a_full_disk_is_told_in_a_line(programs):
    command = f"{sys.executable} {SOURCE}/python/shaken/study/__main__.py --list > /dev/full"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and done.stderr == "shaken: [Errno 28] No space left on device\n"


def test_every_set_has_its_sweep_at_every_scale(programs):
    folder = SOURCE / "configs" / "figures" / "desk"
    names = {name for _, name in sets.ORDER}
    assert {path.stem for path in folder.iterdir()} == names
    assert {name for figure in FIGURES for name in figure.sets} <= names
    for scale in sets.SCALES.values():
        for name, sweep in sets.sweeps(folder, scale):
            file = programs.root / "sweep.json"
            file.write_text(json.dumps(sweep))
            assert sweep["name"] == f"{name}-{scale.name}"
            programs.shaken("validate", file)


@pytest.mark.parametrize("scale", [pytest.param("desk", marks=night), "tiny"])
def test_what_is_missing_is_what_is_submitted(programs, tmp_path, scale):
    program = str(PROGRAMS / "shaken")
    every = running.Plan(program, sets.sweeps(SOURCE / "configs" / "figures" / "desk", sets.SCALES[scale]), tmp_path)
    assert len({point.set for point in every.missing}) == len(sets.ORDER)
    for name in every.sweeps:
        submitted = [point["id"] for point in running.points_of(program, every.sweep_of_missing(name))]
        assert sorted(submitted) == sorted(point.id for point in every.missing if point.set == name)
    every.missing = [point for point in every.missing if point.id == every.missing[-1].id
                     or (point.set == "fluid-start" and point.parameters["stage"] == 2
                         and point.parameters["rods.end_diameter"] == 0.5)]
    chains = running.points_of(program, every.sweep_of_missing("fluid-start"))
    assert {point.id for point in every.missing if point.set == "fluid-start"} < {point["id"] for point in chains}
    assert {point["parameters"]["rods.end_diameter"] for point in chains} == {0.5}, "what lacks nothing is not run anew"
    assert len(running.points_of(program, every.sweep_of_missing("movies"))) == 1


class DaemonOfAFailure:
    """One whose first stage fails, so that the stages after it are held."""

    def __init__(self, plan):
        self.points = [point for point in plan.missing if point.set == "strip"][-6:]

    def submit(self, sweep, **terms):
        return "s1"

    def ask(self, method, path):
        return {}

    def jobs(self, sweep):
        states = ["failed", "held", "cancelled", "held", "held", "failed"]
        before = [None, self.points[0].id, None, self.points[2].id, self.points[3].id, None]
        return [{"id": point.id, "state": state, "ended": JOB_STATES[state]["has_ended"], "label": "",
                 "starts_from": start, "wall_s": 0, "reason": "lost"}
                for point, state, start in zip(self.points, states, before)]


def test_a_chain_that_is_broken_is_reported_and_ends_the_study(programs, tmp_path):
    folder = SOURCE / "configs" / "figures" / "desk"
    plan = running.Plan(str(PROGRAMS / "shaken"), sets.sweeps(folder, sets.SCALES["tiny"], ["strip"]), tmp_path)
    lines = running.run_plan(plan, DaemonOfAFailure(plan), say=lambda line: None, every=0.01)
    assert len(lines) == 6 and sum(": held: lost" in line for line in lines) == 3


def test_a_finished_run_is_archived_once_however_long_the_others_take(monkeypatch):
    points = [SimpleNamespace(set="one", id=id_, cost=60.0) for id_ in ("a", "b")]
    plan = SimpleNamespace(sweeps={"one": {}}, missing=points, archive=Path("archive"), cost=lambda name=None: 120.0,
                           sweep_of_missing=lambda name: {"name": name})
    polls = [[("done", 5), ("running", 0)]] * 3 + [[("done", 9), ("done", 7)]]  # the first goes on, and ends once more

    def jobs(sweep):
        states = polls.pop(0)
        return [{"id": id_, "state": state, "ended": JOB_STATES[state]["has_ended"], "finished_utime": end, "label": "",
                 "starts_from": None, "wall_s": 0, "reason": ""} for id_, (state, end) in zip("ab", states)]

    read = []
    monkeypatch.setattr(running, "archive_job",
                        lambda job, name, archive: read.append((job["id"], job["finished_utime"])))
    daemon = SimpleNamespace(jobs=jobs, submit=lambda sweep, **terms: "s1", ask=lambda method, path: {})
    said: list[str] = []
    assert running.run_plan(plan, daemon, say=said.append, every=0.0) == []
    assert "one: 2 runs, about 0.03 CPU-h" in said
    assert read == [("a", 5), ("a", 9), ("b", 7)]


def test_damaged_files_of_a_run_are_reported_and_the_others_go_on(monkeypatch):
    plan = SimpleNamespace(sweeps={"one": {}}, missing=[SimpleNamespace(set="one", id=id_, cost=60.0) for id_ in "ab"],
                           archive=Path("archive"), cost=lambda name=None: 120.0,
                           sweep_of_missing=lambda name: {"name": name})
    jobs = [{"id": id_, "state": "done", "ended": True, "finished_utime": 5, "label": "", "starts_from": None,
             "wall_s": 0, "reason": ""} for id_ in "ab"]

    def archive_job(job, name, archive):
        if job["id"] == "a":
            raise ShakenError("observables.h5 is damaged")

    monkeypatch.setattr(running, "archive_job", archive_job)
    daemon = SimpleNamespace(jobs=lambda sweep: jobs, submit=lambda sweep, **terms: "s1", ask=lambda method, path: {})
    assert running.run_plan(plan, daemon, say=lambda line: None, every=0.0) == ["a one : observables.h5 is damaged"]


def wait_until(fits, seconds=30):
    end = time.monotonic() + seconds
    while not fits():
        assert time.monotonic() < end, "in vain"
        time.sleep(0.05)


@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_nothing_is_left_behind_by_a_process_that_is_killed(tmp_path, how):
    script = tmp_path / "script.py"
    script.write_text("""
import subprocess, sys, time
from shaken.system import ends_with_us, scratch_folder
with scratch_folder("shaken-test-") as folder:
    (folder / "file").write_text("text")
    child = subprocess.Popen(["sleep", "600"], preexec_fn=ends_with_us)
    print(folder, child.pid, flush=True)
    time.sleep(600)
""")
    killed = subprocess.Popen([sys.executable, script], stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "PYTHONPATH": str(SOURCE / "python")})
    folder, child = killed.stdout.readline().split()
    assert (Path(folder) / "file").exists() and Path(f"/proc/{child}").exists()
    killed.send_signal(how)
    killed.wait(30)
    killed.stdout.close()
    wait_until(lambda: not Path(folder).exists())
    wait_until(lambda: not Path(f"/proc/{child}/exe").exists())


def test_a_daemon_of_our_own_ends_with_us_however_we_do(programs):
    script = programs.root / "script.py"
    script.write_text(f"""
import time
from pathlib import Path
from shaken.study import running
with running.daemon_at(Path("{programs.root}"), "{PROGRAMS / 'shaken'}") as daemon:
    time.sleep(600)
""")
    killed = subprocess.Popen([sys.executable, "-u", script], stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "PYTHONPATH": str(SOURCE / "python")})
    assert "one has been started" in killed.stdout.readline()
    pid = Daemon(programs.root).status()["pid"]
    killed.kill()
    killed.wait(30)
    killed.stdout.close()
    wait_until(lambda: not Path(f"/proc/{pid}/exe").exists())


def test_an_error_beside_a_daemon_is_reported_as_it_is(programs, tmp_path):
    said = []
    for _ in range(2):
        with pytest.raises(ShakenError, match="^no such point$"):
            with running.daemon_at(tmp_path, str(PROGRAMS / "shaken"), said.append):
                with running.daemon_at(tmp_path, str(PROGRAMS / "shaken"), said.append):
                    raise ShakenError("no such point")
    assert len(said) == 2 and all("one has been started" in line for line in said)


def test_what_different_physics_computed_is_never_averaged(tmp_path):
    for name, physics, packing, order in (("a", 3, 0.5, 0.2), ("b", 4, 0.5, 0.6), ("c", 4, 0.5, 0.8),
                                          ("d", 3, 0.6, 0.9)):
        add_run(made_up_run(tmp_path / name, run_id=name * 16, order=order, version=("0.1.0", physics)),
                tmp_path / "archive", {"rods.area_fraction": packing}, ["long-rods-desk"])
    evidence = Evidence(archived_runs(tmp_path / "archive"))
    assert [run.id[0] for run in evidence["long-rods"]] == ["b", "c", "d"]
    assert evidence["long-rods"].at(packing=0.5).number("S").value == pytest.approx(0.7)


def test_numbers_of_rods_grow_with_the_boxes():
    def scaled(scale, name):
        return sets.scaled(sets.sweep_file(SOURCE / "configs" / "figures" / "desk", name), sets.SCALES[scale])

    fluid = scaled("paper", "fluid-start")["sweep"][0]
    assert fluid["zip"] == {"rods.end_diameter": [0.4, 0.5, 0.6], "rods.count": [2704, 2484, 2292]}
    assert fluid["stages"][1] == {"rods.area_fraction": [0.85], "time.steady": ["360 s"], "time.measure": ["840 s"]}
    strip = scaled("paper", "strip")
    assert strip["name"] == "strip-paper"
    assert strip["scene"]["box"] == {"side": "42 mm", "aspect": 6}, "as wide as the paper's box is large"
    assert strip["sweep"][1]["zip"]["rods.count"] == [4 * n for n in (1159, 1021, 902)]
    tiny = scaled("tiny", "strip")
    assert tiny["scene"]["box"]["side"] == "16.5 mm"
    assert tiny["sweep"][1]["zip"]["rods.count"] == [round(n * (16.5 / 21) ** 2) for n in (1159, 1021, 902)]


def test_every_statement_belongs_to_a_figure():
    words = {word for figure in FIGURES for word in (figure.number, figure.name) if word}
    assert {statement.figure for statement in STATEMENTS} <= words


def test_sections_are_replaced_between_their_marks():
    document = "a\n<!-- claims: begin -->\nold\n<!-- claims: end -->\nb\n"
    known = {"claims": lambda: "new\n", "origin": lambda: 1 / 0}  # what a page does not ask for is not made
    assert with_sections(document, known) == "a\n<!-- claims: begin -->\nnew\n<!-- claims: end -->\nb\n"
    with pytest.raises(ShakenError, match="no marks.*claims, origin"):
        with_sections("a\nb\n", known)
    with pytest.raises(ShakenError, match="'verdicts', which is no section"):
        with_sections(document + "<!-- verdicts: begin --><!-- verdicts: end -->", known)
    with pytest.raises(ShakenError, match="lacks one of <!-- claims: begin"):
        with_sections("<!-- claims: end -->", known)


def test_every_mark_of_the_pages_is_a_section():
    known = sections(Evidence([]))
    pages = [str(path.relative_to(SOURCE)) for path in (SOURCE / "docs" / "validation").iterdir()]
    for page in ("docs/validation.md", "docs/accuracy.md", "docs/findings.md", *pages):
        text = (SOURCE / page).read_text()
        again = with_sections(text, {name: lambda: "" for name in known}, page)
        assert again != text, f"{page} has sections that are drawn"


def _timed_run(step: float, numbers: dict[str, Estimate], cpu: float = 3600.0, time: float = 100.0) -> SimpleNamespace:
    keys = {"rods.length": 4.5, "rods.area_fraction": 0.75, "box.side": 33.492, "box.gap": 1.2, "plates.gamma": 7.0,
            "plates.frequency": 200.0, "time.step": step}
    return SimpleNamespace(id=f"{step}{sorted(numbers)}{cpu}", sweeps=["long-rods-desk"], key=keys.get, parameters=keys,
                           numbers=numbers, steady=True, summary={"cpu_seconds": cpu, "sim_seconds": time})


def test_the_two_steps_are_compared_and_priced():
    def order(value: float, error: float) -> dict[str, Estimate]:
        return {"S": Estimate(value, error, True), "diffusion_mm2_s": Estimate(2 * value, 2 * error, True)}

    found = ((0.88, 1800.0), (0.90, 3600.0), (0.92, 5400.0))  # S and CPU seconds
    desk = [_timed_run(16e-6, order(value, 0.02), cpu) for value, cpu in found]
    evidence = Evidence([*desk, _timed_run(4e-6, order(0.91, 0.01), 7200.0)])
    (pair,) = time_step.pairs(evidence)
    assert len(pair.desk) == 3 and len(pair.paper) == 1
    row = time_step.differences(evidence).splitlines()[2].split(" | ")
    assert row[:6] == ["| 4.5 mm", "0.75", "33.492 mm", "1.2 mm", "7", "3 + 1"]
    # errors: of three means 0.0115 (their scatter 0.02 / sqrt 3, and what they know themselves), and 0.01
    assert row[6] == "−0.010 ± 0.015" and row[7] == "−1.1 ± 1.7 %"
    # an hour with an error of 0.02 for one of 0.005: 16 hours; at the finer step 2 h x (0.01 / 0.005)^2
    row = time_step.prices(evidence).splitlines()[2].split(" | ")
    assert row[6:10] == ["16.0", "8", "–", "–"]
    # D: (0.04 / (0.05 x 1.8))^2 h and so on
    hours = [cpu / 3600 * (0.04 / (0.05 * 2 * value)) ** 2 for value, cpu in found]
    assert row[10] == f"{sum(hours) / 3:.2g}"
    # the same trajectory counts once, as many controls as runs are still controls, and other rods are other rods
    twin, control, beads = desk[0], _timed_run(4e-6, order(0.91, 0.01), 7200.0), _timed_run(16e-6, order(0.5, 0.02))
    again = SimpleNamespace(**{**vars(twin), "id": "again", "sweeps": ["short-step-desk"]})
    for run in (twin, again):
        run.summary["state_hash"] = "0123456789abcdef"
    control.sweeps = ["short-step-desk"]
    beads.key = {**beads.parameters, "rods.inertia": "beads"}.get
    (pair,) = time_step.pairs(Evidence([*desk, again, control, beads]))
    assert len(pair.desk) == 3 and len(pair.paper) == 1
    assert time_step.layered(Evidence([*desk, beads])) == [], "scenes with and without a newer key have an order"
    # a run of another length is not compared
    other = Evidence([_timed_run(16e-6, order(0.9, 0.02), time=50.0), _timed_run(4e-6, order(0.9, 0.02))])
    assert time_step.pairs(other) == []


def test_every_figure_is_completed_by_the_shell():
    source = (SOURCE / "client" / "verbs" / "figures.cpp").read_text()
    words = "".join(source.split("kFigures =")[1].split(";")[0].replace('"', " ").split()).split("|")
    assert words == [f.number for f in FIGURES if f.number] + [f.name for f in FIGURES]


def test_defects_are_found_where_they_are_in_a_box_of_any_shape():
    # rods on a grid whose director turns by half a turn around two places, and back around two others: in a strip
    x, y = (grid.ravel() for grid in np.meshgrid(np.arange(0.25, 20, 0.5), np.arange(0.25, 60, 0.5)))
    cores = {(5.0, 10.0): 0.5, (15.0, 50.0): 0.5, (15.0, 10.0): -0.5, (5.0, 50.0): -0.5}
    theta = sum(charge * np.arctan2(y - b - 60 * j, x - a - 20 * i) for (a, b), charge in cores.items()
                for i in range(-3, 4) for j in range(-3, 4))
    strip = Snapshot(0.0, np.column_stack([x, y]), theta, np.array([20.0, 60.0]))
    found = defects_of(strip, 1.0)
    assert len(found) == 4
    for (a, b), charge in cores.items():
        [nearest] = [row for row in found if np.hypot(row[0] - a, row[1] - b) < 1]
        assert nearest[2] == charge


@pytest.mark.skipif(not (PROGRAMS / "shaken").exists(), reason="no programs")
def test_the_client_hands_on_figures_and_what_was_given(tmp_path):
    def listed(*arguments):
        done = subprocess.run([PROGRAMS / "shaken", "figures", "--list", *arguments], cwd=tmp_path, text=True,
                              capture_output=True, check=False)
        return done.stdout or done.stderr

    assert "Mean order" in listed("3") and "MSD" not in listed("3") and listed("3", "tilt") == listed("--", "3", "tilt")
    assert listed("3", "--scale", "", "--archive", "", "--json=false") == listed("3")
    assert listed("--report=a", "--report=b", "x").count("there is no such file") == 2
    assert listed("--cores=x") == "shaken: --cores: invalid int value: 'x'\n"
