#!/usr/bin/env python3
"""Counts lines of code outside of tests, and declared parameters.

    tools/count_code.py            # by folder
    tools/count_code.py --limits   # fails if there are more of either than the project allows

Lines: of the .cpp and .h files that git knows, without test/, test_support/, tests/ and plugins/testing; neither blank nor comment. Parameters: rows of the tables of
docs/reference, which is generated from the declarations (advanced parameters, on a page of their own, do not count).
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
MOST_LINES = 63000
MOST_PARAMETERS = 200


def is_counted(path):
    folders = pathlib.PurePath(path).parts[:-1]
    return not {"test", "tests", "test_support"} & set(folders) and folders[:2] != ("plugins", "testing")


def code_lines(text):
    """Lines that are neither blank nor comment."""
    count, inside = 0, False
    for line in text.splitlines():
        line = line.strip()
        if inside:
            inside, line = "*/" not in line, line.partition("*/")[2].strip()
        elif line.startswith("/*"):
            inside, line = "*/" not in line, line.partition("*/")[2].strip()
        count += bool(line) and not inside and not line.startswith("//")
    return count


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limits", action="store_true", help="fail beyond %d lines or %d parameters" % (MOST_LINES, MOST_PARAMETERS))
    options = parser.parse_args()
    listed = subprocess.run(["git", "ls-files", "-z", "*.cpp", "*.h"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    folders = collections.Counter()
    for path in filter(is_counted, listed.split("\0")[:-1]):
        folders["/".join(path.split("/")[:2])] += code_lines((ROOT / path).read_text())
    pages = [page for page in (ROOT / "docs/reference").glob("*.md") if page.name != "advanced.md"]
    parameters = sum(len(re.findall(r"^\| `", page.read_text(), re.MULTILINE)) for page in pages)
    if not options.limits:
        for folder, lines in sorted(folders.items()):
            print("%6d  %s" % (lines, folder))
    lines = folders.total()
    print("%d lines of code (limit %d), %d declared parameters (limit %d)" % (lines, MOST_LINES, parameters, MOST_PARAMETERS))
    return 1 if options.limits and (lines > MOST_LINES or parameters > MOST_PARAMETERS) else 0


if __name__ == "__main__":
    sys.exit(main())
