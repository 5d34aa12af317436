#!/usr/bin/python3
"""CPU seconds per frame of a film with all that a style can switch, and with each of it off in turn.

    bench/pictures.py build/release/bin/shaken-render RUN...        prints a table in Markdown, a column for each run

The last frames of each recording are drawn at 1920x1080 by one thread, reading and encoding included; what is compared
takes turns, and the least of all rounds counts, which is the one least disturbed by others on the machine.
"""

import argparse
import os
import subprocess
import sys
import tempfile

# Nothing under the rods is seen while they hide it, so they are a little transparent.
ALL_ON = {"rods": "0.8", "samples": "3", "background": "order", "lines": "streamlines", "tracks": "0.002",
          "displacements": "0.002", "inset": "angles", "colour": "layers"}

# What a row is called, and how it differs from all on.
ROWS = [
    ("all on", {}, []),
    ("one sample a pixel", {"samples": "1"}, []),
    ("shadows", {}, ["shadows"]),
    ("gloss", {}, ["gloss"]),
    ("occlusion", {}, ["occlusion"]),
    ("smooth bodies (beads are seen)", {}, ["smooth"]),
    ("rods", {"rods": "0"}, []),
    ("background by local order", {"background": "none"}, []),
    ("streamlines", {"lines": "none"}, []),
    ("defects and their tracks", {}, ["defects"]),
    ("all that needs the director field", {"background": "none", "lines": "none"}, ["defects"]),
    ("arrows of displacement", {"displacements": "0"}, []),
    ("inset", {"inset": "none"}, []),
    ("words: caption, legend, scale bar", {}, ["caption", "legend", "scale-bar"]),
    ("all of these but rods and words",
     {"rods": "1", "samples": "1", "background": "none", "lines": "none", "displacements": "0", "inset": "none"},
     ["shadows", "gloss", "occlusion", "smooth", "defects"]),
]


def cpu_per_frame(command, frames):
    """User and system time of a program, by the number of its frames [s]."""
    # Mesa's own threads would only wait for each other.
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env={**os.environ, "LP_NUM_THREADS": "0"})
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit("failed: " + " ".join(command))
    return (used.ru_utime + used.ru_stime) / frames


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("runs", nargs="+")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--frames", type=int, default=3, help="of each film [3]")
    parser.add_argument("--rounds", type=int, default=3, help="the least of so many counts [3]")
    given = parser.parse_args()
    import h5py

    least = {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(given.rounds):
            for run in given.runs:
                with h5py.File(os.path.join(run, "trajectory.h5")) as recorded:
                    begin = recorded["particles/trajectory/box/edges/time"][-given.frames]
                for name, changed, off in ROWS:
                    style = {k: v for k, v in {**ALL_ON, **changed}.items() if not (k == "tracks" and "defects" in off)}
                    options = [f"--{key}={value}" for key, value in style.items()] + [f"--no-{key}" for key in off]
                    command = [given.program, "movie", run, "-o", folder + "/film.mp4", "--threads=1",
                               f"--from={begin}", f"--size={given.size}", *options]
                    cost = cpu_per_frame(command, given.frames)
                    least[name, run] = min(cost, least.get((name, run), cost))
    print("| switched off | " + " | ".join(given.runs) + " |")
    print("|---" * (1 + len(given.runs)) + "|")
    for name, _, _ in ROWS:
        costs = [f"{least[name, run]:.2f}" for run in given.runs]
        print(f"| {'nothing: ' if name == 'all on' else ''}{name} | " + " | ".join(costs) + " |")


if __name__ == "__main__":
    main()
