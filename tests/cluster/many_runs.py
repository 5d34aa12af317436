"""What a large sweep costs the daemon and Slurm: runs that only sleep for a moment, through a Slurm of one's own.

usage: many_runs.py FOLDER-OF-PROGRAMS [--runs 10000] [--runs-per-task 50] [--max-pending 100] [--poll 2]
docs/cluster.md has what it printed."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from little_cluster import LittleCluster

WORKER = """#!/bin/sh
sleep 0.05
printf '{"n_rods": 7, "run_id": "%s", "exit": {"state": "done", "tick": 1000000000}}' "$5" > "$3/summary.json"
"""
COUNTED = "#!/bin/sh\necho >> '{calls}'\nexec {program} \"$@\"\n"
SCENE = {"rods": {"length": "2.5 mm", "start": "random", "area_fraction": 0.2}, "box": {"side": "12 mm"},
         "time": {"steady": "0 s", "measure": "1 s"}, "measure": {"order": {}}}


def executable(path, text):
    path.write_text(text)
    path.chmod(0o755)


def of_process(pid, file, key):
    """A number in /proc/PID/FILE."""
    for line in pathlib.Path(f"/proc/{pid}/{file}").read_text().splitlines():
        if line.startswith(key):
            return int(line.split()[1])
    raise KeyError(key)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=10_000)
    parser.add_argument("--runs-per-task", type=int, default=50)
    parser.add_argument("--max-pending", type=int, default=100)
    parser.add_argument("--poll", type=float, default=2)
    arguments = parser.parse_args()
    programs = arguments.programs.resolve()
    with tempfile.TemporaryDirectory(prefix="many-runs-") as folder:
        base = pathlib.Path(folder)
        executable(base / "worker", WORKER)
        with LittleCluster(base / "cluster", cores=2) as cluster:
            (base / "bin").mkdir()
            for name in ("sbatch", "squeue", "scancel"):
                executable(base / "bin" / name, COUNTED.format(calls=base / f"{name}.calls", program=f"/usr/bin/{name}"))
            environment = dict(cluster.environment, PATH=f"{base}/bin:{os.environ['PATH']}")
            root = base / "root"
            daemon = subprocess.Popen(
                [programs / "shakend", "--root", root, "--no-lcm", "--quiet", "--executor", "slurm", "--worker",
                 base / "worker", "--slurm-poll", str(arguments.poll), "--runs-per-task", str(arguments.runs_per_task),
                 "--max-pending", str(arguments.max_pending)], env=environment, stdout=subprocess.DEVNULL)
            try:
                while not (root / "shakend.sock").exists():
                    time.sleep(0.1)
                (base / "sweep.json").write_text(json.dumps({"scene": SCENE, "sweep": {"replicas": arguments.runs}}))
                begin = time.monotonic()
                subprocess.run([programs / "shaken", "--root", root, "submit", base / "sweep.json"], check=True,
                               stdout=subprocess.DEVNULL)
                print(f"queued after {time.monotonic() - begin:.0f} s", flush=True)
                begin = time.monotonic()
                done = 0
                while done < arguments.runs:
                    time.sleep(1)
                    status = subprocess.run([programs / "shaken", "--root", root, "status", "--json"], check=True,
                                            capture_output=True, text=True)
                    jobs = json.loads(status.stdout)["status"]["jobs"]
                    done = jobs["done"]
                    if jobs["failed"]:
                        raise SystemExit(f"{jobs['failed']} runs have failed")
                wall = time.monotonic() - begin
                calls = {name: len(file.read_text()) if (file := base / f"{name}.calls").exists() else 0
                         for name in ("sbatch", "squeue", "scancel")}
                operations = of_process(daemon.pid, "io", "syscr") + of_process(daemon.pid, "io", "syscw")
                ticks = pathlib.Path(f"/proc/{daemon.pid}/stat").read_text().rsplit(")", 1)[1].split()
                seconds = (int(ticks[11]) + int(ticks[12])) / os.sysconf("SC_CLK_TCK")
                print(f"{arguments.runs} runs, {arguments.runs_per_task} in a task: {wall:.0f} s, "
                      f"{arguments.runs / wall:.0f} runs/s\ncalls: {calls}\n"
                      f"daemon: {operations / wall:.0f} reads and writes a second, {seconds:.0f} CPU-seconds, "
                      f"{of_process(daemon.pid, 'status', 'VmHWM') / 1000:.0f} MB at most", flush=True)
            finally:
                daemon.terminate()
                daemon.wait(60)
    return 0


if __name__ == "__main__":
    sys.exit(main())
