"""`index.html` beside a plan, and `dismantle view`. What the page shows is tested in a browser (apps/viewer/test)."""
import base64
import json
import os
import shutil
import struct
import unittest

from program import PROGRAM, VIEWER, CliTest

QUICK = ("--path-timeout", "0", "--timeout", "0")


def data_of(page):
    """The JSON that stands in a page."""
    mark = 'id="dismantle-data">'
    begin = page.index(mark) + len(mark)
    return json.loads(page[begin:page.index("</script>", begin)])


@unittest.skipUnless(VIEWER, "the viewer was not built")
class View(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "peg_in_hole", "-o", "peg", status=0)
        self.run_program("plan", "peg", *QUICK, "-o", "out", "-q", status=0)

    def test_plan_writes_a_page_that_holds_the_plan(self):
        data = data_of(self.read("out", "index.html"))
        plan = json.loads(self.read("out", "plan.json"))
        proofs = [check.pop("certificate", None) for step in plan["disassembly"] + plan["assembly_steps"]
                  for check in step.get("checks", [])]
        self.assertTrue(any(proofs))
        left_out = 0
        for mode, steps in (("disassembly", plan["disassembly"]), ("assembly", plan["assembly_steps"])):
            numbers = base64.b64decode(data["view"]["animations"][mode]["poses"])
            numbers = list(struct.unpack(f"<{len(numbers) // 4}I", numbers))
            for step, drawn in zip(steps, data["plan"]["disassembly" if mode == "disassembly" else "assembly_steps"]):
                count = len(drawn["moves"][0]["poses"])
                kept, numbers = numbers[:count], numbers[count:]
                for move in step["moves"]:
                    left_out += len(move["poses"]) - count
                    move["poses"] = [move["poses"][k] for k in kept]
                if "transfer" in step:
                    step["transfer"] = kept.index(step["transfer"])
            self.assertEqual(numbers, [])
        self.assertGreater(left_out, 0)
        self.assertEqual(data["plan"], plan, "all but the proofs of holds, and poses on straight stretches")
        self.assertEqual(len(data["geometry"]["parts"]), 2)

    def test_the_page_names_no_host_and_loads_nothing(self):
        page = self.read("out", "index.html")
        self.assertIn("default-src 'none'", page)
        for word in ("<link rel=\"stylesheet\"", "src=\"http", "@import"):
            self.assertNotIn(word, page)

    def test_view_writes_the_same_page_again(self):
        first = self.read("out", "index.html")
        os.remove(self.path("out", "index.html"))
        done = self.run_program("view", "out/plan.json", "--format", "json", status=0)
        self.assertEqual(self.result_of(done)["page"], "out/index.html")
        again = self.read("out", "index.html")
        self.assertEqual(data_of(again), data_of(first))
        self.run_program("view", "out/plan.json", "-o", "page.html", "-q", status=0)
        self.assertEqual(self.read("page.html"), again)

    def test_what_does_not_fit_is_refused_and_nothing_is_written(self):
        self.assert_fails(3, "is a folder", "view", "out")
        os.rename(self.path("peg"), self.path("moved"))
        self.assert_fails(3, "name it with --assembly", "view", "out/plan.json", "-o", "page.html")
        self.assertFalse(os.path.exists(self.path("page.html")))
        self.run_program("view", "out/plan.json", "-o", "page.html", "--assembly", "moved", "-q", status=0)
        with open(self.path("moved", sorted(os.listdir(self.path("moved")))[0]), "a", encoding="utf-8") as file:
            file.write("# changed\n")
        self.run_program("view", "out/plan.json", "-o", "other.html", "--assembly", "moved", status=3)
        self.assertFalse(os.path.exists(self.path("other.html")))
        self.run_program("view", "out/plan.json", "-o", "no/such/folder/page.html", "--assembly", "moved", status=3)


class WithoutViewer(CliTest):
    """The program with a library where there is no template beside it."""

    def test_plan_says_once_that_there_is_no_page_and_view_fails(self):
        os.mkdir(self.path("bin"))
        program = self.path("bin", "dismantle")
        shutil.copy(PROGRAM, program)
        libraries = os.path.abspath(os.path.join(os.path.dirname(PROGRAM), "..", "lib"))
        os.mkdir(self.path("lib"))
        shutil.copy(os.path.join(libraries, "libdismantle_session.so.0"), self.path("lib"))
        env = {"LD_LIBRARY_PATH": self.path("lib") + os.pathsep + libraries}
        self.run_program("sample", "peg_in_hole", "-o", "peg", status=0)
        done = self.run_program("plan", "peg", *QUICK, "-o", "out", program=program, env=env, status=0)
        self.assertEqual(done.stderr.count("index.html was not written"), 1)
        self.assertNotIn("index.html", done.stdout)
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["plan.glb", "plan.json", "precedence.dot", "resolved.yaml"])
        done = self.run_program("view", "out/plan.json", program=program, env=env, status=2)
        self.assertIn("built without the viewer", done.stderr)
