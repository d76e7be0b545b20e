#!/usr/bin/env python3
"""Fails when the source tree breaks the rules of docs/architecture.md, "The include rule":

- core <- process; core <- parallel <- geometry <- fasteners (<- tools, statics), verification <- preparation, plan_io <- book, orders, serve, engine <- host <- session <- apps, bench: no #include against the arrows;
- a plugin includes core, geometry, the plugin sdk and the shared libraries of its kind (folders without a plugin: KIND/common and
  others that build a library), an importer also process, a step check also statics, fasteners or tools, a sequence planner also ordering; never another plugin;
- headers of a library are included by the name of its folder, "dismantle/geometry/x.h"; those of KIND/common by KIND; those of core,
  lib/parallel and the plugin sdk, which authors of plugins include, as "dismantle/x.h";
- core has at most 2500 lines of code (comments and empty lines are free), a file 400, a class 40 methods (a rough count of the declarations in its body)."""
import argparse
import os
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
CORE_MAX_LINES = 2500
FILE_MAX_LINES = 400
CLASS_MAX_METHODS = 40
FOLDERS = ("core", "lib", "plugins", "simulators", "planners", "apps", "tests")

# What the code of a folder may include besides itself and core.
BELOW_ENGINE = {"lib/geometry", "lib/fasteners", "lib/verification", "lib/preparation", "lib/plan_io"}
ALLOWED = {
    "core": set(),
    "lib/parallel": set(),
    "lib/process": set(),
    "lib/geometry": set(),
    "lib/ordering": set(),
    "lib/statics": {"lib/geometry", "lib/fasteners"},
    "lib/fasteners": {"lib/geometry"},
    "lib/tools": {"lib/geometry", "lib/fasteners"},
    "lib/verification": {"lib/geometry"},
    "lib/preparation": {"lib/geometry", "lib/fasteners", "lib/verification"},
    "lib/plan_io": {"lib/geometry"},
    "lib/orders": {"lib/geometry", "lib/ordering", "lib/verification", "lib/plan_io"},
    "lib/serve": {"lib/process", "lib/geometry", "lib/plan_io"},
    "lib/book": {"lib/geometry", "lib/plan_io"},
    "lib/samples": {"lib/geometry"},
    "lib/engine": BELOW_ENGINE,
    "plugins/sdk": {"lib/geometry"},
    "plugins/host": BELOW_ENGINE | {"lib/engine", "plugins/sdk"},
    "lib/session": BELOW_ENGINE | {"lib/statics", "lib/engine", "plugins/sdk", "plugins/host"},
    "plugins/testing": BELOW_ENGINE | {"lib/engine", "lib/samples", "plugins/sdk", "plugins/host"},
    "lib/bench": BELOW_ENGINE | {"lib/orders", "lib/process", "lib/engine", "lib/samples", "lib/session", "plugins/sdk", "plugins/host"},
    "apps": BELOW_ENGINE | {"lib/statics", "lib/tools", "lib/ordering", "lib/process", "lib/serve", "lib/book", "lib/orders", "lib/engine", "lib/samples", "lib/session", "lib/bench", "plugins/sdk", "plugins/host"},
}
PLUGIN_MAY = {"lib/geometry", "plugins/sdk"}
IMPORTER_MAY = PLUGIN_MAY | {"lib/process"}
CHECK_MAY = PLUGIN_MAY | {"lib/statics", "lib/fasteners", "lib/tools"}
SEQUENCE_MAY = PLUGIN_MAY | {"lib/ordering"}
# Folders of plugin kinds, and the depth of the plugin folders below them.
KINDS = {"simulators": 1, "plugins/importers": 1, "planners": 2}


def sources(root, folder):
    for path, folders, names in os.walk(os.path.join(root, folder)):
        folders[:] = sorted(f for f in folders if f not in ("build", "node_modules"))
        for name in sorted(names):
            if name.endswith((".h", ".cpp")):
                yield os.path.relpath(os.path.join(path, name), root)


def is_test(file):
    parts = file.split("/")
    return parts[0] == "tests" or parts[-1].endswith("_test.cpp") or any(
        p in ("test", "test_support") for p in parts[:-1])


def kind_of(file):
    return next((k for k in KINDS if file.startswith(k + "/")), None)


def plugin_folder(file):
    """planners/path/bfs of planners/path/bfs/src/x.cpp; None outside the folders of plugins."""
    kind = kind_of(file)
    if kind is None:
        return None
    parts = file.split("/")
    depth = len(kind.split("/")) + KINDS[kind]
    return "/".join(parts[:depth]) if len(parts) > depth else None


def shared_for(folder, libraries):
    """The non-plugin libraries that a folder may include: those of its kind, and planners/common/* for all planners."""
    beside = os.path.dirname(folder) + "/"
    return {lib for lib in libraries if lib.startswith(beside) or
            (folder.startswith("planners/") and lib.startswith("planners/common/"))}


def without_comments(text):
    """Blanks comments, strings and characters; keeps line breaks."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)


CLASS = re.compile(r"\b(?:class|struct)\s+(?:DISMANTLE_API\s+)?(\w+)\s*(?:final\s*)?(?::[^;{}()]*)?\{")


def classes(text):
    """(name, body) of each class; nested classes are separate."""
    for match in CLASS.finditer(text):
        depth, at = 1, match.end()
        while depth and at < len(text):
            depth += {"{": 1, "}": -1}.get(text[at], 0)
            at += 1
        yield match.group(1), text[match.end():at - 1]


def method_count(body):
    """Counts declarations with a parameter list at class level, after removing initialisers and bodies."""
    flat, depth = [], 0
    for c in body:
        if c == "{":
            depth += 1
            if depth == 1:
                flat.append(";")
        elif c == "}":
            depth -= 1
        elif depth == 0:
            flat.append(c)
    count = 0
    for statement in "".join(flat).split(";"):
        statement = re.sub(r"\b(?:public|private|protected)\s*:", " ", statement).strip()
        statement = statement.split("=")[0] if "operator" not in statement else statement
        if re.match(r"(using|typedef|friend|enum|static_assert|class|struct)\b", statement):
            continue
        # A type with parentheses (std::function<void(int)> f) is a member, not a method.
        plain = re.sub(r"<[^<>]*>", "", re.sub(r"<[^<>]*>", "", re.sub(r"<[^<>]*>", "", statement)))
        if re.search(r"[\w~=<>\]+*/!-]\s*\(", plain):
            count += 1
    return count


def check(root):
    files = [f for folder in FOLDERS for f in sources(root, folder)]
    known = set(files)
    text = {}
    for f in files:
        with open(os.path.join(root, f), encoding="utf-8") as stream:
            text[f] = stream.read()

    def place_of(file):
        folder = plugin_folder(file)
        return folder or max((p for p in ALLOWED if file.startswith(p + "/")), key=len, default=None)

    with_plugin = {place_of(f) for f in files if plugin_folder(f) and not is_test(f) and "\nDISMANTLE_PLUGIN(" in text[f]}
    libraries = {plugin_folder(f) for f in files if plugin_folder(f)} - with_plugin
    include_path = {}  # include path -> header of a library
    for f in files:
        if f.endswith(".h") and "/include/" in f:
            include_path.setdefault(f.split("/include/", 1)[1], []).append(f)
    # Headers in a plugin folder that other folders include by file name.
    beside_cmake = {}
    for f in files:
        if f.endswith(".h") and plugin_folder(f) and not is_test(f):
            beside_cmake.setdefault(os.path.relpath(f, plugin_folder(f)), []).append(f)
            beside_cmake.setdefault(os.path.relpath(f, os.path.dirname(plugin_folder(f))), []).append(f)

    def target_of(file, included):
        """The included file; None for headers of other projects."""
        beside = os.path.normpath(os.path.join(os.path.dirname(file), included))
        if beside in known:
            return beside
        candidates = include_path.get(included, []) + beside_cmake.get(included, [])
        own = [c for c in candidates if place_of(c) == place_of(file)]
        return (own or candidates or [None])[0]

    problems = []
    for included, found in include_path.items():
        place, folder = place_of(found[0]), os.path.dirname(included)
        if place not in ("core", "lib/parallel", "plugins/sdk", None):
            name = os.path.basename(os.path.dirname(place) if os.path.basename(place) == "common" else place)
            if folder != f"dismantle/{name}":
                problems.append(f'{found[0]}: included as "{included}", not as "dismantle/{name}/..."')
        if len(found) > 1:
            problems.append(f'"{included}" is the name of {" and of ".join(found)}')
    for f in files:
        lines = text[f].count("\n")
        if lines > FILE_MAX_LINES:
            problems.append(f"{f}: {lines} lines; at most {FILE_MAX_LINES}")
        code = without_comments(text[f])
        for name, body in classes(code):
            count = method_count(body)
            if count > CLASS_MAX_METHODS:
                problems.append(f"{f}: class {name} has {count} methods; at most {CLASS_MAX_METHODS}")
        place = place_of(f)
        if place is None or is_test(f):
            continue
        allowed = ALLOWED[place] if place in ALLOWED else shared_for(place, libraries) | (
            IMPORTER_MAY if kind_of(place) == "plugins/importers" else
            CHECK_MAY if place.startswith("planners/checks/") else
            SEQUENCE_MAY if place.startswith("planners/sequence/") else PLUGIN_MAY)
        for included in INCLUDE.findall(text[f]):
            target = target_of(f, included)
            to = target and place_of(target)
            if to is None:
                if target and is_test(target):
                    problems.append(f'{f}: includes "{included}", a header of tests')
                continue
            if to == place and is_test(target):
                problems.append(f'{f}: includes "{included}", a header of tests')
            elif to not in (place, "core", "" if place == "core" else "lib/parallel") and to not in allowed:
                problems.append(f'{f}: includes "{included}" of {to}, which {place} may not')
    core = sum(bool(line.strip()) and not line.strip().startswith("//")
               for f in files if f.startswith("core/") and not is_test(f) for line in text[f].splitlines())
    if core > CORE_MAX_LINES:
        problems.append(f"core: {core} lines of code; at most {CORE_MAX_LINES}")
    return files, core, problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    files, core, problems = check(os.path.abspath(parser.parse_args().root))
    for problem in problems:
        print(problem)
    print(f"check_includes: {len(files)} files, core {core} lines, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
