"""`shaken results`: one line of numbers per job, or per point."""
import argparse
import json
import math
import sys
from typing import Sequence

from ..catalogue import STEADINESS
from ..daemon import Daemon
from ..errors import ShakenError
from ..rows import Row, aggregated, axes_of, field_names, has_several_versions, resolved, short_name, swept, target_of
from ..text import Column, csv_line, in_yellow, json_text, number_text, printable, table, terminal_width, value_text
from ..units import unit_of
from .conditions import read, selected

#: Title with its unit, field and rank of what the table on a terminal shows of a summary, or of replicas.
_COLUMNS = tuple((f"{title} {unit_of(name)}".removesuffix(" 1"), name, rank) for title, name, rank in (
    ("REPLICAS", "n_replicas", 4), ("DONE", "n_done", 3), ("N", "n_rods", 3), ("S", "order.mean", 0),
    ("SEM", "order.sem", 1), ("STD", "order.std", 5), ("N_EFF", "order.n_effective", 4),
    ("THETA_M", "measured.theta_m_deg.value", 2), ("SEM", "measured.theta_m_deg.sem", 2), ("TAU", "order.tau_s", 8),
    ("STEADY", "order.t_steady_s", 6), ("SIM", "sim_seconds", 6), ("CPU", "cpu_seconds", 7),
    ("ROD-S/CPU-S", "rod_seconds_per_cpu_second", 9), ("OVERLAP", "max_overlap_mm", 10)))
#: Of those, what is shown of single runs only.
_OF_RUNS = ("order.t_steady_s", "rod_seconds_per_cpu_second", "max_overlap_mm")


def _chosen(rows: Sequence[Row], words: str) -> list[str]:
    """The fields that --columns names. Raises ShakenError with all that no row has."""
    found, problems = [], []
    for word in filter(None, words.split(",") if rows else []):
        try:
            found.append(resolved(rows, word))
        except ShakenError as problem:
            problems.append(str(problem))
    if problems:
        raise ShakenError("\n".join([*problems, "--csv shows all names"]))
    return found


def _shown(rows: Sequence[Row], aggregate: bool) -> list[tuple[str, str, int]]:
    """Title, field and rank of the columns without --columns."""
    found: list[tuple[str, str, int]] = []
    if not aggregate:
        found = [("JOB", "job", 0), ("STATE", "state", 3 if all(row.state == "done" for row in rows) else 0)]
    found += [(path, path, 0) for path in swept(row.parameters for row in rows)]
    if has_several_versions(rows):
        found += [("SHAKEN", "versions.shaken", 0), ("PHYSICS", "versions.physics", 0)]
    if any(row.number("replica") > 1 for row in rows):
        found.append(("REPLICA", "replica", 1))
    return [(title, name, rank) for title, name, rank in (*found, *_COLUMNS)
            if not (aggregate and name in _OF_RUNS)
            and any(row.fields.get(name) is not None or (rank == 0 and name in row.fields) for row in rows)]


def _cell(row: Row, name: str) -> str:
    value = row.fields.get(name)
    if name == "job":
        return value_text(value)[:8]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return value_text(value)
    steady = row.steady(name)
    text = STEADINESS[steady]["mark"] + number_text(value)
    if name + ":n" in row.fields:
        text += f" ({row.fields[name + ':n']})"
    return text if steady else in_yellow(text)


def _print_table(rows: Sequence[Row], options: argparse.Namespace) -> None:
    if not rows:
        print("No rows.")
        return
    columns = [(name, name, 0) for name in _chosen(rows, options.columns)] or _shown(rows, options.aggregate)
    text, left_out = table([Column(
        printable(title), [_cell(row, name) for row in rows],
        all(type(row.fields.get(name)) in (int, float, type(None)) for row in rows), rank)
        for title, name, rank in columns], terminal_width())
    print(text, end="")
    met = {row.steady(name) for row in rows for _, name, _ in columns}
    for steady, row in STEADINESS.items():
        if steady in met and row["mark"]:
            print(f"{in_yellow(row['mark'])} {row['word']}: {row['advice']}")
    if left_out:
        print(f"no room for {', '.join(left_out)} (--columns FIELD,... chooses, --csv has all)", file=sys.stderr)


def results(options: argparse.Namespace) -> None:
    if options.csv and options.json:
        raise ShakenError("--csv and --json exclude each other")
    conditions = read(options.where)
    target = target_of(Daemon(options.root), options.id)
    if options.aggregate and has_several_versions(target.rows):
        print("several versions computed these runs; each has means of its own (versions.shaken, versions.physics)",
              file=sys.stderr)
    rows = selected(target, conditions, options.aggregate)
    if options.json:
        print(json_text({"rows": [row.fields if options.aggregate else row.source for row in rows]}))
    elif options.csv:
        names = _chosen(rows, options.columns) or field_names(rows)
        lines = [list(map(printable, names)), *([value_text(row.fields.get(name)) for name in names] for row in rows)]
        print("".join(csv_line(line) for line in lines if names), end="")
    else:
        if not options.id:
            print(printable(target.title), file=sys.stderr)
        _print_table(rows, options)


def fields(options: argparse.Namespace) -> None:
    """What the shell may offer where a field is wanted: those of the newest sweep."""
    for name in field_names(target_of(Daemon(options.root), "").rows):
        print(short_name(printable(name)))


def inset(options: argparse.Namespace) -> None:
    """Prints {x, y, points: [[x, y, S]], here: [[x, y]]} by the first two numbers that are swept, for shaken-render; y
    is empty where there is one, and null what is not known."""
    rows = target_of(Daemon(options.root), options.id).rows
    axes = axes_of(rows)

    def place(row: Row, *more: str) -> list[float | None]:
        found = [row.number(name) for name in (*axes, *more)]
        known = [value if math.isfinite(value) else None for value in found]
        return known if len(axes) > 1 else [known[0], None, *known[1:]]

    of_jobs = {row.fields["job"]: row for row in rows}
    foreign = [job[:8] for job in options.job if job not in of_jobs]
    if foreign:
        raise ShakenError(f"job {foreign[0]} does not belong to sweep {options.id}")
    print(json.dumps({"x": axes[0], "y": axes[1] if len(axes) > 1 else "",
                      "points": [place(point, "order.mean") for point in aggregated(rows)],
                      "here": [place(of_jobs[job]) for job in options.job]}))
