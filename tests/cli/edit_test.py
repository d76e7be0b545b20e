"""Edits of a plan: verified, numbered again, never over the plan itself."""
import json

from program import CliTest, box


class Edit(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "stacked_box", "-o", "in", "-q", status=0)
        self.run_program("plan", "in", "-o", "out", "-q", status=0)

    def plan(self, folder="out"):
        return json.loads(self.read(folder, "plan.json"))

    def leaving(self, folder="out"):
        return [s["separates"][0][0] for s in self.plan(folder)["disassembly"]]

    def edit(self, *arguments, status=0):
        return self.run_program("edit", "out/plan.json", *arguments, "-o", "new", "--format", "json", status=status)

    def dependent(self):
        for step in self.plan()["disassembly"]:
            if step.get("after"):
                return max(step["after"]), step["step"]
        self.fail("no step of this plan waits for another")

    def test_the_same_order_gives_the_same_plan_by_numbers_and_by_file(self):
        steps = len(self.leaving())
        before = self.read("out", "plan.json")
        self.edit("--order", ",".join(str(k + 1) for k in range(steps)))
        self.assertEqual(self.leaving("new"), self.leaving())
        for new, old in zip(self.plan("new")["disassembly"], self.plan()["disassembly"]):
            for a, b in zip(new["moves"], old["moves"]):
                self.assertEqual((a["part"], len(a["poses"])), (b["part"], len(b["poses"])))
                for p, q in zip(a["poses"], b["poses"]):
                    for x, y in zip(p, q):
                        self.assertAlmostEqual(x, y, 9)
        self.write("same.csv", "step,part\n" + "".join(f"{k},{p}\n" for k, p in enumerate(reversed(self.leaving()))))
        self.edit("--order", "same.csv")
        self.assertEqual(self.leaving("new"), self.leaving())
        self.assertEqual(self.read("out", "plan.json"), before)
        self.run_program("verify", "new/plan.json", status=0)

    def test_steps_that_do_not_wait_change_places(self):
        for k in range(4):
            self.write(f"blocks/block_{k}.obj", box((3 * k, 0, 1), (3 * k + 2, 2, 3)))
        self.write("blocks/plate.obj", box((0, 0, 0), (11, 2, 1)))
        self.run_program("plan", "blocks", "-o", "out", "-q", status=0)
        old = self.leaving()
        a, b = 1, 3  # steps of the disassembly
        self.edit("--move-step", str(b), "--before", str(a), "--disassembly")
        new = self.leaving("new")
        self.assertEqual(new, [old[2], old[0], old[1], old[3]])
        self.assertEqual([s["step"] for s in self.plan("new")["disassembly"]], list(range(1, len(old) + 1)))
        self.run_program("verify", "new/plan.json", status=0)
        # What the other order costs is said, check by check.
        done = self.edit("--move-step", str(b), "--before", str(a), "--disassembly")
        told = json.loads(done.stdout)
        self.assertEqual((told["cost_before"], told["cost"]), (self.plan()["objective"]["cost"], self.plan("new")["objective"]["cost"]))
        self.assertIn(f"{told['costs']}\n", done.stderr)
        self.assertIn(f"it costs {told['cost']:.3g} (before: {told['cost_before']:.3g})", told["costs"])
        # The same in numbers of the assembly: there the first of the two is the later one.
        first, second = len(old) + 1 - a, len(old) + 1 - b
        self.edit("--move-step", str(second), "--after", str(first))
        self.assertEqual(self.leaving("new"), new)
        self.edit("--move-step", str(second), "--before", str(first))
        self.assertEqual(self.leaving("new"), [old[0], old[2], old[1], old[3]])

    def test_a_step_that_has_to_wait_is_refused_by_name_and_nothing_is_written(self):
        a, b = self.dependent()
        done = self.edit("--move-step", str(b), "--before", str(a), "--disassembly", status=1)
        result = json.loads(done.stdout)
        self.assertEqual((result["status"], result["step"]), ("refused", b))
        self.assertIn(f"refused: step {b} ({self.leaving()[b - 1]})", done.stderr)
        self.assertIn("nothing was written", done.stderr)
        with self.assertRaises(FileNotFoundError):
            self.read("new", "plan.json")

    def test_an_order_that_a_constraint_forbids_is_refused(self):
        old = self.leaving()
        order = ",".join(str(k + 1) for k in range(len(old)))
        done = self.edit("--order", order, "--set", f"constraints.base=[{old[0]}]", status=1)
        self.assertEqual(json.loads(done.stdout)["step"], len(old))
        self.assertIn("it moves a part of the base", done.stderr)

    def test_directions_are_those_of_the_insertion(self):
        number = len(self.leaving())  # the last part that is put in is the first that leaves
        def out():
            first = self.plan("new")["disassembly"][0]["moves"][0]["poses"]
            return [b - a for a, b in zip(first[0][:3], first[-1][:3])]
        possible = []
        for axis in "xyz":
            for sign in (1, -1):
                name = "+-"[sign < 0] + axis
                done = self.run_program("edit", "out/plan.json", "--direction", f"{number}={name}", "-o", "new", "-q")
                self.assertIn(done.returncode, (0, 1), done.stderr)
                if done.returncode == 0:
                    possible.append(name)
                    moved = out()
                    self.assertLess(sign * moved["xyz".index(axis)], 0, name)
                    self.assertEqual(sum(abs(v) > 1e-9 for v in moved), 1)
                    self.run_program("verify", "new/plan.json", "-q", status=0)
        self.assertTrue(possible)

    def test_what_cannot_be_meant_is_refused_before_any_work(self):
        for message, arguments in [
                ("nothing to change", []),
                ("needs --before N or --after N", ["--move-step", "1"]),
                ("there is no step 99", ["--move-step", "99", "--before", "1"]),
                ("cannot be moved to itself", ["--move-step", "1", "--before", "1"]),
                ("step 1 is there twice", ["--order", "1,1"]),
                ("is missing; name every step once", ["--order", "1"]),
                ("'x' is no number of a step", ["--order", "x"]),
                ("'up' is no direction", ["--direction", "1=up"]),
                ("step 1 has two directions", ["--direction", "1=+z", "--direction", "1=-z"])]:
            done = self.run_program("edit", "out/plan.json", *arguments, "-o", "new", status=2)
            self.assertIn(message, done.stderr)
        done = self.run_program("edit", "out/plan.json", "--direction", "1=+z", "-o", "out", status=2)
        self.assertIn("would be written over", done.stderr)
        self.write("strange.csv", "step,part\n1,nothing\n")
        self.assert_fails(3, "it does not name", "edit", "out/plan.json", "--order", "strange.csv", "-o", "new")
