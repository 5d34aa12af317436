"""Running the sets of the study on a daemon, within a budget, each finished run into the archive."""
import contextlib
import json
import math
import os
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator, Mapping

import numpy as np

from ..archive import add_run, archived_runs
from ..system import ends_with_us, output_of
from ..daemon import Daemon
from ..errors import ShakenError
from ..plots.series import grouped
from ..run import Run
from .rules import markdown

#: Wall time of one attempt, and of all attempts, of a run [s].
_SOFT_LIMIT, _TIME_LIMIT = 3 * 3600, 7 * 24 * 3600
#: Wall time for which a daemon may be away [s].
_MAY_BE_AWAY = 60.0
#: rod seconds per CPU second at these packings at 16 us, where nothing has been run yet.
_SPEED = ((0.45, 0.65, 0.75, 0.85), (860.0, 560.0, 420.0, 350.0))


@dataclass(frozen=True)
class Missing:
    """A point of a set that is not in the archive.

    part: which of the products of the set's sweep it is of, from 0
    cost: [CPU s], by the speed of the runs that are
    """

    set: str
    part: int
    id: str
    parameters: dict[str, Any]
    cost: float


def points_of(shaken: str, sweep: dict[str, Any]) -> list[dict[str, Any]]:
    """The points of a sweep as the program has them: id, parameters, replica, n_rods. `shaken` is the program."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(sweep, file)
        file.flush()
        return json.loads(output_of([shaken, "validate", file.name, "--json"], str(sweep.get("name"))))["points"]


def speed(runs: Iterable[Run], packing: float) -> float:
    """rod seconds per CPU second at a packing, at 16 us: of the runs at hand, or else of a table."""
    found = [(float(run.scene["rods"]["area_fraction"]),
              run.summary["rod_seconds_per_cpu_second"] * 1.6e-5 / run.scene["time"]["step"]) for run in runs]
    near = [value for at, value in found if abs(at - packing) < 0.03]
    return float(np.median(near)) if near else float(np.interp(packing, *_SPEED))


class Plan:
    """What is to be run: the sets' points that the archive does not have, in order of worth. Damaged files of the
    archive are errors, or are set aside (archived_runs)."""

    def __init__(self, shaken: str, sweeps: Iterable[tuple[str, dict[str, Any]]], archive: Path,
                 set_aside: Callable[[str], None] | None = None) -> None:
        self.archive = archive
        self.sweeps = dict(sweeps)
        have = {run.id: run for run in (archived_runs(archive, set_aside) if archive.is_dir() else ())}
        self.missing: list[Missing] = []
        self.order: dict[str, int] = {}  # id -> place of the run in its sweep
        self.n_points = 0
        for name, sweep in self.sweeps.items():
            points: dict[str, tuple[int, dict[str, Any]]] = {}
            for part, product in enumerate(sweep["sweep"]):
                for point in points_of(shaken, {**sweep, "sweep": product}):
                    points.setdefault(point["id"], (part, point))
            self.n_points += len(points)
            for place, (part, point) in enumerate(points.values()):
                self.order.setdefault(point["id"], place)
                seconds = float(point["sim_seconds"])
                run = have.get(point["id"])
                if run is not None and run.summary["sim_seconds"] >= seconds * (1 - 1e-9):
                    continue
                seed = point["parameters"].get("time.seed", sweep["scene"].get("time", {}).get("seed", 1))
                parameters = {**point["parameters"], "time.seed": int(seed) + int(point["replica"]) - 1}
                per = speed(have.values(), float(point["area_fraction"]))
                fine = 1.6e-5 / (seconds / int(point["ticks"]))
                self.missing.append(Missing(name, part, point["id"], parameters, int(point["n_rods"]) * seconds / per *
                                            (1 if fine < 1.5 else 1.7)))

    def sweep_of_missing(self, name: str) -> dict[str, Any]:
        """The sweep of what a set lacks: single runs, and chains of stages from their first stage on, for each stage
        begins where the one before has ended."""
        products = []
        for part, product in enumerate(self.sweeps[name]["sweep"]):
            stages = product.get("stages", [])
            of_stages = {"stage", *(key for stage in stages for key in stage)}
            entries: list[dict[str, Any]] = []
            for point in self.missing:
                swept = {**product.get("grid", {}), **product.get("zip", {})}
                entry = {**dict.fromkeys(swept), **point.parameters}  # null is no parameter
                entry = {key: value for key, value in entry.items() if key not in of_stages}
                if (point.set, point.part) == (name, part) and entry not in entries:
                    entries.append(entry)
            if entries:
                products.append({"list": entries, **({"stages": stages} if stages else {})})
        return {**self.sweeps[name], "sweep": products}

    def cost(self, name: str | None = None) -> float:
        """CPU seconds of what is missing; of one set if it is named."""
        return sum(point.cost for point in self.missing if name in (None, point.set))

    def table(self) -> str:
        """What is open and what it would cost, a line for each set."""
        lines = []
        for name in self.sweeps:
            n = sum(point.set == name for point in self.missing)
            if n:
                lines.append(f"{name:20} {n:4d} runs  {self.cost(name) / 3600:6.2f} CPU-h")
        lines.append(f"{'together':20} {len(self.missing):4d} of {self.n_points} runs  {self.cost() / 3600:.2f} CPU-h")
        return "\n".join(lines)


def two_digits(value: float) -> str:
    """A number with two digits: estimates know no more."""
    if value == 0:
        return "0"
    digits = 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, digits):,.{max(digits, 0)}f}"


def _hours(seconds: float) -> str:
    return f"{two_digits(seconds / 3600)} h" if seconds >= 3600 else f"{two_digits(seconds / 60)} min"


def write_plan(file: Path, program: str, sweeps: Mapping[str, dict[str, Any]], cores: int, drawing: str) -> list[Path]:
    """Writes the plan (Markdown) and, into the folder FILE-sweeps beside it, the sweeps. Returns what was written."""
    folder = file.with_name(file.stem + "-sweeps")
    folder.mkdir(parents=True, exist_ok=True)
    rows, written = [], []
    tasks = runs = 0
    core_hours = disk = memory = longest = 0.0
    for name, sweep in sweeps.items():
        path = folder / f"{name}.json"
        path.write_text(json.dumps(sweep, indent=2) + "\n")
        written.append(path)
        told = json.loads(output_of([program, "explain", str(path), "--executor", "slurm", "--cores", str(cores),
                                     "--json"], str(path)))  # after a short probe on this machine
        slurm = told["slurm"]
        runs, tasks = runs + told["n_runs"], tasks + slurm["n_tasks"]
        core_hours += slurm["core_hours"]
        disk += told["levels"][0]["disk_bytes"]
        memory = max(memory, float(told["memory_bytes"]))
        longest = max(longest, float(slurm["longest_run_s"]))
        rows.append([name, f"{told['n_runs']}", f"{slurm['n_tasks']}", two_digits(slurm['core_hours']),
                     _hours(slurm['longest_run_s']), f"{two_digits(told['memory_bytes'] / 1e6)} MB"])
    text = "# Plan: the figures of Sharma & Soni (2024) by Shaken\n\n" + markdown(
        ["set", "runs", "tasks", "core-hours", "longest run", "memory of a task"], rows) + f"""
- **Together** {runs} runs in {tasks} tasks of one core each, {two_digits(core_hours)} core-hours: about
  {_hours(max(longest, core_hours * 3600 / cores))} on {cores} cores.
- **Ask for**, of a task: {_hours(1.5 * longest)} of wall time and {two_digits(1.5 * memory / 1e6)} MB of memory, half
  as much again as estimated. A task that ends early costs another one only: runs go on from their checkpoint.
- **Storage**: {two_digits(disk / 1e9)} GB on a file system that all nodes see; about ten files a run.
- **Software**: Shaken (Debian package, or built with CMake and g++), Slurm, Python 3 with numpy, scipy, matplotlib and
  h5py to draw.
- **The daemon** lives on the login node meanwhile, and hands batches of tasks to Slurm; it takes hardly any CPU time.
- Estimates come from a probe of about a second of one run of each set, on the machine where this was written.

    shakend --root ROOT --executor slurm &
""" + "".join(f"    shaken --root ROOT submit {path.relative_to(file.parent)}\n"
              for path in written) + f"    {drawing}\n"
    file.write_text(text)
    return [file, *written]


def run_plan(plan: Plan, daemon: Daemon, budget: float = math.inf, *, say: Callable[[str], None] = print,
             films: Path | None = None, every: float = 1.0) -> list[str]:
    """Queues what is missing, set by set, and archives each run when it is done, until all is done or `budget` CPU
    seconds have been spent: what runs then is held at a checkpoint, and the same call goes on with it.

    The next set is queued when nothing of those before waits any more, so that the order of worth holds. Films are
    copied into `films` as S1.mp4, S2.mp4, ... in the order of their sweep. Returns what went wrong, a line for each job
    that has failed, or whose files are damaged.
    """
    began, now = dict[str, float](), dict[str, float]()  # wall time of jobs, which is CPU time: a worker has one thread
    waiting = [name for name in plan.sweeps if plan.cost(name) > 0]
    at_work: dict[str, str] = {}  # id of the sweep -> its name
    costs = {point.id: point.cost for point in plan.missing}
    archived: set[tuple[str, int]] = set()  # ids and ends of runs that need not be read again
    damaged: list[str] = []
    while True:
        jobs = {job["id"]: (job, name) for sweep, name in at_work.items() for job in daemon.jobs(sweep)}
        done = [id_ for id_, (job, _) in jobs.items() if job["state"] == "done" and id_ in costs]
        left = plan.cost() - sum(costs[id_] for id_ in done)
        for job, name in jobs.values():
            if job["state"] != "done" or (job["id"], job["finished_utime"]) in archived:
                continue
            archived.add((job["id"], job["finished_utime"]))
            try:
                path = archive_job(job, [name], plan.archive)
            except ShakenError as error:
                damaged.append(f"{job['id'][:8]} {name} {job['label']}: {error}")
                continue
            if path:
                say(f"{path.name[:8]}  {name}  {job['label']}  ({len(done)} of {len(costs)} runs, about "
                    f"{left / 3600:.2f} CPU-h left)")
                if films is not None:
                    _copy_film(job, plan, films)
        now |= {id_: float(job["wall_s"] or 0) for id_, (job, _) in jobs.items()}
        began = {**now, **began}  # when they were first seen here
        if sum(now.values()) - sum(began.values()) >= budget:
            for sweep in at_work:
                daemon.ask("POST", f"/v1/sweeps/{sweep}/hold")
            return damaged
        if waiting and not any(job["state"] == "queued" and not _waits_for_start(job, jobs)
                               for job, _ in jobs.values()):
            name = waiting.pop(0)
            missing = plan.sweep_of_missing(name)
            submitted = daemon.submit(missing, name=missing["name"], soft_limit_s=_SOFT_LIMIT, time_limit_s=_TIME_LIMIT)
            daemon.ask("POST", f"/v1/sweeps/{submitted}/resume")  # of what was held when a budget had ended
            at_work[submitted] = missing["name"]
            say(f"{missing['name']}: {sum(point.set == name for point in plan.missing)} runs, about "
                f"{plan.cost(name) / 3600:.2f} CPU-h")
            continue
        if not waiting and all(job["ended"] or job["state"] == "held" for job, _ in jobs.values()):
            return damaged + [f"{job['id'][:8]} {name} {job['label']}: {job['state']}: {job['reason']}"
                              for job, name in jobs.values() if job["state"] != "done"]
        time.sleep(every)


def _waits_for_start(job: dict[str, Any], jobs: dict[str, tuple[dict[str, Any], str]]) -> bool:
    """Whether a job starts from another of these that is not done, and so takes no place yet."""
    before = jobs.get(job["starts_from"] or "")
    return before is not None and before[0]["state"] != "done"


def _copy_film(job: dict[str, Any], plan: Plan, films: Path) -> None:
    film = Path(job["directory"]) / "movie.mp4"
    names = plan.order.get(job["id"])
    if film.exists() and names is not None:
        films.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(film, films / f"S{names + 1}.mp4")


def archive_job(job: dict[str, Any], sweeps: Iterable[str], archive: Path) -> Path | None:
    """Archives a job that is done, as a run of these sweeps; None where it is there already."""
    parameters = {path: value for path, value in job["parameters"].items() if path != "time.seed"}
    return add_run(job["directory"], archive, parameters, sweeps)


def sweeps_of_points(shaken: str, sweeps: Iterable[dict[str, Any]]) -> dict[str, list[str]]:
    """The names of the sweeps that ask for a run, by its id."""
    return dict(grouped((point["id"], sweep["name"]) for sweep in sweeps for point in points_of(shaken, sweep)))


def collect(daemon: Daemon, archive: Path, known: Mapping[str, list[str]]) -> list[Path]:
    """Archives every run of a daemon that is done: as one of the sweeps that ask for it (`known`, by its id), whatever
    it was submitted in; of others the sweep's own name."""
    written = []
    for sweep in daemon.sweeps():
        for job in daemon.jobs(sweep["id"]):
            sweeps = known.get(job["id"], [sweep["name"]])
            if job["state"] == "done" and (path := archive_job(job, sweeps, archive)):
                written.append(path)
    return written


def _is_served(daemon: Daemon) -> bool:
    try:
        daemon.status()
    except ShakenError:
        return False
    return True


@contextlib.contextmanager
def daemon_at(root: Path | None, shaken: str, say: Callable[[str], None] = print) -> Iterator[Daemon]:
    """The daemon of a root, for which requests wait while it is restarted; where none serves it, one of our own, which
    goes with us."""
    daemon = Daemon(root)
    patient = Daemon(root, patience=_MAY_BE_AWAY)
    if _is_served(daemon):
        yield patient
        return
    program_ = Path(shaken).with_name("shakend")
    daemon.root.mkdir(parents=True, exist_ok=True)
    ours = subprocess.Popen([str(program_), "--root", str(daemon.root), "--quiet", "--no-lcm"], start_new_session=True,
                            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                            preexec_fn=ends_with_us)
    try:
        end = time.monotonic() + 60
        while not _is_served(daemon):
            if ours.poll() is not None or time.monotonic() > end:
                words = ours.stderr.read().strip() if ours.stderr else ""
                raise ShakenError(f"no daemon could be started: {words}")
            time.sleep(0.1)
        say(f"no daemon served {daemon.root}: one has been started, which ends with this command")
        yield patient
    finally:
        ours.terminate()
        ours.wait(60)


def program() -> str:
    """The program `shaken`: beside the daemon, or on the path."""
    found = os.environ.get("SHAKEN_PROGRAM") or shutil.which("shaken")
    if not found:
        raise ShakenError("the program `shaken` is not on the path; set SHAKEN_PROGRAM to it")
    return found
