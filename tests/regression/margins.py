#!/usr/bin/env python3
"""Tries every margin of sim/bounds/margins.h: sets it to nothing, builds the simulator, and says which tests fail.

    tests/regression/margins.py [NAME ...]     all constants, if none is named; minutes each

A margin that no test misses is either larger than it need be, or met too seldom by the tests' random rods. It works on a
copy of the source in build/margins, so that the tree stays as it is."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COPY = ROOT / "build/margins/source"
BUILD = ROOT / "build/margins/build"
MARGIN = re.compile(r"^(inline constexpr (?:float|double) (k\w+) = )([^;]+);", re.MULTILINE)
TESTS = "unit/(SafeTime|PlateSafeTicks|BeadsMayOverlap|GapBudgets|PairSchedule|SkinBudget)|regression/(.*/)?SteppersAgree"


def run(*command, **options):
    return subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)


def failing_tests():
    built = run("cmake", "--build", str(BUILD), "--target", "sim_test", "steppers_agree_test")
    if built.returncode:
        return ["(does not build)"]
    tests = run("ctest", "--test-dir", str(BUILD), "-R", TESTS, "-j", "2", env={**os.environ, "SHAKEN_NIGHT": "1"})
    return re.findall(r"^\s*\d+ - (\S+) \(", tests.stdout, re.MULTILINE)


def main():
    shutil.rmtree(COPY, ignore_errors=True)
    COPY.mkdir(parents=True)
    files = run("git", "ls-files", "-z", cwd=ROOT).stdout.split("\0")
    for name in filter(None, files):
        if name.startswith(("base/core/", "sim/", "tests/", "packaging/cmake/", "CMake")) and (ROOT / name).is_file():
            (COPY / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, COPY / name)
    made = run("cmake", "-S", str(COPY), "-B", str(BUILD), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
               "-DSHAKEN_ONLY_SIM=ON")
    if made.returncode:
        sys.exit(made.stdout)
    header = COPY / "sim/bounds/margins.h"
    text = header.read_text()
    names = sys.argv[1:] or [match[2] for match in MARGIN.finditer(text)]
    for name in ["", *names]:
        changed = MARGIN.sub(lambda match: f"{match[1]}0;" if match[2] == name else match[0], text)
        if name and changed == text:
            sys.exit(f"{name} is no margin of sim/bounds/margins.h")
        header.write_text(changed)
        print(f"{name or '(as it is)'}: {', '.join(failing_tests()) or 'no test fails'}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
