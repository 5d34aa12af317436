"""Runs of the rods of one species by themselves: how much they turn at a noise, to a wanted precision."""
import copy
import functools
import json
import math
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from ..system import output_of, scratch_folder
from ..errors import ShakenError
from ..opening import open_run
from .diffusion import BEYOND, Diffusion, diffusion, exponent

#: Independent runs, each with a seed of its own, and rods in each. Runs are independent; rods of a run are where they
#: are alone.
RUNS, RODS = 12, 16
#: The box of rods that are to meet no other, the largest there is [mm]: half a metre from rod to rod.
LARGE_BOX = 2000.0
#: Simulated time of a run after it has become steady, which takes a quarter of it [s]: at first, and at most; of rods
#: without noise at most.
SHORTEST, LONGEST, LONGEST_OWN = 4.0, 320.0, 64.0
#: Rods whose MSAD still grows by such a power of the lag, in runs of such a length [s], have a memory that is too
#: long for the longest runs.
HOPELESS = (32.0, 1.6)
#: Time between samples [s] at first; it is halved until no rod turns by more than 60 degrees between two.
EVERY, FINEST = 5e-3, 2e-4


@dataclass(frozen=True)
class Species:
    """The rods of one species by themselves, as `shaken calibrate` hands them over.

    scene:        of them and nothing else; number, box, noise and times are to be set
    rod_area_mm2: of a rod that lies flat, seen from above
    least_side_mm: of a periodic box in which no rod meets two images of another
    """

    name: str
    has_axis: bool
    rod_area_mm2: float
    least_side_mm: float
    scene: Mapping[str, Any]

    @property
    def key(self) -> str:
        return "plates.noise" if self.name == "rods" else f"plates.{self.name}.noise"


class Unmet(ShakenError):
    """A D_r that rods do not have at any noise, or none that can be measured."""


class NotDiffusive(Unmet):
    """Rods whose turning is not diffusive up to the longest lag [s] at a noise [rad/mm]; exponent: of the MSAD."""

    def __init__(self, noise: float, lag: float, exponent: float) -> None:
        super().__init__(f"at noise {noise:.3g} rad/mm turning is not diffusive: up to lags of {lag:.3g} s the mean "
                         f"square angle grows as lag^{exponent:.2f}")


@dataclass(frozen=True)
class Level:
    """What was measured at one noise [rad/mm] in runs of `length` [s]: `rod_seconds` simulated, `meetings` impulses
    between rods."""

    noise: float
    found: Diffusion
    length: float
    rod_seconds: float
    meetings: int

    @property
    def d_r(self) -> float:
        return self.found.d_r.value

    @property
    def error(self) -> float:
        return self.found.d_r.error

    def as_json(self) -> dict[str, Any]:
        return {"noise_rad_per_mm": self.noise, "rotational_diffusion_rad2_s": self.d_r,
                "rotational_diffusion_sem_rad2_s": self.error, "lag_from_s": self.found.lag_from,
                "lag_to_s": self.found.lag_to, "memory_s": self.found.memory, "rod_seconds": self.rod_seconds,
                "impulses_between_rods": self.meetings}


def scene_of(species: Species, noise: float, area_fraction: float | None, rods: int, run: int, measure: float,
             every: float) -> dict[str, Any]:
    """The scene of run number `run`: so many rods, alone or at an area fraction, for `measure` [s] after a quarter of
    that; samples `every` [s]. Times are whole numbers of ticks."""
    scene = copy.deepcopy(dict(species.scene))
    tick = float(scene["time"]["step"])
    period = tick * max(1, round(every / tick))
    side = LARGE_BOX if area_fraction is None else math.sqrt(rods * species.rod_area_mm2 / area_fraction)
    scene["rods"].pop("area_fraction", None)
    scene["rods"].update(count=rods, start="random" if area_fraction is None or area_fraction <= 0.2 else "compressed")
    scene["box"]["side"] = round(side, 4)
    scene["plates"]["noise"] = noise
    scene["time"].update(steady=period * round(measure / 4 / period), measure=period * round(measure / period),
                         seed=int(scene["time"]["seed"]) + run)
    scene["measure"] = {"order": None, "rotation": {"every": period}}
    scene["stream"] = None
    return scene


def rods_at(area_fraction: float, species: Species) -> int:
    """How many rods there are in a box at an area fraction: RODS, or as many as the smallest box takes."""
    return max(RODS, math.ceil(1.02 * area_fraction * species.least_side_mm**2 / species.rod_area_mm2))


def _longer(level: Level, precision: float, longest: float) -> float:
    """How long runs must be for the precision, with a fifth to spare [s]; at most eight times as long as before."""
    share = level.error / (precision * level.d_r)
    return min(longest, level.length * min(max(1.2 * share**2, 1.5), 8.0))


class Measuring:
    """Measures levels of noise of one species, each once per precision, by runs of the program `shaken`."""

    def __init__(self, species: Species, area_fraction: float | None, program: str, threads: int,
                 say: Callable[[str], None] = lambda line: None) -> None:
        self.species, self.area_fraction, self.program, self.threads = species, area_fraction, program, threads
        self.say = say
        self.rods = RODS if area_fraction is None else rods_at(area_fraction, species)
        self.start, self.every = SHORTEST, EVERY  # what the next level begins with
        self.levels: dict[float, Level] = {}
        self._without: dict[float, NotDiffusive] = {}  # noise at which rods do not diffuse
        self._speed = math.nan  # rod seconds per second

    def level(self, noise: float, precision: float) -> Level:
        """D_r at a noise, to a relative standard error of `precision` if the longest runs give that. Raises
        NotDiffusive."""
        if noise in self._without:
            raise self._without[noise]
        longest = LONGEST if noise > 0 else LONGEST_OWN
        known = self.levels.get(noise)
        if known is not None and (known.error <= precision * known.d_r or known.length >= longest):
            return known
        length = min(self.start, longest) if known is None else _longer(known, precision, longest)
        while True:
            lag, msad, meetings = self._curves(noise, length)
            found = diffusion(lag, msad, length / 2)
            if found is None:
                power = exponent(lag, msad, length / 2)
                if length >= longest or (length >= HOPELESS[0] and power > HOPELESS[1]):
                    self._without[noise] = NotDiffusive(noise, length / 2, power)
                    raise self._without[noise]
                length = min(2 * length, longest)
                continue
            # a rod that has met another has forgotten how it turned once more than it would alone
            disturbed = meetings * found.lag_from / (length * RUNS * self.rods)
            if self.area_fraction is None and disturbed > 0.5 * precision and self.rods > 1:
                self.rods //= 4
                continue
            self.start = max(SHORTEST, 2 * BEYOND * found.lag_to)
            level = self.levels[noise] = Level(noise, found, length, 1.25 * length * RUNS * self.rods, meetings)
            if level.error <= precision * level.d_r or length >= longest:
                self.say(f"{self.species.name}: noise {noise:.4g} rad/mm, D_r {found.d_r}, lags {found.lag_from:.3g} "
                         f"to {found.lag_to:.3g} s")
                return level
            length = _longer(level, precision, longest)

    def _curves(self, noise: float, length: float) -> tuple[NDArray[Any], NDArray[Any], int]:
        """Lags (lags) [s] and MSAD (runs, lags) [rad^2] of all runs, and the impulses between rods."""
        seconds = 1.25 * length * RUNS * self.rods
        while True:
            takes = f", about {seconds / self._speed:.0f} s" if math.isfinite(self._speed) else ""
            self.say(f"{self.species.name}: noise {noise:.4g} rad/mm, {RUNS} runs of {1.25 * length:.3g} s{takes} ...")
            began = time.monotonic()
            with scratch_folder("shaken-calibrate-") as folder, ThreadPoolExecutor(self.threads) as pool:
                runs = list(pool.map(functools.partial(self._run, folder, noise, length), range(RUNS)))
            self._speed = seconds / max(time.monotonic() - began, 1e-3)
            lags, msads, meetings, large_turns = zip(*runs)
            if not any(large_turns):
                n = min(map(len, lags))
                return lags[0][:n], np.array([msad[:n] for msad in msads]), sum(meetings)
            if self.every <= FINEST:
                raise Unmet(f"at noise {noise:.3g} rad/mm rods turn by more than 60 degrees "
                            f"in {self.every:.2g} s, which is too fast to follow: ask for less D_r")
            self.every /= 2

    def _run(self, folder: Path, noise: float, length: float,
             run: int) -> tuple[NDArray[Any], NDArray[Any], int, float]:
        scene = scene_of(self.species, noise, self.area_fraction, self.rods, run, length, self.every)
        file, out = folder / f"{run}.json", folder / str(run)
        file.write_text(json.dumps(scene))
        output_of([self.program, "run", str(file), "--out", str(out)],
                  f"{self.species.name}, noise {noise:.3g} rad/mm")
        found = open_run(out)
        return (np.asarray(found.arrays["/rotation/lag_s"]), np.asarray(found.arrays["/rotation/msad_rad2"]),
                int(found.summary["collisions"]["rod_rod"]), found.numbers["large_turns"].value)
