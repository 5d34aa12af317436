#!/usr/bin/env python3
"""What those who listen cost a run: CPU and wall time of a worker with no subscriber, with one that reads, and with one
that is stopped (SIGSTOP) and reads nothing, in turn, so that all see the same weather of the machine.

The worker sends its live state to the relay of a daemon of its own, on a free port of 127.0.0.1; the subscriber is
LCM's lcm-logger, which takes every message. The final states must have the same hash. Whatever else the machine does
can only add to a time, so the least CPU times are compared; the medians tell how much that was. Exits 1 if a hash
differs, or if a subscriber costs more than --most."""
import argparse
import json
import os
import pathlib
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time

BIN = pathlib.Path(__file__).resolve().parent.parent / "build" / "release" / "bin"
CASES = ("none", "reads", "stopped")


def scene(seconds):
    return {"rods": {"length": "4.5 mm", "area_fraction": 0.6}, "box": {"side": "30 mm"},
            "time": {"measure": f"{seconds} s"}, "stream": {"rate": 20}, "movie": None, "trajectory": None}


def free_address():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return "127.0.0.1:%d" % probe.getsockname()[1]


def wait_until(is_so, what):
    for _ in range(2000):
        if is_so():
            return
        time.sleep(0.01)
    sys.exit(f"subscribers: {what} did not happen")


def subscriber(case, url, folder):
    """A logger that has heard something, and is then stopped if the case says so; None without one."""
    if case == "none":
        return None
    log = folder / "log"
    process = subprocess.Popen(["lcm-logger", "--quiet", "--force", f"--lcm-url={url}", str(log)],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until(lambda: log.exists() and log.stat().st_size > 0, "a message for the logger")
    if case == "stopped":
        process.send_signal(signal.SIGSTOP)
    return process


def end(process):
    if process:
        process.kill()
        process.wait()


def measured(case, url, folder, scene_file):
    """(CPU time, wall time) of one run [s], and its hash."""
    with tempfile.TemporaryDirectory(dir=folder) as out:
        listener = subscriber(case, url, folder)
        begun = time.monotonic()
        worker = subprocess.Popen([BIN / "shaken-worker", scene_file, "--out", out + "/run", "--lcm-url", url],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(worker.pid, 0)
        wall = time.monotonic() - begun
        worker.returncode = os.waitstatus_to_exitcode(status)
        end(listener)
        if worker.returncode:
            sys.exit(f"subscribers: the worker ended with {worker.returncode}")
        summary = json.loads(pathlib.Path(out, "run", "summary.json").read_text())
        return usage.ru_utime + usage.ru_stime, wall, summary["state_hash"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeat", type=int, default=5, help="runs of each case [5]")
    parser.add_argument("--seconds", type=float, default=6, help="simulated time of a run [6]")
    parser.add_argument("--most", type=float, default=1, help="per cent of CPU time that a subscriber may cost [1]")
    options = parser.parse_args()
    times = {case: [] for case in CASES}
    hashes = set()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene_file = folder / "scene.json"
        scene_file.write_text(json.dumps(scene(options.seconds)))
        address = free_address()
        url = "tcpq://" + address
        daemon = subprocess.Popen([BIN / "shakend", "--root", folder / "root", "--relay", address, "--lcm-url", url,
                                   "--quiet"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        try:
            daemon.stdout.readline()
            measured("none", url, folder, scene_file)  # so that the first has everything in memory, too
            for round_number in range(options.repeat):
                for case in CASES[round_number % 3:] + CASES[:round_number % 3]:
                    cpu, wall, state = measured(case, url, folder, scene_file)
                    times[case].append((cpu, wall))
                    hashes.add(state)
                    print(f"{case:8} CPU {cpu:7.3f} s  wall {wall:7.3f} s  {state}", flush=True)
        finally:
            daemon.terminate()
            daemon.wait()
    print("\nsubscriber    least CPU [s]   ratio   median CPU [s]   ratio   median wall [s]   ratio")
    least, medians = ({case: how([run[0] for run in times[case]]) for case in CASES} for how in (min, statistics.median))
    walls = {case: statistics.median(run[1] for run in times[case]) for case in CASES}
    for case in CASES:
        print(case.ljust(12) + "".join(f"  {column[case]:13.3f}  {column[case] / column['none']:6.4f}"
                                       for column in (least, medians, walls)))
    worst = max(100 * (least[case] / least["none"] - 1) for case in CASES)
    print(f"same hash: {'yes' if len(hashes) == 1 else 'NO'}; a subscriber costs {worst:.2f} % of CPU time at most")
    return 0 if len(hashes) == 1 and worst <= options.most else 1


if __name__ == "__main__":
    sys.exit(main())
