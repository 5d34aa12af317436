#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lines of code and of tests in every folder, beside those of the last release (until 0.1.0 is tagged: those before
2026-11-25): how the house grows.

    .ci/size.py            the table
    .ci/size.py --release  writes today's numbers into .ci/size_at_release.json, when a version is released

Counts every line of C++ (.h, .cpp), Python (.py) and JavaScript (.js) that git knows. Tests are counted apart: those
below tests/unit/NAME with folder NAME, the others with the folder `tests`."""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
AT_RELEASE = ROOT / ".ci/size_at_release.json"
LANGUAGES = {".h": "C++", ".cpp": "C++", ".py": "Python", ".js": "JavaScript"}


def place_of(path):
    """The folder that a file is counted with, and whether it is a test."""
    parts = path.parts
    if parts[0] == "tests":
        return (parts[2] if parts[1] == "unit" and len(parts) > 3 else "tests"), True
    return parts[0], "tests" in parts


def sizes():
    """{language: {folder: [lines of code, lines of tests]}}"""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    lines = {}
    for name in subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0"):
        path = pathlib.Path(name)
        language = LANGUAGES.get(path.suffix)
        if language and (ROOT / path).is_file() and not path.parts[0].startswith("."):
            folder, is_test = place_of(path)
            counts = lines.setdefault(language, {}).setdefault(folder, [0, 0])
            counts[is_test] += (ROOT / path).read_bytes().count(b"\n")
    return lines


def row(name, code, old_code, tests, old_tests):
    return f"{name:<12}{code:>8}{old_code:>8}{code - old_code:>+8}{tests:>8}{old_tests:>8}{tests - old_tests:>+8}"


def main():
    now = sizes()
    if sys.argv[1:] == ["--release"]:
        AT_RELEASE.write_text(json.dumps(now, indent=1, sort_keys=True) + "\n")
        return 0
    if sys.argv[1:]:
        print(__doc__)
        return 0 if sys.argv[1:] in (["-h"], ["--help"]) else 2
    before = json.loads(AT_RELEASE.read_text())
    for language in ("C++", "Python", "JavaScript"):
        print(f"\n{language:<12}{'code':>8}{'before':>8}{'':>8}{'tests':>8}{'before':>8}")
        total = [0, 0, 0, 0]
        for folder in sorted({*now.get(language, {}), *before.get(language, {})}):
            code, tests = now.get(language, {}).get(folder, [0, 0])
            old_code, old_tests = before.get(language, {}).get(folder, [0, 0])
            total = [a + b for a, b in zip(total, (code, old_code, tests, old_tests))]
            print(row(folder, code, old_code, tests, old_tests))
        print(row("all", *total))
    return 0


if __name__ == "__main__":
    sys.exit(main())
