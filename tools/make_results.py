#!/usr/bin/env python3
"""Writes docs/results: the comparison of all planners, in the form of the paper's tables 2 to 4.

  tools/make_results.py [--data DIR] [--program build/release/bin/dismantle] [--work build/results] [--jobs N] [--only SUITE]... [--no-run]

Runs the suites configs/bench/results_*.yaml with `dismantle bench`, which resumes an earlier run (delete the work folder to start
again), and writes the output of `dismantle report`: README.md with the tables, and for each suite a plot of success over time and
a CSV file of all trials. DIR contains the third-party assemblies; without it only the samples are compared. --only is for these
suites alone, --no-run runs none; of suites that are not complete the page says how many trials were run.
"""
import argparse
import os
import sys

sys.dont_write_bytecode = True

from results_page import fidelity, paper  # noqa: E402
from results_page.causes import CAUSES  # noqa: E402
from results_page.suite_results import SuiteResults, is_solved, markdown, matrix, output_of  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

# Suite, title, description, the paper's limits, tables of `dismantle report`, each with a title and the paper's figures.
SECTIONS = [
    ("two_part", "Two parts (table 2, left)",
     "One part is taken out, the other one is fixed. Path planners, each asked for the same path. The paper: 300 s, six seeds.",
     [("success", "Success (%)", paper.TWO_PART)]),
    ("rotational", "Parts that have to turn, and puzzles (table 2, right)",
     "Screws, mazes, bayonets of two parts. Path planners, as before. The paper: 600 s, six seeds.",
     [("success", "Success (%)", paper.ROTATIONAL)]),
    ("multi_part", "Whole assemblies (tables 3 and 4)",
     "The first six rows are the paper's methods: its baselines and `full_bfs` with the sequence planner `queue`, `prog_bfs` with "
     "`progressive`. The other rows are sequence planners, named as such, with the path planner `guided`; `ndbg` asks no path planner. "
     "The paper: 120 s for an attempt, 7200 s for an assembly, three seeds.",
     [("sizes", "Success by number of parts (%), table 3", paper.SIZES),
      ("time", "Mean time per part (s), over assemblies that all planners solved, table 4", paper.TIMES)]),
]


def best(results, most=4):
    """The planners that solved most trials, as text."""
    counts = {label: [is_solved(t) for t in results.of(label)] for label in results.labels}
    order = sorted(counts, key=lambda label: -sum(counts[label]) / len(counts[label]))  # stable: ties in the order of the suite
    return ", ".join(f"`{p}` {sum(counts[p])} of {len(counts[p])}" for p in order[:most])


def without_solution(results):
    """Why a planner solved nothing: how its trials ended, and the cause where it is known."""
    none = [label for label in results.labels if not any(is_solved(t) for t in results.of(label))]
    text = "### How trials ended\n\n" + markdown(results.table("outcomes"))
    if none:
        text += "\nPlanners that solved nothing here:\n\n"
    for label in none:
        cause = CAUSES.get((results.name, label.removesuffix(" (plain)")), "the cause was not looked into.")
        text += f"- `{label}`: {cause}\n"
    return text


def section(results, title, words, tables, arguments):
    text = f"\n## {title}\n\n{words}\n"
    if not results.trials:
        return text + f"\n{results.progress() if results.planned else 'Its assemblies are not here'}.\n"
    count = len(results.assemblies())
    text += f"\n{count} assembl{'y' if count == 1 else 'ies'}, {results.progress()}: {', '.join(results.assemblies())}. Most solved: {best(results)}.\n"
    for table, heading, figures in tables:
        rows = results.table(table)
        text += f"\n### {heading}\n\n{markdown(rows)}\n{markdown(paper.table(figures))}"
        if table == "time":
            text += f"\n{paper.common_times(results)}"
            continue
        text += ("\nBeside the paper, judged by the 95 % interval of our share (equal: the paper's share lies within it):\n\n"
                 f"{paper.compared(figures, rows)}\n{paper.unsolved_endings(results, [paper.OURS[name] for name in figures['rows']])}")
        text += paper.attempt_limit(results) if results.name == "multi_part" else ""
    text += ("\n### Assemblies and planners\n\nMedian CPU seconds of the solved trials, with solved/trials where there are several seeds; "
             f"otherwise how the trials ended.\n\n{markdown(matrix(results))}")
    text += f"\n{without_solution(results)}"
    text += f"\n### Success over time\n\n![Share of trials solved within a time]({results.name}.svg)\n"
    text += f"\n### Precision of the plans\n\n{markdown(results.table('precision'))}"
    suite = os.path.relpath(results.suite, arguments.out)
    return text + f"\nAll trials: [{results.name}.csv]({results.name}.csv). Suite: [results_{results.name}.yaml]({suite}).\n"


def write_files(results, arguments, forms):
    for form in forms if results.trials else ():
        with open(os.path.join(arguments.out, f"{results.name}.{form}"), "w", encoding="utf-8", newline="\n") as file:
            file.write(results.report(form).replace("\r\n", "\n"))


def how_it_was_run(every):
    """Limits, tolerance, seeds, machine, commit and date of each suite, from its rows."""
    keys = ["limits", "tolerance of the verifier", "seeds", "Dismantle", "machine", "date"]
    rows = [["suite", "trials", *keys]]
    for results in every:
        if results.trials:
            setup = results.setup()
            rows.append([results.name, results.progress(), *(setup[key] for key in keys)])
    return markdown(rows)


def head(every, arguments):
    trials = [t for results in every for t in results.trials]
    claimed = [t for t in trials if not is_solved(t) and t["outcome"] == "solved"]
    refused = sum(t["verified"] == "no" for t in claimed)
    starved = sum(t["outcome"] == "wall_limit" for t in trials)
    note = f" {arguments.note}" if arguments.note else ""
    if starved:
        note += (f" **{starved} trial{'s were' if starved > 1 else ' was'} ended by the limit of wall-clock time**, before the limit of CPU time: "
                 "the machine was busy with other work, and what such a planner solves within its CPU time is not known.")
    docs = os.path.relpath(os.path.join(ROOT, "docs"), arguments.out)
    only = "".join(f" --only {name}" for name in arguments.only or ())
    return f"""# Results

All planners on the same assemblies, made by one command, which resumes a run that was interrupted:

```
tools/make_results.py --data DIR{only}
```

{how_it_was_run(every)}
{len(trials)} trials, {sum(r.seconds() for r in every) / 3600:.1f} hours of wall-clock time of the planning processes in all.
The page was written by {output_of(arguments.program, "--version").splitlines()[0]}.{note}

How to read it: a trial is **solved** when the planner says so *and* the verifier, in a process of its own and on the original triangles,
finds the plan valid; {refused} trials were claimed and refused, of {len(claimed) - refused} the verification did not end within its limit.
In brackets: the 95 % interval of Wilson, then solved/trials; seeds that changed nothing are one observation. The paper's limits are named in
each section; where ours are smaller, a row says what a planner solves within them, not what it can solve at all.
The assemblies are few and of our choice, so the intervals are wide; the paper's figures beside ours are of its own data set of
thousands, and are there for their form and for the order of the methods, not for the numbers.
Times are CPU seconds, from reading the input to the plan. **Precision** is the deepest penetration that the verifier certifies along a whole
plan, beyond the overlap of the parts when assembled, of an assembly scaled to size 10; the tolerance is in the table above.

[benchmark.md]({docs}/benchmark.md) says how suites, limits and reports work; [planners]({docs}/planners/README.md) what the path planners do.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    names = [entry[0] for entry in SECTIONS] + fidelity.SUITES
    parser.add_argument("--data", default=os.environ.get("DISMANTLE_DATA", ""), help="folder of assemblies; default: $DISMANTLE_DATA")
    parser.add_argument("--program", default=os.path.join(ROOT, "build/release/bin/dismantle"))
    parser.add_argument("--work", default=os.path.join(ROOT, "build/results"), help="folder of the databases")
    parser.add_argument("--suites", default=os.path.join(ROOT, "configs/bench"), help="folder of results_*.yaml: other limits, more seeds")
    parser.add_argument("--out", default=os.path.join(ROOT, "docs/results"))
    parser.add_argument("--note", default="", help="what a reader has to know of this run, such as other jobs on the machine")
    parser.add_argument("--jobs", type=int, default=1, help="trials at the same time; more than one disturb each other's times")
    parser.add_argument("--only", action="append", choices=names, help="this suite only; may be repeated. The page has no other")
    parser.add_argument("--no-run", action="store_true", help="run nothing: the page of what the databases hold")
    arguments = parser.parse_args()
    if arguments.data:
        os.environ["DISMANTLE_DATA"] = os.path.abspath(arguments.data)
    os.makedirs(arguments.out, exist_ok=True)

    every = [SuiteResults(name, arguments, run=not arguments.no_run) for name in names if name in (arguments.only or names)]
    text = ""
    for name, title, words, tables in SECTIONS:
        for results in every:
            if results.name == name:
                text += section(results, title, words, tables, arguments)
                write_files(results, arguments, ("svg", "csv"))
    published = [results for results in every if results.name in fidelity.SUITES]
    if published:
        text += fidelity.section(published, os.path.relpath(os.path.join(ROOT, "configs/paper.yaml"), arguments.out))
    for results in published:
        write_files(results, arguments, ("csv",))
    with open(os.path.join(arguments.out, "README.md"), "w", encoding="utf-8") as file:
        file.write(head(every, arguments) + text)
    print(f"wrote {os.path.relpath(arguments.out)}: {sum(len(r.trials) for r in every)} of {sum(r.planned for r in every)} trials, "
          f"{sum(r.seconds() for r in every):.0f} s")


if __name__ == "__main__":
    main()
