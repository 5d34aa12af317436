#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""An observable of one's own on the live stream: the rms tilt n_z of every frame, as it arrives.

    lcm-gen --python proto/frame_t.lcm      makes the package `shaken`, which decodes the messages
    PYTHONPATH=. python3 docs/live_observable.py

Nothing but Python's own library is needed. The bus is LCM's UDP multicast (docs/protocol.md).
"""
import math
import socket

from shaken import frame_t

GROUP, PORT = "239.255.76.67", 7667


def frames():
    """Every chunk of a frame that is sent on this machine, decoded."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind((GROUP, PORT))
    membership = socket.inet_aton(GROUP) + socket.inet_aton("0.0.0.0")
    listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    while True:
        datagram = listener.recv(65536)
        if datagram[:4] != b"LC02":  # a message of one datagram: magic, sequence number, channel, NUL, payload
            continue
        channel, _, payload = datagram[8:].partition(b"\0")
        if channel == b"SHAKEN_FRAME":
            yield frame_t.decode(payload)


for frame in frames():
    n_z = [value / 32767 for value in frame.n_z]
    rms = math.sqrt(sum(value * value for value in n_z) / len(n_z))
    print(f"{frame.job_id[:8]}  t = {frame.sim_time_s:.3f} s  S = {frame.order:.3f}  rms n_z = {rms:.4f}", flush=True)
