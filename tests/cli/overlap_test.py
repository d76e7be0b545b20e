"""Assemblies as they come from CAD, whose parts overlap: what comes apart, what is forced, and what the plan says of it."""
import json
import math
import re

from program import CliTest

# Sample, forced steps, and the class of the contact that decides.
SAMPLES = [
    ("pressed_pin", 0, "uniform_interference"),
    ("plain_bore_screw", 0, "uniform_interference"),
    ("same_plate_twice", 0, None),
    ("spring_between_seats", 0, "local_interference"),
    ("gear_pair", 0, "local_interference"),
    ("o_ring", 0, "uniform_interference"),
    ("part_in_solid", 1, "inside"),
]


def turned(rings, closed, around=48):
    """OBJ of a surface through rings (height, radius, corners; 0 corners: round); closed: from the last to the first, else
    with flat ends."""
    points = []
    for z, r, corners in rings:
        for i in range(around):
            a, s = 2 * math.pi * i / around, 2 * math.pi / corners if corners else 0
            at = r / math.cos((a + s / 2) % s - s / 2) if corners else r
            points.append((at * math.cos(a), at * math.sin(a), z))
    faces = []
    for k in range(len(rings) if closed else len(rings) - 1):
        a, b = k * around + 1, (k + 1) % len(rings) * around + 1
        for i, j in ((i, (i + 1) % around) for i in range(around)):
            faces += [(a + i, a + j, b + j), (a + i, b + j, b + i)]
    if not closed:
        points += [(0, 0, rings[0][0]), (0, 0, rings[-1][0])]
        top = (len(rings) - 1) * around + 1
        for i, j in ((i, (i + 1) % around) for i in range(around)):
            faces += [(len(points) - 1, 1 + j, 1 + i), (top + i, top + j, len(points))]
    return "".join("v %.9g %.9g %.9g\n" % p for p in points) + "".join("f %d %d %d\n" % f for f in faces)


def revolved(profile, closed, around=48):
    """Lines of an LDraw file: a surface of revolution about x through the corners (x, radius) of a profile that goes round
    counter-clockwise (closed), or from end to end (flat ends)."""
    def ring(x, r):
        return [(x, r * math.cos(2 * math.pi * i / around), r * math.sin(2 * math.pi * i / around)) for i in range(around)]

    def line(*corners):
        return "%d 16 %s\n" % (len(corners), " ".join("%.6f" % v for p in corners for v in p))
    rings, out = [ring(*p) for p in profile], "0 BFC CERTIFY CCW\n"
    for a, b in zip(rings, rings[1:] + (rings[:1] if closed else [])):
        out += "".join(line(a[i], a[(i + 1) % around], b[(i + 1) % around], b[i]) for i in range(around))
    for end, step in () if closed else ((rings[0], -1), (rings[-1], 1)):
        middle = (end[0][0], 0, 0)
        out += "".join(line(middle, end[i], end[(i + step) % around]) for i in range(around))
    return out


class Overlap(CliTest):
    def plan(self, name, *options, status):
        self.run_program("plan", name, "-o", "out", "--threads", "1", "-q", *options, status=status)
        return json.loads(self.read("out", "plan.json"))

    def test_samples_end_as_their_truth_says(self):
        for name, forced, contact in SAMPLES:
            with self.subTest(name):
                self.run_program("sample", name, "-o", name, "-q", status=0)
                plan = self.plan(name, status=1 if forced else 0)
                self.assertEqual(plan["status"], "forced" if forced else "complete")
                self.assertEqual(sum("forced" in step for step in plan["disassembly"]), forced)
                self.assertEqual(plan["remaining"], plan["remaining"][:1])
                if contact:
                    self.assertIn(contact, [o.get("class") for o in plan["assembly"]["overlaps"]])
                verified = self.run_program("verify", "out/plan.json", "--format", "json", "-q", status=1 if forced else 0)
                self.assertEqual(json.loads(verified.stdout.splitlines()[-1])["status"], plan["status"])
                off = self.plan(name, "--set", "run.force=off", status=1 if forced else 0)
                self.assertEqual(off["status"], "partial" if forced else "complete")
                if not forced:
                    self.assertEqual([s["moves"] for s in off["disassembly"]], [s["moves"] for s in plan["disassembly"]])

    def test_a_region_that_is_not_there_is_refused(self):
        self.run_program("sample", "spring_between_seats", "-o", "in", "-q", status=0)
        plan = self.plan("in", status=0)
        named = [o for step in plan["disassembly"] for o in step.get("overlaps", [])]
        self.assertTrue(named)
        for overlap in named:
            overlap["region"] = [[-50, -50, -50], [50, 50, 50]]
        self.write("false.json", json.dumps(plan))
        done = self.run_program("verify", "false.json", status=1)
        self.assertIn("there is no such place", done.stderr + done.stdout)

    def test_what_the_user_accepts_is_complete_and_no_more_than_that(self):
        self.run_program("sample", "part_in_solid", "-o", "in", "-q", status=0)
        forced = self.plan("in", status=1)["disassembly"][0]["forced"]
        part, against = forced["pair"]
        for share, other, status in ((1.01, against, 0), (0.9, against, 1)):
            self.write("accept.yaml", "schema: 1\nconstraints:\n  accept: [{part: %s, against: %s, as: snap, depth: %r}]\n"
                       % (part, other, share * forced["depth"]))
            plan = self.plan("in", "-c", "accept.yaml", status=status)
            self.assertEqual(plan["status"], "forced" if status else "complete")
            self.assertEqual(plan["disassembly"][0]["forced"].get("accepted"), None if status else "snap")
            self.run_program("verify", "out/plan.json", "-q", status=status)
            if status == 0:
                self.assertIn("accepted as snap", self.run_program("explain", "out/plan.json").stdout)
                self.assertNotIn("color=red", self.read("out", "precedence.dot"))

    def test_a_depth_that_is_stated_too_small_is_refused(self):
        self.run_program("sample", "part_in_solid", "-o", "in", "-q", status=0)
        plan = self.plan("in", status=1)
        true = plan["disassembly"][0]["forced"]["depth"]
        for share, wrong in ((0.95, False), (0.5, True), (1e-9, True)):
            for step in plan["disassembly"] + plan["assembly_steps"]:
                step["forced"]["depth"] = share * true
            self.write("said.json", json.dumps(plan))
            done = self.run_program("verify", "said.json", status=1)
            self.assertEqual("NOT VALID" in done.stdout, wrong, share)

    def test_an_acceptance_says_all_of_it(self):
        self.run_program("sample", "part_in_solid", "-o", "in", "-q", status=0)
        for entry in ("{part: block, against: insert, depth: 1}", "{part: block, against: insert, as: snap, depth: 0}",
                      "{part: block, against: block, as: snap, depth: 1}", "block"):
            self.write("wrong.yaml", "schema: 1\nconstraints:\n  accept: [%s]\n" % entry)
            done = self.run_program("plan", "in", "-c", "wrong.yaml", "-o", "out", status=2)
            self.assertIn("wrong.yaml:3:12: error: constraints.accept must be a list of", done.stderr)

    def test_a_forced_step_names_pair_depth_and_place_everywhere(self):
        self.run_program("sample", "part_in_solid", "-o", "in", "-q", status=0)
        done = self.run_program("plan", "in", "-o", "out", "--threads", "1", status=1)
        self.assertIn("FORCED: ", done.stderr + done.stdout)
        plan = json.loads(self.read("out", "plan.json"))
        forced = plan["disassembly"][0]["forced"]
        self.assertEqual(len(forced["pair"]), 2)
        self.assertGreater(forced["depth"], 0)
        self.assertGreater(forced["assembled"], 0)
        self.assertIn("color=red", self.read("out", "precedence.dot"))
        self.assertIn("FORCED", self.run_program("explain", "out/plan.json", status=0).stdout)
        forced["depth"] *= 2  # a false statement is refused
        self.write("out/plan.json", json.dumps(plan))
        done = self.run_program("verify", "out/plan.json", status=1)
        self.assertIn("measured", done.stderr + done.stdout)

    def test_flexible_parts_are_recognised_and_named(self):
        for name, part, kind in [("o_ring", "ring", "loop"), ("spring_between_seats", "spring", "coil")]:
            with self.subTest(name):
                self.run_program("sample", name, "-o", name, "--set", "rotate_seed=3", "-q", status=0)
                plan = self.plan(name, status=0)
                flexible = {p["name"]: p["flexible"] for p in plan["assembly"]["parts"] if "flexible" in p}
                self.assertEqual(flexible, {part: kind})
                self.assertEqual({part in (o["a"], o["b"]) for o in plan["assembly"]["overlaps"]}, {True})
                self.assertTrue(all(o["flexible"] and o["declared"] > o["depth"] for o in plan["assembly"]["overlaps"]))
                self.run_program("verify", "out/plan.json", "-q", status=0)
                check = self.run_program("check", name, "--format", "json", "-q")
                found = json.loads(check.stdout.splitlines()[-1])["findings"]
                self.assertEqual([f["parts"] for f in found if f["kind"] == "flexible"], [[part]])
        plan = self.plan("o_ring", "--set", "assembly.flexible=declared", status=1)
        self.assertEqual(plan["status"], "forced")
        self.assertFalse([p for p in plan["assembly"]["parts"] if "flexible" in p])

    def test_a_band_of_rubber_needs_no_force(self):
        self.write("model/library/parts/band.dat", "0 Band\n0 !LDRAW_ORG Part\n" + revolved(
            [(-8, 10), (8, 10), (8, 20), (-8, 20)], closed=True))
        self.write("model/library/parts/wheel.dat", "0 Wheel\n0 !LDRAW_ORG Part\n" + revolved(
            [(-12, 13), (-8.1, 13), (-8.1, 9.9), (8.1, 9.9), (8.1, 13), (12, 13)], closed=False))
        self.write("model/library/LDConfig.ldr", "0 !COLOUR Black CODE 0 VALUE #1B2A34 EDGE #808080\n"
                   "0 !COLOUR Rubber_Black CODE 256 VALUE #1B2A34 EDGE #808080 RUBBER\n")
        for colour in (0, 256):
            self.write("model/car.ldr", "0 Car\n1 %d 0 0 0 1 0 0 0 1 0 0 0 1 band.dat\n"
                       "1 0 0 0 0 1 0 0 0 1 0 0 0 1 wheel.dat\n" % colour)
            check = self.run_program("check", "model/car.ldr", "--format", "json", "-q")
            found = json.loads(check.stdout.splitlines()[-1])["findings"]
            self.assertEqual([f["parts"] for f in found if f["kind"] == "flexible"], [["Band"]] if colour else [])
        plan = self.plan("model/car.ldr", status=0)
        self.assertEqual(plan["status"], "complete")
        self.assertEqual([p.get("flexible") for p in plan["assembly"]["parts"]], ["material", None])
        self.assertTrue(plan["assembly"]["overlaps"][0]["flexible"])
        self.run_program("verify", "out/plan.json", "-q", status=0)
        # Not believed of a file that does not say so.
        self.write("model/car.ldr", self.read("model", "car.ldr").replace("1 256 ", "1 0 "))
        refused = self.run_program("verify", "out/plan.json", status=3)
        plan["assembly"]["sha256"] = re.search("SHA-256 is ([0-9a-f]{64})", refused.stderr).group(1)
        self.write("out/plan.json", json.dumps(plan))
        done = self.run_program("verify", "out/plan.json", status=1)
        self.assertIn("for flexible, and neither the file nor their shape and contact say so", done.stderr + done.stdout)

    def test_that_a_rigid_part_is_flexible_is_not_believed(self):
        self.run_program("sample", "pressed_pin", "-o", "in", "-q", status=0)
        plan = self.plan("in", status=0)
        plan["assembly"]["parts"][1]["flexible"] = "coil"
        plan["assembly"]["overlaps"][0].update({"flexible": True, "declared": 1.0})
        self.write("out/plan.json", json.dumps(plan))
        done = self.run_program("verify", "out/plan.json", status=1)
        self.assertIn("for flexible, and neither the file nor their shape and contact say so", done.stderr + done.stdout)

    def test_what_the_user_allows_needs_no_force_and_is_named(self):
        self.run_program("sample", "o_ring", "-o", "in", "-q", status=0)
        self.write("run.yaml", "schema: 1\nconstraints: {flexible: [ring]}\n")
        plan = self.plan("in", "-c", "run.yaml", status=0)
        self.assertEqual(plan["status"], "complete")
        named = [o for step in plan["disassembly"] for o in step.get("overlaps", [])]
        self.assertEqual({p["name"]: p.get("flexible") for p in plan["assembly"]["parts"]}["ring"], "declared")
        self.assertTrue(any("ring" in o["pair"] and o["depth"] > o["assembled"] for o in named), named)
        self.run_program("verify", "out/plan.json", "-q", status=0)

    def test_a_screw_that_cuts_deeper_says_that_it_cuts_its_thread(self):
        """A screw with a neck below its head; the mouth of its bore is narrower than where its thread is."""
        screw = [(-16, 3, 0), (-6, 3, 0), (-6, 2.4, 0), (0, 2.4, 0), (0, 5, 6), (4, 5, 6)]
        block = [(-22, 2.75, 0), (-22, 10, 4), (0, 10, 4), (0, 2.6, 0), (-4, 2.6, 0), (-4, 2.75, 0)]
        self.write("in/screw_M6x16.obj", turned(screw, False))
        self.write("in/block.obj", turned(block, True))
        words = "'screw_M6x16' cuts its thread, 0.4 mm deep, into 'block' (0.25 mm when assembled)"
        self.write("run.yaml", "schema: 1\nconstraints: {overlap: [{parts: [screw_M6x16, block], depth: 0.45}]}\n")
        done = self.run_program("plan", "in", "-o", "out", "-c", "run.yaml", "--unit", "mm", "--threads", "1", status=0)
        self.assertIn(words, done.stdout + done.stderr)
        self.assertIn(words, self.read("out", "index.html"))
        self.run_program("book", "out/plan.json", "-o", "book.html", "-q", status=0)
        self.assertIn("cuts its thread, 0.4 mm deep", self.read("book.html"))
        self.run_program("verify", "out/plan.json", "-q", status=0)
