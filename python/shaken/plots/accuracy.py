# SPDX-License-Identifier: MIT
"""What the rows of `shaken-bench accuracy` come to: orders of convergence, also in words for a terminal."""
from __future__ import annotations

import math
from typing import Any, Mapping, NamedTuple, Sequence

import numpy as np

from .rows import Row, column, like, number, series_of

NORMS = ("position", "director", "energy")
#: The asymptotic part of a series of errors: steps whose error is at least ABOVE_FLOOR times what the converged
#: solution itself is off by; of these the LEAST finest, and each next one while its error stays within a factor ON_LINE
#: of the line through those before.
ABOVE_FLOOR, ON_LINE, LEAST = 8.0, 1.5, 4


class PowerLaw(NamedTuple):
    """y = coefficient x**order, through `points` from the index `first` on."""

    order: float
    order_error: float  # standard error, from the scatter about the line
    coefficient: float
    first: int
    points: int

    def at(self, x: float) -> float:
        return self.coefficient * x**self.order


def power_law(x: Sequence[float], y: Sequence[float], floor: float = 0.0) -> PowerLaw | None:
    """Through the asymptotic part of `y` at rising `x`; None if fewer than LEAST points count."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    counts = (y > 0) & (y >= ABOVE_FLOOR * floor)
    first = int(np.argmax(counts)) if counts.any() else len(y)
    if len(y) - first < LEAST or not (y[first:] > 0).all():
        return None

    def through(points: int) -> PowerLaw:
        (order, at_one), covariance = np.polyfit(np.log(x[first:first + points]), np.log(y[first:first + points]), 1,
                                                 cov=True)
        return PowerLaw(order, math.sqrt(covariance[0, 0]), math.exp(at_one), first, points)

    law = through(LEAST)
    for k in range(first + LEAST, len(y)):
        if abs(math.log(y[k] / law.at(x[k]))) > math.log(ON_LINE):
            break
        law = through(law.points + 1)
    return law


def with_orders(report: Row) -> dict[str, Any]:
    """"orders": of each case, variant and norm the order of the medians, or None."""
    orders = []
    for rows in series_of(report["rows"], "case", "variant"):
        converged = like(report.get("converged", ()), rows[0], "case", "variant")
        order: dict[str, Any] = {"case": rows[0]["case"], "variant": rows[0]["variant"]}
        for norm in NORMS:
            floor = number(converged, f"error/{norm}/upper")
            law = power_law(column(rows, "dt_s"), column(rows, f"error/{norm}/median"),
                            floor if math.isfinite(floor) else 0.0)
            order[norm] = law and law._asdict()
        orders.append(order)
    return {**report, "orders": orders}


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


def verdict_text(report: Row) -> str:
    """What the rows come to, as shaken-bench writes them; empty for other benches."""
    if report.get("bench") != "accuracy" or not report.get("rows"):
        return ""
    report = with_orders(report)
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
