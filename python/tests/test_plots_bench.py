"""Pictures of what shaken-bench has measured: their data are those of the report, and nothing is cut."""
from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")
from figures_whole import assert_whole  # noqa: E402

from shaken.plots import accuracy, bench, names, style  # noqa: E402

_SCENE = {"length_mm": 4.5, "area_fraction": 0.75, "side_mm": 41.865, "n_rods": 1000}
_PHASES = ("surfaces", "detection", "response", "storing", "rod_bounds", "shortening", "pair_bounds", "neighbors")
_MACHINE = {"cpu": "made up", "cores": 2, "compiler": "none", "flags": "-O3"}


def _speed_rows() -> list[dict[str, Any]]:
    return [{**_SCENE, "area_fraction": phi, "scene": f"kind {phi}", "scheduled": {"rod_s_per_cpu_s": 1660.4 / phi},
             "reference": {"rod_s_per_cpu_s": 12.0}, "phase_shares": {**dict.fromkeys(_PHASES, 0.11), "other": 0.12}}
            for phi in (0.45, 0.6, 0.75)]


def _accuracy() -> dict[str, Any]:
    quartiles = ("lower", "median", "upper")
    rows = [{"case": case, "variant": "newton", "dt_s": 1e-6 * step, "duration_s": 0.004,
             "scheduled_cpu_s": 1e-4 / step, "reference_cpu_s": 1e-3 / step, "reference_over_scheduled": 10.0,
             "states_equal": True, "in_trouble": 0,
             "error": {norm: {q: 1e-5 * step * (1 + k) for k, q in enumerate(quartiles)}
                       for norm in ("position", "director", "energy")}}
            for case in ("head-on", "dozen") for step in (8, 16, 32, 64)]
    converged = [{"case": case, "variant": "newton", "dt_s": 1e-9, "impulses": 1.0,
                  "error": {norm: {"upper": floor} for norm, floor in (("position", 1e-9), ("director", 0.0),
                                                                       ("energy", 1.0))}}
                 for case in ("head-on", "dozen")]
    return {"rows": rows, "converged": converged}


REPORTS: dict[str, dict[str, Any]] = {
    "speed": {"rows": _speed_rows()}, "kinds": {"rows": _speed_rows()},
    "hard": {"rows": [{"case": f"case-{k % 5}", "limit": 1.0, "limit_is": "most", "margin": 3.0**k} for k in range(9)]},
    "hard history": {"rows": [{"case": name, "time_s": 5.0 * k, "S": 0.8, "max_overlap": 1e-3 * k,
                               "energy_unaccounted": 1e-14 * k} for name in ("collapse", "rest") for k in range(9)]},
    "effects": {"rows": [{"without": name, "own_state": {"cpu_ratio": ratio, "cpu_ratio_error": 0.02}, "same_state": {}}
                         for name, ratio in (("(nothing)", 1.0), ("vibration", 16.2), ("rod_rod_friction", 1.19))]},
    "accuracy": _accuracy(),
    "peers": {"rows": [{"program": "Shaken", "dt_us": 16, "rod_s_per_cpu_s_best": "12345"},
                       {"program": "ODE", "dt_us": 100, "rod_s_per_cpu_s_best": ""}]},
}


def report(bench_name: str) -> dict[str, Any]:
    return {"bench": bench_name, "version": "0.1.0", "machine": _MACHINE, **REPORTS[bench_name]}


def test_every_bench_with_pictures_is_here() -> None:
    assert set(REPORTS) == set(bench.DRAWERS)


@pytest.mark.parametrize("name", REPORTS)
@pytest.mark.parametrize("width", [None, "89mm", "183mm"])
def test_nothing_is_cut(name: str, width: str | None) -> None:
    found = list(bench.figures_of(report(name), width))
    assert found
    for _, sheet in found:
        if width == "89mm" and len(sheet.panels) > 1:
            continue  # several panels beside each other are for a page
        assert_whole(sheet)


def test_numbers_are_plain() -> None:
    assert [names.short_number(value) for value in (1660.4, 0.01234, 100, 23456, -0.5, math.nan)] == [
        "1660", "0.0123", "100", "23,500", "−0.500", "–"]
    (_, sheet), = bench.figures_of(report("speed"))
    shown = [text.get_text() for text in sheet[0].axes.texts]
    assert shown == ["3690", "2770", "2210", "12.0", "12.0", "12.0"]


def test_the_smallest_margin_of_each_case_counts() -> None:
    (_, sheet), = bench.figures_of(report("hard"))
    assert [(drawn.curve, float(drawn.x[0])) for drawn in sheet[0].drawn[:5]] == [
        (f"case-{k}", 3.0**k) for k in range(5)]


def test_reports_are_drawn_by_the_program_beside_their_rows(tmp_path: Path) -> None:
    (tmp_path / "speed.json").write_text(json.dumps(report("speed")))
    (tmp_path / "speed.csv").write_text("the rows\n")
    program = Path(style.__file__).parent / "__main__.py"

    def call(*words: Any) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, program, "bench", *map(str, words)], text=True, capture_output=True,
                              check=False)

    done = call(tmp_path / "speed.json", "--out", tmp_path)
    assert done.returncode == 0 and done.stdout == f"{tmp_path}/speed.png\n", done.stdout + done.stderr
    assert (tmp_path / "speed.csv").read_text() == "the rows\n"
    assert b"made up, 2, none, -O3" in (tmp_path / "speed.png").read_bytes()
    (tmp_path / "count.json").write_text(json.dumps({"bench": "count", "rows": [{}]}))
    assert call(tmp_path / "count.json").stdout == ""
    assert call(tmp_path / "none.json").returncode == 2


def test_numbers_of_a_row() -> None:
    assert accuracy.number({"a": {"b": 2}}, "a/b") == 2
    assert np.isnan(accuracy.number({"a": {"b": None}}, "a/b")) and np.isnan(accuracy.number({}, "a/b"))


def test_the_verdict_is_told_by_the_program(tmp_path: Path) -> None:
    program = Path(style.__file__).parent / "__main__.py"

    def told(name: str) -> str:
        return subprocess.run([sys.executable, program, "verdict", "-"], input=json.dumps(report(name)), text=True,
                              capture_output=True, check=True).stdout

    assert "head-on  newton   1.00 +- 0.00   4  1.00 +- 0.00   4       -   -\n" in told("accuracy")
    assert told("speed") == ""
