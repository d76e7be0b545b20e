"""tools/make_results.py on small suites: the page has all planners and tables, and a second run gives the same page."""
import os
import re
import subprocess
import sys
import unittest

from benching import PROGRAM, BenchTest

SOURCE = os.environ["SOURCE_FOLDER"]


T_RRT = "{set: {simulator.type: fcl, path_planner.type: t_rrt, sequence_planner.type: progressive, immobility.provers: []}"
NONE = "{config: ../evil.yaml}"


class MakeResults(BenchTest):
    def make(self, *more, status=0):
        done = subprocess.run([sys.executable, "-B", os.path.join(SOURCE, "tools/make_results.py"), "--program", PROGRAM, "--suites", self.path("suites"),
                               "--work", self.path("work"), "--out", self.path("pages"), *more], capture_output=True, text=True)
        self.assertEqual(done.returncode, status, done.stderr)
        return self.read("pages", "README.md")

    def suites(self, more_seeds=""):
        for name, category in (("two_part", "two-part"), ("rotational", "puzzle"), ("multi_part", "sample")):
            self.suite(f"  t_rrt: {T_RRT}{more_seeds}}}\n  none: {NONE}\n", f"  - {{sample: l_slot, category: {category}}}\n",
                       name=f"suites/results_{name}.yaml")
        for name, assembly in (("translation", "two_part/keyhole_2step"), ("rotation", "rotational/key_in_lock")):
            self.suite(f"  paper: {T_RRT if name == 'rotation' else NONE[:-1]}}}\n  guided: {T_RRT}}}\n", f"  - {{sample: l_slot, name: {assembly}}}\n",
                       name=f"suites/results_paper_{name}.yaml")
        self.suite(f"  paper: {NONE}\n", "  - {path: $DISMANTLE_NOT_HERE/x, optional: true}\n", name="suites/results_paper_sequence.yaml")

    def test_the_page(self):
        self.suites()
        first = self.make("--only", "two_part")
        self.assertEqual(sorted(os.listdir(self.path("work"))), ["two_part"])
        self.assertNotIn("## Parts that have to turn", first)
        self.assertIn("tools/make_results.py --data DIR --only two_part\n", first)
        self.assertIn("**0 of 2 trials run**", self.make("--no-run"))
        page = self.make()
        for name in ("two_part", "rotational", "multi_part"):
            self.assertIn(f"({name}.svg)", page)
            self.assertIn("<svg", self.read("pages", f"{name}.svg"))
            self.assertEqual(len(self.read("pages", f"{name}.csv").splitlines()), 3)
        # Tables 2, 2, 3 and 4; precision and endings of each suite.
        self.assertEqual(len(re.findall(r"^\| t_rrt \| ", page, re.MULTILINE)), 2 + 2 + 2 + 4)
        self.assertEqual(len(re.findall(r"^\| none \| 0\.0 \[0\.0, 79\.3\] 0/1 ", page, re.MULTILINE)), 3)
        self.assertEqual(len(re.findall(r"^\| l_slot \| [\d.]+ \| \*exhausted\* \|$", page, re.MULTILINE)), 3)  # assemblies and planners
        self.assertRegex(page, r"T-RRT \(100 %, 1/1; the paper 97\.4\)")
        self.assertRegex(page, r"better: T-RRT \(100 %, 1/1; the paper 18\.8\)")
        self.assertEqual(len(re.findall("- `none`: the cause was not looked into", page)), 3)
        self.assertRegex(page, r"\| two_part \| 2 trials \| 120 s for a path, .* \| 0\.001, for an assembly of size 10 \| 1 \| \d+\.\d+\.\d+ ")
        self.assertEqual(self.make("--no-run"), page)
        self.assertEqual(self.make(), page)  # nothing is run again

    def test_beside_the_published_code(self):
        self.suites()
        page = self.make("--only", "paper_translation", "--only", "paper_rotation")
        self.assertRegex(page, r"\| two_part/keyhole_2step \| solved \| 2\.1 \| 27 \| 2800 \| 2 \| 0\.010 \| \*exhausted\* \|")
        self.assertRegex(page, r"\| two_part/skew_peg \| solved \| .* \| 0\.016 \(refused\) \| not run \|")
        self.assertRegex(page, r"\| rotational/key_in_lock \| not in 100 s \| .* \| solved, verified \|")
        self.assertIn("Of 2 assemblies, 0 are solved by both, 1 only here (rotational/key_in_lock), 1 only by the published code (two_part/keyhole_2step).", page)
        self.assertRegex(page, r"- two_part/keyhole_2step, success: ended with `exhausted` after .*; not explained")
        self.assertNotIn("paper_sequence", page)
        self.assertIn("`paper_sequence`: 0 trials.", self.make("--no-run"))

    def test_what_is_not_run_is_said(self):
        self.suites()
        self.make()
        self.suites(", seeds: 1..3")
        self.assertIn("**2 of 4 trials run**", self.make("--no-run"))
        self.assertRegex(self.make("--only", "two_part"), r"\| l_slot \| 3/3: [\d.]+ \|")


if __name__ == "__main__":
    unittest.main()
