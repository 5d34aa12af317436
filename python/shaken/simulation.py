"""A simulation in this process, to be looked at and steered between its steps."""
import functools
import hashlib
import json
import math
import tempfile
from pathlib import Path
from typing import Any, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .errors import ShakenError
from .frames import Frame
from .native import native
from .notebook import picture
from .run import Arrays, Run
from .scenes import Scene, as_settings, text_of
from .units import seconds, unit_of

_MAGIC = b"shaken simulation 1\n"


class Simulation:
    """Rods between their plates, in this process.

        simulation = Simulation("scene.json")
        simulation.advance("0.5 s")
        simulation.positions, simulation.order, simulation.results()["S"]

    The trajectory is that of `shaken run`, bit by bit: the same engine, which depends neither on how far it is advanced
    at once nor on the number of threads. Other threads of Python go on meanwhile, and Ctrl-C ends `advance` between two
    ticks, from which it can be gone on from. What the scene measures is measured; nothing is recorded or drawn.

    scene:      a dict as docs/scene.md has it, the text of a file or its path
    settings:   keys that are set in it: {"rods.area_fraction": 0.75, "time.step": "8 us"}
    threads:    that share each tick; worth it from some 2,000 rods on
    positions:  (n, 3) centres [mm] of rods that take the place of those that the scene places, as `shaken import` takes
                them; z is the height above the base, NaN as low as possible
    directors:  (n, 3) their axes
    velocities: (n, 3) of the centres [mm/s], and `angular_velocities` (n, 3) [rad/s]; drawn as at any other start where
                both are left out
    species:    (n,) 0 for `rods`, 1 and 2 for `rods_2` and `rods_3`; left out where there is one

    Raises ShakenError with all that is wrong with the scene, or with the rods.
    """

    def __init__(self, scene: Scene, settings: Mapping[str, Any] | None = None, *, threads: int = 1,
                 positions: Any = None, directors: Any = None, velocities: Any = None, angular_velocities: Any = None,
                 species: Sequence[int] = ()) -> None:
        asked = (text_of(scene), as_settings(settings))
        if (positions is None) != (directors is None):
            raise ShakenError("give both positions and directors of the rods, or neither")
        if positions is None:
            if velocities is not None or angular_velocities is not None or len(species):
                raise ShakenError("velocities and species are of rods whose positions and directors are given")
            self._native = native().Simulation(*asked)
        else:
            self._native = native().Simulation(*asked, positions, directors, velocities, angular_velocities,
                                               [int(each) for each in species])
        self._begin(threads)

    def _begin(self, threads: int) -> None:
        self._threads, self._stage = threads, getattr(self, "_stage", 0) + 1
        self._now: Frame | None = None
        self._rods: dict[str, Any] = self._native.rods()
        if threads > 1:
            self._native.use_threads(threads)

    @property
    def tick(self) -> int:
        """Time steps of this stage so far."""
        return int(self._native.tick())

    @property
    def time(self) -> float:
        """Since the start, all stages together [s]."""
        return float(self._native.time_before() + self._native.time())

    @property
    def step(self) -> float:
        """The length of a tick [s]."""
        return float(self._native.step())

    @property
    def scene(self) -> dict[str, Any]:
        """The resolved scene of this stage, with every key that matters (docs/scene.md)."""
        return dict(json.loads(self._native.scene()))

    @property
    def state_hash(self) -> str:
        """Of the state of every rod: equal hashes mean equal bits. That of summary.json."""
        return f"{self._native.state_hash():016x}"

    def advance(self, time: float | str | None = None, *, ticks: int | None = None) -> None:
        """Steps on for so long ([s], or with its unit: "10 ms"), or for so many ticks.

        Raises NumericalTrouble where the physics breaks down; the simulation must not be advanced any further then.
        """
        if (time is None) == (ticks is None):
            raise ShakenError("advance by a time, \"10 ms\", or by ticks=1")
        n = seconds(time) / self.step if time is not None else ticks or 0
        if not 0 <= n < 2**53:
            raise ShakenError(f"a simulation goes on for 0 s or more, not for {time if ticks is None else ticks}")
        self._native.advance_to(self.tick + math.floor(n + 0.5))

    def set(self, key: str, value: Any) -> None:
        """Begins a stage in which a key of the scene has another value, as a stage of a protocol does (docs/sweeps.md):
        `simulation.set("plates.gamma", 8)`. It begins with the next vibration of the plates, to which this steps; tick
        and measurements begin anew, and `time` goes on.

        Raises ShakenError where the scene refuses the value, or the rods as they are do not fit.
        """
        self.set_all({key: value})

    def set_all(self, settings: Mapping[str, Any]) -> None:
        """As `set`, of several keys at once."""
        self._native.begin_stage(as_settings(settings))
        self._begin(self._threads)

    @property
    def snapshot(self) -> Frame:
        """The rods as they are now."""
        tick = self._native.tick()
        if self._now is None or self._now.tick != tick:
            now = self._native.frame()
            species = np.array(self._rods["species"] or np.zeros(len(now["positions"])), dtype=np.uint8)
            self._now = Frame(self._native.time_before() + now["time"], now["tick"], now["positions"], now["directors"],
                              now["velocities"], now["images"], species, np.array(now["box"]),
                              tuple(self._rods["spheres"]), self._rods["periodic"],
                              functools.partial(self._picture, self._stage, now["tick"]))
            self._spins = now["angular_velocities"]
        return self._now

    def _picture(self, stage: int, tick: int) -> bytes | None:
        """Of the rods at a tick of a stage, as long as it is that."""
        if (stage, tick) != (self._stage, self.tick):
            return None
        with tempfile.TemporaryDirectory(prefix="shaken-frame-") as folder:
            self._native.write_frame(f"{folder}/trajectory.h5")
            return picture(Path(folder, "trajectory.h5"), 0)

    @property
    def positions(self) -> NDArray[Any]:
        """(n, 3) centres of mass [mm] (Frame.positions)."""
        return self.snapshot.positions

    @property
    def directors(self) -> NDArray[Any]:
        """(n, 3) unit vectors along the rods, from tail to head."""
        return self.snapshot.directors

    @property
    def velocities(self) -> NDArray[Any]:
        """(n, 3) of the centres [mm/s]."""
        return self.snapshot.velocities

    @property
    def angular_velocities(self) -> NDArray[Any]:
        """(n, 3) [rad/s]."""
        self.snapshot
        return self._spins

    @property
    def order(self) -> float:
        """S of the rods as they are now (Frame.order)."""
        return self.snapshot.order

    def results(self) -> Run:
        """What the scene measures, of this stage so far: numbers with their errors, and curves. At the end of the
        scene's time they are those of `shaken run`, bit by bit."""
        summary, arrays = self._native.results()
        return measured_run(self.scene, summary, arrays, "a simulation in this process")

    def checkpoint(self) -> bytes:
        """All that it needs to go on elsewhere, or later, as if it had not stopped. `copy` and `pickle` use it. Raises
        ShakenError after numerical trouble, from which nothing goes on."""
        text, settings, run, time, time_before, *spent, state, measured = self._native.save()
        parts = (state, measured)
        head = json.dumps({"scene": text, "settings": settings, "start": [run, time], "time_before": time_before,
                           "spent": spent, "threads": self._threads, "bytes": [len(part) for part in parts]}).encode()
        body = head + b"\n" + b"".join(parts)
        return _MAGIC + hashlib.blake2b(body, digest_size=16).digest() + body

    @classmethod
    def resume(cls, checkpoint: bytes) -> "Simulation":
        """The simulation of a checkpoint. Raises ShakenError where that is damaged."""
        digest, body = checkpoint[len(_MAGIC):len(_MAGIC) + 16], checkpoint[len(_MAGIC) + 16:]
        if not checkpoint.startswith(_MAGIC) or hashlib.blake2b(body, digest_size=16).digest() != digest:
            raise ShakenError("the checkpoint is damaged, or is none of Simulation.checkpoint()")
        first, _, parts = body.partition(b"\n")
        head = json.loads(first)
        n = head["bytes"][0]
        simulation = cls.__new__(cls)
        simulation._native = native().Simulation((head["scene"], head["settings"], *head["start"], head["time_before"],
                                                  *head["spent"], parts[:n], parts[n:]))
        simulation._begin(head["threads"])
        return simulation

    def __reduce__(self) -> Any:
        return Simulation.resume, (self.checkpoint(),)

    def _repr_png_(self) -> bytes | None:
        return self._picture(self._stage, self.tick)

    def __repr__(self) -> str:
        return f"<simulation at {self.time:g} s: {len(self.positions)} rods, S = {self.order:.3g}>"


def measured_run(scene: dict[str, Any], summary: str, arrays: Mapping[str, NDArray[Any]], where: str) -> Run:
    """A run whose numbers and curves are in memory."""
    read = Arrays(list(arrays), lambda name: (arrays[name], unit_of(name)))
    return Run(scene, json.loads(summary), read, None, where)
