"""--up and layout.up: the same words in every command, and the plan's word in what is made of it."""
import json
import re

from program import CliTest

# Without best_order, which prefers what leaves upwards, the peg always leaves along +z.
QUICK = ("--set", "immobility.provers=[]", "--set", "run.best_order=false", "--timeout", "0")


class Up(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "peg_in_hole", "-o", "peg", status=0)

    def planned(self, folder, *options):
        self.run_program("plan", "peg", "-o", folder, *QUICK, *options, status=0)
        return json.loads(self.read(folder, "plan.json"))

    def motion(self, *options):
        table = self.run_program("export", *options, "--format", "markdown", "-o", "-", status=0).stdout
        return re.search(r"units ([a-z ]+ \(.\w\))", table).group(1)

    def test_what_is_made_of_a_plan_has_the_up_of_the_plan(self):
        self.assertEqual(self.planned("z")["objective"]["up"], [0, 0, 1], "auto")
        for written, up in (("-x", [-1, 0, 0]), ("y", [0, 1, 0]), ("0,0,-2", [0, 0, -1])):
            with self.subTest(written):
                plan = self.planned("out", "--up", written)
                self.assertEqual(plan["objective"]["up"], up)
                self.assertIn(json.dumps(up).replace(" ", ""), self.read("out", "index.html").replace(" ", ""))
        plan["disassembly"][0].pop("up", None)  # it lies as drawn
        self.write("out/plan.json", json.dumps(plan))
        self.assertEqual(self.motion("out/plan.json"), "down (+Z)")
        self.assertEqual(self.motion("out/plan.json", "--up", "z"), "up (+Z)")
        self.assertEqual(self.motion("out/plan.json", "--up=-y"), self.motion("out/plan.json", "--up", "0,-1,0"))

    def test_the_parts_are_laid_out_on_the_ground(self):
        for up, axis, sign in (("z", 2, 1), ("-z", 2, -1), ("x", 0, 1)):
            with self.subTest(up):
                plan = self.planned("out", "--up", up, "--set", "objective=[]")
                self.assertEqual(plan["assembly_status"], "complete")
                steps = plan["assembly_steps"]
                first = {move["part"]: move["poses"][0][axis] for step in steps for move in step["moves"]}
                self.assertTrue(all(sign * height <= 1e-9 for height in first.values()), "what waits is not in the air")

    def test_no_command_takes_what_is_no_direction(self):
        self.planned("out")
        for command in (("plan", "peg"), ("check", "peg"), ("stability", "peg"), ("export", "out/plan.json", "--format", "dot"),
                        ("book", "out/plan.json")):
            for wrong in ("w", "0,0,0", "1,2"):
                with self.subTest(command, wrong=wrong):
                    failed = self.run_program(*command, f"--up={wrong}", status=2)
                    self.assertIn("x, y, z, -x, -y, -z or X,Y,Z", failed.stderr)
            for right in ("-z", "y", "0,1,1"):
                with self.subTest(command, right=right):
                    self.assertNotEqual(self.run_program(*command, "--up", right, "-q").returncode, 2)
        self.write("up.yaml", "layout: {up: sideways}\n")
        failed = self.run_program("plan", "peg", "-c", "up.yaml", status=2)
        self.assertIn("up.yaml:1:14: error: layout.up: 'sideways' is no direction", failed.stderr)
