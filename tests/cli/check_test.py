"""`dismantle check`: each place where parts overlap is named, and drawn where that is asked for."""
import json
import os
import subprocess
import unittest

import meshes
from program import PROGRAM, CliTest

HAS_PICTURES = "built without instructions" not in subprocess.run(
    [PROGRAM, "book", "none.json"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True).stderr


class Check(CliTest):
    def setUp(self):
        super().setUp()
        for name, lo, hi in (("plate", (0, 0, 0), (40, 40, 4)), ("pin", (10, 10, 3), (14, 14, 30)), ("cap", (10, 10, 30), (14, 14, 34))):
            self.write(f"parts/{name}.obj", meshes.obj(*meshes.box(lo, hi)))

    def findings(self, *options, status):
        done = self.run_program("check", "parts", "--format", "json", "-q", *options, status=status)
        return json.loads(done.stdout.splitlines()[-1])["findings"]

    def test_an_overlap_has_its_pair_depth_and_place(self):
        overlaps = [f for f in self.findings(status=1) if f["kind"] == "overlap"]
        self.assertEqual([sorted(f["parts"]) for f in overlaps], [["pin", "plate"]])
        self.assertAlmostEqual(overlaps[0]["depth"], 1, delta=0.02)
        x, y, z = overlaps[0]["at"]
        self.assertTrue(9.9 <= x <= 14.1 and 9.9 <= y <= 14.1 and 2.9 <= z <= 4.1, overlaps[0]["at"])
        self.assertNotIn("picture", overlaps[0])

    def test_warnings_alone_are_no_failure_and_what_is_left_out_is(self):
        for name, lo in (("here", (0, 0, 0)), ("there", (50, 0, 0))):
            self.write(f"loose/{name}.obj", meshes.obj(*meshes.box(lo, [x + 4 for x in lo])))
        for command in (["check", "loose"], ["plan", "loose", "-o", "out"]):
            self.run_program(*command, "-q", status=0)
        done = self.run_program("check", "loose", status=0)
        self.assertIn("0 errors", done.stdout)
        self.assertIn("touches no other part", done.stdout)
        self.write("loose/empty.obj", "v 0 0 0\n")
        for command in (["check", "loose"], ["plan", "loose", "-o", "out"]):
            self.run_program(*command, "-q", status=1)

    def test_contacts_are_in_the_words_of_a_workshop(self):
        done = self.run_program("check", "parts", status=1)
        self.assertIn("pairs of parts: 1 touching, 1 with an overlap of one depth (press fits, threads)", done.stdout)
        self.assertNotIn("kissing", done.stdout)

    def test_contacts_have_a_class(self):
        done = self.run_program("check", "parts", "--format", "json", "-q", status=1)
        result = json.loads(done.stdout.splitlines()[-1])
        contacts = {tuple(sorted(c["parts"])): c for c in result["contacts"]}
        self.assertEqual({pair: c["class"] for pair, c in contacts.items()},
                         {("pin", "plate"): "uniform_interference", ("cap", "pin"): "kissing"})
        lower, upper = contacts["pin", "plate"]["region"]
        for value, expected in zip(lower + upper, (10, 10, 3, 14, 14, 4)):
            self.assertAlmostEqual(value, expected, delta=0.5)
        self.assertNotIn("region", contacts["cap", "pin"])
        self.assertEqual([f["class"] for f in result["findings"] if f["kind"] == "overlap"], ["uniform_interference"])

    @unittest.skipUnless(HAS_PICTURES, "built without pangocairo")
    def test_the_place_is_drawn(self):
        found = [f for f in self.findings("--pictures", "places", status=1) if "picture" in f]
        self.assertEqual([f["kind"] for f in found], ["overlap"])
        with open(self.path(found[0]["picture"]), "rb") as file:
            self.assertTrue(file.read().startswith(b"\x89PNG\r\n"))
        self.assertEqual(os.listdir(self.path("places")), [os.path.basename(found[0]["picture"])])

    @unittest.skipUnless(HAS_PICTURES, "built without pangocairo")
    def test_the_gallery_has_a_picture_and_a_line_for_each_kind_of_part(self):
        self.findings("--gallery", "kinds.html", status=1)
        with open(self.path("kinds.html"), encoding="utf-8") as file:
            html = file.read()
        self.assertGreater(html.count("data:image/png;base64,"), 0)
        self.assertEqual(html.count("data:image/png;base64,"), html.count("<pre>parts:"))
