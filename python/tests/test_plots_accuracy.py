"""What the rows of `shaken-bench accuracy` come to: fits with known answers."""
from __future__ import annotations

import math

import numpy as np
import pytest

from shaken.plots import accuracy

_STEPS = np.array([1.0, 2, 4, 8, 16, 32])


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
