# SPDX-License-Identifier: MIT
"""What the rows of `shaken-bench accuracy` come to: orders of convergence, and biases."""
from __future__ import annotations

import math
from typing import Any, Callable, Mapping, NamedTuple, Sequence

import numpy as np

from .rows import Row, column, like, number, series_of

NORMS = ("position", "director", "energy")
#: The asymptotic part of a series of errors: steps whose error is at least ABOVE_FLOOR times what the converged
#: solution itself is off by; of these the LEAST finest, and each next one while its error stays within a factor ON_LINE
#: of the line through those before.
ABOVE_FLOOR, ON_LINE, LEAST = 8.0, 1.5, 4
#: A limit dt -> 0 is that of a straight line through the steps up to so many times the finest.
LINEAR = 8.0
#: Where a bias is settled.
BOUND = 0.01


class PowerLaw(NamedTuple):
    """y = coefficient x**order, through `points` from the index `first` on."""

    order: float
    order_error: float  # standard error, from the scatter about the line
    coefficient: float
    first: int
    points: int

    def at(self, x: float) -> float:
        return self.coefficient * x**self.order


class Line(NamedTuple):
    """at_zero + slope x, each with its standard error; chi_squared is about `freedom` if the line holds."""

    at_zero: float
    at_zero_error: float
    slope: float
    slope_error: float
    chi_squared: float
    freedom: int


def line_through(x: Sequence[float], y: Sequence[float], errors: Sequence[float]) -> Line:
    """By weighted least squares."""
    x, y, errors = (np.asarray(values, dtype=float) for values in (x, y, errors))
    design = np.column_stack([1 / errors, x / errors])
    covariance = np.linalg.inv(design.T @ design)
    found = covariance @ (design.T @ (y / errors))
    left = y / errors - design @ found
    return Line(found[0], math.sqrt(covariance[0, 0]), found[1], math.sqrt(covariance[1, 1]), float(left @ left),
                len(x) - 2)


def power_law(x: Sequence[float], y: Sequence[float], floor: float = 0.0) -> PowerLaw | None:
    """Through the asymptotic part of `y` at rising `x`; None if fewer than LEAST points count."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    counts = (y > 0) & (y >= ABOVE_FLOOR * floor)
    first = int(np.argmax(counts)) if counts.any() else len(y)
    if len(y) - first < LEAST or not (y[first:] > 0).all():
        return None

    def through(points: int) -> PowerLaw:
        log_x, log_y = np.log(x[first:first + points]), np.log(y[first:first + points])
        middle = log_x.mean()
        line = line_through(log_x - middle, log_y, np.ones(points))
        return PowerLaw(line.slope, line.slope_error * math.sqrt(line.chi_squared / line.freedom),
                        math.exp(line.at_zero - line.slope * middle), first, points)

    law = through(LEAST)
    for k in range(first + LEAST, len(y)):
        if abs(math.log(y[k] / law.at(x[k]))) > math.log(ON_LINE):
            break
        law = through(law.points + 1)
    return law


def relative_bias(value: float, error: float, truth: float, truth_error: float) -> tuple[float, float]:
    """(value - truth) / truth; the error is of both, taken as independent."""
    return value / truth - 1, math.hypot(error / truth, value / truth * truth_error / truth)


def verdict(bias: float, error: float, bound: float = BOUND) -> str:
    """"below" or "above" the bound with two standard errors to spare; "open" where these do not tell."""
    if abs(bias) + 2 * error < bound:
        return "below"
    return "above" if abs(bias) - 2 * error > bound else "open"


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


def with_biases(report: Row) -> dict[str, Any]:
    """"limits": the limit dt -> 0 of each observable. Rows get the "bias" of each relative to it; of impulses, and for
    other knobs than the step, relative to the first row."""
    rows, limits = [], []
    for series in series_of(report["rows"], "length_mm", "variant", "knob"):
        found = [dict(row) for row in series]
        for of in report["observables"]:
            name, first = of["name"], series[0]
            fine = [row for row in series if row["value"] <= LINEAR * first["value"] and number(row, f"{name}/sem") > 0]
            truth, truth_error = number(first, f"{name}/value"), number(first, f"{name}/sem")
            has_limit = first["knob"] == "step" and of["has_limit"] and len({row["value"] for row in fine}) > 1
            if has_limit:
                line = line_through(*(column(fine, path) for path in ("value", f"{name}/value", f"{name}/sem")))
                truth, truth_error = line.at_zero, line.at_zero_error
                limits.append({"length_mm": first["length_mm"], "variant": first["variant"], "observable": name,
                               **line._asdict()})
            for row, one in zip(series, found):
                bias, error = relative_bias(number(row, f"{name}/value"), number(row, f"{name}/sem"), truth,
                                            truth_error)
                if row is first and not has_limit:
                    bias, error = 0.0, 0.0  # the first value against itself is no measurement
                one[name] = {**row[name], "bias": bias, "bias_error": error, "verdict": verdict(bias, error)}
        rows += found
    return {**report, "rows": rows, "limits": limits}


#: "bench" of a report -> what adds the fits to it.
FITS: Mapping[str, Callable[[Row], dict[str, Any]]] = {
    "accuracy deterministic": with_orders, "accuracy statistical": with_biases}


def fitted(report: Row) -> Row:
    """The report with the fits that its figures and its verdict need."""
    fit = FITS.get(report.get("bench", ""))
    return fit(report) if fit is not None and report.get("rows") else report
