"""What is written about the runs of a study, in Markdown: verdicts, sets and their cost, versions; and the pages of the
validation, one for each figure of the paper, with the statements that belong to it."""
import functools
import json
import math
import re
import textwrap
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping, Sequence

import numpy as np

from ..errors import ShakenError
from ..estimate import Estimate
from ..plots.series import grouped
from ..run import Run
from .beyond_paper import SECTIONS, strip
from .evidence import Evidence
from .figures import FIGURES
from .material import Figure
from .next_runs import open_questions, open_statements
from .rules import AGREES, CONSISTENT, CONTRADICTS, DISAGREES, IN_PART, NO_DATA, OPEN, SIGMAS, markdown, text
from .sets import ORDER
from .statement import CALIBRATES, HARDLY_FAILS, Statement
from .statements import Verdict, as_table, judged
from .time_step import differences, prices


@dataclass(frozen=True)
class Page:
    """A page.

    name:    of its file without the suffix, "figure-8"
    figures: what is drawn on it, by the ids of `Figure`: the paper's figure, and those beyond it that bear on the same
             statements
    """

    name: str
    figures: tuple[str, ...]

    @property
    def drawn(self) -> list[Figure]:
        return [figure for figure in FIGURES if figure.id in self.figures]

    def has(self, statement: Statement) -> bool:
        return statement.figure in self.figures


PAGES: tuple[Page, ...] = (
    Page("figure-2", ("2",)), Page("figure-3", ("3", "scaling", "steady")), Page("figure-4", ("4",)),
    Page("figure-5", ("5",)), Page("figure-6", ("6", "elasticity")), Page("figure-7", ("7",)),
    Page("figure-8", ("8", "layer-trends", "larger-box", "ends", "gap", "taper")),
    Page("figure-9", ("9", "diffusion-more")), Page("figure-10", ("10",)), Page("figure-11", ("11",)),
    Page("figure-12", ("12",)), Page("figure-13", ("13",)),
    Page("figure-14", ("14", "melting")), Page("shaking", ("shaking",)))


def page_of(statement: Statement) -> Page:
    return next(page for page in PAGES if page.has(statement))


def content(page: Page, images: Sequence[str], found: Sequence[Verdict]) -> str:
    """The figures of a page, as they are in Markdown, and the table of its statements."""
    return "\n".join([*images, as_table([v for v in found if page.has(v.statement)], figure=None)])


def index(found: Sequence[Verdict], folder: str) -> str:
    """The pages, what they show, and the verdicts on their statements; a table of Markdown."""
    rows = []
    for page in PAGES:
        words = [CALIBRATES if v.statement.role == CALIBRATES else v.finding.verdict
                 for v in found if page.has(v.statement)]
        counted = ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))
        shows = "; ".join(figure.title for figure in page.drawn)
        rows.append([f"[{page.name.replace('-', ' ')}]({folder}/{page.name}.md)", shows, counted])
    return markdown(["page", "shows", "statements"], rows)


def origin(evidence: Evidence) -> str:
    """Which versions made the runs, how many, and when the last was finished; a list of Markdown."""
    by_version = grouped(("shaken {shaken}, physics {physics}, {compiler}".format(**run.summary["versions"]),
                          run.summary.get("finished") or "") for run in evidence.everything)
    return "".join(f"- {len(times)} run{'s' * (len(times) > 1)} by {words}, the last on {max(times)[:10]}\n"
                   for words, times in sorted(by_version))


def sets_table(evidence: Evidence) -> str:
    """What each set has taken, as its runs tell; a table of Markdown."""
    def times(runs: Iterable[Run]) -> list[str]:
        return [f"{sum(run.summary['sim_seconds'] for run in runs):.0f}",
                f"{sum(run.summary['cpu_seconds'] for run in runs) / 3600:.2f}"]

    rows = []
    for letter, name in ORDER:
        if runs := [*evidence[name], *evidence.controls.get(name, [])]:
            rods = sorted({run.summary["n_rods"] for run in runs})
            rows.append([letter, f"`{name}`", f"{len(runs)}", f"{rods[0]} to {rods[-1]}", *times(runs)])
    everything = evidence.everything
    return markdown(["", "set", "runs", "rods", "simulated s", "CPU-h"],
                    [*rows, ["", "together", f"{len(everything)}", "", *times(everything)]])


def tally(found: list[Verdict]) -> str:
    """How many statements agree, and so on, in a sentence."""
    calibrating = [verdict for verdict in found if verdict.statement.role == CALIBRATES]
    counted = [verdict for verdict in found if verdict.statement.role != CALIBRATES]
    counts = Counter(verdict.finding.verdict for verdict in counted)
    easy = sum(verdict.statement.role == HARDLY_FAILS and verdict.finding.verdict == AGREES for verdict in counted)
    words = {AGREES: ("agrees", "agree"), CONSISTENT: ("is consistent with the runs", "are consistent with the runs"),
             IN_PART: ("agrees in part", "agree in part"), DISAGREES: ("disagrees", "disagree"),
             CONTRADICTS: ("contradicts itself", "contradict themselves"), OPEN: ("is open", "are open"),
             NO_DATA: ("has no runs yet", "have no runs yet")}
    listed = [f"{counts[verdict]} {said[counts[verdict] > 1]}" +
              (f" ({easy} of them could hardly fail)" if verdict == AGREES and easy else "")
              for verdict, said in words.items() if counts[verdict]]
    were = "was" if len(calibrating) == 1 else "were"
    return _wrapped(f"Of the paper's {len(found)} statements {len(calibrating)} {were} used to choose the model; of "
                    f"the other {len(counted)}, {_and(listed)}.").rstrip() + "\n"


def _and(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def questions(found: list[Verdict]) -> str:
    """How many questions the statements ask, and how many of them are open, in a sentence."""
    answers = [answer for verdict in found for answer in verdict.finding.answers]
    open_ = sum(answer.word is None for answer in answers)
    return _wrapped(f"The statements ask {len(answers)} questions, of which {open_} are open.")


def other_program(path: Path) -> str:
    """What another program finds for the same rods: the numbers of the file that `./dev validate other-program` wrote,
    for each kind of rod; tables of Markdown."""
    cases = json.loads(path.read_text())
    return "\n".join(_compared([case for case in cases if case["rods"] == rods])
                     for rods in dict.fromkeys(case["rods"] for case in cases))


def _compared(cases: list[dict[str, Any]]) -> str:
    found = [{name: Estimate(*number) for name, number in case["numbers"].items()} for case in cases]
    soft = [(case["softness"], numbers) for case, numbers in zip(cases, found) if case["softness"]]
    ours, *others = found
    others.append({name: _extrapolated([(x, them[name]) for x, them in soft if name in them]) for name in ours})
    rows = []
    known, beyond = [0] * len(others), [0] * len(others)
    for name, our in ours.items():
        cells = [text(our)]
        for k, number in enumerate(numbers.get(name, Estimate()) for numbers in others):
            apart = (number.value - our.value) / math.hypot(number.error, our.error)
            known[k] += number.is_known
            beyond[k] += abs(apart) > SIGMAS
            cells.append(f"{text(number)} ({apart:+.1f})".replace("-", "−") if number.is_known else "–")
        rows.append([name, *cells])
    rows.append(["beyond two errors", "", *map("{} of {}".format, beyond, known)])
    rows.append(["simulated s, CPU-h", *(f"{case['seconds']:.0f}, {case['cpu_s'] / 3600:.2f}" for case in cases), ""])
    return markdown([cases[0]["rods"], *(case["title"] for case in cases), "rigid, extrapolated"], rows)


def _extrapolated(points: list[tuple[float, Estimate]]) -> Estimate:
    """The value at 0 of the line through the points that weighs them by their errors; unknown of one point."""
    if len(points) < 2:
        return Estimate()
    where, values, errors = zip(*((x, number.value, number.error) for x, number in points))
    line, covariance = np.polyfit(where, values, 1, w=1 / np.array(errors), cov="unscaled")
    return Estimate(line[1], math.sqrt(covariance[1, 1]))


def images(evidence: Evidence, figures: Iterable[Figure], folder: str) -> list[str]:
    """The figures in `folder`, each a paragraph of Markdown, and which are still to come for want of runs."""
    shown, missing = [], []
    for figure in figures:
        name = f"figure {figure.number}, `{figure.name}`" if figure.number else f"`{figure.name}`"
        if not any(evidence[set_] for set_ in figure.sets):
            missing.append(name)
            continue
        absent = [set_ for set_ in figure.sets if not evidence[set_]]
        still = f" *Still without {', '.join(f'`{set_}`' for set_ in absent)}.*" if absent else ""
        shown.append(_wrapped(f"**{name[0].upper() + name[1:]}**: {figure.title}.{still}") +
                     f"\n![{figure.title}]({folder}/{figure.file}.png)\n")
    if missing:
        shown.append(_wrapped(f"Still to come, for none of their runs is in the archive yet: {'; '.join(missing)}."))
    return shown


def _wrapped(text: str) -> str:
    """A paragraph of Markdown, in lines of at most 120 characters, and an empty line."""
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False) + "\n"


def sections(evidence: Evidence, folder: str = "figures", pages: str = "validation",
             data: Path = Path("data")) -> dict[str, Callable[[], str]]:
    """What makes each section that a page may have, by the names of their marks.

    folder: where the figures are, as seen from the page; pages: where those of the validation are;
    data: the folder of what the tables of the pages need beside the archive
    """
    @functools.cache
    def found() -> list[Verdict]:
        return judged(evidence)

    def link(statement: Statement) -> str:
        return f"[{statement.figure}]({pages}/{page_of(statement).name}.md)"

    beyond = [figure for figure in FIGURES if not any(figure.id in page.figures for page in PAGES)]

    def page_of_statements(page: Page) -> str:
        return content(page, images(evidence, page.drawn, folder), found())

    return {"origin": lambda: origin(evidence), "tally": lambda: tally(found()),
            "questions": lambda: questions(found()),
            "claims": lambda: as_table(found(), link),
            "sweeps": lambda: sets_table(evidence), "index": lambda: index(found(), pages),
            "figures beyond": lambda: "\n".join(images(evidence, beyond, folder)),
            **{page.name: functools.partial(page_of_statements, page) for page in PAGES},
            "strip": lambda: strip(evidence), "time step": lambda: differences(evidence),
            "price of errors": lambda: prices(evidence), "next runs": lambda: open_questions(evidence),
            "open": lambda: open_statements(evidence, found()),
            "other program": lambda: other_program(data / "other-program.json"),
            **{name: functools.partial(make, evidence) for name, make in SECTIONS.items()}}


_MARK = r"<!-- (.+?): (?:begin|end) -->"
_SECTION = r"(<!-- (.+?): begin -->).*?(<!-- \2: end -->)"


def with_sections(document: str, known: Mapping[str, Callable[[], str]], where: str = "the report") -> str:
    """The document with its sections anew: what stands between marks, `<!-- NAME: begin -->` and `<!-- NAME: end -->`.

    Raises ShakenError where it has no marks, marks of a section that is not known, or only one of two.
    """
    names = list(dict.fromkeys(re.findall(_MARK, document)))
    whole = {name for _, name, _ in re.findall(_SECTION, document, re.S)}
    problems = [f"{where} has marks of '{name}', which is no section" for name in names if name not in known]
    problems += [f"{where} lacks one of <!-- {name}: begin --> and <!-- {name}: end -->, or their order is wrong"
                 for name in names if name in known and name not in whole]
    if not names:
        problems.append(f"{where} has no marks: <!-- NAME: begin --> and <!-- NAME: end -->, where NAME is one of "
                        + ", ".join(known))
    if problems:
        raise ShakenError("\n".join(problems))
    return re.sub(_SECTION, lambda match: f"{match[1]}\n{known[match[2]]().rstrip()}\n{match[3]}", document, flags=re.S)


def write_report(path: Path, evidence: Evidence) -> None:
    """Writes the marked sections of a Markdown file anew, and those of its pages: the files with marks in the folder
    beside it that has its name, where there is one."""
    _write(path, sections(evidence, data=path.parent / "data"))
    of_pages = sections(evidence, "../figures", ".")
    for page in sorted(path.with_suffix("").glob("*.md")):
        if re.search(_MARK, page.read_text()):
            _write(page, of_pages)


def _write(path: Path, known: Mapping[str, Callable[[], str]]) -> None:
    try:
        document = path.read_text()
    except OSError as error:
        raise ShakenError(f"{path}: {error.strerror}") from None
    path.write_text(with_sections(document, known, str(path)))
