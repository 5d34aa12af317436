"""What goes wrong, in one sentence with the way out."""
import importlib
from typing import Any, Iterable, Sequence


class ShakenError(Exception):
    """Something that the caller can mend: a path, a name, an option, a daemon that does not run.

    exit_code: of a program that ends for it, as `shaken --help` has them
    """

    exit_code = 2


class Failed(ShakenError):
    """What could not be done, although it was asked for rightly: a file is damaged, or a disk is full."""

    exit_code = 1


class NumericalTrouble(Failed):
    """What a simulation met that it must not go on from.

    tick: at which it was met
    rods: the numbers of the rods that are concerned
    """

    def __init__(self, said: str, tick: int, rods: Sequence[int]) -> None:
        super().__init__(f"tick {tick}, rods {', '.join(map(str, rods)) or 'none'}: {said}")
        self.tick, self.rods, self._said = tick, list(rods), said

    def __reduce__(self) -> tuple[type, tuple[str, int, list[int]]]:
        return type(self), (self._said, self.tick, self.rods)


class NoDaemon(ShakenError):
    """No daemon answers at its root: none runs there, or it has just ended."""

    exit_code = 3


class NotFound(ShakenError):
    """The daemon has nothing of that name."""


class DaemonFailed(Failed):
    """A daemon whose answer is none, or which could not do what it was asked for."""


def imported(module: str, otherwise: str = "") -> Any:
    """A module that not everybody has. Raises ShakenError where it is missing, with what does `otherwise`."""
    try:
        return importlib.import_module(module)
    except ImportError:
        name = module.partition(".")[0]
        raise ShakenError(f"{name} is not installed: `apt install python3-{name}`{otherwise}") from None


def _distance(a: str, b: str) -> int:
    """Letters to change, to put in, to take out, or neighbours to swap, for one word to become the other."""
    before, last = [0] * (len(b) + 1), list(range(len(b) + 1))
    for i, letter in enumerate(a, 1):
        row = [i]
        for j, other in enumerate(b, 1):
            row.append(min(last[j] + 1, row[-1] + 1, last[j - 1] + (letter != other)))
            if i > 1 and j > 1 and letter == b[j - 2] and a[i - 2] == other:
                row[j] = min(row[j], before[j - 2] + 1)
        before, last = last, row
    return last[-1]


def nearest(word: str, known: Iterable[str], otherwise: Sequence[str] = ()) -> str:
    """"; did you mean NAME?" with the first of the names that are nearest, whatever their case, to a word of at most
    100 letters; else with the first of `otherwise`; "" where a third of it or more would have to change."""
    found = min(known, key=lambda name: _distance(word.lower(), name.lower()), default="") if len(word) <= 100 else ""
    away = _distance(word.lower(), found.lower())
    near = [found] if away <= max(1, max(len(word), len(found)) // 3) and away < len(found) else otherwise
    return f"; did you mean {near[0]}?" if near else ""


class UnknownName(ShakenError, KeyError):
    """A name that nothing has, with the nearest that there is."""

    def __init__(self, said: str, name: object, known: Iterable[str], of: str = "there are") -> None:
        names = list(known)
        super().__init__(f"{said}{nearest(str(name), names)} ({of} {', '.join(names) or 'none'})")

    __str__ = Exception.__str__  # a KeyError's is that of its repr
