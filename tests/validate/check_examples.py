#!/usr/bin/python3
"""Runs every Python example of a page of the documentation on a run directory. Exits 1 if one fails.

    tests/validate/check_examples.py docs/files.md RUN_DIR

Debian packages: python3-h5py, python3-mdanalysis."""
import re
import subprocess
import sys


def main():
    page, run = sys.argv[1:]
    examples = re.findall(r"^```python\n(.*?)^```", open(page).read(), re.MULTILINE | re.DOTALL)
    if not examples:
        sys.exit(f"{page} has no Python examples")
    failed = 0
    for number, example in enumerate(examples, 1):
        done = subprocess.run([sys.executable, "-c", example, run], text=True, capture_output=True)
        print(f"{page}, example {number}: {'ok' if done.returncode == 0 else 'FAILED'}\n{done.stdout}", end="")
        if done.returncode != 0:
            print(done.stderr)
            failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
