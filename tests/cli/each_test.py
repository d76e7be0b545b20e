"""`dismantle plan --each`: a folder of products, each planned by itself."""
import csv
import json
import os
import shutil
import signal
import subprocess
import threading

import meshes
from program import HANGING, PROGRAM, CliTest

QUICK = ("--path-timeout", "0", "--timeout", "0")


def pair(gap=1):
    """Two boxes above each other as one OBJ file with two objects."""
    lower, upper = meshes.obj(*meshes.box((0, 0, 0), (1, 1, 1))), meshes.obj(*meshes.box((0, 0, gap), (1, 1, gap + 1)))
    upper = "".join(line if line[0] == "v" else "f " + " ".join(str(int(i) + 8) for i in line.split()[1:]) + "\n"
                    for line in upper.splitlines(True))
    return f"o lower\n{lower}o upper\n{upper}"


class Each(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "peg_in_hole", "-o", "in/peg", status=0)
        self.write("in/pair.obj", pair())

    def each(self, *options, status, out="out"):
        done = self.run_program("plan", "--each", "in", "-o", out, *QUICK, "--format", "json", *options, status=status)
        return self.result_of(done), done.stderr

    def rows(self, out="out"):
        with open(self.path(out, "summary.csv"), encoding="utf-8", newline="") as file:
            return {row["name"]: row for row in csv.DictReader(file)}

    def test_every_file_and_sub_folder_is_planned_into_a_folder_of_its_own(self):
        result, said = self.each(status=0)
        self.assertEqual((result["status"], result["products"], result["complete"], result["kept"]), ("complete", 2, 2, 0))
        rows = self.rows()
        self.assertEqual(list(rows), ["pair", "peg"])
        for name, row in rows.items():
            plan = json.loads(self.read("out", name, "plan.json"))
            self.assertEqual((row["status"], row["complete"], row["exit_status"], row["kept"]), ("complete", "yes", "0", "no"))
            self.assertEqual([int(row[k]) for k in ("parts", "steps", "forced")], [len(plan["assembly"]["parts"]), len(plan["disassembly"]), 0])
            self.assertEqual(row["plan"], f"out/{name}/plan.json")
            self.run_program("verify", row["plan"], "-q", status=0)
            alone = self.run_program("plan", row["input"], *QUICK, "-o", "alone", "-q", status=0)
            self.assertEqual(alone.stdout, "")
            self.assertEqual([s["moves"] for s in json.loads(self.read("alone", "plan.json"))["disassembly"]],
                             [s["moves"] for s in plan["disassembly"]])
        for name in rows:
            self.assertRegex(said, rf"(?m)^{name} +2 +complete +0 ")
        self.assertIn("2 of 2 products complete", said)

    def test_what_is_finished_is_kept_while_files_and_settings_are_the_same(self):
        self.each(status=0)
        before = {name: self.read("out", name, "plan.json") for name in ("pair", "peg")}

        def kept(*options):
            result, _ = self.each(*options, status=0)
            names = [name for name, row in self.rows().items() if row["kept"] == "yes"]
            self.assertEqual(result["kept"], len(names))
            return names

        self.assertEqual(kept(), ["pair", "peg"])
        self.assertEqual(kept("--jobs", "2"), ["pair", "peg"], "no plan depends on the number of threads")
        self.assertEqual({name: self.read("out", name, "plan.json") for name in before}, before)
        self.write("in/pair.obj", pair(gap=1.5))
        self.assertEqual(kept(), ["peg"])
        self.assertEqual(kept("--seed", "7"), [])
        self.assertEqual(kept("--seed", "7"), ["pair", "peg"])
        os.remove(self.path("out", "peg", "plan.json"))
        self.assertEqual(kept("--seed", "7"), ["pair"])
        self.run_program("plan", "in/peg", *QUICK, "--seed", "7", "-o", "out/peg", "-q", status=0)
        self.assertEqual(kept("--seed", "7"), ["pair"], "what `plan` writes there by itself is no part of the run")

    def test_one_that_fails_stops_no_other_and_the_exit_status_is_1(self):
        self.write("in/broken.obj", "v 0 0 zero\n")
        self.write("in/lone.obj", meshes.obj(*meshes.box((0, 0, 0), (1, 1, 1))))
        self.write("in/drawing.prt", "?")
        for run in range(2):
            result, said = self.each("--jobs", "2", status=1)
            self.assertEqual((result["status"], result["products"], result["complete"]), ("partial", 4, 2))
            self.assertEqual(result["kept"], 2 * run, "those that failed are tried again")
            rows = self.rows()
            for name in ("broken", "lone"):
                self.assertEqual((rows[name]["status"], rows[name]["complete"], rows[name]["exit_status"]), ("error", "no", "3"))
                self.assertIn(f"in/{name}.obj", rows[name]["message"])
            self.assertEqual(rows["pair"]["complete"], "yes")
            self.assertIn("drawing.prt: no importer reads '.prt'", said)

    def test_ctrl_c_keeps_what_is_finished(self):
        shutil.rmtree(self.path("in", "peg"))
        self.run_program("sample", "machine", "-o", "in/work", "--set", "parts=160", status=0)  # seconds of work
        process = subprocess.Popen([PROGRAM, "plan", "--each", "in", "-o", "out", *QUICK, "--threads", "1", "--jobs", "2"], cwd=self.folder, text=True,
                                   encoding="utf-8", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        watchdog = threading.Timer(HANGING, process.kill)
        watchdog.start()
        try:
            for line in process.stderr:
                if line.startswith("1/2 pair: complete"):
                    process.send_signal(signal.SIGINT)
                    break
            said = process.stdout.read()
            self.assertEqual(process.wait(), 130)
        finally:
            watchdog.cancel()
        self.assertIn("the same command goes on", said)
        rows = self.rows()
        self.assertEqual((rows["pair"]["status"], rows["work"]["status"], rows["work"]["exit_status"]), ("complete", "interrupted", "130"))
        shutil.rmtree(self.path("in", "work"))
        self.run_program("sample", "peg_in_hole", "-o", "in/work", status=0)
        result, _ = self.each("--threads", "1", status=0)
        self.assertEqual((result["complete"], result["kept"]), (2, 1))

    def test_wrong_use_is_told(self):
        self.assert_fails(2, "--each needs a folder for the results: name it with -o", "plan", "--each", "in")
        self.assert_fails(2, "--each", "plan", "in", "--jobs", "2")
        self.assert_fails(2, "--part", "plan", "--each", "in", "-o", "out", "--part", "x")
        self.assert_fails(2, "unknown key", "plan", "--each", "in", "-o", "out", "--set", "run.sped=1")
        self.assert_fails(3, "folder cannot be read", "plan", "--each", "in/pair.obj", "-o", "out")
        os.mkdir(self.path("empty"))
        self.assert_fails(3, "no product in this folder", "plan", "--each", "empty", "-o", "out")
        self.assertFalse(os.path.exists(self.path("out")), "nothing was begun")

    def test_a_folder_of_products_that_is_planned_as_one_assembly_is_told(self):
        shutil.rmtree(self.path("in", "peg"))
        self.write("in/other.obj", pair().replace("v 0", "v 5").replace("v 1", "v 6"))
        done = self.run_program("plan", "in", *QUICK, "-o", "out", status=0)
        self.assertIn("2 of the 2 files hold several bodies each, and the folder is taken as one assembly", done.stderr)
        self.assertIn("dismantle plan --each in -o DIR", done.stderr)
        os.mkdir(self.path("outer"))
        os.rename(self.path("in"), self.path("outer", "in"))
        self.assert_fails(3, "plan --each", "plan", "outer")


if __name__ == "__main__":
    import unittest
    unittest.main()
