# SPDX-License-Identifier: MIT
"""What is written about the runs of a study: verdicts, sets and their cost, versions; as tables of Markdown."""
from __future__ import annotations

import re
import textwrap
from collections import Counter
from pathlib import Path
from typing import Callable, Mapping

from ..errors import ShakenError
from .beyond_paper import SECTIONS
from .evidence import Evidence
from .figures import FIGURES
from .sets import ORDER
from .statements import STATEMENTS, as_table, findings
from .time_step import differences, prices


def origin(evidence: Evidence) -> str:
    """Which versions made the runs, how many, and when the last was finished; a list of Markdown."""
    by_version: dict[str, list[str]] = {}
    for run in evidence.everything:
        versions = run.summary["versions"]
        words = f"shaken {versions['shaken']}, physics {versions['physics']}, {versions['compiler']}"
        by_version.setdefault(words, []).append(run.summary.get("finished") or "")
    return "".join(f"- {len(times)} runs by {words}, the last on {max(times)[:10]}\n"
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
    counts = Counter(finding.verdict for _, finding in findings(evidence))
    words = {"agrees": ("agrees", "agree"),
             "consistent": ("is consistent with the runs, which could only refute it",
                            "are consistent with the runs, which could only refute them"),
             "in part": ("agrees in part", "agree in part"), "disagrees": ("disagrees", "disagree"),
             "contradicts itself": ("contradicts itself", "contradict themselves"), "open": ("is open", "are open"),
             "no data": ("has no runs yet", "have no runs yet")}
    listed = [f"{counts[verdict]} {said[counts[verdict] > 1]}" for verdict, said in words.items() if counts[verdict]]
    return _wrapped(f"Of the paper's {len(STATEMENTS)} statements {', '.join(listed)}.").rstrip() + "\n"


#: Statements about the phase diagram, figure 3.
_PHASES = ("ordered", "disordered", "short", "transition")


def phases(evidence: Evidence) -> str:
    """The paper's words on the phase diagram and what was found, for a page that shows the figure; in Markdown."""
    lines = ["| the paper says | found here | verdict |", "|---|---|---|"]
    for statement, finding in findings(evidence, [s for s in STATEMENTS if s.id in _PHASES]):
        why = f": {finding.why}" if finding.why else ""
        lines.append(f"| {statement.says} | {finding.found or '–'} | {finding.verdict}{why} |")
    return "\n".join(lines) + "\n"


def figures_list(evidence: Evidence, folder: str) -> str:
    """The figures in `folder`, and which are still to come for want of runs."""
    shown, missing = [], []
    for figure in FIGURES:
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
    return "\n".join(shown)


def _wrapped(text: str) -> str:
    """A paragraph of Markdown, in lines of at most 120 characters, and an empty line."""
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False) + "\n"


def sections(evidence: Evidence, folder: str = "figures") -> dict[str, Callable[[], str]]:
    """What makes each section that a page may have, by the names of their marks."""
    return {"origin": lambda: origin(evidence), "tally": lambda: tally(evidence),
            "claims": lambda: as_table(findings(evidence)),
            "phases": lambda: phases(evidence), "sweeps": lambda: sets_table(evidence),
            "figures": lambda: figures_list(evidence, folder), "time step": lambda: differences(evidence),
            "price of errors": lambda: prices(evidence),
            **{name: lambda make=make: make(evidence) for name, make in SECTIONS.items()}}


def with_sections(document: str, known: Mapping[str, Callable[[], str]], where: str = "the report") -> str:
    """The document with its sections anew: what stands between marks, `<!-- NAME: begin -->` and `<!-- NAME: end -->`.

    Raises ShakenError where it has no marks, marks of a section that is not known, or only one of two.
    """
    names = re.findall(r"<!-- (.+?): (?:begin|end) -->", document)
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
    """Writes the marked sections of a Markdown file anew."""
    try:
        document = path.read_text()
    except OSError as error:
        raise ShakenError(f"{path}: {error.strerror}") from None
    path.write_text(with_sections(document, sections(evidence), str(path)))
