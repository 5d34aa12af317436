import importlib
import shutil
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import shaken
from shaken import bus

PROTO = Path(__file__).resolve().parents[2] / "proto"


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def test_frames_and_observables_of_a_running_job(programs):
    address = f"127.0.0.1:{free_port()}"
    daemon = programs.start_daemon("--slots", "1", "--relay", address, "--lcm-url", f"tcpq://{address}")
    daemon.submit({"box": {"side": "16 mm"}, "accuracy": "draft", "time": {"measure": "1000 s"}}, name="live")
    [job] = daemon.jobs("live")
    frames, numbers = [], []
    for message in shaken.live(job["id"][:8], address, observables=True, timeout=60):
        (frames if isinstance(message, shaken.LiveFrame) else numbers).append(message)
        if len(frames) >= 3 and numbers:
            break
    daemon.cancel("live")
    frame = frames[-1]
    assert frame.job_id == job["id"] and frame.side == 16 and frames[0].time < frame.time
    assert frame.positions.min() >= 0 and frame.positions.max() < 16
    assert frame.order == pytest.approx(abs(np.exp(2j * frame.theta).mean()), abs=1e-3)
    assert numbers[0].n_rods == len(frame.theta) and 0 <= numbers[0].order <= 1


def test_types_are_those_of_the_definitions(tmp_path):
    if not shutil.which("lcm-gen"):
        pytest.skip("lcm-gen is not installed (liblcm-bin)")
    subprocess.run(["lcm-gen", "--python", "--ppath", tmp_path, PROTO / "frame_t.lcm", PROTO / "observables_t.lcm"],
                   check=True)
    (tmp_path / "shaken").rename(tmp_path / "generated")
    sys.path.insert(0, str(tmp_path))
    try:
        frame_t = importlib.import_module("generated.frame_t").frame_t
        observables_t = importlib.import_module("generated.observables_t").observables_t
    finally:
        sys.path.remove(str(tmp_path))
    frame = frame_t()
    frame.job_id, frame.sim_time_s, frame.tick, frame.order = "abc", 1.5, 7, 0.5
    frame.box_x_mm, frame.box_y_mm = 20.0, 40.0
    frame.n_rods, frame.chunk, frame.n_chunks, frame.n_chunk_rods = 3, 0, 2, 2
    frame.x, frame.y, frame.heading, frame.n_z = [0, 32767], [-32768, 0], [0, 16384], [32767, 0]
    parts = bus._FrameParts()
    assert parts.add(frame.encode()) is None
    frame.chunk, frame.first_rod, frame.n_chunk_rods = 1, 2, 1
    frame.x, frame.y, frame.heading, frame.n_z = [0], [0], [-32768], [0]
    whole = parts.add(frame.encode())
    assert whole.time == 1.5 and whole.tick == 7 and np.allclose(whole.theta, [0, np.pi / 2, -np.pi])
    assert np.allclose(whole.positions, [[10, 0], [19.9997, 20], [10, 20]], atol=1e-4) and whole.n_z[0] == 1
    numbers = observables_t()
    numbers.job_id, numbers.n_rods, numbers.order, numbers.eta_s, numbers.collisions_rod_lid = "abc", 9, 0.25, 3.5, 4
    found = bus._decode_observables(numbers.encode())
    assert (found.n_rods, found.order, found.eta_s, found.collisions_rod_lid) == (9, 0.25, 3.5, 4)
    for broken in (frame.encode()[:-1], frame.encode() + b"\0", numbers.encode(), b"", b"x" * 40):
        with pytest.raises((ValueError, struct.error)):
            parts.add(broken)


def frame_message(job, sequence=1, chunk=0, n_chunks=2, n_rods=1000, n=500):
    head = struct.pack(">QqqI", bus._FRAME, 0, sequence, len(job) + 1) + job.encode() + b"\0"
    return head + struct.pack(">dqddddiiiii", 0, 0, 9, 9, 0, 0, n_rods, chunk, n_chunks, 0, n) + bytes(8 * n)


def test_frames_that_never_become_whole_are_not_kept_for_ever():
    wanted = bus._FrameParts("a")
    assert wanted.add(frame_message("b")) is None and wanted.unfinished == 0, "of a job that nobody asked for"
    everything = bus._FrameParts()
    for k in range(700):
        everything.add(frame_message(f"{k:016x}", n_rods=100_000, n=50_000))
        everything.add(frame_message("aa", sequence=k))
    assert everything.unfinished <= bus._MOST_UNFINISHED
    assert everything.add(frame_message("aa", sequence=699, chunk=1)) is not None, "the newest goes on"
    for wrong in (frame_message("a" * 100), frame_message("aa", n=1001)):
        with pytest.raises(ValueError):
            everything.add(wrong)
    everything.add(frame_message("aa", n_chunks=3))
    with pytest.raises(ValueError, match="more rods than the frame"):
        everything.add(frame_message("aa", chunk=1, n_chunks=3, n=501))


def test_a_relay_that_is_not_there_is_named():
    with pytest.raises(shaken.ShakenError, match="no beginning of a job's id"):
        next(shaken.live("a job"))
    for address in ({"relay": f"127.0.0.1:{free_port()}"}, {"job": f"127.0.0.1:{free_port()}"}):
        with pytest.raises(shaken.ShakenError, match="start the daemon with"):
            next(shaken.live(**address))


def test_what_is_no_relay_is_refused():
    with socket.create_server(("127.0.0.1", 0)) as server:
        import threading
        def answer():
            connection, _ = server.accept()
            connection.recv(100)
            connection.sendall(b"HTTP/1.1")
            time.sleep(0.2)
            connection.close()
        threading.Thread(target=answer, daemon=True).start()
        with pytest.raises(shaken.ShakenError, match="is no relay"):
            next(shaken.live(relay=f"127.0.0.1:{server.getsockname()[1]}"))
