"""What the paper states, and the runs' answer to each statement, which the checks of each subject have."""
import math
from dataclasses import dataclass
from typing import Any, Callable, Iterable

from . import layer_checks, motion_checks, order_checks, structure_checks
from .evidence import Evidence, Read, box_of, box_text, reads
from .rules import NO_DATA, Finding
from .statement import Statement

#: In the order of the pages.
STATEMENTS: tuple[Statement, ...] = tuple(
    said for module in (order_checks, structure_checks, layer_checks, motion_checks) for said in vars(module).values()
    if isinstance(said, Statement))


def of_figures(figures: Iterable[str] = ()) -> list[Statement]:
    """The statements of these figures; all if none is named."""
    wanted = set(figures)
    return [statement for statement in STATEMENTS if not wanted or statement.figure in wanted]


@dataclass(frozen=True)
class Basis:
    """What a verdict stands on; each is the smallest and the largest of its state points, or empty.

    samples: independent samples, of all seeds together
    seeds:   runs of a state point
    boxes:   in words, the smallest area and the largest
    seconds: simulated, of a run, its transient included
    """

    samples: tuple[float, ...] = ()
    seeds: tuple[int, ...] = ()
    boxes: tuple[str, ...] = ()
    seconds: tuple[float, ...] = ()

    @staticmethod
    def of(taken: Iterable[Read]) -> "Basis":
        taken = list(taken)
        runs = [run for read, _ in taken for run in read]
        named = {box_of(run): box_text(run) for run in runs}
        return Basis(_ends(number.n_eff for _, number in taken if math.isfinite(number.n_eff)),
                     _ends(len(read) for read, _ in taken), tuple(named[box] for box in _ends(named, math.prod)),
                     _ends(run.summary["sim_seconds"] for run in runs))

    def cells(self) -> list[str]:
        """Independent samples, seeds, box and time of a table."""
        return [_range(f"{n:.0f}" for n in self.samples), _range(f"{n}" for n in self.seeds), _range(self.boxes, " mm"),
                _range((f"{t:.0f} s" for t in self.seconds), " s")]


def _ends(values: Iterable[Any], size: Callable[[Any], Any] | None = None) -> tuple[Any, ...]:
    found = sorted(set(values), key=size)
    return (found[0], found[-1]) if len(found) > 1 else tuple(found)


def _range(words: Iterable[str], unit: str = "") -> str:
    """One word, or the first and the last with the unit of both behind them: "33.5 to 67 mm"."""
    first, *other = dict.fromkeys(words) or ["–"]
    return f"{first.removesuffix(unit)} to {other[0]}" if other else first


@dataclass(frozen=True)
class Verdict:
    """A statement, what the runs say to it, and on what that stands."""

    statement: Statement
    finding: Finding
    basis: Basis

    @property
    def words(self) -> str:
        """The verdict and its reason, for a table of Markdown."""
        word = f"**{self.finding.verdict}**" if self.finding.verdict == "disagrees" else self.finding.verdict
        if self.statement.role:
            word += f" ({self.statement.role})"
        return f"{word}: {self.finding.why}" if self.finding.why else word


def judged(evidence: Evidence, statements: Iterable[Statement] = STATEMENTS) -> list[Verdict]:
    """Each statement with what the runs say to it."""
    found = []
    for statement in statements:
        with reads() as taken:
            finding = statement.check(evidence)
        found.append(Verdict(statement, finding, Basis() if finding.verdict == NO_DATA else Basis.of(taken)))
    return found


def as_json(found: Iterable[Verdict]) -> list[dict[str, Any]]:
    return [{"statement": v.statement.id, "figure": v.statement.figure, "says": v.statement.says,
             "verdict": v.finding.verdict, "found": v.finding.found, "why": v.finding.why, "note": v.statement.note,
             "role": v.statement.role,
             "independent_samples": v.basis.samples, "seeds": v.basis.seeds, "boxes": v.basis.boxes,
             "sim_seconds": v.basis.seconds} for v in found]


def as_table(found: Iterable[Verdict], figure: Callable[[Statement], str] | None = lambda s: s.figure) -> str:
    """A table of Markdown; `figure` is what its first column says, which is left out if that is None."""
    head = ["the paper says", "found here", "n_eff", "seeds", "box", "time", "verdict"]
    rows = []
    for verdict in found:
        statement = verdict.statement
        note = f". *Note:* {statement.note}" if statement.note else ""
        cells = [f"{statement.says}{note}", verdict.finding.found or "–", *verdict.basis.cells(), verdict.words]
        rows.append(([figure(statement)] if figure else []) + cells)
    head = (["figure"] if figure else []) + head
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows]) + "\n"
