#!/usr/bin/env python3
"""Prints what the units of the last build cost, the dearest first, and the sum of each folder.

The times are those of the build tool's log (wall time of each command, seconds): build on a quiet machine with
CCACHE_DISABLE=1 and an empty build folder to compare two states of the code. With a compiler cache, units that were
found in it show only the time of the look-up.
"""
import argparse
import collections
import pathlib
import re
import sys


def durations(log):
    """Seconds by output file; the latest entry of each output counts."""
    seconds = {}
    for line in log.read_text().splitlines():
        fields = line.split("\t")
        if line.startswith("#") or len(fields) < 4:
            continue
        seconds[fields[3]] = (int(fields[1]) - int(fields[0])) / 1000
    return seconds


def folder_of(output):
    """The source folder that a command's output belongs to."""
    name = re.sub(r"CMakeFiles/[^/]*\.dir/", "", output)
    parts = [p for p in name.split("/")[:-1] if p not in ("Unity", "src", "..")]
    return "/".join(parts[:3]) or "."


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default="build/release", type=pathlib.Path, help="build folder (build/release)")
    parser.add_argument("--top", type=int, default=30, help="units to print (30)")
    arguments = parser.parse_args()
    log = arguments.build / ".ninja_log"
    if not log.is_file():
        sys.exit(f"{log} does not exist: build first, with the generator Ninja")
    seconds = durations(log)
    units = {o: s for o, s in seconds.items() if o.endswith((".o", ".gch"))}
    others = {o: s for o, s in seconds.items() if o not in units}
    folders = collections.Counter()
    for output, s in units.items():
        folders[folder_of(output)] += s
    print(f"{len(units)} units compiled in {sum(units.values()) / 60:.1f} min, {len(others)} other commands in {sum(others.values()) / 60:.1f} min")
    print("\nunits")
    for output, s in sorted(units.items(), key=lambda entry: -entry[1])[: arguments.top]:
        print(f"{s:8.1f}  {output}")
    print("\nfolders")
    for folder, s in folders.most_common(arguments.top):
        print(f"{s:8.1f}  {folder}")


if __name__ == "__main__":
    main()
