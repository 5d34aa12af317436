"""`shaken figures`: runs what the figures need, archives it, draws, judges."""
import argparse
import math
import os
import sys
from pathlib import Path
from typing import Any, Sequence

from ..archive import archived_runs
from ..daemon import Daemon
from ..errors import ShakenError
from ..plots.style import inches
from ..program import BAD_INPUT, FAILED, OK, Options, failed, run
from ..text import json_text
from ..units import seconds
from . import running
from .figures import FIGURES, chosen, draw
from .evidence import Evidence
from .material import Figure
from .report import tally, write_report
from .sets import ORDER, SCALES, sweeps
from .statements import as_json, as_table, judged, of_figures


def parser() -> argparse.ArgumentParser:
    """The options that client/verbs/figures.cpp hands on, where they are described."""
    found = Options()
    found.add_argument("figures", nargs="*")
    found.add_argument("--scale", default="desk")
    found.add_argument("--format", default="png")
    found.add_argument("--width", default="183mm")
    found.add_argument("--cores", type=int, default=len(os.sched_getaffinity(0)))
    found.add_argument("--runs-per-task", type=int)
    for name in ("budget", "executor", "partition", "account", "time", "memory"):
        found.add_argument(f"--{name}")
    for name in ("archive", "out", "configs", "root", "plan"):
        found.add_argument(f"--{name}", type=Path)
    for name in ("list", "dry-run", "draw-only", "collect", "json", "yes"):
        found.add_argument(f"--{name}", action="store_true")
    found.add_argument("--slurm-option", action="append")
    found.add_argument("--report", type=Path, action="append", default=[])
    return found


#: Options that go into a sweep's "slurm"; --slurm-option is called "options" there.
_SLURM = ("partition", "account", "time", "memory", "runs_per_task", "slurm_option")


def sent(sweep: dict[str, Any], options: argparse.Namespace) -> dict[str, Any]:
    """The sweep with the executor that was asked for."""
    if options.executor is None:
        return sweep
    settings = {("options" if key == "slurm_option" else key): getattr(options, key) for key in _SLURM
                if getattr(options, key) is not None}
    return {**sweep, "executor": options.executor,
            **({"slurm": {**sweep.get("slurm", {}), **settings}} if options.executor == "slurm" and settings else {})}


def configs_folder(given: Path | None) -> Path:
    """The folder of the desk's sweeps: as given, that of the sources, or that of an installation."""
    if given:
        folder = given / "figures" / "desk" if (given / "figures" / "desk").is_dir() else given
        if not any(folder.glob("*.json")):
            raise ShakenError(f"{given} has no sweeps of the figures: give the folder that has configs/figures/desk")
        return folder
    # `shaken` says where they are; without it they are those of the sources
    place = Path(os.environ.get("SHAKEN_CONFIGS") or Path(__file__).resolve().parents[3] / "configs")
    if not (place / "figures" / "desk").is_dir():
        raise ShakenError(f"the sweeps of the figures are not here ({place}): name their folder with --configs")
    return place / "figures" / "desk"


def problems_of(options: argparse.Namespace) -> list[str]:
    """All that is wrong with the options, a line each."""
    found = []
    if options.scale not in SCALES:
        found.append(f"--scale takes {', '.join(SCALES)}, not '{options.scale}'")
    if options.format not in ("png", "pdf", "svg"):
        found.append(f"--format takes png, pdf or svg, not '{options.format}'")
    try:
        if not 40 <= 25.4 * inches(options.width) <= 500:
            found.append(f"--width takes 89mm, 120mm, 183mm or another from 40mm to 500mm, not '{options.width}'")
    except ValueError:
        found.append(f"--width takes 89mm, 120mm, 183mm or another, not '{options.width}'")
    found += [f"--draw-only and --{name} exclude each other" for name in ("dry-run", "plan", "collect")
              if options.draw_only and getattr(options, name.replace("-", "_"))]
    if options.executor not in (None, "local", "slurm"):
        found.append(f"--executor takes local or slurm, not '{options.executor}'")
    if options.executor != "slurm":
        found += [f"--{key.replace('_', '-')} is for Slurm: add --executor slurm" for key in (*_SLURM, "plan")
                  if getattr(options, key) is not None]
    if options.cores < 1:
        found.append("--cores must be at least 1")
    if options.budget is not None:
        try:
            if seconds(options.budget) <= 0:
                found.append("--budget must be above 0")
        except ShakenError as error:
            found.append(f"--budget: {error}")
    try:
        chosen(options.figures)
    except ShakenError as error:
        found.append(str(error))
    if not (options.draw_only or options.list):
        try:
            configs_folder(options.configs)
        except ShakenError as error:
            found.append(str(error))
    if options.archive and (options.archive.exists() or options.draw_only) and not options.archive.is_dir():
        found.append(f"--archive takes the folder of an archive, and {options.archive} is none")
    found += [f"{report}: there is no such file, whose marked sections could be written anew"
              for report in options.report if not report.is_file()]
    return found


def main(arguments: Sequence[str]) -> int:
    options = parser().parse_args(arguments)
    if problems := problems_of(options):
        return failed("\n".join(problems), BAD_INPUT, options.json)
    return run(_run, options, options.json, code=FAILED,
               interrupted="interrupted: jobs that are queued go on; the same command goes on from here")


def _run(options: argparse.Namespace) -> int:
    figures = chosen(options.figures)
    if options.list:
        return _list(figures, options)
    out = options.out or Path(f"figures-{options.scale}")
    archive = options.archive or out / "archive"
    failed: list[str] = []
    if not options.draw_only:
        names = {name for figure in figures for name in figure.sets}
        # of a whole study every set is run, also what no figure but a statement needs
        wanted = None if len(figures) == len(FIGURES) else [name for _, name in ORDER if name in names]
        program = running.program()
        all_sweeps = {name: sent(sweep, options) for name, sweep in
                      sweeps(configs_folder(options.configs), SCALES[options.scale], wanted)}
        if options.plan:
            drawing = f"shaken --root ROOT figures {' '.join(options.figures)} --scale {options.scale} --collect"
            print("\n".join(map(str, running.write_plan(options.plan, program, all_sweeps, options.cores, drawing))))
            return OK
        if options.collect:
            known = running.sweeps_of_points(program, all_sweeps.values())
            running.collect(Daemon(options.root), archive, known)
        plan = running.Plan(program, all_sweeps.items(), archive, None if options.dry_run else _say)
        if options.dry_run:
            print(json_text(_plan_json(plan)) if options.json else plan.table())
            return OK
        if plan.missing:
            if not _agreed(plan, options):
                print("nothing was started", file=sys.stderr)
                return FAILED
            failed += _run_plan(plan, program, out, options)
    evidence = Evidence(run for run in archived_runs(archive)
                      if any(name.endswith("-" + options.scale) for name in run.sweeps))
    if not evidence.sets:
        raise ShakenError(f"{archive} has no runs of scale {options.scale}: there is nothing to draw")
    if not any(evidence[name] for figure in figures for name in figure.sets):
        raise ShakenError(f"{archive} has no runs of these figures: there is nothing to draw")
    _draw(options, figures, evidence, out)
    return FAILED if failed else OK


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _run_plan(plan: running.Plan, program: str, out: Path, options: argparse.Namespace) -> list[str]:
    """Runs what is missing, and says what is still open. Returns what has failed."""
    budget = math.inf if options.budget is None else seconds(options.budget)
    with running.daemon_at(options.root, program, _say) as daemon:
        failed = running.run_plan(plan, daemon, budget, say=_say, films=out / "movies")
    for line in failed:
        _say(line)
    still = running.Plan(program, plan.sweeps.items(), plan.archive)
    if still.missing:
        _say(f"still open:\n{still.table()}")
    return failed


def _draw(options: argparse.Namespace, figures: list[Figure], evidence: Evidence, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    made = draw(figures, evidence, out, width=25.4 * inches(options.width), form=options.format,
                origin={"Software": "shaken figures"})
    found = judged(evidence, of_figures({figure.id for figure in figures} if options.figures else ()))
    (out / "statements.md").write_text(as_table(found))
    (out / "statements.json").write_text(json_text(as_json(found)) + "\n")
    for report in options.report:
        write_report(report, evidence)
    if options.json:
        print(json_text({"scale": options.scale, "made": list(map(str, made)), "statements": as_json(found)}))
    else:
        print("\n".join(map(str, [*made, out / "statements.md"])))
        if not options.figures:
            print(tally(found), end="")


def _list(figures: list[Figure], options: argparse.Namespace) -> int:
    if options.json:
        print(json_text([{"id": figure.id, "number": figure.number or None, "name": figure.name, "title": figure.title,
                          "sets": figure.sets} for figure in figures]))
        return OK
    wide = max(len(figure.name) for figure in figures)
    print(f"{'PAPER':5}  {'NAME':{wide}}  SHOWS")
    for figure in figures:
        print(f"{figure.number:5}  {figure.name:{wide}}  {figure.title}\n{'':5}  {'':{wide}}  sets: "
              f"{', '.join(figure.sets)}")
    return OK


def _plan_json(plan: running.Plan) -> dict[str, Any]:
    return {"runs": plan.n_points, "missing": len(plan.missing), "cpu_seconds": plan.cost(),
            "sets": [{"set": name, "missing": sum(point.set == name for point in plan.missing),
                      "cpu_seconds": plan.cost(name)} for name in plan.sweeps]}


def _agreed(plan: running.Plan, options: argparse.Namespace) -> bool:
    print(plan.table(), file=sys.stderr)
    if options.yes or not (sys.stdin.isatty() and sys.stderr.isatty()):
        return True
    print("start? [y/N] ", end="", file=sys.stderr, flush=True)
    return sys.stdin.readline().strip().lower() in ("y", "yes")
