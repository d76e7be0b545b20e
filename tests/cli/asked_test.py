"""What a plan was asked for, and how its input was read, stand in the plan file: all commands that read it agree."""
import json
import os
import unittest

from program import VIEWER, CliTest, box
from export_test import HAS_BOOK

QUICK = ("--path-timeout", "0", "--timeout", "0", "--set", "run.path_steps=2000")


class Asked(CliTest):
    def setUp(self):
        super().setUp()
        for k, name in enumerate(("base", "middle", "top", "lid")):
            self.write(f"in/{name}.obj", box((0, 0, k), (1, 1, k + 1)))

    def agree(self, status, word, text, *options):
        """Plans, and checks that plan, verify, explain, page, book and Markdown say the same."""
        done = self.run_program("plan", "in", *QUICK, *options, "-o", "out", "--format", "json", status=status)
        result = self.result_of(done)
        self.assertEqual(result["status"], word)
        self.assertEqual(result["reason"] is None, status == 0)
        self.assertEqual(result["asked"], json.loads(self.read("out", "plan.json")).get("asked", {}))
        self.assertIn(text, done.stderr)
        verified = self.run_program("verify", "out/plan.json", "--format", "json", status=status)
        for key, value in (("status", word), ("reason", result["reason"]), ("asked", result["asked"])):
            self.assertEqual(self.result_of(verified)[key], value)
        self.assertIn(text, verified.stderr)
        explained = self.run_program("explain", "out/plan.json", "--format", "json", status=0)
        self.assertEqual(self.result_of(explained)["status"], word)
        self.assertIn(text, explained.stderr)
        self.assertIn(text, self.run_program("export", "out/plan.json", "--format", "markdown", "-o", "-", status=0).stdout)
        if VIEWER:
            page = self.read("out", "index.html")
            data = json.loads(page[page.index('{"format":"dismantle.page"'):].split("</script>")[0])
            self.assertEqual((data["result"]["word"], text in data["result"]["text"]), (word, True))
            seen = self.run_program("view", "out/plan.json", "--format", "json", status=0)
            self.assertEqual(self.result_of(seen)["status"], word)
        plan = json.loads(self.read("out", "plan.json"))
        if HAS_BOOK and plan["disassembly"]:
            book = self.run_program("book", "out/plan.json", "--format", "json", status=0)
            self.assertEqual(self.result_of(book)["status"], word)
        return plan

    def constraints(self, text):
        return "-c", self.write("config.yaml", "schema: 1\nconstraints: " + text + "\n")

    def test_all(self):
        plan = self.agree(0, "complete", "complete: every part came out")
        self.assertNotIn("asked", plan)

    def test_parts_that_stay_together(self):
        plan = self.agree(0, "complete", "but for those that are to stay together", *self.constraints("{together: [[top, lid]]}"))
        self.assertEqual(plan["asked"], {"together": [["top", "lid"]]})
        self.assertEqual(plan["status"], "complete")

    def test_a_target(self):
        plan = self.agree(0, "complete", "top is out, which was the target", *self.constraints("{target: top}"))
        self.assertEqual(plan["asked"], {"target": "top"})
        self.assertLess(len(plan["disassembly"]), 3)

    def test_one_part(self):
        plan = self.agree(0, "complete", "lid came out, which was all that was asked for", "--part", "lid")
        self.assertEqual((plan["asked"], len(plan["disassembly"])), ({"part": "lid"}, 1))

    def test_one_part_of_those_that_stay_together(self):
        self.agree(0, "complete", "lid came out", "--part", "lid", *self.constraints("{together: [[top, lid]]}"))

    def test_a_target_that_does_not_come_out(self):
        self.write("in/shell.obj", self.hollow((-1, -1, -1), (2, 2, 5)))
        plan = self.agree(1, "partial", "top is not out", *self.constraints("{target: top}"), "--set", "run.force=off")
        self.assertEqual(plan["status"], "partial")

    def test_parts_that_cannot_be_used(self):
        self.write("in/open.obj", "v 5 0 0\nv 5 0 0\nv 5 0 0\nf 1 2 3\n")
        plan = self.agree(1, "partial", "some parts of the input could not be used")
        self.assertEqual([e.get("unusable") for e in plan["assembly"]["excluded"]], [True])

    def test_a_plan_that_claims_more_than_it_does(self):
        plan = self.agree(0, "complete", "top is out", *self.constraints("{target: top}"))
        del plan["asked"]
        self.write("out/claims.json", json.dumps(plan))
        done = self.run_program("verify", "out/claims.json", "--assembly", "in", status=1)
        self.assertIn("says that it is complete", done.stdout)

    @staticmethod
    def hollow(lo, hi):
        """A box with a box-shaped hole."""
        text = box(lo, hi)
        for line in box([x + 0.5 for x in lo], [x - 0.5 for x in hi]).splitlines():
            word = line.split()
            text += (line if word[0] == "v" else "f " + " ".join(str(int(i) + 8) for i in reversed(word[1:]))) + "\n"
        return text


class ImporterParameters(CliTest):
    """The plan states them: every command that reads its input again reads it with them."""

    def test_each_command(self):
        env = {"DISMANTLE_PLUGIN_PATH": os.pathsep.join(filter(None, (os.environ.get("DISMANTLE_PLUGIN_PATH"), os.environ["BOXES_FOLDER"])))}
        self.write("in.boxes", "base 0 0 0 1 1 1\nlid 0 0 1 1 1 2\n")
        self.write("config.yaml", "schema: 1\nimporters:\n  test.boxes:\n    scale: 3\n")
        self.assertIn("without its scale", self.run_program("plan", "in.boxes", *QUICK, status=3, env=env).stderr)
        self.run_program("plan", "in.boxes", *QUICK, "-c", "config.yaml", "-o", "out", "-q", status=0, env=env)
        self.assertEqual(json.loads(self.read("out", "plan.json"))["assembly"]["import"], {"test.boxes": {"scale": 3}})
        self.run_program("verify", "out/plan.json", status=0, env=env)
        for format_ in ("poses-csv", "poses-json", "glb", "glb-exploded"):
            self.run_program("export", "out/plan.json", "--format", format_, "--unit", "mm", status=0, env=env)
        if HAS_BOOK:
            self.run_program("book", "out/plan.json", status=0, env=env)
        if VIEWER:
            self.run_program("view", "out/plan.json", status=0, env=env)

    def test_a_benchmark(self):
        env = {"DISMANTLE_PLUGIN_PATH": os.pathsep.join(filter(None, (os.environ.get("DISMANTLE_PLUGIN_PATH"), os.environ["BOXES_FOLDER"])))}
        self.write("in.boxes", "base 0 0 0 1 1 1\nlid 0 0 1 1 1 2\n")
        self.write("suite.yaml", "schema: 1\nassemblies: [{path: in.boxes}]\nplanners: {plain: {}}\n"
                                 "importers: {test.boxes: {scale: 3}}\n"
                                 "limits: {timeout: 60, wall: 300, memory: 2048, path_steps: 2000}\n")
        done = self.run_program("bench", "suite.yaml", "-o", "rows", "--format", "json", status=0, env=env)
        result = json.loads(done.stdout.splitlines()[-1])
        self.assertEqual((result["done"], result["solved"]), (1, 1), done.stderr)


if __name__ == "__main__":
    unittest.main()
