# SPDX-License-Identifier: MIT
"""What a computing centre wants to know of a study before it runs there, over `shaken explain --json`."""
from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path
from typing import Any, Mapping

from ..errors import ShakenError


def explained(program: str, file: Path, cores: int) -> dict[str, Any]:
    """What `shaken explain` says of a sweep in Slurm, after a short probe on this machine."""
    done = subprocess.run([program, "explain", str(file), "--executor", "slurm", "--cores", str(cores), "--json"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ShakenError(f"{file}: {done.stderr.strip() or done.stdout.strip()}")
    return json.loads(done.stdout)


def two_digits(value: float) -> str:
    """A number with two digits: estimates know no more."""
    if value == 0:
        return "0"
    digits = 1 - math.floor(math.log10(abs(value)))
    return f"{round(value, digits):,.{max(digits, 0)}f}"


def _hours(seconds: float) -> str:
    return f"{two_digits(seconds / 3600)} h" if seconds >= 3600 else f"{two_digits(seconds / 60)} min"


def write_plan(file: Path, program: str, sweeps: Mapping[str, dict[str, Any]], cores: int, drawing: str) -> list[Path]:
    """Writes the plan (Markdown) and, into the folder FILE-sweeps beside it, the sweeps. Returns what was written."""
    folder = file.with_name(file.stem + "-sweeps")
    folder.mkdir(parents=True, exist_ok=True)
    rows, written = [], []
    tasks = runs = 0
    core_hours = disk = memory = longest = 0.0
    for name, sweep in sweeps.items():
        path = folder / f"{name}.json"
        path.write_text(json.dumps(sweep, indent=2) + "\n")
        written.append(path)
        told = explained(program, path, cores)
        slurm = told["slurm"]
        runs, tasks = runs + told["n_runs"], tasks + slurm["n_tasks"]
        core_hours += slurm["core_hours"]
        disk += told["levels"][0]["disk_bytes"]
        memory = max(memory, float(told["memory_bytes"]))
        longest = max(longest, float(slurm["longest_run_s"]))
        rows.append(f"| {name} | {told['n_runs']} | {slurm['n_tasks']} | {two_digits(slurm['core_hours'])} | "
                    f"{_hours(slurm['longest_run_s'])} | {two_digits(told['memory_bytes'] / 1e6)} MB |")
    text = f"""# Plan: the figures of Sharma & Soni (2024) by Shaken

| set | runs | tasks | core-hours | longest run | memory of a task |
|---|---|---|---|---|---|
""" + "\n".join(rows) + f"""

- **Together** {runs} runs in {tasks} tasks of one core each, {two_digits(core_hours)} core-hours: about
  {_hours(max(longest, core_hours * 3600 / cores))} on {cores} cores.
- **Ask for**, of a task: {_hours(1.5 * longest)} of wall time and {two_digits(1.5 * memory / 1e6)} MB of memory, half
  as much again as estimated. A task that ends early costs another one only: runs go on from their checkpoint.
- **Storage**: {two_digits(disk / 1e9)} GB on a file system that all nodes see; about ten files a run.
- **Software**: Shaken (Debian package, or built with CMake and g++), Slurm, Python 3 with numpy, scipy, matplotlib and
  h5py to draw.
- **The daemon** lives on the login node meanwhile, and hands batches of tasks to Slurm; it takes hardly any CPU time.
- Estimates come from a probe of about a second of one run of each set, on the machine where this was written.

    shakend --root ROOT --executor slurm &
""" + "".join(f"    shaken --root ROOT submit {path.relative_to(file.parent)}\n"
              for path in written) + f"    {drawing}\n"
    file.write_text(text)
    return [file, *written]
