"""One trial of bench(), in a process of its own: python3 -m dismantle._trial [--load FILE]... [--verify] FOLDER"""
import argparse
import os
import runpy
import sys

from . import _core
from ._errors import ConfigError, Error, InputError, PluginError


def main():
    parser = argparse.ArgumentParser(prog="python3 -m dismantle._trial")
    parser.add_argument("--load", action="append", default=[], metavar="FILE")
    parser.add_argument("--verify", action="store_true")
    parser.add_argument("folder")
    arguments = parser.parse_args()
    try:
        if not arguments.verify:  # the verifier's process runs no planner's code
            for file in arguments.load:
                folder = os.path.dirname(os.path.abspath(file))
                if folder not in sys.path:  # a file imports its neighbours, as it does when Python runs it
                    sys.path.insert(0, folder)
                runpy.run_path(file, run_name="dismantle_plugin")
        _core._bench_trial(arguments.folder, arguments.verify)
    except MemoryError:
        print("out of memory: the limit of the trial (limits.memory) is reached", file=sys.stderr)
        return _core._out_of_memory
    except ConfigError as error:
        print(error, file=sys.stderr)
        return 2
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 3
    except PluginError as error:
        print(f"error: {error}", file=sys.stderr)
        return 4
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
