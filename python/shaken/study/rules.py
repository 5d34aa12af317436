"""How runs are asked: yes, no, or open with the reason; and what several answers come to."""
import math
from dataclasses import dataclass, field
from typing import Iterable, Sequence, Sized, TypeVar

from scipy import stats

from ..estimate import Estimate, decimals, joint_dof

#: Errors by which two numbers must differ before they count as different: 95 %.
SIGMAS = 2.0
#: Errors by which neighbours of a trend may go the other way: with ten of them two would be met by chance.
STEP_BACK = 3.0

AGREES, IN_PART, DISAGREES = "agrees", "in part", "disagrees"
CONSISTENT = "consistent"               # refuted nowhere: it could only have been, or it holds where it is decided
CONTRADICTS = "contradicts itself"      # the sentence, not the runs
OPEN, NO_DATA = "open", "no data"


_Some = TypeVar("_Some", bound=Sized)


class NoRuns(Exception):
    """The runs that a statement is asked of are not there."""


def needed(found: _Some, n: int = 1) -> _Some:
    """The same, of which there are so many at least. Raises NoRuns where there are not."""
    if len(found) < n:
        raise NoRuns
    return found


@dataclass(frozen=True)
class Answer:
    """What runs say to a question: True, False, or None (open) with the reason. `at` is where it was asked."""

    word: bool | None
    why: str = ""
    at: str = ""

    def placed(self, at: str) -> "Answer":
        return Answer(self.word, self.why, at)

    def negated(self) -> "Answer":
        return Answer(None if self.word is None else not self.word, self.why, self.at)


YES, NO = Answer(True), Answer(False)


def unknown(why: str) -> Answer:
    return Answer(None, why)


#: Why an answer is open where the runs are still to come: without them a statement is open, whatever others say.
NOT_RUN = "not run yet"


def judged_error(estimate: Estimate) -> float:
    """The standard error that a number is judged with; NaN where there is none.

    Where no error of its own is known, but its drift is (the later half less the earlier one), what the drift can be
    stands in for it: the error of a difference of halves is about twice that of the whole.
    """
    if math.isfinite(estimate.error):
        return estimate.error
    return math.hypot(estimate.drift, estimate.drift_error)


def _values(estimate: Estimate) -> tuple[float, ...]:
    """Between what a true value is, but for its error: of a mean that drifts, it and what it would be after a further
    drift of twice the size, as if it went on for as long again as it was averaged."""
    drifts = estimate.steady is False and math.isfinite(estimate.drift)
    return (estimate.value, estimate.value + 2 * estimate.drift) if drifts else (estimate.value,)


def doubt(estimate: Estimate) -> str:
    """Why a number decides nothing; empty where it does."""
    if not estimate.is_known:
        return estimate.reason or "not measured"
    if estimate.steady is False and not math.isfinite(estimate.drift):
        return "a run still relaxes"
    if not math.isfinite(judged_error(estimate)):
        return "too few independent samples for an error"
    return ""


def margin(*estimates: Estimate) -> float:
    """What a number may be away from its value, or a difference of two: two errors, and more where an error is the
    scatter of a few replicas: what Student's t has at the same confidence."""
    plain = []  # the errors as they were before they were widened to cover 68 %
    for estimate in estimates:
        covers_68 = stats.t.ppf(stats.norm.cdf(1), estimate.dof) if math.isfinite(estimate.dof) else 1.0
        plain.append((judged_error(estimate) / covers_68, estimate.dof))
    dof = joint_dof(plain)
    quantile = stats.t.ppf(stats.norm.cdf(SIGMAS), dof) if math.isfinite(dof) else SIGMAS
    return float(quantile * math.hypot(*(error for error, _ in plain)))


def larger(a: Estimate, b: Estimate, apart: float | None = None) -> Answer:
    """a > b, by the errors (and drifts) that they are judged with; apart: by that much in place of two errors."""
    for estimate in (a, b):
        if why := doubt(estimate):
            return unknown(why)
    apart = margin(a, b) if apart is None else apart
    differences = [x - y for x in _values(a) for y in _values(b)]
    if min(differences) > apart:
        return YES
    if max(differences) < -apart:
        return NO
    return unknown("a run still relaxes" if abs(a.value - b.value) > apart else "the errors are too large")


def above(estimate: Estimate, level: float) -> Answer:
    return larger(estimate, Estimate(level, 0.0, True))


def below(estimate: Estimate, level: float) -> Answer:
    return larger(Estimate(level, 0.0, True), estimate)


def close_to(estimate: Estimate, target: float, tolerance: float) -> Answer:
    """Within `tolerance` of `target`, with its error to spare."""
    if why := doubt(estimate):
        return unknown(why)
    aways, spare = [value - target for value in _values(estimate)], margin(estimate)
    if max(abs(away) for away in aways) + spare <= tolerance:
        return YES
    is_off = min(aways) - spare > tolerance or max(aways) + spare < -tolerance
    return NO if is_off else unknown("the errors are too large")


def trend(points: Sequence[tuple[float, Estimate]], rising: bool) -> Answer:
    """Whether what is measured at rising values of a key rises (or falls) from the first to the last that decide. A
    step back between neighbours by more than three errors is a no."""
    deciding = [estimate for _, estimate in points if not doubt(estimate)]
    if len(deciding) < 2:
        reasons = [doubt(estimate) for _, estimate in points if doubt(estimate)]
        return unknown(reasons[0] if reasons else "fewer than two points")
    if not rising:
        deciding.reverse()
    for before, after in zip(deciding, deciding[1:]):
        if larger(before, after, STEP_BACK * math.hypot(judged_error(before), judged_error(after))).word:
            return NO
    return larger(deciding[-1], deciding[0])


def all_of(answers: Sequence[Answer]) -> Answer:
    """One answer for several questions of which each must be yes: no where one is, else open where one is."""
    return min(answers, key=lambda answer: (False, None, True).index(answer.word))


@dataclass
class Finding:
    """What the runs say to a statement.

    verdict: one of the words above
    found:   numbers with errors, in words
    why:     what is open, or where it does not hold
    answers: to the questions that it asks
    """

    verdict: str = NO_DATA
    found: str = ""
    why: str = ""
    answers: list[Answer] = field(default_factory=list)


def conclude(answers: Iterable[Answer], found: str, *, everywhere: bool = False) -> Finding:
    """All yes: agrees. All no: disagrees. Some of both: in part, and where. Of answers that are open none counts for
    either side: where more than half say yes and none no, the runs are consistent with the statement, and the rest is
    named as open; not where runs are still to come.

    everywhere: of what is said to hold everywhere one no is enough to disagree
    """
    given = list(answers)
    if not given:
        return Finding()
    says_yes = [a for a in given if a.word is True]
    says_no = [a for a in given if a.word is False]
    open_ = [a for a in given if a.word is None]
    reasons = _reasons(open_)
    if says_no:
        if not says_yes or everywhere:
            where = f"at {_places(says_no)}" if says_yes and _places(says_no) else ""
            return Finding(DISAGREES, found, _joined(where, reasons and f"open: {reasons}"), given)
        where = f"holds: {_places(says_yes)}; not: {_places(says_no)}" if _places(says_no) else ""
        return Finding(IN_PART, found, _joined(where, reasons and f"open: {reasons}"), given)
    if not open_:
        return Finding(AGREES, found, "", given)
    if 2 * len(says_yes) > len(given) and all(a.why != NOT_RUN for a in open_):
        return Finding(CONSISTENT, found, f"at {len(says_yes)} of {len(given)}; open: {reasons}", given)
    return Finding(OPEN, found, reasons, given)


def refutable(answer: Answer, found: str, how_well: str) -> Finding:
    """Of a statement that runs like these can refute but not prove: `answer` is no where they do. Otherwise they are
    consistent with it, and `how_well` says to what precision."""
    if answer.word is False:
        return Finding(DISAGREES, found, "", [answer])
    if answer.word is None:
        return Finding(OPEN, found, answer.why, [answer])
    return Finding(CONSISTENT, found, how_well, [answer])


def _places(answers: Sequence[Answer]) -> str:
    return ", ".join(dict.fromkeys(a.at for a in answers if a.at))


def _reasons(answers: Sequence[Answer]) -> str:
    by_reason: dict[str, list[str]] = {}
    for answer in answers:
        by_reason.setdefault(answer.why, []).append(answer.at)
    return "; ".join(_joined(", ".join(dict.fromkeys(at for at in places if at)), f"({why})" if any(places) else why,
                             between=" ") for why, places in by_reason.items())


def _joined(*words: str, between: str = "; ") -> str:
    return between.join(word for word in words if word)


def text(estimate: Estimate, digits: int | None = None) -> str:
    """A number with its error, and the drift where it is not steady: "0.912 ± 0.004"."""
    if not estimate.is_known:
        return "–"
    error = judged_error(estimate)
    places = decimals(error) if digits is None or (math.isfinite(error) and error > 0) else digits
    shown = f"{error:.{places}f}" if math.isfinite(error) else "?"
    words = f"{estimate.value:.{places}f} ± {shown}".replace("-", "−")
    if estimate.steady is False and math.isfinite(estimate.drift):
        words += f" (drifts by {estimate.drift:+.{places}f})".replace("-", "−")
    return words


def listed(points: Sequence[tuple[float, Estimate]], symbol: str, unit: str = "") -> str:
    """Points in words: "0.90 ± 0.01 at φ = 0.75; ..."."""
    return "; ".join(f"{text(estimate)}{unit} at {symbol} = {value:g}" for value, estimate in points)


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of Markdown."""
    lines = ["|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|" for cells in (head, *rows)]
    return "\n".join([lines[0], "|---" * len(head) + "|", *lines[1:]]) + "\n"
