"""Archives: a small file for each finished run, with all that figures and verdicts need of it.

A file holds, compressed by xz, one line of JSON and then numbers, little-endian: scene, parameters, summary, the arrays
as float32 rounded to a part in 8,000 (S(t) to one in 2,000, errors to one in 500), and the rods of one or two instants.
Files are named by their runs, so that folders are merged by copying; of one run that is there twice the longer one is
kept. Equal runs give equal files.
"""
import json
import lzma
import math
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from .catalogue import ARRAYS
from .errors import ShakenError
from .frames import Frame
from .run import Arrays, DirectoryRun, Run
from .system import write_whole

SUFFIX = ".run.xz"
#: No file is larger: what figures need least is left out until it fits.
LARGEST = 60_000
_FORMAT = "shaken archive 1"
_HIGHEST = 1 << 26  # bytes that a file may grow to when it is read: nobody's disk is filled by a hostile one

#: Points that are kept of curves against time that have more, by their groups; each is the mean of those that it stands
#: for.
_MOST_POINTS = {row["axes"][0].removesuffix("/time_s"): 1050 for row in ARRAYS.values()
                if len(row["axes"]) == 1 and re.fullmatch("/[^/]+/time_s", row["axes"][0])} | {"/defects": 350}
#: Left out: what no figure shows, or what follows from others.
_NO_FIGURE = ("/defects/tracks/speed_", "/msd/relative_across", "/msd/relative_along")
_TRACE_TIME = 2.0    # seconds of which a trace keeps every point of n_z
_TRACE_POINTS = 750  # points of the way of a rod


@dataclass(frozen=True)
class Snapshot:
    """The rods of the first species at an instant, in the plane, as an archive keeps them.

    time:      [s]
    positions: (n, 2) centres [mm], to a 65,536th of the box
    theta:     (n,) angles of the axes in the plane [rad], in [-pi/2, pi/2), to half a degree or better
    box:       (2,) sides of the box along x and y [mm]
    """

    time: float
    positions: NDArray[Any]
    theta: NDArray[Any]
    box: NDArray[Any]


class ArchivedRun(Run):
    """A run from an archive: as any other, but without frames. Of arrays with very many points means are kept, and of
    the maps of `pairs` one quadrant, the mean of the four."""

    def __init__(self, header: dict[str, Any], data: bytes, where: str) -> None:
        places = {entry["name"]: entry for entry in header["arrays"]}
        for entry in header["arrays"]:
            _check_place(entry, 4, data)
            if entry["name"] in ("/pairs/g", "/pairs/g2") and math.isqrt(entry["n"]) ** 2 != entry["n"]:
                raise ValueError(f"a map of {entry['n']} places")
        for entry in header["snapshots"]:
            _check_place(entry, 4 + (2 if entry["bytes"] == 2 else 1), data)
            float(entry["time"]) + float(entry["side"]) + float(entry.get("side_y", 0))
        if not all(isinstance(word, str) for word in header["sweeps"]):
            raise ValueError("sweeps without names")
        float(header["summary"]["sim_seconds"])

        def read(name: str) -> tuple[NDArray[Any], str]:
            entry = places[name]
            values = np.frombuffer(data, "<f4", entry["n"], entry["at"])
            if name in ("/pairs/g", "/pairs/g2"):
                return unfolded(values).ravel(), entry["unit"]
            return values.astype(float), entry["unit"]

        super().__init__(header["scene"], header["summary"], Arrays(list(places), read), header["parameters"], where)
        self.sweeps: list[str] = header["sweeps"]
        self._header, self._data = header, data

    @property
    def snapshots(self) -> list[Snapshot]:
        """The rods at the end; and, where defects were counted, at the recorded instant with the most. Empty where the
        run recorded no frames."""
        found = []
        for entry in self._header["snapshots"]:
            n, at = entry["n"], entry["at"]
            box = np.array([entry["side"], entry.get("side_y", entry["side"])])
            place = np.frombuffer(self._data, "<u2", 2 * n, at).reshape(2, n).T * (box / 65536)
            angle = np.frombuffer(self._data, "<u2" if entry["bytes"] == 2 else "u1", n, at + 4 * n)
            theta = (angle + 0.5) * (np.pi / (65536 if entry["bytes"] == 2 else 256)) - np.pi / 2
            found.append(Snapshot(entry["time"], place, theta, box))
        return found


def _check_place(entry: dict[str, Any], width: int, data: bytes) -> None:
    """Raises ValueError where the file does not have so many numbers of so many bytes."""
    n, at = entry["n"], entry["at"]
    if not (type(n) is int and type(at) is int and 0 <= n and 0 <= at and at + n * width <= len(data)):
        raise ValueError(f"{n} numbers at {at}, where there are {len(data)} bytes")


def folded(map_: NDArray[Any]) -> NDArray[Any]:
    """The quadrant across >= 0, along >= 0 of a map of an odd number of bins each way: the mean of all four, which
    differ by chance only, since rods know neither head nor tail nor hand."""
    mean = (map_ + map_[::-1] + map_[:, ::-1] + map_[::-1, ::-1]) / 4
    middle = len(map_) // 2
    return mean[middle:, middle:]


def unfolded(values: NDArray[Any]) -> NDArray[Any]:
    """The whole map of a quadrant."""
    half = int(round(np.sqrt(len(values))))
    quadrant = values.reshape(half, half).astype(float)
    lower = np.concatenate([quadrant[:0:-1], quadrant])
    return np.concatenate([lower[:, :0:-1], lower], axis=1)


def archive_file(run: DirectoryRun, sweeps: Iterable[str] = ()) -> bytes:
    """The file of a run that is done. Raises ShakenError for one that was stopped or has failed."""
    state = (run.summary.get("exit") or {}).get("state")
    if state != "done":
        raise ShakenError(f"run {run.id} is not done but {state}: only finished runs are archived")
    arrays = _kept_arrays(run)
    snapshots = _kept_snapshots(run)
    while True:
        packed = _packed(run, sweeps, arrays, snapshots)
        if len(packed) <= LARGEST:
            return packed
        if len(snapshots) > 1:
            snapshots = snapshots[:1]
        elif "/pairs/g" in arrays:
            for name in ("/pairs/g", "/pairs/g2", "/pairs/across_mm", "/pairs/along_mm"):
                arrays.pop(name)
        elif snapshots:
            snapshots = []
        else:
            raise ShakenError(f"run {run.id} does not fit into {LARGEST} bytes: its arrays are too long")


#: Time, places and angles as whole numbers, sides of the box, bytes of an angle.
_Small = tuple[float, NDArray[Any], NDArray[Any], NDArray[Any], int]


def _packed(run: Run, sweeps: Iterable[str], arrays: dict[str, tuple[NDArray[Any], str | None]],
            snapshots: list[_Small]) -> bytes:
    data = bytearray()
    header: dict[str, Any] = {"format": _FORMAT, "sweeps": sorted(set(sweeps)), "parameters": run.parameters,
                              "scene": run.scene, "summary": _kept_summary(run.summary), "arrays": [], "snapshots": []}
    for time, place, angle, box, width in snapshots:
        sides = {"side": float(box[0]), **({"side_y": float(box[1])} if box[1] != box[0] else {})}
        header["snapshots"].append({"time": time, **sides, "n": len(angle), "bytes": width, "at": len(data)})
        data += place.T.astype("<u2").tobytes() + angle.astype("<u2" if width == 2 else "u1").tobytes()
    data += bytes(-len(data) % 4)
    for name, (values, unit) in arrays.items():
        header["arrays"].append({"name": name, "unit": unit, "n": int(values.size), "at": len(data)})
        data += _rounded(values, 8 if "_sem" in name else 10 if _group(name) in _MOST_POINTS else 12).tobytes()
    text = json.dumps(header, separators=(",", ":"), ensure_ascii=False).encode()
    return lzma.compress(text + b"\n" + bytes(data), preset=9 | lzma.PRESET_EXTREME)


def _rounded(values: NDArray[Any], bits: int) -> NDArray[Any]:
    """float32 with so many bits of the mantissa, rounded to nearest: what is left out is noise that does not compress.
    """
    dropped = 23 - bits
    words = np.ascontiguousarray(values, dtype="<f4").view("<u4").copy()
    finite = np.isfinite(values)
    words[finite] = (words[finite] + (1 << (dropped - 1))) & ~np.uint32((1 << dropped) - 1)
    return words.view("<f4")


def _kept_summary(summary: dict[str, Any]) -> dict[str, Any]:
    """The summary without the reasons of each null, and with six digits of each number."""
    def short(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: short(inner) for key, inner in value.items()}
        if isinstance(value, list):
            return [short(inner) for inner in value]
        return float(f"{value:.6g}") if isinstance(value, float) else value

    return short({key: value for key, value in summary.items() if key not in ("why_null", "files")})


def _kept_arrays(run: Run) -> dict[str, tuple[NDArray[Any], str | None]]:
    kept: dict[str, tuple[NDArray[Any], str | None]] = {}
    for name, array in run.arrays.items():
        values = np.asarray(array)
        if name.startswith("/rods/trace/"):
            trace = _trace(name, values, np.asarray(run.arrays["/rods/trace/time_s"]))
            if trace is None:
                continue
            values = trace
        elif name in ("/pairs/g", "/pairs/g2"):
            values = folded(values)
        elif name.startswith(_NO_FIGURE):
            continue
        elif name == "/order/director_rad":
            values = _thinned(np.unwrap(2 * values) / 2, _MOST_POINTS["/order"])
        elif _group(name) in _MOST_POINTS:
            values = _thinned(values, _MOST_POINTS[_group(name)])
        kept[name] = (values.ravel(), array.unit)
    return kept


def _group(name: str) -> str:
    return name.rpartition("/")[0]


def _thinned(values: NDArray[Any], most: int) -> NDArray[Any]:
    """Means of neighbours, at most so many; the first value, that of the start, stays as it is."""
    each = -(-(len(values) - 1) // (most - 1))
    if each <= 1:
        return values
    n = (len(values) - 1) // each * each
    return np.concatenate([values[:1], values[1:n + 1].reshape(-1, each).mean(axis=1)])


def _trace(name: str, values: NDArray[Any], time: NDArray[Any]) -> NDArray[Any] | None:
    """What is kept of the traces of single rods: n_z of the first for two seconds, the ways of all."""
    if name.endswith("/theta_rad"):
        return None
    early = int(np.searchsorted(time, time[0] + _TRACE_TIME)) if len(time) else 0
    if name.endswith("/n_z"):
        return values[:early] if name == "/rods/trace/0/n_z" else None
    if name.endswith("time_s"):
        return values[:early]
    each = max(1, -(-len(values) // _TRACE_POINTS))
    return values[::each]


def _kept_snapshots(run: DirectoryRun) -> list[_Small]:
    if not (run.directory / "trajectory.h5").exists():
        return []
    trajectory = run.trajectory
    wanted = [len(trajectory) - 1]
    if "/defects/n_plus" in run:
        count = run["/defects/n_plus"]
        at = np.interp(trajectory.times, count.axis, count)
        at[trajectory.times < float(run.summary.get("t_steady_s") or 0)] = -1
        wanted.append(int(np.argmax(at)))
    frames = [trajectory[k] for k in dict.fromkeys(wanted)]
    return [_small(frame) for frame in frames]


def _small(frame: Frame) -> _Small:
    """The rods of a frame in whole numbers. They go in the order of their places, which compresses better than that of
    their numbers."""
    first = frame.is_seen & (frame.species == 0)
    box = frame.box[:2]
    place = np.minimum((frame.positions[first, :2] / box * 65536).astype(int), 65535)
    turn = (frame.theta[first] / np.pi + 0.5) % 1.0
    width = 2 if len(place) < 1500 else 1
    angle = np.minimum((turn * 256**width).astype(int), 256**width - 1)
    order = np.lexsort((place[:, 1], place[:, 0]))
    return frame.time, place[order], angle[order], box, width


def read_archived(path: str | Path) -> ArchivedRun:
    """The run of a file of an archive. Raises ShakenError where it is damaged or no such file."""
    path = Path(path)
    try:
        decoder = lzma.LZMADecompressor(memlimit=1 << 28)
        data = decoder.decompress(path.read_bytes(), _HIGHEST)
        if not decoder.eof:
            raise ValueError("it is cut off, or larger than any")
        text, _, numbers = data.partition(b"\n")
        header = json.loads(text)
        if header.get("format") != _FORMAT:
            raise ValueError(f"it is of another format: {header.get('format')}")
        run = ArchivedRun(header, numbers, str(path))
        if path.name.endswith(SUFFIX) and path.name != run.id + SUFFIX:
            raise ValueError(f"it is of run {run.id}, and has another name")
    except (OSError, lzma.LZMAError, ValueError, AttributeError, LookupError, TypeError, OverflowError, RecursionError,
            ShakenError) as error:
        raise ShakenError(f"{path} is damaged, or no file of an archive: {error}. Put a copy of it back, or remove it: "
                          "`shaken figures` then does its run again") from None
    return run


def _is_longer(run: Run, target: Path) -> bool:
    """Whether the archive lacks the run, or has less of it; a damaged file is none."""
    try:
        return bool(run.summary["sim_seconds"] > read_archived(target).summary["sim_seconds"])
    except ShakenError:
        return True


def add_run(directory: str | Path, folder: str | Path, parameters: dict[str, Any] | None = None,
            sweeps: Iterable[str] = ()) -> Path | None:
    """Archives the run of `directory` in `folder`: ID.run.xz. None, and nothing is written, if it is there as long or
    longer. Raises ShakenError for a run that is not done."""
    run = DirectoryRun(directory, parameters)
    path = Path(folder) / (run.id + SUFFIX)
    if not _is_longer(run, path):
        return None
    packed = archive_file(run, sweeps)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, packed, sync=True)
    return path


def merge(source: str | Path, into: str | Path) -> list[Path]:
    """Copies the files of one archive into another; of a run that both have the longer one stays. Returns what was
    written. Raises ShakenError, after the others, with all files that are damaged, which are not copied."""
    written = []
    for run in archived_runs(source):
        target = Path(into) / Path(run.where).name
        if _is_longer(run, target):
            target.parent.mkdir(parents=True, exist_ok=True)
            write_whole(target, Path(run.where).read_bytes(), sync=True)
            written.append(target)
    return written


def archived_runs(folder: str | Path, set_aside: Callable[[str], None] | None = None) -> Iterator[ArchivedRun]:
    """The runs of an archive, in the order of their ids. Raises ShakenError where there is no such folder, and, after
    the others, with all files that are damaged; or gives these other names, and says so by `set_aside`."""
    if not Path(folder).is_dir():
        raise ShakenError(f"{folder} is no folder, and so no archive")
    problems = []
    for path in sorted(Path(folder).glob("*" + SUFFIX)):
        try:
            yield read_archived(path)
        except ShakenError as error:
            if set_aside is None:
                problems.append(str(error))
            else:
                os.replace(path, path.with_name(path.name + ".damaged"))
                set_aside(f"{error}. It is now {path.name}.damaged")
    if problems:
        raise ShakenError("\n".join(problems))
