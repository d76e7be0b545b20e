"""Running the program that is under test: $DISMANTLE."""
import json
import os
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["DISMANTLE"]
VIEWER = os.path.exists(os.path.join(os.path.dirname(PROGRAM), "..", "share", "dismantle", "viewer.html"))  # was it built
HANGING = 300  # seconds after which a program that should have ended long ago is taken for hanging


class CliTest(unittest.TestCase):
    """Each test runs in a folder of its own."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="dismantle-cli-")
        self.addCleanup(self._folder.cleanup)
        self.folder = self._folder.name

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(content)
        return name

    def read(self, *names):
        with open(self.path(*names), encoding="utf-8") as file:
            return file.read()

    def run_program(self, *arguments, status=None, env=None, stdout=subprocess.PIPE, preexec_fn=None, program=PROGRAM):
        done = subprocess.run([program, *arguments], cwd=self.folder, text=True, encoding="utf-8", timeout=HANGING,
                              stdin=subprocess.DEVNULL, stdout=stdout, stderr=subprocess.PIPE, preexec_fn=preexec_fn,
                              env={**os.environ, **(env or {})})
        if status is not None:
            self.assertEqual(done.returncode, status, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def result_of(self, done):
        """The JSON object that must be the last line of standard output."""
        self.assertTrue(done.stdout.endswith("\n"), done.stdout)
        lines = done.stdout.splitlines()
        result = json.loads(lines[-1])
        for key in ("status", "wall_seconds", "cpu_seconds", "peak_rss_mb", "plan"):
            self.assertIn(key, result)
        self.assertEqual(len(lines), 1, "everything else goes to standard error")
        return result

    def assert_fails(self, status, message, *arguments):
        """Fails with this status and a message that holds the text; with --format json in one JSON line too."""
        done = self.run_program(*arguments, status=status)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stdout, "", "errors go to standard error")
        return done


def box(lo, hi):
    """A box as OBJ text."""
    text = ""
    for i in range(8):
        text += "v {} {} {}\n".format(*(hi[k] if i >> k & 1 else lo[k] for k in range(3)))
    for quad in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
        text += "f {} {} {} {}\n".format(*(i + 1 for i in quad))
    return text


def text_of_plan(parts=("a", "b")):
    """A plan without steps."""
    return json.dumps({
        "format": "dismantle.plan", "version": 1, "generator": {"name": "test", "version": "1"},
        "assembly": {"source": "missing", "sha256": "00", "scale": 1, "center": [0, 0, 0], "bbox": [[0, 0, 0], [1, 1, 1]],
                     "parts": [{"id": i, "name": n, "file": n + ".obj"} for i, n in enumerate(parts)],
                     "excluded": [{"name": "foil", "reason": "not watertight"}], "overlaps": []},
        "status": "partial", "seed": 1, "verified_max_penetration": 0.01, "disassembly": [], "assembly_steps": [],
        "remaining": list(parts),
        "unsolved": [{"part": parts[0], "outcome": "depth_limit", "blocked_by": [parts[1]],
                      "best_pose": [0, 0, 0.25, 1, 0, 0, 0], "message": "12 nodes"}]})
