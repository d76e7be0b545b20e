"""Whole runs: what is written, what is said, and what an interruption leaves."""
import json
import math
import os
import re
import signal
import subprocess
import threading

from program import HANGING, PROGRAM, VIEWER, CliTest, box

QUICK = ("--path-timeout", "0", "--timeout", "0")


class Plan(CliTest):
    def make(self, name, *set_):
        arguments = [a for item in set_ for a in ("--set", item)]
        self.run_program("sample", name, "-o", name, *arguments, status=0)
        return name

    def test_a_plan_is_complete_written_and_verified(self):
        self.make("machine", "parts=4")
        done = self.run_program("plan", "machine", *QUICK, "--format", "json", status=0)
        result = self.result_of(done)
        self.assertEqual(result["status"], "complete")
        self.assertEqual([result[k] for k in ("parts", "steps", "removed", "left", "excluded", "unsolved")], [4, 3, 3, 1, 0, 0])
        self.assertEqual(result["plan"], "machine.plan/plan.json")
        self.assertEqual(sorted(os.listdir(self.path("machine.plan"))), ["index.html"] * VIEWER + ["plan.glb", "plan.json", "precedence.dot", "resolved.yaml"])
        plan = json.loads(self.read(result["plan"]))
        self.assertEqual(plan["status"], "complete")
        self.assertEqual(len(plan["disassembly"]), 3)
        with open(self.path("machine.plan", "plan.glb"), "rb") as file:
            self.assertEqual(file.read(4), b"glTF")

        verified = self.run_program("verify", result["plan"], "--format", "json", status=0)
        self.assertEqual(self.result_of(verified)["status"], "complete")
        self.assertIn("every part came out", self.run_program("explain", result["plan"], status=0).stdout)

    def test_same_seed_same_bytes_and_the_resolved_file_repeats_the_run(self):
        self.make("machine", "parts=4")
        self.run_program("plan", "machine", *QUICK, "-o", "a", "--threads", "1", "--seed", "7", "-q", status=0)
        self.run_program("plan", "machine", *QUICK, "-o", "b", "--threads", "2", "--seed", "7", "-q", status=0)
        self.run_program("plan", "machine", "-c", "a/resolved.yaml", "-o", "c", "-q", status=0)
        plans = [re.sub(r'"seconds": [^,]*', "", self.read(name, "plan.json")) for name in "abc"]
        self.assertEqual(plans[0], plans[1])
        self.assertEqual(plans[0], plans[2])

    def test_text_output_names_parts_in_order_and_quiet_is_silent(self):
        self.make("peg_in_hole")
        done = self.run_program("plan", "peg_in_hole", *QUICK, "-o", "out", status=0)
        for word in ("2 parts, 1 step, complete", "every step is verified", "stays:", "plan.glb"):
            self.assertIn(word, done.stdout)
        self.assertNotIn("penetration <=", done.stdout)
        verbose = self.run_program("plan", "peg_in_hole", *QUICK, "-o", "out", "-v", status=0)
        self.assertRegex(verbose.stdout, r"(?m)^ +1  \w+ +[\d.]+ s  penetration <= ")
        done = self.run_program("plan", "peg_in_hole", *QUICK, "-o", "out", "-q", status=0)
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_a_saved_plan_goes_on_from_any_step(self):
        self.make("machine", "parts=4")
        self.run_program("plan", "machine", *QUICK, "-o", "whole", "-q", status=0)
        whole = json.loads(self.read("whole", "plan.json"))
        for after in ("0", "2", None):
            keep = ("--after", after) if after else ()
            self.run_program("plan", "machine", *QUICK, "-o", "more", "--resume", "whole/plan.json", *keep, "-q", status=0)
            more = json.loads(self.read("more", "plan.json"))
            self.assertEqual((more["status"], more["remaining"]), (whole["status"], whole["remaining"]))
            for a, b in zip(more["disassembly"], whole["disassembly"], strict=True):
                for key in ("step", "separates", "planner", "contacts", "after"):
                    self.assertEqual(a[key], b[key])
            self.run_program("verify", "more/plan.json", "-q", status=0)
        for arguments, message in (
            (("-o", "whole", "--resume", "whole/plan.json"), "would be written over"),
            (("-o", "more", "--resume", "whole/plan.json", "--after", "9"), "has 3 steps, 9 cannot be kept"),
        ):
            self.assertIn(message, self.run_program("plan", "machine", *QUICK, *arguments, status=2).stderr)
        self.assertIn("--resume", self.run_program("plan", "machine", "--after", "1", status=2).stderr)
        self.make("peg_in_hole")
        other = self.run_program("plan", "peg_in_hole", *QUICK, "-o", "more", "--resume", "whole/plan.json", status=3)
        self.assertIn("made for other files", other.stderr)

    def test_one_part(self):
        self.make("peg_in_hole")
        name = json.loads(self.result("peg_in_hole"))["disassembly"][0]["moves"][0]["part"]
        done = self.run_program("plan", "peg_in_hole", *QUICK, "-o", "one", "--part", name, "--format", "json", status=0)
        self.assertEqual(self.result_of(done)["steps"], 1)

    def result(self, name):
        self.run_program("plan", name, *QUICK, "-o", "all", "-q", status=0)
        return self.read("all", "plan.json")

    def test_what_cannot_come_out_gives_a_partial_plan(self):
        # A cube in a closed box, and a second one outside of it.
        self.write("in/cube.obj", box((-1, -1, -1), (1, 1, 1)))
        walls = box((-3, -3, -3), (3, 3, 3))
        inner = box((-2, -2, -2), (2, 2, 2)).splitlines()
        for line in inner:
            word = line.split()
            walls += line + "\n" if word[0] == "v" else "f " + " ".join(str(int(i) + 8) for i in reversed(word[1:])) + "\n"
        self.write("in/box.obj", walls)
        self.write("in/free.obj", box((3.2, -1, -1), (5, 1, 1)))
        done = self.run_program("plan", "in", "--path-timeout", "0", "--set", "run.path_steps=2000", "--set", "run.force=off",
                                "--format", "json", status=1)
        result = self.result_of(done)
        self.assertEqual((result["status"], result["removed"], result["left"]), ("partial", 1, 2))
        self.assertGreater(result["unsolved"], 0)
        verified = self.run_program("verify", result["plan"], "--format", "json", status=1)
        self.assertEqual(self.result_of(verified)["status"], "partial")
        self.assertIn("did not come out", self.run_program("explain", result["plan"], status=0).stdout)

    def test_an_interlock_is_solved_by_two_motions_at_once(self):
        self.make("interlock3")
        done = self.run_program("plan", "interlock3", *QUICK, "-o", "out", status=0)
        self.assertIn("step 1: block out, spindle moved part-way, 2 left", done.stderr)
        plan = json.loads(self.read("out", "plan.json"))
        self.assertEqual((plan["status"], plan["assembly_status"], plan["remaining"]), ("complete", "complete", ["frame"]))
        both, last = plan["disassembly"]
        self.assertEqual(sorted(move["part"] for move in both["moves"]), ["block", "spindle"])
        self.assertEqual((both["separates"], last["separates"], last["after"]), ([["block"]], [["spindle"]], [1]))
        turned = next(move["poses"] for move in both["moves"] if move["part"] == "spindle")
        left_at = turned[-1]
        halves = [min(1, abs(sum(a * b for a, b in zip(p[3:], q[3:])))) for p, q in zip(turned, turned[1:])]
        self.assertGreater(sum(2 * math.acos(c) for c in halves), math.radians(120), "the spindle has turned, and stays so")
        begins = last["moves"][0]["poses"][0]
        self.assertIn(left_at, (begins, begins[:3] + [-q for q in begins[3:]]))
        # On the way back the spindle is there, and waits while the block comes from the layout.
        back = plan["assembly_steps"][1]
        self.assertGreater(back["transfer"], 0)
        for move in back["moves"]:
            waits = all(pose == move["poses"][0] for pose in move["poses"][:back["transfer"] + 1])
            self.assertEqual(waits, move["part"] == "spindle")
        verified = self.run_program("verify", "out/plan.json", "--format", "json", status=0)
        self.assertEqual(self.result_of(verified)["status"], "complete")

    def test_a_tampered_plan_is_found_out(self):
        self.make("peg_in_hole")
        plan = json.loads(self.result("peg_in_hole"))
        poses = plan["disassembly"][0]["moves"][0]["poses"]
        poses[1:] = [[x + 1e3 * i for i in (0.7, 0.5, 0.3)] + [1, 0, 0, 0] for x in (0,)]
        self.write("bad.json", json.dumps(plan))
        done = self.run_program("verify", "bad.json", "--format", "json", status=1)
        result = self.result_of(done)
        self.assertEqual(result["status"], "invalid")
        self.assertEqual(result["problems"][0]["step"], 1)


class Interruption(CliTest):
    def interrupt(self, sign, at="step 1:", times=1):
        """Sends the signal when a line that starts so is reported; returns status and standard output."""
        self.run_program("sample", "machine", "-o", "machine", "--set", "parts=160", status=0)  # seconds of work
        process = subprocess.Popen([PROGRAM, "plan", "machine", *QUICK, "--threads", "1", "--format", "json"], cwd=self.folder, text=True,
                                   encoding="utf-8", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        watchdog = threading.Timer(HANGING, process.kill)
        watchdog.start()
        try:
            for line in process.stderr:
                if line.startswith(at):
                    for _ in range(times):
                        process.send_signal(sign)
                    break
            process.stderr.read()
            return process.wait(), process.stdout.read()
        finally:
            watchdog.cancel()

    def test_once_saves_what_is_done(self):
        for sign in (signal.SIGINT, signal.SIGTERM):
            status, output = self.interrupt(sign)
            self.assertEqual(status, 130)
            result = json.loads(output.splitlines()[-1])
            self.assertEqual(result["status"], "interrupted")
            self.assertGreaterEqual(result["steps"], 1)
            self.assertLess(result["steps"], 159)
            verified = self.run_program("verify", result["plan"], "--format", "json", status=1)
            self.assertEqual(self.result_of(verified)["status"], "partial")
            self.assertTrue(os.path.exists(self.path("machine.plan", "plan.glb")))

    def test_while_the_parts_are_prepared(self):
        status, output = self.interrupt(signal.SIGINT, at="reading")
        self.assertEqual(status, 130)
        self.assertEqual(json.loads(output.splitlines()[-1])["status"], "interrupted")

    def test_twice_ends_at_once_and_keeps_what_was_saved(self):
        status, _ = self.interrupt(signal.SIGINT, times=2)
        self.assertEqual(status, 130)
        self.run_program("verify", "machine.plan/plan.json", "-q", status=1)
