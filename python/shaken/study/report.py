# SPDX-License-Identifier: MIT
"""What is written about the runs of a study: verdicts, sets and their cost, versions; as tables of Markdown."""
from __future__ import annotations

import re
import textwrap
from collections import Counter
from pathlib import Path

from ..errors import ShakenError
from .figures import FIGURES
from .evidence import Evidence
from .sets import ORDER
from .statements import STATEMENTS, as_table, findings


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
    words = {"agrees": "agree", "consistent": "are consistent with the runs, which could only refute them",
             "in part": "agree in part", "disagrees": "disagree", "contradicts itself": "contradict themselves",
             "open": "are open", "no data": "have no runs yet"}
    listed = [f"{counts[verdict]} {said}" for verdict, said in words.items() if counts[verdict]]
    return _wrapped(f"Of the paper's {len(STATEMENTS)} statements {', '.join(listed)}.").rstrip() + "\n"


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


def sections(evidence: Evidence, folder: str = "figures") -> dict[str, str]:
    """The sections of a report on everything, by the names of their marks."""
    return {"origin": origin(evidence), "tally": tally(evidence), "claims": as_table(findings(evidence)),
            "sweeps": sets_table(evidence), "figures": figures_list(evidence, folder)}


def with_sections(document: str, found: dict[str, str], where: str = "the report") -> str:
    """The document with these sections between their marks, `<!-- NAME: begin -->` and `<!-- NAME: end -->`.

    Raises ShakenError with all marks that it lacks.
    """
    missing = [name for name in found if not re.search(_marks(name), document, flags=re.S)]
    if missing:
        raise ShakenError(f"{where} lacks the marks " + ", ".join(f"<!-- {name}: begin --> and <!-- {name}: end -->"
                                                                  for name in missing))
    for name, text in found.items():
        document = re.sub(_marks(name), lambda match, text=text: f"{match[1]}\n{text.rstrip()}\n{match[2]}", document,
                          flags=re.S)
    return document


def _marks(name: str) -> str:
    return rf"(<!-- {name}: begin -->).*?(<!-- {name}: end -->)"


def write_report(path: Path, evidence: Evidence) -> None:
    """Puts the sections into a Markdown file that has their marks."""
    try:
        document = path.read_text()
    except OSError as error:
        raise ShakenError(f"{path}: {error.strerror}") from None
    path.write_text(with_sections(document, sections(evidence), str(path)))
