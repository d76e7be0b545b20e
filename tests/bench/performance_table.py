#!/usr/bin/env python3
"""The table of figures of docs/performance.md: by size, by threads, of verification, of the start, and of kernels.

    tests/bench/performance_table.py                           # everything; an hour on two cores
    tests/bench/performance_table.py --only parts threads      # some of it
    tests/bench/performance_table.py --against OTHER/build     # another build beside this one, each run after the other

CPU seconds of whole runs of the command line, files written, `--threads 1` unless said; median of --repeat runs, which are
made in turn for all builds. The command line's default objective, and without one beside. Markdown on standard output.
"""
import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECTIONS = ["parts", "threads", "verify", "start", "kernels"]
FOLDERS = ["cad", "threads", "two_part"]  # of the data, for verification
FOR_THREADS = ["cad/pushdevice", "cad/taranium_hub", "cad/fb_square_table", "cad/or_box"]
FOR_START = ["cad/pwjfea", "cad/asap_beam", "cad/industreal_round_peg_16mm"]
KERNELS = "ContactStep/.*/rigid:1|ContactStep_Feet/feet:2000$|Query_(GridValueAndGradient|ExactNearWithHint)$"
PLAIN = ["--set", "objective=[]"]


def run(command):
    """CPU seconds, wall seconds, MB at most, seconds until the first step was shown (None: no step)."""
    begin, first = time.monotonic(), None
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    tail = []
    for line in process.stderr:
        tail = (tail + [line])[-5:]
        if first is None and line.startswith("step 1:"):
            first = time.monotonic() - begin
    _, status, usage = os.wait4(process.pid, 0)
    code = os.waitstatus_to_exitcode(status)
    if code not in (0, 1):
        raise RuntimeError(f"{' '.join(map(str, command))}: exit status {code}\n{''.join(tail)}")
    return usage.ru_utime + usage.ru_stime, time.monotonic() - begin, usage.ru_maxrss / 1024, first


def median(runs, which):
    values = [r[which] for r in runs if r[which] is not None]
    return statistics.median(values) if values else float("nan")


class Table:
    def __init__(self, arguments, folder):
        self.builds = [arguments.build] + ([arguments.against] if arguments.against else [])
        self.repeat, self.folder, self.data, self.sizes = arguments.repeat, folder, arguments.data, arguments.sizes

    def program(self, build):
        return build / "bin/dismantle"

    def plans(self, source, extra=(), threads=1):
        """Runs of each build."""
        runs = [[] for _ in self.builds]
        for _ in range(self.repeat):
            for k, build in enumerate(self.builds):
                out = self.folder / f"plan{k}"
                command = [self.program(build), "plan", source, "-o", out, "--threads", threads]
                try:
                    runs[k].append(run([*command, *extra]))
                except RuntimeError as e:  # older builds have no objective, so that they plan without one
                    if list(extra) != PLAIN or "unknown key 'objective'" not in str(e):
                        raise
                    runs[k].append(run(command))
        return runs

    def figures(self, name, runs, which=0, digits=2):
        print(f"| {name} |", *(f"{median(r, which):.{digits}f} |" for r in reversed(runs)), flush=True)

    def head(self, title, what="CPU s"):
        columns = [f"before, {what}", f"now, {what}"] if len(self.builds) > 1 else [what]
        print(f"\n## {title}\n\n| | {' | '.join(columns)} |\n|---|{'---|' * len(columns)}")

    def sources(self, names):
        found = [(n, self.data / n) for n in names if self.data and (self.data / n).exists()]
        for name in set(names) - {n for n, _ in found}:
            print(f"{name}: not there", file=sys.stderr)
        return found

    def parts(self):
        self.head("Many parts")
        for count in self.sizes:
            source = self.folder / f"machine_{count}"
            run([self.program(self.builds[0]), "sample", "machine", "--set", f"parts={count}", "-o", source])
            runs = self.plans(source)
            self.figures(f"`sample machine`, {count} parts", runs)
            self.figures(f"{count} parts, MB", runs, 2, 0)
            self.figures(f"{count} parts, s until the first step is shown", runs, 3)
            self.figures(f"{count} parts, without objective", self.plans(source, PLAIN))
        for name, source in self.sources(["ldraw/models/21303.mpd"]):
            self.figures(name, self.plans(source))

    def threads(self):
        self.head("Threads", "wall s of 1, of 2, ratio")
        for name, source in self.sources(FOR_THREADS):
            one, two = self.plans(source), self.plans(source, threads=2)
            cells = [f"{median(a, 1):.2f}, {median(b, 1):.2f}, {median(b, 1) / median(a, 1):.2f}" for a, b in zip(one, two)]
            print(f"| {name} | {' | '.join(reversed(cells))} |", flush=True)

    def verify(self):
        self.head("Verification", "plan CPU s, verify CPU s, ratio")
        ratios = [[] for _ in self.builds]
        for group in FOLDERS if self.data else []:
            for source in sorted(s for s in (self.data / group).iterdir() if s.is_dir()):
                plans, cells = self.plans(source), []
                for k, build in enumerate(self.builds):
                    plan = self.folder / f"plan{k}/plan.json"
                    checks = [run([self.program(build), "verify", plan, "--assembly", source]) for _ in range(self.repeat)]
                    made, checked = median(plans[k], 0), median(checks, 0)
                    ratios[k].append(checked / made)
                    cells.append(f"{made:.2f}, {checked:.2f}, {checked / made:.2f}")
                print(f"| {group}/{source.name} | {' | '.join(reversed(cells))} |", flush=True)
        if ratios[0]:
            print("| median and largest ratio |",
                  *(f"{statistics.median(r):.2f}, {max(r):.2f} |" for r in reversed(ratios)), flush=True)

    def start(self):
        self.head("Start and straight lines")
        for name, source in self.sources(FOR_START):
            self.figures(name, self.plans(source), digits=3)

    def kernels(self):
        self.head("Kernels", "us")
        found = [{} for _ in self.builds]
        for k, build in enumerate(self.builds):
            done = subprocess.run([build / "tests/dismantle_bench", f"--benchmark_filter={KERNELS}", "--benchmark_format=json",
                                   f"--benchmark_repetitions={self.repeat}"], capture_output=True, text=True, check=True)
            for row in json.loads(done.stdout)["benchmarks"]:
                if row.get("aggregate_name") == "median" or self.repeat == 1:  # one run has no median
                    seconds = row.get("per_step", row.get("per_query"))
                    found[k][row["run_name"]] = 1e6 * seconds if seconds else float("nan")
        for name in found[0]:
            print(f"| `{re.sub('/repeats:.*', '', name)}` |", *(f"{f.get(name, float('nan')):.3f} |" for f in reversed(found)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--against", type=pathlib.Path, help="another build folder: its figures are `before`")
    parser.add_argument("--data", default=os.environ.get("DISMANTLE_DATA"), type=lambda p: pathlib.Path(p) if p else None)
    parser.add_argument("--only", nargs="+", choices=SECTIONS, default=SECTIONS)
    parser.add_argument("--sizes", nargs="+", type=int, default=[1000, 3000, 10000], help="parts of the sample `machine`")
    parser.add_argument("--repeat", type=int, default=3, help="the median counts")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        table = Table(arguments, pathlib.Path(folder))
        for section in arguments.only:
            getattr(table, section)()


if __name__ == "__main__":
    main()
