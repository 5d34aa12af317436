"""The scene in ODE, by a small program of its own (ode_rods.cpp). ODE has no periodic boundaries: Shaken's state is
unwrapped between four side walls that reach round every rod, and the walls then move in until they enclose the area of
the periodic box, so that number and area fraction are the same."""
import os
import subprocess

from system import Frame

HERE = os.path.dirname(os.path.abspath(__file__))
SQUEEZE = 0.3  # time in which the walls move in [s]
REST = 0.1  # and after it, before the state is kept [s]
SQUEEZE_DT = 50e-6


def build(folder):
    program = os.path.join(folder, "ode_rods")
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "ode"], capture_output=True, text=True, check=True)
    subprocess.run(["g++", "-std=c++20", "-O3", "-march=native", "-Wall", "-Wextra", os.path.join(HERE, "ode_rods.cpp"),
                    *flags.stdout.split(), "-o", program], check=True)
    return program


def write_start(system, folder):
    """The system and its start as plain numbers, squeezed into walls of the same area."""
    loose = os.path.join(folder, "loose.txt")
    with open(loose, "w") as f:
        f.write(f"{system.n_rods} {len(system.bead_offset)} {system.side!r} {system.gap!r} {system.amplitude!r} "
                f"{system.frequency!r} {system.gravity!r} {system.mass!r} {system.inertia_par!r} "
                f"{system.inertia_perp!r} {system.mu_rod!r} {system.mu_plate!r} {system.restitution!r} "
                f"{system.start.time!r}\n")
        for s, radius in zip(system.bead_offset, system.bead_radius):
            f.write(f"{s!r} {radius!r}\n")
        start = system.start
        for rod in zip(start.position, start.director, start.velocity, start.angular_velocity):
            f.write(" ".join(repr(c) for vector in rod for c in vector) + "\n")
    program = build(folder)
    subprocess.run([program, "squeeze", loose, os.path.join(folder, "squeezed.txt"), str(SQUEEZE_DT), str(SQUEEZE),
                    str(REST)], check=True)


def read_frames(system, path):
    frames = []
    with open(path) as f:
        lines = f.read().splitlines()
    for first in range(0, len(lines), system.n_rods + 1):
        time, base = (float(word) for word in lines[first].split())
        rods = [[float(word) for word in line.split()] for line in lines[first + 1:first + 1 + system.n_rods]]
        frames.append(Frame(time, base, [r[0:3] for r in rods], [r[3:6] for r in rods], [r[6:9] for r in rods]))
    return frames


def run(system, folder, dt, settle, timed, frames, every):
    """(CPU seconds of `timed` simulated seconds, frames). The first `settle` seconds, and the frames, are not timed."""
    path = os.path.join(folder, "frames.txt")
    done = subprocess.run([os.path.join(folder, "ode_rods"), "run", os.path.join(folder, "squeezed.txt"), path, str(dt),
                           str(settle), str(timed), str(frames), str(every)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError((done.stdout + done.stderr)[-300:])
    return float(done.stdout), read_frames(system, path) if frames else []
