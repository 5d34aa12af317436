# SPDX-License-Identifier: MIT
"""What the rows of `shaken-bench accuracy` come to: fits with known answers."""
from __future__ import annotations

import math

import numpy as np
import pytest

from shaken.plots import accuracy

_STEPS = np.array([1.0, 2, 4, 8, 16, 32])


def test_a_line_is_exact_on_a_line() -> None:
    line = accuracy.line_through([1, 2, 4, 8], [3.5, 4, 5, 7], [0.1, 0.2, 0.1, 0.3])
    assert line.at_zero == pytest.approx(3) and line.slope == pytest.approx(0.5)
    assert line.chi_squared == pytest.approx(0, abs=1e-20) and line.freedom == 2


def test_errors_of_a_line_are_those_of_two_points() -> None:
    # from y(1) +- 0.3 and y(3) +- 0.1: slope (y3 - y1) / 2, at zero (3 y1 - y3) / 2
    line = accuracy.line_through([1, 3], [10, 20], [0.3, 0.1])
    assert line.slope_error == pytest.approx(math.hypot(0.3, 0.1) / 2)
    assert line.at_zero == pytest.approx(5) and line.at_zero_error == pytest.approx(math.hypot(0.9, 0.1) / 2)


def test_a_line_weighs_by_errors() -> None:
    assert accuracy.line_through([1, 2, 3], [1, 2, 9], [1e-3, 1e-3, 1e3]).slope == pytest.approx(1)
    # the middle one is off by 1 error of an even line
    assert accuracy.line_through([0, 1, 2], [0, 3, 0], [1, 1, 1]).chi_squared == pytest.approx(6)


def test_a_bias_is_relative_to_the_truth_and_judged_with_two_errors_to_spare() -> None:
    bias, error = accuracy.relative_bias(1.1, 0.03, 1.0, 0.04)
    assert bias == pytest.approx(0.1) and error == pytest.approx(math.hypot(0.03, 1.1 * 0.04))
    biases = ((0.004, 0.002), (-0.004, 0.002), (-0.03, 0.002), (0, 0.006), (0.02, 0.006))
    assert [accuracy.verdict(*of) for of in biases] == ["below", "below", "above", "open", "open"]


def test_a_power_law_is_exact_for_a_power() -> None:
    for order in (1.0, 2.0, 0.5):
        law = accuracy.power_law(_STEPS, 3 * _STEPS**order)
        assert law is not None and law.points == 6
        assert law.order == pytest.approx(order) and law.coefficient == pytest.approx(3) and law.order_error < 1e-7


def test_the_error_of_an_order_is_the_standard_error_of_the_slope() -> None:
    # y = x +- 0.1 log 2, alternating, at x = 0 .. 3 log 2: slope 0.96, squares about the line 0.032, over two degrees
    # of freedom and the squares of x, 5
    law = accuracy.power_law([1, 2, 4, 8], np.exp2([0.1, 0.9, 2.1, 2.9]))
    assert law is not None and law.order == pytest.approx(0.96)
    assert law.order_error == pytest.approx(math.sqrt(0.032 / 2 / 5))


def test_a_power_law_leaves_out_what_is_not_asymptotic() -> None:
    law = accuracy.power_law(_STEPS, np.where(_STEPS <= 8, _STEPS, 10 + 1e-3 * _STEPS))  # saturates at 10
    assert law is not None and law.points == 4 and law.order == pytest.approx(1)


def test_a_power_law_leaves_out_what_the_converged_solution_cannot_tell() -> None:
    law = accuracy.power_law(_STEPS, _STEPS**2 + 1, floor=1)  # order 2 on top of the converged solution's own 1
    assert law is not None and (law.first, law.points) == (2, 4) and law.order == pytest.approx(2, abs=0.05)
    assert accuracy.power_law(_STEPS, _STEPS, floor=1) is None  # three steps left
    assert accuracy.power_law(_STEPS, 0 * _STEPS) is None and accuracy.power_law([], []) is None
