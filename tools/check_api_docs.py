#!/usr/bin/env python3
"""Checks the comments of the public headers with Doxygen. Exit status 1: problems were found; 77: Doxygen is missing.

  tools/check_api_docs.py [--doxygen PROGRAM]

- docs/Doxyfile gives no warning;
- every type, free function, enumeration and alias has a comment. Class members with clear names need none.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
NOT_DOCUMENTED = re.compile(r"warning: (Compound|Member) (.*) is not documented\.$")


def warnings_of(doxygen, more):
    with tempfile.TemporaryDirectory() as folder, open(os.path.join(ROOT, "docs/Doxyfile"), encoding="utf-8") as file:
        text = file.read() + f"\nOUTPUT_DIRECTORY = {folder}\n{more}\n"
        done = subprocess.run([doxygen, "-"], input=text, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    if done.returncode != 0 and not lines:
        sys.exit(f"{doxygen} ended with status {done.returncode}")
    return lines


def needs_a_comment(line):
    found = NOT_DOCUMENTED.search(line)
    if not found or found.group(1) == "Compound":
        return found is not None
    return re.search(r" of (namespace|file) |\((enumeration|typedef)\)", found.group(2)) is not None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--doxygen", default="doxygen")
    doxygen = shutil.which(parser.parse_args().doxygen)
    if doxygen is None:
        print("check_api_docs: there is no doxygen (Debian: apt-get install doxygen)")
        return 77
    problems = warnings_of(doxygen, "")
    problems += filter(needs_a_comment, warnings_of(doxygen, "WARN_IF_UNDOCUMENTED = YES\nWARN_AS_ERROR = NO\nGENERATE_HTML = NO\nGENERATE_XML = YES"))
    for problem in problems:
        print(problem.replace(ROOT + "/", ""))
    print(f"check_api_docs: {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
