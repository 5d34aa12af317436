#!/usr/bin/python3
"""The little cluster starts whatever this machine's name is resolved to, listens nowhere but on loopback, and says what
it is for; where it does not start, it says why, and keeps the logs.

usage: starting_test.py FOLDER-OF-PROGRAMS [TEST ...]
Exits 77 where no Slurm can be started here, and says why."""
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import little_cluster
from little_cluster import Unavailable

PROGRAMS = None  # folder
PROGRAM = pathlib.Path(little_cluster.__file__)
# a network and a table of names of its own, and no control groups; $1 is the table
OWN_NAMES = """ip link set lo up && ip addr add 192.0.2.1/32 dev lo && mount -t tmpfs none /sys &&
mount --bind "$1" /etc/hosts && shift && exec "$@" """
# a job is done, and it says who listens
TRIAL = """
import sys; sys.path.insert(0, sys.argv[2])
from little_cluster import LittleCluster
with LittleCluster(sys.argv[1], cores=1) as cluster:
    cluster.run("sbatch", "--wait", "--output=/dev/null", "--wrap=true", timeout=60)
    print(cluster.run("ss", "-Hltn").stdout)
"""


def in_own_namespaces(*command):
    return ["unshare", "-nm" if os.geteuid() == 0 else "-rnm", *command]


class WhateverTheNameIs(unittest.TestCase):
    def setUp(self):
        if subprocess.run(in_own_namespaces("true"), stderr=subprocess.DEVNULL, check=False).returncode != 0:
            self.skipTest("no private namespaces on this system")
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="little-cluster-")))

    def listeners(self, own_address):
        """Where it listens when this machine's name is resolved to an address."""
        hosts = self.folder / "hosts"
        hosts.write_text("127.0.0.1 localhost\n" + (f"{own_address} {socket.gethostname()}\n" if own_address else ""))
        done = subprocess.run(in_own_namespaces("sh", "-c", OWN_NAMES, "sh", hosts, sys.executable, "-c", TRIAL,
                                                self.folder / "cluster", PROGRAM.parent),
                              capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return {line.split()[3].rsplit(":", 1)[0] for line in done.stdout.splitlines() if line}

    def test_debians_installer(self):
        self.assertEqual(self.listeners("127.0.1.1"), {"127.0.1.1"})

    def test_an_address_that_others_reach(self):
        self.assertEqual(self.listeners("192.0.2.1"), {"127.0.0.1"})

    def test_nothing(self):
        self.assertEqual(self.listeners(None), {"127.0.0.1"})


class WhereItDoesNotStart(unittest.TestCase):
    def test_a_name_that_cannot_be_changed(self):
        for address, words in (("192.0.2.7", "is 192.0.2.7: write"), (None, "is nothing: write")):
            refused = subprocess.CompletedProcess([], 1)
            names = {"localhost": "127.0.0.1", socket.gethostname(): address}
            with mock.patch.object(little_cluster, "resolved", names.get), \
                    mock.patch.object(subprocess, "run", return_value=refused), \
                    self.assertRaises(Unavailable) as caught:
                little_cluster.listening()
            self.assertIn(words, str(caught.exception))
            self.assertIn(f"127.0.1.1 {socket.gethostname()}", str(caught.exception))

    def test_logs_are_kept(self):
        with tempfile.TemporaryDirectory(prefix="little-cluster-") as place:
            (pathlib.Path(place) / "slurmctld").write_text("#!/bin/sh\necho no state here\nexit 1\n")
            (pathlib.Path(place) / "slurmctld").chmod(0o755)
            done = subprocess.run([sys.executable, PROGRAM], capture_output=True, text=True, check=False, timeout=60,
                                  env=dict(os.environ, PATH=f"{place}:{os.environ['PATH']}", TMPDIR=place))
            self.assertEqual(done.returncode, 1)
            self.assertIn("no cluster: slurmctld has ended\n", done.stderr)
            self.assertIn("\nslurmctld: no state here\n", done.stderr)
            folder = pathlib.Path(re.search(r"^logs are kept in (.*)$", done.stderr, re.M)[1])
            self.assertEqual((folder / "slurmctld.out").read_text(), "no state here\n")

    def test_a_folder_that_is_there(self):
        with tempfile.TemporaryDirectory() as place:
            done = subprocess.run([sys.executable, PROGRAM, "--folder", place], capture_output=True, text=True,
                                  check=False, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("is there already", done.stderr)


class WhatItSays(unittest.TestCase):
    def test_can_be_pasted_anywhere(self):
        with tempfile.TemporaryDirectory(prefix="little-cluster-") as home:
            cluster = subprocess.Popen([sys.executable, PROGRAM, "--programs", PROGRAMS], stdout=subprocess.PIPE,
                                       text=True, env=dict(os.environ, TMPDIR=home))
            said = []
            for line in cluster.stdout:
                if line.startswith("Ctrl-C"):
                    break
                said += [line.strip()] * line.startswith("  ")
            said[said.index(next(line for line in said if "submit" in line))] += " -s time.measure=0.1s"  # not half a minute
            shell = subprocess.Popen(["bash", "-e"], cwd="/", env={"HOME": home, "PATH": "/usr/sbin:/usr/bin:/sbin:/bin"},
                                     start_new_session=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            try:
                # the shell's end does not end what it has put into the background
                printed = shell.communicate("\n".join([*said, "kill $!; wait"]), timeout=300)[0]
            finally:
                if shell.poll() is None:
                    os.killpg(shell.pid, signal.SIGKILL)
                cluster.send_signal(signal.SIGINT)
                cluster.wait(60)
            self.assertEqual(shell.returncode, 0, printed)
            self.assertEqual(len(list(pathlib.Path(home).glob("shaken-cluster/runs/*/summary.json"))), 1, printed)
            self.assertRegex(printed, r"(?m)^[0-9a-f]{8}  done ")


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    little_cluster.run_tests()
