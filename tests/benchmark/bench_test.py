"""Laws of `dismantle bench`: every trial is a row, once, whatever the planners and the user do."""
import glob
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import time
import unittest

from benching import BenchTest, PROGRAM, without_times


class Isolation(BenchTest):
    def test_planners_that_misbehave_are_rows_and_nothing_else(self):
        names = ("none", "abort", "memory", "scribble", "lie")
        self.suite(self.evil(*names), limits="timeout: 60, wall: 600, memory: 1024")
        result = self.bench("--jobs", "2")
        self.assertEqual((result["done"], result["solved"]), (len(names), 0))
        self.assert_each_once(len(names))
        rows = {r["planner"]: r for r in self.rows()}
        outcomes = {name: row["outcome"] for name, row in rows.items()}
        # The lie is refused by the run's own check already.
        self.assertEqual(outcomes, {"none": "exhausted", "abort": "crash", "memory": "out_of_memory", "scribble": "crash",
                                    "lie": outcomes["lie"]})
        self.assertNotEqual(outcomes["lie"], "solved")
        self.assertEqual(rows["abort"]["signal"], signal.SIGABRT)
        self.assertIn("evil.abort says goodbye", rows["abort"]["last_words"])
        self.assertIn(rows["scribble"]["signal"], (signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT))
        self.assertIn("limits.memory", rows["memory"]["last_words"])
        self.assertEqual(os.listdir(self.path("out", "work")), [])

    def test_planners_that_do_not_end(self):
        # One limit that ends the trial, the other far away: how fast the machine is does not matter.
        self.suite(self.evil("spin"), limits="timeout: 0, wall: 600, cpu: 2")
        self.bench()
        self.assertEqual([r["outcome"] for r in self.rows()], ["cpu_limit"])
        self.suite(self.evil("sleep"), limits="timeout: 0, wall: 2, cpu: 600", name="sleep.yaml")
        self.bench(suite="sleep.yaml", out="asleep")
        self.assertEqual([r["outcome"] for r in self.rows(database="asleep/results.db")], ["wall_limit"])

    def test_what_a_trial_leaves_behind_ends_with_it(self):
        self.suite(self.evil("daemon"))
        self.bench()
        row, = self.rows()
        left = re.search(r"evil.daemon leaves (\d+) behind", row["last_words"])
        self.assertIsNotNone(left, row["last_words"])
        status = pathlib.Path("/proc", left.group(1), "status")
        # It is gone, or dead and not yet waited for by its new parent.
        self.assertTrue(not status.exists() or re.search(r"^State:\s+[ZX]", status.read_text(), re.M))

    def test_the_verifier_has_the_last_word(self):
        """A plan that was good for the planner, and is not for the verifier."""
        self.suite("  t_rrt: {set: {simulator.type: fcl, path_planner.type: t_rrt, sequence_planner.type: progressive}}\n",
                   more="seeds: 1\nverify: {max_penetration: 0.1}\n")
        self.bench()
        row, = self.rows()
        self.assertEqual((row["outcome"], row["verified"], row["solved"]), ("solved", 1, 1), row["verification"])
        self.call("sample", "l_slot", "-o", "mesh")
        self.call("plan", "mesh", "-o", "trial", "--set", "verify.max_penetration=0.1", "--set", "simulator.type=fcl",
                  "--set", "path_planner.type=t_rrt", "--set", "sequence_planner.type=progressive")
        for depth, valid in ((0.1, True), (1e-9, False)):
            request = {"config": "", "input": self.path("mesh"), "sample": "", "sample_values": {}, "rotate": False, "seed": 1, "part": "",
                       "inputs": self.folder, "input_name": "", "max_penetration": depth, "plugins": [], "search_nodes": 0}
            self.write("trial/request.json", json.dumps(request))
            self.call("bench-trial", "trial", "--verify")
            with open(self.path("trial/verification.json"), encoding="utf-8") as file:
                verification = json.load(file)
            self.assertEqual(verification["valid"], valid, verification)
        self.assertIn("step 1", verification["problems"][0])

    def test_constraints_of_the_suite(self):
        planner = "  t_rrt: {set: {simulator.type: fcl, path_planner.type: t_rrt, sequence_planner.type: progressive}}\n"
        self.suite(planner, assemblies="  - {sample: stacked_box, set: {count: 2}}\n  - {sample: l_slot}\n",
                   more="seeds: 1\nconstraints: {ignore: [lid, plate_2]}\n")
        self.bench()
        box, slot = self.rows()
        self.assertEqual((box["parts"], box["solved"]), (2, 1), dict(box))
        self.assertEqual(slot["outcome"], "bad_configuration")
        self.assertIn("has no part 'lid'", slot["last_words"])

    def test_input_that_cannot_be_read_is_a_row(self):
        self.write("broken/a.obj", "no mesh\n")
        self.write("broken/b.obj", "v 0 0 0\n")
        self.suite(self.evil("none"), assemblies="  - {path: broken}\n  - {sample: l_slot, part: nobody}\n")
        self.bench()
        first, second = self.rows()
        self.assertEqual(first["outcome"], "bad_input")
        self.assertIn("a.obj", first["last_words"])
        self.assertNotEqual(second["outcome"], "solved")
        self.assertIn("nobody", second["last_words"])


class Resuming(BenchTest):
    ASSEMBLIES = "  - {sample: l_slot}\n  - {sample: zigzag}\n"

    def processes_here(self):
        """Ids of processes that have this test's folder on their command line."""
        found = []
        for file in glob.glob("/proc/[0-9]*/cmdline"):
            try:
                with open(file, "rb") as opened:
                    if self.folder.encode() in opened.read():
                        found.append(file)
            except OSError:
                pass  # ended in the meantime
        return found

    def test_kill_at_any_moment_costs_nothing_but_the_running_trials(self):
        self.suite(self.evil("none", "lie"), assemblies=self.ASSEMBLIES, more="seeds: 1..6\n")
        def done():
            if not os.path.exists(self.path("out/results.db")) or not self.rows("SELECT name FROM sqlite_master WHERE name = 'trials'"):
                return 0
            return len(self.rows("SELECT id FROM trials WHERE state = 'done'"))

        kept = 0
        for more in (0, 1, 2, 0, 3):  # it is killed when so many more trials are done, wherever it is then
            process = self.start("bench", "suite.yaml", "-o", self.path("out"), "--jobs", "2")
            while done() < kept + more or not self.processes_here():
                self.assertIsNone(process.poll(), "it ended by itself")
                time.sleep(0.01)
            process.kill()
            process.communicate()
            while self.processes_here():  # its trials die with it
                time.sleep(0.01)
            self.assertGreaterEqual(done(), kept + more)
            kept = done()
        self.assertEqual(self.bench("--jobs", "2", out=self.path("out"))["ran"], 24 - kept)
        self.assert_each_once(24)
        self.assertEqual(self.bench(out=self.path("out"))["ran"], 0)
        self.assertEqual(os.listdir(self.path("out", "work")), [])

    def test_two_processes_share_a_suite(self):
        self.suite(self.evil("none"), assemblies=self.ASSEMBLIES, more="seeds: 1..5\n")
        others = [self.start("bench", "suite.yaml", "-o", "out") for _ in range(2)]
        ran = 0
        for process in others:
            out, err = process.communicate()
            self.assertEqual(process.returncode, 0, err)
            ran += int(out.split("; ")[1].split()[0])
        self.assertEqual(ran, 10)
        self.assert_each_once(10)

    def test_interrupt_puts_running_trials_back(self):
        self.suite(self.evil("sleep"), more="seeds: 1..2\n")
        process = self.start("bench", "suite.yaml", "-o", "out", "--jobs", "2")
        while len(self.processes_here()) < 2:  # `bench` itself names the folder in no argument, its trials do
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate()
        self.assertEqual(process.returncode, 130, err)
        self.assertEqual([r["state"] for r in self.rows()], ["waiting", "waiting"])
        self.assertEqual(self.processes_here(), [])

    def test_rows_of_another_configuration_are_not_mixed(self):
        self.suite(self.evil("none"))
        self.bench()
        self.suite("  none: {config: evil.yaml, set: {path_planner.type: evil.lie}}\n")
        done = self.call("bench", "suite.yaml", "-o", "out", status=2)
        self.assertIn("planner 'none' on 'l_slot' (seed 1)", done.stderr)
        self.suite(self.evil("none"), limits="timeout: 60, wall: 301, memory: 2048")
        self.assertIn("limits.wall differs", self.call("bench", "suite.yaml", "-o", "out", status=2).stderr)

    def changed_planner(self):
        """The suite `none`, `lie`, done; then the planner `lie` is another one."""
        self.suite(self.evil("none", "lie"), assemblies=self.ASSEMBLIES)
        self.bench()
        before = {(r["assembly"], r["planner"]): r for r in self.rows()}
        self.suite(self.evil("none") + "  lie: {config: evil.yaml, set: {path_planner.type: evil.abort}}\n", assemblies=self.ASSEMBLIES)
        return before

    def test_replace_runs_what_has_changed_and_keeps_the_rest(self):
        before = self.changed_planner()
        self.assertIn("path_planner.type: evil.lie -> evil.abort", self.call("bench", "suite.yaml", "-o", "out", status=2).stderr)
        result = self.bench("--replace")
        self.assertEqual(result["ran"], 2)
        self.assertEqual(len(result["replaced"]), 1)
        self.assertIn("planner 'lie': 2 rows are run again: its configuration", result["replaced"][0])
        self.assert_each_once(4)
        for row in self.rows():
            if row["planner"] == "lie":
                self.assertEqual(row["outcome"], "crash")
            else:
                self.assertEqual(dict(row), dict(before[row["assembly"], row["planner"]]))
        self.assertEqual(self.rows("SELECT * FROM plans WHERE trial IN (SELECT id FROM trials WHERE outcome = 'crash')"), [])
        again = self.bench("--replace")
        self.assertEqual((again["ran"], again["replaced"]), (0, []))

    def test_only_runs_the_planners_that_it_names(self):
        self.changed_planner()
        self.assertEqual(self.bench("--only", "none")["ran"], 0)  # the other one has changed, and is left alone
        self.assertEqual(self.bench("--only", "lie", "--replace")["ran"], 2)
        self.suite(self.evil("none", "lie"), assemblies=self.ASSEMBLIES, name="new.yaml")
        self.assertEqual(self.bench("--only", "none", suite="new.yaml", out="new")["ran"], 2)
        self.assertEqual({r["planner"] for r in self.rows(database="new/results.db")}, {"none"})
        self.assertIn("has no planner 'nobody'; it has: none, lie",
                      self.call("bench", "new.yaml", "-o", "new", "--only", "nobody", status=2).stderr)

    def test_more_seeds_of_a_planner_are_more_rows_of_it(self):
        self.suite(self.evil("none", "lie"), assemblies=self.ASSEMBLIES)
        self.bench()
        before = [dict(row) for row in self.rows()]
        self.suite(self.evil("none") + "  lie: {config: evil.yaml, set: {path_planner.type: evil.lie}, seeds: 1..3}\n", assemblies=self.ASSEMBLIES)
        self.assertEqual(self.bench()["ran"], 4)
        self.assert_each_once(8)
        self.assertEqual([dict(row) for row in self.rows()][:4], before)
        self.assertEqual({r["planner"] for r in self.rows("SELECT * FROM trials WHERE seed > 1")}, {"lie"})
        self.assertIn("seeds,1 of none; 1..3 of lie", self.call("report", "out", "--table", "setup", "--format", "csv").stdout)

    def test_only_does_not_make_planners_that_cannot_be_compared(self):
        self.suite(self.evil("none", "lie"))
        self.bench()
        self.suite(self.evil("none", "lie"), limits="timeout: 60, wall: 301, memory: 2048")
        done = self.call("bench", "suite.yaml", "-o", "out", "--only", "none", "--replace", status=2)
        self.assertIn("limits.wall differs from that of the rows of planner 'lie'", done.stderr)
        self.assertEqual({r["limit_wall"] for r in self.rows()}, {300})  # nothing was changed
        self.assertEqual(self.bench("--replace")["ran"], 2)

    def test_another_input_is_another_row(self):
        self.call("sample", "l_slot", "-o", "mesh")
        part = sorted(os.listdir(self.path("mesh")))[0]
        self.suite(self.evil("none"), assemblies="  - {path: mesh}\n", more="seeds: 1\nvariants: {plain: {}, turned: {rotate: random}}\n")
        self.bench()
        before = [r["input_sha256"] for r in self.rows()]
        self.write(f"mesh/{part}", self.read("mesh", part).replace("v ", "# changed\nv ", 1))
        self.assertEqual(self.bench("--replace")["ran"], 2)
        self.write(f"mesh/{part}", re.sub(r"^v (\S+)", lambda m: f"v {float(m[1]) * 1.001}", self.read("mesh", part), flags=re.M))
        self.assertIn("the input of the assembly differs", self.call("bench", "suite.yaml", "-o", "out", status=2).stderr)
        self.assertEqual(self.bench("--replace")["ran"], 2)
        for old, row in zip(before, self.rows()):
            self.assertNotEqual(old, row["input_sha256"])


class Repeating(BenchTest):
    PLANNERS = "  t_rrt: {set: {simulator.type: fcl, path_planner.type: t_rrt, sequence_planner.type: progressive}}\n"

    def test_a_row_again_gives_the_same_plan(self):
        self.suite(self.PLANNERS, assemblies="  - {sample: l_slot}\n  - {sample: stacked_box, name: stacked_box, set: {count: 1}}\n",
                   more="seeds: 3\nvariants: {plain: {}, turned: {rotate: random}}\n",
                   limits="path_timeout: 0, timeout: 0, wall: 300")
        self.bench("--jobs", "2")
        rows = self.rows()
        self.assertEqual([r["solved"] for r in rows], [1, 1, 1, 1], [dict(r) for r in rows])
        for number in (1, 2, 3, 4):
            said = self.call("report", "out", "--row", str(number), "-o", f"row{number}").stdout
            command = shlex.split(said.splitlines()[-1])
            self.assertEqual(command[0], "dismantle")
            again = subprocess.run([PROGRAM, *command[1:], "-o", f"again{number}", "-q"], cwd=self.folder, capture_output=True)
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertEqual(without_times(self.read(f"again{number}/plan.json")), without_times(self.read(f"row{number}/plan.json")))
            self.call("verify", f"row{number}/plan.json")


class PaperLayout(BenchTest):
    def test_offsets_of_multi_assembly_folders(self):
        """A peg in a block whose files stand around the origin; translation.json says where they belong."""
        self.call("sample", "stacked_box", "-o", "whole", "--set", "count=1")
        offsets = []
        names = sorted(os.listdir(self.path("whole")))
        for i, name in enumerate(names):
            moved = []
            for line in self.read("whole", name).splitlines():
                if line.startswith("v "):
                    x, y, z = map(float, line.split()[1:])
                    line = f"v {x - 8 * i} {y + 16} {z - 32}"
                moved.append(line)
            self.write(f"data/multi_assembly/00007/{i}.obj", "\n".join(moved) + "\n")
            self.write(f"data/joint_assembly/00001/{i}.obj", self.read("whole", name)) if i < 2 else None
            offsets.append(f'"{i}": [{8 * i}, -16, 32]')
        self.write("data/multi_assembly/00007/translation.json", "{" + ", ".join(offsets) + "}")
        self.suite("  t_rrt: {set: {simulator.type: fcl, path_planner.type: t_rrt, sequence_planner.type: progressive}}\n",
                   assemblies="  - {glob: 'data/joint_assembly/*/', category: two_part}\n"
                              "  - {glob: 'data/multi_assembly/*/', category: multi_part}\n")
        self.bench("--jobs", "2")
        rows = {r["category"]: r for r in self.rows()}
        self.assertEqual((rows["multi_part"]["parts"], rows["multi_part"]["solved"]), (len(names), 1), dict(rows["multi_part"]))
        self.assertEqual(rows["two_part"]["parts"], 2)


if __name__ == "__main__":
    unittest.main()
