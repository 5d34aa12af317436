import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from shaken.estimate import Estimate, decimals, derived, exactly, replica_mean, student_factor
from shaken.plots.series import mean_curve


@pytest.mark.parametrize("n", [2, 3, 4, 6, 10, 30])
def test_student_factor_is_the_quantile_of_t(n):
    quantile = stats.t.ppf(stats.norm.cdf(1), n - 1)
    assert student_factor(n) == pytest.approx(quantile, rel=0.015 if n == 2 else 0.0015)


VECTORS = json.loads((Path(__file__).resolve().parents[2] / "tests/vectors/replica_mean.json").read_text())


@pytest.mark.parametrize("case", VECTORS, ids=lambda case: case["why"])
def test_means_of_numbers_and_of_curves_are_those_of_the_programs(case):
    """The C++ client and the page are held against the same."""
    errors = [math.nan if error is None else error for error in case["errors"]]
    error = math.nan if case["error"] is None else case["error"]
    found = replica_mean(Estimate(value, error) for value, error in zip(case["values"], errors))
    assert found.value == pytest.approx(case["mean"], abs=1e-14)
    assert found.error == pytest.approx(error, abs=1e-14, nan_ok=True)
    mean, of_curve = mean_curve([np.array([value, math.nan]) for value in case["values"]],
                                [np.array([error, math.nan]) for error in errors])
    assert mean[0] == pytest.approx(case["mean"], abs=1e-14) and math.isnan(mean[1])
    assert of_curve[0] == pytest.approx(error, abs=1e-14, nan_ok=True)


def test_the_drift_of_a_mean_is_that_of_independent_runs():
    found = replica_mean([Estimate(1.0, 0.1, True, drift=0.4, drift_error=0.3),
                          Estimate(1.0, 0.1, True, drift=-0.2, drift_error=0.4)])
    assert found.drift == pytest.approx(0.1) and found.drift_error == pytest.approx(0.25)
    assert math.isnan(replica_mean([Estimate(1.0, drift=0.4, drift_error=0.3), Estimate(1.0)]).drift)


def test_replicas_are_as_steady_as_the_least():
    steady, unknown, relaxing = (Estimate(1.0, 0.1, word) for word in (True, None, False))
    assert replica_mean([steady, steady]).steady is True
    assert replica_mean([steady, unknown]).steady is None
    assert replica_mean([steady, unknown, relaxing]).steady is False


def test_what_was_not_measured_is_left_out():
    assert replica_mean([Estimate(2.0, 0.1, True), Estimate()]).value == 2.0
    assert not replica_mean([Estimate(reason="one peak")]).is_known


def test_derived_adds_errors_in_quadrature():
    ratio = derived(2.0, [(1.0, Estimate(2.0, 0.3, True)), (-2.0, Estimate(1.0, 0.2, None))])
    assert ratio.error == pytest.approx(0.5) and ratio.steady is None
    assert exactly(3.0).error == 0 and exactly(3.0).steady is True


def test_an_estimate_is_computed_with_as_a_number():
    a, b = Estimate(2.0, 0.3, True, unit="mm"), Estimate(4.0, 0.4, None, unit="mm")
    for found, value, error, unit in (
            (a + b, 6, 0.5, "mm"), (a - b, -2, 0.5, "mm"), (a + 1, 3, 0.3, "mm"), (1 - a, -1, 0.3, "mm"),
            (1 + a, 3, 0.3, "mm"), (a - 1, 1, 0.3, "mm"), (-a, -2, 0.3, "mm"), (abs(-a), 2, 0.3, "mm"),
            (a * 3, 6, 0.9, "mm"), (3 * a, 6, 0.9, "mm"), (a / 2, 1, 0.15, "mm"),
            (a * b, 8, math.hypot(1.2, 0.8), None), (a / b, 0.5, math.hypot(0.075, 0.05), "1"),
            (1 / b, 0.25, 0.025, None),
            (a * Estimate(3.0, 0.0), 6, 0.9, "mm"), (a + Estimate(1.0, 0.4, unit="s"), 3, 0.5, None)):
        assert found.value == pytest.approx(value) and found.error == pytest.approx(error) and found.unit == unit
    assert (a + b).steady is None and (a + 1).steady is True
    inverse = 1 / Estimate(4.0, 0.4, drift=0.8, drift_error=0.2)
    assert (inverse.drift, inverse.drift_error) == pytest.approx((-0.05, 0.0125))
    assert a < b and b > 3 and a >= 2 and a <= 2 and sorted([b, a]) == [a, b]
    assert (f"{a:.3f}", round(a, 1), float(a), f"{a}") == ("2.000", 2.0, 2.0, str(a))
    assert [str(Estimate(2.0, 0.3, word)) for word in (True, False, None)] == ["2.0 ± 0.3", "~2.0 ± 0.3", "?2.0 ± 0.3"]


def test_degrees_of_freedom_are_those_of_the_error_that_counts():
    """Welch's: of two errors of three replicas each that are alike four; of one beside a smaller one its own."""
    few = replica_mean([Estimate(value) for value in (1.0, 2.0, 3.0)])
    assert few.dof == 2 and replica_mean([Estimate(1.0, 0.1), Estimate(3.0, 0.1)]).dof == math.inf
    assert derived(0.0, [(1.0, few), (-1.0, few)]).dof == pytest.approx(4)
    assert derived(0.0, [(1.0, few), (1.0, Estimate(1.0, 1e-4))]).dof == pytest.approx(2, rel=1e-3)
    assert few.with_further_error(1e-4).dof == pytest.approx(2, rel=1e-3)
    assert few.with_further_error(100.0).dof > 1e6 and few.with_further_error(3.0).error == pytest.approx(
        math.hypot(few.error, 3.0))


@pytest.mark.parametrize("error, digits", [(0.012, 3), (0.03, 2), (0.2, 1), (1.4, 1), (3.0, 0), (250.0, 0)])
def test_decimals_show_the_error(error, digits):
    assert decimals(error) == digits
    words = json.loads((Path(__file__).resolve().parents[2] / "tests/vectors/words.json").read_text())
    assert all(str(Estimate(value, error, True)) == text for value, error, text in words["value_text"])
    assert "±" in str(Estimate(1.0, error, True))
