import pathlib
import subprocess
import sys

import numpy as np
import pytest

import dismantle
import planners_for_tests  # noqa: F401  (registers planners)

SUITE = """
schema: 1
assemblies: [{sample: stacked_box}, {sample: peg_in_hole}]
planners:
  lines: {set: {path_planner.type: test.lines, sequence_planner.type: progressive}}
  raises: {set: {path_planner.type: test.raises, sequence_planner.type: progressive}}
  bfs: {set: {path_planner.type: bfs, sequence_planner.type: progressive}}
seeds: 1..2
limits: {timeout: 60}
"""


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bench")
    (folder / "suite.yaml").write_text(SUITE)
    done = dismantle.bench(folder / "suite.yaml", folder / "results", jobs=2)
    assert (done["total"], done["done"], done["ran"], done["solved"]) == (12, 12, 12, 8)
    assert dismantle.bench(folder / "suite.yaml", folder / "results")["ran"] == 0  # goes on where it stopped
    return folder / "results"


def test_planners_in_python_are_rows_like_all_others(results):
    columns = dismantle.read_results(results)
    assert {len(v) for v in columns.values()} == {12}
    counts = columns["counts.state_checks"]
    assert counts.dtype == float and (counts[columns["planner"] == "lines"] > 0).all()
    assert columns["solved"].dtype == bool and columns["wall_seconds"].dtype == float and columns["seed"].dtype == np.int64
    for planner, solved in (("lines", True), ("bfs", True), ("raises", False)):
        mine = columns["planner"] == planner
        assert mine.sum() == 4 and (columns["solved"][mine] == solved).all()
        assert sorted(set(columns["seed"][mine])) == [1, 2]
        if solved:
            assert (columns["verified"][mine] == True).all()  # noqa: E712
            assert (columns["removed"][mine] == columns["parts"][mine] - 1).all()
    assert (columns["outcome"][columns["planner"] == "raises"] == "crashed").all()
    with pytest.raises(dismantle.InputError):
        dismantle.read_results(results / "nothing")


def test_memory_that_runs_out_in_python(tmp_path):
    (tmp_path / "suite.yaml").write_text("""
schema: 1
assemblies: [{sample: l_slot}]
planners: {memory: {set: {path_planner.type: test.memory, sequence_planner.type: progressive}}}
limits: {timeout: 60, memory: 3072}
""")
    dismantle.bench(tmp_path / "suite.yaml", tmp_path / "results")
    columns = dismantle.read_results(tmp_path / "results")
    assert columns["outcome"].tolist() == ["out_of_memory"], columns["last_words"]


def test_the_example_that_plots(results, source, tmp_path):
    picture = tmp_path / "comparison.png"
    matplotlib = subprocess.run([sys.executable, "-c", "import matplotlib"], capture_output=True)
    if matplotlib.returncode != 0:
        pytest.skip("matplotlib is not installed")
    out = subprocess.run([sys.executable, source / "apps/python/examples/compare_planners.py", results, "-o", picture],
                         capture_output=True, text=True, check=True).stdout
    assert "lines: 4 of 4" in out and "raises: 0 of 4" in out
    assert pathlib.Path(picture).read_bytes().startswith(b"\x89PNG")
