"""All that has a name in Shaken, as the programs know it (`shaken schema catalogue`): no list of it stands in Python.

UNITS:   unit -> {"of": what it measures, "scale": how many of the default unit it is}; that of scale 1 comes first
SYMBOLS: of units that names of arrays and numbers end in
KEYS:    key of a scene -> {"of", "unit", "range", "default", "title", "symbol", "doc"}
ARRAYS:  array of observables.h5 -> {"unit", "title", "symbol", "doc", "error": whether there is one of its standard
         errors, "axes": the arrays that it is measured at, the slowest first}
NUMBERS: number of summary.json -> {"unit", "title", "symbol", "doc", "observable"}
SUMMARY: key of summary.json -> {"doc", "if_null": why, of a number "unit", "title", "symbol", of a block "averages":
         which of its members are means over time}
JOB_STATES: state of a job, in the order of its life -> {"has_worker": whether one is at work on it, "has_ended":
         whether nothing more happens to it unless somebody asks, "has_failed": whether it ended by itself and is not
         done, "requests": what may be asked of it, "doc"}
STEADINESS: "steady" of summary.json (True, False, or None where it cannot be told) -> {"mark": before an average,
         "word", "advice": what it means for the average, and what to do}
"""
import json
from pathlib import Path
from typing import Any

_ALL: dict[str, dict[str, dict[str, Any]]] = json.loads(
    Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
UNITS, SYMBOLS, KEYS, ARRAYS, NUMBERS, SUMMARY, JOB_STATES = (
    _ALL[section] for section in ("units", "symbols_in_names", "keys", "arrays", "numbers", "summary", "job_states"))
STEADINESS: dict[bool | None, dict[str, str]] = {json.loads(flag): row for flag, row in _ALL["steadiness"].items()}
