#!/usr/bin/env python3
"""Subjects of commits since the budget of lines (.ci/size_budget.json) came in: at most 72 letters, one thing each.

A semicolon or "and" between two things says that they are two commits; of these the check sees the semicolon."""
import subprocess
import sys

MOST = 72


def log(*words):
    return subprocess.run(["git", "log", *words], capture_output=True, text=True).stdout.split("\n")[:-1]


def main():
    first = log("--diff-filter=A", "--format=%H", "--", ".ci/size_budget.json")
    if not first:  # not committed yet, or a clone without its history
        return 0
    wrong = []
    for line in log("--no-merges", "--format=%h %s", f"{first[-1]}..HEAD"):
        commit, subject = line.split(" ", 1)
        if len(subject) > MOST:
            wrong.append(f"{commit}: {len(subject)} letters, where {MOST} are allowed: {subject}")
        elif ";" in subject:
            wrong.append(f"{commit}: two things in one commit: {subject}")
    print("\n".join(wrong) or f"subjects: those of {len(log('--format=%h', f'{first[-1]}..HEAD'))} commits are short")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
