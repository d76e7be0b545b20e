"""Revisions of an assembly: what changed, and what of the plan still holds."""
import json

from program import CliTest, box


class Revision(CliTest):
    def assembly(self, folder, blocks=(0, 1, 2, 3), lid=False, high=3):
        """Blocks on a plate, each with room beside it; a lid lies on all of them."""
        self.write(f"{folder}/plate.obj", box((0, 0, 0), (11, 2, 1)))
        for k in blocks:
            self.write(f"{folder}/block_{k}.obj", box((3 * k, 0, 1), (3 * k + 2, 2, high)))
        if lid:
            self.write(f"{folder}/lid.obj", box((0, 0, high), (11, 2, high + 1)))
        return folder

    def plan(self, folder):
        return json.loads(self.read(folder, "plan.json"))

    def diff(self, before, now, status):
        done = self.run_program("diff", before, now, "--format", "json", status=status)
        return json.loads(done.stdout), done.stderr

    def fates(self, result):
        return {p["now"] or p["before"]: p["fate"] for p in result["parts"]}

    def test_what_became_of_each_part_is_said(self):
        self.assembly("a")
        self.assembly("b", blocks=(0, 1))
        self.write("b/other_name.obj", box((6, 0, 1), (8, 2, 3)))   # block_2
        self.write("b/block_1.obj", box((3.5, 0, 1), (5.5, 2, 3)))  # moved
        self.write("b/block_0.obj", box((0, 0, 1), (2, 2, 2)))      # lower
        self.write("b/knob.obj", box((9, 0, 1), (10, 1, 2)))
        result, text = self.diff("a", "b", status=1)
        self.assertEqual(self.fates(result), {"plate": "same", "block_0": "changed", "block_1": "moved", "block_3": "removed",
                                              "other_name": "renamed", "knob": "added"})
        self.assertIn("renamed  block_2 -> other_name", text)
        self.assertIn("1 of 6 parts are the same", text)
        result, _ = self.diff("a", "a", status=0)
        self.assertEqual(set(self.fates(result).values()), {"same"})
        self.assertFalse(result["differ"])

    def test_steps_that_hold_are_kept_and_the_rest_is_planned(self):
        self.run_program("plan", self.assembly("a"), "-o", "old", "-q", status=0)
        old = self.plan("old")["disassembly"]
        self.assembly("b", blocks=(0, 1, 3))
        self.write("b/knob.obj", box((6, 0, 1), (8, 2, 2)))
        result, text = self.diff("old/plan.json", "b", status=1)
        kept = {s["parts"][0]: s["kept"] for s in result["revised"]}
        self.assertEqual(kept, {"block_0": True, "block_1": True, "block_2": False, "block_3": True})
        self.assertIn("its parts are not there any more", text)
        done = self.result_of(self.run_program("plan", "b", "--from", "old/plan.json", "-o", "new", "--format", "json", "-q", status=0))
        self.assertEqual(done["status"], "complete")
        self.assertEqual(done["revised"], result["revised"])
        new = self.plan("new")["disassembly"]
        self.assertEqual([s["moves"][0]["part"] for s in new],
                         [s["moves"][0]["part"] for s in old if s["moves"][0]["part"] != "block_2"] + ["knob"])
        self.run_program("verify", "new/plan.json", status=0)

    def test_what_a_new_part_blocks_is_planned_anew(self):
        self.run_program("plan", self.assembly("a"), "-o", "old", "-q", status=0)
        if not all(m["poses"][-1][2] > 0 for s in self.plan("old")["disassembly"] for m in s["moves"]):
            self.run_program("plan", "a", "-o", "old", "--set", "sequence_planner={type: queue}", "--set", "run.best_order=false", "-q")
        up = [s["moves"][0]["part"] for s in self.plan("old")["disassembly"] if s["moves"][0]["poses"][-1][2] > 0]
        self.assembly("b", lid=True)
        result, text = self.diff("old/plan.json", "b", status=1)
        for step in result["revised"]:
            if step["parts"][0] in up:
                self.assertFalse(step["kept"])
                self.assertIn("into 'lid'", step["reason"])
        self.run_program("plan", "b", "--from", "old/plan.json", "-o", "new", "-q", status=0)
        self.assertEqual(len(self.plan("new")["disassembly"]), 5)
        self.run_program("verify", "new/plan.json", status=0)

    def test_a_step_that_a_constraint_forbids_is_not_kept(self):
        self.run_program("plan", self.assembly("a"), "-o", "old", "-q", status=0)
        old = [s["moves"][0]["part"] for s in self.plan("old")["disassembly"]]
        done = self.result_of(self.run_program(
            "plan", "a", "--from", "old/plan.json", "-o", "new", "--set", f"constraints.before=[[{old[1]}, {old[0]}]]",
            "--format", "json", "-q", status=0))
        self.assertEqual([s["kept"] for s in done["revised"]], [False, True, True, True])
        self.assertIn("another part has to leave first", done["revised"][0]["reason"])
        new = [s["moves"][0]["part"] for s in self.plan("new")["disassembly"]]
        self.assertLess(new.index(old[1]), new.index(old[0]))
        self.assertEqual(sorted(new), sorted(old))

    def test_what_does_not_go_together_is_refused(self):
        self.run_program("plan", self.assembly("a"), "-o", "old", "-q", status=0)
        self.assertIn("excludes", self.run_program("plan", "a", "--from", "old/plan.json", "--resume", "old/plan.json", status=2).stderr)
        self.assertIn("would be written over", self.run_program("plan", "a", "--from", "old/plan.json", "-o", "old", status=2).stderr)
        self.assert_fails(3, "none.json", "diff", "none.json", "a")
