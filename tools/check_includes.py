#!/usr/bin/env python3
"""Fails when an #include goes against the layers of docs/architecture.md: core <- geometry <- verification <-
preparation, plan_io <- engine <- host <- apps, bench. A plugin includes core, geometry, the plugin sdk and the common
libraries of its own kind."""
import argparse
import os
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
LIBRARIES = ["geometry", "verification", "preparation", "plan_io", "engine", "samples", "bench"]
CORE_MAX_LINES = 2500
FILE_MAX_LINES = 400

# What code of a place may include, by place. "self" and core are always allowed.
ALLOWED = {
    "core": set(),
    "lib/geometry": set(),
    "lib/verification": {"lib/geometry"},
    "lib/preparation": {"lib/geometry", "lib/verification"},
    "lib/plan_io": {"lib/geometry", "lib/verification"},
    "lib/samples": {"lib/geometry"},
    "lib/engine": {"lib/geometry", "lib/verification", "lib/preparation", "lib/plan_io"},
    "plugins/sdk": {"lib/geometry"},
    "plugins/host": {"lib/geometry", "lib/verification", "lib/preparation", "lib/plan_io", "lib/engine", "plugins/sdk"},
    "plugins/testing": {"lib/geometry", "lib/verification", "lib/preparation", "lib/plan_io", "lib/engine", "lib/samples",
                        "plugins/sdk", "plugins/host"},
    "lib/bench": {"lib/geometry", "lib/verification", "lib/preparation", "lib/plan_io", "lib/engine", "lib/samples",
                  "plugins/sdk", "plugins/host"},
}
EVERYTHING = set(ALLOWED)
PLUGIN = {"lib/geometry", "plugins/sdk"}
PLUGIN_ROOTS = ("planners/", "simulators/", "plugins/importers/")


def sources(root, folder):
    for path, folders, names in os.walk(os.path.join(root, folder)):
        folders[:] = sorted(f for f in folders if f not in ("build", "node_modules"))
        for name in sorted(names):
            if name.endswith((".h", ".cpp")):
                yield os.path.relpath(os.path.join(path, name), root)


def is_test(file):
    parts = file.split("/")
    return any(p in ("test", "tests", "test_support") for p in parts[:-1]) or parts[-1].endswith("_test.cpp")


def common_of(place, commons):
    """The common libraries of a plugin's own kind: planners/KIND/common, simulators/sdf, and folders without a plugin."""
    kind = place.split("/")[:-1]
    return {c for c in commons if c.split("/")[:len(kind)] == kind}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    root = os.path.abspath(parser.parse_args().root)
    files = [f for folder in ("core", "lib", "plugins", "simulators", "planners", "apps") for f in sources(root, folder)]
    places = set(ALLOWED)
    for f in files:
        if f.startswith(PLUGIN_ROOTS):
            places.add("/".join(f.split("/")[:3 if not f.startswith("simulators/") else 2]))
    places = {p for p in places if os.path.isdir(os.path.join(root, p))}

    def place_of(file):
        return max((p for p in places if file.startswith(p + "/")), key=len, default=None)

    with_plugin = set()
    for f in files:
        with open(os.path.join(root, f), encoding="utf-8") as stream:
            if f.startswith(PLUGIN_ROOTS) and not is_test(f) and "\nDISMANTLE_PLUGIN(" in stream.read():
                with_plugin.add(place_of(f))
    commons = {p for p in places if p.startswith(PLUGIN_ROOTS) and p not in with_plugin}

    # A header by the path that it is included by.
    header = {}
    for f in files:
        if f.endswith(".h") and "/include/" in f:
            header[f.split("/include/", 1)[1]] = f
    problems = []
    for f in files:
        place = place_of(f)
        with open(os.path.join(root, f), encoding="utf-8") as stream:
            text = stream.read()
        lines = text.count("\n")
        if lines > FILE_MAX_LINES:
            problems.append(f"{f}: {lines} lines; at most {FILE_MAX_LINES}")
        if is_test(f) or place is None:
            continue
        if place in ALLOWED:
            allowed = ALLOWED[place]
        else:
            allowed = PLUGIN | common_of(place, commons)
        for included in INCLUDE.findall(text):
            target = header.get(included)
            if target is None:
                beside = os.path.normpath(os.path.join(os.path.dirname(f), included))
                target = beside if beside in files else None
            if target is None:
                continue
            to = place_of(target)
            if to is None or to in (place, "core") or to in allowed:
                continue
            problems.append(f'{f}: includes "{included}" of {to}, which {place} may not')
    core = sum(sum(1 for _ in open(os.path.join(root, f), encoding="utf-8")) for f in files
               if f.startswith("core/") and not is_test(f))
    if core > CORE_MAX_LINES:
        problems.append(f"core: {core} lines; at most {CORE_MAX_LINES}")
    print("\n".join(problems))
    print(f"check_includes: {len(files)} files, core {core} lines, {len(problems)} problems")
    return 1 if problems else 0


sys.exit(main())
