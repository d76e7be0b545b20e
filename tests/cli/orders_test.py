"""Orders: replayed against an assembly, compared with each other."""
import json

from program import CliTest


class Orders(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("sample", "stacked_box", "-o", "in", "-q", status=0)
        self.run_program("plan", "in", "-o", "out", "-q", status=0)
        plan = json.loads(self.read("out", "plan.json"))
        self.out = [s["separates"][0][0] for s in plan["disassembly"]]
        self.base = plan["remaining"][0]

    def csv(self, name, parts):
        return self.write(name, "step,part\n" + "".join(f'{k},"{part}"\n' for k, part in enumerate(parts)))

    def test_the_order_of_the_plan_is_possible_and_its_reverse_is_not(self):
        self.csv("good.csv", [self.base, *reversed(self.out)])
        done = self.result_of(self.run_program("replay", "out/plan.json", "--order", "good.csv", "--format", "json", "-q", status=0))
        self.assertEqual((done["status"], done["refused"], done["tau"]), ("complete", 0, 1))
        self.assertEqual(done["not_in_order"], [])
        self.csv("short.csv", [self.base, *reversed(self.out[1:])])
        done = self.run_program("replay", "out/plan.json", "--order", "short.csv", status=1)  # its lid is on
        self.assertIn(f"not in the order, taken as there from the start: {self.out[0]}", done.stdout)
        self.csv("bad.csv", [self.base, *self.out])
        done = self.run_program("replay", "in", "--order", "bad.csv", "--format", "json", status=1)
        result = json.loads(done.stdout)
        refused = [i for i in result["items"] if not i["possible"]]
        self.assertEqual(len(refused), result["refused"])
        self.assertGreater(refused[0]["depth"], 0)
        self.assertEqual(len(refused[0]["pair"]), 2)
        self.assertLess(result["tau"], 0)
        self.assertIn("refused: step", done.stderr)

    def test_replay_needs_an_order(self):
        self.assert_fails(3, "it states no order", "replay", "in", "--no-plan")
        self.csv("strange.csv", ["no_such_part"])
        self.assert_fails(3, "the assembly has no part 'no_such_part'", "replay", "in", "--no-plan", "--order", "strange.csv")

    def test_orders_are_compared_side_by_side(self):
        self.csv("same.csv", [self.base, *reversed(self.out)])
        done = self.result_of(self.run_program("compare", "out/plan.json", "same.csv", "--format", "json", "-q", status=0))
        self.assertEqual(done["tau"], 1)
        self.assertEqual(done["a"]["parts"], done["b"]["parts"])
        self.assertIn("changes of direction", self.run_program("compare", "out/plan.json", "out/plan.json", status=0).stdout)
        self.assert_fails(3, "cannot be opened", "compare", "out/plan.json", "none.csv")
