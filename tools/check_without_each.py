#!/usr/bin/env python3
"""Builds and tests the project without each of its plugin folders in turn. One folder is one plugin, and the project must
build and pass without it (docs/architecture.md). For each folder: configures with -DDISMANTLE_WITHOUT=FOLDER, builds the
programs and the remaining tests, and runs the fast tests. All use the same build folder, so that only dependent targets are
rebuilt; with ccache the second run is cheap.

  tools/check_without_each.py                       all folders of DISMANTLE_SHIPPED_PLUGINS (cmake/DismantleFolders.cmake)
  tools/check_without_each.py planners/path/bfs     only these folders
  tools/check_without_each.py --configure-only      only configure: seconds per folder
  tools/check_without_each.py --tests REGEX         other tests than the fast ones

Exit status 0: all passed. Each line of the summary names the folder, the tests that were left out, and the time."""
import argparse
import os
import re
import subprocess
import sys
import time

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
# Tests that take seconds: of every library, and tests that load plugins.
FAST = ("core_tests geometry_tests preparation_tests plan_io_tests book_tests engine_tests plugins_tests plugins_good_tests configs_tests "
        "shipped_plugins_are_found sdf_tests sdf_world_tests path_common_tests push_search_tests ompl_common_tests progressive_tests "
        "queue_tests random_tests mesh_files_test").split()
COMMAND_LINE = r"cli_\w+"  # a test for each module of tests/cli
# Targets that these tests run besides the programs.
HELPERS = ("dismantle_contract_tests", "evil_planners")


def shipped():
    with open(os.path.join(ROOT, "cmake", "DismantleFolders.cmake"), encoding="utf-8") as file:
        found = re.search(r"set\(DISMANTLE_SHIPPED_PLUGINS\s([^)]*)\)", file.read())
    return found.group(1).split()


def run(log, *command):
    """Runs a command with output to the log; returns its exit status."""
    log.write(f"\n$ {' '.join(command)}\n")
    log.flush()
    return subprocess.run(command, cwd=ROOT, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL).returncode


def check(folder, build, jobs, tests, configure_only, log):
    """Returns the failed stage, or an empty string, and the tests that were left out."""
    at = log.tell()
    if run(log, "cmake", "-S", ".", "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DDISMANTLE_BUILD_BENCH=OFF",
           f"-DDISMANTLE_WITHOUT={folder}"):
        return "configure", []
    log.flush()
    with open(log.name, encoding="utf-8", errors="replace") as written:
        written.seek(at)
        left_out = re.findall(r"Test left out: (.*?) needs", written.read())
    if configure_only:
        return "", left_out
    listed = subprocess.run(["ninja", "-C", build, "-t", "targets", "all"], stdout=subprocess.PIPE, text=True, check=True).stdout
    targets = set(re.findall(r"^(\w+): phony$", listed, re.MULTILINE))
    wanted = ["programs"] + [t for t in [*FAST, *HELPERS] if t in targets]
    if run(log, "cmake", "--build", build, "--parallel", str(jobs), "--target", *wanted):
        return "build", left_out
    if run(log, "ctest", "--test-dir", build, "--parallel", str(jobs), "--no-tests=error", "--output-on-failure",
           "--tests-regex", tests):
        return "tests", left_out
    return "", left_out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", metavar="FOLDER")
    parser.add_argument("--build", default="build/without", help="build folder (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--tests", default="^(" + "|".join([*FAST, COMMAND_LINE]) + ")$", metavar="REGEX", help="tests to run")
    parser.add_argument("--configure-only", action="store_true")
    arguments = parser.parse_args()
    known = shipped()
    for folder in arguments.folders:
        if folder.rstrip("/") not in known:
            parser.error(f"{folder} is none of {', '.join(known)}")
    folders = [f.rstrip("/") for f in arguments.folders] or known
    summary, failed = [], False
    os.makedirs(os.path.join(ROOT, arguments.build), exist_ok=True)
    with open(os.path.join(ROOT, arguments.build, "without_each.log"), "w", encoding="utf-8") as log:
        for folder in folders:
            begin = time.monotonic()
            problem, left_out = check(folder, arguments.build, arguments.jobs, arguments.tests, arguments.configure_only, log)
            failed = failed or bool(problem)
            summary.append(f"{'FAILED: ' + problem if problem else 'ok':<18}{folder}  ({time.monotonic() - begin:.0f} s)"
                           f"  left out: {', '.join(left_out) or 'nothing'}")
            print(summary[-1], flush=True)
        print(f"check_without_each: {'FAILED' if failed else 'all passed'}; output in {log.name}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
