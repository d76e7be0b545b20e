"""tools/make_results.py on small suites: the page has all planners and tables, and a second run gives the same page."""
import os
import re
import subprocess
import sys
import unittest

from benching import PROGRAM, BenchTest

SOURCE = os.environ["SOURCE_FOLDER"]
PLANNERS = "t_rrt: {set: {simulator.type: fcl, path_planner.type: t_rrt, sequence_planner.type: progressive}}"


class MakeResults(BenchTest):
    def make(self):
        done = subprocess.run([sys.executable, "-B", os.path.join(SOURCE, "tools/make_results.py"), "--program", PROGRAM, "--suites", self.path("suites"),
                               "--work", self.path("work"), "--out", self.path("pages")], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.read("pages", "README.md")

    def test_the_page(self):
        for name, category in (("two_part", "two-part"), ("rotational", "puzzle"), ("multi_part", "sample")):
            self.suite(f"  {PLANNERS}\n  none: {{config: ../evil.yaml}}\n", f"  - {{sample: l_slot, category: {category}}}\n",
                       name=f"suites/results_{name}.yaml")
        page = self.make()
        for name in ("two_part", "rotational", "multi_part"):
            self.assertIn(f"({name}.svg)", page)
            self.assertIn("<svg", self.read("pages", f"{name}.svg"))
            self.assertEqual(len(self.read("pages", f"{name}.csv").splitlines()), 3)
        self.assertEqual(len(re.findall(r"^\| t_rrt \| ", page, re.MULTILINE)), 2 + 2 + 3)  # tables 2, 2, 3 and 4, precision of each
        self.assertEqual(len(re.findall(r"^\| none \| 0\.0 \[0\.0, 79\.3\] 0/1 ", page, re.MULTILINE)), 3)
        self.assertRegex(page, r"\| commit \| ([0-9a-f]{10}|unknown)")
        self.assertEqual(self.make(), page)  # nothing is run again


if __name__ == "__main__":
    unittest.main()
