"""Whatever the input is: a message that names the file or part, the right status, nothing that crashes or hangs."""
import json
import os
import random
import struct

import meshes
from program import CliTest

UNIT = meshes.box((0, 0, 0), (1, 1, 1))
BESIDE = meshes.box((1, 0, 0), (2, 1, 1))
ABOVE = meshes.box((0, 0, 1), (1, 1, 2))
QUICK = ("--path-timeout", "0", "--timeout", "0", "--set", "run.path_steps=2000")


class BadInput(CliTest):
    def put(self, name, content):
        """A file below the test's folder; text or bytes."""
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())

    def folder_with(self, name, *parts):
        """A folder of boxes, part after part as (file name, content)."""
        for file, content in parts:
            self.put(f"{name}/{file}", content)
        return name

    def prepared(self, folder, *options, status=0):
        """prepare.json of a folder that can be used, and what was said. Status 1: some parts cannot."""
        done = self.run_program("prepare", folder, "-o", "clean", "--format", "json", *options, status=status)
        report = json.loads(self.read("clean", "prepare.json"))
        return {p["name"]: p for p in report["parts"]}, done.stderr, self.result_of(done)

    def planned_and_verified(self, folder):
        done = self.run_program("plan", folder, *QUICK, "-o", folder + ".out", "--format", "json", status=0)
        self.run_program("verify", folder + ".out/plan.json", "-q", status=0)
        return done.stderr


class Files(BadInput):
    def test_each_format_is_read(self):
        for k, (ending, writer) in enumerate(meshes.FORMATS):
            folder = self.folder_with(f"ok{k}", (f"a.{ending}", writer(*UNIT)), ("b.obj", meshes.obj(*BESIDE)))
            parts, _, _ = self.prepared(folder)
            self.assertAlmostEqual(parts["a"]["volume"], 1, 5, writer.__name__)

    def test_files_that_are_cut_off(self):
        for k, (ending, writer) in enumerate(meshes.FORMATS):
            whole = writer(*UNIT)
            for share in (0.02, 0.35, 0.6, 0.9):
                folder = self.folder_with(f"cut{k}-{share}", (f"a.{ending}", whole[:int(share * len(whole))]), ("b.obj", meshes.obj(*BESIDE)))
                # With one part of two left there is no assembly, so that OBJ, which has no end mark, is refused too.
                done = self.run_program("plan", folder, *QUICK, status=3)
                self.assertRegex(done.stderr, rf"a\.{ending}:|\n  a: ", writer.__name__)
                self.assertFalse(os.path.exists(self.path(folder + ".plan")))

    def test_files_that_are_something_else(self):
        noise = random.Random(5).randbytes(4000)
        for k, (ending, _) in enumerate(meshes.FORMATS):
            for what, content in (("noise", noise), ("nothing", b""), ("page", b"<!DOCTYPE html><html><body>404</body></html>\n")):
                folder = self.folder_with(f"{what}{k}", (f"a.{ending}", content), ("b.obj", meshes.obj(*BESIDE)), ("c.obj", meshes.obj(*ABOVE)))
                self.assert_left_out(folder, f"a.{ending}")

    def assert_left_out(self, folder, file):
        """The part of this file is left out by name, whatever is asked; the others are planned."""
        parts, said, result = self.prepared(folder, status=1)
        name = file.split(".")[0]
        self.assertFalse(parts[name]["kept"])
        self.assertIn(file, parts[name]["reason"])
        self.assertIn(f"'{name}' is left out", said)
        self.assertEqual((result["status"], result["unusable"]), ("partial", [name]))

    def test_headers_that_promise_too_much(self):
        many = 4000000000
        stl = bytes(80) + struct.pack("<I", many) + bytes(200)
        ply = meshes.ply_text(*UNIT).replace("vertex 8", f"vertex {many}").replace("face 12", f"face {many}")
        off = meshes.off(*UNIT).replace("8 12 0", f"{many} {many} 0", 1)
        for file, content in (("a.stl", stl), ("a.ply", ply), ("a.off", off), ("a.obj", meshes.obj(*UNIT) + "f 1 2 99999999999999999999\n")):
            folder = self.folder_with(file + ".in", (file, content), ("b.obj", meshes.obj(*BESIDE)), ("c.obj", meshes.obj(*ABOVE)))
            done = self.run_program("prepare", folder, "-o", "clean")
            self.assertIn(done.returncode, (1, 3))
            self.assertIn(file, done.stderr)

    def test_ten_million_triangles_are_refused_before_they_are_read(self):
        self.folder_with("big", ("a.stl", bytes(80) + struct.pack("<I", 10**7)), ("b.obj", meshes.obj(*BESIDE)))
        os.truncate(self.path("big", "a.stl"), 84 + 50 * 10**7)  # a hole on the disk
        done = self.run_program("plan", "big", "--format", "json", status=3)
        self.assertIn("a.stl: 10000000 triangles are more than the limit of 5000000 (assembly.max_triangles)", done.stderr)
        self.assertLess(self.result_of(done)["peak_rss_mb"], 400)

    def test_links_pipes_and_folders_that_are_called_like_meshes(self):
        self.folder_with("in", ("b.obj", meshes.obj(*UNIT)), ("c.obj", meshes.obj(*BESIDE)))
        os.mkfifo(self.path("in", "a.obj"))
        os.mkdir(self.path("in", "d.obj"))
        self.put("in/d.obj/inside.obj", meshes.obj(*ABOVE))
        _, said, _ = self.prepared("in", status=1)
        self.assertIn("part 'a.obj' is left out: it is no regular file", said)
        self.assertIn("part 'd.obj/' is left out: sub-folders are not read", said)
        for gone in ("a.obj", "d.obj/inside.obj"):
            os.remove(self.path("in", *gone.split("/")))
        os.rmdir(self.path("in", "d.obj"))
        os.symlink("nowhere.obj", self.path("in", "e.obj"))
        self.assert_left_out("in", "e.obj")

    def test_what_cannot_be_used_is_said_everywhere(self):
        self.folder_with("in", ("a.obj", "v 0 0\n"), ("b.obj", meshes.obj(*BESIDE)), ("c.obj", meshes.obj(*ABOVE)),
                         ("d.obj", meshes.obj(UNIT[0], UNIT[1][:6])))
        exclude = ("--set", "assembly.open=exclude")
        done = self.run_program("plan", "in", *QUICK, *exclude, "-o", "out", "--format", "json", status=1)
        result = self.result_of(done)
        self.assertEqual((result["status"], result["parts"], result["unusable"]), ("partial", 2, ["a", "d"]))
        self.assertIn("left out: a: a.obj cannot be read: ", done.stderr)
        self.assertIn("left out: d: not watertight", done.stderr)
        self.assertIn("2 of 4 parts could not be used", done.stderr)
        self.run_program("plan", "in", *QUICK, *exclude, "-o", "out", "-q", status=1)
        plan = json.loads(self.read("out", "plan.json"))
        self.assertEqual([e["name"] for e in plan["assembly"]["excluded"]], ["a", "d"])
        verified = self.run_program("verify", "out/plan.json", "--format", "json", status=1)
        self.assertEqual(self.result_of(verified)["status"], "partial", "as plan says")
        # What the user leaves out is no defect.
        self.run_program("plan", "in", *QUICK, "-o", "out", "-q", "--set", "constraints.ignore=[a, d]", status=0)

    def test_results_among_the_input_are_no_parts(self):
        self.folder_with("in", ("b.obj", meshes.obj(*BESIDE)), ("c.obj", meshes.obj(*ABOVE)))
        first = self.result_of(self.run_program("plan", "in", *QUICK, "-o", "in", "--format", "json", status=0))
        os.rename(self.path("in", "plan.glb"), self.path("in", "renamed.glb"))
        done = self.run_program("plan", "in", *QUICK, "-o", "in", "--format", "json", status=0)
        self.assertEqual(self.result_of(done)["parts"], first["parts"])
        self.assertIn("'renamed.glb' is left out: it is the animation of a plan", done.stderr)
        self.assert_fails(2, "is the input itself", "prepare", "in", "-o", "in")

    def test_a_part_that_is_not_there_is_refused_before_anything_is_prepared(self):
        self.folder_with("in", ("housing.obj", meshes.obj(*UNIT)), ("shaft.obj", meshes.obj(*BESIDE)))
        done = self.assert_fails(3, "has no part 'shafd'; did you mean 'shaft'?", "plan", "in", "--part", "shafd")
        self.assertNotIn("preparing", done.stderr)
        self.assert_fails(3, "its parts: 'housing', 'shaft'", "plan", "in", "--part", "zzzzzzz")


class Surfaces(BadInput):
    def beside_two(self, vertices, triangles):
        return self.folder_with("in", ("a.obj", meshes.obj(vertices, triangles)), ("b.obj", meshes.obj(*BESIDE)), ("c.obj", meshes.obj(*ABOVE)))

    def test_coordinates_that_are_no_numbers(self):
        for ending, writer in meshes.FORMATS[:6]:
            broken = ([(float("nan"), 0.0, 0.0)] + UNIT[0][1:], UNIT[1])
            self.folder_with("nan." + ending, (f"a.{ending}", writer(*broken)), ("b.obj", meshes.obj(*BESIDE)), ("c.obj", meshes.obj(*ABOVE)))
            parts, _, _ = self.prepared("nan." + ending, status=1)
            self.assertIn(f"a.{ending}", parts["a"]["reason"])

    def test_what_has_no_inside_is_left_out_by_name(self):
        flat = ([(x, y, 0.0) for x, y, _ in UNIT[0]], UNIT[1])
        self.beside_two(*flat)
        parts, said, result = self.prepared("in", "--set", "assembly.open=exclude", status=1)
        self.assertFalse(parts["a"]["kept"])
        self.assertIn("no volume", parts["a"]["reason"])
        self.assertIn("'a' is left out", said)
        self.assertEqual((result["parts"], result["excluded"]), (2, 1))
        self.run_program("plan", "in", *QUICK, "--set", "assembly.open=exclude", "-o", "out", "-q", status=1)
        self.assertEqual([e["name"] for e in json.loads(self.read("out", "plan.json"))["assembly"]["excluded"]], ["a"])

    def test_a_surface_that_is_not_closed_is_a_wall_or_left_out(self):
        self.beside_two(UNIT[0], UNIT[1][:6])
        parts, _, result = self.prepared("in", status=0)
        self.assertTrue(parts["a"]["kept"])
        self.assertIn("not watertight", parts["a"]["open"])
        self.assertEqual((result["parts"], result["excluded"]), (3, 0))
        done = self.run_program("plan", "in", *QUICK, "-o", "out", status=0)
        self.assertIn("open: a: its surface is not closed, and is a wall", done.stdout + done.stderr)
        assembly = json.loads(self.read("out", "plan.json"))["assembly"]
        self.assertEqual([p["name"] for p in assembly["parts"] if p.get("open")], ["a"])
        self.run_program("verify", "out/plan.json", status=0)
        checked = self.result_of(self.run_program("check", "in", "--format", "json"))
        self.assertEqual([f["parts"] for f in checked["findings"] if f["kind"] == "open"], [["a"]])
        done = self.run_program("plan", "in", *QUICK, "-o", "out", "--set", "assembly.open=exclude", status=1)
        self.assertIn("left out: a: not watertight", done.stdout + done.stderr)

    def test_faces_the_wrong_way_round_are_turned(self):
        some = [t[::-1] if i % 3 else t for i, t in enumerate(UNIT[1])]
        for triangles in (some, [t[::-1] for t in UNIT[1]]):
            self.beside_two(UNIT[0], triangles)
            parts, _, _ = self.prepared("in")
            self.assertAlmostEqual(parts["a"]["volume"], 1)
            self.assertIn("turned", " ".join(parts["a"]["actions"]))

    def test_a_surface_that_crosses_itself_is_kept_with_a_warning(self):
        self.beside_two(UNIT[0][:7] + [(0.3, 0.4, -1.0)], UNIT[1])  # a corner pulled out through the face below
        _, said, _ = self.prepared("in")
        self.assertIn("part 'a': the surface crosses itself", said)

    def test_copies(self):
        self.folder_with("in", *((f"{n}.obj", meshes.obj(*UNIT)) for n in "abc"))
        done = self.assert_fails(3, "at least two", "plan", "in")
        self.assertIn("b: ", done.stderr)


class NamesAndScales(BadInput):
    def test_any_name(self):
        names = ("pär t", "部品 2", "it's \"q\" & <b>", "a.b.c")
        self.folder_with("in", *((f"{n}.obj", meshes.obj(*meshes.box((0, 0, z), (1, 1, z + 1)))) for z, n in enumerate(names)))
        self.planned_and_verified("in")
        plan = json.loads(self.read("in.out", "plan.json"))
        self.assertEqual(sorted(p["name"] for p in plan["assembly"]["parts"]), sorted(names))
        self.assertEqual(len(plan["disassembly"]), 3)
        self.prepared("in")

    def test_a_name_that_is_not_utf8(self):
        self.folder_with("in", ("b.obj", meshes.obj(*BESIDE)))
        with open(os.path.join(self.path("in").encode(), b"caf\xe9.obj"), "w", encoding="ascii") as file:
            file.write(meshes.obj(*UNIT))
        self.planned_and_verified("in")
        self.assertIn("caf\ufffd", self.read("in.out", "plan.json"))

    def test_two_files_of_one_name(self):
        self.folder_with("in", ("a.obj", meshes.obj(*UNIT)), ("a.stl", meshes.stl(*BESIDE)))
        self.assertIn("several files are called 'a'", self.planned_and_verified("in"))
        plan = json.loads(self.read("in.out", "plan.json"))
        self.assertEqual([p["name"] for p in plan["assembly"]["parts"]], ["a.obj", "a.stl"])

    def test_any_scale(self):
        for scale in (1e-9, 1e12):
            folder = f"scale{scale:g}"
            for name, (vertices, triangles) in (("a", UNIT), ("b", BESIDE)):
                self.put(f"{folder}/{name}.obj", meshes.obj([tuple(scale * x for x in v) for v in vertices], triangles))
            self.planned_and_verified(folder)

    def test_far_from_the_origin_and_from_each_other(self):
        self.folder_with("off", *((f"{n}.obj", meshes.obj(*meshes.box((1e9 + x, 0, 0), (1e9 + x + 1, 1, 1)))) for n, x in (("a", 0), ("b", 1))))
        self.assertIn("digits of its shape", self.planned_and_verified("off"))
        self.folder_with("far", ("a.obj", meshes.obj(*UNIT)), ("b.obj", meshes.obj(*meshes.box((1e6, 0, 0), (1e6 + 1, 1, 1)))))
        self.assertIn("'b' floats apart", self.planned_and_verified("far"))


class Output(BadInput):
    def setUp(self):
        super().setUp()
        self.folder_with("in", ("a.obj", meshes.obj(*UNIT)), ("b.obj", meshes.obj(*BESIDE)))

    def test_a_standard_output_that_is_full(self):
        for command in (["plan", "in", *QUICK], ["plan", "in", *QUICK, "--format", "json"], ["sample", "list"], ["plugins", "list"], ["--help"]):
            with open("/dev/full", "w", encoding="ascii") as full:
                done = self.run_program(*command, stdout=full, status=2)
            self.assertIn("standard output cannot be written", done.stderr)
        self.run_program("verify", "in.plan/plan.json", "-q", status=0)  # the plan itself is there

    def test_closed_streams_do_not_end_up_in_files(self):
        done = self.run_program("plan", "in", *QUICK, status=0, preexec_fn=lambda: os.closerange(0, 3))
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        self.run_program("verify", "in.plan/plan.json", "-q", status=0)

    def test_folders_that_cannot_be_written(self):
        for command in (["plan", "in", *QUICK], ["prepare", "in"], ["sample", "peg_in_hole"]):
            self.assert_fails(2, "/dev/full", *command, "-q", "-o", "/dev/full")
            self.assert_fails(2, "/proc", *command, "-q", "-o", "/proc/nothing/here")
