"""Recorded frames, and what other packages take them as."""
import functools
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from .errors import ShakenError
from .notebook import picture
from .recorded import recorded
from .units import seconds


@dataclass(frozen=True, repr=False)
class Frame:
    """The rods of one instant.

    time:       [s]
    tick:       time over the time step
    positions:  (n, 3) centres of mass [mm]; x and y are wrapped into the box, z is the height above the lowest position
                of the base. NaN, as directors and velocities are, of a tracked rod that was missed in this frame
    directors:  (n, 3) unit vectors along the rods, from tail to head; those of spheres mean nothing
    velocities: (n, 3) [mm/s]; NaN of tracked rods that nobody could follow
    images:     (n, 3) crossings of the border of the box: positions + box * images is a path without jumps
    species:    (n,) 0 for `rods`, 1 and 2 for `rods_2` and `rods_3` as far as the scene has them
    box:        (3,) sides of the box along x and y [mm], and the gap between the plates
    spheres:    the species that are spheres, which have no axis
    periodic:   whether the box is, along x and y: not where side walls stand
    draw:       makes a PNG of it; None where it is not known how
    lacking:    what is not known of tracked rods, in words: /parameters/lacking of docs/files.md
    """

    time: float
    tick: int
    positions: NDArray[Any]
    directors: NDArray[Any]
    velocities: NDArray[Any]
    images: NDArray[Any]
    species: NDArray[Any]
    box: NDArray[Any]
    spheres: tuple[int, ...] = ()
    periodic: tuple[bool, bool] = (True, True)
    draw: Callable[[], bytes | None] | None = field(default=None, compare=False)
    lacking: str = ""

    @property
    def theta(self) -> NDArray[Any]:
        """(n,) angle of each rod in the plane [rad], in (-pi, pi]."""
        return np.arctan2(self.directors[:, 1], self.directors[:, 0])

    @property
    def _mean_axis(self) -> complex:
        """<exp 2i theta> of the first species; NaN of spheres."""
        of_first = self.is_seen & (self.species == 0)
        has_axis = 0 not in self.spheres and of_first.any()
        return complex(np.exp(2j * self.theta[of_first]).mean()) if has_axis else complex("nan")

    @property
    def is_seen(self) -> NDArray[Any]:
        """(n,) whether a rod is there: of a run, all are."""
        return np.asarray(~np.isnan(self.positions[:, 0]))

    @property
    def order(self) -> float:
        """S = `|<exp 2i theta>|` of the first species, in the plane; NaN of spheres."""
        return float(abs(self._mean_axis))

    @property
    def director_angle(self) -> float:
        """The angle of the nematic director [rad], in (-pi/2, pi/2]: the mean axis of the first species; NaN of
        spheres."""
        return float(np.angle(self._mean_axis) / 2)

    def __repr__(self) -> str:
        return f"<frame at {self.time:g} s: {self.is_seen.sum()} rods, S = {self.order:.3g}>"

    def _repr_png_(self) -> bytes | None:
        return self.draw() if self.draw else None

    def to_freud(self) -> tuple[Any, NDArray[Any], NDArray[Any]]:
        """What freud takes of the n rods that are seen: (box, points, orientations).

        box:          freud.box.Box of the plane, Lx x Ly, periodic where no side walls stand; a tuple (Lx, Ly) where
                      freud is not installed
        points:       (n, 3) float32, counted from the middle of the box, with z = 0, as freud has them in the plane
        orientations: (n, 4) float32 unit quaternions (w, x, y, z) that turn the x axis into the rod's direction in the
                      plane, as freud's two-dimensional computations have them
        """
        points = self.positions[self.is_seen].astype(np.float32)
        points[:, :2] -= (self.box[:2] / 2).astype(np.float32)
        points[:, 2] = 0
        half = self.theta[self.is_seen] / 2
        orientations = np.zeros((len(half), 4), dtype=np.float32)
        orientations[:, 0], orientations[:, 3] = np.cos(half), np.sin(half)
        try:
            import freud
            box = freud.box.Box.from_box([float(self.box[0]), float(self.box[1])])
            box.periodic = [*self.periodic, False]
        except ImportError:
            box = (float(self.box[0]), float(self.box[1]))
        return box, points, orientations


def directors_of(quaternions: NDArray[Any]) -> NDArray[Any]:
    """(..., 3) unit vectors along rods from their quaternions (..., 4), (w, x, y, z), of any length but 0, which turn
    the z axis into them."""
    w, x, y, z = np.moveaxis(np.asarray(quaternions, dtype=float), -1, 0)
    axes = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), w**2 - x**2 - y**2 + z**2], axis=-1)
    return np.asarray(axes / np.linalg.norm(axes, axis=-1, keepdims=True))


class Trajectory:
    """The frames of a trajectory.h5, each read from the file when it is asked for; or of a trajectory.part, in which a
    run that has not ended keeps its frames, as far as it went when it was opened.

    times:   (frames,) [s]
    species: (n,) see Frame

    Raises ShakenError where the file cannot be read.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._recorded = recorded(self.path)
        self.times, self.species = self._recorded.times, self._recorded.species

    @property
    def lengths(self) -> NDArray[Any]:
        """(n,) of the rods, tip to tip [mm]."""
        lengths = [(offset + radius).max() - (offset - radius).min() for offset, radius in self._recorded.beads]
        return np.array(lengths)[self._recorded.shapes]

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        until = f", {self.times[0]:g} to {self.times[-1]:g} s" if len(self) else ""
        return f"<trajectory: {len(self)} frames of {len(self.species)} rods{until}>"

    def __getitem__(self, k: int) -> Frame:
        """Frame k, counted from the end where it is below 0; a slice is none: `frames()` gives many."""
        if isinstance(k, slice):
            raise ShakenError("a trajectory gives one frame at a time; frames() gives many")
        k = range(len(self))[k]
        of, rods = self._recorded, self._recorded.read(k)
        return Frame(float(rods["time"]), int(rods["tick"]), rods["position"].astype(float),
                     directors_of(rods["orientation"]), rods["velocity"].astype(float), rods["image"].copy(),
                     self.species, of.box.copy(), of.spheres, of.periodic, functools.partial(picture, self.path, k),
                     of.lacking)

    def frames(self, every: float | str | None = None) -> Iterator[Frame]:
        """The frames one by one. With `every` ([s], or "0.1 s"), those nearest to its multiples, each once. Raises
        ShakenError where `every` is not above 0."""
        if every is None:
            yield from (self[k] for k in range(len(self)))
            return
        step = seconds(every)
        if not step > 0:
            raise ShakenError(f"`every` must be above 0, not {every}")
        due = self.times[0] if len(self) else 0.0
        for k, time in enumerate(self.times):
            if time >= due - 1e-9 * step:
                yield self[k]
                due += step * max(1, np.floor((time - due) / step + 1 + 1e-9))

    def to_mdanalysis(self) -> Any:
        """An MDAnalysis Universe with an atom for each rod at its centre of mass, in MDAnalysis' units (Angstrom, ps):
        `universe.atoms.positions * 1e-7` is in mm. It needs the package MDAnalysis (Debian: python3-mdanalysis)."""
        import MDAnalysis
        from MDAnalysis.coordinates.H5MD import H5MDReader
        MDAnalysis.units.conversion_factor["length"]["mm"] = 1e-7  # mm per Angstrom
        MDAnalysis.units.conversion_factor["speed"]["mm/s"] = 1e5  # mm/s per Angstrom/ps
        H5MDReader._unit_translation["length"]["mm"] = "mm"
        H5MDReader._unit_translation["velocity"]["mm s-1"] = "mm/s"
        step = {"dt": float(np.diff(self.times[:2])[0]) * 1e12} if len(self) > 1 else {}  # [ps]
        reader = H5MDReader(str(self.path), **step)
        universe = MDAnalysis.Universe.empty(reader.n_atoms, trajectory=True, velocities=True)
        universe.trajectory = reader
        return universe
