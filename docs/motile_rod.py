#!/usr/bin/env python3
"""A few motile rods among apolar ones: their tracks, and the flow about them (docs/examples.md).

    shaken run configs/motile.json --out motile
    python3 docs/motile_rod.py motile motile.png
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import shaken

run = shaken.open(sys.argv[1])
field = shaken.field_about(run.frames(), tagged=1, around=0, reach=9, bin_width=1)
figure, (tracks, flow) = plt.subplots(1, 2, figsize=(7.6, 3.4), layout="constrained")

frames = list(run.frames(every="0.5 s"))[:41]  # twenty seconds
director = np.angle(np.mean([frame.order * np.exp(2j * frame.director_angle) for frame in frames])) / 2
turn = np.array([[np.cos(director), np.sin(director)], [-np.sin(director), np.cos(director)]])
for species, colour, width in ((0, "0.55", 0.8), (1, "#D55E00", 1.2)):
    for rod in np.flatnonzero(frames[0].species == species)[:4]:
        path = np.array([(frame.positions + frame.box * frame.images)[rod, :2] for frame in frames]) @ turn.T
        tracks.plot(*(path - path[0]).T, color=colour, lw=width)
tracks.set(xlabel="along the director (mm)", ylabel="across it (mm)", title="tracks of 20 s from one place")

shown = flow.pcolormesh(field.x, field.y, field.velocity[..., 0], cmap="RdBu_r", vmin=-1, vmax=1)
flow.quiver(field.x, field.y, field.velocity[..., 0], field.velocity[..., 1], scale=12, width=0.004)
flow.plot([-2.25, 2.25], [0, 0], color="#D55E00", lw=4, solid_capstyle="round")
flow.set(xlabel="towards its head (mm)", ylabel="to its left (mm)", aspect="equal", title="velocity of apolar rods")
figure.colorbar(shown, ax=flow, label="towards its head (mm/s)")
figure.savefig(sys.argv[2], dpi=150)
centre = abs(field.y) < 1
print(f"{field.n_seen} instants; the rod swims at {field.speed:.2f} mm/s")
for low, high in ((-8, -4), (-4, -2.5), (2.5, 4), (4, 8)):
    part = field.velocity[centre][:, (field.x > low) & (field.x < high), 0]
    error = field.velocity_error[centre][:, (field.x > low) & (field.x < high), 0]
    print(f"{low:g} to {high:g} mm ahead: {np.nanmean(part):.2f} +- "
          f"{np.sqrt(np.nansum(error**2)) / np.isfinite(error).sum():.2f} mm/s")
