#!/usr/bin/env python3
"""Whole plans, from import to verified plan: CPU seconds, and as ratios to a sample of the same run; or instruction counts.

    tests/bench/end_to_end.py                       # samples, and assemblies of $DISMANTLE_DATA if it is set
    tests/bench/end_to_end.py --parts 250 1000 3000 # the sample `machine` with these numbers of parts: seconds and memory by size
    tests/bench/end_to_end.py --callgrind peg_in_hole
    tests/bench/end_to_end.py --against OTHER/bin/dismantle   # is every plan the same but for its times?

CPU seconds of a machine that has other work mean little; the ratio to the reference, planned before and after each
assembly, means more, and the instructions that callgrind counts are the same each time. One thread.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
REFERENCE = "peg_in_hole"
SAMPLES = ["stacked_box", "l_slot", "peg_in_hole", "machine"]
TIMES = {"seconds", "wall_seconds", "cpu_seconds"}


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    if done.returncode not in (0, 1):  # 1: a plan that leaves parts in
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stderr}")
    return done


def make_sample(program, name, folder, settings=()):
    target = folder / "-".join([name, *(s.replace("=", "_") for s in settings)])
    if not target.exists():
        run([program, "sample", name, "-o", target, *(x for s in settings for x in ("--set", s))])
    return target


def plan(program, source, folder):
    """Its summary, and plan.json without what a clock wrote."""
    out = folder / "plan"
    done = run([program, "plan", source, "-o", out, "--threads", "1", "--format", "json", "-q"])
    return json.loads(done.stdout.splitlines()[-1]), without_times(json.loads((out / "plan.json").read_text()))


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES}
    if isinstance(value, list):
        return [without_times(v) for v in value]
    return value


def instructions(program, source, folder):
    """As callgrind counts them: needs valgrind."""
    out = folder / "callgrind.out"
    done = run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program, "plan", source, "-o",
                folder / "plan", "--threads", "1", "-q"])
    return next(int(line.split()[-1].replace(",", "")) for line in done.stderr.splitlines() if "Collected" in line), out


def assemblies(arguments, folder):
    if arguments.inputs:
        return [(pathlib.Path(i).stem, i) if os.path.exists(i) else (i, make_sample(arguments.program, i, folder))
                for i in arguments.inputs]
    if arguments.parts:
        return [(f"machine {n}", make_sample(arguments.program, "machine", folder, [f"parts={n}"]))
                for n in arguments.parts]
    found = [(name, make_sample(arguments.program, name, folder)) for name in SAMPLES]
    data = os.environ.get("DISMANTLE_DATA")
    for source in sorted(pathlib.Path(data).glob("*/*")) if data else []:
        if source.is_dir() or source.suffix.lower() in (".step", ".stp", ".3mf", ".glb"):
            found.append((f"{source.parent.name}/{source.name}", source))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inputs", nargs="*", help="files, folders, or names of samples")
    parser.add_argument("--program", default=ROOT / "build/release/bin/dismantle", type=pathlib.Path)
    parser.add_argument("--against", type=pathlib.Path, help="another build: its figures beside, and whether plans differ")
    parser.add_argument("--parts", nargs="+", type=int, metavar="N")
    parser.add_argument("--repeat", type=int, default=3, help="the median counts")
    parser.add_argument("--callgrind", action="store_true", help="instructions in place of seconds")
    arguments = parser.parse_args()
    programs = [arguments.program] + ([arguments.against] if arguments.against else [])
    differ = False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        reference = make_sample(arguments.program, REFERENCE, folder)
        for label, source in assemblies(arguments, folder):
            if arguments.callgrind:
                print(f"{label:40}", *(f"{instructions(p, source, folder)[0]:16,}" for p in programs), flush=True)
                continue
            seconds, units, plans, memory = [[] for _ in programs], [], [None] * len(programs), 0
            for _ in range(arguments.repeat):
                for k, program in enumerate(programs):
                    units.append(plan(program, reference, folder)[0]["cpu_seconds"])
                    summary, plans[k] = plan(program, source, folder)
                    seconds[k].append(summary["cpu_seconds"])
                    memory = max(memory, summary["peak_rss_mb"])
            unit = statistics.median(units)
            figures = [f"{statistics.median(s):9.3f} s {statistics.median(s) / unit:8.2f} x" for s in seconds]
            same = all(p == plans[0] for p in plans)
            differ = differ or not same
            print(f"{label:40}", *figures, f"{memory:8.1f} MB", "" if same else "plans differ", flush=True)
    sys.exit(1 if differ else 0)


if __name__ == "__main__":
    main()
