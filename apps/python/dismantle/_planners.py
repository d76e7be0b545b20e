"""Planners and step checks that are written in Python."""
import inspect
import os
from dataclasses import dataclass, field
from typing import Optional, Union

from . import _core

# Source files of registered planners, for the processes of bench().
source_files = []


@dataclass(frozen=True)
class Parameter:
    """One parameter of a planner. It is given to the class as keyword argument `name`, and can be set in configurations.

    default: bool, int, float or str; it says the type. unit: of numbers ('s', 'rad', '1' = dimensionless). min, max: range of
    numbers; min_open, max_open: the bound itself is not allowed. choices: dict of allowed strings, each with its meaning.
    advanced: only studies change it; in configurations it is a key of the map `advanced`.
    """

    name: str
    default: Union[bool, int, float, str]
    doc: str
    unit: str = "1"
    min: Optional[float] = None
    max: Optional[float] = None
    min_open: bool = False
    max_open: bool = False
    choices: dict = field(default_factory=dict)
    advanced: bool = False


class PathPlanner:
    """Base of path planners: how is this part (or group) removed? The decorator @path_planner registers a class.

    One object is made per thread of the run, with the parameters as keyword arguments. The same parameters, query and random
    numbers (context.rng) have to give the same result.
    """

    def plan(self, query, context):
        """Answers a PathQuery. Returns

        - an accepted PathCheck (query.check(path)), or PathResult.solved(check, depth=...);
        - a path, (K, M, 7) or (K, 7) for one moving part: it is verified, and a refused one is the planner's fault;
        - PathResult.failed(outcome, message, blocked_by, best_pose), or None: nothing was found;
        - PathResult.start_is_goal().

        What it raises makes the attempt `crashed`, with the traceback as message.
        """
        raise NotImplementedError(f"{type(self).__name__} has no plan(query, context)")


class SequencePlanner:
    """Base of sequence planners: in which order do the parts come out? The decorator @sequence_planner registers a class."""

    keeps_constraints = False  # True: it follows oracle.constraints; else a run with constraints is refused

    def plan(self, assembly, oracle, context):
        """Asks the Oracle and books removals with oracle.remove(answer). Returns None, or the unsuccessful answers that say
        why parts are left. What it raises ends the search; the steps that were booked stay. After a forced step (run.force) it is
        called again with an assembly of those parts that are left."""
        raise NotImplementedError(f"{type(self).__name__} has no plan(assembly, oracle, context)")


@dataclass(frozen=True)
class StepVerdict:
    """The answer of a step check. cost: from 0 on, in the unit that the check documents. reason: one phrase, when there is a cost
    or a refusal. notes: StepNote objects for the reader of the plan."""

    cost: float = 0.0
    allowed: bool = True
    reason: str = ""
    notes: tuple = ()


class StepCheck:
    """Base of step checks: is a step an assembly operation that somebody can carry out? The decorator @step_check registers a class.

    The same StepQuestion has to have the same verdict at any time. A class with a method judge_plan(questions) also judges the plan
    as a whole: it is given all operations in the order of assembly, and returns a StepVerdict or None.
    """

    remembers = ()  # what is read of question.previous: 'direction', 'orientation' (up), 'shape' (moving); nothing else of it

    def judge(self, question):
        """Answers a StepQuestion with a StepVerdict, or None: allowed, without cost. What it raises is told in the plan."""
        raise NotImplementedError(f"{type(self).__name__} has no judge(question)")


@dataclass
class _Declared:
    id: str
    cls: type
    doc: str
    source: str
    version: str
    file: str
    needs: tuple
    parameters: tuple
    simultaneous_motion: bool


def _first_line(cls):
    text = inspect.cleandoc(cls.__doc__ or "")
    return text.splitlines()[0] if text else ""


def _decorator(base, register, id, parameters, doc, source, version, needs, simultaneous_motion):
    if not isinstance(id, str):
        raise TypeError("the decorator takes the id of the type: @dismantle.path_planner('acme.lines')")

    def decorate(cls):
        if not (isinstance(cls, type) and issubclass(cls, base)):
            raise TypeError(f"{cls!r} has to be derived from dismantle.{base.__name__}")
        # Otherwise a class that does not take the declared parameters would fail only at its first use.
        given = {p.name: p.default for p in parameters}
        try:
            inspect.signature(cls).bind(**given)
        except TypeError as error:
            raise TypeError(f"{cls.__name__}.__init__ does not take the declared parameters: {error}") from None
        try:
            file = os.path.abspath(inspect.getsourcefile(cls) or "")
        except (OSError, TypeError):  # a notebook, an interactive session
            file = ""
        if os.path.isfile(file):
            if file not in source_files:
                source_files.append(file)
        else:
            file = "<python>"
        register(_Declared(id, cls, doc or _first_line(cls), source, version, file, tuple(needs), tuple(parameters),
                           simultaneous_motion))
        return cls

    return decorate


def path_planner(id, parameters=(), *, needs=(), doc="", source="own", version="0", simultaneous_motion=False):
    """Class decorator that registers a PathPlanner under `id`, for every run from now on. Registering an id again replaces it.

    id: words of lower-case letters, digits and '_', joined by at least one dot ('acme.lines').
    parameters: Parameter objects. needs: what the simulator must have, of 'dynamics', 'contacts', 'distance'.
    doc: one line; default: the first line of the class's docstring. source: paper or reference.
    simultaneous_motion: the planner answers queries with any_of.
    """
    return _decorator(PathPlanner, _core._register_path_planner, id, parameters, doc, source, version, needs, simultaneous_motion)


def sequence_planner(id, parameters=(), *, doc="", source="own", version="0"):
    """Class decorator that registers a SequencePlanner under `id`; see path_planner."""
    return _decorator(SequencePlanner, _core._register_sequence_planner, id, parameters, doc, source, version, (), False)


def step_check(id, parameters=(), *, doc="", source="own", version="0"):
    """Class decorator that registers a StepCheck under `id`; see path_planner. Configurations name it in `objective`."""
    return _decorator(StepCheck, _core._register_step_check, id, parameters, doc, source, version, (), False)
