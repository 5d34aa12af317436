# SPDX-License-Identifier: MIT
"""What the rows of `shaken-bench accuracy` come to: orders of convergence, biases, and how errors fall with time."""
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
#: Errors of S whose cost is told.
WANTED = (0.01, 0.001, 0.0001)
_FEWEST = 6   # stretches of time that scatter is taken from
_LONG = 5.0   # length of the stretches that c is taken from, in correlation times


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


def time_for(sem: float, c: float, tau: float) -> float:
    """Simulated time until the error of S is `sem` [s]."""
    return 2 * tau * (c / sem)**2


def error_of_order(row: Row, series: Sequence[Sequence[float]]) -> dict[str, Any]:
    """How the error of the mean of S falls with time: `series` is S(t) of each replica. "sem" is the scatter of means
    over stretches of time of lengths "stretch_s"; "c" of sem = c / sqrt(T / 2 tau) is from those of at least 5 tau,
    None without any: it is "std" if S(t) is one stationary process."""
    every, tau = row["every_s"], row["tau_s"]
    everything = np.concatenate([np.asarray(values, dtype=float) for values in series])
    std = float(np.std(everything, ddof=1))
    stretches, sems, errors = [], [], []
    length = 1
    while True:
        means = np.array([np.mean(values[k:k + length]) for values in series
                          for k in range(0, len(values) - length + 1, length)])
        if len(means) < _FEWEST:
            break
        stretches.append(every * length)
        sems.append(float(np.std(means, ddof=1)))
        errors.append(sems[-1] / math.sqrt(2 * (len(means) - 1)))
        length *= 2
    scale = np.sqrt(np.array(stretches) / (2 * tau)) if tau > 0 else np.zeros(len(stretches))
    counts = (np.array(stretches) >= _LONG * tau) & (np.array(sems) > 0) & (scale > 0)
    c = c_error = None
    if counts.any():
        of, of_error = (np.array(sems) * scale)[counts], (np.array(errors) * scale)[counts]
        c = float(np.average(of, weights=of_error**-2))
        # the stretches of different lengths are of the same series: the best of them says how well c is known
        c_error = float(of_error.min())
    cpu = {f"{sem:g}": time_for(sem, c or std, tau) * row["n_rods"] * row["cpu_s_per_rod_s"] for sem in WANTED}
    return {**row, "std": std, "c": c, "c_error": c_error, "stretch_s": stretches, "sem": sems, "sem_error": errors,
            "replica_scatter": float(np.std([np.mean(of) for of in series], ddof=1)) if len(series) > 1 else None,
            "expected_scatter": (c or std) / math.sqrt(row["measured_s"] / (2 * tau)) if tau > 0 else None,
            "cpu_s_for_sem": cpu}


def extrapolated(rows: Sequence[Row], large: Row) -> dict[str, Any] | None:
    """What was measured in small boxes, continued to a large one by power laws of the side; None where these do not
    hold, or from fewer than LEAST boxes."""
    sides = column(rows, "side_mm")
    std, tau = power_law(sides, column(rows, "std")), power_law(sides, column(rows, "tau_s"))
    if std is None or tau is None:
        return None
    cpu = rows[-1]["cpu_s_per_rod_s"] * large["n_rods"]
    times = {f"{sem:g}": time_for(sem, std.at(large["side_mm"]), tau.at(large["side_mm"])) for sem in WANTED}
    return {**large, "std_power": std.order, "std_power_error": std.order_error, "tau_power": tau.order,
            "tau_power_error": tau.order_error, "time_s_for_sem": times,
            "cpu_s_for_sem": {sem: time * cpu for sem, time in times.items()}}


def with_errors(report: Row) -> dict[str, Any]:
    """Each row with what its series comes to, and "extrapolated" to the paper's box."""
    rows = [error_of_order(row, series) for row, series in zip(report["rows"], report["series"])]
    return {**report, "rows": rows, "extrapolated": extrapolated(rows, report["paper_box"])}


#: "bench" of a report -> what adds the fits to it.
FITS: Mapping[str, Callable[[Row], dict[str, Any]]] = {
    "accuracy deterministic": with_orders, "accuracy statistical": with_biases, "accuracy error": with_errors}


def fitted(report: Row) -> Row:
    """The report with the fits that its figures and its verdict need."""
    fit = FITS.get(report.get("bench", ""))
    return fit(report) if fit is not None and report.get("rows") else report
