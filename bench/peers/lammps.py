# SPDX-License-Identifier: MIT
"""The scene in LAMMPS: rods are clumps of beads held together by fix rigid/small, contacts are springs with dashpots.

Traps: fix rigid/nve styles leave clumps of finite spheres without rotation, so it has to be fix rigid/small with mass
and inertia from a file; thermo output must not ask for temperature or pressure of clumps. A dashpot acts on the
contact's effective mass: half a rod's between two rods, a rod's at a plate, which is exact only for central hits."""
import math
import os
import re
import subprocess

from system import Frame

MM, MG = 1e-3, 1e-6  # in SI units


def inertia_tensor(system, n):
    """Of a rod along n [mg mm^2]."""
    return [[(system.inertia_perp if i == j else 0.0) + (system.inertia_par - system.inertia_perp) * n[i] * n[j]
             for j in range(3)] for i in range(3)]


def wrapped(x, side):
    image = math.floor(x / side)
    return x - image * side, image


def write_start(system, folder):
    """The beads (rods.data) and the bodies that they make (bodies.txt)."""
    n_beads = len(system.bead_offset)
    marked = {0, n_beads // 2, n_beads - 1}
    side = system.side * MM
    with open(os.path.join(folder, "rods.data"), "w") as f:
        f.write(f"rods\n\n{system.n_rods * n_beads} atoms\n2 atom types\n0 {side:.10g} xlo xhi\n0 {side:.10g} ylo yhi\n"
                f"{-system.gap * MM:.10g} {2 * system.gap * MM:.10g} zlo zhi\n\nAtoms\n\n")
        number = 0
        for rod, (r, n) in enumerate(zip(system.start.position, system.start.director), 1):
            for bead, (s, radius) in enumerate(zip(system.bead_offset, system.bead_radius)):
                number += 1
                x, ix = wrapped(r[0] + s * n[0], system.side)
                y, iy = wrapped(r[1] + s * n[1], system.side)
                z = r[2] + s * n[2]
                # the mass that counts is the body's; the beads share it evenly
                density = system.mass * MG / n_beads / (4 / 3 * math.pi * (radius * MM)**3)
                f.write(f"{number} {2 if bead in marked else 1} {x * MM:.12e} {y * MM:.12e} {z * MM:.12e} "
                        f"{2 * radius * MM:.9e} {density:.9e} {rod} {ix} {iy} 0\n")
    with open(os.path.join(folder, "bodies.txt"), "w") as f:
        f.write(f"{system.n_rods}\n")
        start = system.start
        for rod, (r, n, v, w) in enumerate(
                zip(start.position, start.director, start.velocity, start.angular_velocity), 1):
            inertia = inertia_tensor(system, n)
            momentum = [sum(inertia[i][j] * w[j] for j in range(3)) * MG * MM**2 for i in range(3)]
            tensor = [inertia[i][j] * MG * MM**2 for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
            x, ix = wrapped(r[0], system.side)
            y, iy = wrapped(r[1], system.side)
            numbers = [system.mass * MG, x * MM, y * MM, r[2] * MM, *tensor, *[c * MM for c in v], *momentum]
            f.write(f"{rod} " + " ".join(f"{number:.12e}" for number in numbers) + f" {ix} {iy} 0\n")


def read_dump(system, path, dt):
    """Frames from the three marked beads of every rod."""
    frames = []
    with open(path) as f:
        lines = f.read().splitlines()
    size = 9 + 3 * system.n_rods
    for first in range(0, len(lines), size):
        time = system.start.time + int(lines[first + 1]) * dt
        beads = [[float(word) / MM for word in line.split()[1:]] for line in lines[first + 9:first + size]]
        frame = Frame(time, system.base_at(time), [], [], [])
        for tail, centre, head in zip(beads[0::3], beads[1::3], beads[2::3]):
            along = [head[c] - tail[c] for c in range(3)]
            length = math.sqrt(sum(c * c for c in along))
            frame.position.append(centre[:3])
            frame.director.append([c / length for c in along])
            frame.velocity.append(centre[3:])
        frames.append(frame)
    return frames[1:]  # the first is from before the first interval


def run(system, folder, dt, settle, timed, frames, every, stiffness):
    """(CPU seconds of `timed` simulated seconds, frames). The first `settle` seconds, and the frames, are not timed.
    `stiffness` is that of a contact of two beads [N/m]."""
    if abs(round(system.start.time * system.frequency) - system.start.time * system.frequency) > 1e-9:
        raise ValueError("LAMMPS starts its plates at a turning point: the warm-up must be whole vibrations")
    steps = lambda time: round(time / dt)
    log = math.log(system.restitution)
    damping = -2 * log / math.hypot(math.pi, log)  # of gamma in units of sqrt(kn / effective mass)
    mass = system.mass * MG
    dump = os.path.join(folder, "frames.dump")
    variables = {
        "data": os.path.join(folder, "rods.data"), "bodies": os.path.join(folder, "bodies.txt"), "dump": dump,
        "reach": 0.6 * system.length * MM, "dt": dt, "gravity": system.gravity * MM,
        "kn": stiffness, "kt": stiffness * 2 / 7,
        "gamma_rod": damping * math.sqrt(2 * stiffness / mass), "gamma_plate": damping * math.sqrt(stiffness / mass),
        "mu_rod": system.mu_rod, "mu_plate": system.mu_plate,
        # base + lid at lo + A (1 - cos(w t)): with A = -a and lo = 2 a that is a + a cos(w t), as in Shaken
        "base": 2 * system.amplitude * MM, "lid": (2 * system.amplitude + system.gap) * MM,
        "amplitude": -system.amplitude * MM, "period": 1 / system.frequency,
        "settle": steps(settle), "frame_every": max(1, steps(every)), "frames": frames * max(1, steps(every)),
        "timed": steps(timed)}
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rods.lammps")
    command = ["lmp", "-in", script, "-log", "none"]
    for name, value in variables.items():
        command += ["-var", name, f"{value:.12g}" if isinstance(value, float) else str(value)]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    loops = re.findall(r"Loop time of (\S+) on 1 procs for (\d+) steps", done.stdout)
    uses = re.findall(r"([\d.]+)% CPU use", done.stdout)
    if done.returncode != 0 or not loops:
        complaint = re.search(r"ERROR.*", done.stdout + done.stderr)
        raise RuntimeError(complaint[0] if complaint else (done.stdout + done.stderr)[-300:])
    cpu = float(loops[-1][0]) * min(1.0, float(uses[-1]) / 100)
    return cpu, read_dump(system, dump, dt) if frames else []
