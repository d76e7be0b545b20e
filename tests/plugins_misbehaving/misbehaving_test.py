"""Plugins that misbehave in a run: the status, a message that names the plugin and what to do, and what is saved."""
import json
import os
import signal
import subprocess
import threading
import unittest

from program import HANGING, PROGRAM, CliTest

BAD = os.environ["BAD_FOLDER"]
PARTS = 4  # of the sample: lid, two boxes inside, box
ENV = {"DISMANTLE_PLUGIN_PATH": os.environ.get("DISMANTLE_PLUGIN_PATH", "") + ":" + os.path.join(BAD, "bad_planners")}


class WithBoxes(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "stacked_box", "-o", "in", "--set", "count=2", status=0)

    def plan(self, planner, *more, status=4, kind="--path-planner"):
        order = () if kind == "--sequence-planner" else ("--sequence-planner", "progressive")
        threads = () if "--threads" in more else ("--threads", "1")
        path = ("--path-planner", "bad.honest") if kind == "--sequence-planner" else ()
        return self.run_program("plan", "in", "-o", "out", kind, planner, "--simulator", "fcl", "--format", "json", *threads, *order, *path, *more,
                                status=status, env=ENV)

    def saved(self):
        return json.loads(self.read("out", "plan.json"))

    def outcomes(self):
        return {u["outcome"] for u in self.saved()["unsolved"]}

    def assert_one_line(self, done):
        lines = done.stdout.splitlines()
        self.assertEqual(len(lines), 1, done.stdout)
        return json.loads(lines[0])


class Values(WithBoxes):
    """What can be caught is an outcome or an error, in the process of the run."""

    def test_the_honest_one_takes_it_apart(self):
        self.plan("bad.honest", status=0)

    def test_throwing_where_it_is_made(self):
        for planner, why in (("bad.factory", "no licence for today"), ("bad.factory_int", "no std::exception")):
            done = self.plan(planner)
            self.assertIn(planner, done.stderr)
            self.assertIn("libbad_planners.so", done.stderr)
            self.assertIn(why, done.stderr)

    def test_throwing_while_it_plans(self):
        for planner, why in (("bad.throws", "index 7 of 3"), ("bad.throws_int", "not a std::exception")):
            done = self.plan(planner)
            self.assertIn(f"path planner '{planner}' threw", done.stderr)
            self.assertIn(why, done.stderr)
            self.assertEqual(self.outcomes(), {"crashed"})

    def test_a_wrong_path_is_the_planners_fault(self):
        for planner, why in (("bad.not_finite", "is not finite"), ("bad.jump", "cuts"), ("bad.wrong_parts", "2 poses for 1 moving part")):
            done = self.plan(planner)
            self.assertIn(f"path planner '{planner}' reports as solved a path that was not verified", done.stderr)
            self.assertIn(why, done.stderr)
            self.assertIn("dismantle plugins check", done.stderr)
            self.assertEqual(self.outcomes(), {"crashed"})
            self.assertEqual(self.saved()["disassembly"], [])

    def test_sequence_planners(self):
        for planner, why in (("bad.sequence_throws", "out of ideas"), ("bad.sequence_claims", "reports success with"), ("bad.sequence_twice", "")):
            done = self.plan(planner, kind="--sequence-planner")
            self.assertIn(why, done.stderr)
            self.assertIn("sequence planner", done.stderr)
            self.assertEqual(len(self.saved()["disassembly"]), 1, planner)
            self.assertEqual(self.outcomes(), {"crashed"})
            self.run_program("verify", "out/plan.json", "-q", status=1)


class Crashes(WithBoxes):
    """What ends the process: which plugin it was, what to do, and the steps until then."""

    def check_message(self, text, name):
        self.assertIn("plugin bad.planners 1.0.0", text)
        self.assertIn("https://example.org/bad", text)
        self.assertIn(name, text)
        self.assertIn("dismantle plugins check", text)

    def test_in_the_process_of_the_run(self):
        for planner, name in (("bad.segfault", "SIGSEGV"), ("bad.abort", "SIGABRT")):
            done = self.plan(planner)
            result = self.assert_one_line(done)
            for text in (done.stderr, result["message"]):
                self.check_message(text, name)
                self.assertIn("--isolate", text)
                self.assertIn(planner, text)
            self.assertEqual(result["plan"], "out/plan.json")
            self.assertEqual(len(self.saved()["disassembly"]), 1)

    def test_a_stack_that_overflows_on_any_thread(self):
        for threads in ("1", "3"):
            done = self.plan("bad.overflow", "--threads", threads)
            self.check_message(done.stderr, "SIGSEGV")
            self.assertEqual(len(self.saved()["disassembly"]), 1)

    def test_isolated(self):
        for planner, name in (("bad.segfault", "SIGSEGV"), ("bad.abort", "SIGABRT")):
            done = self.plan(planner, "--isolate")
            result = self.assert_one_line(done)
            self.check_message(result["message"], name)
            self.assertEqual((result["status"], result["steps"], result["left"]), ("error", 1, PARTS - 1))
            self.assertEqual(self.outcomes(), {"crashed"})
            self.assertIn(name, self.saved()["unsolved"][0]["message"])
            for file in ("plan.glb", "precedence.dot", "resolved.yaml"):
                self.assertTrue(os.path.exists(self.path("out", file)), file)
            self.run_program("verify", "out/plan.json", "-q", status=1)

    def test_sequence_planner_isolated(self):
        done = self.plan("bad.sequence_segfault", "--isolate", kind="--sequence-planner")
        self.check_message(done.stderr, "SIGSEGV")
        self.assertEqual(len(self.saved()["disassembly"]), 1)

    def test_importer(self):
        self.write("x.crash", "boom")
        for more in ((), ("--isolate",)):
            done = self.run_program("plan", "x.crash", "-o", "out", *more, status=4, env=ENV)
            self.check_message(done.stderr, "SIGABRT")
            self.assertFalse(os.path.exists(self.path("out", "plan.json")))

    def test_while_it_is_loaded(self):
        env = {"DISMANTLE_PLUGIN_PATH": ENV["DISMANTLE_PLUGIN_PATH"] + ":" + os.path.join(BAD, "bad_loading")}
        for command in (("plan", "in", "-o", "out"), ("plan", "in", "-o", "out", "--isolate"), ("plugins", "list"), ("check", "in")):
            done = self.run_program(*command, status=4, env=env)
            self.assertIn("SIGSEGV", done.stderr)
            self.assertIn("libbad_loading.so", done.stderr)


class Isolated(WithBoxes):
    def test_a_good_run_is_the_same(self):
        plans = []
        for more in ((), ("--isolate",)):
            result = self.assert_one_line(self.plan("bad.honest", *more, status=0))
            self.assertEqual(result["status"], "complete")
            plan = self.saved()
            for step in plan["disassembly"] + plan["assembly_steps"]:
                step.pop("seconds", None)
            plans.append(plan)
        self.assertEqual(plans[0], plans[1])
        self.assertEqual(self.plan("bad.throws", "--isolate").returncode, 4)
        self.run_program("plan", "nowhere", "--isolate", status=3)
        self.run_program("plan", "in", "--memory", "100", status=2)

    def test_memory_is_limited(self):
        if os.environ.get("ASAN_OPTIONS") or os.environ.get("TSAN_OPTIONS"):
            self.skipTest("sanitizers reserve all addresses")
        done = self.plan("bad.memory", "--isolate", "--memory", "1500")
        self.assertIn("bad_alloc", done.stderr)
        self.assertEqual(self.outcomes(), {"crashed"})
        self.assertEqual(len(self.saved()["disassembly"]), 1)

    def test_a_planner_that_hangs_is_stopped(self):
        done = self.plan("bad.hang", "--isolate", "--timeout", "1", "--set", "run.grace=0.3")
        self.assertIn("run.grace", self.assert_one_line(done)["message"])
        self.assertEqual(len(self.saved()["disassembly"]), 1)

    def interrupt(self, grace, times):
        process = subprocess.Popen([PROGRAM, "plan", "in", "-o", "out", "--path-planner", "bad.hang", "--simulator", "fcl", "--sequence-planner", "progressive",
                                    "--threads", "1", "--isolate", "--set", f"run.grace={grace}", "--format", "json"], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **ENV})
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        cues = ["bad.hang hangs", "stopping"][:times]  # each signal after the other was seen
        watchdog = threading.Timer(HANGING, process.kill)
        watchdog.start()
        try:
            for line in process.stderr:
                if cues and line.startswith(cues[0]):
                    process.send_signal(signal.SIGINT)
                    cues.pop(0)
            return process.wait(), process.stdout.read()
        finally:
            watchdog.cancel()

    def test_ctrl_c_reaches_the_child(self):
        status, output = self.interrupt(0.3, 1)
        self.assertEqual(status, 4)
        self.assertIn("run.grace", json.loads(output.splitlines()[-1])["message"])
        self.assertEqual(len(self.saved()["disassembly"]), 1)

    def test_a_second_ctrl_c_ends_now(self):
        status, output = self.interrupt(0, 2)
        self.assertEqual(status, 130)


class Checking(WithBoxes):
    def test_the_contract_tests_find_them(self):
        for planner in ("bad.throws", "bad.jump"):
            self.run_program("plugins", "check", planner, status=1, env=ENV)

    def test_a_crash_breaks_the_law_that_was_tried(self):
        done = self.run_program("plugins", "check", "bad.segfault", status=1, env=ENV)
        self.assertIn("SIGSEGV", done.stderr)
        self.assertIn("/bad_segfault", done.stderr)

    def test_so_does_one_that_hangs(self):
        tests = os.path.join(os.path.dirname(PROGRAM), "dismantle_contract_tests")
        done = self.run_program("bad.hang", "--time-limit", "1", "--gtest_filter=*WhatIsSolvedWasAccepted*", status=1, env=ENV, program=tests)
        self.assertIn("did not come back", done.stderr)
        self.assertIn("WhatIsSolvedWasAccepted/bad_hang", done.stderr)


if __name__ == "__main__":
    unittest.main()
