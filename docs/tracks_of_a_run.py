"""Writes the recorded rods of a run as a camera and a tracker would give them: in pixels, with noise, with rods missed.

python3 docs/tracks_of_a_run.py RUN tracks.csv [MISSED] [SHIFT_MM] [TURN_DEG] [MM_PER_PIXEL]
"""
import csv
import sys

import numpy as np

import shaken

run, out = shaken.open(sys.argv[1]), sys.argv[2]
missed, shift, turn, pixel = (float(word) for word in (sys.argv[3:] + ["0.05", "0.02", "1", "0.05"][len(sys.argv) - 3:]))
random = np.random.default_rng(1)
with open(out, "w", newline="") as file:
    table = csv.writer(file)
    table.writerow(["frame", "particle", "x", "y", "angle", "species"])
    for number, frame in enumerate(run.frames()):
        width, height = frame.box[:2]
        seen = random.random(len(frame.positions)) >= missed
        x = (frame.positions[:, 0] + random.normal(0, shift, len(seen))) % width
        y = (frame.positions[:, 1] + random.normal(0, shift, len(seen))) % height
        angle = np.degrees(np.arctan2(frame.directors[:, 1], frame.directors[:, 0])) + random.normal(0, turn, len(seen))
        for i in np.flatnonzero(seen):  # a camera counts y downwards, and an axis has no head
            table.writerow([number, i, f"{x[i] / pixel:.2f}", f"{(height - y[i]) / pixel:.2f}", f"{-angle[i] % 180:.2f}",
                            frame.species[i]])
