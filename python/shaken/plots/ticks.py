# SPDX-License-Identifier: MIT
"""Ticks: plain numbers as far as they are short, powers of ten beyond."""
from __future__ import annotations

import math
from typing import Any


def set_ticks(axes: Any, name: str) -> None:
    """Labels of an axis, once its limits are known."""
    from matplotlib import ticker
    axis = getattr(axes, f"{name}axis")
    low, high = getattr(axes, f"get_{name}lim")()
    if getattr(axes, f"get_{name}scale")() != "log":
        most = max(abs(low), abs(high))
        formatter = axis.get_major_formatter()
        if not 1e-3 < most < 1e5 and isinstance(formatter, ticker.ScalarFormatter):
            formatter.set_useMathText(True)  # ×10⁻⁶ at the end of the axis; plain numbers are drawn much faster without
        if isinstance(axis.get_major_locator(), ticker.AutoLocator):
            axis.set_major_locator(ticker.MaxNLocator("auto", steps=[1, 2, 5, 10]))
        return
    decades = math.log10(high / low)
    n_tens = math.floor(math.log10(high) + 1e-9) - math.ceil(math.log10(low) - 1e-9) + 1
    powers = high >= 1e5 or low < 1e-4 or decades > 5
    subs = (1.0,) if n_tens >= 3 else (1.0, 2.0, 5.0)
    if decades > 0.7:
        axis.set_major_locator(ticker.LogLocator(base=10, subs=subs, numticks=9 if n_tens >= 3 else 15))
    else:
        axis.set_major_locator(ticker.MaxNLocator(4, steps=[1, 2, 5, 10]))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: log_text(value, powers and len(subs) == 1)))
    axis.set_minor_locator(ticker.LogLocator(base=10, subs=range(1, 10), numticks=50))
    axis.set_minor_formatter(ticker.NullFormatter())


def log_text(value: float, power: bool) -> str:
    if value <= 0 or not math.isfinite(value):
        return ""
    if power:
        return rf"$10^{{{round(math.log10(value))}}}$"
    if 1e4 <= value < 1e7:
        return f"{value:,.0f}"
    return f"{value:.10g}" if 1e-5 < value < 1e7 else f"{value:.0e}"
