import logging
import os
import signal

import pytest

import dismantle
from planners_for_tests import LINES


def test_configurations_mean_the_same_in_every_form(box, tmp_path):
    file = tmp_path / "config.yaml"
    file.write_text("schema: 1\npath_planner: {type: bfs}\nsequence_planner: {type: progressive}\n")
    forms = [
        dismantle.run(box, config=file, seed=2),
        dismantle.run(box, config={"path_planner": {"type": "bfs"}, "sequence_planner": {"type": "progressive"}}, seed=2),
        dismantle.run(box, set={"path_planner.type": "bfs", "sequence_planner.type": "progressive", "run.seed": 2}),
        dismantle.run(box, config={"path_planner.type": "rrt", "sequence_planner": {"type": "progressive"}},
                      set={"path_planner": {"type": "bfs"}}, seed=2),
    ]
    moves = [[(s.parts, {k: v.tolist() for k, v in s.moves.items()}) for s in plan.steps] for plan in forms]
    assert all(m == moves[0] for m in moves) and all(p.steps[0].planner == "bfs" for p in forms)


def test_all_problems_of_a_configuration_are_told_with_their_places(box, tmp_path):
    file = tmp_path / "config.yaml"
    file.write_text("schema: 1\npath_planner:\n  type: bfs\n  motoin: 1\nrun: {seed: none}\n")
    with pytest.raises(dismantle.ConfigError) as error:
        dismantle.run(box, config=file)
    places = [(d.file, d.line, d.column) for d in error.value.diagnostics]
    assert places == [(str(file), 4, 3), (str(file), 5, 13)]
    assert f"{file}:4:3: error: unknown key 'motoin'" in str(error.value)
    assert issubclass(dismantle.ConfigError, dismantle.Error)
    with pytest.raises(ValueError, match="'run' is given twice"):
        dismantle.run(box, config={"run": 1}, set={"run.seed": 2})


def test_unknown_plugins_are_told(box):
    with pytest.raises(dismantle.ConfigError, match="did you mean 'bfs'"):
        dismantle.run(box, set={"path_planner.type": "bsf"})
    with pytest.raises(dismantle.PluginError, match="sdf_penalty"):
        dismantle.Simulator("sdf_penalti")
    with pytest.raises(dismantle.PluginError, match="nothing.so"):
        dismantle.load_plugin("nothing.so")


def test_an_assembly_that_was_prepared_in_another_way_is_refused(box):
    with pytest.raises(dismantle.Error, match="size"):
        dismantle.run(box, config={"assembly": {"size": 20}})
    larger = dismantle.Assembly.from_sample("stacked_box", config={"assembly": {"size": 20}})
    assert dismantle.run(larger, config={"assembly": {"size": 20}}).complete


def test_one_part_and_constraints(machine):
    plan = dismantle.run(machine, part="pin_2")
    assert plan.removed == ["pin_2"] and len(plan.steps) == 1
    with pytest.raises(dismantle.InputError, match="has no part 'pin2'"):
        dismantle.run(machine, part="pin2")
    order = dismantle.run(machine, config={"constraints": {"before": [["washer_3_2", "pin_2"]]}}).removed
    assert order.index("washer_3_2") < order.index("pin_2")
    with pytest.raises(dismantle.Error, match="keep"):
        dismantle.run(machine, config={"constraints": {"base": ["base"]}, "sequence_planner": {"type": "progressive"}})


def test_progress_is_told_and_should_stop_is_obeyed(machine):
    events = []
    plan = dismantle.run(machine, on_progress=lambda *event: events.append(event))
    assert plan.complete and not plan.info["interrupted"]
    assert {"sequence"} <= {phase for phase, *_ in events}
    assert all(isinstance(d, int) and isinstance(t, int) and (d <= t or t == 0) for _, d, t, _ in events)
    stopped = dismantle.run(machine, should_stop=lambda: True)
    assert stopped.info["interrupted"] or stopped.complete
    with pytest.raises(ZeroDivisionError):
        dismantle.run(machine, config=LINES, on_progress=lambda *event: 1 / 0)


class Interrupting:
    """Sends Ctrl-C to this process when the first parts are out."""

    def __init__(self, times):
        self.times = times

    def __call__(self, phase, done, total, detail):
        if phase == "sequence" and done >= 3 and self.times > 0:
            self.times -= 1
            os.kill(os.getpid(), signal.SIGINT)


def test_ctrl_c_gives_the_steps_that_are_done():
    import dismantle as d

    @d.sequence_planner("test.never_ends")
    class NeverEnds(d.SequencePlanner):
        """Takes three parts out and waits to be told to stop."""

        def plan(self, assembly, oracle, context):
            removed = 0
            while not context.should_stop():
                for part in oracle.left:
                    if removed == 3:
                        break
                    answer = oracle.attempt(part, max_depth=2)
                    if answer:
                        oracle.remove(answer)
                        removed += 1

    machine = d.Assembly.from_sample("machine")
    config = {"sequence_planner": {"type": "test.never_ends"}, "path_planner": {"type": "test.lines"}}
    plan = d.run(machine, config=config, on_progress=Interrupting(1))
    assert plan.info["interrupted"] and plan.info["outcome"] == d.Outcome.cancelled
    assert len(plan.steps) == 3 and not plan.complete
    assert d.verify(plan, machine).valid


def test_the_log_goes_to_logging(box, caplog):
    with caplog.at_level(logging.ERROR, logger="dismantle"):
        dismantle.run(box, config={**LINES, "path_planner": {"type": "test.raises"}})
    assert any("test.raises" in record.message for record in caplog.records)


def test_plugins_are_listed_with_their_parameters():
    kinds = {p["kind"] for p in dismantle.plugins()}
    assert {"simulator", "path_planner", "sequence_planner", "transfer_planner", "importer", "step_check"} <= kinds
    mine = dismantle.describe("test.lines")
    assert mine["kind"] == "path_planner" and mine["summary"] == "Straight lines."
    assert [p["name"] for p in mine["parameters"]] == ["directions", "order"]
    assert [p["name"] for p in mine["advanced"]] == ["step"]
    with pytest.raises(ValueError):
        dismantle.plugins("planner")
    assert "acme" not in dismantle.resolved_config() and "schema: 1" in dismantle.resolved_config()
