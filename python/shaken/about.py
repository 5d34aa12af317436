"""What other rods do about a tagged one, on average, seen from it."""
from dataclasses import dataclass
from typing import Any, Iterable

import numpy as np
from numpy.typing import NDArray

from .errors import ShakenError
from .frames import Frame


@dataclass(frozen=True)
class FieldAbout:
    """Means over the rods about a tagged rod, on a grid whose x axis is the direction of the tagged rod (towards its
    head) and whose y axis points to its left. Bins that no rod was ever in have NaN.

    x, y:           (n,) middles of the bins [mm]; both axes have the same
    density:        (n, n) rods per area [1/mm^2], by [y, x]; also of what lies behind side walls, where there are none
    velocity:       (n, n, 2) mean velocity in the laboratory, by its parts along x and y [mm/s]
    velocity_error: (n, n, 2) its standard error, as if what was seen at different times were independent [mm/s]
    angle:          (n, n) axis of the director against x [rad], in (-pi/2, pi/2]
    order:          (n, n) `|<exp 2i angle>|`
    speed:          mean velocity of the tagged rods along x [mm/s]
    n_seen:         tagged rods times pairs of frames
    """

    x: NDArray[Any]
    y: NDArray[Any]
    density: NDArray[Any]
    velocity: NDArray[Any]
    velocity_error: NDArray[Any]
    angle: NDArray[Any]
    order: NDArray[Any]
    speed: float
    n_seen: int


def field_about(frames: Iterable[Frame], tagged: int = 1, around: int = 0, reach: float = 8.0,
                bin_width: float = 1.0) -> FieldAbout:
    """The field of the rods of species `around` about those of species `tagged`, up to `reach` [mm] to each side, in
    bins of `bin_width` [mm]. A velocity is the displacement from one frame to the next by the time between them, which
    leaves out what is shorter: places and directions are those of the earlier frame. A rod is not seen from itself, nor
    through side walls. Raises ShakenError if there are not two frames, no rods of these species, if tagged ones are
    spheres, which have no direction, or if `reach` is more than half of a periodic box."""
    n = int(round(2 * reach / bin_width))
    sums = np.zeros((5, n, n))  # of 1, v_x, v_y, v_x^2, v_y^2
    axes = np.zeros((n, n), dtype=complex)
    n_seen, way = 0, []
    former: Frame | None = None
    for frame in frames:
        if former is not None:
            stay = former.is_seen & frame.is_seen  # tracked rods may be missed
            tags, others = (np.flatnonzero(stay & (former.species == of)) for of in (tagged, around))
            for species, found in ((tagged, tags), (around, others)):
                if not len(found):
                    raise ShakenError(f"no rod is of species {species}; there are {set(former.species.tolist())}")
            if tagged in former.spheres:
                raise ShakenError(f"species {tagged} are spheres, which have no direction to look in")
            box = np.where(former.periodic, former.box[:2], np.inf)
            if reach > box.min() / 2:
                raise ShakenError(f"a reach of {reach:g} mm is more than half the box of {box.min():g} mm")
            velocity = (_path(frame) - _path(former)) / (frame.time - former.time)
            for tag in tags:
                heading = former.directors[tag, :2] / np.linalg.norm(former.directors[tag, :2])
                turn = np.array([heading, [-heading[1], heading[0]]])  # into the rod's axes
                seen = others[others != tag]
                apart = former.positions[seen, :2] - former.positions[tag, :2]
                image = np.round(apart / box)
                place = (apart - np.where(image, box, 0) * image) @ turn.T
                bins = np.floor((place + reach) / bin_width).astype(int)
                inside = np.all((bins >= 0) & (bins < n), axis=1)
                at = bins[inside, 1], bins[inside, 0]
                v = velocity[seen[inside]] @ turn.T
                for row, values in zip(sums, (1.0, v[:, 0], v[:, 1], v[:, 0]**2, v[:, 1]**2)):
                    np.add.at(row, at, values)
                axis = former.directors[seen[inside], :2] @ turn.T
                turns = np.exp(2j * np.arctan2(axis[:, 1], axis[:, 0]))
                np.add.at(axes, at, np.nan if around in former.spheres else turns)
                way.append(float(velocity[tag] @ heading))
            n_seen += len(tags)
        former = frame
    if not n_seen:
        raise ShakenError("velocities need two frames")
    count = np.where(sums[0] > 0, sums[0], np.nan)
    mean, square = np.moveaxis(sums[1:3] / count, 0, -1), np.moveaxis(sums[3:5] / count, 0, -1)
    middles = (np.arange(n) + 0.5) * bin_width - reach
    return FieldAbout(middles, middles, sums[0] / (n_seen * bin_width**2), mean,
                      np.sqrt(np.maximum(square - mean**2, 0) / count[..., None]),
                      np.angle(axes) / 2 + 0 * count, abs(axes) / count, float(np.mean(way)), n_seen)


def _path(frame: Frame) -> NDArray[Any]:
    """(n, 2) places without jumps at the border of the box [mm]."""
    return (frame.positions + frame.box * frame.images)[:, :2]
