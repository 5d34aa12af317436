# SPDX-License-Identifier: MIT
"""The pages of the validation: one for each figure of the paper, with the statements that belong to it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

from .figures import FIGURES, Figure
from .statements import CALIBRATES, Statement, Verdict, as_table


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
    lines = ["| page | shows | statements |", "|---|---|---|"]
    for page in PAGES:
        words = [CALIBRATES if v.statement.role == CALIBRATES else v.finding.verdict
                 for v in found if page.has(v.statement)]
        counted = ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))
        shows = "; ".join(figure.title for figure in page.drawn)
        lines.append(f"| [{page.name.replace('-', ' ')}]({folder}/{page.name}.md) | {shows} | {counted} |")
    return "\n".join(lines) + "\n"
