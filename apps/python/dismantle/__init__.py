"""Assembly planning by disassembly: load assemblies, plan with any plugin, verify, simulate, write planners.

    import dismantle
    plan = dismantle.run("gearbox/")
    for step in plan.steps:
        print(step.number, step.parts, {part: poses.shape for part, poses in step.moves.items()})

Poses are rows of seven numbers: x, y, z, qw, qx, qy, qz. Plans are in the units of the input; simulators and planners use
assembly units, in which the largest edge of the assembly is 10 (see Assembly).
"""
from ._core import (Answer, Assembly, Capabilities, Certificate, Contacts, Forced, Objective, ObjectiveItem, Oracle, Outcome, Overlap, Part,
                    PathCheck, PathQuery, PathResult, Plan, RunContext, Simulator, Step, StepNote, StepOverlap, StepQuestion, StepReport,
                    Unsolved, Verdict, Verification, World, Worlds, __version__, interpolate, load_plugin, plugin_problems, samples)
from ._bench import bench, read_results
from ._contract import check_contract
from ._errors import ConfigError, Diagnostic, Error, InputError, PluginError
from ._planners import (Parameter, PathPlanner, SequencePlanner, StepCheck, StepVerdict, path_planner, sequence_planner,
                        step_check)
from ._poses import compose, inverse, matrix, pose_of_matrix, transform
from ._run import describe, plugins, resolved_config, run, verify

__all__ = [
    "Answer", "Assembly", "Capabilities", "Certificate", "ConfigError", "Contacts", "Diagnostic", "Error", "Forced",
    "InputError", "Objective", "ObjectiveItem", "Oracle", "Outcome", "Overlap", "Parameter", "Part", "PathCheck",
    "PathPlanner", "PathQuery", "PathResult", "Plan", "PluginError", "RunContext", "SequencePlanner", "Simulator",
    "Step", "StepCheck", "StepNote", "StepOverlap", "StepQuestion", "StepReport", "StepVerdict", "Unsolved", "Verdict",
    "Verification", "World", "Worlds", "bench", "check_contract", "compose", "describe", "interpolate", "inverse", "load_plugin", "matrix",
    "path_planner", "plugin_problems", "plugins", "pose_of_matrix", "read_results", "resolved_config", "run", "samples",
    "sequence_planner", "step_check", "transform", "verify",
]
