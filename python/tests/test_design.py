"""Points that fill a space."""
from collections import Counter

import numpy as np
import pytest

from shaken.design import METHODS, entries
from shaken.errors import ShakenError

SPACE = {"rods.length": (2.5, 4.5), "contacts.rod_rod.friction": (0.001, 1.0, "log"), "contacts.sweeps": (1, 4)}


@pytest.mark.parametrize("method", METHODS)
def test_points_lie_in_their_intervals_and_are_repeatable(method):
    made = entries(16, SPACE, method, 5)
    assert made == entries(16, SPACE, method, 5) != entries(16, SPACE, method, 6)
    assert all(list(entry) == list(SPACE) for entry in made)
    lengths = np.array([entry["rods.length"] for entry in made])
    frictions = np.log([entry["contacts.rod_rod.friction"] for entry in made]) / np.log(1000) + 1
    assert 2.5 <= lengths.min() and lengths.max() <= 4.5 and 0 <= frictions.min() and frictions.max() <= 1
    assert all(type(entry["contacts.sweeps"]) is int for entry in made)
    if method != "random":  # one in each sixteenth, and each whole number as often
        assert sorted(np.floor((lengths - 2.5) / 2 * 16)) == list(range(16))
        assert sorted(np.floor(frictions * 16)) == list(range(16))
        assert Counter(entry["contacts.sweeps"] for entry in made) == {1: 4, 2: 4, 3: 4, 4: 4}


@pytest.mark.parametrize("method", ["random", "sobol"])
def test_more_points_begin_with_the_fewer_ones(method):
    assert entries(37, SPACE, method)[:10] == entries(10, SPACE, method)


def test_sobol_points_are_even_in_a_plane():
    """Of 64 points one lies in each of the 64 parts of every kind into which halvings cut the plane."""
    made = entries(64, {"a": (0.0, 1.0), "b": (0.0, 1.0)}, "sobol", 3)
    for k in range(7):
        cells = {(int(p["a"] * 2**k), int(p["b"] * 2**(6 - k))) for p in made}
        assert len(cells) == 64


def test_all_mistakes_are_listed():
    with pytest.raises(ShakenError) as caught:
        entries(0, {"a": (2, 1), "b": (0, 1, "log"), "c": (1, 2, "cubic")}, "lattice")
    lines = str(caught.value).splitlines()
    assert [line.split(":")[0] for line in lines[2:]] == ["a", "b", "c"] and len(lines) == 5
    with pytest.raises(ShakenError, match="no key"):
        entries(4, {})
