"""Live state of running jobs, from the relay of a daemon (`shakend --relay 127.0.0.1:7700`).

The relay speaks LCM's protocol tcpq (docs/protocol.md), and this module enough of it to listen.
"""
import re
import socket
import struct
from dataclasses import dataclass
from typing import Any, BinaryIO, Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from .errors import ShakenError

_CLIENT, _SERVER, _VERSION = 0x287617FB, 0x287617FA, 0x0100
_PUBLISH, _SUBSCRIBE = 1, 2
_LONGEST_CHANNEL, _LONGEST_PAYLOAD = 63, 1 << 20


@dataclass(frozen=True)
class LiveFrame:
    """The rods of a running job at an instant, as proto/frame_t.lcm has them.

    job_id:    of the run
    time:      simulated time [s]
    tick:      time over the time step
    side:      of the box along x [mm]
    side_y:    of the box along y [mm]
    order:     S of the first species; NaN of spheres
    director:  its angle [rad], in [-pi/2, pi/2)
    positions: (n, 2) centres in the plane [mm], to a 65,536th of the box
    theta:     (n,) angle of each rod in the plane [rad], in [-pi, pi)
    n_z:       (n,) vertical component of its axis
    """

    job_id: str
    time: float
    tick: int
    side: float
    side_y: float
    order: float
    director: float
    positions: NDArray[Any]
    theta: NDArray[Any]
    n_z: NDArray[Any]


@dataclass(frozen=True)
class LiveObservables:
    """Numbers of a running job at an instant, as proto/observables_t.lcm has them. Names end in units; without one are

    job_id:     of the run
    time:       simulated time [s]; `time_total` is that at which the run ends
    order:      S of the first species; `order_running_mean` is its mean over the later half of the time so far
    director:   its angle [rad], in [-pi/2, pi/2)
    rms_n_z:    root mean square of the vertical component of the axes
    collisions: (`collisions_rod_rod`, ...) impulses since the start, as is `max_overlap_mm`
    sim_rate:   simulated seconds per wall second
    eta_s:      wall seconds to the end; negative where unknown
    """

    job_id: str
    time: float
    time_total: float
    n_rods: int
    order: float
    order_running_mean: float
    director: float
    rms_speed_xy_mm_s: float
    rms_speed_z_mm_s: float
    rms_n_z: float
    kinetic_energy_uJ: float
    max_overlap_mm: float
    collisions_rod_rod: int
    collisions_rod_base: int
    collisions_rod_lid: int
    sim_rate: float
    eta_s: float


class _Payload:
    """A message's bytes, read in order; big-endian, as LCM has them."""

    def __init__(self, data: bytes, fingerprint: int) -> None:
        self._data, self._at = data, 0
        if self.numbers("Q") != (fingerprint,):
            raise ValueError("a message of another type")

    def numbers(self, form: str) -> tuple[Any, ...]:
        found = struct.unpack_from(">" + form, self._data, self._at)
        self._at += struct.calcsize(">" + form)
        return found

    def text(self) -> str:
        (length,) = self.numbers("i")
        if not 1 <= length <= len(self._data) - self._at:
            raise ValueError("a text that is longer than its message")
        found = self._data[self._at:self._at + length - 1].decode(errors="replace")
        self._at += length
        return found

    def array(self, n: int, of: str) -> NDArray[Any]:
        found = np.frombuffer(self._data, of, n, self._at)
        self._at += found.nbytes
        return found

    def end(self) -> None:
        if self._at != len(self._data):
            raise ValueError("a message that is longer than its type")


#: What LCM makes of the types of the messages and their names (`lcm-gen --python`), so that no other type is read.
_FRAME, _OBSERVABLES = 0x0D06D91756EFF7D0, 0x59B43E22B4B3C113


def _decode_observables(data: bytes) -> LiveObservables:
    message = _Payload(data, _OBSERVABLES)
    message.numbers("qq")
    found = LiveObservables(message.text(), *message.numbers("ddi8d3q2d"))
    message.end()
    return found


#: What is kept of frames that are not whole [bytes]: anybody may send some, and never the rest.
_MOST_UNFINISHED = 1 << 26


class _FrameParts:
    """Frames of more than 7,000 rods come in several messages. `job`: the first digits of those that are wanted."""

    def __init__(self, job: str = "") -> None:
        self._job = job
        self._parts: dict[str, tuple[int, dict[int, NDArray[Any]]]] = {}  # that with the newest message last

    def add(self, data: bytes) -> LiveFrame | None:
        message = _Payload(data, _FRAME)
        _, sequence = message.numbers("qq")
        job = message.text()
        time, tick, side, side_y, order, director, n_rods, chunk, n_chunks, _, n = message.numbers("dqddddiiiii")
        if not (0 <= n <= n_rods <= 10_000_000 and 0 <= chunk < n_chunks <= 2_000 and len(job) <= 64):
            raise ValueError("sizes that no frame has")
        rods = message.array(4 * n, ">i2").reshape(4, n)
        message.end()
        if not job.startswith(self._job):
            return None
        known, parts = self._parts.pop(job, (-1, {}))
        if known != sequence:
            parts = {}
        parts[chunk] = rods
        if sum(part.shape[1] for part in parts.values()) > n_rods:
            raise ValueError("more rods than the frame has")
        if len(parts) < n_chunks:
            self._parts[job] = (sequence, parts)
            while len(self._parts) > 1 and self.unfinished > _MOST_UNFINISHED:
                del self._parts[next(iter(self._parts))]
            return None
        x, y, heading, n_z = np.concatenate([parts[k] for k in range(n_chunks)], axis=1).astype(float)
        return LiveFrame(job, time, tick, side, side_y, order, director,
                         np.stack([(x / 65536 + 0.5) * side, (y / 65536 + 0.5) * side_y], axis=1),
                         heading * (2 * np.pi / 65536), n_z / 32767)

    @property
    def unfinished(self) -> int:
        """[bytes]"""
        return sum(part.nbytes + 1000 for _, parts in self._parts.values() for part in parts.values())


def live(job: str = "", relay: str = "127.0.0.1:7700", *, observables: bool = False,
         timeout: float | None = None) -> Iterator[Any]:
    """The frames of running jobs as they come (LiveFrame); with `observables` those and LiveObservables, in the order
    in which they arrive.

    job:     an id, or its first digits; those of all jobs if left out. Of an ADDRESS:PORT it is the relay
    relay:   ADDRESS:PORT of `shakend --relay`
    timeout: [s] without a message after which the iteration ends; it goes on for ever if None

    No run waits for whoever listens: what is not read in time is dropped by the relay. Raises ShakenError where no
    relay answers. Messages that are not of their type are left out.
    """
    if ":" in job:
        job, relay = "", job
    if not re.fullmatch("[0-9a-f]{0,16}", job):
        raise ShakenError(f"'{job}' is no beginning of a job's id, and no ADDRESS:PORT of a relay")
    host, _, port = relay.rpartition(":")
    try:
        connection = socket.create_connection((host, int(port)), timeout=5)
    except (OSError, ValueError) as error:
        raise ShakenError(f"no relay answers at {relay} ({error}): start the daemon with `shakend --relay {relay}`"
                          ) from None
    with connection:
        channels = "SHAKEN_FRAME|SHAKEN_OBSERVABLES" if observables else "SHAKEN_FRAME"
        connection.sendall(struct.pack(">II", _CLIENT, _VERSION) +
                           struct.pack(">II", _SUBSCRIBE, len(channels)) + channels.encode())
        stream = connection.makefile("rb")
        if struct.unpack(">II", _exactly(stream, 8)) != (_SERVER, _VERSION):
            raise ShakenError(f"what answers at {relay} is no relay")
        connection.settimeout(timeout)
        frames = _FrameParts(job)
        decode: dict[str, Callable[[bytes], Any]] = {"SHAKEN_FRAME": frames.add,
                                                     "SHAKEN_OBSERVABLES": _decode_observables}
        while True:
            try:
                channel, payload = _message(stream)
            except (TimeoutError, EOFError):
                return
            try:
                found = decode[channel](payload)
            except (KeyError, ValueError, struct.error):
                continue
            if found is not None and found.job_id.startswith(job):
                yield found


def _message(stream: BinaryIO) -> tuple[str, bytes]:
    kind, length = struct.unpack(">II", _exactly(stream, 8))
    if kind != _PUBLISH or length > _LONGEST_CHANNEL:
        raise EOFError
    channel = _exactly(stream, length).decode(errors="replace")
    (length,) = struct.unpack(">I", _exactly(stream, 4))
    if length > _LONGEST_PAYLOAD:
        raise EOFError
    return channel, _exactly(stream, length)


def _exactly(stream: BinaryIO, n: int) -> bytes:
    data = stream.read(n)
    if len(data) < n:
        raise EOFError
    return data
