"""Do planners that are written in Python obey the laws of their kind?"""
import time

from . import _core
from ._run import _from_sample, describe, run

_SAMPLE = "peg_in_hole"
_STEPS = 2000  # of a search: a limit in seconds would depend on the machine


def _same(a, b):
    """The same steps, on the same paths."""
    return ([(s.parts, {n: p.tobytes() for n, p in s.moves.items()}) for s in a.steps]
            == [(s.parts, {n: p.tobytes() for n, p in s.moves.items()}) for s in b.steps])


def _crashes(plan):
    return [f"it crashed: {u.message}" for u in plan.unsolved if u.outcome == _core.Outcome.crashed]


def _config(id, kind, parameters):
    chosen = {"type": id, **parameters}
    config = {"run": {"force": "off", "path_steps": _STEPS}, "objective": [], "immobility": {"provers": []}}
    if kind == "path_planner":
        return {**config, "path_planner": chosen, "sequence_planner": {"type": "progressive"}}
    return {**config, "sequence_planner": chosen, "path_planner": {"type": "mv_t_rrt"}, "simulator": {"type": "fcl"}}


def _planner_problems(id, kind, config):
    assembly = _from_sample(_SAMPLE)
    first = run(assembly, config=config, seed=1, threads=1)
    yield from _crashes(first)
    if not _same(first, run(assembly, config=config, seed=1, threads=1)):
        yield "the same seed gave two plans; random numbers have to come from context.rng, and nothing may depend on the clock"
    if not _same(first, run(assembly, config=config, seed=1, threads=2)):
        yield "two threads gave another plan than one"
    closed = run(_from_sample("closed_box"), config=config, seed=1)
    yield from (f"closed_box: {c}" for c in _crashes(closed))
    if closed.complete:
        yield "closed_box: a part left a box without an opening"
    begin = time.monotonic()
    stopped = run(_from_sample("closed_box"), config=config, seed=1, should_stop=lambda: time.monotonic() > begin + 0.5)
    if time.monotonic() - begin > 0.5 + 5 and stopped.info.get("interrupted"):
        yield "it did not stop within five seconds after it was asked to: query.should_stop() has to be asked often"


def _check_problems(id, config):
    assembly = _from_sample("stacked_box")
    first, again = (run(assembly, config=config, seed=1) for _ in range(2))
    yield from _crashes(first)
    verdicts = [[(v.cost, v.allowed, v.reason) for v in step.checks] for step in first.steps]
    if verdicts != [[(v.cost, v.allowed, v.reason) for v in step.checks] for step in again.steps]:
        yield "the same steps had different verdicts"
    for number, step in enumerate(first.steps, 1):
        for verdict in step.checks:
            if not verdict.cost >= 0:
                yield f"step {number}: its cost is {verdict.cost}, and costs are not negative"
            if verdict.cost > 0 and not verdict.reason:
                yield f"step {number}: it has a cost and no reason"


def check_contract(id, parameters=None):
    """Tries the laws of its kind on a registered planner or step check (docs/plugin-kinds.md): it does not crash, the same seed gives
    the same plan on any number of threads, no part leaves a closed box, it stops when it is asked to; a check has the same verdict
    for the same step, and says why it costs.

    id: such as 'acme.lines'. parameters: dict. Returns a list of sentences: what does not hold; empty: all does. Takes up to a minute.
    `dismantle plugins check` tries more laws on plugins that are files. Raises PluginError when there is no such type.
    """
    kind, parameters = describe(id)["kind"], dict(parameters or {})
    if kind == "step_check":
        return list(_check_problems(id, {"objective": [{"type": id, **parameters}]}))
    if kind not in ("path_planner", "sequence_planner"):
        raise ValueError(f"'{id}' is of the kind {kind}; `dismantle plugins check` tries its laws")
    return list(_planner_problems(id, kind, _config(id, kind, parameters)))
