"""Observables of Shaken, of rods in arrays: of an experiment's tracks, of another program's frames, of one's own."""
import json
from dataclasses import dataclass
from typing import Any, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .errors import ShakenError
from .frames import Frame
from .native import native
from .run import Run
from .scenes import Scene, as_settings, text_of
from .simulation import measured_run
from .units import seconds


def measure(frames: Iterable[Any], *, interval: float | str | None = None, scene: Scene | None = None, box: Any = None,
            length: float | str = "4.5 mm", settings: Mapping[str, Any] | None = None, followed: bool = True,
            **observables: Any) -> Run:
    """Measures rods of one species, frame by frame, and returns what a run would have of them: numbers with their
    errors, and curves.

        run = shaken.measure(frames, interval="20 ms", box=(33.5, 33.5), order=True, g2={"bins": 100})
        run["S"], run["/g2/g2"]

    frames:      Frame of a run or of a simulation, or tuples of arrays (positions, directors) or (positions, directors,
                 velocities): positions (n, 2) or (n, 3) [mm], directors (n, 2) or (n, 3), or (n,) angles in the plane
                 [rad], velocities (n, 3) [mm/s]. Without z, rods lie between the plates; without velocities those of
                 rods that are followed are displacements, which is said. n may vary. Rods whose position is NaN were
                 missed, and are followed across that frame
    interval:    from one frame to the next [s]; that of the frames where they are `Frame`
    box:         sides of the periodic box [mm]; a scene has other views, as a disc or a rectangle with open edges
    length:      of the rods, by which bins and ranges are chosen that are not given
    scene:       in place of box and length: a scene that has them, with what else it measures (docs/experiment.md)
    settings:    keys that are set in it
    followed:    whether a row is the same rod in every frame. Its path is then the shorter way from frame to frame,
                 where frames do not count the crossings of the border
    observables: the blocks of `measure` (docs/observables.md), True for their defaults

    What the frames do not tell is left out, and said in summary["frames"]["remarks"]. Raises ShakenError with all that
    is wrong with the scene or the frames.
    """
    rods = [_Rods.of(frame) for frame in frames]
    if not rods:
        raise ShakenError("there are no frames")
    if scene is not None and box is not None:
        raise ShakenError("a scene has its box: leave out box=")
    if scene is None:
        if box is None:
            raise ShakenError("say in which box the rods are: box=(Lx, Ly) in mm, or a scene that has it")
        x, y = np.broadcast_to(np.asarray(box, dtype=float), (2,)).tolist()
        scene = {"box": {"side": x, "aspect": y / x}, "rods": {"length": length}}
    asked = {**(settings or {}), **{f"measure.{name}": block for name, block in observables.items()}}
    is_followed = followed and len({len(each.positions) for each in rods}) == 1
    said, summary, arrays = native().measure(
        text_of(scene), as_settings(asked), [each.as_tuple(is_followed) for each in rods], _interval(interval, rods),
        all(each.velocities is not None for each in rods), all(each.has_tilts for each in rods), is_followed,
        rods[0].lacking)
    return measured_run(json.loads(said), summary, arrays, "what was measured on arrays")


@dataclass
class _Rods:
    """The arrays of a frame, of three columns each; velocities, images, time and box are None where it has none."""

    positions: NDArray[Any]
    directors: NDArray[Any]
    velocities: NDArray[Any] | None
    images: NDArray[Any] | None
    time: float | None
    box: tuple[float, float] | None
    has_tilts: bool
    lacking: str | None = None

    @classmethod
    def of(cls, frame: Any) -> "_Rods":
        if isinstance(frame, Frame):
            first = frame.species == 0
            velocities, directors = frame.velocities[first], frame.directors[first]
            return cls(frame.positions[first], directors, None if np.isnan(velocities).any() else velocities,
                       frame.images[first], frame.time, (float(frame.box[0]), float(frame.box[1])), True,
                       frame.lacking)
        if not isinstance(frame, (tuple, list)) or not 2 <= len(frame) <= 3:
            raise ShakenError("a frame is (positions, directors), or with velocities, or a Frame of Shaken")
        positions, directors, *velocities = (np.asarray(each, dtype=float) for each in frame)
        has_tilts = directors.ndim == 2 and directors.shape[-1] == 3
        if directors.ndim == 1:
            directors = np.stack([np.cos(directors), np.sin(directors)], axis=-1)
        directors = directors / np.linalg.norm(directors, axis=-1, keepdims=True)
        return cls(_columns(positions, np.nan), _columns(directors, 0.0),
                   _columns(velocities[0], 0.0) if velocities else None, None, None, None, has_tilts)

    def as_tuple(self, is_followed: bool) -> tuple[Any, ...]:
        velocities = np.zeros_like(self.positions) if self.velocities is None else self.velocities
        if not len(self.positions) == len(self.directors) == len(velocities):
            raise ShakenError(f"a frame has {len(self.positions)} positions and {len(self.directors)} directors: each "
                              "rod has one of either, and a velocity if there are any")
        return self.positions, self.directors, velocities, self.images if is_followed else None, self.box


def _columns(array: NDArray[Any], third: float) -> NDArray[Any]:
    """(n, 3) of (n, 2) or (n, 3)."""
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ShakenError(f"an array of rods has the shape (n, 2) or (n, 3), not {array.shape}")
    return array if array.shape[1] == 3 else np.column_stack([array, np.full(len(array), third)])


def _interval(interval: float | str | None, rods: Sequence[_Rods]) -> float:
    times = [each.time for each in rods if each.time is not None]
    if interval is None and len(times) == len(rods) > 1:
        steps = np.diff(times)
        if not np.allclose(steps, steps.mean(), rtol=1e-3):
            raise ShakenError(f"frames are {steps.min():g} s to {steps.max():g} s apart: equal intervals are measured")
        return float(steps.mean())
    if interval is None:
        raise ShakenError("say how long it is from one frame to the next: interval=\"20 ms\"")
    found = seconds(interval)
    if not found > 0:
        raise ShakenError(f"from one frame to the next it is more than 0 s, not {interval}")
    return found
