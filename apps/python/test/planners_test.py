import numpy as np
import pytest

import dismantle
from planners_for_tests import LINES
from shapes import loose_blocks

NO_PROOFS = {"immobility": {"provers": []}}


def poses_of(plan):
    return [(s.parts, {k: v.tobytes() for k, v in s.moves.items()}) for s in plan.steps]


def test_a_planner_in_python_solves_and_is_verified(box, peg, machine):
    for assembly in (box, peg, machine):
        plan = dismantle.run(assembly, config=LINES)
        assert plan.complete and all(s.planner == "test.lines" for s in plan.steps)
        assert dismantle.verify(plan, assembly).complete
        assert plan.info["planner_counts"]["state_checks"] > 0


def test_same_seed_same_plan_on_any_number_of_threads():
    blocks = dismantle.Assembly.from_meshes(loose_blocks())
    config = {**LINES, "path_planner": {"type": "test.lines", "order": "random"}}
    plans = []
    for seed in (1, 2, 3):
        alike = [dismantle.run(blocks, config=config, seed=seed, threads=threads) for threads in (1, 1, 3)]
        assert all(p.complete and len(p.steps) == 3 and p.steps[0].planner == "test.lines" for p in alike)
        assert poses_of(alike[0]) == poses_of(alike[1]) == poses_of(alike[2])
        plans.append(poses_of(alike[0]))
    assert plans[0] != plans[1] != plans[2] != plans[0]


def test_a_wrong_path_is_refused(box):
    plan = dismantle.run(box, config={**LINES, "path_planner": {"type": "test.through_walls"}, "run.force": "off"})
    assert not plan.steps and not plan.complete and plan.unsolved
    for unsolved in plan.unsolved:
        assert unsolved.outcome == dismantle.Outcome.crashed
        assert "'test.through_walls'" in unsolved.message and "the verifier refuses" in unsolved.message


def test_an_exception_names_the_planner_and_the_line(box):
    plan = dismantle.run(box, config={**LINES, "path_planner": {"type": "test.raises"}, "run.force": "off"})
    assert not plan.steps and plan.unsolved
    for unsolved in plan.unsolved:
        assert unsolved.outcome == dismantle.Outcome.crashed
        assert "'test.raises'" in unsolved.message and "Traceback" in unsolved.message
        assert "KeyError: 'the key that is missing'" in unsolved.message and "planners_for_tests.py" in unsolved.message


def test_parameters_are_checked_like_those_of_every_plugin(box, tmp_path):
    file = tmp_path / "config.yaml"
    file.write_text("schema: 1\npath_planner:\n  type: test.lines\n  directions: 2\n  stepp: 1\n  order: best\n")
    with pytest.raises(dismantle.ConfigError) as error:
        dismantle.run(box, config=file)
    assert {d.line for d in error.value.diagnostics} == {4, 5, 6}
    assert "did you mean 'advanced.step'" in str(error.value)
    file.write_text("schema: 1\npath_planner: {type: portfolio, of: [{type: test.lines, advanced: {step: 0.1}}]}\nsequence_planner: {type: progressive}\n")
    assert dismantle.run(box, config=file).complete


def test_advanced_parameters_are_in_a_map_of_their_own(caplog):
    written = dismantle.resolved_config({"path_planner": {"type": "test.lines", "advanced": {"step": 0.1}}})
    assert "  advanced:\n    step: 0.1 " in written and not caplog.records
    assert "advanced" not in dismantle.resolved_config({"path_planner.type": "test.lines"})
    assert dismantle.resolved_config(set={"path_planner.type": "test.lines", "path_planner.step": 0.1}) == written
    assert any("write path_planner.advanced.step" in record.message for record in caplog.records)


def test_declarations_are_checked():
    def declare(id, parameters=(), **options):
        @dismantle.path_planner(id, parameters, **options)
        class Planner(dismantle.PathPlanner):
            """Nothing."""

            def __init__(self, **parameters):
                pass

    with pytest.raises(dismantle.PluginError, match="dot"):
        declare("lines")
    with pytest.raises(dismantle.PluginError, match="test.upper.*|bad id"):
        declare("test.Upper")
    with pytest.raises(dismantle.PluginError, match="out of range|must"):
        declare("test.range", [dismantle.Parameter("n", 1, "A number.", min=6)])
    with pytest.raises(ValueError, match="'friction' is not a capability"):
        declare("test.needs", needs=["friction"])
    with pytest.raises(TypeError, match="bool, int, float or str"):
        declare("test.list", [dismantle.Parameter("n", [], "A list.")])
    with pytest.raises(TypeError, match="derived"):
        dismantle.path_planner("test.plain")(int)
    with pytest.raises(TypeError, match="does not take"):

        @dismantle.path_planner("test.signature", [dismantle.Parameter("n", 1, "A number.")])
        class NoParameters(dismantle.PathPlanner):
            """Nothing."""

    registered = {p["id"] for p in dismantle.plugins()}
    assert not registered & {"test.range", "test.needs", "test.list", "test.plain", "test.signature", "lines"}


def test_what_is_kept_of_a_query_raises_when_it_is_over(peg):
    kept = {}

    @dismantle.path_planner("test.keeps", needs=["distance"])
    class Keeps(dismantle.PathPlanner):
        """Keeps what it is given."""

        def plan(self, query, context):
            kept.update(query=query, context=context, world=query.world(), assembly=query.assembly)
            kept["budget"] = (query.max_steps, query.spent)
            kept["world"].penetration()
            kept["counted"] = query.spent
            return dismantle.PathResult.failed(dismantle.Outcome.exhausted, "kept", best_pose=query.start)

    plan = dismantle.run(peg, part="peg", config={"path_planner": {"type": "test.keeps"}, "run": {"path_steps": 5}, **NO_PROOFS})
    assert plan.unsolved[0].message == "kept" and plan.unsolved[0].outcome == dismantle.Outcome.exhausted
    assert kept["budget"] == (5, 0) and kept["counted"] == 1
    for use in (lambda: kept["query"].start, lambda: kept["query"].world(), lambda: kept["context"].rng,
                lambda: kept["context"].should_stop(), lambda: kept["world"].penetration(), lambda: kept["world"].reset()):
        with pytest.raises(dismantle.Error, match="over"):
            use()
    assert kept["assembly"].names == peg.names


def test_a_budget_is_kept_to(peg):
    config = {**LINES, "run": {"path_steps": 7}, **NO_PROOFS}
    plan = dismantle.run(peg, part="peg", config=config)
    assert not plan.complete and plan.unsolved[0].outcome == dismantle.Outcome.timeout
    assert plan.info["planner_counts"]["state_checks"] <= 7


def test_a_simulator_that_lacks_what_is_needed(peg):
    @dismantle.path_planner("test.dynamics", needs=["dynamics", "contacts"])
    class Dynamics(dismantle.PathPlanner):
        """Never asked."""

        def plan(self, query, context):
            raise AssertionError("the simulator cannot do what is needed")

    # fcl checks states and has no dynamics; reading the configuration reports that before planning.
    with pytest.raises(dismantle.ConfigError, match="dynamics"):
        dismantle.run(peg, config={"path_planner": {"type": "test.dynamics"}, "simulator": {"type": "fcl"}})


def test_a_sequence_planner_in_python(box, peg, machine):
    for assembly in (box, peg, machine):
        for path_planner in ("test.lines", "bfs"):
            config = {"sequence_planner": {"type": "test.greedy"}, "path_planner": {"type": path_planner}}
            plan = dismantle.run(assembly, config=config, threads=2)
            assert plan.complete and plan.info["outcome"] == dismantle.Outcome.solved
            assert dismantle.verify(plan, assembly).complete


def test_a_sequence_planner_that_raises_keeps_its_steps(box, caplog):
    config = {"sequence_planner": {"type": "test.stops_in_the_middle"}, "path_planner": {"type": "test.lines"}, "run.force": "off"}
    plan = dismantle.run(box, config=config)
    assert len(plan.steps) == 1 and plan.info["outcome"] == dismantle.Outcome.crashed
    assert dismantle.verify(plan, box).valid
    assert any("'test.stops_in_the_middle' raised" in r.message and "ValueError: enough" in r.message for r in caplog.records)


def test_the_oracle(box):
    seen = {}

    @dismantle.sequence_planner("test.asks")
    class Asks(dismantle.SequencePlanner):
        """Tries the oracle."""

        def plan(self, assembly, oracle, context):
            lid = assembly["lid"].id
            answer = oracle.attempt("lid", max_depth=3)
            seen["path"] = answer.path
            seen["again"] = np.array_equal(oracle.attempt(lid, max_depth=3).path, answer.path)
            blocked = oracle.attempt("plate_1", max_depth=1)
            seen["blocked"] = (bool(blocked), blocked.outcome)
            with pytest.raises(ValueError, match="success"):
                oracle.remove(blocked)
            proposed = oracle.propose("lid", answer.path)
            seen["proposed"] = bool(proposed)
            wrong = answer.path.copy()
            wrong[:, :, :3] = -wrong[:, :, :3]
            seen["refused"] = bool(oracle.propose("lid", wrong))
            oracle.remove(proposed)
            seen["left"] = list(oracle.left)
            seen["tolerance"] = oracle.tolerance
            seen["oracle"] = oracle
            return [blocked]

    plan = dismantle.run(box, config={"sequence_planner": {"type": "test.asks"}, "path_planner": {"type": "test.lines"}, "run.force": "off"})
    assert seen["path"].shape[1:] == (1, 7) and seen["again"] and seen["proposed"] and not seen["refused"]
    assert seen["blocked"][0] is False
    assert box["lid"].id not in seen["left"] and len(seen["left"]) == len(box) - 1
    assert seen["tolerance"] == 0.001
    assert [s.parts for s in plan.steps] == [["lid"]] and not plan.complete
    with pytest.raises(dismantle.Error, match="over"):
        seen["oracle"].attempt("lid")


def test_groups_that_leave_together_have_to_be_taken_apart(machine):
    @dismantle.sequence_planner("test.groups")
    class Groups(dismantle.SequencePlanner):
        """Two washers leave as one group; then each group is taken apart."""

        def plan(self, assembly, oracle, context):
            answer = oracle.attempt(["washer_1_3", "washer_1_4"], max_depth=3)
            if answer:
                oracle.remove(answer)
            while not context.should_stop():
                groups = [g for g in oracle.groups if len(g) > 1]
                if not groups:
                    return None
                failed = []
                for part in groups[-1]:
                    answer = oracle.attempt(part, max_depth=3)
                    if answer:
                        oracle.remove(answer)
                        break
                    failed.append(answer)
                else:
                    return failed

    plan = dismantle.run(machine, config={"sequence_planner": {"type": "test.groups"}, "path_planner": {"type": "test.lines"},
                                            "objective": []})
    assert sorted(plan.steps[0].parts) == ["washer_1_3", "washer_1_4"] and len(plan.steps) == len(machine) - 1
    assert plan.complete and dismantle.verify(plan, machine).complete


def test_a_step_check_in_python(tmp_path):
    blocks = dismantle.Assembly.from_meshes(loose_blocks())
    for reverse in (False, True):
        config = {**LINES, "objective": [{"type": "test.alphabet", "weight": 2, "reverse": reverse}]}
        plan = dismantle.run(blocks, config=config)
        names = [step.parts[0] for step in reversed(plan.steps)]
        assert plan.complete and len(names) == 3
        wrong = sum((a > b) != reverse for a, b in zip(names, names[1:]))
        assert plan.objective.checks[0].cost == 1.5 * wrong and plan.objective.cost == 3 * wrong
        for step in plan.steps:
            for verdict in step.checks:
                assert (verdict.type, verdict.weight, verdict.allowed) == ("test.alphabet", 2, True)
                assert [n.data for n in verdict.notes] == (['{"from": 1.0e0}'] if verdict.cost else [])
        check = dismantle.verify(plan, blocks)
        assert check.valid and check.verdicts == 3 and not check.not_checked
        foreign = dismantle.Plan.from_json(plan.to_json().replace("test.alphabet", "acme.unknown"))
        check = dismantle.verify(foreign, blocks)
        assert check.valid and check.verdicts == 0 and "acme.unknown" in check.not_checked[0]
        read = dismantle.Plan.from_json(plan.to_json())
        assert read.to_json() == plan.to_json()


def test_what_a_check_raises_is_told_in_the_plan(caplog):
    blocks = dismantle.Assembly.from_meshes(loose_blocks())
    plan = dismantle.run(blocks, config={**LINES, "objective": ["test.broken"]})
    assert plan.complete and all("nothing here" in step.checks[0].failed for step in plan.steps)
    assert any("test.broken" in record.message for record in caplog.records)


def test_a_check_may_judge_the_plan_as_a_whole():
    blocks = dismantle.Assembly.from_meshes(loose_blocks())
    plan = dismantle.run(blocks, config={**LINES, "objective": ["test.whole"]})
    assert [step.checks[0].allowed for step in plan.steps] == [False] * 3
    assert plan.objective.checks[0].plan.cost == 3 == plan.objective.cost


def test_a_check_says_what_it_remembers():
    @dismantle.step_check("test.remembers_all")
    class RemembersAll(dismantle.StepCheck):
        """Remembers more than there is."""

        remembers = ("everything",)

    with pytest.raises(dismantle.PluginError, match="'direction', 'orientation', 'shape'"):
        dismantle.run(dismantle.Assembly.from_meshes(loose_blocks()), config={**LINES, "objective": ["test.remembers_all"]})


@dismantle.sequence_planner("test.obedient")
class Obedient(dismantle.SequencePlanner):
    """Takes out what the constraints let go."""

    keeps_constraints = True

    def plan(self, assembly, oracle, context):
        answers = []
        while not oracle.is_done and not context.should_stop():
            for part in oracle.left:
                if not oracle.may_leave(part):
                    oracle.count("kept")
                    continue
                answer = oracle.attempt(part, max_depth=2)
                if answer:
                    oracle.remove(answer)
                    break
                answers.append(answer)
            else:
                return answers


def test_a_sequence_planner_in_python_keeps_constraints_and_counts(box):
    names = [part.name for part in box]
    lid = [s.parts for s in dismantle.run(box, seed=1).steps][0][0]
    config = {"sequence_planner": {"type": "test.obedient"}, "objective": []}
    plan = dismantle.run(box, seed=1, config={**config, "constraints": {"target": lid}})
    assert plan.steps[-1].parts == [lid] and plan.status == "complete"
    plan = dismantle.run(box, seed=1, config={**config, "constraints": {"base": [names[0]]}})
    assert plan.info["sequence_counts"]["kept"] > 0 and plan.steps and all(names[0] not in s.parts for s in plan.steps)
    with pytest.raises(dismantle.Error, match="constraints"):
        dismantle.run(box, seed=1, config={"sequence_planner": {"type": "test.disobedient"}, "constraints": {"base": [names[0]]}})


@dismantle.sequence_planner("test.disobedient")
class Disobedient(Obedient):
    """Keeps no constraints."""

    keeps_constraints = False


@dismantle.path_planner("test.edges", needs=["distance"])
class Edges(dismantle.PathPlanner):
    """Asks for single edges, and counts those that are free."""

    def plan(self, query, context):
        start, world = query.start, query.world("translation")
        for axis in range(3):
            for sign in (1, -1):
                end = start.copy()
                end[:, axis] += 3 * sign * world.radius()
                free = query.is_free(start, end)
                query.count("free" if free else "blocked")
                if free:
                    return np.stack([start, end])
        return None


def test_a_path_planner_in_python_asks_for_edges_and_counts(peg):
    plan = dismantle.run(peg, part="peg", seed=1, config={"path_planner": {"type": "test.edges"}, "simulator": {"type": "fcl"}})
    assert plan.steps and plan.info["planner_counts"]["free"] >= 1 and plan.info["planner_counts"]["blocked"] >= 1


@dismantle.sequence_planner("test.by_the_clock")
class ByTheClock(Obedient):
    """Breaks the law of determinism."""

    def plan(self, assembly, oracle, context):
        ByTheClock.calls = getattr(ByTheClock, "calls", 0) + 1
        if ByTheClock.calls % 2:
            return super().plan(assembly, oracle, context)


def test_the_contract_is_checked(box):
    assert dismantle.check_contract("test.obedient") == []
    assert any("the same seed gave two plans" in p for p in dismantle.check_contract("test.by_the_clock"))
    with pytest.raises(ValueError, match="plugins check"):
        dismantle.check_contract("fcl")
