#!/usr/bin/python3
"""`./dev cluster` on a terminal ends with all that belongs to it, however it is ended.

Exits 77 where no Slurm can be started here, and says why."""
import os
import pathlib
import pty
import signal
import subprocess
import sys
import time
import unittest

from little_cluster import run_tests

PROGRAM = pathlib.Path(__file__).with_name("little_cluster.py")
CTRL_C = b"\x03"


def processes_of(folder):
    listed = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    return [line for line in listed.splitlines() if str(folder) in line]


class OnATerminal(unittest.TestCase):
    def setUp(self):
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.execv(sys.executable, [sys.executable, str(PROGRAM), "--cores", "1"])
        said = b""
        while b"Ctrl-C ends it" not in said:
            said += os.read(self.terminal, 4096)
        self.folder = pathlib.Path(said.decode().split("SLURM_CONF=")[1].split("/slurm.conf")[0])
        self.assertTrue(processes_of(self.folder))

    def assert_all_ended(self):
        deadline = time.monotonic() + 60
        while os.waitpid(self.pid, os.WNOHANG)[0] == 0:
            if time.monotonic() > deadline:
                os.kill(self.pid, signal.SIGKILL)
                self.fail("it does not end")
            time.sleep(0.05)
        self.assertEqual(processes_of(self.folder), [])
        self.assertFalse(self.folder.exists())

    def test_ctrl_c(self):
        os.write(self.terminal, CTRL_C)
        self.assert_all_ended()

    def test_ctrl_c_again_and_again(self):
        for _ in range(20):
            try:
                os.write(self.terminal, CTRL_C)
            except OSError:  # it has ended
                break
            time.sleep(0.02)
        self.assert_all_ended()

    def test_a_signal_to_it_alone(self):
        os.kill(self.pid, signal.SIGTERM)
        self.assert_all_ended()

    def test_a_terminal_that_is_closed(self):
        os.close(self.terminal)
        self.assert_all_ended()


if __name__ == "__main__":
    run_tests()
