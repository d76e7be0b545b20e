#!/usr/bin/env python3
"""Runs the fuzz targets of a build with the preset `fuzz`, and says what they did.

  tests/fuzz/fuzz.py                          two minutes, divided among all targets
  tests/fuzz/fuzz.py --cpu-minutes 30         the long form: CPU minutes for each target
  tests/fuzz/fuzz.py --targets obj,plan       only these

Seeds come from the samples, made by the release build; what is found stays in build/fuzz/corpus, so runs add up. Results of
all runs: build/fuzz/results.json. Exit status 1: a target crashed, took more than 10 s for one input, leaked, or used too
much memory; the input lies in build/fuzz/found.
"""

import argparse
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import seeds

ROOT = pathlib.Path(__file__).resolve().parents[2]
SLICE = 150  # s of a turn in the long form: all targets get somewhere when it is ended early
LONGEST_INPUT = {"plan": 200000, "results": 200000, "assimp": 65536, "step_file": 65536, "configuration": 8192,
                 "suite": 8192, "prepare": 1024}


def targets_of(folder):
    return sorted(f.name[len("fuzz_"):] for f in folder.glob("fuzz_*") if f.name != "fuzz_step_seeds" and os.access(f, os.X_OK))


def run_target(name, folder, seconds, seed, hang):
    """Returns what it did: executions, coverage, CPU seconds, and whether something was found."""
    corpus, found = folder.parent / "corpus" / name, folder.parent / "found" / name
    corpus.mkdir(parents=True, exist_ok=True)
    found.mkdir(parents=True, exist_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = ROOT / "test/fuzz/words" / (name + ".dict")
    command = [str(folder / ("fuzz_" + name)), str(corpus), "-artifact_prefix=%s/" % found, "-max_total_time=%d" % seconds,
               "-timeout=%d" % hang, "-rss_limit_mb=2048", "-malloc_limit_mb=1024", "-print_final_stats=1", "-seed=%d" % seed,
               "-max_len=%d" % LONGEST_INPUT.get(name, 16384), "-close_fd_mask=1"]
    if words.exists():
        command.append("-dict=%s" % words)
    environment = dict(os.environ, ASAN_OPTIONS="allocator_may_return_null=0:detect_leaks=1",
                       LSAN_OPTIONS="suppressions=%s:print_suppressions=0" % (ROOT / "tools/lsan_suppressions.txt"),
                       DISMANTLE_PLUGIN_PATH=str(folder.parent / "lib/dismantle/plugins"))
    # Descriptor 1 is closed within the target: what a reader prints is not of interest.
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
                               env=environment, preexec_fn=lambda: os.nice(19), start_new_session=True)
    try:
        _, log = process.communicate(timeout=seconds + 120 + hang)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        _, log = process.communicate()
        log += "\nkilled: it did not end\n"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    (folder.parent / "found" / (name + ".log")).write_text(log)
    runs = re.findall(r"stat::number_of_executed_units:\s+(\d+)", log) or re.findall(r"^#(\d+)\s", log, re.M)
    coverage = re.findall(r"cov: (\d+) ft: (\d+)", log)
    return {"target": name, "executions": int(runs[-1]) if runs else 0,
            "edges": int(coverage[-1][0]) if coverage else 0, "features": int(coverage[-1][1]) if coverage else 0,
            "cpu_seconds": round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1),
            "failed": process.returncode != 0}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/fuzz")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/dismantle")
    parser.add_argument("--targets", help="names, separated by commas")
    parser.add_argument("--seconds", type=float, default=120, help="of all targets together")
    parser.add_argument("--cpu-minutes", type=float, help="of each target, in turns")
    parser.add_argument("--hang", type=int, default=10,
                        help="wall seconds for one input that count as a hang; more where the machine is busy with other things")
    parser.add_argument("--seed", type=int, default=1, help="of the mutations")
    options = parser.parse_args()
    folder = options.build / "fuzz"
    names = options.targets.split(",") if options.targets else targets_of(folder)
    if not names:
        sys.exit("no targets in %s: cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_targets" % folder)
    corpus = options.build / "corpus"
    if not (corpus / "plan").exists():
        seeds.make_seeds(options.program, folder / "fuzz_step_seeds", ROOT, corpus)
    seeds.copy_regressions(ROOT, corpus)

    record = options.build / "results.json"
    total = json.loads(record.read_text()) if record.exists() else {}
    failed, spent, turn = set(), dict.fromkeys(names, 0.0), 0
    turns = len(names)
    queue = list(names)
    while queue:
        name = queue.pop(0)
        turn += 1
        seconds = options.seconds / turns if options.cpu_minutes is None else SLICE
        result = run_target(name, folder, max(1, int(seconds)), options.seed + turn, options.hang)
        spent[name] += result["cpu_seconds"]
        known = total.setdefault(name, {"executions": 0, "cpu_seconds": 0, "failures": 0})
        known["executions"] += result["executions"]
        known["cpu_seconds"] = round(known["cpu_seconds"] + result["cpu_seconds"], 1)
        known["failures"] += result["failed"]
        known["edges"], known["features"] = result["edges"], result["features"]
        record.write_text(json.dumps(total, indent=1) + "\n")
        print("%s  %-14s %9d executions, %6d edges, %7.1f CPU s%s" % (
            time.strftime("%H:%M:%S"), name, result["executions"], result["edges"], result["cpu_seconds"],
            "  FAILED: see %s" % (options.build / "found" / (name + ".log")) if result["failed"] else ""), flush=True)
        if result["failed"]:
            failed.add(name)
        if options.cpu_minutes is not None and spent[name] < 60 * options.cpu_minutes:
            queue.append(name)
    print("all runs of this build so far:")
    for name, known in sorted(total.items()):
        print("  %-14s %10d executions, %6d edges, %8.1f CPU s, %d failures" % (
            name, known["executions"], known["edges"], known["cpu_seconds"], known["failures"]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
