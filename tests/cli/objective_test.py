"""Step checks: the objective of a plan, what is shown of it, and that verify judges again."""
import json

from program import CliTest, box


class Objective(CliTest):
    QUICK = ("--path-timeout", "0", "--timeout", "0", "--set", "run.force=off", "--set", "immobility.provers=[]", "--set", "layout.enabled=false")

    def setUp(self):
        super().setUp()
        listed = self.run_program("plugins", "list", status=0).stdout
        self.types = {line.split()[0] for line in listed.splitlines() if line[:1].strip()}
        if not {"directions", "identical_parts"} <= self.types:
            self.skipTest("the step checks are not part of this build")
        self.run_program("sample", "machine", "-o", "machine", "--set", "parts=8", status=0)

    def plan_with(self, objective, folder, *more):
        return self.run_program("plan", "machine", "-o", folder, *self.QUICK, "--set", "objective=" + objective, *more)

    def read_plan(self, folder):
        return json.loads(self.read(folder, "plan.json"))

    def changed(self, folder, change):
        plan = self.read_plan(folder)
        change(plan)
        self.write("changed/plan.json", json.dumps(plan))
        return self.run_program("verify", "changed/plan.json", "--assembly", "machine", "--format", "json")

    def test_verdicts_are_stated_shown_and_judged_again(self):
        done = self.plan_with("[{type: directions, weight: 2, angle: 0.2}, identical_parts]", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("objective: ", done.stdout)
        plan = self.read_plan("out")
        checks = plan["objective"]["checks"]
        self.assertEqual([(c["type"], c["weight"]) for c in checks], [("directions", 2), ("identical_parts", 1)])
        self.assertEqual(checks[0]["parameters"], {"angle": 0.2, "preference": 0})
        for k, check in enumerate(checks):
            self.assertAlmostEqual(check["cost"], sum(step["checks"][k]["cost"] for step in plan["disassembly"]))
        self.assertAlmostEqual(plan["objective"]["cost"], 2 * checks[0]["cost"] + checks[1]["cost"])
        again = self.run_program("verify", "out/plan.json", "--assembly", "machine", "--format", "json", status=0)
        self.assertEqual(self.result_of(again)["verdicts"], 2 * len(plan["disassembly"]))
        self.run_program("export", "out/plan.json", "--format", "markdown", "-o", "steps.md", status=0)
        self.assertIn("objective: ", self.read("steps.md"))
        resolved = self.run_program("plan", "machine", "-o", "again", "-c", "out/resolved.yaml", status=0)
        self.assertIn("objective: ", resolved.stdout)
        strip = lambda p: [(s["moves"], s["checks"]) for s in p["disassembly"]]
        self.assertEqual(strip(plan), strip(self.read_plan("again")))

    def write_pegs(self, count):
        """Pegs in cups of one body, which open to +x and to +z in turn."""
        shells = []
        for n in range(count):
            axis = 0 if n % 2 == 0 else 2
            others = [k for k in range(3) if k != axis]
            origin = [0, 3 * (n // 2), 0]
            origin[axis] = 4

            def corners(along, u, v):
                spans = dict(zip([axis, *others], (along, u, v)))
                return [tuple(origin[k] + spans[k][end] for k in range(3)) for end in (0, 1)]
            for wall in (((-0.3, -0.02), (-0.3, 1.3), (-0.3, 1.3)), ((0, 2), (-0.3, -0.02), (-0.3, 1.3)), ((0, 2), (1.02, 1.3), (-0.3, 1.3)),
                         ((0, 2), (0, 1), (-0.3, -0.02)), ((0, 2), (0, 1), (1.02, 1.3))):
                shells.append(corners(*wall))
            self.write(f"pegs/peg{n}.obj", box(*corners((0.05, 1.5 + 0.01 * n), (0.02, 0.98), (0.02, 0.98))))
        text = ""
        for k, shell in enumerate(shells):
            for line in box(*shell).splitlines():
                words = line.split()
                text += " ".join([words[0], *(str(int(w) + 8 * k) for w in words[1:])] if words[0] == "f" else words) + "\n"
        self.write("pegs/body.obj", text)

    def test_planners_prefer_what_the_objective_likes(self):
        self.write_pegs(6)
        for planner in {"ndbg", "state_based", "blocking", "progressive"} & self.types:
            costs = []
            for weight in (0, 1):
                done = self.run_program("plan", "pegs", "-o", "out", *self.QUICK, "--sequence-planner", planner, "--set", "run.best_order=false",
                                        "--set", f"objective=[{{type: directions, weight: {weight}}}]")
                self.assertEqual(done.returncode, 0, done.stderr)
                costs.append(self.read_plan("out")["objective"]["checks"][0]["cost"])
            self.assertEqual(costs, [5, 1], planner)

    def test_the_order_of_any_planner_is_improved(self):
        self.write_pegs(6)
        costs = []
        for best in ("false", "true"):
            done = self.run_program("plan", "pegs", "-o", "out", *self.QUICK, "--sequence-planner", "queue",
                                    "--set", "objective=[directions]", "--set", f"run.best_order={best}")
            self.assertEqual(done.returncode, 0, done.stderr)
            objective = self.read_plan("out")["objective"]
            costs.append(objective["cost"])
        self.assertEqual(costs, [5, 1])
        self.assertEqual(objective["least_cost"], 1)
        self.assertEqual([c["cost"] for c in objective["alternatives"][0]["checks"]], [5])
        other = objective["alternatives"][-1]
        self.assertGreater(other["checks"][0]["cost"], 1)
        self.run_program("book", "out/plan.json", "-o", "book.html", status=0)
        told = "the order that was found first would cost 5: directions 4 more"
        more = f"it would cost {other['checks'][0]['cost'] - 1:.3g} more: directions"
        explained = self.run_program("explain", "out/plan.json", status=0).stdout
        self.run_program("export", "out/plan.json", "--format", "markdown", "-o", "steps.md", status=0)
        for text in (explained, self.read("out", "index.html"), self.read("book.html"), self.read("steps.md").replace("\\", "")):
            self.assertIn(told, text)
            self.assertIn(more, text)
        self.assertIn(told, done.stdout)

    def test_a_target_comes_out_in_one_step(self):
        self.plan_with("[directions]", "all")
        first = self.read_plan("all")["disassembly"][0]["separates"][0]
        self.assertEqual(len(first), 1)
        done = self.plan_with("[directions]", "one", "--target", first[0])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.read_plan("one")["disassembly"]), 1)

    def test_a_target_takes_the_fewest_steps_and_the_plan_says_so(self):
        self.write("tower/foot.obj", box((0, 0, 0), (9, 9, 1)))
        for k in range(3):  # between a foot and a roof
            self.write(f"tower/slab{k}.obj", box((1, 1, 1 + k), (8, 8, 2 + k)))
        self.write("tower/roof.obj", box((0, 0, 4), (9, 9, 5)))
        walls = [((0, 0, 1), (1, 9, 4)), ((8, 0, 1), (9, 9, 4)), ((1, 0, 1), (8, 1, 4)), ((1, 8, 1), (8, 9, 4))]
        for k, (lo, hi) in enumerate(walls):
            self.write(f"tower/wall{k}.obj", box(lo, hi))
        for objective, cost in (("[]", 2000), ("[{type: steps, weight: 3}]", 6), ("[directions]", 2000)):
            done = self.run_program("plan", "tower", "-o", "out", *self.QUICK, "--set", "objective=" + objective, "--target", "slab1")
            self.assertEqual(done.returncode, 0, done.stderr)
            plan = self.read_plan("out")
            self.assertEqual(len(plan["disassembly"]), 2)
            self.assertEqual(plan["disassembly"][1]["separates"][0], ["slab1"])
            self.assertEqual(plan["objective"]["least_cost"], plan["objective"]["cost"])
            self.assertGreaterEqual(plan["objective"]["cost"], cost)
            self.assertIn("no order of these motions costs less", done.stdout)
            self.run_program("verify", "out/plan.json", "-q", status=0)

    def test_a_verdict_that_differs_makes_the_plan_invalid(self):
        self.plan_with("[directions]", "out")
        def cheaper(plan):
            plan["disassembly"][0]["checks"][0]["cost"] += 1
            plan["objective"]["checks"][0]["cost"] += 1
            plan["objective"]["cost"] += 1
        done = self.changed("out", cheaper)
        self.assertEqual(done.returncode, 1)
        problems = self.result_of(done)["problems"]
        self.assertEqual([p["step"] for p in problems], [1])
        self.assertIn("'directions': the plan says that it costs", problems[0]["message"])

    def test_a_check_that_is_not_there_is_not_checked_here(self):
        self.plan_with("[directions]", "out")
        def foreign(plan):
            for place in [plan["objective"], *plan["disassembly"]]:
                place["checks"][0]["type"] = "acme.elsewhere"
        done = self.changed("out", foreign)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("not checked here: the verdicts of 'acme.elsewhere'", done.stderr)
        self.assertEqual(len(self.result_of(done)["not_checked"]), 1)

    def test_without_an_objective_the_plan_says_nothing_of_it(self):
        self.run_program("plan", "machine", "--set", "objective=[]", "-o", "out", *self.QUICK, status=0)
        self.assertNotIn("objective", self.read("out", "plan.json"))
        self.assertNotIn('"checks"', self.read("out", "plan.json"))

    def test_what_is_wrong_with_an_objective(self):
        self.write("bad.yaml", "schema: 1\nobjective: [{type: direction, weight: -1}]\n")
        self.assert_fails(2, "bad.yaml:2:20: error: unknown step_check 'direction'; did you mean 'directions'?",
                          "plan", "machine", "-o", "out", "-c", "bad.yaml")
