# SPDX-License-Identifier: MIT
"""The rows that a command line asks for."""
from __future__ import annotations

import sys
from typing import Sequence

from .conditions import Condition, matching, names_in
from .rows import Row, Target, add_from_scenes, aggregated
from .text import printable


def selected(target: Target, conditions: Sequence[Condition], aggregate: bool) -> list[Row]:
    """The runs or the points for which the conditions hold. Conditions are on what is shown: with `aggregate` on
    means."""
    add_from_scenes(target, names_in(conditions))
    rows = aggregated(target.rows) if aggregate else target.rows
    # without any summary nobody knows which numbers there will be
    all_known = any(row.source.get("summary") for row in target.rows)
    kept, lacking = matching(rows, conditions, all_known)
    for name, n in lacking.items():
        print(f"{n} of {len(rows)} {'points' if aggregate else 'runs'} lack {printable(name)}: comparisons with it are "
              "false for them", file=sys.stderr)
    return kept
