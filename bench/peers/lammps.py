"""The scene in LAMMPS: rods are clumps of beads held together by fix rigid/small, contacts are springs with dashpots.

Traps: fix rigid/nve styles leave clumps of finite spheres without rotation, so it has to be fix rigid/small with mass
and inertia from a file; thermo output must not ask for temperature or pressure of clumps. A dashpot of gran/hooke acts
on half a rod's mass between two rods, on a rod's at a plate, which is exact only for central hits."""
import itertools
import math
import operator
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
    arms = arms_of(system)
    side = system.side * MM
    with open(os.path.join(folder, "rods.data"), "w") as f:
        f.write(f"rods\n\n{system.n_rods * n_beads} atoms\n{len(arms)} atom types\n"
                f"0 {side:.10g} xlo xhi\n0 {side:.10g} ylo yhi\n"
                f"{-system.gap * MM:.10g} {2 * system.gap * MM:.10g} zlo zhi\n\nAtoms\n\n")
        number = 0
        for rod, (r, n) in enumerate(zip(system.start.position, system.start.director), 1):
            for s, radius in zip(system.bead_offset, system.bead_radius):
                number += 1
                x, ix = wrapped(r[0] + s * n[0], system.side)
                y, iy = wrapped(r[1] + s * n[1], system.side)
                z = r[2] + s * n[2]
                # the mass that counts is the body's; the beads share it evenly
                density = system.mass * MG / n_beads / (4 / 3 * math.pi * (radius * MM)**3)
                f.write(f"{number} {arms.index(abs(s)) + 1} {x * MM:.12e} {y * MM:.12e} {z * MM:.12e} "
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


def arms_of(system):
    """Distances of beads from the centre, of which each is one type of bead."""
    return sorted({abs(s) for s in system.bead_offset})


def write_contacts(system, path, dt, stiffness, each_arm):
    """Springs of `stiffness` [N/m] with dashpots, and plates that move as Shaken's: base + lid at lo + A (1 - cos(w t))
    with A = -a and lo = 2 a, which is a + a cos(w t). Where a central hit of two rods, or of a rod and a plate, has the
    restitution wanted, those off the centre have a lower one. With `each_arm` each pair of beads, and each bead and
    plate, has a dashpot for its own effective mass, that of hits across the rods."""
    mass = system.mass * MG

    def dashpot(*arms):
        """In kg/s, of hits that far from the centres of the rods concerned."""
        reduced = mass / sum(1 + system.mass * arm**2 / system.inertia_perp for arm in arms)
        critical = 1 / (1 + (math.pi / math.log(system.restitution))**2)  # square of the share of critical damping
        # the dashpot acts half a step late, as if it took c dt / 2 from the mass
        late = critical * stiffness * dt if each_arm else 0
        return math.sqrt(late**2 + 4 * critical * stiffness * reduced) - late

    plates = (f"zplane {2 * system.amplitude * MM:.12g} {(2 * system.amplitude + system.gap) * MM:.12g} "
              f"wiggle z {-system.amplitude * MM:.12g} {1 / system.frequency:.12g}\n")
    arms = arms_of(system)
    with open(path, "w") as f:
        if not each_arm:
            hooke = f"hooke {stiffness:.12g} {stiffness * 2 / 7:.12g} {{0:.12g}} NULL {{1:.12g}} 0".format
            f.write(f"pair_style gran/{hooke(dashpot(0, 0) / (mass / 2), system.mu_rod)}\npair_coeff * *\n"
                    f"fix plates all wall/gran {hooke(dashpot(0) / mass, system.mu_plate)} {plates}")
            return
        hooke = f"hooke {stiffness:.12g} {{0:.12g}} damping velocity tangential linear_nohistory 0.5 {{1:.12g}}".format
        f.write("pair_style granular\n")
        for i, arm in enumerate(arms, 1):
            for j, other in enumerate(arms[i - 1:], i):
                f.write(f"pair_coeff {i} {j} {hooke(dashpot(arm, other), system.mu_rod)}\n")
            f.write(f"group arm{i} type {i}\nfix plates{i} arm{i} wall/gran granular "
                    f"{hooke(dashpot(arm), system.mu_plate)} {plates}")


def read_dump(system, path, dt):
    """Every rod at each instant written, but the first, which is from before the first interval. Directors keep their
    sign, which is that of the start if that first instant is the start's."""
    sign = None
    with open(path) as f:
        size = 9 + system.n_rods
        for lines in iter(lambda: list(itertools.islice(f, size)), []):
            time = system.start.time + int(lines[1]) * dt
            rods = [[float(word) for word in line.split()[1:]] for line in lines[9:]]
            axes = [long_axis(*r[9:13]) for r in rods]
            if sign is None:
                sign = [math.copysign(1, sum(map(operator.mul, n, m))) for n, m in zip(axes, system.start.director)]
                continue
            yield Frame(time, system.base_at(time), [[c / MM for c in r[0:3]] for r in rods],
                        [[s * c for c in n] for s, n in zip(sign, axes)],
                        [[c / MM for c in r[3:6]] for r in rods], [r[6:9] for r in rods])


def long_axis(w, x, y, z):
    """LAMMPS sorts the axes of a body by their moments of inertia, the smallest last."""
    return [2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z]


def simulate(system, folder, dt, settle, timed, frames, every, stiffness, each_arm=False):
    """CPU seconds of `timed` simulated seconds. The first `settle` seconds, and the frames, are not timed. Contacts are
    those of write_contacts, frames go to frames.dump, and beside it are two means over each 25 intervals of frames:
    the power that plates give to all rods [W] (frames.dump.given), and the virial in the plane of the contacts of rods
    [J] (frames.dump.virial)."""
    if abs(round(system.start.time * system.frequency) - system.start.time * system.frequency) > 1e-9:
        raise ValueError("LAMMPS starts its plates at a turning point: the warm-up must be whole vibrations")
    steps = lambda time: round(time / dt)
    contacts = os.path.join(folder, "contacts.lammps")
    write_contacts(system, contacts, dt, stiffness, each_arm)
    frame_every = max(1, steps(every))
    variables = {
        "data": os.path.join(folder, "rods.data"), "bodies": os.path.join(folder, "bodies.txt"),
        "contacts": contacts, "dump": os.path.join(folder, "frames.dump"),
        "reach": 0.6 * system.length * MM, "dt": dt, "gravity": system.gravity * MM,
        "amplitude": -system.amplitude * MM, "period": 1 / system.frequency,
        "settle": steps(settle), "frame_every": frame_every, "mean_every": 25 * frame_every,
        "frames": frames * frame_every, "timed": steps(timed)}
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
    return float(loops[-1][0]) * min(1.0, float(uses[-1]) / 100)


def run(system, folder, dt, settle, timed, frames, every, stiffness):
    """(CPU seconds of `timed` simulated seconds, frames), as simulate."""
    cpu = simulate(system, folder, dt, settle, timed, frames, every, stiffness)
    return cpu, list(read_dump(system, os.path.join(folder, "frames.dump"), dt)) if frames else []
