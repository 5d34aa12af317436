"""What the rows of `shaken-bench accuracy` come to: orders of convergence, also in words for a terminal."""
import math
from typing import Any, Mapping, NamedTuple, Sequence

import numpy as np
from numpy.typing import NDArray

from ..text import Column, table
from .series import grouped

#: A row of a report of shaken-bench.
Row = Mapping[str, Any]

NORMS = ("position", "director", "energy")
#: The asymptotic part of a series of errors: steps whose error is at least ABOVE_FLOOR times what the converged
#: solution itself is off by; of these the LEAST finest, and each next one while its error stays within a factor ON_LINE
#: of the line through those before.
ABOVE_FLOOR, ON_LINE, LEAST = 8.0, 1.5, 4


def number(row: Any, path: str) -> float:
    """The number at "scheduled/spread" in a row; NaN if there is none."""
    for part in path.split("/"):
        row = row.get(part) if isinstance(row, Mapping) else None
    return float(row) if isinstance(row, (int, float)) and not isinstance(row, bool) else math.nan


def column(rows: Sequence[Row], path: str, factor: float = 1.0) -> NDArray[Any]:
    return factor * np.array([number(row, path) for row in rows])


def series_of(rows: Sequence[Row], *members: str) -> list[list[Row]]:
    """Rows that are alike in some members, as one list each, in the order in which these begin."""
    return [alike for _, alike in grouped(([row.get(member) for member in members], row) for row in rows)]


def like(rows: Sequence[Row], row: Row, *members: str) -> Row | None:
    """The one of the rows that is like `row` in these members."""
    return next((other for other in rows if all(other.get(m) == row.get(m) for m in members)), None)


class PowerLaw(NamedTuple):
    """y = coefficient x**order, through `points` from the index `first` on."""

    order: float
    order_error: float  # standard error, from the scatter about the line
    coefficient: float
    first: int
    points: int

    def at(self, x: float) -> float:
        return self.coefficient * x**self.order


def power_law(x: Any, y: Any, floor: float = 0.0) -> PowerLaw | None:
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


def verdict_text(report: Row) -> str:
    """The orders that shaken-bench's rows come to, as a table for a terminal; empty for other benches."""
    if report.get("bench") != "accuracy" or not report.get("rows"):
        return ""
    orders = with_orders(report)["orders"]
    columns = [Column(name, [of[name] for of in orders]) for name in ("case", "variant")]
    for norm in NORMS:
        laws = [of[norm] for of in orders]
        columns += [Column(norm, [f"{law['order']:.2f} +- {law['order_error']:.2f}" if law else "-" for law in laws],
                           right=True),
                    Column("of", [str(law["points"]) if law else "-" for law in laws], right=True)]
    return ("\nOrder of convergence: slope of the median error in log-log, its standard error, and from how many "
            f"steps.\nThe finest {LEAST} steps count, then each next one while it stays within a factor {ON_LINE:g} of "
            f"the line;\nerrors below {ABOVE_FLOOR:g} times what the converged solution is off by do not.\n" +
            table(columns, 0)[0])
