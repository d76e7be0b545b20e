"""The command line program that was installed with this package."""
import os
import sys


def main():
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "dismantle")
    if not os.path.isfile(program):
        sys.exit(f"{program} is not there: this package was installed without the program")
    os.execv(program, [program, *sys.argv[1:]])
