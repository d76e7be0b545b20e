"""The rows of one suite: runs `dismantle bench` and reads what `dismantle report` says."""
import csv
import io
import os
import re
import statistics
import subprocess
import sys


def output_of(*command):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: status {done.returncode}")
    return done.stdout


def rows_of(text):
    return list(csv.reader(io.StringIO(text)))


class SuiteResults:
    """`trials`: rows of the table of trials, one dict each; empty if there is no database."""

    def __init__(self, name, arguments, run):
        self.name, self.program = name, arguments.program
        self.folder = os.path.join(arguments.work, name)
        self.suite = os.path.join(arguments.suites, f"results_{name}.yaml")
        self.planned = self.count_planned()
        if run and self.planned > 0:
            command = [self.program, "bench", self.suite, "-o", self.folder, "--jobs", str(arguments.jobs)]
            done = subprocess.run(command, stdin=subprocess.DEVNULL)
            if done.returncode != 0:
                sys.exit(f"{' '.join(command)}: status {done.returncode}")
        there = os.path.isfile(os.path.join(self.folder, "results.db"))
        self.trials = list(csv.DictReader(io.StringIO(self.report("csv")))) if there else []
        if there:  # rows of assemblies that the suite finds no more count, too
            waiting = re.search(r"^> (\d+) trials are not done yet", self.report("markdown", "--table", "setup"), re.MULTILINE)
            self.planned = max(self.planned, len(self.trials) + (int(waiting[1]) if waiting else 0))
        self.labels = list(dict.fromkeys(self.label(t) for t in self.trials))

    def count_planned(self):
        """The number of trials of the suite; 0 if all of its assemblies are missing."""
        done = subprocess.run([self.program, "bench", self.suite, "--dry-run"], stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode != 0 and "the suite has no assembly" in done.stderr:
            return 0
        count = re.search(r": (\d+) trials$", done.stdout, re.MULTILINE)
        if done.returncode != 0 or not count:
            sys.exit(f"dismantle bench {self.suite} --dry-run: status {done.returncode}\n{done.stderr}")
        return int(count[1])

    def report(self, form, *more):
        return output_of(self.program, "report", self.folder, "--time", "cpu", "--format", form, *more)

    def table(self, name):
        rows = rows_of(self.report("csv", "--table", name))
        if len(rows[0]) == 3 and rows[0][2] == "overall":  # a single category
            rows = [row[:2] for row in rows]
        return rows

    def setup(self):
        return dict(rows_of(self.report("csv", "--table", "setup"))[1:])

    def label(self, trial):
        """As the reports name it: with the variant, if there are several."""
        several = len({t["variant"] for t in self.trials}) > 1
        return f"{trial['planner']} ({trial['variant']})" if several else trial["planner"]

    def of(self, label, assembly=None):
        return [t for t in self.trials if self.label(t) == label and assembly in (None, t["assembly"])]

    def assemblies(self):
        return list(dict.fromkeys(t["assembly"] for t in self.trials))

    def progress(self):
        """"182 trials", or "50 of 182 trials run"."""
        done = len(self.trials)
        return f"{done} trials" if done == self.planned else f"**{done} of {self.planned} trials run**"

    def seconds(self):
        return sum(float(t["wall s"]) for t in self.trials)


def is_solved(trial):
    return trial["solved"] == "yes"


def outcome_of(trial):
    """Why a trial is not solved, in one word."""
    if trial["outcome"] != "solved":
        return trial["outcome"]
    return "refused" if trial["verified"] == "no" else "not_verified"


def median_seconds(trials):
    return statistics.median(float(t["cpu s"]) for t in trials)


def markdown(rows):
    """A table in Markdown; the first row is the header."""
    lines = ["| " + " | ".join(str(cell).replace("|", "\\|") for cell in row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]]) + "\n"


def number(value):
    """Three digits."""
    return f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def cell_of(trials):
    """"0.36", "2/3: 1.2", or how the trials ended."""
    if not trials:
        return ""
    solved = [t for t in trials if is_solved(t)]
    if not solved:
        return "*" + "*, *".join(dict.fromkeys(outcome_of(t) for t in trials)) + "*"
    share = f"{len(solved)}/{len(trials)}: " if len(trials) > 1 else ""
    return share + number(median_seconds(solved))


def matrix(results):
    """Assemblies and planners."""
    return [["assembly", *results.labels],
            *([a, *(cell_of(results.of(label, a)) for label in results.labels)] for a in results.assemblies())]
