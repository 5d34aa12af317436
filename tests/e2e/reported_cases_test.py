#!/usr/bin/env python3
"""Inputs that users of programs like this one have reported as bugs, typed into the programs; each has a right answer.

    reported_cases_test.py BIN

BIN is the folder of the programs. Each test below is one report: what was typed, and what is right.
"""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.dom.minidom
from pathlib import Path

import h5py
import numpy as np

BIN = Path(sys.argv.pop(1))
ONE = {"rods": {"length": "4.5 mm", "area_fraction": 0.3}, "box": {"side": "15 mm"},
       "time": {"steady": 0, "measure": "0.2 s", "step": "20 us"}, "measure": {"order": {}},
       "trajectory": {"every": "10 ms"}}


class Reported(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="shaken-cases-"))
        self.daemon = None

    def tearDown(self):
        if self.daemon:
            self.daemon.send_signal(signal.SIGTERM)
            self.assertEqual(self.daemon.wait(60), 0)
        shutil.rmtree(self.folder)

    def type(self, command, code=0, limit=100):
        """The output of a command that ends with this exit code, or one of these, within so many seconds."""
        environment = {**os.environ, "SHAKEN_ROOT": str(self.folder / "root"), "PATH": f"{BIN}:{os.environ['PATH']}"}
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=limit)
        output = done.stdout.decode(errors="backslashreplace")
        self.assertIn(done.returncode, code if isinstance(code, tuple) else (code,), f"{command}\n{output}")
        return output

    def write(self, name, content):
        text = content if isinstance(content, str) else json.dumps(content)
        (self.folder / name).write_text(text)

    def run_one(self, scene=None, name="r"):
        self.write(f"{name}.json", scene or ONE)
        self.type(f"shaken run {name}.json --out {name}")
        return self.folder / name

    def start_daemon(self, root="root"):
        environment = {**os.environ, "SHAKEN_ROOT": str(self.folder / root)}
        self.daemon = subprocess.Popen([BIN / "shakend", "--no-lcm", "--slots", "2"], env=environment,
                                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.assertIn(b"ready", self.daemon.stdout.readline())

    def test_07_one_run_that_a_sweep_lists_several_times_is_one_sample(self):
        scene = {**ONE, "time": {"steady": 0, "measure": "0.1 s", "step": "20 us"}}
        self.write("so.json", {"scene": scene, "sweep": {"list": [{"contacts.sweeps": n} for n in [1, 2] * 4]}})
        self.start_daemon()
        self.type("shaken submit so.json --name so && shaken wait so")
        rows = json.loads(self.type("shaken results so --aggregate --json"))["rows"]
        singles = json.loads(self.type("shaken results so --json"))["rows"]
        n_effective = {row["job"]: row["summary"]["order"]["n_effective"] for row in singles}
        self.assertEqual(sum(row["n_replicas"] for row in rows), len(n_effective))
        for row in rows:
            self.assertEqual(row["n_replicas"], 1)
            self.assertIn(row["order.n_effective"], n_effective.values())

    def test_10_foreign_spaces_and_decimal_commas_are_named(self):
        self.write("nbsp.json", '{"rods": {"length": "4.5\u00a0mm"}}')
        self.write("narrow.json", '{"rods": {"length": "4.5\u202fmm"}}')
        self.write("comma.json", '{"rods": {"length": "4,5 mm"}}')
        self.write("one.json", ONE)
        self.assertIn("U+00A0", self.type("shaken validate nbsp.json", 2))
        self.assertIn("U+202F", self.type("shaken validate narrow.json", 2))
        self.assertIn("decimal comma", self.type("shaken validate comma.json", 2))
        self.assertIn("decimal comma", self.type("shaken validate one.json -s 'box.gap=1,3 mm'", 2))

    def test_11_g_of_few_rods_is_one_where_they_do_not_know_of_each_other(self):
        side = 20.0
        for n in (2, 3, 7):
            run = self.run_one({"rods": {"length": "4.5 mm", "count": n, "start": "random"},
                                "box": {"side": f"{side} mm"}, "time": {"steady": 0, "measure": "1 s", "step": "20 us"},
                                "measure": {"g2": {}}, "trajectory": {"every": "10 ms"}}, f"n{n}")
            with h5py.File(run / "observables.h5") as file:
                r, g = file["g2/r_mm"][:], file["g2/g"][:]
            with h5py.File(run / "trajectory.h5") as file:
                rods = file["particles/trajectory"]
                at, place = rods["position/time"][:], rods["position/value"][:]
            width = r[1] - r[0]
            counts, samples = np.zeros(len(r)), 0
            for frame in np.flatnonzero(np.abs(at / 0.1 - np.round(at / 0.1)) < 1e-6):
                apart = place[frame, :, None, :2] - place[frame, None, :, :2]
                apart -= side * np.round(apart / side)
                pairs = np.hypot(apart[..., 0], apart[..., 1])[np.triu_indices(n, 1)]
                counts += np.histogram(pairs, bins=len(r), range=(0, r[-1] + width / 2))[0]
                samples += 1
            right = counts / (samples * n * (n - 1) / 2 * 2 * np.pi * r * width / side**2)
            np.testing.assert_allclose(g, right, rtol=1e-3, atol=1e-9)

    def test_22_numbers_of_a_recorded_file_are_checked(self):
        run = self.run_one()
        for kind in ("inf", "1e30", "nan", "box1e-6", "box0"):
            copy = self.folder / kind
            shutil.copytree(run, copy)
            (copy / "summary.json").unlink()  # which knows what the file was
            with h5py.File(copy / "trajectory.h5", "r+") as file:
                if kind.startswith("box"):
                    file["parameters"].attrs["box_side_mm"] = float(kind[3:])
                else:
                    file["particles/trajectory/position/value"][3, 2, 0] = float(kind)
            frames = "--frame 3"
            picture = self.type(f"timeout 20 shaken-render picture {kind} {frames} -o x.png", (1, 2))
            export = self.type(f"timeout 20 shaken export {kind} -o x.gsd", (1, 2))
            for output in (picture, export):
                self.assertIn("trajectory.h5", output)
                self.assertNotIn("region.cpp", output)
                if not kind.startswith("box"):
                    self.assertRegex(output, r"frame 3\b.*rod 2\b")

    def test_27_closed_streams_spoil_no_lock(self):
        self.write("one.json", ONE)
        self.type("shaken-worker one.json --out x --no-lcm 2>&-")
        self.assertRegex((self.folder / "x/lock").read_text(), r"^\d+\n?$")

    def test_29_a_root_that_json_cannot_name_is_refused(self):
        output = self.type("shakend --root $(printf 'r\\xff') --no-lcm", 2, 20)
        self.assertIn("UTF-8", output)

    def test_38_an_odd_size_is_bad_input_for_every_film(self):
        self.run_one()
        for suffix in ("mp4", "webm"):
            self.type(f"shaken movie r -o r.{suffix} --size 321x241", 2)

    def test_39_a_film_that_validate_accepts_is_made(self):
        scene = {**ONE, "movie": {"every": "200 ms", "size": [7680, 4320]}}
        scene["time"] = {"steady": 0, "measure": "20 ms", "step": "20 us"}
        self.run_one(scene)
        self.assertGreater((self.folder / "r/movie.mp4").stat().st_size, 1000)

    def test_40_a_name_with_a_colon_is_a_file(self):
        self.run_one()
        for name in ("2026-11-25T02:30:00.mp4", "run:1.gif"):
            self.type(f"shaken movie r -o {name} --size 320x240 --samples 1 --every 10")
            self.assertGreater((self.folder / name).stat().st_size, 100)
        self.assertNotIn("onnection", self.type("shaken-render movie r -o http://127.0.0.1:1/x.mp4", 1))

    def test_41_what_was_not_recorded_is_not_drawn(self):
        self.run_one()
        for command in ("movie r -o x.mp4 --from 5s --to 9s", "picture r --time 100s -o x.png",
                        "export r --from 5s -o x.gsd"):
            output = self.type(f"shaken {command}", 2)
            self.assertIn("0.2 s", output)
        self.assertEqual(list(self.folder.glob("x.*")), [])

    def test_42_an_svg_is_xml_whatever_the_label(self):
        self.run_one()
        self.type("shaken-render picture r -o x.svg --label $'a\\x01b\\x1b[31m <&>\"'")
        xml.dom.minidom.parse(str(self.folder / "x.svg"))

    def test_46_a_message_is_not_cut_off_at_a_nul(self):
        self.start_daemon()
        output = self.type("curl -s --unix-socket root/shakend.sock 'http://x/v1/jobs/ab%00cd'")
        self.assertIn(r"ab\\u0000cd", output)
        self.assertTrue(output.strip().endswith("}"))

    def test_47_of_two_writers_of_one_file_one_is_there_whole(self):
        self.run_one({**ONE, "rods": {"length": "4.5 mm", "count": 40}}, "a")
        self.run_one({**ONE, "rods": {"length": "4.5 mm", "count": 20}}, "b")
        for attempt in range(4):
            self.type("shaken export a -o c.extxyz & p=$!; shaken export b -o c.extxyz & q=$!; wait $p && wait $q")
            lines = (self.folder / "c.extxyz").read_text().splitlines()
            n = int(lines[0])
            self.assertEqual(len(lines), 21 * (n + 2))
            self.assertEqual(set(lines[:: n + 2]), {str(n)})
            self.assertEqual([path.name for path in self.folder.glob("c.extxyz*")], ["c.extxyz"])

    def test_55_a_scene_without_an_end_is_refused(self):
        for command in ("shaken-worker /dev/zero --probe p.json --probe-cpu 0", "shaken validate /dev/zero"):
            self.assertIn("16 MiB", self.type(f"timeout -k 5 60 {command}", 2))

    def test_57_a_run_or_a_sample_that_is_too_short_is_named(self):
        self.write("one.json", ONE)
        self.assertIn("time.measure", self.type("shaken validate one.json -s time.measure=1e-6", 2))
        self.assertIn("measure.order.every 100 s is longer than the run",
                      self.type("shaken validate one.json -s measure.order.every=100s"))

    def test_61_a_name_with_a_zero_before_its_number_is_no_id(self):
        self.write("long.json", {**ONE, "time": {"steady": 0, "measure": "1000 s", "step": "20 us"}})
        self.start_daemon()
        self.type("shaken submit long.json --name victim && shaken submit long.json -s time.seed=52 --name s01")
        self.assertIn("sweep s2 (s01): 1 job", self.type("shaken cancel s01"))
        state = json.loads(self.type("shaken status s1 --json"))["jobs"][0]["state"]
        self.assertNotIn(state, ("cancelled", "stopping"))
        for name in ("s1", "0123456789abcdef"):
            self.assertIn("could be mistaken for", self.type(f"shaken submit long.json --name {name}", 2))
        # every verb looks in one order: a name before a shortened id (30)
        job = json.loads(self.type("shaken status s1 --json"))["jobs"][0]["id"]
        self.type(f"shaken submit long.json -s time.seed=53 --name {job[:4]}")
        for verb in ("status", "history"):
            self.assertNotIn(job, self.type(f"shaken {verb} {job[:4]} --json"))
        self.assertIn("did you mean victim?", self.type("shaken status victm", 2))

    def test_68_the_environment_chooses_no_rasteriser(self):
        self.run_one()
        self.type("shaken picture r -o right.png --size 160x120")
        for setting in ("GALLIUM_DRIVER=zink", "GALLIUM_DRIVER=nonsense", "GALLIUM_DRIVER=softpipe",
                        "MESA_GL_VERSION_OVERRIDE=2.1"):
            self.type(f"{setting} shaken picture r -o x.png --size 160x120")
            self.assertEqual((self.folder / "x.png").read_bytes(), (self.folder / "right.png").read_bytes(), setting)

    def test_68_a_film_that_could_not_be_made_is_said(self):
        scene = {**ONE, "movie": {"every": "50 ms"}}
        self.write("film.json", scene)
        programs = self.folder / "bin"
        programs.mkdir()
        for program in BIN.iterdir():
            (programs / program.name).symlink_to(program)
        (programs / "shaken-worker-wide").unlink(missing_ok=True)
        copy = programs / "shaken-worker"  # its siblings are those beside it
        copy.unlink()
        shutil.copy(BIN / "shaken-worker", copy)
        (programs / "shaken-render").unlink()
        (programs / "shaken-render").write_text("#!/bin/sh\n: >\"$2/movie.mp4.0123456789ab.tmp\"\nkill -SEGV $$\n")
        (programs / "shaken-render").chmod(0o755)
        output = self.type("bin/shaken-worker film.json --out r --no-lcm", 1)
        self.assertIn("without its movie, which the next start draws", output)
        self.assertEqual(list((self.folder / "r").glob("*.tmp")), [])
        self.type("shaken-worker film.json --out r --no-lcm")
        self.assertTrue((self.folder / "r/movie.mp4").exists())

    def test_70_a_dry_run_refuses_what_a_submission_refuses(self):
        self.write("tiny.json", ONE)
        self.start_daemon()
        for term in ("--time-limit 01:30:00", "--time-limit 0", "--soft-limit -5s", "--at-once 0", "--after nosuch",
                     "--stop-if 'done>3'", "--name a/b", "--name .", "--name s22"):
            said = [self.type(f"shaken submit tiny.json {term} {trial}", 2) for trial in ("--dry-run --no-probe", "")]
            self.assertEqual(*said)
        self.type("shaken submit tiny.json --dry-run --no-probe --at-once 1")
        self.assertIn("nothing has been submitted yet", self.type("shaken results", 2))

    def test_73_a_relative_root_of_the_environment_is_ignored(self):
        for setting in ("XDG_DATA_HOME=rel", "HOME=$PWD XDG_DATA_HOME="):
            self.assertIn("$PWD/.local".replace("$PWD", str(self.folder)),
                          self.type(f"unset SHAKEN_ROOT; HOME=$PWD {setting} shaken status", 3))
        self.assertIn("absolute path", self.type("unset SHAKEN_ROOT; HOME=rel XDG_DATA_HOME=rel shaken status", 2))

    def test_74_another_users_daemon_is_told_as_such(self):
        self.start_daemon()
        if os.getuid() != 0 or not shutil.which("setpriv"):
            self.skipTest("another user is needed")
        for folder in (self.folder, self.folder / "root"):
            folder.chmod(0o755)  # so that the socket itself is what refuses
        output = self.type("setpriv --reuid 65534 --clear-groups shaken status", 3)
        self.assertIn("Permission denied: what listens there is another user's daemon", output)

    def test_126_a_folder_for_scratch_that_is_not_there_is_named(self):
        self.write("tiny.json", ONE)
        self.type("TMPDIR= shaken explain tiny.json")
        self.assertIn("/nonexistent, which TMPDIR names", self.type("TMPDIR=/nonexistent shaken explain tiny.json", 1))

    def test_files_of_strangers_end_no_reader(self):
        self.run_one()
        (self.folder / "r/summary.json").unlink()  # nothing vouches for the files any more
        broken = bytearray((self.folder / "r/trajectory.h5").read_bytes())
        heap = broken.index(b"GCOL")  # of the file's texts
        broken[heap + 29:heap + 31] = b"\x7f\x7f"  # the first is longer than all memory: HDF5 1.10 is ended by that
        (self.folder / "r/trajectory.h5").write_bytes(broken)
        for command in ("picture r -o x.png", "movie r -o x.mp4", "export r -o x.extxyz",
                        "import r/trajectory.h5 --scene r.json"):
            output = self.type(f"shaken {command}", (1, 2))
            self.assertIn("ended its reader (signal 11), as damaged files do", output)

    def test_equal_runs_have_equal_files(self):
        self.run_one(name="a")
        time.sleep(1.1)  # HDF5 would note the second in which a data set was made
        self.run_one(name="b")
        for name in ("trajectory.h5", "observables.h5"):
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes(), name)


unittest.main(verbosity=2)
