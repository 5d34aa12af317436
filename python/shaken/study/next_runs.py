"""The runs to do next and their price: what would decide the statements that are open, and what docs/findings.md
asks."""
import math
import re
from dataclasses import dataclass, replace
from typing import Iterable

import numpy as np

from .evidence import GAMMA, PACKING, Evidence, Runs, box_of, key_of
from .rules import NO_DATA, OPEN, markdown
from .running import speed
from .statements import Verdict


@dataclass(frozen=True)
class Batch:
    """Alike runs at the desk's time step.

    length: of the rods [mm]; packing: their area fraction; side: of the box [mm]; seconds: simulated, of each run;
    end: diameter of the rods at their ends [mm]
    """

    length: float
    packing: float
    side: float
    seconds: float
    n_runs: int
    end: float = 0.4

    def missing(self, there_are: Runs) -> int:
        """How many of the runs are not there yet; a run that follows a shorter stage counts as if it began there."""
        there = [run for run in there_are.at(length=self.length, end=self.end)
                 if abs(key_of(run, PACKING) - self.packing) < 2e-3 and run.summary["sim_seconds"] > 0.85 * self.seconds
                 and abs(math.prod(box_of(run)) / self.side**2 - 1) < 0.01]
        return max(0, self.n_runs - len(there))


#: Side [mm] of the square that is as large as the strip of 21 mm x 126 mm.
STRIP = 51.44

#: What would decide each question of docs/findings.md.
QUESTIONS: dict[str, tuple[str, Batch]] = {
    "beads": ("7, 9 and 21 beads with 986 rods each, three seeds", Batch(2.5, 0.75, 41.865, 200, 9)),
    "number of rods": ("0.8264 and 0.878 of the set `density`, two seeds", Batch(2.5, 0.85, 60, 200, 4)),
    "frequency": ("225 and 280 Hz at 0.80, until the MSD is linear, one seed", Batch(2.5, 0.80, 60, 900, 2)),
    "shaking": ("Γ = 3 from the disordered end of a run at Γ = 14, three seeds", Batch(2.5, 0.75, 25.119, 1000, 3)),
    "minimum of D": ("0.65 to 0.85 in steps of 0.05, the set `diffusion`", Batch(2.5, 0.75, 60, 250, 10)),
    "lanes": ("0.85 in twice the box, for as long, two seeds", Batch(4.5, 0.85, 66.984, 810, 2)),
    "defects": ("0.80 in the paper's box, defects every 50 ms, two seeds", Batch(2.5, 0.80, 83.73, 120, 2)),
    "elastic constants": ("0.55 in twice the box, two seeds", Batch(4.5, 0.55, 133.968, 300, 2)),
}

#: Rods with blunt ends where they have layers and may still be a fluid: at 0.85 they freeze, and at 0.825 the layers of
#: each seed are its own still after 280 s.
BLUNT = ("the three seeds with ends of 0.5 mm at 0.825 of the set `strip`, for 1200 s in place of 280 s",
         (Batch(4.0, 0.825, STRIP, 1230, 3, end=0.5),))

#: What would decide each statement that is open or may be again, by its id: all runs that are wanted, done or not.
DECIDING: dict[str, tuple[str, tuple[Batch, ...]]] = {
    "long-range": ("0.55, 0.60 and 0.65 in a box of 134 mm, two seeds, at 0.60 three: the set `long-range`",
                   (Batch(4.5, 0.55, 133.968, 400, 2), Batch(4.5, 0.60, 133.968, 400, 3),
                    Batch(4.5, 0.65, 133.968, 400, 2))),
    "g2-oscillates": ("the seeds from the seventh on in the strip: the set `strip`",
                      (Batch(4.5, 0.80, STRIP, 280, 9), Batch(4.5, 0.85, STRIP, 310, 12))),
    "rotation-saturates": ("eight seeds at 0.80 and 0.85: the set `diffusion-along`",
                           (Batch(4.5, 0.80, 33.492, 480, 8), Batch(4.5, 0.85, 33.492, 480, 8))),
    "angle-end": BLUNT,
    "peaks-end": BLUNT,
    "angle-packing": ("three seeds of 4.0 mm at 0.825 in the strip: the set `strip`",
                      (Batch(4.0, 0.825, STRIP, 310, 3),)),
    "wavelength-packing": ("12 seeds at 0.85 in the strip: the set `strip`", (Batch(4.5, 0.85, STRIP, 310, 12),)),
    "wavelength-length": ("six seeds of 3.5 mm and twelve of 4.5 mm in the strip: the set `strip`",
                          (Batch(3.5, 0.85, STRIP, 310, 6), Batch(4.5, 0.85, STRIP, 310, 12))),
    "wavelength-end": BLUNT,
}


def hours(evidence: Evidence, batch: Batch) -> float:
    """CPU-hours of one core, by the speed of the runs of that length near that packing, and by how many rods of that
    length they have at an area fraction; NaN where there are none."""
    known = Runs(run for run in evidence.everything.at(length=batch.length)
                 if "rod_seconds_per_cpu_second" in run.summary and key_of(run, GAMMA) > 0)
    if not known:
        return math.nan
    per_area = float(np.median([run.summary["n_rods"] / math.prod(box_of(run)) / key_of(run, PACKING)
                                for run in known]))
    n_rods = per_area * batch.packing * batch.side ** 2
    return batch.n_runs * n_rods * batch.seconds / speed(known, batch.packing) / 3600


def sets_in(text: str) -> list[str]:
    """The sets that a text of DECIDING names."""
    return re.findall("`([a-z-]+)`", text)


def to_do(evidence: Evidence, statement: str) -> list[Batch]:
    """The runs that would decide a statement and are not there yet."""
    text, wanted = DECIDING.get(statement, ("", ()))
    there_are = evidence.joined(*sets_in(text))
    return [replace(batch, n_runs=n) for batch in wanted if (n := batch.missing(there_are))]


def _price(evidence: Evidence, batches: Iterable[Batch]) -> str:
    price = sum((hours(evidence, batch) for batch in batches), 0.0)
    return f"{price:.2g}" if price > 0 else "–"


def open_questions(evidence: Evidence) -> str:
    """What would decide the questions of docs/findings.md, and its price; as a table of Markdown."""
    return markdown(["question", "runs", "ℓ", "φ", "box", "time of each", "CPU-h"],
                    [[question, runs, f"{batch.length:g} mm", f"{batch.packing:g}", f"{batch.side:.3g} mm",
                      f"{batch.seconds:g} s", _price(evidence, [batch])]
                     for question, (runs, batch) in QUESTIONS.items()])


def open_statements(evidence: Evidence, found: Iterable[Verdict]) -> str:
    """The statements that are open, why they are, what would decide them, and its price; as a table of Markdown."""
    rows = []
    for verdict in found:
        if verdict.finding.verdict in (OPEN, NO_DATA):
            runs, _ = DECIDING.get(verdict.statement.id, ("–", ()))
            price = _price(evidence, to_do(evidence, verdict.statement.id))
            rows.append([verdict.statement.says, verdict.finding.why or "no runs yet", runs, price])
    return markdown(["the paper says", "why it is open", "what would decide it", "CPU-h"], rows)
