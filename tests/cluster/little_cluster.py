#!/usr/bin/python3
"""A Slurm of one's own on this machine: munged, slurmctld and slurmd on loopback, with ports, keys and files of their
own, ended with the program that started them. By itself it keeps such a cluster up until Ctrl-C:

    tests/cluster/little_cluster.py [--cores N] [--folder DIR] [--programs DIR]
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
import unittest

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)  # Ctrl-C, kill, and a terminal that is closed
CONFIGURATION = """\
ClusterName=little
SlurmctldHost=localhost({address})
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
NodeName=n0 NodeHostname=localhost NodeAddr={address} CPUs={cores} RealMemory=2000 State=UNKNOWN
PartitionName=main Nodes=n0 Default=YES MaxTime=INFINITE PriorityTier=1 State=UP
PartitionName=urgent Nodes=n0 MaxTime=INFINITE PriorityTier=10 State=UP
"""
# nothing is bounded by control groups, but slurmd ends where it finds none, unless it need not look for their version
CONTROL_GROUPS = "CgroupPlugin=cgroup/v1\n"


class Unavailable(Exception):
    """There is no Slurm here, or it does not start: why, as a sentence."""


def resolved(name):
    """The address that Slurm finds for a name; None if it finds none."""
    try:
        return socket.getaddrinfo(name, None, socket.AF_INET, socket.SOCK_STREAM, flags=socket.AI_ADDRCONFIG)[0][4][0]
    except socket.gaierror:
        return None


def listening():
    """Where Slurm's daemons listen, an address of loopback, and what their commands begin with for that.

    They listen on what the name of this machine is resolved to. Where that is no address of loopback, they get another
    name, which only they see."""
    name = socket.gethostname()
    address = resolved(name)
    if address and address.startswith("127."):
        return address, []
    own = [] if os.geteuid() == 0 else ["--map-current-user", "--keep-caps"]
    renamed = ["unshare", "--uts", *own, "sh", "-c", 'hostname localhost && exec "$@"', "sh"]
    if resolved("localhost") == "127.0.0.1":
        if subprocess.run([*renamed, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
            return "127.0.0.1", renamed
    raise Unavailable(f"Slurm listens on what the name of this machine, {name}, is resolved to, and that is "
                      f"{address or 'nothing'}: write the lines `127.0.0.1 localhost` and `127.0.1.1 {name}` into "
                      "/etc/hosts, before all others"
                      + ("" if address else "; without any address but loopback's, no name is looked up"))


def free_ports(n, address):
    """Ports of an address on which nobody listens."""
    sockets = [socket.socket() for _ in range(n)]
    try:
        for one in sockets:
            one.bind((address, 0))
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
        self.address, self.begins_with = None, []
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"),
                                PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")

    def __enter__(self):
        missing = [name for name in PROGRAMS if not shutil.which(name, path=self.environment["PATH"])]
        if missing:
            raise Unavailable(f"there is no {', '.join(missing)} here: apt install slurm-wlm munge")
        self.address, self.begins_with = listening()
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
        controller = self.processes.get("slurmctld")
        if controller and controller.poll() is None:
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
        (self.folder / "cgroup.conf").write_text(CONTROL_GROUPS)
        controller_port, node_port = free_ports(2, self.address)
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, user=getpass.getuser(), cores=self.cores, controller_port=controller_port, address=self.address,
            node_port=node_port))

    def _command(self, name):
        folder = self.folder
        ends_with_us = ["setpriv", "--pdeathsig", "TERM"]  # in whatever way this program ends
        return {
            "munged": [*ends_with_us, "munged", "--foreground", "--force", f"--key-file={folder}/munge.key",
                       f"--socket={folder}/munge.sock", f"--pid-file={folder}/munged.pid",
                       f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed"],
            "slurmctld": [*self.begins_with, *ends_with_us, "slurmctld", "-D", "-f", f"{folder}/slurm.conf"],
            "slurmd": [*self.begins_with, *ends_with_us, "slurmd", "-D", "-N", "n0", "-f", f"{folder}/slurm.conf"],
        }[name]

    def start(self, name):
        """Starts one of the three daemons; its words go to NAME.out."""
        with open(self.folder / f"{name}.out", "ab") as out:
            self.processes[name] = subprocess.Popen(self._command(name), env=self.environment, stdout=out, stderr=out,
                                                    stdin=subprocess.DEVNULL, start_new_session=True)

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
        while True:
            for name, process in self.processes.items():
                if process.poll() is not None:
                    raise Unavailable(f"{name} has ended\n{self.last_words()}")
            if condition():
                return
            if time.monotonic() > deadline:
                raise Unavailable(f"{what} does not come up within {seconds} s\n{self.last_words()}")
            time.sleep(0.05)

    def last_words(self):
        """The ends of what the daemons printed."""
        lines = [f"{file.stem}: {line}" for file in sorted(self.folder.glob("*.out"))
                 for line in file.read_text(errors="replace").splitlines()[-5:]]
        return "\n".join(lines)


def run_tests():
    """Runs the unit tests of the program; ends with 77, skipped, where no cluster comes up."""
    try:
        with tempfile.TemporaryDirectory(prefix="little-cluster-") as trial, LittleCluster(trial, cores=1):
            pass
    except Unavailable as problem:
        print(f"skipped: {problem}")
        sys.exit(77)
    unittest.main(verbosity=2)


def end_once(*_):
    """For signals that end this program: by the first, in order; those that follow are in no more of a hurry."""
    for number in ENDING:
        signal.signal(number, signal.SIG_IGN)
    sys.exit(0)


def for_another_terminal(cluster, programs):
    """Lines that can be pasted into any shell, in any folder."""
    exports = [f"SLURM_CONF={shlex.quote(cluster.environment['SLURM_CONF'])}"]
    if programs:
        exports.append(f"PATH={shlex.quote(programs)}:$PATH")
    scene = pathlib.Path(__file__).resolve().parents[2] / "configs/quickstart.json"
    return ["export " + " ".join([*exports, "SHAKEN_ROOT=$HOME/shaken-cluster"]),
            'mkdir -p "$SHAKEN_ROOT" && shaken doctor --executor slurm',
            "shakend --executor slurm --slurm-poll 1 & sleep 1",
            f"shaken submit {shlex.quote(str(scene))}",
            "shaken status; shaken wait; shaken results"]


def main():
    parser = argparse.ArgumentParser(description="A little Slurm on this machine, until Ctrl-C: one node, with the "
                                                 "partitions main and urgent. It says what to type to use it.")
    parser.add_argument("--cores", type=int, default=os.cpu_count(), help="that its node claims to have")
    parser.add_argument("--folder", help="for its files, a new one; if not given, one that is removed at the end")
    parser.add_argument("--programs", help="where Shaken's programs are, for the lines that it prints")
    arguments = parser.parse_args()
    for number in ENDING:
        signal.signal(number, end_once)
    if arguments.folder and os.path.exists(arguments.folder):
        parser.error(f"--folder: {arguments.folder} is there already; give one that is not")
    folder = pathlib.Path(arguments.folder or tempfile.mkdtemp(prefix="little-cluster-"))
    keep = bool(arguments.folder)
    try:
        with LittleCluster(folder, arguments.cores) as cluster:
            print("a little Slurm is up, with the partitions main and urgent; in another terminal:",
                  *for_another_terminal(cluster, arguments.programs), sep="\n  ")
            print("Ctrl-C ends it, with what runs in it; results stay in ~/shaken-cluster.", flush=True)
            signal.pause()
    except Unavailable as problem:
        keep = folder.is_dir() and any(folder.iterdir())
        print(f"no cluster: {problem}" + (f"\nlogs are kept in {folder}" if keep else ""), file=sys.stderr)
        return 1
    finally:
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
