#!/usr/bin/env python3
"""Files of former versions, beside this one, are read by the present one (docs/compatibility.md). The first are of the
state of 30 November 2026 (938b697c), between 0.1.0 and 1.0.

    former_test.py SOURCE BIN

SOURCE is the source tree, BIN the folder of the programs. An archive holds what a user of that version may have kept: a
daemon's root with its queue, runs that are done, a run that is held, a scene, a sweep, what `shaken pack` and `shaken
record` wrote.
"""
import json
import os
import signal
import subprocess
import sys
import tarfile
import tempfile
import time
import unittest
from pathlib import Path

SOURCE, BIN = Path(sys.argv.pop(1)), Path(sys.argv.pop(1))
HAS_NETWORK = os.environ.get("SHAKEN_OWN_NETWORK") == "1"
sys.path.insert(0, str(SOURCE / "python"))
import shaken  # noqa: E402  (that of this tree)


class Former(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory(prefix="shaken-former-")
        self.folder = Path(self.scratch.name)
        with tarfile.open(SOURCE / "tests/former/2026-11-30.tar.xz") as kept:
            kept.extractall(self.folder)
        self.environment = {**os.environ, "SHAKEN_ROOT": str(self.folder / "root")}
        self.daemon = subprocess.Popen([BIN / "shakend", "--slots", "1", *([] if HAS_NETWORK else ["--no-lcm"])],
                                       env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.assertIn("ready", self.daemon.stdout.readline())

    def tearDown(self):
        self.daemon.send_signal(signal.SIGTERM)
        self.assertEqual(self.daemon.wait(60), 0)
        self.daemon.stdout.close()
        self.scratch.cleanup()

    def type(self, *command):
        """The output of a verb that ends well."""
        done = subprocess.run([BIN / "shaken", *command], cwd=self.folder, env=self.environment, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=100)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}")
        return done.stdout

    def job(self):
        return json.loads(self.type("status", "long", "--json"))["jobs"][0]

    def test_the_queue_and_what_is_done(self):
        states = {sweep["name"]: sweep["counts"] for sweep in json.loads(self.type("status", "--json"))["sweeps"]}
        self.assertEqual([states[name]["done"] for name in ("one", "chain")], [1, 4])
        self.assertEqual(states["long"]["held"], 1)
        self.assertIn("0 new", self.type("submit", "scene.json"))  # the id of a scene is what it was
        self.assertIn("0 new", self.type("submit", "sweep.json"))

    def test_a_held_run_goes_on_where_it_was(self):
        reached = self.job()["progress"]["sim_time_s"]
        self.assertGreater(reached, 20)
        self.type("resume", "long")
        until = time.monotonic() + 60
        while (job := self.job())["state"] != "running" or job["progress"]["sim_time_s"] <= reached:
            self.assertLess(time.monotonic(), until, job)
            time.sleep(0.1)
        log = next((self.folder / "root/runs").glob("07483b96*")) / "worker.log"
        self.assertIn("going on from", log.read_text())  # and not from the beginning
        self.type("cancel", "long")

    def test_the_files_of_a_run(self):
        (run,) = shaken.results(self.folder / "root", "one")[0].runs
        self.assertEqual((run.summary["n_rods"], len(run.trajectory)), (36, 8))
        self.assertEqual(run.arrays["/order/order"].shape, run.arrays["/order/time_s"].shape)
        self.assertEqual(run.numbers["S"].value, run.summary["order"]["mean"])
        self.type("picture", str(run.directory), "-o", "rods.png", "--size", "320x180", "--samples", "1")
        self.type("plot", str(run.directory), "-o", "run.png")

    def test_what_was_packed_and_recorded(self):
        self.type("unpack", "one.tar.xz")
        self.assertIn("b010cdf5", self.type("results", "one"))
        if HAS_NETWORK:
            self.assertIn("20 messages", self.type("replay-log", "live.lcmlog", "--speed", "10"))


if __name__ == "__main__":
    unittest.main()
