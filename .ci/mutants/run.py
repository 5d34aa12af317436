#!/usr/bin/env python3
"""Small defects, made by rules, and whether the tests notice.

    ./dev mutants                  of the files that the last commit, or what is not committed, changes
    ./dev mutants sim              of a folder
    ./dev mutants --all -n 40      40 of each folder
    ./dev mutants sim --seed 2     others of the same folder
    ./dev mutants analysis --tests analysis_test unit_run      with these tests alone, which is built sooner

All mutants are built at once, in a copy of the sources (build/mutants), each behind a switch. First every test that
takes less than --longest seconds runs once and says to which mutants' places it comes; then each mutant is switched on
for the tests that come to it, the quickest first, until one fails. What survives is a test that is missing, or changes
nothing: such are listed with their reason in .ci/mutants/equal.json. Exits 1 if fewer than --least per cent are killed
in any folder."""
from __future__ import annotations

import argparse
import concurrent.futures
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import cpp  # noqa: E402
import python  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
PLACE = ROOT / "build/mutants"
COPY, BUILD = PLACE / "source", PLACE / "build"
BUILT = PLACE / "built"  #: is there if this run has mutants in C++
FOLDERS = ("base", "proto", "sim", "scene", "analysis", "run", "render", "server", "client", "web", "bench",
           "python/shaken")
EQUAL = Path(__file__).with_name("equal.json")


def tracked() -> list[str]:
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0")
    return [name for name in names if name and (ROOT / name).is_file()]


def changed() -> list[str]:
    """Files that the working tree changes, or where it changes none, the last commit."""
    for what in (["HEAD"], ["HEAD~1", "HEAD"]):
        names = subprocess.run(["git", "diff", "--name-only", *what], cwd=ROOT, check=True, capture_output=True,
                               text=True).stdout.split()
        if names:
            return names
    return []


def folder_of(file: str) -> str:
    return next((folder for folder in FOLDERS if file.startswith(folder + "/")), "")


def possible(files: list[str]) -> list:
    found = []
    for file in files:
        text = (ROOT / file).read_text()
        kind = cpp if file.endswith(".cpp") else python if file.startswith("python/shaken/") else None
        if kind and folder_of(file) and "/peers/" not in file and not file.endswith("main.cpp"):
            found += kind.points(file, text)
    return found


def write_sources(mutants: dict) -> dict[str, dict[int, set[int]]]:
    """The copy of the sources with these mutants. Of each C++ file, the mutants on each line."""
    by_file: dict[str, dict] = {}
    for k, point in mutants.items():
        by_file.setdefault(point.file, {})[k] = point
    lines = {}
    for name in tracked():
        if name.startswith("docs/archive/"):
            continue
        content = (ROOT / name).read_bytes()
        if name in by_file and name.endswith(".cpp"):
            text, lines[name] = cpp.mutated(content.decode(), by_file[name])
            content = text.encode()
        elif name in by_file:
            content = python.mutated(content.decode(), by_file[name]).encode()
        put(COPY / name, content)
    kept = {*tracked(), "base/core/mutant.h", "python/shaken/_mutant.py"}
    for path in [path for path in COPY.rglob("*") if path.is_file() or path.is_symlink()]:
        if path.relative_to(COPY).as_posix() not in kept:
            path.unlink()  # of a former run: CMake would find it
    put(COPY / "base/core/mutant.h", Path(__file__).with_name("mutant.h").read_bytes())
    put(COPY / "python/shaken/_mutant.py", python.SWITCH.encode())
    return lines


def put(path: Path, content: bytes) -> None:
    if not path.exists() or path.read_bytes() != content:  # the others need not be built anew
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def build(mutants: dict, programs: list[str], jobs: int) -> None:
    """Builds programs of the copy, or all, without mutants that do not compile: these are taken out of `mutants`."""
    BUILT.unlink(missing_ok=True)
    lines = write_sources(mutants)
    if not any(point.file.endswith(".cpp") for point in mutants.values()):
        return
    subprocess.run(["cmake", "-S", COPY, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Mutants",
                    "-DCMAKE_CXX_FLAGS_MUTANTS=-O1 -w", "-DSHAKEN_WERROR=OFF", "-DCMAKE_UNITY_BUILD=ON",
                    "-DCMAKE_UNITY_BUILD_BATCH_SIZE=8"], check=True, stdout=subprocess.DEVNULL)
    while True:
        done = subprocess.run(["cmake", "--build", BUILD, "-j", str(jobs), "--target", *(programs or ["all"]), "--",
                               "-k", "0"], capture_output=True, text=True)  # all that do not compile at once
        if done.returncode == 0:
            BUILT.touch()
            return
        wrong = set()
        for name, line in re.findall(rf"{re.escape(str(COPY))}/([\w/]+\.cpp):(\d+):", done.stdout + done.stderr):
            here = lines.get(name, {})  # a word too much is an error of the line before it, too
            wrong |= here.get(int(line)) or here.get(int(line) + 1, set())
        wrong &= mutants.keys()
        if not wrong:
            sys.exit("the mutants cannot be built:\n" + done.stdout[-5000:])
        print(f"   {len(wrong)} do not compile", flush=True)
        for k in wrong:
            del mutants[k]
        lines = write_sources(mutants)


def tests(of_cpp: bool, longest: float, slow: dict[str, float]) -> dict[str, tuple[list[str], str]]:
    """Name -> command and folder, of every test that is not known to take longer."""
    listed = json.loads(subprocess.run(["ctest", "--show-only=json-v1"], cwd=BUILD, check=True, capture_output=True,
                                       text=True).stdout)["tests"] if of_cpp else []
    found = {}
    for test in listed:
        values = {entry["name"]: entry["value"] for entry in test["properties"]}
        if "command" in test and slow.get(test["name"], 0) <= longest and not any(
                label.startswith(("e2e", "cluster")) for label in values.get("LABELS", [])):
            found[test["name"]] = (test["command"], values.get("WORKING_DIRECTORY", str(BUILD)))
    found.pop("unit/Python.Package", None)
    return found


PYTEST = ["/usr/bin/python3", "-B", "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider"]


def trace_python(all_tests: dict, reached: dict, longest: float, jobs: int) -> None:
    """Adds the tests of the Python package that pass within `longest` seconds each."""
    def one(file):
        out = PLACE / f"seen/{file.stem}.json"
        run(([*PYTEST[:-3], "-p", "no:cacheprovider", "-p", "pytest_seen", str(file)], str(COPY)), 40 * longest,
            SHAKEN_MUTANTS_OF_TESTS=str(out), SHAKEN_MUTANTS_SEEN=str(out.with_suffix(".seen")))
        return [json.loads(line) for line in out.read_text().split("\n") if line] if out.exists() else []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for rows in pool.map(one, sorted((COPY / "python/tests").glob("test_*.py"))):
            for row in rows:
                if row["seconds"] > longest or not row["seen"]:
                    continue
                all_tests[row["test"]] = ([*PYTEST, row["test"]], str(COPY))
                for k in row["seen"]:
                    reached.setdefault(k, []).append((row["seconds"] + 1, row["test"]))
    for found in reached.values():
        found.sort()


def run(test: tuple[list[str], str], limit: float, **more: str) -> bool:
    """Whether it passes within that time."""
    programs = BUILD / "bin" if BUILT.exists() else ROOT / "build/release/bin"
    environment = {**os.environ, "SHAKEN_PROGRAMS": str(programs), **more,
                   "PYTHONPATH": f"{COPY / 'python'}:{Path(__file__).resolve().parent}"}
    process = subprocess.Popen(test[0], cwd=test[1], env=environment, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        return process.wait(timeout=limit) == 0
    except subprocess.TimeoutExpired:
        return False
    finally:
        try:
            os.killpg(process.pid, 9)
        except ProcessLookupError:
            pass


def trace(all_tests: dict, longest: float, jobs: int) -> dict[int, list[tuple[float, str]]]:
    """Mutant -> (seconds, test) of those that come to its place, the quickest first."""
    def one(item):
        number, (name, test) = item
        file = PLACE / f"seen/{number}"
        begin = time.monotonic()
        passes = run(test, longest, SHAKEN_MUTANTS_SEEN=str(file))
        seen = {int(line) for line in file.read_text().split()} if passes and file.exists() else set()
        return name, time.monotonic() - begin, seen, passes
    shutil.rmtree(PLACE / "seen", ignore_errors=True)
    (PLACE / "seen").mkdir(parents=True)
    reached: dict[int, list[tuple[float, str]]] = {}
    left_out = []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for name, seconds, seen, passes in pool.map(one, enumerate(all_tests.items())):
            if not passes:
                left_out.append(name)
            for k in seen:
                reached.setdefault(k, []).append((seconds, name))
    if left_out:
        print(f"   {len(left_out)} tests fail or take longer than {longest:g} s, and are left out: "
              f"{', '.join(left_out[:8])}", flush=True)
    return {k: sorted(found) for k, found in reached.items()}


def try_out(mutants: dict, reached: dict, all_tests: dict, jobs: int, most: float, log: str | None) -> dict[int, str]:
    """Mutant -> the test that killed it; "" if none did. `log` is written after each, so that a stop loses none."""
    def one(k):
        spent = 0.0
        for seconds, name in reached.get(k, []):
            if spent > most:
                return k, ""
            spent += seconds
            if not run(all_tests[name], 10 + 10 * seconds, SHAKEN_MUTANT=str(k)):
                return k, name
        return k, ""
    killed = {}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for number, (k, by) in enumerate(pool.map(one, mutants), 1):
            killed[k] = by
            if log:
                write_log(Path(log), mutants, killed, reached)
            if number % 25 == 0:
                print(f"   {number} of {len(mutants)}, {sum(map(bool, killed.values()))} killed", flush=True)
    return killed


def write_log(log: Path, mutants: dict, killed: dict, reached: dict) -> None:
    """What became of those that were tried, as JSON."""
    part = log.with_suffix(".part")
    part.write_text(json.dumps([{
        "number": k, "file": mutants[k].file, "line": mutants[k].line, "rule": mutants[k].rule, "what": mutants[k].what,
        "killed_by": by, "reached_by": len(reached.get(k, []))} for k, by in killed.items()], indent=1))
    part.replace(log)


def report(mutants: dict, killed: dict, reached: dict, equal: list[dict], least: float) -> bool:
    """Prints the table and what survived. Whether enough are killed in every folder."""
    def is_equal(point) -> str:
        text = (ROOT / point.file).read_text().split("\n")[point.line - 1].strip()
        return next((row["why"] for row in equal if (row["file"], row["line"], row["what"]) ==
                     (point.file, text, point.what)), "")
    enough = True
    print(f"\n{'folder':<16}{'mutants':>8}{'killed':>8}{'equal':>8}{'score':>8}")
    for folder in FOLDERS:
        here = [k for k, point in mutants.items() if folder_of(point.file) == folder]
        dead = [k for k in here if killed[k]]
        same = [k for k in here if not killed[k] and is_equal(mutants[k])]
        if here:
            score = 100 * len(dead) / max(1, len(here) - len(same))
            enough &= score >= least or len(here) == len(same)
            print(f"{folder:<16}{len(here):>8}{len(dead):>8}{len(same):>8}{score:>7.0f}%")
    for k, point in sorted(mutants.items(), key=lambda item: (item[1].file, item[1].line)):
        if not killed[k] and not is_equal(point):
            print(f"{point.file}:{point.line}: {point.rule}: {point.what}" + (
                "" if k in reached else " (no test comes here)"))
    return enough


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     prog="./dev mutants")
    parser.add_argument("folder", nargs="*", help=f"of {', '.join(FOLDERS)}, or files")
    parser.add_argument("--all", action="store_true", help="every folder")
    parser.add_argument("-n", "--number", type=int, default=40, help="mutants of each folder (40)")
    parser.add_argument("--seed", type=int, default=1, help="which ones")
    parser.add_argument("--longest", type=float, default=30, help="seconds of the longest test that takes part (30)")
    parser.add_argument("--most", type=float, default=120, help="seconds of tests for one mutant (120)")
    parser.add_argument("--least", type=float, default=92, help="per cent that must be killed in each folder (92)")
    parser.add_argument("--tests", nargs="+", metavar="PROGRAM", help="test programs that take part (all)")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("JOBS", os.cpu_count() or 1)))
    parser.add_argument("--json", metavar="FILE", help="what became of each, as JSON")
    options = parser.parse_args()

    names = tracked()
    wanted = FOLDERS if options.all else options.folder
    files = [name for name in names if any(name == one or name.startswith(one.rstrip("/") + "/") for one in wanted)]
    if not wanted:
        files = [name for name in changed() if name in names]
    of_folder: dict[str, list] = {}
    for point in possible(files):
        of_folder.setdefault(folder_of(point.file), []).append(point)
    draw = random.Random(options.seed)
    chosen = [point for points in of_folder.values() for point in draw.sample(points, min(options.number, len(points)))]
    if not chosen:
        sys.exit("no file there in which a mutant could be made")
    mutants = dict(enumerate(chosen))
    print(f"== {len(mutants)} mutants of {sum(map(len, of_folder.values()))} possible ones", flush=True)
    build(mutants, options.tests, options.jobs)
    costs = {}
    for log in (ROOT / "build").glob("*/Testing/Temporary/CTestCostData.txt"):
        costs.update({line.split()[0]: float(line.split()[2]) for line in log.read_text().split("\n")
                      if len(line.split()) == 3})
    of_cpp = [point.file.endswith(".cpp") for point in mutants.values()]
    all_tests = tests(any(of_cpp), options.longest, costs)
    print("== the tests say to which they come", flush=True)
    reached = trace(all_tests, options.longest, options.jobs)
    if not all(of_cpp):
        trace_python(all_tests, reached, options.longest, options.jobs)
    print(f"== trying {len(mutants)} mutants", flush=True)
    killed = try_out(mutants, reached, all_tests, options.jobs, options.most, options.json)
    equal = json.loads(EQUAL.read_text()) if EQUAL.exists() else []
    return 0 if report(mutants, killed, reached, equal, options.least) else 1


if __name__ == "__main__":
    sys.exit(main())
