# SPDX-License-Identifier: MIT
"""What is written about the runs of a study: verdicts, sets and their cost, versions; as tables of Markdown."""
from __future__ import annotations

import re
import textwrap
from collections import Counter
from pathlib import Path

from ..errors import ShakenError
from .figures import FIGURES
from .library import Library
from .sets import ORDER
from .statements import STATEMENTS, as_table, findings


def origin(library: Library) -> str:
    """Which versions made the runs, how many, and when the last was finished; a list of Markdown."""
    by_version: dict[str, list[str]] = {}
    for run in library.everything:
        versions = run.summary["versions"]
        words = f"shaken {versions['shaken']}, physics {versions['physics']}, {versions['compiler']}"
        by_version.setdefault(words, []).append(run.summary.get("finished") or "")
    return "".join(f"- {len(times)} runs by {words}, the last on {max(times)[:10]}\n"
                   for words, times in sorted(by_version.items()))


def sets_table(library: Library) -> str:
    """What each set has taken, as its runs tell; a table of Markdown."""
    lines = ["| | set | runs | rods | simulated s | CPU-h |", "|---|---|---|---|---|---|"]
    for letter, name in ORDER:
        runs = [*library[name], *library.controls.get(name, [])]
        if not runs:
            continue
        rods = sorted({run.summary["n_rods"] for run in runs})
        lines.append(f"| {letter} | `{name}` | {len(runs)} | {rods[0]} to {rods[-1]} | "
                     f"{sum(run.summary['sim_seconds'] for run in runs):.0f} | "
                     f"{sum(run.summary['cpu_seconds'] for run in runs) / 3600:.2f} |")
    everything = library.everything
    lines.append(f"| | together | {len(everything)} | | {sum(run.summary['sim_seconds'] for run in everything):.0f} | "
                 f"{sum(run.summary['cpu_seconds'] for run in everything) / 3600:.2f} |")
    return "\n".join(lines) + "\n"


def tally(library: Library) -> str:
    """How many statements agree, and so on, in a sentence."""
    counts = Counter(finding.verdict for _, finding in findings(library))
    words = {"agrees": "agree", "consistent": "are consistent with the runs, which could only refute them",
             "in part": "agree in part", "disagrees": "disagree", "contradicts itself": "contradict themselves",
             "open": "are open", "no data": "have no runs yet"}
    listed = [f"{counts[verdict]} {said}" for verdict, said in words.items() if counts[verdict]]
    return _wrapped(f"Of the paper's {len(STATEMENTS)} statements {', '.join(listed)}.").rstrip() + "\n"


def figures_list(library: Library, folder: str) -> str:
    """The figures in `folder`, and which are still to come for want of runs."""
    shown, missing = [], []
    for figure in FIGURES:
        name = f"figure {figure.number}, `{figure.name}`" if figure.number else f"`{figure.name}`"
        if not any(library[set_] for set_ in figure.sets):
            missing.append(name)
            continue
        absent = [set_ for set_ in figure.sets if not library[set_]]
        still = f" *Still without {', '.join(f'`{set_}`' for set_ in absent)}.*" if absent else ""
        shown.append(_wrapped(f"**{name[0].upper() + name[1:]}**: {figure.title}.{still}") +
                     f"\n![{figure.title}]({folder}/{figure.file}.png)\n")
    if missing:
        shown.append(_wrapped(f"Still to come, for none of their runs is in the archive yet: {'; '.join(missing)}."))
    return "\n".join(shown)


def _wrapped(text: str) -> str:
    """A paragraph of Markdown, in lines of at most 120 characters, and an empty line."""
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False) + "\n"


def sections(library: Library, folder: str = "figures") -> dict[str, str]:
    """The sections of a report on everything, by the names of their marks."""
    return {"origin": origin(library), "tally": tally(library), "claims": as_table(findings(library)),
            "sweeps": sets_table(library), "figures": figures_list(library, folder)}


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


def write_report(path: Path, library: Library) -> None:
    """Puts the sections into a Markdown file that has their marks."""
    try:
        document = path.read_text()
    except OSError as error:
        raise ShakenError(f"{path}: {error.strerror}") from None
    path.write_text(with_sections(document, sections(library), str(path)))


