"""Laws of `dismantle report`: what it says does not depend on how the rows were spread, and pages need nothing else."""
import csv
import io
import json
import os
import re
import shutil
import sqlite3
import tempfile
import unittest
import xml.etree.ElementTree

from benching import BenchTest


class Report(BenchTest):
    PLANNERS = "  t_rrt: {set: {simulator.type: fcl, path_planner.type: t_rrt, sequence_planner.type: progressive}}\n"
    TRIALS = 2 * 2 * 3  # assemblies, planners, seeds

    shared = None  # one suite, run once, for all tests

    def setUp(self):
        if Report.shared is not None:
            self.folder = Report.shared.name
            return
        Report.shared = tempfile.TemporaryDirectory(prefix="dismantle-report-")
        self.addClassCleanup(Report.shared.cleanup)
        self.folder = Report.shared.name
        self.write_evil()
        self.suite(self.PLANNERS + self.evil("none"), more="seeds: 1..3\n",
                   assemblies="  - {sample: l_slot, category: slide}\n"
                              "  - {sample: stacked_box, name: stacked_box, set: {count: 1}, category: 'many <&> |'}\n")
        self.bench("--jobs", "2")

    def report(self, *arguments):
        return self.call("report", *arguments).stdout

    def split(self, parts, folder="shards"):
        """The rows dealt out to several databases, as shards have them."""
        os.makedirs(self.path(folder))
        for i in range(parts):
            name = self.path(folder, f"shard-{i + 1}-of-{parts}.db")
            shutil.copy(self.path("out/results.db"), name)
            db = sqlite3.connect(name)
            for table, column in (("plans", "trial"), ("progress", "trial"), ("searches", "trial"), ("search_nodes", "trial"),
                                  ("trials", "id")):
                db.execute(f"DELETE FROM {table} WHERE {column} % {parts} <> {i}")
            db.commit()
            db.close()

    def test_merged_shards_are_the_whole(self):
        self.split(5)
        for form in ("text", "markdown", "csv", "svg", "html"):
            self.assertEqual(self.report("out", "--format", form), self.report("shards", "--format", form))
        # The same rows twice are the same rows.
        self.assertEqual(self.report("out", "--format", "csv"), self.report("out", "shards", "--format", "csv"))

    def test_a_hundred_shards_are_the_whole_and_nothing_counts_twice(self):
        self.split(100, "hundred")  # most of them are empty, as those of tasks that came too late are
        whole = self.report("out", "--format", "csv")
        self.assertEqual(whole, self.report("hundred", "--format", "csv"))
        self.assertEqual(whole, self.report("hundred", "out", "hundred", "--format", "csv"))
        self.assertIn("24 rows were in several databases", self.report("hundred", "out", "hundred", "--format", "html"))

    def test_real_shards_are_the_whole_matrix(self):
        for i in (1, 2, 3):
            self.bench("--shard", f"{i}/3", out="sharded")
        whole, sharded = (list(csv.DictReader(io.StringIO(self.report(d, "--format", "csv")))) for d in ("out", "sharded"))
        fixed = ("row", "assembly", "category", "parts", "planner", "variant", "seed", "solved", "removed")
        self.assertEqual([[r[c] for c in fixed] for r in whole], [[r[c] for c in fixed] for r in sharded])

    def test_figures(self):
        rows = list(csv.DictReader(io.StringIO(self.report("out", "--format", "csv"))))
        self.assertEqual(len(rows), self.TRIALS)
        solved = [r for r in rows if r["planner"] == "t_rrt" and r["solved"] == "yes"]
        text = self.report("out", "--table", "success")
        self.assertRegex(text, rf"t_rrt .* {len(solved)}/6(, n = [2-5])?\n")
        # Three seeds that change nothing are one observation: the interval is that of 0 of 2.
        self.assertRegex(text, r"none .* 0\.0 \[0\.0, 65\.8\] 0/6, n = 2\n")
        per_part = {}
        for r in solved:
            per_part.setdefault(r["assembly"], []).append(float(r["seconds"]) / float(r["removed"]))
        mean = sum(sum(times) / len(times) for times in per_part.values()) / len(per_part)
        self.assertIn(f"{mean:.3g} ({len(per_part)} of {len(per_part)})", self.report("out", "--table", "time"))

        cpu = list(csv.DictReader(io.StringIO(self.report("out", "--time", "cpu", "--format", "csv"))))
        for row in cpu:
            self.assertAlmostEqual(float(row["seconds"]), float(row["cpu s"]), delta=0.001 + 0.01 * float(row["cpu s"]))
        self.assertNotEqual([r["seconds"] for r in cpu], [r["seconds"] for r in rows])

        depths = sorted(float(r["deepest"]) for r in solved)
        cells = self.report("out", "--table", "precision", "--format", "csv").splitlines()[1].split(",")
        self.assertEqual(cells[:2], ["t_rrt", str(len(solved))])
        for cell, depth in zip(cells[2:], (depths[0], depths[(len(depths) - 1) // 2], depths[-1])):
            self.assertAlmostEqual(float(cell), depth, delta=0.06 * depth)

    def test_the_picture_stands_alone(self):
        root = xml.etree.ElementTree.fromstring(self.report("out", "--format", "svg"))
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertEqual(len([e for e in root.iter() if e.tag.endswith("path")]), 2)  # a curve for each planner
        self.assertIn("exclude", self.call("report", "out", "--format", "svg", "--table", "time", status=2).stderr)

    def test_page_is_self_contained(self):
        page = self.report("out", "--format", "html")
        self.assertNotRegex(page, r"https?:(?!//www\.w3\.org/2000/svg')|src=|@import|url\(|<link")
        self.assertIn("many &lt;&amp;&gt; |", page)
        self.assertIsNone(re.search(r"many <&>", page))
        self.assertIn("many <&> \\|", self.report("out", "--format", "markdown"))

    def test_rows_link_to_their_plans(self):
        self.call("report", "out", "--format", "html", "--plans", "-o", "page.html")
        links = re.findall(r"<a href='(page\.plans/\d+\.json)'", self.read("page.html"))
        self.assertEqual(len(links), self.TRIALS)
        for link in links:
            self.assertEqual(json.loads(self.read(link))["format"], "dismantle.plan")

    def test_a_row_opens_its_plan(self):
        self.call("report", "out", "--format", "html", "--pages", "-o", "shown.html")
        links = re.findall(r"<a href='(shown\.plans/\d+\.html)'", self.read("shown.html"))
        self.assertEqual(len(links), self.TRIALS)
        for link in links:
            self.assertIn("<!doctype html>", self.read(link).lower())
        self.assertIn("--pages needs --format html", self.call("report", "out", "--pages", status=2).stderr)

    def rows_of(self, name, out):
        return list(csv.DictReader(io.StringIO(self.report(out, "--table", name, "--format", "csv"))))

    def table(self, name, *arguments):
        return list(csv.DictReader(io.StringIO(self.report("out", "--table", name, "--format", "csv", *arguments))))

    def test_what_it_was_made_with(self):
        setup = {r["what"]: r["value"] for r in self.table("setup")}
        self.assertEqual(setup["limits"], "120 s for a path, 60 s of planning, 300 s of wall-clock time, 300 s of CPU time, 2048 MiB, 1 thread")
        self.assertEqual(setup["seeds"], "1..3")
        row = self.rows("SELECT * FROM trials ORDER BY started")[0]
        self.assertEqual(setup["machine"], f"{row['host']}, {row['cpu_model']}")
        self.assertEqual(setup["Dismantle"], row["version"])
        self.assertRegex(row["version"], r"^\d+\.\d+\.\d+( \([0-9a-f]{7,40}(-dirty)?\))?$")
        self.assertTrue(setup["date"].startswith(row["started"]))
        # CPU times change nothing of the set-up.
        self.assertEqual(self.table("setup"), self.table("setup", "--time", "cpu"))
        planners = {r["planner"]: r for r in self.table("planners")}
        self.assertIn("path_planner: t_rrt", planners["t_rrt"]["consists of"])
        self.assertIn("path_planner: evil.none", planners["none"]["consists of"])

    def test_pairs(self):
        """Observations: one per assembly where the seeds of both planners changed nothing."""
        [pair] = self.table("pairs")
        self.call("report", "out", "--format", "html", "--plans", "-o", "pairs.html")
        steps = set()
        for row in self.table("trials"):
            if row["planner"] == "t_rrt":
                plan = json.loads(self.read(f"pairs.plans/{row['row']}.json"))
                steps.add((row["assembly"], json.dumps([{**step, "seconds": 0} for step in plan["disassembly"]])))
        n = len(steps)
        self.assertEqual((pair["n"], pair["both"], pair["only A"], pair["only B"]), (str(n), "0", str(n), "0"))
        self.assertAlmostEqual(float(pair["p solved"]), 2 * 0.5**n, delta=0.006)
        self.assertEqual(pair["p sooner"], pair["p solved"])  # the other one gave up: whoever solved was sooner

    def test_times_to_solution(self):
        solution = {r["planner"]: r for r in self.table("solution")}
        self.assertEqual([solution["none"][c] for c in ("trials", "solved", "censored", "never", "25 %")], ["6", "0", "0", "6", "-"])
        seconds = sorted(float(r["seconds"]) for r in self.table("trials") if r["planner"] == "t_rrt")
        for column, k in (("25 %", 1), ("50 %", 2), ("75 %", 4)):  # of 6
            self.assertAlmostEqual(float(solution["t_rrt"][column]), seconds[k], delta=0.006 * seconds[k])

    def test_arena(self):
        self.call("report", "out", "--arena", "arena.db")
        db = sqlite3.connect(self.path("arena.db"))
        tables = {r[0] for r in db.execute("SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite_%'")}
        self.assertEqual(tables, {"experiments", "plannerConfigs", "enums", "runs", "progress"})
        self.assertEqual(db.execute("SELECT count(*) FROM runs").fetchone()[0], self.TRIALS)
        # Every run has an experiment, a planner, and a status with a name.
        joined = db.execute("SELECT count(*) FROM runs r JOIN experiments e ON e.id = r.experimentid JOIN plannerConfigs p ON "
                            "p.id = r.plannerid JOIN enums n ON n.name = 'status' AND n.value = r.status").fetchone()[0]
        self.assertEqual(joined, self.TRIALS)
        self.assertEqual(dict(db.execute("SELECT name, runcount FROM experiments")), {"l_slot": 3, "stacked_box": 3})
        db.close()

    # The columns of version 3. Another list needs another version, or databases of before cannot be continued.
    COLUMNS = (
        "id INTEGER, assembly TEXT NOT NULL, variant TEXT NOT NULL, planner TEXT NOT NULL, seed INTEGER NOT NULL, "
        "category TEXT NOT NULL, part TEXT NOT NULL, planner_hash TEXT NOT NULL, config_hash TEXT NOT NULL, "
        "limit_path_timeout REAL NOT NULL, limit_path_steps INTEGER NOT NULL, limit_timeout REAL NOT NULL, "
        "limit_wall REAL NOT NULL, limit_cpu REAL NOT NULL, limit_memory_mb INTEGER NOT NULL, "
        "threads INTEGER NOT NULL, verify_max_penetration REAL NOT NULL, state TEXT NOT NULL, owner TEXT, "
        "owner_host TEXT, lease_until REAL, outcome TEXT, solved INTEGER, verified INTEGER, complete INTEGER, "
        "max_penetration REAL, verification TEXT, signal INTEGER, exit_status INTEGER, last_words TEXT, input TEXT, "
        "input_sha256 TEXT, parts INTEGER, excluded INTEGER, removed INTEGER, left_together INTEGER, steps INTEGER, "
        "direction_changes INTEGER, off_axis INTEGER, path_length REAL, path_turns REAL, checks TEXT, "
        "wall_seconds REAL, cpu_seconds REAL, peak_rss_mb REAL, load_seconds REAL, prepare_seconds REAL, "
        "plan_seconds REAL, solve_seconds REAL, proof_seconds REAL, verify_seconds REAL, attempts INTEGER, "
        "memoised INTEGER, simulated_steps REAL, nodes REAL, collision_checks REAL, counts TEXT, host TEXT, "
        "cpu_model TEXT, version TEXT, started TEXT, ended TEXT, ")

    def test_columns_of_the_database(self):
        db = sqlite3.connect(self.path("out/results.db"))
        columns = [f"{name} {kind}{' NOT NULL' if needed else ''}" for _, name, kind, needed, _, _ in db.execute("PRAGMA table_info(trials)")]
        db.close()
        self.assertEqual(columns, self.COLUMNS.rstrip(", ").split(", "))

    def test_columns_are_found_by_name(self):
        """A database of another build, which lacks a column and has another: the rest is read."""
        os.makedirs(self.path("other"))
        shutil.copy(self.path("out/results.db"), self.path("other"))
        db = sqlite3.connect(self.path("other/results.db"))
        db.execute("ALTER TABLE trials DROP COLUMN memoised")
        db.execute("ALTER TABLE trials ADD COLUMN mood TEXT")
        db.commit()
        db.close()
        self.assertEqual(self.report("out", "--format", "csv"), self.report("other", "--format", "csv"))

    def test_a_database_of_version_2_is_read_and_continued(self):
        os.makedirs(self.path("old"))
        shutil.copy(self.path("out/results.db"), self.path("old"))
        db = sqlite3.connect(self.path("old/results.db"))
        for column in ("direction_changes", "off_axis", "path_length", "path_turns", "checks"):
            db.execute(f"ALTER TABLE trials DROP COLUMN {column}")
        db.execute("UPDATE suite SET value = '2' WHERE key = 'store_version'")
        db.commit()
        db.close()
        self.assertEqual(self.report("out", "--table", "success"), self.report("old", "--table", "success"))
        self.assertIn("plans", self.report("old", "--table", "plans"))
        self.assertEqual(self.bench(out="old")["ran"], 0)
        db = sqlite3.connect(self.path("old/results.db"))
        names = {name for _, name, *_ in db.execute("PRAGMA table_info(trials)")}
        self.assertEqual(db.execute("SELECT value FROM suite WHERE key = 'store_version'").fetchone()[0], "3")
        db.close()
        self.assertEqual(names, {column.split()[0] for column in self.COLUMNS.rstrip(", ").split(", ")})

    def test_plans_and_counts_have_tables(self):
        plans = self.report("out", "--table", "plans", "--format", "csv").splitlines()
        self.assertEqual(plans[0].split(",")[:4], ["planner", "assemblies", "steps", "changes of direction"])
        trials = list(csv.DictReader(self.report("out", "--format", "csv").splitlines()))
        solved = [row for row in trials if row["solved"] == "yes"]
        self.assertTrue(solved)
        for row in solved:
            self.assertGreater(float(row["path length"]), 0)
        counts = self.report("out", "--table", "counts", "--format", "csv").splitlines()[0].split(",")[2:]
        self.assertEqual(counts, sorted(name.removeprefix("counts.") for name in trials[0] if name.startswith("counts.")
                                        and any(row[name] for row in solved)))

    def test_tables_of_the_suite(self):
        """A table of the suite has the means of the columns that it names, over all trials or the solved ones."""
        more = ("seeds: 1..2\nsearch_nodes: 50\nobjective: [{type: directions, weight: 0}]\ntables:\n"
                "  - {id: acme.effort, title: Effort of all, columns: [attempts, counts.iterations, checks.directions,"
                " counts.refused, counts.itertions], trials: all}\n"
                "  - {id: solved_ones, columns: [steps]}\n")
        self.suite(self.PLANNERS + self.evil("none"), more=more, assemblies="  - {sample: stacked_box}\n", name="own.yaml")
        self.bench(suite="own.yaml", out="own")
        table = self.rows_of("acme.effort", out="own")
        self.assertEqual(list(table[0]), ["planner", "assemblies", "attempts", "counts.iterations", "checks.directions",
                                          "counts.refused", "counts.itertions"])
        self.assertIn("No trial has `counts.itertions`; there are counts.", self.report("own", "--table", "acme.effort"))
        self.assertEqual({line["counts.itertions"] for line in table}, {"-"})
        rows = self.rows(database="own/results.db")
        for line in table:  # what a planner counts in one trial, and not in another, is 0 there
            mine = [json.loads(r["counts"]) for r in rows if r["planner"] == line["planner"] and r["counts"]]
            for name in ("iterations", "refused"):
                if any(name in counts for counts in mine):
                    mean = sum(counts.get(name, 0) for counts in mine) / len(mine)
                    self.assertAlmostEqual(float(line[f"counts.{name}"]), mean, delta=1e-3 * mean)
                else:
                    self.assertEqual(line[f"counts.{name}"], "-")
        for line in table:
            mine = [r["attempts"] for r in rows if r["planner"] == line["planner"]]
            self.assertAlmostEqual(float(line["attempts"]), sum(mine) / len(mine), places=2)
        self.assertEqual({line["planner"] for line in self.rows_of("solved_ones", out="own")}, {"t_rrt", "none"})
        self.assertIn("Effort of all", self.report("own", "--format", "html"))
        self.assertIn("there is no such table; there are setup, ", self.call("report", "own", "--table", "efort", status=2).stderr)

    def test_progress_of_trials_and_searches(self):
        """Shares never fall, and end where the trials ended; points and nodes are rows of the database."""
        planners = "  bfs: {set: {path_planner.type: bfs, sequence_planner.type: progressive}}\n"
        self.suite(planners, more="search_nodes: 20\n", assemblies="  - {sample: peg_in_hole}\n", name="searches.yaml")
        self.bench(suite="searches.yaml", out="searches")
        points = self.rows("SELECT * FROM searches ORDER BY rowid", "searches/results.db")
        self.assertTrue(points)
        for before, after in zip(points, points[1:]):
            if before["search"] == after["search"]:
                self.assertGreater(after["best"], before["best"])
                self.assertGreaterEqual(after["effort"], before["effort"])
        nodes = self.rows("SELECT * FROM search_nodes ORDER BY search, node", "searches/results.db")
        self.assertTrue(0 < len(nodes) <= 20)
        self.assertTrue(all(-1 <= n["parent"] < n["node"] for n in nodes))
        for table in ("progress", "searches"):
            line = self.rows_of(table, out="searches")[0]
            shares = [float(share) for share in list(line.values())[2:]]
            self.assertEqual(shares, sorted(shares))
        self.assertEqual(float(list(self.rows_of("progress", out="searches")[0].values())[-1]), 100)
        page = self.report("searches", "--format", "html")
        self.assertIn("Progress of searches", page)
        self.call("report", "searches", "--row", "1", "-o", "row")
        trees = json.loads(self.read("row/search_trees.json"))
        self.assertEqual(sum(len(tree["nodes"]) for tree in trees), len(nodes))
        self.assertEqual(self.read("row/search_trees.html").count("<circle"), len(nodes))

    def test_what_cannot_be_reported(self):
        os.makedirs(self.path("empty"))
        self.assertIn("holds no results", self.call("report", "empty", status=3).stderr)
        self.write("text.db", "this is no database, and long enough to be looked at as one\n" * 20)
        self.assertIn("text.db", self.call("report", "text.db", status=3).stderr)
        self.assertIn("there are 12 rows", self.call("report", "out", "--row", "13", "-o", "x", status=2).stderr)


if __name__ == "__main__":
    unittest.main()
