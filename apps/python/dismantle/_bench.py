"""Benchmarks: running suites with planners that are written in Python, reading their databases."""
import os
import sys

import numpy as np

from . import _core, _planners


def bench(suite, output, jobs=1, on_progress=None, only=(), replace=False):
    """Runs a suite file (docs/benchmark.md), each trial in a process of its own; the same call again goes on where it stopped.

    Planners that are written in Python take part: the trials run the files in which they are registered (put what is not to be
    run there below `if __name__ == "__main__":`). output: folder for the results. jobs: concurrent trials. only: names of the
    planners whose trials are run; empty: all. replace: rows that were made with something else are run again.
    Returns a dict: total, done, solved, ran (numbers of trials), replaced (what is run again, and why), database (path).
    """
    command = [sys.executable, "-m", "dismantle._trial"]
    for file in _planners.source_files:
        command += ["--load", file]
    return _core._bench(os.fspath(suite), os.fspath(output), jobs, list(only), replace, command, on_progress)


def read_results(*paths):
    """The trials of benchmark databases, each once: dict of column name to numpy array, all of the same length.

    paths: databases, or folders with databases. Columns: those of the table `trials` (docs/benchmark.md): str, int, bool or float,
    nan where a trial has no number; verified and complete: True, False or None; progress: lists of (seconds, parts out); and
    counts.NAME and checks.NAME, float: what planners count, and what step checks cost.
    Raises InputError.
    """
    columns = _core._read_results([os.fspath(p) for p in paths])
    out = {}
    for name, (dtype, values) in columns.items():
        if dtype == "object":
            out[name] = np.empty(len(values), dtype=object)
            out[name][:] = values
        else:
            out[name] = np.array([np.nan if v is None else v for v in values], dtype=dtype)
    return out
