"""Suites for tests: small, fast, with planners that misbehave."""
import json
import os
import re
import sqlite3
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["DISMANTLE"]
EVIL = os.environ["EVIL_FOLDER"]
HANGING = 600  # seconds after which a program that should have ended long ago is taken for hanging

OTHER_THAN_TIMES = re.compile(r'"(seconds|source)": [^,\n]*')


class BenchTest(unittest.TestCase):
    """Each test runs in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="dismantle-bench-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.write_evil()

    def write_evil(self):
        self.write("evil.yaml", f"schema: 1\nplugins: {{search_paths: [{EVIL}]}}\nsimulator: {{type: fcl}}\n"
                                "path_planner: {type: evil.none}\nsequence_planner: {type: progressive}\n"
                                "immobility: {provers: []}\n")  # without them a trial takes a tenth of a second

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def read(self, *names):
        with open(self.path(*names), encoding="utf-8") as file:
            return file.read()

    def evil(self, *names):
        """Lines of `planners:`."""
        return "".join(f"  {n}: {{config: evil.yaml, set: {{path_planner.type: evil.{n}}}}}\n" for n in names)

    def suite(self, planners, assemblies="  - {sample: l_slot, part: slider}\n", more="seeds: 1\n",
              limits="timeout: 60, wall: 300, memory: 2048", name="suite.yaml"):
        self.write(name, f"schema: 1\nassemblies:\n{assemblies}planners:\n{planners}{more}limits: {{{limits}}}\n")

    def start(self, *arguments):
        return subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def call(self, *arguments, status=0):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=HANGING)
        self.assertEqual(done.returncode, status, f"{arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def bench(self, *arguments, suite="suite.yaml", out="out"):
        done = self.call("bench", suite, "-o", out, "--format", "json", *arguments)
        return json.loads(done.stdout.splitlines()[-1])

    def rows(self, sql="SELECT * FROM trials ORDER BY id", database="out/results.db"):
        db = sqlite3.connect(self.path(database))
        db.row_factory = sqlite3.Row
        self.assertEqual(db.execute("PRAGMA integrity_check").fetchone()[0], "ok")
        found = db.execute(sql).fetchall()
        db.close()
        return found

    def assert_each_once(self, count, database="out/results.db"):
        rows = self.rows(database=database)
        self.assertEqual(len(rows), count)
        self.assertEqual({r["state"] for r in rows}, {"done"})
        self.assertEqual(len({(r["assembly"], r["variant"], r["planner"], r["seed"]) for r in rows}), count)


def without_times(plan):
    return OTHER_THAN_TIMES.sub("", plan)
