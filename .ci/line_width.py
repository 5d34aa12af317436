#!/usr/bin/env python3
"""Holds the prose of every Markdown file, the comments of C++ (clang-format leaves them as they are), the Python
package and these scripts to lines of at most 120 characters. Exits 1 and names file and line of each that is longer.

    python3 .ci/line_width.py [FILE ...]      all such files that git knows, if none is named

Not prose are code blocks (fenced, or indented by four spaces after a blank line), rows of tables, and lines that
consist of one link, image or address, because these cannot be broken."""
import pathlib
import re
import subprocess
import sys

WIDTH = 120
ROOT = pathlib.Path(__file__).resolve().parent.parent
FENCE = re.compile(r"\s*(?:[-*+] +|\d+\. +)?(`{3,}|~{3,})")
LINK = r"!?\[[^\]]*\]\([^)]*\)"
LINKED_IMAGE = r"\[!\[[^\]]*\]\([^)]*\)\]\([^)]*\)"
DEFINITION = r"\[[^\]]*\]: *\S+"
ADDRESS = r"<?https?://\S+"
UNBREAKABLE = re.compile(rf"\s*(?:[-*+>] +|\d+\. +)?(?:{LINK}|{LINKED_IMAGE}|{DEFINITION}|{ADDRESS})[.,;:]?\s*")


def long_lines(text):
    """Number and length of every line of prose in `text` that is too long."""
    fence = None         # the marks that opened the block which the line is in
    is_indented = False  # the last line that was not blank belongs to an indented block
    is_blank = True      # the line before is blank
    for number, line in enumerate(text.split("\n"), 1):
        mark = FENCE.match(line)
        if fence:
            if mark and mark[1].startswith(fence) and line.strip() == mark[1]:
                fence = None
            continue
        if mark:
            fence, is_indented, is_blank = mark[1], False, False
        elif not line.strip():
            is_blank = True
        else:
            is_indented = line.startswith("    ") and (is_blank or is_indented)
            is_blank = False
            is_prose = not (is_indented or line.lstrip().startswith("|") or UNBREAKABLE.fullmatch(line))
            if is_prose and len(line) > WIDTH:
                yield number, len(line)


def long_lines_of_code(text, begin=""):
    """Number and length of every line that is too long, of those that begin with these characters."""
    return [(number, len(line)) for number, line in enumerate(text.split("\n"), 1)
            if len(line) > WIDTH and line.lstrip().startswith(begin)]


def long_lines_of(file):
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".md":
        return long_lines(text)
    return long_lines_of_code(text, "//" if file.suffix in (".h", ".cpp") else "")


def files_of_git():
    kinds = ["*.md", "*.h", "*.cpp", "python/*.py", ".ci/*.py", ".ci/run", "dev"]
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", *kinds]
    names = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0")
    return [ROOT / name for name in names if (ROOT / name).is_file()]


def main():
    files = [pathlib.Path(name).resolve() for name in sys.argv[1:]] or files_of_git()
    n_long = 0
    for file in files:
        name = file.relative_to(ROOT) if file.is_relative_to(ROOT) else file
        for number, length in long_lines_of(file):
            print(f"{name}:{number}: {length} characters, where {WIDTH} are allowed")
            n_long += 1
    return 1 if n_long else 0


if __name__ == "__main__":
    sys.exit(main())
