# SPDX-License-Identifier: MIT
"""What `shaken-bench accuracy` has found, in words and tables for a terminal."""
from __future__ import annotations

import math
from typing import Callable, Mapping, NamedTuple, Sequence

from . import accuracy
from .accuracy import ABOVE_FLOOR, BOUND, LEAST, LINEAR, NORMS, ON_LINE
from .rows import Row, number, series_of


def table(titles: Sequence[str], lines: Sequence[Sequence[str]], n_texts: int) -> str:
    """Aligned columns, of which the first are texts and the others numbers."""
    widths = [max(len(line[k]) for line in (titles, *lines)) for k in range(len(titles))]
    return "".join("  ".join(cell.ljust(width) if k < n_texts else cell.rjust(width)
                             for k, (cell, width) in enumerate(zip(line, widths))).rstrip() + "\n"
                   for line in (titles, *lines))


def _text(value: float | None, form: str) -> str:
    return "-" if value is None or not math.isfinite(value) else format(value, form)


class Column(NamedTuple):
    """A number of each row."""

    title: str
    path: str
    form: str
    factor: float = 1.0


def _numbers(row: Row, columns: Sequence[Column]) -> list[str]:
    return [_text(of.factor * number(row, of.path), of.form) for of in columns]


#: Of each step of a case.
_ERRORS = [Column("dt us", "dt_s", ".10g", 1e6), Column("position mm", "error/position/median", ".2e"),
           Column("lower", "error/position/lower", ".2e"), Column("upper", "error/position/upper", ".2e"),
           Column("director rad", "error/director/median", ".2e"), Column("energy", "error/energy/median", ".2e"),
           Column("scheduled us", "scheduled_cpu_s", ".4g", 1e6), Column("reference us", "reference_cpu_s", ".4g", 1e6),
           Column("ratio", "reference_over_scheduled", ".1f"), Column("trouble", "in_trouble", ".0f")]
#: Of each converged solution.
_CONVERGED = [Column("dt ns", "dt_s", ".4g", 1e9), Column("impulses", "impulses", ".4g"),
              *(Column(norm, f"error/{norm}/upper", ".2e") for norm in NORMS),
              *(Column(norm, f"from_first/{norm}/median", ".2e") for norm in NORMS)]


def _case_table(rows: Sequence[Row], columns: Sequence[Column], more: Mapping[str, str] | None = None) -> str:
    """With the columns `more` of yes and no."""
    more = more or {}
    return table(["case", "variant", *(of.title for of in columns), *more],
                 [[row["case"], row["variant"], *_numbers(row, columns),
                   *("yes" if row[member] else "NO" for member in more.values())] for row in rows], 2)


def _orders(report: Row) -> str:
    text = ("\nErrors against a converged solution at the end of each case: median over an ensemble of starts, and "
            "its\nquartiles for the position. CPU time of one start. Energy: kinetic, relative.\n" +
            _case_table(report["rows"], _ERRORS, {"same state": "states_equal"}) +
            "\nConverged solutions: their step, the impulses of one start, what one of twice that step is off by "
            "(upper\nquartile), and how far they are from that of the first variant (median).\n" +
            _case_table(report["converged"], _CONVERGED))
    lines = []
    for of in report["orders"]:
        lines.append([of["case"], of["variant"]])
        for norm in NORMS:
            law = of[norm]
            lines[-1] += [f"{law['order']:.2f} +- {law['order_error']:.2f}", str(law["points"])] if law else ["-", "-"]
    return (text + "\nOrder of convergence: slope of the median error in log-log, its standard error, and from how "
            f"many steps. The\nfinest {LEAST} steps count, then each next one while it stays within a factor "
            f"{ON_LINE:g} of the line; errors below {ABOVE_FLOOR:g}\ntimes what the converged solution is off by do "
            "not.\n" +
            table(["case", "variant", *(title for norm in NORMS for title in (norm, "of"))], lines, 2))


def _steps_below(rows: Sequence[Row], name: str) -> str:
    """"S: 8 us (16 us: open)": the last step up to which the bias is below the bound."""
    verdicts = [row[name]["verdict"] for row in rows]
    n = next((k for k, found in enumerate(verdicts) if found != "below"), len(rows))
    last = f"{rows[n - 1]['value']:g} us" if n else "none"
    return f"  {name}: {last}" + (f" ({rows[n]['value']:g} us: {verdicts[n]})" if n < len(rows) else "") + "\n"


_COST = [Column("CPU-s/rod-s", "cpu_s_per_rod_s", ".3g"), Column("overlap um", "max_overlap_mm", ".2f", 1e3)]


def _biases(report: Row) -> str:
    names, text = [of["name"] for of in report["observables"]], ""
    for rows in series_of(report["rows"], "length_mm", "variant", "knob"):
        first = rows[0]
        limits = {of["observable"]: of for of in report["limits"]
                  if (of["length_mm"], of["variant"]) == (first["length_mm"], first["variant"])}
        by_step = first["knob"] == "step"
        lines = [[f"{row['value']:g}", *(f"{100 * number(row, f'{name}/bias'):.2f} +- "
                                         f"{100 * number(row, f'{name}/bias_error'):.2f}" for name in names)]
                 for row in rows]
        if by_step:
            lines.append(["chi2/f", *(f"{limits[name]['chi_squared'] / limits[name]['freedom']:.1f}"
                                      if name in limits and limits[name]["freedom"] else "-" for name in names)])
        against = (f"of the limit dt -> 0, a line through the steps up to {LINEAR * first['value']:g} us\n(chi2 per "
                   "degree of freedom below); of impulses, in % of the first row" if by_step else "of the first row")
        knob = f"{first['knob']} {first['unit']}"
        means = [[f"{row['value']:g}", *_numbers(row, _COST),
                  *(f"{number(row, f'{name}/value'):.4g} +- {number(row, f'{name}/sem'):.1g}" for name in names)]
                 for row in rows]
        text += (f"\nl = {first['length_mm']:g} mm, phi = {first['area_fraction']:g}, L = {first['side_mm']:g} mm, "
                 f"N = {first['n_rods']}, {first['variant']}: {first['knob']}; {first['simulated_s']:g} s of each\n" +
                 table([knob, *(of.title for of in _COST),
                        *(f"{of['name']} {of['unit']}" for of in report["observables"])], means, 0) +
                 f"Bias in % {against}:\n" + table([knob, *names], lines, 0))
        if by_step and limits:
            text += (f"Largest step up to which the bias is below {100 * BOUND:g} % with two standard errors to spare "
                     "(and the next step):\n" + "".join(_steps_below(rows, name) for name in limits))
    return text


_WORDS: Mapping[str, Callable[[Row], str]] = {
    "accuracy deterministic": _orders, "accuracy statistical": _biases}


def verdict_text(report: Row) -> str:
    """Of the rows as shaken-bench writes them; empty for other benches."""
    words = _WORDS.get(report.get("bench", ""))
    return words(accuracy.fitted(report)) if words is not None and report.get("rows") else ""
