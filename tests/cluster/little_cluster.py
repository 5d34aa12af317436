#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A Slurm of one's own on this machine: munged, slurmctld and slurmd on 127.0.0.1, with ports, keys and files of their
own, ended with the program that started them. By itself it keeps such a cluster up until Ctrl-C:

    tests/cluster/little_cluster.py [--cores N] [--folder DIR]
"""
import argparse
import getpass
import os
import pathlib
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)  # Ctrl-C, kill, and a terminal that is closed
CONFIGURATION = """\
ClusterName=little
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
ReturnToService=2
SchedulerType=sched/builtin
SchedulerParameters=sched_min_interval=50000,batch_sched_delay=0,sched_interval=1
KillWait=10
MinJobAge=300
MaxArraySize=10001
MaxJobCount=20000
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
NodeName=n0 NodeHostname=localhost NodeAddr=127.0.0.1 CPUs={cores} RealMemory=2000 State=UNKNOWN
PartitionName=main Nodes=n0 Default=YES MaxTime=INFINITE PriorityTier=1 State=UP
PartitionName=urgent Nodes=n0 MaxTime=INFINITE PriorityTier=10 State=UP
"""


class Unavailable(Exception):
    """There is no Slurm here, or it does not start: why, as a sentence."""


def free_ports(n):
    """Ports of 127.0.0.1 on which nobody listens."""
    sockets = [socket.socket() for _ in range(n)]
    try:
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()


class LittleCluster:
    """One node that claims to have `cores` cores. For use with `with`."""

    def __init__(self, folder, cores=2):
        self.folder = pathlib.Path(folder).resolve()
        self.cores = cores
        self.processes = {}
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"),
                                PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")

    def __enter__(self):
        missing = [name for name in PROGRAMS if not shutil.which(name, path=self.environment["PATH"])]
        if missing:
            raise Unavailable(f"there is no {', '.join(missing)} here: apt install slurm-wlm munge")
        try:
            self._prepare()
            self.start("munged")
            self._wait(lambda: (self.folder / "munge.sock").exists(), "munged")
            self.start("slurmctld")
            self.start("slurmd")
            self._wait(self.is_idle, "the node")
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, *_):
        if "slurmctld" in self.processes:
            try:
                self.run("scancel", f"--user={getpass.getuser()}", check=False, timeout=5)
                deadline = time.monotonic() + 15
                while time.monotonic() < deadline and self.run("squeue", "-h", check=False, timeout=5).stdout.strip():
                    time.sleep(0.2)
            except subprocess.TimeoutExpired:
                pass  # it does not answer; its daemons are ended all the same
        for name in ("slurmd", "slurmctld", "munged"):
            self.end(name)

    def _prepare(self):
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        for name in ("state", "spool"):
            (self.folder / name).mkdir(mode=0o700)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        controller_port, node_port = free_ports(2)
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, user=getpass.getuser(), cores=self.cores, controller_port=controller_port,
            node_port=node_port))

    def _command(self, name):
        folder = self.folder
        return {
            "munged": ["munged", "--foreground", "--force", f"--key-file={folder}/munge.key",
                       f"--socket={folder}/munge.sock", f"--pid-file={folder}/munged.pid",
                       f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed"],
            "slurmctld": ["slurmctld", "-D", "-f", f"{folder}/slurm.conf"],
            "slurmd": ["slurmd", "-D", "-N", "n0", "-f", f"{folder}/slurm.conf"],
        }[name]

    def start(self, name):
        """Starts one of the three daemons; its words go to NAME.out."""
        with open(self.folder / f"{name}.out", "ab") as out:
            # it ends with this program, in whatever way that ends
            self.processes[name] = subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *self._command(name)],
                                                    env=self.environment, stdin=subprocess.DEVNULL, stdout=out,
                                                    stderr=out, start_new_session=True)

    def end(self, name, how=signal.SIGTERM):
        """Ends one of them, and waits for that."""
        process = self.processes.pop(name, None)
        if process is None:
            return
        process.send_signal(how)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def run(self, *command, check=True, timeout=60):
        """A command of Slurm's, to its end."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, check=check,
                              timeout=timeout)

    def is_idle(self):
        return self.run("sinfo", "-h", "-o", "%T", check=False).stdout.strip() == "idle"

    def _wait(self, condition, what, seconds=30):
        deadline = time.monotonic() + seconds
        while not condition():
            for name, process in self.processes.items():
                if process.poll() is not None:
                    words = (self.folder / f"{name}.out").read_text(errors="replace")[-500:]
                    raise Unavailable(f"{name} has ended: {words}")
            if time.monotonic() > deadline:
                raise Unavailable(f"{what} does not come up within {seconds} s (logs in {self.folder})")
            time.sleep(0.05)


def end_once(*_):
    """For signals that end this program: by the first, in order; those that follow are in no more of a hurry."""
    for number in ENDING:
        signal.signal(number, signal.SIG_IGN)
    sys.exit(0)


def main():
    parser = argparse.ArgumentParser(description="A little Slurm on this machine, until Ctrl-C.")
    parser.add_argument("--cores", type=int, default=os.cpu_count(), help="that its node claims to have")
    parser.add_argument("--folder", help="for its files; if not given, one that is removed at the end")
    arguments = parser.parse_args()
    for number in ENDING:
        signal.signal(number, end_once)
    folder = arguments.folder or tempfile.mkdtemp(prefix="little-cluster-")
    try:
        with LittleCluster(folder, arguments.cores) as cluster:
            print("a little Slurm is up; in another terminal:\n"
                  f"  export SLURM_CONF={shlex.quote(cluster.environment['SLURM_CONF'])}\n"
                  "  sinfo; shakend --executor slurm\n"
                  "Ctrl-C ends it, and what runs in it.", flush=True)
            signal.pause()
    except Unavailable as problem:
        print(f"no cluster: {problem}", file=sys.stderr)
        return 1
    finally:
        if not arguments.folder:
            shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
