#!/usr/bin/env python3
"""What README.md and docs/*.md tell one to type is typed here, in order, in a fresh folder.

    commands_test.py SOURCE BIN

SOURCE is the source tree, BIN the folder of the programs. The commands are those of the pages' indented blocks that
begin with a program of Shaken. They are typed as they stand, but for what SHORTENED says: lengths of runs, and names
that stand for something ("JOB"). A command of the docs is either typed or listed in LEFT_OUT with the reason; one that
is neither, and an entry that fits none, fails the test. Without SHAKEN_NIGHT, those of README.md and docs/commands.md
are typed and no others.
"""
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCE, BIN = Path(sys.argv[1]), Path(sys.argv[2])
HAS_NETWORK = os.environ.get("SHAKEN_OWN_NETWORK") == "1"
PROGRAM = re.compile(r"(shaken|shakend|shaken-[a-z]+) ")

# Of the block of docs/commands.md: each must fit once.
BLOCK_SHORTENED = [
    ("build/release/bin/shakend &", "true"),  # the test has started it
    ("export PATH=$PWD/build/release/bin:$PATH", "true"),
    ("--measure 10min", "--measure 300ms"),
    ("--y theta_m_deg", "--y S"),  # no layers in so short a time
    ("shaken web;", "true;"),  # typed below, in the background
    ("shaken record JOB", "shaken record JOB --for 1s" if HAS_NETWORK else "true"),
]

# Why a command of the docs is not typed.
LEFT_OUT = [
    (r"shaken bench (?!effects)", "minutes to hours; bench/ has tests of its own"),
    (r"shaken bench effects", "minutes"),
    (r"shaken(d)? .*slurm|shaken --root /shared", "needs Slurm; tests/cluster types it"),
    (r"shaken (--root ~/desk )?figures ", "minutes to hours; the block's figure is typed"),
    (r"shakend --(relay|web|root ~/desk)", "another daemon: tests/e2e start these"),
    (r"shaken (watch|record) --lcm-url tcpq", "needs that relay"),
    (r"shaken record -o night", "eight hours"),
    (r"shaken run t\.json", "a table of several scenes"),
    (r"shaken submit tour\.json", "minutes; the block's sweep, of the same points, is typed"),
    (r"shaken clean --older", "asks for an answer"),
    (r"shaken picture RUN --time 35", "of that run, which takes an hour"),
    (r"shaken watch", "typed from the block"),
    (r"shaken web", "typed below"),
]
if not HAS_NETWORK:
    LEFT_OUT.append((r"shaken (record|replay-log)", "needs a network of one's own"))

# Run directories that stand in for RUN, and for those that the docs do not make by a command of their own.
RUNS = ["first", "second", "third", "nematic", "layered"]

problems = []


def fail(text):
    problems.append(text)
    print(f"FAILED: {text}", flush=True)


class Shell:
    """Types commands in a folder of its own, with a daemon of its own."""

    def __init__(self, folder):
        self.folder = folder
        self.environment = {**os.environ, "SHAKEN_ROOT": str(folder / "root"), "PATH": f"{BIN}:{os.environ['PATH']}",
                            "PYTHONPATH": str(folder)}
        (folder / "configs").symlink_to(SOURCE / "configs")
        (folder / "proto").symlink_to(SOURCE / "proto")
        options = [] if HAS_NETWORK else ["--no-lcm"]
        self.daemon = subprocess.Popen([BIN / "shakend", "--slots", "2", *options], env=self.environment, cwd=folder,
                                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert "ready" in self.daemon.stdout.readline()

    def close(self):
        self.daemon.send_signal(signal.SIGTERM)
        if self.daemon.wait(60) != 0:
            fail("the daemon's exit code")

    def type(self, command, allowed=(0,)):
        """The output of `command`; a failure is noted unless its exit code is allowed."""
        began = time.monotonic()
        done = subprocess.run(["bash", "-c", command], env=self.environment, cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=280)
        print(f"{time.monotonic() - began:6.1f} s  {command}", flush=True)
        if done.returncode not in allowed:
            fail(f"{command}\n  exit code {done.returncode}\n  {done.stdout.strip()}")
        return done.stdout

    def serves_a_page(self):
        """`shaken web` prints an address and serves until it is ended."""
        web = subprocess.Popen([BIN / "shaken", "web", "--port", "0"], env=self.environment, cwd=self.folder,
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        if not web.stdout.readline().startswith("open http://127.0.0.1:"):
            fail("shaken web prints no address")
        web.send_signal(signal.SIGINT)
        web.wait(60)


def commands_of(page):
    """The commands of a page's indented blocks, continued lines joined, comments cut off."""
    text = re.sub(r"\\\n\s*", "", (SOURCE / page).read_text())
    for line in text.splitlines():
        if not line.startswith("    "):
            continue
        command = re.sub(r"\s+(#|->|   ).*", "", line.strip())
        command = re.split(r"\s{3,}", command)[0]
        if PROGRAM.match(command + " "):
            yield re.sub(r"\s+", " ", command).removesuffix(" &")


def type_block(shell):
    block = next(part for part in (SOURCE / "docs/commands.md").read_text().split("\n\n") if part.startswith("    "))
    for before, after in BLOCK_SHORTENED:
        if block.count(before) != 1:
            fail(f"commands.md: '{before}' is not there once")
        block = block.replace(before, after)
    job = "JOB"
    for line in block.splitlines():
        command = re.sub(r"\s+# .*", "", line.strip())
        if "JOB" in command and job == "JOB":
            job = shell.type("shaken results s1 --csv").splitlines()[1].split(",")[0][:8]
        output = shell.type(command.replace("JOB", job))
        if command == "shaken init scene.json":
            scene = shell.folder / "scene.json"
            text = scene.read_text()
            assert '"measure": "100 s"' in text
            scene.write_text(text.replace('"measure": "100 s"', '"measure": "200 ms"').replace("100 ms", "20 ms"))
        if "submit" in command and "30 points: 30 new" not in output:
            fail(f"the block's sweep: {output}")
        if "aggregate" in command and len(re.findall(r"^ +0\.[4-8]5 +[24]\.5 ", output, re.M)) != 10:
            fail(f"a table of ten points: {output}")
        if "extend" in command:
            shell.type("shaken wait")
    for file in ["t.pdf", f"{job}.mp4", "f.pdf", f"{job}.gsd", "here/summary.json", "figures-tiny"]:
        if not (shell.folder / file).exists():
            fail(f"the block's commands make no {file}")
    shell.serves_a_page()
    return job


def type_readme(shell):
    """Its scene, in no time, and what follows it."""
    text = (SOURCE / "README.md").read_text().split("```json\n")[1]
    scene, after = text.split("```", 1)
    (shell.folder / "scene.json").write_text(scene.replace('"auto"', "0").replace('"240 s"', '"100 ms"'))
    submit, plot = (line.strip() for line in after.split("\n\n")[1].splitlines()[-2:])
    sweep = re.search(r"sweep (s\d+) .*: 5 points: 5 new", shell.type(submit))
    if not sweep:
        return fail(f"README's sweep: {submit}")
    shell.type(plot.replace("s1", sweep[1]))
    if not (shell.folder / "order.png").exists():
        fail(f"no plot by README's {plot}")


def shortened(command, job):
    """The same with a run, a job and a sweep that are there, and no longer than it must be."""
    for run in RUNS[:3]:
        command = re.sub(r"\bRUN\b", run, command, count=1)
    command = re.sub(r"\b(JOB|1f0c)\b", job, command)
    command = re.sub(r"\b(s3|s2)\b", "s1", command)
    if "mechanism" not in command:
        command = re.sub(r"--time \S+", "--frame last", command)
        command = re.sub(r"--(from|to) \S+s\b", "", command)
    if command.startswith("shaken movie"):
        command = re.sub(r"--size \S+", "", command) + " --size 320x180 --samples 1"
    command = re.sub(r"--displacements \d+", "--displacements 0.02", command)
    command = re.sub(r"--cpu \d+", "--cpu 0.2", command)
    command = re.sub(r"-o (\w+\.lcmlog)", r"-o \1 --for 1s --force", command) if "record" in command else command
    command = command.replace("replay-log run.lcmlog", "replay-log live.lcmlog")
    if command.startswith("shaken submit configs/"):
        command = re.sub(r" (-s time\.\S+|--replicas \d+)", "", command)
        command += " --replicas 1 -s time.steady=0 -s time.measure=200ms -s trajectory.every=100ms"
    if command.startswith("shaken calibrate"):
        command = re.sub(r" -d \S+", "", command) + " -d 20 --precision 0.3 -s time.step=16us -s rods.length=2.5"
    if command.startswith("shaken run ") and not re.search("--out (full|mechanism)", command):  # others need these as they are
        command += " -s time.steady=0 -s time.measure=60ms -s trajectory.every=10ms"
    return command


def lay_out(shell, job):
    """What the commands of docs/experiment.md find in their folder: a run, its tracks, scenes and a paper's curve."""
    (shell.folder / "runs").mkdir()
    (shell.folder / "runs" / "first").symlink_to(shell.folder / "first")
    scene = next((shell.folder / "root" / "runs").glob(job + "*")) / "scene.json"
    (shell.folder / "others.json").write_text(scene.read_text())
    (shell.folder / "paper.csv").write_text("r_mm,g2\n2,0.9\n4,0.8\n6,0.7\n")
    (shell.folder / "dish.json").write_text(re.sub('"steady": "0.4 s"', '"steady": 0',
                                                   (SOURCE / "configs" / "tracks.json").read_text()))
    shell.type(shortened("shaken run dish.json --out sim", job))
    shell.type(f"PYTHONPATH={shlex.quote(str(SOURCE / 'python'))} /usr/bin/python3 "
               f"{shlex.quote(str(SOURCE / 'docs' / 'tracks_of_a_run.py'))} sim tracks.csv")


def type_docs(shell, job):
    typed = 0
    used = set()
    (shell.folder / "sweep.json").write_text('{"scene": {"box": {"side": "16 mm"}, "rods": {"area_fraction": 0.5}, '
                                             '"time": {"steady": 0, "measure": "20 ms"}}, '
                                             '"sweep": {"grid": {"rods.area_fraction": [0.4, 0.5]}}}')
    for run in RUNS:
        shell.type(shortened(f"shaken run configs/quickstart.json --out {run}", job))
    lay_out(shell, job)
    for page in sorted(path.relative_to(SOURCE) for path in (SOURCE / "docs").glob("*.md") if path.stem != "commands"):
        for command in commands_of(page):
            reasons = [pattern for pattern, _ in LEFT_OUT if re.match(pattern, command)]
            used.update(reasons)
            if reasons:
                continue
            command = shortened(command, job)
            allowed = (0, 1) if "--where" in command else (0,)  # no run may be that good
            shell.type(command, allowed)
            typed += 1
    for pattern, reason in LEFT_OUT:
        if pattern not in used:
            fail(f"nothing is left out by '{pattern}' ({reason})")
    print(f"{typed} commands of the docs were typed")
    if typed < 40:
        fail(f"only {typed} commands of the docs were typed")


def cites_as_the_file_says(shell):
    """`shaken cite` and CITATION.cff name the same version and the same paper."""
    file = (SOURCE / "CITATION.cff").read_text()
    printed = shell.type("shaken cite")
    for key in ("version", "doi", "journal", "volume"):
        value = re.search(rf"^ *{key}: \"?([^\"\n]+)", file, re.M)[1]
        if f"{{{value}}}" not in printed:
            fail(f"`shaken cite` does not have the {key} of CITATION.cff, {value}")


def record_live(shell):
    """`shaken record` of a running job, as docs/protocol.md says."""
    if not HAS_NETWORK:
        return
    scene = ('{"box": {"side": "16 mm"}, "rods": {"area_fraction": 0.4}, "time": {"steady": 0, "measure": "60 s"}, '
             '"stream": {"rate": 20}}')
    (shell.folder / "live.json").write_text(scene)
    shell.type("shaken submit live.json --name live")
    shell.type("shaken record live -o live.lcmlog --for 1s")
    shell.type("shaken cancel live")


with tempfile.TemporaryDirectory(prefix="shaken docs ") as name:
    shell = Shell(Path(name))
    try:
        a_job = type_block(shell)
        type_readme(shell)
        cites_as_the_file_says(shell)
        if os.environ.get("SHAKEN_NIGHT"):
            record_live(shell)
            type_docs(shell, a_job)
    finally:
        shell.close()
sys.exit(f"{len(problems)} problems:\n" + "\n".join(problems) if problems else 0)
