#!/usr/bin/env python3
"""The n-th call of each kind fails, in one program after the other: no service stops, no job and no frame is lost.

    every_call_fails.py BIN FAILING_CALLS [MOST [PROGRAM ...]]

BIN is the folder of the programs, FAILING_CALLS the library that lets a call fail (failing_calls.cpp). Of each kind of
call and program at most MOST instants are tried, evenly spread (one, or three where SHAKEN_NIGHT is set); 0 tries all.
Prints a line for each kind, and ends with 1 where something was lost.
"""
import errno
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from pathlib import Path

import h5py

BIN, LIBRARY = Path(sys.argv[1]), sys.argv[2]
MOST = int(sys.argv[3]) if len(sys.argv) > 3 else 3 if os.environ.get("SHAKEN_NIGHT") else 1
CALLS = {"open": errno.EIO, "read": errno.EIO, "write": errno.EIO, "fsync": errno.EIO, "rename": errno.ESTALE,
         "stat": errno.ESTALE, "readdir": errno.EIO, "thread": errno.EAGAIN, "memory": errno.ENOMEM, "wait": errno.ECHILD}
SCENE = {"rods": {"count": 6, "length": "3 mm"}, "box": {"side": "12 mm"},
         "time": {"steady": 0, "measure": "0.04 s", "step": "20 us"}, "measure": {"order": {}},
         "trajectory": {"every": "2 ms"}}
N_FRAMES = 21
LIMIT = 60  # seconds for what takes one


class Lost(Exception):
    """What should have been there after a fault."""


def environment(call, n, program, **more):
    return {**os.environ, "LD_PRELOAD": LIBRARY, "SHAKEN_CALL_FAILS": f"{call}:{CALLS[call]}:{n}",
            "SHAKEN_CALL_FAILS_IN": program, **more}


def ended(command, env=None):
    """Exit code and output of a command."""
    done = subprocess.run([str(word) for word in command], env=env, stdin=subprocess.DEVNULL, timeout=LIMIT,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout.decode(errors="replace")


def expect(holds, what):
    if not holds:
        raise Lost(what)


def result_of(folder):
    """The hash of the state at the end of a run, which has all of its frames."""
    summary = json.loads((folder / "summary.json").read_text())
    expect(summary["exit"]["state"] == "done", f"state {summary['exit']['state']}")
    with h5py.File(folder / "trajectory.h5") as frames:
        n = len(frames["particles/trajectory/position/step"])
    expect(n == N_FRAMES, f"{n} of {N_FRAMES} frames")
    return summary["state_hash"]


def no_rest(folder):
    left = [file.name for file in folder.iterdir() if file.suffix in (".tmp", ".part")]
    expect(not left, f"left over: {left}")


class Worker:
    """A run: whatever fails, it is done, or its job is tried again, and the next start ends as an undisturbed one."""
    program = "shaken-worker"

    def __init__(self, folder):
        self.folder = folder
        (folder / "scene.json").write_text(json.dumps(SCENE))
        self.result = self.run("reference")[2]

    def run(self, name, env=None):
        out = self.folder / name
        code, text = ended([BIN / "shaken-worker", self.folder / "scene.json", "--out", out, "--no-lcm"], env)
        return code, text, result_of(out) if code == 0 else None

    def __call__(self, env):
        code, text, result = self.run("faulty", env)
        failed_for_good = code in (1, 2)
        expect(not failed_for_good, f"exit {code}: {text[-300:]}")
        if code != 0:
            code, more, result = self.run("faulty")
            expect(code == 0, f"then exit {code}: {more[-300:]}")
        expect(result == self.result, "another state")
        no_rest(self.folder / "faulty")
        shutil.rmtree(self.folder / "faulty")
        return text


class Renderer:
    """A picture is the whole one, or none is there and the exit code says so."""
    program = "shaken-render"
    only_first = ("thread",)  # later ones are Mesa's, which waits for ever for them

    def __init__(self, folder):
        self.folder = folder
        Worker(folder)
        self.draw()
        self.picture = (folder / "p.png").read_bytes()
        (folder / "p.png").unlink()

    def draw(self, env=None):
        return ended([BIN / "shaken-render", "picture", self.folder / "reference", "-o", self.folder / "p.png", "--size",
                      "160x120", "--bare"], env)  # which letters fontconfig finds is its own affair

    def __call__(self, env):
        code, text = self.draw(env)
        file = self.folder / "p.png"
        try:
            expect(file.exists() == (code == 0), f"exit {code}: {text[-300:]}")
            expect(code != 0 or file.read_bytes() == self.picture, "another picture")
            expect(not list(self.folder.glob("p.png*.tmp")) or code < 0, "left over")
        finally:
            for rest in self.folder.glob("p.png*"):
                rest.unlink()
        return text


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


class Daemon:
    """With its relay: two jobs that are submitted after the fault are done, and it ends in order."""
    program = "shakend"

    def __init__(self, folder):
        self.folder = folder
        (folder / "sweep.json").write_text(json.dumps({"scene": SCENE, "sweep": {"grid": {"time.seed": [1, 2]}}}))

    def start(self, root, env):
        port = free_port()
        command = [BIN / "shakend", "--root", root, "--slots", "2", "--relay", f"127.0.0.1:{port}", "--lcm-url",
                   f"tcpq://127.0.0.1:{port}"]
        with open(root.with_suffix(".log"), "wb") as log:
            return subprocess.Popen([str(word) for word in command], env=env, stdin=subprocess.DEVNULL, stdout=log,
                                    stderr=subprocess.STDOUT)

    def command(self, *words):
        env = {**os.environ, "SHAKEN_ROOT": str(self.folder / "root")}
        return ended([BIN / "shaken", *words], env)

    def during(self):
        """What the daemon is asked for while a call fails. A request may be refused; then it is asked for again."""
        end = time.monotonic() + LIMIT
        while self.command("submit", self.folder / "sweep.json", "--name", "two")[0] != 0:
            expect(time.monotonic() < end, "nothing is accepted")
            time.sleep(0.2)
        while True:
            code, text = self.command("results", "two", "--json")
            rows = json.loads(text)["rows"] if code == 0 else []
            if sum(row["state"] == "done" for row in rows) == 2:
                return
            expect(time.monotonic() < end, f"jobs are not done: {text[-300:]}")
            time.sleep(0.1)

    def __call__(self, env):
        root, begun = self.folder / "root", self.folder / "begun"
        process = self.start(root, {**env, "SHAKEN_CALL_FAILS_FROM": str(begun)})
        log = root.with_suffix(".log")
        try:
            end = time.monotonic() + LIMIT
            while b"ready" not in log.read_bytes():
                expect(process.poll() is None and time.monotonic() < end, "it does not start")
                time.sleep(0.02)
            begun.touch()
            self.during()
            expect(process.poll() is None, f"it has ended with {process.poll()}")
            process.send_signal(signal.SIGTERM)
            expect(process.wait(LIMIT) in (0, -signal.SIGTERM), f"exit {process.returncode}")
            for run in (root / "runs").glob("*"):
                result_of(run)
            return log.read_text(errors="replace")
        except Lost as loss:
            raise Lost(f"{loss}\n{log.read_text(errors='replace')[-1500:]}") from None
        finally:
            process.kill()
            process.wait()
            begun.unlink(missing_ok=True)
            shutil.rmtree(root, ignore_errors=True)


class Page(Daemon):
    """The page's program answers after a fault as before it."""
    program = "shaken-web"

    def start(self, root, env):
        self.daemon = super().start(root, None)
        end = time.monotonic() + LIMIT
        while self.command("status")[0] != 0:
            expect(time.monotonic() < end, "no daemon")
            time.sleep(0.05)
        self.log = root.with_suffix(".web.log")
        with open(self.log, "wb") as log:
            self.web = subprocess.Popen([str(BIN / "shaken-web"), "--root", str(root), "--port", "0"], env=env,
                                        stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
        while b"open http" not in self.log.read_bytes():
            expect(self.web.poll() is None and time.monotonic() < end, "the page does not start")
            time.sleep(0.02)
        self.address = self.log.read_text().split("open ", 1)[1].split()[0]
        return self.daemon

    def during(self):
        super().during()
        end, answered = time.monotonic() + LIMIT, 0
        while answered < 5:
            expect(self.web.poll() is None, f"the page has ended with {self.web.poll()}")
            try:
                with urllib.request.urlopen(self.address, timeout=20) as answer:
                    answered += answer.status == 200 and b"</html>" in answer.read()
            except OSError:
                expect(time.monotonic() < end, "the page is not answered")
                time.sleep(0.2)
        self.web.send_signal(signal.SIGTERM)
        expect(self.web.wait(LIMIT) == 0, f"exit {self.web.returncode} of the page")

    def __call__(self, env):
        try:
            super().__call__(env)
            return self.log.read_text(errors="replace")
        finally:
            for process in (self.web, self.daemon):
                process.kill()
                process.wait()


def instants(n):
    if MOST == 0 or n <= MOST:
        return range(1, n + 1)
    return sorted({1 + int((k + 0.5) * n / MOST) for k in range(MOST)})


def main():
    programs = [each for each in (Worker, Renderer, Daemon, Page) if not sys.argv[4:] or each.program in sys.argv[4:]]
    n_lost = 0
    for kind in programs:
        folder = Path(tempfile.mkdtemp(prefix="shaken-calls-"))
        one, n_met = kind(folder), 0
        for call in CALLS:
            counted = one(environment(call, 0, kind.program))
            n = int(counted.rsplit(f"{call}: ", 1)[1].split()[0]) if f"{call}: " in counted else 0
            tried = met = 0
            for k in instants(n if call not in getattr(kind, "only_first", ()) else min(n, 1)):
                tried += 1
                try:
                    met += "fault met" in one(environment(call, k, kind.program))
                except (Lost, subprocess.TimeoutExpired) as loss:
                    n_lost += 1
                    print(f"LOST {kind.program}, {call} {k} of {n}: {loss}", flush=True)
                    shutil.rmtree(folder / "faulty", ignore_errors=True)
            print(f"{kind.program:14} {call:8} {n:6} calls, {tried:5} of them failed one by one, {met:5} met", flush=True)
            n_met += met
        if n_met == 0:
            n_lost += 1
            print(f"LOST {kind.program}: no call has failed: is {LIBRARY} loaded?", flush=True)
        shutil.rmtree(folder)
    return 1 if n_lost else 0


if __name__ == "__main__":
    sys.exit(main())
