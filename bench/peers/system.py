"""The scene that all programs run, as `shaken-bench export` wrote it, and what is measured on its states.

Units: mm, s, mg, rad; energies in pJ."""
import json
import math
from dataclasses import dataclass, field


@dataclass
class Frame:
    """Every rod at one time."""
    time: float
    base: float  # height of the lower plate
    position: list
    director: list
    velocity: list
    angular_velocity: list = field(default_factory=list)


@dataclass
class System:
    n_rods: int
    side: float
    gap: float
    amplitude: float
    frequency: float
    gravity: float
    area_fraction: float
    length: float
    bead_offset: list
    bead_radius: list
    mass: float
    inertia_perp: float
    inertia_par: float
    mu_rod: float
    mu_plate: float
    restitution: float
    start: Frame

    @property
    def thickness(self):
        """Diameter of the centre bead."""
        return 2 * max(self.bead_radius)

    @property
    def largest_tilt(self):
        """n_z of a rod in the middle of the gap whose end beads touch both plates."""
        return min(1.0, (self.gap / 2 - self.bead_radius[-1]) / self.bead_offset[-1])

    def base_at(self, time):
        return self.amplitude * math.cos(2 * math.pi * self.frequency * time) + self.amplitude


def frame_of(data):
    return Frame(data["time"], data["base"], data["position"], data["director"], data["velocity"],
                 data["angular_velocity"])


def read(text):
    """The system, and the frames that follow its start."""
    data = json.loads(text)
    rod = data["rod"]
    restitutions = {data[kind]["restitution"] for kind in ("rod_rod", "rod_base", "rod_lid")}
    if len(restitutions) != 1 or data["rod_base"] != data["rod_lid"]:
        raise ValueError("the peers' scene has one restitution, and plates that are alike")
    system = System(
        n_rods=data["n_rods"], side=data["side"], gap=data["gap"], amplitude=data["amplitude"],
        frequency=data["frequency"], gravity=data["gravity"], area_fraction=data["area_fraction"],
        length=rod["length"], bead_offset=rod["bead_offset"], bead_radius=rod["bead_radius"], mass=rod["mass"],
        inertia_perp=rod["inertia_perp"], inertia_par=rod["inertia_par"], mu_rod=data["rod_rod"]["friction"],
        mu_plate=data["rod_base"]["friction"], restitution=restitutions.pop(), start=frame_of(data["start"]))
    return system, [frame_of(frame) for frame in data.get("frames", [])]


@dataclass
class Quality:
    """How well a program kept rods apart, over some frames: a maximum over instants, so a lower bound of the true one.
    """
    rod_rod: float  # deepest overlap of two beads, over the rods' thickness
    rod_plate: float
    kinetic_energy: float  # of translation, mean over the frames [uJ]
    lost: int  # rods whose centre has left the gap or the box, or is no number


def quality(system, frames, periodic):
    deepest_rod = deepest_plate = energy = 0.0
    lost = 0
    for frame in frames:
        deepest_rod = max(deepest_rod, deepest_rod_overlap(system, frame, periodic))
        for r, n in zip(frame.position, frame.director):
            height = r[2] - frame.base
            inside = 0 < height < system.gap and (
                periodic or all(-system.length < r[c] < system.side + system.length for c in (0, 1)))
            lost += not inside
            for s, radius in zip(system.bead_offset, system.bead_radius):
                z = height + s * n[2]
                deepest_plate = max(deepest_plate, radius - z, z + radius - system.gap)
        energy += 0.5 * system.mass * sum(v[0]**2 + v[1]**2 + v[2]**2 for v in frame.velocity)
    n_frames = max(1, len(frames))
    return Quality(deepest_rod / system.thickness, max(0.0, deepest_plate) / system.thickness, 1e-6 * energy / n_frames,
                   lost)


def deepest_rod_overlap(system, frame, periodic):
    """Of any two beads of different rods, found on a grid as wide as the thickest bead; 0 if none overlap."""
    # a box that is not periodic is put into a periodic one with room to spare, where no image is near
    side = system.side if periodic else system.side + 4 * system.length
    n_cells = int(side / system.thickness)
    width = side / n_cells
    cells = {}
    for rod, (r, n) in enumerate(zip(frame.position, frame.director)):
        for s, radius in zip(system.bead_offset, system.bead_radius):
            x, y, z = (r[0] + s * n[0]) % side, (r[1] + s * n[1]) % side, r[2] + s * n[2]
            key = (min(int(x / width), n_cells - 1), min(int(y / width), n_cells - 1))
            cells.setdefault(key, []).append((x, y, z, radius, rod))
    deepest = 0.0
    for (cx, cy), beads in cells.items():
        for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1), (-1, 1)):
            others = cells.get(((cx + dx) % n_cells, (cy + dy) % n_cells))
            if others is None:
                continue
            for k, (x, y, z, radius, rod) in enumerate(beads):
                for ox, oy, oz, other_radius, other_rod in others[k + 1:] if others is beads else others:
                    if other_rod == rod:
                        continue
                    ex, ey = ox - x, oy - y
                    ex -= side * round(ex / side)
                    ey -= side * round(ey / side)
                    reach = radius + other_radius
                    square = ex * ex + ey * ey + (oz - z)**2
                    if square < (reach - deepest)**2:
                        deepest = reach - math.sqrt(square)
    return deepest
