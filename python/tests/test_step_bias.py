"""bench/step_bias.py: biases of averages against the step, from runs whose answers are known."""
from __future__ import annotations

import csv
import math
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from shaken import Estimate, Point, Sweep

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def step_bias() -> ModuleType:
    loader = SourceFileLoader("step_bias", str(SOURCE / "bench" / "step_bias.py"))
    module = module_from_spec(spec_from_loader(loader.name, loader))  # type: ignore[arg-type]
    loader.exec_module(module)
    return module


def test_the_limit_is_that_of_a_line_through_the_short_steps(step_bias: ModuleType) -> None:
    # on the line 2 + 0.01 step up to 8, beyond which nothing counts; the last is off by 50 %
    steps = [1, 2, 4, 8, 16]
    values = [Estimate(2 + 0.01 * step, 0.001) for step in steps[:-1]] + [Estimate(3, 0.001)]
    found = step_bias.biases(steps, values)
    assert [bias.value for bias in found] == pytest.approx([0.5, 1, 2, 4, 50])
    # the line's error at no step: sum of squares of the steps over that of their differences from the mean, 3.75
    limit = 0.001 * math.sqrt(85 / 4 / (85 - 4 * 3.75**2))
    assert found[-1].error == pytest.approx(100 * math.hypot(0.001 / 2, 1.5 * limit / 2))


def test_a_line_weighs_by_errors(step_bias: ModuleType) -> None:
    values = [Estimate(1.0, 1e-6), Estimate(1.0, 1e-6), Estimate(9.0, 1e3)]
    assert step_bias.biases([1, 2, 4], values)[0].value == pytest.approx(0, abs=1e-4)
    assert not step_bias.biases([1, 2], [Estimate(1.0), Estimate(1.0, 0.1)])[0].is_known


def _run(length: float, impacts: str, step: float, names: list[str]) -> Any:
    scene = {"rods": {"length": length}, "time": {"step": step, "impacts": impacts}}
    return SimpleNamespace(scene=scene, summary={"cpu_seconds": 4e-6 / step}, key=lambda path: None if "." not in path
                           else scene[path.split(".")[0]][path.split(".")[1]],
                           numbers={name: Estimate(2.0, 0.01) for name in names})


def test_a_table_of_a_sweep_is_drawn(step_bias: ModuleType, tmp_path: Path) -> None:
    measured = [name for name in step_bias.QUANTITIES.values() if name]
    points = [Point({"time.step": f"{us} us", "time.impacts": impacts}, [_run(length, impacts, 1e-6 * us, measured)])
              for impacts in ("tick_end", "at_instant") for us in (1, 2, 4, 64) for length in (2.5, 4.5)]
    rows = step_bias.table(Sweep([*points, Point({"rods.beads": 9}, [])]))
    assert [(row["rod_length_mm"], row["impacts"], row["step_us"]) for row in rows[:5]] == [
        ("4.5", "tick_end", "1"), ("4.5", "tick_end", "2"), ("4.5", "tick_end", "4"), ("4.5", "tick_end", "64"),
        ("4.5", "at_instant", "1")]
    assert len(rows) == 16 and [row[step_bias.COST] for row in rows[:4]] == ["4", "2", "1", "0.0625"]
    assert {row["T_upright_bias_percent"].lstrip("-") for row in rows} == {"0.00"}
    with (SOURCE / "docs" / "data" / "accuracy-bias.csv").open(newline="") as file:
        committed = csv.DictReader(file)
        shared = [name for name in rows[0] if name in (committed.fieldnames or [])]
    assert len(shared) == 4 + 2 * 5  # all but what runs do not measure
    assert len(step_bias.bias_sheet(rows).panels) == 8 and len(step_bias.cost_sheet(rows).panels) == 2


def test_the_table_of_the_docs_is_drawn(step_bias: ModuleType, tmp_path: Path) -> None:
    step_bias.main([str(SOURCE / "docs" / "data" / "accuracy-bias.csv"), str(tmp_path)])
    for name in ("bias", "cost"):
        assert (tmp_path / f"accuracy-{name}.png").read_bytes()[1:4] == b"PNG"
