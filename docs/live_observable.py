#!/usr/bin/env python3
"""An observable of one's own on running jobs: how much the director bends from one side of the box to the other.

    shakend --relay 127.0.0.1:7700
    python3 docs/live_observable.py 127.0.0.1:7700
"""
import sys

import numpy as np
import shaken

STRIPS = 8


def bend(frame):
    """Standard deviation [degrees] of the directors of strips of the box about that of the whole."""
    strip = (frame.positions[:, 0] / frame.side * STRIPS).astype(int)
    axes = np.array([np.exp(2j * frame.theta[strip == k]).mean() for k in range(STRIPS) if np.any(strip == k)])
    return np.degrees(np.angle(axes * np.exp(-2j * frame.director)) / 2).std()


for frame in shaken.live(relay=sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1:7700"):
    print(f"{frame.job_id[:8]}  t = {frame.time:.3f} s  S = {frame.order:.3f}  bend {bend(frame):.1f} degrees", flush=True)
