#!/usr/bin/env python3
"""Lines of code and of tests in every folder, held to a budget that can only fall by itself.

    .ci/size.py            the table
    .ci/size.py --check    fails where there are more lines than .ci/size_budget.json allows, and where there are fewer
    .ci/size.py --lower    lowers the numbers to what there is, to be committed

Counts every line that is not blank of C++ (.h, .cpp), Python (.py) and JavaScript (.js) that git knows. Tests are
counted apart: those below tests/unit/NAME with folder NAME, the others with the folder `tests`. A number that is raised
is a line of the diff, with its reason in the commit."""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUDGET = ROOT / ".ci/size_budget.json"
LANGUAGES = {".h": "C++", ".cpp": "C++", ".py": "Python", ".js": "JavaScript"}


def place_of(path):
    """The folder that a file is counted with, and whether it is code or tests."""
    parts = path.parts
    if parts[0] == "tests":
        return (parts[2] if parts[1] == "unit" and len(parts) > 3 else "tests"), "tests"
    return parts[0], "tests" if "tests" in parts else "code"


def sizes():
    """{language: {"code" or "tests": {folder: lines}}}"""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    lines = {}
    for name in subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0"):
        path = pathlib.Path(name)
        language = LANGUAGES.get(path.suffix)
        if language and (ROOT / path).is_file() and not path.parts[0].startswith("."):
            folder, kind = place_of(path)
            counts = lines.setdefault(language, {}).setdefault(kind, {})
            here = sum(1 for line in (ROOT / path).read_bytes().split(b"\n") if line.strip())
            counts[folder] = counts.get(folder, 0) + here
    return lines


def table(now, budget):
    for language in dict.fromkeys(LANGUAGES.values()):
        for kind, counts in sorted(now.get(language, {}).items()):
            allowed = budget.get(language, {}).get(kind, {})
            print(f"\n{language + ', ' + kind:<20}{'lines':>8}{'budget':>8}")
            for folder in sorted(counts):
                print(f"{folder:<20}{counts[folder]:>8}{allowed.get(folder, 0):>8}")
            print(f"{'all':<20}{sum(counts.values()):>8}{sum(allowed.values()):>8}")
    together = sum(sum(counts.values()) for kinds in now.values() for counts in kinds.values())
    print(f"\n{'together':<20}{together:>8} lines that are not blank")


def check(now, budget):
    over, lower = [], 0
    for folder, kind, language, lines, allowed in rows(now, budget):
        lower += lines < allowed
        if lines > allowed:
            over.append(f"{folder}: {lines} lines of {kind} in {language}, where {allowed} are allowed")
    if over:
        print("\n".join(over) + "\nTake out what the change replaces, or raise the number in .ci/size_budget.json and "
              "say why in the commit", file=sys.stderr)
    if lower:
        print(f"size: {lower} numbers of .ci/size_budget.json are too high: `./dev size --lower`, and commit it",
              file=sys.stderr)
    return 1 if over or lower else 0


def lower(now, budget):
    for folder, kind, language, lines, allowed in rows(now, budget):
        budget.setdefault(language, {}).setdefault(kind, {})[folder] = min(lines, allowed)
    BUDGET.write_text(json.dumps(budget, indent=1, sort_keys=True) + "\n")
    return 0


def rows(now, budget):
    """(folder, kind, language, lines, lines that are allowed) of each number."""
    return [(folder, kind, language, lines, budget.get(language, {}).get(kind, {}).get(folder, 0))
            for language, kinds in now.items() for kind, counts in kinds.items() for folder, lines in counts.items()]


def main():
    commands = {"": table, "--check": check, "--lower": lower}
    asked = " ".join(sys.argv[1:])
    if asked not in commands:
        print(__doc__)
        return 0 if asked in ("-h", "--help") else 2
    budget = json.loads(BUDGET.read_text()) if BUDGET.exists() else {}
    return commands[asked](sizes(), budget) or 0


if __name__ == "__main__":
    sys.exit(main())
