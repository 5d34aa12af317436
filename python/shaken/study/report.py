# SPDX-License-Identifier: MIT
"""What is written about the runs of a study: verdicts, sets and their cost, versions; as tables of Markdown."""
from __future__ import annotations

import functools
import re
import textwrap
from collections import Counter
from pathlib import Path
from typing import Callable, Iterable, Mapping

from ..errors import ShakenError
from .beyond_paper import SECTIONS, strip
from .evidence import Evidence
from .figures import FIGURES, Figure
from .next_runs import open_questions, open_statements
from .other_program import tables
from .pages import PAGES, content, index, page_of
from .rules import AGREES, CONSISTENT, CONTRADICTS, DISAGREES, IN_PART, NO_DATA, OPEN
from .sets import ORDER
from .statements import CALIBRATES, HARDLY_FAILS, STATEMENTS, Statement, Verdict, as_table, judged
from .time_step import differences, prices


def origin(evidence: Evidence) -> str:
    """Which versions made the runs, how many, and when the last was finished; a list of Markdown."""
    by_version: dict[str, list[str]] = {}
    for run in evidence.everything:
        versions = run.summary["versions"]
        words = f"shaken {versions['shaken']}, physics {versions['physics']}, {versions['compiler']}"
        by_version.setdefault(words, []).append(run.summary.get("finished") or "")
    return "".join(f"- {len(times)} run{'s' * (len(times) > 1)} by {words}, the last on {max(times)[:10]}\n"
                   for words, times in sorted(by_version.items()))


def sets_table(evidence: Evidence) -> str:
    """What each set has taken, as its runs tell; a table of Markdown."""
    lines = ["| | set | runs | rods | simulated s | CPU-h |", "|---|---|---|---|---|---|"]
    for letter, name in ORDER:
        runs = [*evidence[name], *evidence.controls.get(name, [])]
        if not runs:
            continue
        rods = sorted({run.summary["n_rods"] for run in runs})
        lines.append(f"| {letter} | `{name}` | {len(runs)} | {rods[0]} to {rods[-1]} | "
                     f"{sum(run.summary['sim_seconds'] for run in runs):.0f} | "
                     f"{sum(run.summary['cpu_seconds'] for run in runs) / 3600:.2f} |")
    everything = evidence.everything
    lines.append(f"| | together | {len(everything)} | | {sum(run.summary['sim_seconds'] for run in everything):.0f} | "
                 f"{sum(run.summary['cpu_seconds'] for run in everything) / 3600:.2f} |")
    return "\n".join(lines) + "\n"


def tally(evidence: Evidence) -> str:
    """How many statements agree, and so on, in a sentence."""
    return _tally(judged(evidence))


def _tally(found: list[Verdict]) -> str:
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


#: Statements about the phase diagram, figure 3.
_PHASES = ("ordered", "disordered", "short", "transition")


def phases(evidence: Evidence) -> str:
    """The paper's words on the phase diagram and what was found, for a page that shows the figure; in Markdown."""
    lines = ["| the paper says | found here | verdict |", "|---|---|---|"]
    for verdict in judged(evidence, [s for s in STATEMENTS if s.id in _PHASES]):
        lines.append(f"| {verdict.statement.says} | {verdict.finding.found or '–'} | {verdict.words} |")
    return "\n".join(lines) + "\n"


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

    on_pages = {id_ for page in PAGES for id_ in page.figures}
    beyond = [figure for figure in FIGURES if figure.id not in on_pages]
    return {"origin": lambda: origin(evidence), "tally": lambda: _tally(found()),
            "questions": lambda: questions(found()),
            "claims": lambda: as_table(found(), link), "phases": lambda: phases(evidence),
            "sweeps": lambda: sets_table(evidence), "index": lambda: index(found(), pages),
            "figures beyond": lambda: "\n".join(images(evidence, beyond, folder)),
            **{page.name: lambda page=page: content(page, images(evidence, page.drawn, folder), found())
               for page in PAGES},
            "strip": lambda: strip(evidence), "time step": lambda: differences(evidence),
            "price of errors": lambda: prices(evidence), "next runs": lambda: open_questions(evidence),
            "open": lambda: open_statements(evidence, found()),
            "other program": lambda: tables(data / "other-program.json"),
            **{name: lambda make=make: make(evidence) for name, make in SECTIONS.items()}}


_MARK = r"<!-- (.+?): (?:begin|end) -->"


def with_sections(document: str, known: Mapping[str, Callable[[], str]], where: str = "the report") -> str:
    """The document with its sections anew: what stands between marks, `<!-- NAME: begin -->` and `<!-- NAME: end -->`.

    Raises ShakenError where it has no marks, marks of a section that is not known, or only one of two.
    """
    names = re.findall(_MARK, document)
    problems = [f"{where} has marks of '{name}', which is no section" for name in dict.fromkeys(names)
                if name not in known]
    problems += [f"{where} lacks one of <!-- {name}: begin --> and <!-- {name}: end -->, or their order is wrong"
                 for name in dict.fromkeys(names) if name in known and not re.search(_marks(name), document, re.S)]
    if not names:
        problems.append(f"{where} has no marks: <!-- NAME: begin --> and <!-- NAME: end -->, where NAME is one of "
                        + ", ".join(known))
    if problems:
        raise ShakenError("\n".join(problems))
    for name in dict.fromkeys(names):
        text = known[name]().rstrip()
        document = re.sub(_marks(name), lambda match, text=text: f"{match[1]}\n{text}\n{match[2]}", document,
                          flags=re.S)
    return document


def _marks(name: str) -> str:
    return rf"(<!-- {re.escape(name)}: begin -->).*?(<!-- {re.escape(name)}: end -->)"


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
