"""Frames of other programs, in GSD."""
from pathlib import Path
from typing import Any, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from .errors import ShakenError, imported
from .frames import Frame
from .units import seconds


def gsd_frames(path: str | Path, *, step: float | str, scale: float = 1.0, axis: Sequence[float] = (0, 0, 1),
               kind: str | None = None) -> Iterator[Frame]:
    """The frames of a GSD file, as HOOMD-blue writes it (Glaser et al., *Comput. Phys. Commun.* **192**, 97 (2015)).
    Places are counted from the corner of the box, and z from the lower face, as `shaken.measure` has them.

    step:  what a time step of the other program lasts [s], or with its unit: times are `configuration.step` times it
    scale: mm in one unit of its lengths; velocities are scaled alike
    axis:  along which a rod lies whose orientation turns nothing
    kind:  the type of particle that is read; all if left out

    Needs the package gsd (Debian: python3-gsd). Raises ShakenError where the file is none.
    """
    gsd = imported("gsd.hoomd")
    turned, duration = np.asarray(axis, dtype=float), seconds(step)
    try:
        with gsd.open(str(path), "rb") as file:
            for snapshot in file:
                rods = snapshot.particles
                if kind is not None and kind not in rods.types:
                    raise ShakenError(f"{path} has no particles '{kind}' but {', '.join(rods.types)}")
                chosen = rods.typeid == rods.types.index(kind) if kind is not None else np.full(rods.N, True)
                box = np.asarray(snapshot.configuration.box[:3], dtype=float) * scale
                is_flat = snapshot.configuration.dimensions == 2
                positions = rods.position[chosen].astype(float) * scale + box / 2
                if is_flat:
                    positions[:, 2] = np.nan
                yield Frame(snapshot.configuration.step * duration, int(snapshot.configuration.step), positions,
                            _turned(rods.orientation[chosen].astype(float), turned),
                            rods.velocity[chosen].astype(float) * scale, rods.image[chosen],
                            np.zeros(chosen.sum(), np.uint8), box)
    except (OSError, RuntimeError, ValueError) as error:
        raise ShakenError(f"{path} is damaged, or no file of GSD: {error}") from None


def _turned(quaternions: NDArray[Any], axis: NDArray[Any]) -> NDArray[Any]:
    """(n, 3) unit vectors: `axis` turned by quaternions (n, 4), (w, x, y, z)."""
    w, vector = quaternions[:, :1], quaternions[:, 1:]
    twice = 2 * np.cross(vector, axis)
    found = axis + w * twice + np.cross(vector, twice)
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))
