"""Planners that the tests register."""
import numpy as np

import dismantle


@dismantle.path_planner("test.lines", [dismantle.Parameter("directions", 60, "Directions that are tried.", min=6),
                                       dismantle.Parameter("step", 0.05, "Distance of checks.", unit="radii", min=0, max=1, min_open=True,
                                                           advanced=True),
                                       dismantle.Parameter("order", "axes_first", "Which ones first.", choices={
                                           "axes_first": "the axes", "random": "random ones"})], needs=["distance"])
class Lines(dismantle.PathPlanner):
    """Straight lines."""

    def __init__(self, directions, step, order):
        self.directions, self.step, self.order = directions, step, order

    def plan(self, query, context):
        world = query.world("translation")
        for n in range(self.directions):
            axis = n < 6 and self.order == "axes_first"
            direction = np.eye(3)[n // 2] * (1 - 2 * (n % 2)) if axis else context.rng.normal(size=3)
            poses = query.start.copy()
            while not query.should_stop():
                poses[:, :3] += self.step * world.radius() * direction / np.linalg.norm(direction)
                if world.penetration(poses) > 0.5 * query.tolerance:
                    break
                if world.separated(poses):
                    check = query.check(np.stack([query.start, poses]))
                    if check:
                        return check
                    break
        return None


@dismantle.path_planner("test.through_walls")
class ThroughWalls(dismantle.PathPlanner):
    """Claims a path without asking."""

    def plan(self, query, context):
        end = query.start.copy()
        end[:, 0] += 30
        return np.stack([query.start, end])


@dismantle.path_planner("test.raises")
class Raises(dismantle.PathPlanner):
    """Raises."""

    def plan(self, query, context):
        return {}["the key that is missing"]


@dismantle.sequence_planner("test.greedy")
class Greedy(dismantle.SequencePlanner):
    """Whatever leaves first."""

    def plan(self, assembly, oracle, context):
        while len(oracle.left) > 1 and not context.should_stop():
            failed = []
            for part in oracle.left:
                answer = oracle.attempt(part, max_depth=3)
                if answer:
                    oracle.remove(answer)
                    break
                failed.append(answer)
            else:
                return failed


@dismantle.sequence_planner("test.stops_in_the_middle")
class StopsInTheMiddle(dismantle.SequencePlanner):
    """Raises after the first removal."""

    def plan(self, assembly, oracle, context):
        for part in oracle.left:
            answer = oracle.attempt(part, max_depth=3)
            if answer:
                oracle.remove(answer)
                raise ValueError("enough")


LINES = {"path_planner": {"type": "test.lines"}, "sequence_planner": {"type": "progressive"}, "objective": []}


@dismantle.step_check("test.alphabet", [dismantle.Parameter("reverse", False, "Descending.")])
class Alphabet(dismantle.StepCheck):
    """Parts are put in by their names."""

    remembers = ("shape",)

    def __init__(self, reverse):
        self.reverse = reverse

    def judge(self, question):
        assert question.path.shape[1] == len(question.moving) if question.path is not None else True
        assert set(question.poses) == set(question.moving) | set(question.present)
        if question.previous is None:
            return None
        before, now = question.previous.moving[0], question.moving[0]
        if (before > now) == self.reverse:
            return None
        return dismantle.StepVerdict(1.5, reason=f"{now} after {before}", notes=[dismantle.StepNote("order", "Turn.", '{"from": 1.0e0}')])


@dismantle.step_check("test.broken")
class Broken(dismantle.StepCheck):
    """Raises an error."""

    def judge(self, question):
        raise KeyError("nothing here")


@dismantle.step_check("test.whole")
class Whole(dismantle.StepCheck):
    """Judges the plan as a whole."""

    def judge(self, question):
        return dismantle.StepVerdict(allowed=False, reason="never")

    def judge_plan(self, questions):
        return dismantle.StepVerdict(cost=len(questions), reason="its steps")


@dismantle.path_planner("test.memory")
class Memory(dismantle.PathPlanner):
    """Asks for memory until there is none."""

    def plan(self, query, context):
        held = []
        while True:
            held.append(np.empty(1 << 28, dtype=np.uint8))  # not touched: it takes addresses only
