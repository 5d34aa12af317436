"""The pages of the validation: which statements and figures are on them, and how they are written."""
import re
from pathlib import Path

from shaken.archive import archived_runs
from shaken.run import Numbers
from shaken.study.evidence import LENGTH, PACKING, Evidence, key_of
from shaken.study.figures import FIGURES
from shaken.study.next_runs import DECIDING, sets_in, to_do
from shaken.study.report import PAGES, content, index, page_of, write_report
from shaken.study.rules import NO_DATA, OPEN
from shaken.study.statements import STATEMENTS, judged

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_every_statement_is_on_one_page_and_every_figure_on_one_at_most():
    for statement in STATEMENTS:
        assert [page for page in PAGES if page.has(statement)] == [page_of(statement)]
    shown = [id_ for page in PAGES for id_ in page.figures]
    assert len(set(shown)) == len(shown) and set(shown) <= {figure.id for figure in FIGURES}
    assert {figure.number for figure in FIGURES if figure.number} <= set(shown)


def test_every_page_is_there_with_its_own_figures():
    assert {path.stem for path in (DOCS / "validation").glob("*.md")} == {page.name for page in PAGES}
    for page in PAGES:
        text = (DOCS / "validation" / f"{page.name}.md").read_text()
        assert re.findall(r"<!-- (\S+): begin -->", text)[0] == page.name
        for heading in ("## In the paper", "## Here", "## What limits it"):
            assert heading in text


def test_every_figure_of_the_pages_is_kept_and_no_other():
    pages = [*DOCS.glob("*.md"), *DOCS.glob("validation/*.md")]
    used = {(page.parent / link).resolve() for page in pages
            for link in re.findall(r"!\[[^]]*(?:\[[^]]*\][^]]*)*\]\(([^)]*figures/[^)]+)\)", page.read_text())}
    assert used == {path.resolve() for path in (DOCS / "figures").glob("*.png")}


def test_links_between_pages_lead_to_headings():
    def anchors(path):
        headings = re.findall(r"^#+ (.+)$", path.read_text(), re.M)
        return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}

    for page in [DOCS / "validation.md", *DOCS.glob("validation/*.md")]:
        for target, anchor in re.findall(r"\]\(([^)#:]+\.md)(?:#([^)]+))?\)", page.read_text()):
            path = page.parent / target
            assert path.exists(), f"{page.name}: {target}"
            assert not anchor or anchor in anchors(path), f"{page.name}: {target}#{anchor}"


def test_a_page_has_the_rows_of_its_statements_and_the_index_counts_them():
    found = judged(Evidence([]))
    page = next(page for page in PAGES if page.name == "figure-10")
    lines = content(page, ["![a](b.png)\n"], found).splitlines()
    assert lines[0] == "![a](b.png)" and lines[2].startswith("| the paper says | found here | n_eff |")
    of_page = [statement for statement in STATEMENTS if page.has(statement)]
    assert len(lines) == 4 + len(of_page) and all("| – | – | – | – | – | no data" in line for line in lines[4:])
    [row] = [line for line in index(found, "validation").splitlines() if "figure-10.md" in line]
    assert row.startswith("| [figure 10](validation/figure-10.md) |")
    assert row.endswith("| 4 no data, 1 used for calibration |")


def test_where_readers_differ_the_verdict_is_the_one_that_the_page_has():
    document = (DOCS / "validation.md").read_text()
    of_page = {s.says: line.split(" | ")[-1]
               for s in STATEMENTS for line in document.splitlines() if line.count(" | ") == 7 and s.says in line}
    differing = document.partition("## Where other readers differ")[2].partition("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in differing.splitlines() if line.startswith("| ")][1:]
    assert rows
    for said, _, verdict, _ in rows:
        [word] = [words for says, words in of_page.items() if says.startswith(said)]
        assert word.replace("*", "").startswith(verdict), said


def test_a_report_is_written_with_its_pages(tmp_path):
    report, folder = tmp_path / "report.md", tmp_path / "report"
    folder.mkdir()
    report.write_text("<!-- index: begin -->\n<!-- index: end -->\n")
    (folder / "figure-2.md").write_text("<!-- figure-2: begin -->\n<!-- figure-2: end -->\n")
    (folder / "other.md").write_text("a page without marks\n")
    write_report(report, Evidence([]))
    assert "(validation/figure-2.md)" in report.read_text()
    assert "| Rods start aligned, S(0) = 1" in (folder / "figure-2.md").read_text()
    assert (folder / "other.md").read_text() == "a page without marks\n"


def test_archived_runs_that_are_named_as_deciding_a_statement_are_read_by_it():
    read: set[int] = set()

    class Noting(Numbers):
        def __getitem__(self, name):
            read.add(id(self))
            return super().__getitem__(name)

    runs = list(archived_runs(DOCS / "archive"))
    for run in runs:
        run.numbers = Noting(run.numbers)
    evidence, checks = Evidence(runs), {statement.id: statement.check for statement in STATEMENTS}
    for statement, (text, batches) in DECIDING.items():
        named = {float(packing) for packing in re.findall(r"\b0\.\d+\b(?! mm)", text)}
        assert named <= {batch.packing for batch in batches}, f"{statement}: a packing that nobody counts"
        sets = set(sets_in(text))
        assert sets and batches, f"{statement}: no set or no run is named"
        read.clear()
        checks[statement](evidence)
        for batch in batches:
            named = [run for run in runs if sets & {sweep.rpartition("-")[0] for sweep in run.sweeps}
                     and (key_of(run, LENGTH), key_of(run, PACKING)) == (batch.length, batch.packing)]
            assert not named or any(id(run.numbers) in read for run in named), f"{statement}: {batch} is never read"


def test_what_would_decide_an_open_statement_is_not_done_already():
    evidence = Evidence(archived_runs(DOCS / "archive"))
    done = [verdict.statement.id for verdict in judged(evidence)
            if verdict.finding.verdict in (OPEN, NO_DATA) and not to_do(evidence, verdict.statement.id)]
    assert not done, "their runs are in the archive, and have not decided: say what would"
