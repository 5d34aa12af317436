"""Averages in the frame of a tagged rod."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from shaken import Frame, ShakenError, field_about

BOX = np.array([30.0, 40.0, 1.2])


def frame(time: float, path: np.ndarray, theta: np.ndarray, species: np.ndarray) -> Frame:
    """Rods on such paths (n, 2), put into the box."""
    images = np.zeros((len(path), 3))
    images[:, :2] = np.floor(path / BOX[:2])
    positions = np.column_stack([path - images[:, :2] * BOX[:2], np.full(len(path), 0.6)])
    directors = np.column_stack([np.cos(theta), np.sin(theta), np.zeros(len(path))])
    return Frame(time, 0, positions, directors, np.zeros((len(path), 3)), images, species, BOX)


def turned(vectors: np.ndarray, angle: float) -> np.ndarray:
    return vectors @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def test_neighbours_are_where_and_move_as_the_tagged_rod_sees_them() -> None:
    """One tagged rod in different directions, at the border of the box; two neighbours at places of its own frame."""
    apart = np.array([[4.5, 0.5], [-2.5, -3.5]])
    flow = np.array([[3.0, -1.0], [0.5, 2.0]])
    frames = []
    for k, heading in enumerate((0.3, 1.9, -2.5)):
        at = np.array([29.5, 0.5]) + k
        path = np.vstack([at, at + turned(apart, heading)])
        way = np.vstack([turned(np.array([[7.0, 0.0]]), heading), turned(flow, heading)])
        theta = heading + np.array([0.0, 0.4, np.pi + 0.2])  # the second points backwards, which an axis does not show
        species = np.array([1, 0, 0])
        found = field_about([frame(0.0, path, theta, species), frame(0.1, path + 0.1 * way, theta, species)], reach=6)
        frames += [frame(k, path, theta, species)]
        assert found.speed == pytest.approx(7)
        for (x, y), v, angle in zip(apart, flow, (0.4, 0.2)):
            at_bin = int(np.floor(y + 6)), int(np.floor(x + 6))
            assert found.x[at_bin[1]] == pytest.approx(np.floor(x) + 0.5)
            assert found.density[at_bin] == pytest.approx(1)
            assert found.velocity[at_bin] == pytest.approx(v)
            assert found.angle[at_bin] == pytest.approx(angle)
            assert found.order[at_bin] == pytest.approx(1)
        assert found.density.sum() == pytest.approx(2) and np.isnan(found.velocity).sum() == 2 * (144 - 2)


def test_errors_are_those_of_the_mean_of_what_was_seen() -> None:
    path, theta, species = np.array([[10.0, 10.0], [12.5, 10.5]]), np.zeros(2), np.array([1, 0])
    frames = [frame(time, path + [[0, 0], [x, 0]], theta, species) for time, x in ((0.0, 0.0), (0.1, 0.3), (0.2, 0.4))]
    found = field_about(frames, reach=6)
    assert found.velocity[6, 8] == pytest.approx([2, 0]) and found.velocity_error[6, 8] == pytest.approx(
        [np.sqrt((9 + 1) / 2 - 4) / np.sqrt(2), 0])


def test_without_structure_the_field_is_flat() -> None:
    rng = np.random.default_rng(1)
    n, drift = 3000, np.array([2.0, 0.0])
    species = np.array([1] * 20 + [0] * (n - 20))
    frames = []
    for k in range(30):
        path, theta = rng.uniform(0, 1, (n, 2)) * BOX[:2], rng.uniform(-np.pi, np.pi, n)
        for late in (0.0, 0.01):
            noise = rng.normal(0, 0.1, (n, 2)) if late else 0
            frames.append(frame(k + late, path + late * drift + 0.01 * noise, theta, species))
    found = [field_about(frames[2 * k:2 * k + 2], reach=5) for k in range(30)]
    density = np.mean([one.density for one in found], axis=0)
    assert density.mean() == pytest.approx((n - 20) / (30 * 40), rel=0.02)
    assert density.std() < 0.12 * density.mean()
    speed = np.nanmean([one.velocity for one in found], axis=(0, 1, 2))
    assert abs(speed[0]) < 0.2 and abs(speed[1]) < 0.2, "a drift has no direction for rods that point anywhere"
    assert all(one.n_seen == 20 for one in found)


def test_what_cannot_be_seen_is_refused() -> None:
    one = frame(0.0, np.array([[1.0, 1.0]]), np.array([0.0]), np.array([0]))
    with pytest.raises(ShakenError, match="two frames"):
        field_about([one], tagged=0)
    with pytest.raises(ShakenError, match="no rod is of species 1"):
        field_about([one, one])
    with pytest.raises(ShakenError, match="half the box"):
        field_about([one, one], tagged=0, reach=16)


def test_nothing_is_seen_through_walls_or_by_spheres() -> None:
    path, theta, species = np.array([[1.0, 20.0], [29.0, 20.0]]), np.zeros(2), np.array([1, 0])
    pair = [frame(time, path, theta, species) for time in (0.0, 0.1)]
    assert field_about(pair, reach=4).density.sum() > 0
    walled = [replace(one, periodic=(False, False)) for one in pair]
    assert field_about(walled, reach=4).density.sum() == 0, "the other stands at the far wall"
    assert field_about(walled, reach=29).density.sum() > 0
    with pytest.raises(ShakenError, match="species 1 are spheres"):
        field_about([replace(one, spheres=(1,)) for one in pair], reach=4)
    around = field_about([replace(one, spheres=(0,)) for one in pair], reach=4)
    assert around.density.sum() > 0 and np.all(np.isnan(around.order))
    for wrong in ({"tagged": 2}, {"around": 2}):
        with pytest.raises(ShakenError, match="no rod is of species 2; there are {0, 1}"):
            field_about(pair, reach=4, **wrong)
