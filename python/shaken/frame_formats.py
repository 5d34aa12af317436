"""Recorded frames as other programs read them: GSD, and text with one line a rod or a bead (docs/files.md)."""
import json
import re
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

from .errors import imported
from .folder import flattened
from .frames import directors_of
from .recorded import Recorded
from .text import shortest

_RODS = "type:I:1:pos:R:3:id:I:1:orientation:R:4:aspherical_shape:R:3:map_shift:I:3:velo:R:3:director:R:3:theta:R:1"
_BEADS = "species:S:1:pos:R:3:radius:R:1:molecule:I:1"


def swept_height(of: Recorded) -> float:
    """Height that the plates sweep, so that no rod is ever above it [mm]; the gap where the scene is not known."""
    try:
        known = dict(flattened(json.loads(of.header["scene"])))
    except (ValueError, AttributeError):
        known = {}

    def amplitude(block: str, otherwise: float = 0.0) -> float:
        value = known.get(f"plates.{block}amplitude")
        return value if isinstance(value, (int, float)) else otherwise

    base = amplitude("") + amplitude("second.")
    return float(of.box[2]) + (base + amplitude("lid_motion.", base))


def angles_to_director(of: Recorded, frame: Any) -> NDArray[Any]:
    """(n,) angles in the plane between rods and the director of the first species, in [-pi/2, pi/2): by which pictures
    colour them. NaN of spheres and upright rods, and of all where the first species are spheres."""
    directors, species = directors_of(frame["orientation"]), of.species[frame["rods"]]
    across = directors[:, 0] + 1j * directors[:, 1]
    is_known = (across != 0) & ~np.isin(species, of.spheres) & (0 not in of.spheres)
    theta = np.where(is_known, np.angle(across), np.nan)
    axis = np.angle(np.exp(2j * theta[is_known & (species == 0)]).sum()) / 2
    return np.asarray((theta - axis + np.pi / 2) % np.pi - np.pi / 2)


def _texts(values: NDArray[Any]) -> NDArray[Any]:
    """Columns of numbers in single precision, with as many digits as tell them apart."""
    return values.astype(np.float32).astype("S16")


def _lines(columns: list[NDArray[Any]], comment: str) -> bytes:
    rows = np.column_stack(columns).tolist()
    return b"\n".join([b"%d\n%s" % (len(rows), comment.encode()), *map(b" ".join, rows), b""])


def _comment(of: Recorded, properties: str) -> Callable[[Any], str]:
    """The comment line of a frame, in extended XYZ."""
    sides = [shortest(side) for side in (*of.box[:2], swept_height(of))]
    pbc = " ".join("FT"[is_periodic] for is_periodic in (*of.periodic, False))
    run_id, walls = re.sub("[^0-9A-Za-z]", "", of.header["run_id"]), of.header.get("walls", {})  # damage ends no line
    after = 'units="mm s"' + (f' source="Shaken run {run_id} seed {of.header["seed"]}"' if run_id else "")
    after += f" arena={walls['arena']}" if walls else ""
    for name in ("size", "inner", "length", "narrow"):
        if f"{name}_mm" in walls and (name != "inner" or walls["arena"] == "annulus"):
            after += f" arena_{name}={shortest(walls[name + '_mm'])}"
    return lambda frame: (f'Lattice="{sides[0]} 0 0 0 {sides[1]} 0 0 0 {sides[2]}" Properties={properties} pbc="{pbc}" '
                          f"Time={shortest(frame['time'])} Step={frame['tick']} {after}")


def extended_xyz(of: Recorded) -> Callable[[Any], bytes]:
    """Text with one line a rod. Its species stands first, where readers of plain XYZ look for an element, and as a
    number: ASE takes a word for the symbol of one."""
    radii = [(radius.max(), radius.max(), (np.abs(offset) + radius).max()) for offset, radius in of.beads]
    shapes, comment = _texts(np.array(radii)[of.shapes]), _comment(of, _RODS)
    types, ids = (of.species + 1).astype("S"), np.arange(len(of.shapes)).astype("S")

    def text(frame: Any) -> bytes:
        rods = frame["rods"]
        return _lines([types[rods], _texts(frame["position"]), ids[rods],
                       _texts(np.roll(frame["orientation"], -1, axis=1)), shapes[rods], frame["image"].astype("S"),
                       _texts(frame["velocity"]), _texts(directors_of(frame["orientation"])),
                       _texts(angles_to_director(of, frame))], comment(frame))
    return text


def beads_xyz(of: Recorded) -> Callable[[Any], bytes]:
    """Text with one line a bead, whose name is the letter of its species and its number from the tail: "A1"."""
    n_beads = np.array([len(offset) for offset, _ in of.beads])[of.shapes]
    rods = np.repeat(np.arange(len(n_beads)), n_beads)
    offsets, radii = (np.concatenate([of.beads[shape][which] for shape in of.shapes]) for which in (0, 1))
    names = np.array([f"{'ABC'[kind]}{k}" for kind, n in zip(of.species, n_beads) for k in range(1, n + 1)], "S")
    molecules, radii, comment = rods.astype("S"), _texts(radii), _comment(of, _BEADS)

    def text(frame: Any) -> bytes:
        there = np.isin(rods, frame["rods"])
        of_rod = np.repeat(np.arange(len(frame["rods"])), n_beads[frame["rods"]])
        beads = frame["position"][of_rod] + offsets[there, None] * directors_of(frame["orientation"])[of_rod]
        return _lines([names[there], _texts(beads), radii[there], molecules[there]], comment(frame))
    return text


def gsd_snapshots(of: Recorded) -> Callable[[Any], Any]:
    """Snapshots of the schema of HOOMD-blue, from the middle of the box; each size of a species is a type."""
    hoomd = imported("gsd.hoomd")
    box = np.array([*of.box[:2], swept_height(of)])
    half = box[:2].astype(np.float32) / 2
    firsts = np.searchsorted(of.species_of_shape, of.species_of_shape)
    types = ["ABC"[kind] + (str(k - firsts[k] + 1) if of.has_sizes else "")
             for k, kind in enumerate(of.species_of_shape)]
    unions = [{"type": "SphereUnion", "diameters": (2 * radius).tolist(), "centers": [[0, 0, z] for z in offset]}
              for offset, radius in of.beads]

    def snapshot(frame: Any) -> Any:
        found = (getattr(hoomd, "Frame", None) or hoomd.Snapshot)()
        place = (frame["position"] - box / 2).astype(np.float32)
        place[:, :2] = np.minimum(place[:, :2], np.nextafter(half, np.float32(0)))  # half a side is the other border
        found.configuration.step, found.configuration.box = frame["tick"], [*box, 0, 0, 0]
        rods = found.particles
        rods.N, rods.typeid, rods.types, rods.type_shapes = len(place), of.shapes[frame["rods"]], types, unions
        rods.position, rods.orientation = place, frame["orientation"]
        rods.velocity, rods.image = frame["velocity"], frame["image"]
        angles = angles_to_director(of, frame)
        found.log = {"particles/theta": angles.astype(np.float32), "time_s": np.array([frame["time"]])}
        return found
    return snapshot
