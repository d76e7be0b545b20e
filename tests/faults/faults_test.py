"""Faults of the machine around a run: what is finished is there, what is half-written is not taken for whole."""
import json
import os
import resource
import shutil
import signal
import sqlite3
import struct
import subprocess
import threading
import time
import unittest

from program import PROGRAM, CliTest, box

QUICK = ("--path-timeout", "0", "--timeout", "0", "--set", "run.path_steps=2000")
EVIL = os.environ["EVIL_FOLDER"]
NIGHTLY = os.environ.get("DISMANTLE_TESTS") == "nightly"


class Faults(CliTest):
    def setUp(self):
        super().setUp()
        self.write("in/a.obj", box((0, 0, 0), (1, 1, 1)))
        self.write("in/b.obj", box((1, 0, 0), (2, 1, 1)))

    def good_plan(self, *names):
        """The file is a whole plan, and holds."""
        json.loads(self.read(*names))
        self.run_program("verify", self.path(*names), "--assembly", self.path("in"), "-q", status=0)

    def mounted(self, options, command):
        """Runs a shell command in which `out` is a small file system of its own. It sees the program as $0."""
        os.makedirs(self.path("out"), exist_ok=True)
        done = subprocess.run(["unshare", "-m", "sh", "-c", f"mount -t tmpfs {options} none out || exit 99; {command}", PROGRAM],
                              cwd=self.folder, capture_output=True, text=True, timeout=300)
        if done.returncode in (1, 99) and ("mount" in done.stderr or "unshare" in done.stderr):
            self.skipTest("file systems cannot be mounted here")
        return done

    def test_a_disk_that_is_full(self):
        words = " ".join(QUICK)
        done = self.mounted("-o size=44k", f"\"$0\" plan in -o out {words}; status=$?; mkdir kept; cp -a out/. kept; exit $status")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("No space left", done.stderr)
        for name in os.listdir(self.path("kept")):
            self.assertFalse(name.endswith(".tmp"), name)
        if "plan.json" in os.listdir(self.path("kept")):
            self.good_plan("kept", "plan.json")

    def test_an_output_folder_that_is_read_only(self):
        done = self.mounted("-o ro", "\"$0\" plan in -o out")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("cannot be used as output folder", done.stderr)

    def test_killed_at_any_moment(self):
        for wait in (0.02, 0.1, 0.2, 0.4, 0.8):
            run = subprocess.Popen([PROGRAM, "plan", "in", "-o", "out", "-q", *QUICK], cwd=self.folder)
            try:
                run.wait(wait)
            except subprocess.TimeoutExpired:
                run.send_signal(signal.SIGKILL)
                run.wait()
            if os.path.exists(self.path("out", "plan.json")):
                json.loads(self.read("out", "plan.json"))
            for name in os.listdir(self.path("out")) if os.path.exists(self.path("out")) else ():
                if not name.startswith("."):
                    self.assertGreater(os.path.getsize(self.path("out", name)), 0, name)
        self.run_program("plan", "in", "-o", "out", "-q", *QUICK, status=0)
        self.good_plan("out", "plan.json")

    def test_memory_that_runs_out(self):
        """Whatever the limit: a plan that holds, or a message and a status; no signal."""
        for mib in (60, 120, 250, 400, 800):
            limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (mib << 20, mib << 20))
            done = self.run_program("plan", "in", "-o", "out", "--threads", "1", *QUICK, preexec_fn=limit)
            self.assertGreaterEqual(done.returncode, 0, f"{mib} MiB: {done.stderr}")
            if done.returncode == 0:
                self.good_plan("out", "plan.json")
            else:
                self.assertNotEqual(done.stderr, "", mib)

    def test_an_output_that_is_closed(self):
        """As in `dismantle plan in | head -0`."""
        read, write = os.pipe()
        os.close(read)
        done = self.run_program("plan", "in", "-o", "out", *QUICK, stdout=write)
        os.close(write)
        self.assertNotEqual(done.returncode, 0)
        self.good_plan("out", "plan.json")

    def test_a_clock_that_jumps(self):
        """The time of day, by hours and back: the plan is the same, within its limits, and a campaign ends with all its rows."""
        jumping = dict(os.environ, LD_PRELOAD=os.environ["JUMPING_CLOCK"])
        self.run_program("plan", "in", "-o", "out", "-q", *QUICK, status=0)
        self.run_program("plan", "in", "-o", "jumped", "-q", "--timeout", "600", env=jumping, status=0)
        moves, jumped = ([step["moves"] for step in json.loads(self.read(folder, "plan.json"))["disassembly"]]
                         for folder in ("out", "jumped"))
        self.assertEqual(moves, jumped)
        self.write("suite.yaml", "schema: 1\nassemblies:\n  - {sample: peg_in_hole}\nplanners:\n  default: {}\nseeds: 1..3\n"
                                 "limits: {timeout: 60, wall: 300, memory: 2048}\n")
        self.run_program("bench", "suite.yaml", "-o", "bench", env=jumping, status=0)
        with sqlite3.connect(self.path("bench", "results.db")) as database:
            self.assertEqual(database.execute("select count(*), sum(solved) from trials").fetchone(), (3, 3))

    def evil(self):
        os.makedirs(self.path("plugins"), exist_ok=True)
        name, = (n for n in os.listdir(EVIL) if n.endswith(".so"))
        shutil.copy(os.path.join(EVIL, name), self.path("plugins", name))
        self.write("evil.yaml", "schema: 1\nplugins: {search_paths: [plugins]}\nsimulator: {type: fcl}\n"
                                "path_planner: {type: evil.sleep}\nsequence_planner: {type: progressive}\nrun: {grace: 0.5, timeout: 2}\n")
        return self.path("plugins", name)

    def test_a_plugin_file_that_is_not_there(self):
        os.remove(self.evil())
        self.assert_fails(2, "evil.sleep", "plan", "in", "-o", "out", "-c", "evil.yaml")

    def test_a_plugin_file_that_is_replaced_while_it_runs(self):
        """By another file of that name, as package managers do it; and cut off where it lies."""
        for how in ("renamed", "truncated"):
            file = self.evil()
            run = subprocess.Popen([PROGRAM, "plan", "in", "-o", "out", "-c", "evil.yaml"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
            time.sleep(1)
            if how == "renamed":
                self.write("plugins/new", "this is no plugin")
                os.rename(self.path("plugins", "new"), file)
            else:
                os.truncate(file, 0)
            _, said = run.communicate(timeout=120)
            self.assertEqual(run.returncode, 4, f"{how}: {said}")
            self.assertIn("error", said)

    def bench(self):
        self.write("suite.yaml", "schema: 1\nassemblies:\n  - {path: in}\nplanners:\n  bfs: {set: {path_planner.type: bfs}}\n"
                                 "seeds: 1..2\nlimits: {timeout: 30, wall: 120, memory: 4096}\n")
        return ("bench", "suite.yaml", "-o", "rows", "--format", "json")

    def test_a_database_that_is_locked(self):
        """Another process writes for a while: the campaign waits, and no row is lost."""
        command = self.bench()
        self.run_program(*command, status=0)
        shutil.rmtree(self.path("rows", "work"), ignore_errors=True)
        other = sqlite3.connect(self.path("rows", "results.db"), check_same_thread=False)
        other.execute("UPDATE trials SET state = 'waiting'")
        other.execute("DELETE FROM plans")
        other.commit()
        other.execute("BEGIN IMMEDIATE")
        threading.Timer(2, other.rollback).start()
        self.run_program(*command, status=0)
        self.assertEqual(other.execute("SELECT count(*) FROM trials WHERE state = 'done'").fetchone(), (2,))

    def test_a_database_that_is_damaged(self):
        command = self.bench()
        self.run_program(*command, status=0)
        file = self.path("rows", "results.db")
        whole = open(file, "rb").read()
        for damaged in (whole[:len(whole) // 2], whole[:100], b"", b"no database" * 100, whole[:2000] + bytes(2000) + whole[4000:]):
            for end in ("-wal", "-shm"):
                if os.path.exists(file + end):
                    os.remove(file + end)
            with open(file, "wb") as out:
                out.write(damaged)
            done = self.run_program("report", "rows")
            self.assertIn(done.returncode, (0, 2, 3), done.stderr)  # 0: what was damaged is not looked at
            if done.returncode:
                self.assertIn("results.db", done.stderr)

    @unittest.skipUnless(NIGHTLY, "DISMANTLE_TESTS=nightly")
    def test_ten_thousand_parts(self):
        for i in range(10000):
            x, y, z = i % 22, i // 22 % 22, i // 484
            self.write(f"many/p{i}.obj", box((x, y, z), (x + 0.9, y + 0.9, z + 0.9)))
        begin = time.monotonic()
        done = self.run_program("plan", "many", "-o", "out", "-q", "--timeout", "60", "--format", "json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertLess(time.monotonic() - begin, 62)
        json.loads(self.read("out", "plan.json"))

    @unittest.skipUnless(NIGHTLY, "DISMANTLE_TESTS=nightly")
    def test_a_part_of_five_million_triangles(self):
        n = 1117  # a box with 4 n^2 triangles on its sides: just below the limit
        with open(self.path("in", "fine.stl"), "wb") as out:
            faces = []
            for axis in range(3):
                for end in (0, 1):
                    faces.append((axis, end))
            count = 2 * 6 * (n // 2) ** 2 * 1
            out.write(bytes(80) + struct.pack("<I", count))
            m = n // 2
            for axis, end in faces:
                u, v = (axis + 1) % 3, (axis + 2) % 3
                for i in range(m):
                    for k in range(m):
                        corner = []
                        for di, dk in ((0, 0), (1, 0), (1, 1), (0, 1)):
                            p = [0.0, 0.0, 0.0]
                            p[axis], p[u], p[v] = 3.0 + end, (i + di) / m, (k + dk) / m
                            p[0] += 0 if axis == 0 else 3.0
                            if axis != 0:
                                p[axis] -= 3.0
                            corner.append(p)
                        for t in ((0, 1, 2), (0, 2, 3)) if end else ((0, 2, 1), (0, 3, 2)):
                            out.write(bytes(12) + b"".join(struct.pack("<3f", *corner[j]) for j in t) + bytes(2))
        begin = time.monotonic()
        done = self.run_program("plan", "in", "-o", "out", "-q", "--timeout", "30", "--format", "json")
        self.assertIn(done.returncode, (0, 1, 2), done.stderr)
        self.assertLess(time.monotonic() - begin, 32)


if __name__ == "__main__":
    unittest.main()
