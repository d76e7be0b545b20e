#!/usr/bin/env python3
"""Writes docs/results: the comparison of all planners, in the form of the paper's tables 2 to 4.

  tools/make_results.py [--data DIR] [--program build/release/bin/dismantle] [--work build/results] [--jobs N]

Runs the suites configs/bench/results_*.yaml with `dismantle bench`, which resumes an earlier run (delete the work folder to start
again), and writes the output of `dismantle report`: README.md with the tables, and for each suite a plot of success over time and
a CSV file of all trials. DIR contains the third-party assemblies; without it only the samples are compared.
"""
import argparse
import csv
import io
import os
import platform
import subprocess
import sys

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

PAPER_TWO_PART = """| the paper | two-part |
|---|---|
| RRT | 84.5 |
| T-RRT | 97.4 |
| MV+T-RRT | 97.8 |
| BK-RRT | 93.7 |
| BFS | 99.8 |
| BFS, rotated at random | 99.8 |
"""
PAPER_ROTATIONAL = """| the paper | screw | puzzle | others | overall |
|---|---|---|---|---|
| RRT | 0.0 | 20.8 | 0.0 | 6.9 |
| T-RRT | 2.1 | 18.8 | 0.0 | 6.9 |
| MV+T-RRT | 12.5 | 18.8 | 0.0 | 10.4 |
| BK-RRT | 12.5 | 62.5 | 81.3 | 52.1 |
| BFS | 75.0 | 87.5 | 50.0 | 70.8 |
| BFS, rotated at random | 37.5 | 62.5 | 87.5 | 62.5 |
"""
PAPER_SIZES = """| the paper | small (3-9) | medium (10-49) | large (50+) | overall |
|---|---|---|---|---|
| RRT | 90.0 | 78.1 | 44.3 | 84.7 |
| T-RRT | 94.0 | 84.8 | 52.5 | 89.7 |
| MV+T-RRT | 94.2 | 85.2 | 53.8 | 90.0 |
| BK-RRT | 96.4 | 91.6 | 51.9 | 93.6 |
| Full BFS | 99.1 | 96.8 | 71.1 | 97.6 |
| Prog. BFS | 99.0 | 97.3 | 76.7 | 97.9 |
"""
PAPER_TIMES = """| the paper | small (3-9) | medium (10-49) | large (50+) | overall |
|---|---|---|---|---|
| Full BFS | 18.5 | 38.4 | 30.6 | 25.6 |
| Prog. BFS | 4.5 | 10.1 | 19.4 | 6.7 |
"""

# Suite, title, description, tables of `dismantle report`, each with a title and the paper's figures.
SECTIONS = [
    ("two_part", "Two parts (table 2, left)",
     "One part is taken out, the other one is fixed. Path planners, each asked for the same path.",
     [("success", "Success (%)", PAPER_TWO_PART)]),
    ("rotational", "Parts that have to turn, and puzzles (table 2, right)",
     "Screws, mazes, bayonets. Path planners, as before.",
     [("success", "Success (%)", PAPER_ROTATIONAL)]),
    ("multi_part", "Whole assemblies (tables 3 and 4)",
     "The first six rows are the paper's methods: its baselines and `full_bfs` with the sequence planner `queue`, `prog_bfs` with "
     "`progressive`. The other rows are sequence planners, named as such, with the path planner `guided`; `ndbg` asks no path planner.",
     [("sizes", "Success by number of parts (%), table 3", PAPER_SIZES),
      ("time", "Mean time per part (s), over assemblies that all planners solved, table 4", PAPER_TIMES)]),
]


def output_of(*command):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: status {done.returncode}")
    return done.stdout


def commit_of(root):
    if not os.path.exists(os.path.join(root, ".git")):
        return "unknown: the source is no repository"
    commit = output_of("git", "-C", root, "rev-parse", "--short=10", "HEAD").strip()
    changed = output_of("git", "-C", root, "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs").strip()
    return commit + (", with changes that are not committed" if changed else "")


def machine():
    model = platform.machine()
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    with open("/proc/meminfo", encoding="utf-8") as file:
        memory = int(file.readline().split()[1]) / 2**20
    with open("/etc/os-release", encoding="utf-8") as file:
        system = dict(line.rstrip().split("=", 1) for line in file if "=" in line).get("PRETTY_NAME", "").strip('"')
    return f"{model}, {os.cpu_count()} cores, {memory:.0f} GiB, {system}"


def markdown(rows):
    """A table in Markdown; the first row is the header."""
    lines = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]]) + "\n"


def suite_of(name, arguments):
    """Path of the suite, relative to the page."""
    return os.path.relpath(os.path.join(arguments.suites, f"results_{name}.yaml"), arguments.out)


class Results:
    """The results of one suite."""

    def __init__(self, name, arguments):
        self.program, self.folder = arguments.program, os.path.join(arguments.work, name)
        suite = os.path.join(arguments.suites, f"results_{name}.yaml")
        done = subprocess.run([self.program, "bench", suite, "-o", self.folder, "--jobs", str(arguments.jobs)], stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            sys.exit(f"dismantle bench {suite}: status {done.returncode}")
        self.trials = list(csv.DictReader(io.StringIO(self.report("csv"))))

    def report(self, form, *more):
        return output_of(self.program, "report", self.folder, "--time", "cpu", "--format", form, *more)

    def table(self, name):
        rows = list(csv.reader(io.StringIO(self.report("csv", "--table", name))))
        if len(rows[0]) == 3 and rows[0][2] == "overall":  # a single category
            rows = [row[:2] for row in rows]
        return rows

    def best(self, most=4):
        """The planners that solved most trials, as text."""
        solved, given = {}, {}
        for t in self.trials:
            if t["variant"] == "plain":
                given[t["planner"]] = given.get(t["planner"], 0) + 1
                solved[t["planner"]] = solved.get(t["planner"], 0) + (t["solved"] == "yes")
        order = sorted(solved, key=lambda planner: -solved[planner])  # stable: ties in the order of the suite
        return ", ".join(f"`{p}` {solved[p]} of {given[p]}" for p in order[:most])

    def seconds(self):
        return sum(float(t["wall s"]) for t in self.trials)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", default=os.environ.get("DISMANTLE_DATA", ""), help="folder of assemblies; default: $DISMANTLE_DATA")
    parser.add_argument("--program", default=os.path.join(ROOT, "build/release/bin/dismantle"))
    parser.add_argument("--work", default=os.path.join(ROOT, "build/results"), help="folder of the databases")
    parser.add_argument("--suites", default=os.path.join(ROOT, "configs/bench"), help="folder of results_*.yaml: other limits, more seeds")
    parser.add_argument("--out", default=os.path.join(ROOT, "docs/results"))
    parser.add_argument("--commit", help="what the program was built from, if that is not what is checked out")
    parser.add_argument("--note", default="", help="what a reader has to know of this run, such as other jobs on the machine")
    parser.add_argument("--jobs", type=int, default=1, help="trials at the same time; more than one disturb each other's times")
    arguments = parser.parse_args()
    if arguments.data:
        os.environ["DISMANTLE_DATA"] = os.path.abspath(arguments.data)
    os.makedirs(arguments.out, exist_ok=True)

    text, seconds, trials, refused, unverified = "", 0.0, 0, 0, 0
    for name, title, words, tables in SECTIONS:
        results = Results(name, arguments)
        seconds, trials = seconds + results.seconds(), trials + len(results.trials)
        claimed = [t for t in results.trials if t["solved"] == "no" and t["outcome"] == "solved"]
        refused += sum(t["verified"] == "no" for t in claimed)
        unverified += sum(t["verified"] != "no" for t in claimed)
        assemblies = list(dict.fromkeys(t["assembly"] for t in results.trials))
        text += f"\n## {title}\n\n{words} {len(assemblies)} assemblies, {len(results.trials)} trials: {', '.join(assemblies)}. Most solved: {results.best()}.\n"
        for table, heading, paper in tables:
            text += f"\n### {heading}\n\n{markdown(results.table(table))}\n{paper}"
        text += f"\n### Success over time\n\n![Share of trials solved within a time]({name}.svg)\n"
        text += f"\n### Precision of the plans\n\n{markdown(results.table('precision'))}"
        text += f"\nAll trials: [{name}.csv]({name}.csv). Suite: [results_{name}.yaml]({suite_of(name, arguments)}).\n"
        for form in ("svg", "csv"):
            with open(os.path.join(arguments.out, f"{name}.{form}"), "w", encoding="utf-8", newline="\n") as file:
                file.write(results.report(form).replace("\r\n", "\n"))

    head = f"""# Results

All planners on the same assemblies, made by one command:

```
tools/make_results.py --data DIR
```

| | |
|---|---|
| commit | {arguments.commit or commit_of(ROOT)} |
| program | {output_of(arguments.program, "--version").splitlines()[0]} |
| machine | {machine()} |
| run | one thread for each trial, {arguments.jobs} trial{"s" if arguments.jobs > 1 else ""} at a time; {trials} trials, {seconds / 60:.0f} minutes in all{"; " + arguments.note if arguments.note else ""} |

How to read it: a trial is **solved** when the planner says so *and* the verifier, in a process of its own and on the original triangles,
finds the plan valid; {refused} trials were claimed and refused, of {unverified} the verification did not end within the limit. In brackets: the 95 % interval of Wilson, then solved/trials. Limits are CPU
seconds (`limits` in the suites) and far smaller than the paper's, so that this page can be made in half an hour: a row here says what a planner solves within
seconds, not what it can solve at all. The assemblies are few and of our choice, so the intervals are wide; the paper's figures beside ours are of
its own data set of thousands, with its limits, and are there for their form and for the order of the methods, not for the numbers.
Times are CPU seconds of this machine, from reading the input to the plan. **Precision** is the deepest penetration that the verifier certifies along a whole plan, beyond the overlap of the parts when
assembled, of an assembly scaled to size 10; the tolerance is 0.01.

[benchmark.md](../benchmark.md) says how suites, limits and reports work; [planners](../planners/README.md) what the path planners do.
"""
    with open(os.path.join(arguments.out, "README.md"), "w", encoding="utf-8") as file:
        file.write(head + text)
    print(f"wrote {os.path.relpath(arguments.out)}: {trials} trials, {seconds:.0f} s")


if __name__ == "__main__":
    main()
