#!/usr/bin/env python3
"""Holds every link of the pages to a file of the tree, and to a heading where it names one, and every file of code that
a page or a comment names to one that is there. Exits 1 and lists the others. Links to elsewhere are not followed."""
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


def lost_names(files):
    """Names of headers and sources, `stepping/stepper.h`, that end no path of the tree; NAME.cpp stands for any."""
    tails = {"/".join(pathlib.PurePath(file).parts[k:]) for file in files for k in range(file.count("/") + 1)}
    for file in files:
        if not file.endswith((".md", ".h", ".cpp")) or file == "CHANGELOG.md":
            continue
        for number, line in enumerate((ROOT / file).read_text().splitlines(), 1):
            said = line.partition("//")[2] if not file.endswith(".md") else " ".join(re.findall("`[^`]*`", line))
            for name in re.findall(r"(?<![\w./<-])[a-z][\w/]*\.(?:h|cpp)\b", said):
                if name not in tails and not re.search("[A-Z]{3}", name):
                    yield f"{file}:{number}: there is no {name}"


def main():
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()
    files = [file for file in files if (ROOT / file).is_file()]
    pages = [ROOT / file for file in files if file.endswith(".md")]
    bad, n = list(lost_names(files)), 0
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
