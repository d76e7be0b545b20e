"""How deep each part lies."""
import csv
import io
import json
import signal
import subprocess
import threading

from program import HANGING, PROGRAM, CliTest


class Access(CliTest):
    QUICK = ("--timeout", "0", "--set", "run.path_timeout=0", "--set", "run.force=off", "--set", "immobility.provers=[]",
             "--set", "objective=[directions, {type: identical_parts, weight: 0.3}]")

    def setUp(self):
        super().setUp()
        self.run_program("sample", "machine", "-o", "machine", "--set", "parts=8", status=0)

    def depths(self, *arguments):
        done = self.run_program("access", "machine", *self.QUICK, *arguments, "--format", "json", "-q", status=0)
        return self.result_of(done)

    def test_the_depth_of_a_part_is_that_of_the_plan_to_it(self):
        result = self.depths()
        self.assertEqual(result["status"], "complete")
        self.assertEqual(len(result["parts"]), 8)
        self.assertGreater(max(part["depth"] for part in result["parts"]), 1)
        for part in result["parts"]:
            self.assertTrue(part["optimal"])
            self.assertEqual(part["least_depth"], part["depth"])
            self.assertEqual(len(part["steps"]), part["depth"])
            self.run_program("plan", "machine", "--target", part["part"], "-o", "out", *self.QUICK, "-q", status=0)
            plan = json.loads(self.read("out", "plan.json"))
            self.assertEqual(len(plan["disassembly"]), part["depth"], part["part"])
            self.assertAlmostEqual(plan["objective"]["cost"] - 1000 * part["depth"], part["cost"], msg=part["part"])

    def test_parts_are_named_by_patterns(self):
        every = {part["part"]: part for part in self.depths()["parts"]}
        some = self.depths("--part", "washer*", "--part", "base")["parts"]
        self.assertEqual({p["part"] for p in some}, {n for n in every if n.startswith("washer") or n == "base"})
        for part in some:
            self.assertEqual(part, every[part["part"]])
        self.assert_fails(3, "--part: no part is named 'nix'", "access", "machine", "--part", "nix")

    def test_text_and_csv_say_the_same(self):
        every = self.depths()["parts"]
        done = self.run_program("access", "machine", *self.QUICK, "--format", "csv", "-q", status=0)
        rows = list(csv.DictReader(io.StringIO(done.stdout)))
        self.assertEqual([(r["part"], int(r["depth"]), r["optimal"]) for r in rows], [(p["part"], p["depth"], "yes") for p in every])
        for row, part in zip(rows, every):
            first = [" + ".join(step["parts"]) for step in part["steps"][:-1]]
            self.assertEqual(row["before"], "; ".join(first))
        text = self.run_program("access", "machine", *self.QUICK, status=0).stdout
        self.assertEqual(len(text.splitlines()), 10)
        self.assertIn("8 parts; the fewest steps are proved for 8", text)

    def test_classes_of_fasteners_and_tools(self):
        self.run_program("sample", "bolt_and_nut", "-o", "bolt", status=0)
        for part in self.classes("bolt").values():
            self.assertEqual((part["fasteners"], part["tools"]), ("reusable", "basic"))
            self.assertEqual([(s["fasteners"], s["tools"]) for s in part["steps"]], [("reusable", "basic")])
        self.run_program("sample", "peg_in_hole", "-o", "peg", status=0)
        for part in self.classes("peg").values():
            self.assertEqual((part["fasteners"], part["tools"]), ("none", "none"))

    def test_what_leaves_by_force_is_not_removable(self):
        self.run_program("sample", "snap_fit", "-o", "snap", status=0)
        done = self.run_program("access", "snap", "--format", "json", "-q", status=1)
        for part in self.result_of(done)["parts"]:
            self.assertEqual((part["fasteners"], part["tools"]), ("neither", "not removable"))

    def classes(self, name):
        done = self.run_program("access", name, "--format", "json", "-q")
        return {part["part"]: part for part in self.result_of(done)["parts"]}

    def test_what_is_kept_together_is_one(self):
        parts = self.depths("--set", "constraints.together=[[washer_1_1, shaft_1]]")["parts"]
        both = [p for p in parts if "together" in p]
        self.assertEqual([sorted(p["together"]) for p in both], [["shaft_1", "washer_1_1"]])
        self.assertEqual(len(parts), 7)

    def test_parts_that_cannot_leave(self):
        done = self.run_program("access", "machine", *self.QUICK, "--set", "constraints.base=[base, shaft_1]",
                                "--format", "json", "-q", status=1)
        result = self.result_of(done)
        self.assertEqual(result["status"], "partial")
        self.assertEqual({p["part"] for p in result["parts"] if p["depth"] is None}, {"base", "shaft_1"})

    def test_a_target_in_the_configuration_is_refused(self):
        self.assert_fails(2, "name one with --part instead of constraints.target", "access", "machine", "--set", "constraints.target=base")

    def test_ctrl_c_prints_what_is_known(self):
        self.run_program("sample", "machine", "-o", "large", "--set", "parts=160", status=0)
        process = subprocess.Popen([PROGRAM, "access", "large", "--format", "json"], cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        watchdog = threading.Timer(HANGING, process.kill)
        watchdog.start()
        try:
            for line in process.stderr:
                if line.startswith("parts out"):
                    process.send_signal(signal.SIGINT)
                    break
            output, _ = process.communicate()
        finally:
            watchdog.cancel()
        self.assertEqual(process.returncode, 130)
        result = json.loads(output.splitlines()[-1])
        self.assertEqual(result["status"], "interrupted")
        self.assertEqual(len(result["parts"]), 160)
