"""What files of recorded frames hold, as it is: trajectory.h5, and the trajectory.part of a run that has not ended
(docs/files.md)."""
import json
import os
import struct
from pathlib import Path
from typing import Any, Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from .errors import Failed, ShakenError
from .hdf5 import hash_of, open_file

_WIDTHS = {"position": 3, "velocity": 3, "orientation": 4, "image": 3}
_LARGEST = 1e9  # heights [mm] and speeds [mm/s] beyond it are none


class Recorded:
    """A file of either kind; of one that grows, as far as it went when it was opened.

    ticks, times: (frames,) whole numbers, and [s]; dt: one tick [s]
    box:          (3,) sides along x and y, and the gap [mm]; periodic: whether it is, along x and y
    beads:        offsets and radii of the beads of each shape [mm], species by species
    shapes:       (n,) of the rods, from 0; species: (n,) theirs; species_of_shape: (shapes,); has_sizes: whether a
                  species may have several shapes
    spheres:      the species that are spheres
    header:       what else does not change: walls, scene (as text), run_id, seed
    lacking:      what nobody knows of tracked rods, in words
    """

    def __init__(self, path: Path, header: Mapping[str, Any], ticks: NDArray[Any], times: NDArray[Any],
                 read: Callable[[int], Any]) -> None:
        self.path, self.header, self.ticks, self.times, self._read = path, header, ticks, times, read
        self.lacking = str(header.get("lacking", ""))
        self._has_velocities = "velocities" not in self.lacking.split(", ")
        self.dt, side = float(header["dt_s"]), header["box_side_mm"]
        self.box = np.array([side, header.get("box_side_y_mm", side), header["gap_mm"]])
        self.beads = [(np.asarray(row["offset_mm"], float), np.asarray(row["radius_mm"], float))
                      for row in header["beads"]]
        self.has_sizes = "species_of_shape" in header
        self.species_of_shape = np.array(header.get("species_of_shape", range(len(self.beads))), np.uint8)
        self.shapes = np.zeros(header["n_rods"], np.uint8)
        if len(self.beads) > 1:
            self.shapes[:] = header["species_of_rod"]
        self.species = self.species_of_shape[self.shapes]
        self.spheres = tuple({int(of): None for of, (row, _) in zip(self.species_of_shape, self.beads)
                              if len(row) == 1})
        arena = header.get("walls", {}).get("arena")
        self.periodic = (arena in (None, "channel"), arena is None)  # a channel's walls are along x

    def read(self, k: int) -> Any:
        """A frame, with the fields tick, time, position (n, 3), velocity (n, 3), NaN where it is lacking, orientation
        (n, 4), which is (w, x, y, z), and image (n, 3). Raises Failed."""
        frame = self._read(k)
        if not self._has_velocities:
            frame = frame.copy()
            frame["velocity"] = np.nan
        return frame

    def checked(self, k: int) -> Any:
        """As `read`, of the rods that are there (tracked ones may be missed), with their numbers from 0 as rods (n,).
        Raises Failed where a number is none that a rod in the box can have, too."""
        frame = self._read(k)
        rods = np.flatnonzero(~np.isnan(frame["position"]).all(axis=1) | (not self.lacking))
        there = {name: frame[name][rods] for name in _WIDTHS}
        square = (there["orientation"].astype(float) ** 2).sum(axis=1)
        # a box to either side leaves room for rounding, and for files that count from its middle; false for NaN
        for what, values, middle, most in (("squared length of the orientation", square, 1, 1e-3),
                                           ("position", there["position"][:, :2], 0, 2 * self.box[:2]),
                                           ("height", there["position"][:, 2], 0, _LARGEST),
                                           ("velocity", there["velocity"], 0, _LARGEST)):
            for at in np.argwhere(~(np.abs(values - middle) <= most))[:1]:
                raise Failed(f"{self.path}: frame {k}: the {what} of rod {rods[at[0]]} is {values[tuple(at)]:g}: the "
                             "file is damaged")
        if not self._has_velocities:
            there["velocity"] = np.full_like(there["velocity"], np.nan)
        return {"tick": frame["tick"], "time": frame["time"], "rods": rods, **there}


def recorded(path: Path) -> Recorded:
    """The frames in a file. Raises ShakenError where it is none of ours, Failed where it is not whole."""
    try:
        with path.open("rb") as file:
            is_log = file.read(8) == b"SHKNFRAM"
        return _of_log(path) if is_log else _of_hdf5(path)
    except (FileNotFoundError, IsADirectoryError, PermissionError) as error:
        raise ShakenError(f"{path}: {error.strerror}") from None
    except (OSError, KeyError, TypeError, ValueError, IndexError, struct.error) as error:
        raise Failed(f"{path} is damaged: {error}") from None


def _record_of(n: int) -> Any:
    return np.dtype([("tick", "<i8"), ("time", "<f8"), *((name, "<i4" if name == "image" else "<f4", (n, width))
                                                         for name, width in _WIDTHS.items()), ("hash", "<u8")])


def _of_hdf5(path: Path) -> Recorded:
    file = open_file(path)
    rods, parameters = file["particles/trajectory"], file["parameters"]
    arrays = {"tick": rods["position/step"], "time": rods["position/time"],
              **{name: rods[name + "/value"] for name in _WIDTHS}}

    def text(value: Any) -> Any:
        return value.decode(errors="replace") if isinstance(value, bytes) else value

    header: dict[str, Any] = dict(parameters.attrs, run_id=text(file.attrs.get("run_id", "")),
                                  seed=file.attrs.get("seed", 0))
    for name, key in (("scene", "scene_json"), ("lacking", "lacking")):
        header[name] = text(parameters[key][()]) if key in parameters else ""
    kind, groups = "shape" if "shape" in rods else "species", [parameters]
    while f"{kind}_{len(groups) + 1}" in parameters:
        groups.append(parameters[f"{kind}_{len(groups) + 1}"])
    header["beads"] = [{name: group["bead_" + name][()] for name in ("offset_mm", "radius_mm")} for group in groups]
    header["species_of_rod"] = rods[kind][()] if kind in rods else ()
    if kind == "shape":
        header["species_of_shape"] = parameters["species_of_shape"][()]
    if "walls" in parameters:
        header["walls"] = {name: text(value) for name, value in parameters["walls"].attrs.items()}

    n = int(header["n_rods"])
    if any(arrays[name].shape[1:] != (n, width) for name, width in _WIDTHS.items()) or (
            len(groups) > 1 and len(header["species_of_rod"]) != n):
        raise ValueError(f"arrays are not of {n} rods")

    def read(k: int) -> Any:
        frame = np.zeros((), _record_of(n))
        try:
            for name, array in arrays.items():
                frame[name] = array[k]
        except (OSError, ValueError) as error:
            raise Failed(f"{path}: frame {k}: {error}") from None
        return frame

    return Recorded(path, header, arrays["tick"][()], arrays["time"][()], read)


def _of_log(path: Path) -> Recorded:
    file = path.open("rb", buffering=0)  # and it stays open: the run removes it at its end
    _, version, length = struct.unpack("<8sII", file.read(16))
    text, own = file.read(length), file.read(8)
    if version != 1 or hash_of(text) != int.from_bytes(own, "little"):
        raise ValueError("its header is not whole" if version == 1 else f"it is of version {version}")
    header = json.loads(text)
    record = _record_of(header["n_rods"])

    def at(k: int, size: int = record.itemsize) -> bytes:
        return os.pread(file.fileno(), size, 24 + length + k * record.itemsize)

    def read(k: int) -> Any:
        content = at(k)
        if len(content) < record.itemsize or hash_of(content[:-8]) != int.from_bytes(content[-8:], "little"):
            raise Failed(f"{path}: frame {k} is damaged")
        return np.frombuffer(content, record)[0]

    n_frames = (os.fstat(file.fileno()).st_size - 24 - length) // record.itemsize
    try:
        read(n_frames - 1) if n_frames > 0 else None
    except Failed:
        n_frames -= 1  # it is on its way to the file, or was when its writer was killed
    stamps = np.frombuffer(b"".join(at(k, 16) for k in range(n_frames)), [("tick", "<i8"), ("time", "<f8")])
    return Recorded(path, header, stamps["tick"], stamps["time"], read)
