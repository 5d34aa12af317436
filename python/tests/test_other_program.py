"""The comparison with another program: what it measures on planted motion, and its table."""
import json
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from shaken.study.report import other_program as tables

VALIDATE = Path(__file__).resolve().parents[2] / "tests" / "validate"


@pytest.fixture
def other_program(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(VALIDATE), *sys.path])
    import other_program
    return other_program


def test_planted_motion_is_measured(other_program):
    system = SimpleNamespace(mass=2.0, inertia_perp=3.0, inertia_par=0.5, largest_tilt=0.3)
    tilt = np.array([0.11, 0.11, -0.11, -0.11])
    angle = 0.7 + np.array([0.4, -0.4, 0.4, -0.4])  # about the director of all
    zero, up = np.zeros(4), np.array([0.0, 0.0, 1.0])
    along = np.stack([np.cos(angle), np.sin(angle), zero], -1)
    across = np.cross(up, along)
    director = np.sqrt(1 - tilt[:, None]**2) * along + np.outer(tilt, up)
    velocity = (20 * np.outer(np.sign(tilt), [np.cos(0.7), np.sin(0.7), 0]) + np.outer([1, -1, -1, 1], 5 * up))
    spin = 7 * director + 8 * across + 9 * np.cross(director, across)
    states = np.array([[velocity * k * other_program.EVERY, director, velocity, spin] for k in range(600)])
    means = other_program.means_of(system, states)
    found = other_program.numbers_of(means, 12, means)
    for name, value in {"S": np.cos(0.8), "rms n_z": 0.11, "T along (pJ)": 2 * (20 * np.cos(0.4))**2 * 4 / 3,
                        "T across (pJ)": 2 * (20 * np.sin(0.4))**2 * 4 / 3, "T vertical (pJ)": 2 * 5**2 * 4 / 3,
                        "T turning (pJ)": 3 * 9**2, "T tipping (pJ)": 3 * 8**2, "T spinning (pJ)": 0.5 * 7**2,
                        "v at n_z 0.10 to 0.15 (mm/s)": 20 * np.cos(0.4),
                        "MSD along, 0.5 s (mm²)": (20 * 25 * other_program.EVERY)**2,
                        "MSD across, 0.5 s (mm²)": 0}.items():
        assert found[name][0] == pytest.approx(value, rel=1e-5, abs=1e-9), name


def test_errors_are_those_that_the_longer_run_shows(other_program):
    rng = np.random.default_rng(1)
    slow = lambda n: (np.repeat(rng.normal(3, 1, n // 40), 40), np.ones(n))  # independent only each 40 samples
    seconds = 200 * other_program.EVERY
    found = [other_program.numbers_of({"S": slow(200)}, seconds, {"S": slow(4000)})["S"] for _ in range(300)]
    values, errors = np.transpose(found)
    assert values.mean() == pytest.approx(3, abs=0.1)
    assert errors.mean() == pytest.approx(values.std(), rel=0.1)
    assert errors.mean() == pytest.approx(5**-0.5, rel=0.1)


def test_the_table_extrapolates_to_rigid_contacts(tmp_path):
    case = lambda title, softness, value: {
        "rods": "2.5 mm", "title": title, "softness": softness, "seconds": 10, "cpu_s": 36, "numbers": {"S": value}}
    file = tmp_path / "other-program.json"
    file.write_text(json.dumps([case("Shaken", 0, [0.5, 0.03]), case("soft", 0.04, [0.9, 0.04]),
                                case("stiff", 0.02, [0.72, 0.04]), case("one dashpot", 0, [0.4, 0.04])]))
    head, _, row, beyond, cost = tables(file).splitlines()
    assert head == "| 2.5 mm | Shaken | soft | stiff | one dashpot | rigid, extrapolated |"
    assert row == ("| S | 0.50 ± 0.03 | 0.90 ± 0.04 (+8.0) | 0.72 ± 0.04 (+4.4) | 0.40 ± 0.04 (−2.0) "
                   "| 0.54 ± 0.09 (+0.4) |")
    assert beyond == "| beyond two errors | | 1 of 1 | 1 of 1 | 0 of 1 | 0 of 1 |"
    assert cost.startswith("| simulated s, CPU-h | 10, 0.01 | 10, 0.01 |") and cost.count("|") == head.count("|")
