"""What docs/python.md says is run as it stands."""
import os
import re
import subprocess
import sys


def test_the_page_is_run_literally(source, tmp_path):
    text = (source / "docs" / "python.md").read_text()
    blocks = re.findall(r"^```python(?: file=(\S+))?\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 6
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])}
    for file, code in blocks:
        if file:
            (tmp_path / file).write_text(code)
            continue
        (tmp_path / "block.py").write_text(code)
        done = subprocess.run([sys.executable, "-B", "block.py"], cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, code + done.stdout + done.stderr
        if "bench(" in code:
            assert "lines 1.0" in done.stdout and "bfs 1.0" in done.stdout
    assert (tmp_path / "plan.json").is_file()
