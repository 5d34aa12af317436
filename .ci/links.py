#!/usr/bin/env python3
"""Holds every link of the pages to a file of the tree, and to a heading where it names one. Exits 1 and lists the
others. Links to elsewhere are not followed."""
import pathlib
import re
import subprocess
import sys
from urllib.parse import unquote

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"\[[^\]]*\]\(<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)|(?:src|href)=\"([^\"]+)\"")


def prose(page):
    """The text without blocks of code, and without code in a line."""
    text = re.sub(r"^(```|~~~).*?^\1", "", page.read_text(), flags=re.S | re.M)
    return re.sub(r"`[^`\n]*`", "``", text)


def anchors(page):
    """The anchors of a page's headings, as GitHub makes them."""
    found = {}
    for heading in re.findall(r"^#{1,6} +(.*?) *#*$", re.sub(r"^(```|~~~).*?^\1", "", page.read_text(),
                                                             flags=re.S | re.M), re.M):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {name if k == 0 else f"{name}-{k}" for name, last in found.items() for k in range(last + 1)}


def main():
    pages = [ROOT / name for name in subprocess.run(
        ["git", "ls-files", "*.md"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()]
    bad, n = [], 0
    for page in pages:
        for match in LINK.finditer(prose(page)):
            target = unquote(match.group(1) or match.group(2))
            if re.match(r"[a-z]+:", target):
                continue
            n += 1
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            if not file.exists():
                bad.append(f"{page.relative_to(ROOT)}: {target} is not there")
            elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                bad.append(f"{page.relative_to(ROOT)}: {target} has no such heading")
    print("\n".join(bad) if bad else f"links: {n} lead somewhere")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
