"""`dismantle export` and `dismantle book`: other programs can read what is written."""
import csv
import io
import json
import os
import re
import shutil
import struct
import subprocess
import unittest
from xml.etree import ElementTree

from program import PROGRAM, CliTest

QUICK = ("--path-timeout", "0", "--timeout", "0")
HAS_BOOK = "built without instructions" not in subprocess.run(
    [PROGRAM, "book", "none.json"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True).stderr


def glb_json(data):
    """The JSON chunk of a binary glTF."""
    magic, version, length = struct.unpack("<4sII", data[:12])
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack("<I4s", data[12:20])
    assert kind == b"JSON"
    return json.loads(data[20:20 + size])


class WithPlan(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "stacked_box", "-o", "box", status=0)
        self.run_program("plan", "box", *QUICK, "-o", "out", "-q", status=0)
        self.plan = json.loads(self.read("out", "plan.json"))

    def export(self, format_, *options):
        """What is written to standard output."""
        return self.run_program("export", "out/plan.json", "--format", format_, "-o", "-", *options, status=0).stdout


class Export(WithPlan):
    def test_csv_has_every_pose_and_times_that_do_not_go_back(self):
        rows = list(csv.DictReader(io.StringIO(self.export("poses-csv"))))
        expected = [(kind, step["step"], move["part"], pose) for kind, key in (("disassembly", "disassembly"), ("assembly", "assembly_steps"))
                    for step in self.plan[key] for move in step["moves"] for pose in move["poses"]]
        self.assertEqual(len(rows), len(expected))
        last = {}
        for row, (kind, step, part, pose) in zip(rows, expected):
            self.assertEqual((row["animation"], int(row["step"]), row["part"]), (kind, step, part))
            self.assertEqual([float(row[k]) for k in ("x", "y", "z", "qw", "qx", "qy", "qz")], pose)
            self.assertGreaterEqual(float(row["time"]), last.get((kind, part), 0))
            last[kind, part] = float(row["time"])

    def test_json_of_poses_says_the_same(self):
        poses = json.loads(self.export("poses-json", "--unit", "mm"))
        self.assertEqual(poses["unit"], "mm")
        for mine, theirs in zip(poses["disassembly"], self.plan["disassembly"], strict=True):
            self.assertEqual([m["poses"] for m in mine["moves"]], [m["poses"] for m in theirs["moves"]])
            self.assertEqual(len(mine["times"]), len(mine["moves"][0]["poses"]))

    def test_graphml_is_xml_with_a_node_per_step(self):
        root = ElementTree.fromstring(self.export("graphml"))
        space = "{http://graphml.graphdrawing.org/xmlns}"
        nodes = {n.get("id") for n in root.iter(space + "node")}
        self.assertEqual(nodes, {f"s{s['step']}" for s in self.plan["disassembly"]})
        edges = {(e.get("source"), e.get("target")) for e in root.iter(space + "edge")}
        self.assertEqual(edges, {(f"s{a}", f"s{s['step']}") for s in self.plan["disassembly"] for a in s["after"]})

    def test_the_and_or_graph_goes_from_all_parts_to_each_alone(self):
        graph = json.loads(self.export("and-or-json"))
        names = {p["name"] for p in self.plan["assembly"]["parts"]}
        self.assertEqual(set(graph["nodes"][0]["parts"]), names)
        self.assertEqual({n["parts"][0] for n in graph["nodes"] if len(n["parts"]) == 1}, names)

    def test_markdown_has_a_row_per_step(self):
        rows = [line for line in self.export("markdown").splitlines() if re.match(r"\| \d+ \|", line)]
        self.assertEqual(len(rows), len(self.plan["disassembly"]))

    @unittest.skipUnless(shutil.which("dot"), "Graphviz is not installed")
    def test_graphviz_reads_the_graphs(self):
        for format_ in ("dot", "and-or-dot"):
            subprocess.run(["dot", "-Tsvg"], input=self.export(format_), text=True, check=True, stdout=subprocess.PIPE)

    def test_gltf_is_in_metres_with_y_up_and_says_when_the_unit_is_a_guess(self):
        done = self.run_program("export", "out/plan.json", "--format", "glb-exploded", status=0)
        self.assertIn("mm is assumed", done.stderr)
        self.run_program("export", "out/plan.json", "--format", "glb", "-o", "inch.glb", "--unit", "inch", "--up", "y", status=0)
        with open(self.path("out", "exploded.glb"), "rb") as file:
            exploded = glb_json(file.read())
        with open(self.path("inch.glb"), "rb") as file:
            inch = glb_json(file.read())
        self.assertEqual(exploded["nodes"][0]["scale"], [0.001] * 3)
        self.assertIn("rotation", exploded["nodes"][0])
        self.assertNotIn("animations", exploded)
        self.assertEqual(inch["nodes"][0]["scale"], [0.0254] * 3)
        self.assertNotIn("rotation", inch["nodes"][0])
        self.assertEqual([a["name"] for a in inch["animations"]][0], "disassembly")

    def test_wrong_use_is_told(self):
        self.assert_fails(2, "poses-csv", "export", "out/plan.json", "--format", "stl")
        self.assert_fails(2, "--format is required", "export", "out/plan.json")
        self.assert_fails(3, "is no unit of length", "export", "out/plan.json", "--format", "glb", "--unit", "parsec")
        self.assert_fails(2, "name a file with -o", "export", "out/plan.json", "--format", "glb", "-o", "-")
        self.assert_fails(3, "is a folder", "export", "out", "--format", "markdown")
        os.rename(self.path("box"), self.path("moved"))
        self.export("markdown")
        self.assert_fails(3, "name it with --assembly", "export", "out/plan.json", "--format", "poses-csv")
        self.run_program("export", "out/plan.json", "--format", "poses-csv", "--assembly", "moved", status=0)


@unittest.skipUnless(HAS_BOOK, "built without pangocairo")
class Book(WithPlan):
    def test_html_has_a_page_per_step_in_the_order_of_assembling(self):
        done = self.run_program("book", "out/plan.json", "--title", "A <box>", "--format", "json", status=0)
        self.assertEqual(self.result_of(done)["book"], "out/book.html")
        html = self.read("out", "book.html")
        self.assertIn("<h1>A &lt;box&gt;</h1>", html)
        steps = [int(n) for n in re.findall(r"<dd>(\d+), backwards</dd>", html)]
        self.assertEqual(steps, sorted((s["step"] for s in self.plan["disassembly"]), reverse=True))
        self.assertEqual(len(re.findall(r"data:image/png;base64,iVBOR", html)), html.count("<img"))
        self.run_program("book", "out/plan.json", "--disassembly", "-o", "apart.html", "-q", status=0)
        apart = [int(n) for n in re.findall(r"step of the plan</dt><dd>(\d+)</dd>", self.read("apart.html"))]
        self.assertEqual(apart, steps[::-1])

    def test_pdf(self):
        self.run_program("book", "out/plan.json", "-o", "box.pdf", "-q", status=0)
        with open(self.path("box.pdf"), "rb") as file:
            data = file.read()
        self.assertTrue(data.startswith(b"%PDF-") and data.rstrip().endswith(b"%%EOF"))

    def test_wrong_use_is_told(self):
        self.assert_fails(2, ".html or .pdf", "book", "out/plan.json", "-o", "book.doc")
        self.assert_fails(3, "cannot be read", "book", "none.json")
        self.run_program("sample", "closed_box", "-o", "closed", status=0)
        self.run_program("plan", "closed", *QUICK, "--set", "run.force=off", "-o", "stuck", "-q", status=1)
        self.assertEqual(json.loads(self.read("stuck", "plan.json"))["disassembly"], [])
        self.assert_fails(3, "no steps", "book", "stuck/plan.json", "-q")
        self.assertFalse(os.path.exists(self.path("stuck", "book.html")))


if __name__ == "__main__":
    unittest.main()
