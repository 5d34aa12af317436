"""A sweep in a real Slurm, through all that can happen to it there, gives what it gives locally.

usage: slurm_test.py FOLDER-OF-PROGRAMS [TEST ...]
Exits 77 where no Slurm can be started here, and says why. Without SHAKEN_NIGHT the long tests are skipped."""
import http.client
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from little_cluster import LittleCluster, Unavailable

PROGRAMS = None  # folder
CLUSTER = None
PATIENCE = 600  # s; this is no bound on a speed: the machine may be busy with other tests
CPU_OF_A_RUN = 6  # s: all that happens to the sweep must find it at work, however fast this machine is
SCENE = {"rods": {"length": "2.5 mm", "start": "random"}, "box": {"side": "20 mm"},
         "time": {"steady": "0.2 s", "measure": 3, "seed": 1}, "trajectory": {"every": "100 ms"},
         "measure": {"order": {}}}  # `measure` [s] is set to what takes CPU_OF_A_RUN
POINTS = {"grid": {"rods.area_fraction": [0.25, 0.3, 0.35], "plates.gamma": [6, 7]}, "replicas": 2}
N_POINTS = 12
night = unittest.skipUnless(os.environ.get("SHAKEN_NIGHT"), "`./dev test all`")


class Connection(http.client.HTTPConnection):
    def __init__(self, path):
        super().__init__("shaken", timeout=20)
        self.path = path

    def connect(self):
        self.sock = socket.socket(socket.AF_UNIX)
        self.sock.settimeout(self.timeout)
        self.sock.connect(str(self.path))


class Daemon:
    """A shakend on a root of its own. For use with `with`: ends in order, and with it its jobs in Slurm."""

    def __init__(self, root, *options):
        self.root = pathlib.Path(root)
        self.options = options if "--lcm-url" in options else ("--no-lcm", *options)
        self.process = None

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            for sweep in self.get("/v1/sweeps")["sweeps"]:
                self.post(f"/v1/sweeps/{sweep['id']}/cancel")
            self.end(signal.SIGTERM)

    def start(self):
        with open(self.root.with_suffix(".out"), "ab") as out:
            self.process = subprocess.Popen(
                [PROGRAMS / "shakend", "--root", self.root, "--slots", "2", "--slurm-poll", "0.5", *self.options],
                env=CLUSTER.environment, stdin=subprocess.DEVNULL, stdout=out, stderr=out)
        eventually(lambda: self.get("/v1/status"), "the daemon answers")

    def end(self, how):
        self.process.send_signal(how)
        return self.process.wait(60)

    def request(self, method, path, body=None):
        connection = Connection(self.root / "shakend.sock")
        try:
            connection.request(method, path, json.dumps(body) if body is not None else "",
                               {"Content-Type": "application/json"})
            answer = connection.getresponse()
            text = answer.read().decode()
            if answer.status >= 300:
                raise AssertionError(f"{method} {path}: {answer.status} {text}")
            return json.loads(text)
        finally:
            connection.close()

    def get(self, path):
        return self.request("GET", path)

    def post(self, path, body=None):
        return self.request("POST", path, body)

    def submit(self, sweep, name="test.json"):
        return self.post("/v1/sweeps", {"text": json.dumps(sweep), "file": name})

    def jobs(self, sweep="s1"):
        return self.get(f"/v1/sweeps/{sweep}")["jobs"]

    def job(self, id_):
        return self.get(f"/v1/jobs/{id_}")["job"]

    def counts(self):
        return self.get("/v1/status")["jobs"]

    def at_work(self):
        """Jobs whose workers are computing."""
        return [job for job in self.jobs() if job["state"] == "running" and not job["reason"]
                and self.simulated(job["id"]) > 0]

    def simulated(self, id_):
        try:
            return json.loads((self.root / "runs" / id_ / "progress.json").read_text())["sim_time_s"]
        except FileNotFoundError:
            return 0

    def hashes(self):
        return {file.parent.name: json.loads(file.read_text())["state_hash"]
                for file in (self.root / "runs").glob("*/summary.json")}

    def reports(self):
        """What the tasks tell of themselves, by Slurm's "JOB_TASK"."""
        reports = {}
        for file in (self.root / "slurm").glob("*/[0-9]*.json"):
            job = file.parent / "job"
            if job.exists():
                reports[f"{job.read_text()}_{file.stem}"] = json.loads(file.read_text())
        return reports


def eventually(condition, what, patience=PATIENCE):
    begin, last = time.monotonic(), None
    while time.monotonic() < begin + patience:
        try:
            if found := condition():
                print(f"ok - {what}, after {time.monotonic() - begin:.1f} s", flush=True)
                return found
        except (OSError, AssertionError, json.JSONDecodeError, http.client.HTTPException) as problem:
            last = problem
        time.sleep(0.1)
    raise AssertionError(f"not within {patience} s: {what} ({last})")


def running_tasks():
    """"JOB_TASK" of what runs in Slurm."""
    return CLUSTER.run("squeue", "-h", "-r", "-t", "RUNNING", "-o", "%F_%K").stdout.split()


def sweep_of(scene=SCENE, points=POINTS, **keys):
    return {"scene": scene, "sweep": points, **keys}


class InSlurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="shaken slurm '")  # words to quote
        cls.base = pathlib.Path(cls.folder.name)
        cpu = cls.run_here(dict(SCENE, rods=dict(SCENE["rods"], area_fraction=0.3)))["cpu_seconds"]
        SCENE["time"]["measure"] *= round(CPU_OF_A_RUN / cpu, 1)
        print(f"runs of {SCENE['time']['measure']:.1f} s", flush=True)

    @classmethod
    def run_here(cls, scene):
        """The summary of a run without a daemon."""
        file, out = cls.base / "scene.json", cls.base / f"run-{scene['time']['seed']}"
        file.write_text(json.dumps(scene))
        subprocess.run([PROGRAMS / "shaken", "run", file, "--out", out], check=True, stdin=subprocess.DEVNULL,
                       capture_output=True)
        return json.loads((out / "summary.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run(self, result=None):
        """As a rule; where it fails, the words of all daemons follow."""
        problems = len(result.failures) + len(result.errors)
        super().run(result)
        if len(result.failures) + len(result.errors) == problems:
            return
        print(CLUSTER.run("squeue", "-r", check=False).stdout)
        for file in [*sorted(self.base.glob("*.out")), *sorted(CLUSTER.folder.glob("*.log"))]:
            print(f"--- {file.name}", *file.read_text(errors="replace").splitlines()[-60:], sep="\n", flush=True)

    def locally(self):
        """The hashes of the sweep as it runs without Slurm; worked out once."""
        if not hasattr(InSlurm, "reference"):
            with Daemon(self.base / "local") as daemon:
                daemon.submit(sweep_of())
                eventually(lambda: daemon.counts()["done"] == N_POINTS, "the sweep is done locally")
                InSlurm.reference = daemon.hashes()
            self.assertEqual(len(InSlurm.reference), N_POINTS)
        return InSlurm.reference

    def assert_done_once(self, daemon):
        for job in daemon.jobs():
            ends = [line for line in daemon.get(f"/v1/jobs/{job['id']}/history")["changes"] if line["to"] == "done"]
            self.assertEqual(len(ends), 1, job)

    @night
    def test_a_sweep_survives_what_happens_in_a_cluster(self):
        with Daemon(self.base / "everything") as daemon:
            daemon.submit(sweep_of(executor="slurm", slurm={"runs_per_task": 3}))
            eventually(lambda: len(daemon.at_work()) == 2, "two runs are at work in Slurm")

            CLUSTER.end("slurmd", signal.SIGKILL)
            time.sleep(2)
            CLUSTER.start("slurmd")
            print("ok - slurmd was killed", flush=True)

            CLUSTER.end("slurmctld")  # in order: killed, it would not know any more what it has just started
            time.sleep(4)  # the daemon asks in vain
            CLUSTER.start("slurmctld")
            eventually(lambda: CLUSTER.run("squeue", "-h", check=False).returncode == 0, "slurmctld is back")
            eventually(lambda: daemon.at_work(), "runs are at work")

            before = sum(daemon.simulated(job["id"]) for job in daemon.jobs())
            daemon.end(signal.SIGKILL)
            time.sleep(2)
            daemon.start()
            self.assertGreaterEqual(sum(daemon.simulated(job["id"]) for job in daemon.jobs()), before)
            self.assertGreater(daemon.counts()["running"], 0, "they have outlived the daemon")
            self.assertEqual(daemon.end(signal.SIGTERM), 0)
            self.assertTrue(running_tasks(), "they outlive it in order, too")
            daemon.start()
            eventually(lambda: daemon.at_work(), "a new daemon finds the runs that are at work")

            CLUSTER.run("scancel", running_tasks()[0])
            eventually(lambda: any("has ended: CANCELLED" in job["reason"] for job in daemon.jobs()),
                       "what is cancelled by others goes back into the queue")

            cancelled = eventually(lambda: daemon.at_work(), "runs are at work")[0]["id"]
            daemon.post(f"/v1/jobs/{cancelled}/cancel")
            eventually(lambda: daemon.job(cancelled)["state"] in ("cancelled", "done"), "one is cancelled")
            if daemon.job(cancelled)["state"] == "cancelled":
                daemon.post(f"/v1/jobs/{cancelled}/retry")

            # last, for Slurm takes half a minute over it
            before = {job["id"]: daemon.simulated(job["id"]) for job in daemon.at_work()}
            task = max(eventually(running_tasks, "a task runs"), key=lambda name: [int(n) for n in name.split("_")])
            CLUSTER.run("scontrol", "requeue", task)
            eventually(lambda: CLUSTER.run("squeue", "-h", "-r", "-j", task, "-o", "%r").stdout.strip() == "BeginTime",
                       "a task that is put back waits")
            CLUSTER.run("scontrol", "update", f"JobId={task}", "StartTime=now")  # not in two minutes
            eventually(lambda: daemon.reports().get(task, {}).get("restarts") == 1, "a task that is put back starts again")
            eventually(lambda: all(daemon.simulated(i) >= t for i, t in before.items()), "its run goes on", 60)

            eventually(lambda: daemon.counts()["done"] == N_POINTS, "all are done")
            self.assertEqual(daemon.hashes(), self.locally())
            self.assert_done_once(daemon)
            eventually(lambda: not list((daemon.root / "slurm").iterdir()), "nothing of the batches is left")

    @night
    def test_what_is_preempted_goes_on_when_it_has_its_turn_again(self):
        scene = dict(SCENE, time=dict(SCENE["time"], measure=3 * SCENE["time"]["measure"]))  # Slurm may take its time
        sweep = sweep_of(scene, {"grid": {"rods.area_fraction": [0.3], "plates.gamma": [6]}, "replicas": 2})
        with Daemon(self.base / "preempted locally") as daemon:
            daemon.submit(sweep)
            eventually(lambda: daemon.counts()["done"] == 2, "both are done locally")
            local = daemon.hashes()
        with Daemon(self.base / "preempted", "--executor", "slurm", "--runs-per-task", "1") as daemon:
            daemon.submit(sweep)
            eventually(lambda: len(daemon.at_work()) == 2, "two runs are at work in Slurm")
            before = {job["id"]: daemon.simulated(job["id"]) for job in daemon.at_work()}
            tasks = running_tasks()
            CLUSTER.run("sbatch", "--partition=urgent", "--cpus-per-task=2", "--output=/dev/null", "--wrap=sleep 1")
            eventually(lambda: [job["reason"] for job in daemon.jobs()
                                if job["reason"].endswith("(BeginTime)")] and not daemon.at_work(),
                       "they give way to what is urgent")
            for task in tasks:
                eventually(lambda: CLUSTER.run("squeue", "-h", "-r", "-j", task, "-o", "%r").stdout.strip() == "BeginTime",
                           f"{task} waits")
                CLUSTER.run("scontrol", "update", f"JobId={task}", "StartTime=now")  # not in two minutes
            eventually(lambda: all(daemon.reports().get(task, {}).get("restarts") == 1 for task in tasks),
                       "their tasks start again")
            eventually(lambda: daemon.counts()["done"] == 2, "both are done")
            self.assertTrue(all(daemon.simulated(i) >= t for i, t in before.items()))
            self.assertEqual([job["attempt"] for job in daemon.jobs()], [1, 1], "they never came back to the queue")
            self.assertEqual(daemon.hashes(), local)

    def test_both_executors_share_a_queue_and_what_slurm_refuses_keeps_nobody_else(self):
        short = dict(SCENE, rods=dict(SCENE["rods"], area_fraction=0.3), time=dict(SCENE["time"], measure="1 s"))
        with Daemon(self.base / "both") as daemon:
            seeds = ({"grid": {"time.seed": [first, first + 1]}} for first in (1, 3, 5))
            daemon.submit(sweep_of(short, next(seeds), executor="slurm", slurm={"partition": "nowhere"}), "refused.json")
            eventually(lambda: all("nvalid partition" in job["reason"] for job in daemon.jobs("s1")),
                       "what Slurm refuses says why")
            daemon.submit(sweep_of(short, next(seeds), executor="slurm",
                                   slurm={"partition": "main", "options": ["--nice=10"]}), "slurm.json")
            daemon.submit(sweep_of(short, next(seeds), executor="local"), "local.json")
            eventually(lambda: all(job["state"] == "done" for sweep in ("s2", "s3") for job in daemon.jobs(sweep)),
                       "others are done, there and here")
            self.assertTrue(all(job["state"] == "queued" for job in daemon.jobs("s1")))
            pause_ends = min(job["not_before_utime"] for job in daemon.jobs("s1"))
            daemon.submit(sweep_of(short, {"grid": {"time.seed": [1, 2]}}, executor="slurm", slurm={"partition": "main"}),
                          "refused.json")
            eventually(lambda: all(job["state"] == "done" for job in daemon.jobs("s1")), "a mended partition is taken")
            self.assertTrue(all(job["started_utime"] < pause_ends for job in daemon.jobs("s1")), "without a pause")
            log = {sweep: (daemon.root / "runs" / daemon.jobs(sweep)[0]["id"] / "worker.log").read_text()
                   for sweep in ("s2", "s3")}
            self.assertTrue(all("attempt 1" in text for text in log.values()), log)
            in_slurm = daemon.jobs("s2")[0]["id"]
            self.assertEqual(daemon.hashes()[in_slurm], self.run_here(dict(short, time=dict(short["time"], seed=3)))["state_hash"],
                             "Slurm gives what a run gives locally")

    @night
    def test_rods_of_a_node_are_live_where_the_daemon_says(self):
        with socket.create_server(("127.0.0.1", 0)) as free:
            address = f"127.0.0.1:{free.getsockname()[1]}"
        scene = dict(SCENE, rods=dict(SCENE["rods"], area_fraction=0.3), stream={"rate": "10 Hz"})
        with Daemon(self.base / "live", "--executor", "slurm", "--relay", address, "--lcm-url", f"tcpq://{address}") as daemon:
            daemon.submit(sweep_of(scene, {"grid": {"time.seed": [1]}}))
            log = self.base / "live.lcmlog"
            finished = subprocess.run([PROGRAMS / "shaken", "--root", daemon.root, "record", "s1", "-o", log],
                                      stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=PATIENCE)
            self.assertEqual(finished.returncode, 0, finished.stderr)
            job = daemon.jobs()[0]
            self.assertEqual(job["state"], "done", job)
            self.assertGreater(log.read_bytes().count(b"SHAKEN_FRAME"), 10)

    def test_the_doctor_finds_nothing_missing(self):
        root = self.base / "doctor"
        root.mkdir()
        ask = [PROGRAMS / "shaken", "--root", root, "doctor", "--executor", "slurm", "--json"]
        said = {check["check"]: check for check in json.loads(
            subprocess.run(ask, env=CLUSTER.environment, capture_output=True, text=True).stdout)["checks"]}
        for name in ("slurm", "controller", "arrays", "shared root"):
            self.assertEqual(said[name]["level"], "ok", said[name])
        without = dict(CLUSTER.environment, SLURM_CONF="/nowhere/slurm.conf")
        finished = subprocess.run(ask, env=without, capture_output=True, text=True)
        self.assertEqual(finished.returncode, 1)
        said = {check["check"]: check for check in json.loads(finished.stdout)["checks"]}
        self.assertEqual(said["slurm"]["message"], "SLURM_CONF names /nowhere/slurm.conf, and there is no such file")
        ask[2] = self.base / "not there yet"
        finished = subprocess.run(ask, env=CLUSTER.environment, capture_output=True, text=True)
        said = {check["check"]: check for check in json.loads(finished.stdout)["checks"]}
        self.assertIn("does not exist yet", said["shared root"]["message"])

    @night
    def test_figures_are_drawn_from_runs_in_slurm(self):
        def ended():
            return set(CLUSTER.run("squeue", "-h", "-r", "-t", "COMPLETED", "-o", "%F_%K").stdout.split())
        with Daemon(self.base / "figures") as daemon:
            before = ended()
            configs = pathlib.Path(__file__).resolve().parents[2] / "configs"
            finished = subprocess.run(
                [PROGRAMS / "shaken", "--root", daemon.root, "figures", "10", "--scale", "tiny", "--configs", configs,
                 "-o", self.base / "drawn", "--executor", "slurm", "--partition", "main", "--time", "5min"],
                env=CLUSTER.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
            self.assertEqual(finished.returncode, 0, finished.stderr)
            self.assertTrue((self.base / "drawn" / "fig10-tilt.png").exists())
            self.assertEqual(daemon.counts()["done"], 6)
            eventually(lambda: len(ended() - before) == 6, "each run had a task of its own")

    @night
    def test_a_time_limit_costs_nothing_but_another_task(self):
        with Daemon(self.base / "limit", "--executor", "slurm") as daemon:
            daemon.submit(sweep_of(slurm={"runs_per_task": N_POINTS, "time": "1 min"}))
            eventually(lambda: daemon.counts()["done"] == N_POINTS, "all are done")
            self.assertEqual(daemon.hashes(), self.locally())
            causes = [line["cause"] for job in daemon.jobs()
                      for line in daemon.get(f"/v1/jobs/{job['id']}/history")["changes"]]
            self.assertIn("the worker has stopped at a checkpoint", causes)
            self.assertTrue(any("has ended: COMPLETED" in cause for cause in causes), causes)
            self.assertFalse(any("TIMEOUT" in cause for cause in causes), causes)


def main():
    global PROGRAMS, CLUSTER
    PROGRAMS = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="little-cluster-") as folder:
        try:
            with LittleCluster(folder, cores=2) as CLUSTER:
                program = unittest.main(argv=[sys.argv[0], *sys.argv[2:]], exit=False, verbosity=2)
                return 0 if program.result.wasSuccessful() else 1
        except Unavailable as problem:
            print(f"skipped: {problem}")
            return 77


if __name__ == "__main__":
    sys.exit(main())
