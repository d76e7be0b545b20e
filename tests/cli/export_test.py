"""`dismantle export` and `dismantle book`: other programs can read what is written."""
import csv
import ctypes.util
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
        rows = [line for line in self.export("markdown").split("<details>")[0].splitlines() if re.match(r"\| \d+ \|", line)]
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
        self.assertIn("nothing is beside the part", self.export("markdown"))
        os.rename(self.path("box"), self.path("moved"))
        self.assertIn("lengths of the verified paths", self.export("markdown"))
        self.assert_fails(3, "name it with --assembly", "export", "out/plan.json", "--format", "poses-csv")
        self.run_program("export", "out/plan.json", "--format", "poses-csv", "--assembly", "moved", status=0)


# The elements of MJCF and URDF that a model may have here, each with its attributes: those that must be there, and others.
MJCF = {
    "mujoco": ("model", ""), "compiler": ("", "angle meshdir balanceinertia boundmass boundinertia"), "option": ("", "timestep gravity"),
    "default": ("", "class"), "custom": ("", ""), "text": ("name data", ""), "asset": ("", ""), "mesh": ("file", "name inertia"),
    "worldbody": ("", ""), "light": ("", "pos dir directional"), "body": ("", "name pos quat"), "freejoint": ("", "name"),
    "inertial": ("pos mass", "fullinertia"), "geom": ("", "name class type mesh rgba contype conaffinity"), "equality": ("", ""),
    "weld": ("body1", "name body2"), "keyframe": ("", ""), "key": ("", "name qpos")}
URDF = {
    "robot": ("name", ""), "link": ("name", ""), "inertial": ("", ""), "origin": ("", "xyz rpy"), "mass": ("value", ""),
    "inertia": ("ixx ixy ixz iyy iyz izz", ""), "visual": ("", ""), "collision": ("", ""), "geometry": ("", ""), "mesh": ("filename", ""),
    "material": ("name", ""), "color": ("rgba", ""), "joint": ("name type", ""), "parent": ("link", ""), "child": ("link", "")}
# Fields of the messages of ROS 2, as its .msg files list them; a list: of any length.
TIME = {"sec": int, "nanosec": int}
HEADER = {"stamp": TIME, "frame_id": str}
VECTOR = {"x": float, "y": float, "z": float}
QUATERNION = {**VECTOR, "w": float}
TRANSFORM = {"translation": VECTOR, "rotation": QUATERNION}
TRANSFORM_STAMPED = {"header": HEADER, "child_frame_id": str, "transform": TRANSFORM}
POSE_ARRAY = {"header": HEADER, "poses": [{"position": VECTOR, "orientation": QUATERNION}]}
TWIST = {"linear": VECTOR, "angular": VECTOR}
TRAJECTORY = {"header": HEADER, "joint_names": [str],
              "points": [{"transforms": [TRANSFORM], "velocities": [TWIST], "accelerations": [TWIST], "time_from_start": TIME}]}


class Robots(WithPlan):
    METRES = 0.0254

    def export_folder(self, format_):
        """The input has no unit: inches."""
        self.run_program("export", "out/plan.json", "--format", format_, "--unit", "inch", "-q", status=0)

    def model(self, file, schema):
        root = ElementTree.fromstring(self.read(file))
        for element in root.iter():
            required, others = (set(names.split()) for names in schema[element.tag])
            self.assertLessEqual(required, set(element.keys()), element.tag)
            self.assertLessEqual(set(element.keys()), required | others, element.tag)
        return root

    def assert_box(self, mesh, part):
        """The mesh has the size of the part's input file, in metres."""
        def box(text, scale):
            points = [[scale * float(x) for x in line.split()[1:4]] for line in text.splitlines() if line.startswith("v ")]
            return [f(p[k] for p in points) for k in range(3) for f in (min, max)]
        file = next(p["file"] for p in self.plan["assembly"]["parts"] if p["name"] == part)
        for mine, theirs in zip(box(self.read(mesh), 1), box(self.read("box", file), self.METRES), strict=True):
            self.assertAlmostEqual(mine, theirs, 9)

    def assert_pose(self, xyz, wxyz, pose):
        for mine, theirs in zip([*xyz, *wxyz], [*(self.METRES * x for x in pose[:3]), *pose[3:]], strict=True):
            self.assertAlmostEqual(mine, theirs, 12)

    def assert_fields(self, value, fields):
        if isinstance(fields, dict):
            self.assertEqual(list(value), list(fields))
            for key, inner in fields.items():
                self.assert_fields(value[key], inner)
        elif isinstance(fields, list):
            for item in value:
                self.assert_fields(item, fields[0])
        else:
            self.assertIsInstance(value, (int, float) if fields is float else fields)

    def test_mjcf_has_a_body_per_part_and_a_keyframe_per_step(self):
        self.export_folder("mjcf")
        root = self.model("out/mjcf/assembly.xml", MJCF)
        self.assertEqual([child.tag for child in root],
                         ["compiler", "option", "default", "asset", "worldbody", "equality", "keyframe"])
        folder = root.find("compiler").get("meshdir")
        files = {m.get("name"): os.path.join("out", "mjcf", folder, m.get("file")) for m in root.iter("mesh")}
        names = [part["name"] for part in self.plan["assembly"]["parts"]]
        bodies = root.findall("worldbody/body")
        self.assertEqual([b.get("name") for b in bodies], names)
        for body in bodies:
            self.assertEqual([child.tag for child in body], ["freejoint", "inertial", "geom"])
            self.assert_box(files[body.find("geom").get("mesh")], body.get("name"))
        now = {name: [0, 0, 0, 1, 0, 0, 0] for name in names}
        keys = root.findall("keyframe/key")
        self.assertEqual([k.get("name") for k in keys], ["assembled"] + [f"step_{s['step']}" for s in self.plan["disassembly"]])
        for key, step in zip(keys, [{"moves": []}] + self.plan["disassembly"], strict=True):
            now.update({move["part"]: move["poses"][-1] for move in step["moves"]})
            numbers = [float(x) for x in key.get("qpos").split()]
            for i, name in enumerate(names):
                self.assert_pose(numbers[7 * i:7 * i + 3], numbers[7 * i + 3:7 * i + 7], now[name])
        welds = root.findall("equality/weld")
        self.assertEqual(len(welds), len(names), "all are joined to one, and one to the world")
        for weld in welds:
            self.assertIn(weld.get("body1"), names)
            self.assertIn(weld.get("body2", names[0]), names)

    @unittest.skipUnless(ctypes.util.find_library("mujoco"), "MuJoCo is not installed (Debian: libmujoco-dev)")
    def test_mujoco_loads_the_model(self):
        self.export_folder("mjcf")
        library = ctypes.CDLL(ctypes.util.find_library("mujoco"))
        library.mj_loadXML.restype = ctypes.c_void_p
        error = ctypes.create_string_buffer(1000)
        model = library.mj_loadXML(self.path("out", "mjcf", "assembly.xml").encode(), None, error, len(error))
        self.assertTrue(model, error.value.decode())
        self.assertEqual(error.value, b"", "no warning either")
        counts = (ctypes.c_int * 2).from_address(model)  # nq, nv
        self.assertEqual(list(counts), [7 * len(self.plan["assembly"]["parts"]), 6 * len(self.plan["assembly"]["parts"])])
        library.mj_makeData.restype = ctypes.c_void_p
        data = library.mj_makeData(ctypes.c_void_p(model))
        for key in range(1 + len(self.plan["disassembly"])):
            library.mj_resetDataKeyframe(ctypes.c_void_p(model), ctypes.c_void_p(data), key)
            library.mj_forward(ctypes.c_void_p(model), ctypes.c_void_p(data))

    def test_ros_has_the_fields_of_its_messages_and_the_poses_of_the_plan(self):
        self.export_folder("ros")
        motions = json.loads(self.read("out", "ros", "motions.json"))
        part_of = {link["link"]: link["part"] for link in motions["links"]}
        joint_of = {link["link"]: link["joint"] for link in motions["links"]}
        self.assertEqual([link["part"] for link in motions["links"]], [p["name"] for p in self.plan["assembly"]["parts"]])
        self.assert_fields(motions["frames"], [TRANSFORM_STAMPED])
        for kind, key in (("disassembly", "disassembly"), ("assembly", "assembly_steps")):
            for step, planned in zip(motions[kind], self.plan[key], strict=True):
                self.assertEqual(step["step"], planned["step"])
                self.assert_fields(step["trajectory"], TRAJECTORY)
                self.assert_fields(step["frames"], [TRANSFORM_STAMPED])
                self.assertEqual(step["trajectory"]["joint_names"], [joint_of[p["link"]] for p in step["paths"]])
                for m, (path, move) in enumerate(zip(step["paths"], planned["moves"], strict=True)):
                    self.assert_fields(path["pose_array"], POSE_ARRAY)
                    self.assertEqual(part_of[path["link"]], move["part"])
                    poses = path["pose_array"]["poses"]
                    for pose, point, expected in zip(poses, step["trajectory"]["points"], move["poses"], strict=True):
                        transform = point["transforms"][m]
                        self.assertEqual(transform, {"translation": pose["position"], "rotation": pose["orientation"]})
                        self.assert_pose([pose["position"][k] for k in "xyz"], [pose["orientation"][k] for k in "wxyz"], expected)
                    self.assertEqual(step["frames"][m]["child_frame_id"], path["link"])
                    self.assertEqual(step["frames"][m]["transform"], step["trajectory"]["points"][-1]["transforms"][m])

    def test_urdf_has_a_floating_link_per_part(self):
        self.export_folder("ros")
        root = self.model("out/ros/assembly.urdf", URDF)
        motions = json.loads(self.read("out", "ros", "motions.json"))
        self.assertEqual([link.get("name") for link in root.findall("link")],
                         [motions["root"]] + [link["link"] for link in motions["links"]])
        for link, known in zip(root.findall("link")[1:], motions["links"], strict=True):
            self.assertGreater(float(link.find("inertial/mass").get("value")), 0)
            for mesh in link.iter("mesh"):
                self.assert_box(os.path.join("out", "ros", mesh.get("filename")), known["part"])
        for joint, known in zip(root.findall("joint"), motions["links"], strict=True):
            self.assertEqual((joint.get("name"), joint.get("type")), (known["joint"], "floating"))
            self.assertEqual((joint.find("parent").get("link"), joint.find("child").get("link")), (motions["root"], known["link"]))

    @unittest.skipUnless(shutil.which("check_urdf"), "liburdfdom-tools is not installed")
    def test_urdfdom_reads_the_model(self):
        self.export_folder("ros")
        done = subprocess.run(["check_urdf", self.path("out", "ros", "assembly.urdf")], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn(f"root Link: assembly has {len(self.plan['assembly']['parts'])} child(ren)", done.stdout)

    def test_wrong_use_is_told(self):
        self.assert_fails(2, "name a folder with -o", "export", "out/plan.json", "--format", "mjcf", "-o", "-")
        done = self.run_program("export", "out/plan.json", "--format", "ros", "-o", "robot", status=0)
        self.assertIn("mm is assumed", done.stderr)
        self.assertTrue(os.path.exists(self.path("robot", "assembly.urdf")))
        self.assert_fails(2, "cannot be used as output folder", "export", "out/plan.json", "--format", "ros", "-o", "out/plan.json")


@unittest.skipUnless(HAS_BOOK, "built without pangocairo")
class Book(WithPlan):
    def test_html_has_a_page_per_step_in_the_order_of_assembling(self):
        done = self.run_program("book", "out/plan.json", "--title", "A <box>", "--format", "json", status=0)
        self.assertEqual(self.result_of(done)["book"], "out/book.html")
        html = self.read("out", "book.html")
        self.assertIn("<h1>A &lt;box&gt;</h1>", html)
        steps = self.steps_in(html)
        self.assertEqual(steps, list(range(1, 1 + len(self.plan["disassembly"]))))
        first = {s["moves"][0]["part"] for s in self.plan["disassembly"][-1:]}
        page = html[html.index('id="step-1"'):html.index("</section>", html.index('id="step-1"'))]
        self.assertTrue(all(name in page or name.rstrip("_0123456789") in page for name in first), page[:200])
        self.assertEqual(len(re.findall(r"data:image/png;base64,iVBOR", html)), html.count("<img"))
        self.run_program("book", "out/plan.json", "--disassembly", "-o", "apart.html", "-q", status=0)
        self.assertEqual(self.steps_in(self.read("apart.html")), steps)

    def steps_in(self, html):
        """Numbers of the steps in the order of the pages; equal steps share a page: "step 3–8 of 9"."""
        ranges = re.findall(r"<span>step (\d+)(?:–(\d+))? of", html)
        return [n for first, last in ranges for n in range(int(first), 1 + int(last or first))]

    def test_pdf(self):
        self.run_program("book", "out/plan.json", "-o", "box.pdf", "-q", status=0)
        with open(self.path("box.pdf"), "rb") as file:
            data = file.read()
        self.assertTrue(data.startswith(b"%PDF-") and data.rstrip().endswith(b"%%EOF"))

    def test_notes_language_and_revision(self):
        part = self.plan["disassembly"][0]["moves"][0]["part"]
        self.write("notes.yaml", f"notes:\n  - {{parts: [{part}], text: \"Grease <it>\"}}\n")
        self.write("words.yaml", "language: de\nphrases:\n  Contents: Inhalt\n  Put in: Einbauen\n  down: nach unten\n")
        self.run_program("book", "out/plan.json", "--notes", "notes.yaml", "--language", "words.yaml", "--revision", "B7",
                         "-o", "b.html", "-q", status=0)
        html = self.read("b.html")
        for text in ("Grease &lt;it&gt;", "<dd>B7</dd>", '<html lang="de">', "Einbauen", "nach unten"):
            self.assertIn(text, html)
        self.write("none.yaml", "notes:\n  - {parts: [nobody], text: x}\n")
        self.assert_fails(2, "none.yaml:2:5: error: no step of the plan moves just these parts: nobody", "book",
                          "out/plan.json", "--notes", "none.yaml", "-q")
        self.write("wrong.yaml", "language: de\nphrases:\n  step {} of {}: Schritt {}\n")
        self.assert_fails(2, "wrong.yaml:3:18: error: the translation of 'step {} of {}'", "book", "out/plan.json",
                          "--language", "wrong.yaml", "-q")

    def test_a_long_name_is_not_cut(self):
        name = "bracket_" + "of_the_left_side_" * 12 + "end"
        part = self.plan["disassembly"][0]["moves"][0]["part"]
        os.rename(self.path("box", part + ".obj"), self.path("box", name + ".obj"))
        self.run_program("plan", "box", *QUICK, "-o", "long", "-q", status=0)
        self.run_program("book", "long/plan.json", "-o", "long.html", "-q", status=0)
        self.assertIn(f"<div class=\"what\">", self.read("long.html"))
        self.assertGreaterEqual(self.read("long.html").count(name), 3, "bill of materials, contents or page, picture")
        self.run_program("book", "long/plan.json", "-o", "long.pdf", "-q", status=0)
        if shutil.which("pdftotext"):
            text = subprocess.run(["pdftotext", self.path("long.pdf"), "-"], check=True, text=True, stdout=subprocess.PIPE).stdout
            self.assertGreaterEqual(re.sub(r"\s", "", text).count(name), 2)

    def film_of(self, file):
        """What ffprobe says of the film's pictures."""
        out = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_streams", "-of", "json", file], check=True, text=True,
                             stdout=subprocess.PIPE, timeout=60).stdout
        return json.loads(out)["streams"][0]

    def test_a_film(self):
        done = self.run_program("export", "out/plan.json", "--format", "gif", "-q")
        if "built without GIF" in done.stderr:
            self.skipTest("built without giflib")
        with open(self.path("out", "assembly.gif"), "rb") as file:
            data = file.read()
        self.assertTrue(data.startswith(b"GIF89a") and data.endswith(b";"))
        without = self.run_program("export", "out/plan.json", "--format", "mp4", "-q", env={"PATH": "/nonexistent"}, status=2)
        self.assertIn("apt-get install ffmpeg", without.stderr)
        self.assertFalse(os.path.exists(self.path("out", "assembly.mp4")))
        if shutil.which("ffmpeg") and shutil.which("ffprobe"):
            self.run_program("export", "out/plan.json", "--format", "mp4", "-q", status=0)
            self.assertEqual([f for f in os.listdir(self.path("out")) if ".part" in f or f.endswith(".mp4.gif")], [])
            gif, mp4 = (self.film_of(self.path("out", "assembly" + end)) for end in (".gif", ".mp4"))
            self.assertEqual((mp4["codec_name"], mp4["pix_fmt"]), ("h264", "yuv420p"), "what every player shows")
            self.assertEqual((mp4["width"], mp4["height"]), (gif["width"], gif["height"]))
            self.assertAlmostEqual(float(mp4["duration"]), float(gif["duration"]), delta=0.2)
        self.assert_fails(2, "--disassembly is for films", "export", "out/plan.json", "--format", "dot", "--disassembly")

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
