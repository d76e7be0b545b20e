"""Loading, planning, verifying: the functions around the compiled part."""
import json
import os

from . import _core
from ._notebook import remember
from ._settings import settings


def _load(path, config=None, set=None):
    """Reads and prepares an assembly: a folder of mesh files (one part each), or one file with several parts. Same rules and
    configuration as `dismantle plan`. Raises InputError, ConfigError."""
    return remember(_core.Assembly._load(os.fspath(path), *settings(config, set)), _load, os.path.abspath(path), config, set)


def _from_meshes(meshes, config=None, set=None, unit=""):
    """An assembly of arrays. meshes: dict of part name to (vertices (N, 3) float, triangles (F, 3) int, counter-clockwise seen
    from outside), in assembled position. unit: 'mm', 'inch', 'm', or empty."""
    return remember(_core.Assembly._from_meshes(dict(meshes), unit, *settings(config, set)), _from_meshes, dict(meshes), config, set, unit)


def _from_sample(name, config=None, set=None, **parameters):
    """A sample that the project makes itself, as `dismantle sample` does; see samples(). parameters: those of the sample."""
    return remember(_core.Assembly._from_sample(name, parameters, *settings(config, set)), _from_sample, name, config, set, **parameters)


for _function, _name in ((_load, "load"), (_from_meshes, "from_meshes"), (_from_sample, "from_sample")):
    _function.__name__, _function.__qualname__ = _name, f"Assembly.{_name}"
    _function.__module__ = "dismantle"  # where pickle finds it
    setattr(_core.Assembly, _name, staticmethod(_function))


def run(assembly, config=None, set=None, seed=None, threads=None, timeout=None, path_timeout=None, part="", on_progress=None,
        should_stop=None):
    """Takes an assembly apart and returns the Plan. Every step in it has been verified, but those that are marked as forced.

    assembly: an Assembly, or the path of an input.
    config: path of a YAML file, or a dict with the keys of one (docs/configuration.md).
    set: dict of dotted keys, such as {"path_planner.type": "bfs"}; they win over config.
    seed, threads, timeout, path_timeout: the keys of that name in the section run. Same input, configuration and seed give
        the same plan, on any number of threads.
    part: name of a part: plan just its path, all other parts being fixed.
    on_progress(phase, done, total, detail): called now and then, from another thread; total 0 = unknown.
    should_stop(): called some fifty times a second; True stops the run.

    Ctrl-C (once) and should_stop stop the run and give the plan so far; then plan.info["interrupted"] is True. A second
    Ctrl-C raises KeyboardInterrupt when the run has stopped. Raises ConfigError, InputError, PluginError, Error.
    """
    if not isinstance(assembly, _core.Assembly):
        assembly = _load(assembly, config, set)
    file, overrides = settings(config, set, run_seed=seed, run_threads=threads, run_timeout=timeout, run_path_timeout=path_timeout)
    return _core._run(assembly, file, overrides, part, on_progress, should_stop)


def verify(plan, assembly=None, tolerance=None):
    """Checks a plan against the original triangles, independently of its planner; returns a Verification.

    assembly: an Assembly, the path of the input, or None: the input that the plan names. The parts are prepared anew.
    tolerance: penetration above the initial overlap that is tolerated, assembly units; None: that of the plan, at most the largest one of the plan format.
    """
    return _core._verify(plan, assembly, None if tolerance is None else float(tolerance))


def plugins(kind=None):
    """All plugin types, those that are written in Python included: list of dicts with id, kind, summary, source, needs,
    provides, parameters (list of dicts: name, type, unit, default, range, doc) and plugin (file, version, licence).

    kind: 'path_planner', 'step_check', ... (docs/plugin-kinds.md); None: all.
    """
    types = [json.loads(text) for text in _core._descriptions("")]
    kinds = _core._kinds()
    if kind is not None and kind not in kinds:
        raise ValueError(f"unknown kind '{kind}'; there are {', '.join(kinds)}")
    return [t for t in types if kind is None or t["kind"] == kind]


def describe(id):
    """The entry of plugins() with that id. Raises PluginError when there is none."""
    return json.loads(_core._descriptions(id)[0])


def resolved_config(config=None, set=None):
    """The complete configuration as YAML text, every value with where it came from. Plugins have to be in files, for their hashes."""
    return _core._resolved(*settings(config, set), os.curdir)
