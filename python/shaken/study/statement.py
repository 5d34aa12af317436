"""A sentence of the paper, with the check that asks the runs about it."""
from dataclasses import dataclass
from typing import Callable

from .evidence import Evidence
from .rules import Finding, NoRuns


@dataclass(frozen=True)
class Statement:
    """A sentence of the paper.

    id:     its name, "steady-state"
    figure: the paper's number, or the name of a figure beyond them
    says:   the sentence, in short
    ask:    what the runs say to it; it may raise NoRuns
    note:   how it is read, or why it can only be refuted
    role:   how far its verdict is evidence: CALIBRATES the model, and so stands outside of the tally, or HARDLY_FAILS;
            empty where it is evidence as all others are
    """

    id: str
    figure: str
    says: str
    ask: Callable[[Evidence], Finding]
    note: str = ""
    role: str = ""

    def check(self, evidence: Evidence) -> Finding:
        """What the runs say to it."""
        try:
            return self.ask(evidence)
        except NoRuns:
            return Finding()


#: The model was chosen so that it holds.
CALIBRATES = "used for calibration"
#: It holds by symmetry, by construction, or by a factor of hundreds.
HARDLY_FAILS = "could hardly fail"


def states(id: str, figure: str, says: str, note: str = "",
           role: str = "") -> Callable[[Callable[[Evidence], Finding]], Statement]:
    """Makes of the check that stands below it the statement that it is asked about."""
    return lambda ask: Statement(id, figure, says, ask, note, role)
