"""Runs that fail: plugins that hang or are refused, outputs of an earlier run, constraints that cannot hold."""
import json
import os
import signal
import subprocess
import threading
import unittest

from program import HANGING, PROGRAM, CliTest

EVIL = os.environ.get("EVIL_FOLDER", "")
OUTPUTS = ("plan.json", "plan.glb", "precedence.dot", "resolved.yaml", "index.html")


class WithBoxes(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "l_slot", "-o", "in", status=0)


@unittest.skipUnless(os.path.isdir(EVIL), "the planners that hang were not built")
class Hanging(WithBoxes):
    ENV = {"DISMANTLE_PLUGIN_PATH": os.environ.get("DISMANTLE_PLUGIN_PATH", "") + ":" + EVIL}

    def check(self, result, planner):
        self.assertEqual(result["status"], "error")
        self.assertIn("run.grace", result["message"])
        self.assertIn(planner, result["message"])
        plan = json.loads(self.read(result["plan"]))
        self.assertEqual(plan["status"], "partial")
        self.assertEqual({u["outcome"] for u in plan["unsolved"]}, {"crashed"})
        self.run_program("verify", result["plan"], "-q", status=1)
        self.assertIn("a plugin failed", self.run_program("explain", result["plan"], status=0).stdout)

    def test_after_the_time_of_the_run_the_process_ends(self):
        for planner in ("evil.spin", "evil.sleep"):
            done = self.run_program("plan", "in", "-o", "out", "--path-planner", planner, "--timeout", "1", "--set", "run.grace=0.5", "--format", "json",
                                    status=4, env=self.ENV)
            self.check(self.result_of(done), planner)

    def interrupt(self, times, grace):
        process = subprocess.Popen([PROGRAM, "plan", "in", "-o", "out", "--path-planner", "evil.sleep", "--set", f"run.grace={grace}", "--format", "json"],
                                   cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **self.ENV})
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        cues = ["evil.sleep begins", "stopping"][:times]  # signals of one kind that wait are one: each after the other was seen
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

    def test_after_ctrl_c_the_process_ends(self):
        status, output = self.interrupt(1, 0.5)
        self.assertEqual(status, 4)
        self.check(json.loads(output.splitlines()[-1]), "evil.sleep")

    def test_a_second_ctrl_c_ends_now(self):
        status, output = self.interrupt(2, 0)
        self.assertEqual((status, output), (130, ""))


class Outputs(WithBoxes):
    def old_results(self):
        self.run_program("plan", "in", "-o", "out", "-q", "--path-timeout", "0", status=0)
        self.write("out/notes.txt", "mine")
        self.assertIn("plan.json", os.listdir(self.path("out")))

    def assert_gone(self):
        self.assertEqual([name for name in os.listdir(self.path("out")) if name in OUTPUTS], [])
        self.assertEqual(self.read("out", "notes.txt"), "mine")

    def test_a_run_that_fails_leaves_no_older_plan(self):
        self.old_results()
        self.assert_fails(3, "nowhere", "plan", "nowhere", "-o", "out")
        self.assert_gone()
        self.old_results()
        self.assert_fails(3, "has no part", "plan", "in", "-o", "out", "--part", "nut")
        self.assert_gone()
        self.old_results()
        self.write("broken/a.obj", "v 0 0\n")
        self.run_program("plan", "broken", "-o", "out", status=3)
        self.assert_gone()

    def test_a_command_line_that_is_wrong_touches_nothing(self):
        self.old_results()
        self.assert_fails(2, "unknown key", "plan", "in", "-o", "out", "--set", "run.sed=1")
        self.assertIn("plan.json", os.listdir(self.path("out")))

    def test_the_input_itself_is_no_old_result(self):
        self.old_results()
        done = self.run_program("plan", "out/plan.glb", "-o", "out", "--format", "json", status=0)
        self.assertEqual(self.result_of(done)["parts"], 2)


class Refused(WithBoxes):
    def test_why_a_plugin_was_refused_is_said_where_its_planner_is_asked_for(self):
        self.write("more/libacme.so", "not a library")
        env = {"DISMANTLE_PLUGIN_PATH": os.environ.get("DISMANTLE_PLUGIN_PATH", "") + ":" + self.path("more")}
        done = self.run_program("plan", "in", "--path-planner", "acme.rrt", status=2, env=env)
        self.assertIn("unknown path_planner 'acme.rrt'", done.stderr)
        self.assertIn("libacme.so: is no ELF shared library", done.stderr)
        self.write("c.yaml", "schema: 1\nplugins: {search_paths: [more]}\nsequence_planner: {type: acme.order}\n")
        done = self.run_program("plan", "in", "-c", "c.yaml", status=2)
        self.assertIn("c.yaml:3:26: error: unknown sequence_planner 'acme.order'", done.stderr)
        self.assertIn("libacme.so: is no ELF shared library", done.stderr)


class Constraints(WithBoxes):
    def test_unknown_names_come_together_with_their_places(self):
        self.write("c.yaml", "schema: 1\nconstraints:\n  base: [housin]\n  before: [[slidr, housing]]\n  ignore: [zzzzzzzz]\n")
        done = self.assert_fails(2, "c.yaml:3:10: error: constraints.base: in has no part 'housin'; did you mean 'housing'?", "plan", "in", "-c", "c.yaml")
        self.assertIn("c.yaml:4:13: error: constraints.before: in has no part 'slidr'; did you mean 'slider'?", done.stderr)
        self.assertIn("c.yaml:5:12: error: constraints.ignore: in has no part 'zzzzzzzz'; its parts: 'housing', 'slider'", done.stderr)
        self.assertNotIn("preparing", done.stderr)

    def test_contradictions_are_refused(self):
        done = self.assert_fails(2, "'housing' before 'slider' before 'housing'", "plan", "in", "--set",
                                 "constraints.before=[[housing, slider], [slider, housing]]")
        self.assertNotIn("reading", done.stderr)

    def test_values_and_yaml(self):
        self.assert_fails(2, "verify.max_penetration must be in (0, 0.5]", "plan", "in", "--set", "verify.max_penetration=100")
        self.write("broken.yaml", "run: [1, 2\n")
        self.assertNotIn("schema", self.assert_fails(2, "invalid YAML", "plan", "in", "-c", "broken.yaml").stderr)
