"""Benchmarks: running suites with planners that are written in Python, reading their databases."""
import os
import sys

import numpy as np

from . import _core, _planners


def bench(suite, output, jobs=1, on_progress=None):
    """Runs a suite file (docs/benchmark.md), each trial in a process of its own; the same call again goes on where it stopped.

    Planners that are written in Python take part: the trials run the files in which they are registered (put what is not to be
    run there below `if __name__ == "__main__":`). output: folder for the results. jobs: concurrent trials.
    Returns a dict: total, done, solved, ran (numbers of trials), database (path).
    """
    command = [sys.executable, "-m", "dismantle._trial"]
    for file in _planners.source_files:
        command += ["--load", file]
    return _core._bench(os.fspath(suite), os.fspath(output), jobs, command, on_progress)


def read_results(*paths):
    """The trials of benchmark databases, each once: dict of column name to numpy array, all of the same length.

    paths: databases, or folders with databases. Columns: assembly, variant, planner, category, part, outcome, host, version
    (str); seed (int); solved (bool); verified (object: True, False or None); parts, removed, max_penetration (assembly units),
    solve_seconds (float, nan where a trial has none); wall_seconds, cpu_seconds, peak_rss_mb, limit_timeout (s) (float); progress
    (object: list of (seconds, parts out)). Raises InputError.
    """
    columns = _core._read_results([os.fspath(p) for p in paths])
    out = {}
    for name, values in columns.items():
        if name == "progress" or name == "verified":
            out[name] = np.empty(len(values), dtype=object)
            out[name][:] = values
        elif name in ("parts", "removed", "max_penetration", "solve_seconds", "wall_seconds", "cpu_seconds", "peak_rss_mb",
                      "limit_timeout"):
            out[name] = np.array([np.nan if v is None else v for v in values], dtype=float)
        elif name == "seed":
            out[name] = np.array(values, dtype=np.int64)
        elif name == "solved":
            out[name] = np.array(values, dtype=bool)
        else:
            out[name] = np.array(values, dtype=str)
    return out
