"""The same input, configuration and seed give the same plan: twice, and on one thread and on two. Times alone may differ."""
import os
import re
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["DISMANTLE"]
DATA = os.environ.get("DISMANTLE_DATA") or os.path.join(os.path.dirname(os.path.abspath(os.environ["SOURCE_FOLDER"])), "shared", "data")
COUNTED = ("--path-timeout", "0", "--timeout", "0")  # no seconds may decide
SHORT = ("--set", "run.path_steps=500")
VIEWER = os.path.exists(os.path.join(os.path.dirname(PROGRAM), "..", "share", "dismantle", "viewer.html"))  # was it built
FILES = ("plan.json", "plan.glb", "precedence.dot") + ("index.html",) * VIEWER


class Determinism(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dismantle-determinism-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def call(self, *arguments):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        self.assertIn(done.returncode, (0, 1), f"{arguments}\n{done.stdout}\n{done.stderr}")

    def content(self, run, file):
        with open(os.path.join(self.folder, run, file), "rb") as opened:
            return re.sub(rb'"seconds": ?[^,]*', b"", opened.read())

    def same_every_time(self, assembly, *options):
        for run, threads in (("one", 1), ("again", 1), ("two", 2)):
            self.call("plan", assembly, *COUNTED, *options, "--seed", "7", "--threads", str(threads), "-q", "-o", run)
        for file in FILES:
            for run in ("again", "two"):
                a, b = self.content("one", file), self.content(run, file)
                if a != b:
                    at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
                    self.fail(f"{assembly}: {file} of runs 'one' and '{run}' differ at byte {at}: {a[at - 60:at + 60]!r}, {b[at - 60:at + 60]!r}")


class Samples(Determinism):
    def sample(self, name, *options, **parameters):
        given = [a for key, value in parameters.items() for a in ("--set", f"{key}={value}")]
        self.call("sample", name, "-o", name, *given)
        self.same_every_time(name, *options)

    def test_machine(self):
        self.sample("machine", parts=4)

    def test_stacked_box(self):
        self.sample("stacked_box")

    def test_l_slot(self):
        self.sample("l_slot")

    def test_turning(self):
        self.sample("peg_in_hole", "--set", "path_planner.of.contact_search.motion=rotation")

    def test_random_order(self):
        self.sample("machine", "--sequence-planner", "random", *SHORT, parts=4)

    def test_queue(self):
        self.sample("machine", "--sequence-planner", "queue", *SHORT, parts=4)

    def test_what_does_not_come_out(self):
        self.sample("closed_box", *SHORT)


class Data(Determinism):
    """Real assemblies, where they are: $DISMANTLE_DATA, else the folder shared/data beside the source folder."""

    def entry(self, name):
        path = os.path.join(DATA, name)
        if not os.path.isdir(path):
            self.skipTest(f"{path} is not there; DISMANTLE_DATA names the folder of assemblies")
        self.same_every_time(path, "--set", "run.path_steps=200000")

    def test_as1_oc_214(self):
        self.entry("cad/as1_oc_214")

    def test_dm1_id_214(self):
        self.entry("cad/dm1_id_214")

    def test_oshchip_case(self):
        self.entry("cad/oshchip_case")

    def test_zslot_4step(self):
        self.entry("two_part/zslot_4step")
