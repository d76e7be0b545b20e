#!/usr/bin/env python3
"""Measures how much plans depend on each parameter: halves and doubles one at a time, and prints the changes.

    tools/sensitivity.py -o sensitivity             # samples, and assemblies of $DISMANTLE_DATA if it is set
    tools/sensitivity.py -o sensitivity --random 200 --only sequence_planner.
    tools/sensitivity.py -o features --features --random 0 --seconds 60  # switches, and plugins of lists, one left out at a time
    tools/sensitivity.py -o sensitivity --table > docs/parameters.md  # Markdown table of the runs so far

Switches are inverted; one plugin of a list is left out at a time. Values outside the parameter's range are skipped. Runs use one thread and are kept in
OUT/runs.jsonl. Existing runs are not repeated, so that the work can be stopped and resumed at any time. Random
assemblies are samples with random dimensions and rotations. Assemblies that take longer than --seconds with the
defaults are skipped. A run may take 40 times as long as with the defaults, at least a minute, and counts as lost after that.
"""
import argparse
import collections
import hashlib
import json
import math
import os
import pathlib
import random
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
SECTIONS = ("simulator", "path_planner", "sequence_planner", "transfer_planner", "immobility", "verify")
SEARCH_ONLY = ("path_planner.", "simulator.")
ALWAYS_LEFT_OUT = {  # choices of the user, and parameters that matter only under a time limit
    "verify.max_penetration", "immobility.advanced.deadline_share"}

HEAD = """# Parameters and how much plans depend on them

One parameter at a time is changed; the plans of %d assemblies are compared with those of the default values.

Columns: *assemblies*: the number that were planned (for parameters of searches: those that need a search). *lost*, *gained*: the number of assemblies in which
fewer or more parts came out without force. *other plan*: the number in which a path differs. *CPU time*: total of all assemblies, relative to the default values.
A parameter on which no plan depends here may matter for assemblies that are harder.
"""


def call(command, seconds=None):
    """Exit status, output and errors; status None after the time limit."""
    try:
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None, "", ""
    return done.returncode, done.stdout, done.stderr


def sample_parameters(program):
    """By sample: name, default, smallest and largest value of its numeric parameters."""
    samples, current = collections.OrderedDict(), None
    for line in call([program, "sample", "list"])[1].splitlines():
        if head := re.match(r"(\w+): ", line):
            current = samples.setdefault(head[1], [])
        elif number := re.match(r"\s+(\w+) = ([-\d.e]+)(?: \w+)? in \[([-\d.e]+), ([-\d.e]+)\]", line):
            current.append((number[1], float(number[2]), float(number[3]), float(number[4])))
    return samples


def make_samples(program, folder, count):
    """The samples with defaults, and `count` samples with random dimensions."""
    samples, made = sample_parameters(program), []
    for k in range(-len(samples), count):
        name = list(samples)[k % len(samples)]
        target = folder / (name if k < 0 else "random_%03d_%s" % (k, name))
        settings = []
        if k >= 0:
            draw = random.Random(k)
            for key, default, low, high in samples[name]:
                value = min(max(default * 2 ** draw.uniform(-0.7, 0.7), low), high)
                whole = default == int(default) and low == int(low)
                settings += ["--set", "%s=%s" % (key, round(value) if whole else round(value, 4))]
            settings += ["--set", "rotate_seed=%d" % draw.randrange(1, 10 ** 6)]
        if not target.exists() and call([program, "sample", name, "-o", target, "-q", *settings])[0] != 0:
            continue  # incompatible dimensions
        made.append(target)
    return made


def parameters_of(resolved, schema):
    """Keys for --set with their values, and lists of plugins by key, from resolved.yaml; it has the advanced parameters that differ
    from their defaults, the schema has the others."""
    path, found, lists = [], collections.OrderedDict(), collections.OrderedDict()
    for section in SECTIONS:
        found.update(advanced_of(section, schema["properties"].get(section, {})))
    for line in resolved.splitlines():
        match = re.match(r"( *)(- )?([\w]+): *([^#]*)", line)
        if not match or line.lstrip().startswith("#"):
            continue
        depth, item, key, value = len(match[1]) + (2 if match[2] else 0), match[2], match[3], match[4].strip()
        path = [p for p in path if p[0] < depth]
        if item and key == "type":  # plugins in a list are identified by their type
            path = [p for p in path if p[0] < depth - 1]
            lists.setdefault(".".join(p[1] for p in path), []).append(value)
            path.append((depth - 1, value))
        if key == "type":
            for types in schema["$defs"].values() if item else [schema["properties"].get(path[0][1], {})]:
                for alternative in types.get("oneOf", []):
                    if alternative["properties"]["type"]["const"] == value:
                        found.update(advanced_of(".".join(p[1] for p in path), alternative))
        if item and key == "type":
            continue
        if value == "":
            path.append((depth, key))
            continue
        found[".".join([p[1] for p in path] + [key])] = value
    return collections.OrderedDict((k, v) for k, v in found.items() if k.split(".")[0] in SECTIONS), lists


def advanced_of(key, schema):
    """Keys of the advanced parameters of a section or plugin, with their defaults as YAML."""
    known = schema.get("properties", {}).get("advanced", {}).get("properties", {})
    return {"%s.advanced.%s" % (key, name): json.dumps(spec["default"]) for name, spec in known.items() if "default" in spec}


def lists_without_one(parameters, lists):
    """Plugin name in a list -> setting without it, with all others and their parameters."""
    settings = collections.OrderedDict()
    for key, types in lists.items():
        def item(kind):
            prefix = "%s.%s." % (key, kind)
            own = {k[len(prefix):]: v for k, v in parameters.items() if k.startswith(prefix)}
            values = ["%s: %s" % (k, v) for k, v in own.items() if not k.startswith("advanced.")]
            advanced = ["%s: %s" % (k[len("advanced."):], v) for k, v in own.items() if k.startswith("advanced.")]
            return "{%s}" % ", ".join(["type: " + kind] + values + (["advanced: {%s}" % ", ".join(advanced)] if advanced else []))
        for kind in types:
            settings["%s.%s" % (key, kind)] = "%s=[%s]" % (key, ", ".join(item(t) for t in types if t != kind))
    return settings


def ranges_of(schema):
    """Parameter name -> (smallest, largest, is integer): the widest range of all plugins with this parameter."""
    ranges = {}

    def visit(node):
        if isinstance(node, dict):
            for key, value in node.get("properties", {}).items():
                if isinstance(value, dict) and value.get("type") in ("number", "integer"):
                    low = value.get("minimum", value.get("exclusiveMinimum", -math.inf))
                    high = value.get("maximum", value.get("exclusiveMaximum", math.inf))
                    old = ranges.get(key, (math.inf, -math.inf, True))
                    ranges[key] = (min(low, old[0]), max(high, old[1]), value["type"] == "integer" and old[2])
            for value in node.values():
                visit(value)
        elif isinstance(node, list):
            for value in node:
                visit(value)

    visit(schema)
    return ranges


def variations(key, value, ranges):
    """Replacement values: pairs of a name and a value."""
    if value in ("true", "false"):
        return [("turned", "false" if value == "true" else "true")]
    try:
        number = float(value)
    except ValueError:
        return []
    name = key.split(".")[-1]
    if number == 0 or name not in ranges:
        return []
    low, high, whole = ranges[name]
    out = []
    for label, factor in (("half", 0.5), ("double", 2.0)):
        varied = number * factor
        if whole:
            varied = max(math.floor(varied) if factor < 1 else varied, low)
        if low <= varied <= high and varied != number:
            out.append((label, str(int(varied)) if whole else repr(varied)))
    return out


def plan(program, assembly, folder, settings, seconds):
    """Result of one run."""
    out = folder / "plan"
    command = [program, "plan", assembly, "-o", out, "--threads", "1", "--format", "json", "-q"]
    for setting in settings:
        command += ["--set", setting]
    status, text, errors = call(command, seconds)
    if status is None:  # no --timeout: a plan that a deadline cuts short would differ
        return {"status": 1, "removed": 0, "forced": 0, "seconds": seconds, "searches": 0, "moves": "none"}
    if status not in (0, 1):
        return {"status": status, "error": errors.strip()[-200:]}
    summary = json.loads(text.strip().splitlines()[-1])
    written = json.loads((out / "plan.json").read_text())
    moves = json.dumps([step["moves"] for step in written["disassembly"]])
    return {"status": status, "removed": summary["removed"], "forced": summary["forced"], "steps": summary["steps"],
            "seconds": summary["cpu_seconds"], "searches": summary["counters"].get("searches", 0), "moves": hashlib.sha256(moves.encode()).hexdigest()[:16]}


def read_runs(file):
    runs = {}
    if file.exists():
        for line in file.read_text().splitlines():
            run = json.loads(line)
            runs[run["key"], run["variation"], run["assembly"]] = run
    return runs


def write_table(runs):
    """Prints a Markdown table with a row for each varied parameter."""
    base = {a: r for (k, _, a), r in runs.items() if k == ""}
    rows = collections.OrderedDict()
    for (key, label, assembly), run in runs.items():
        if key and assembly in base and run["status"] != 2:  # 2: outside its range
            rows.setdefault((key, run["default"]), collections.OrderedDict()).setdefault(label, []).append((base[assembly], run))
    print(HEAD % len({assembly for key, _, assembly in runs if key}))
    print("| parameter | default | value | assemblies | lost | gained | other plan | CPU time |")
    print("|---|---|---|---|---|---|---|---|")
    nothing = []
    for (key, default), by_label in rows.items():
        cells, changes = [], 0
        for label, pairs in by_label.items():
            def out(r):
                return r.get("removed", -1) - r.get("forced", 0)
            lost = sum(out(r) < out(b) for b, r in pairs)
            gained = sum(out(r) > out(b) for b, r in pairs)
            other = sum(r.get("moves") != b.get("moves") for b, r in pairs)
            ratio = sum(r.get("seconds", 0) for _, r in pairs) / max(1e-9, sum(b["seconds"] for b, _ in pairs))
            changes += other
            cells.append("| %d | %d | %d | %d | %.2f |" % (len(pairs), lost, gained, other, ratio))
        if changes == 0:
            nothing.append((key, default, max((float(c.split("|")[5]) for c in cells), key=lambda x: abs(math.log(max(x, 1e-3))))))
            continue
        for (label, pairs), cell in zip(by_label.items(), cells):
            print("| `%s` | %s | %s %s" % (key, default, pairs[0][1]["value"], cell))
    print("\nNo plan of these assemblies depends on:\n")
    for key, default, ratio in nothing:
        print("- `%s` = %s (CPU time x %.2f)" % (key, default, ratio))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/dismantle")
    parser.add_argument("--random", type=int, default=200, help="random assemblies")
    parser.add_argument("--only", default="", help="parameters whose key begins so")
    parser.add_argument("--features", action="store_true", help="only switches, and plugins of lists")
    parser.add_argument("--seconds", type=float, default=1.5, help="of CPU time that an assembly may take as it is")
    parser.add_argument("--table", action="store_true", help="print the table of the runs so far, and run nothing")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    file = options.output / "runs.jsonl"
    runs = read_runs(file)
    if options.table:
        return write_table(runs)

    assemblies = make_samples(options.program, options.output, options.random)
    if data := os.environ.get("DISMANTLE_DATA"):
        assemblies += sorted(p for group in ("two_part", "rotational", "threads", "burr", "cad")
                             for p in (pathlib.Path(data) / group).iterdir() if p.is_dir() and list(p.glob("*.obj")))

    def record(key, label, value, default, setting, assembly, seconds):
        if (key, label, assembly.name) in runs:
            return runs[key, label, assembly.name]
        result = plan(options.program, assembly, options.output, [setting] if key else [], seconds)
        result.update(key=key, variation=label, value=value, default=default, assembly=assembly.name)
        with file.open("a") as stream:
            stream.write(json.dumps(result) + "\n")
        runs[key, label, assembly.name] = result
        return result

    used = []
    for k, assembly in enumerate(assemblies):
        base = record("", "", "", "", "", assembly, 40 * options.seconds)
        if base["status"] in (0, 1) and base["seconds"] <= options.seconds:
            used.append((assembly, base))
    print("%d of %d assemblies are used" % (len(used), len(assemblies)), flush=True)
    if not used:
        sys.exit("no assembly is planned in %g s: %s plan %s" % (
            options.seconds, shlex.quote(str(options.program)), shlex.quote(str(assemblies[0]) if assemblies else "")))

    if not (options.output / "plan" / "resolved.yaml").exists():  # all these runs exist already
        plan(options.program, used[0][0], options.output, [], 40 * options.seconds)
    resolved = (options.output / "plan" / "resolved.yaml").read_text()
    schema = json.loads((ROOT / "docs/reference/dismantle.schema.json").read_text())
    ranges = ranges_of(schema)
    parameters, lists = parameters_of(resolved, schema)
    pending = [(key, "in the list", "out", "left out", setting) for key, setting in lists_without_one(parameters, lists).items()]
    pending += [(key, default, label, value, "%s=%s" % (key, value)) for key, default in parameters.items() if key not in ALWAYS_LEFT_OUT
                for label, value in variations(key, default, ranges)]
    pending = [p for p in pending if p[0].startswith(options.only) and (not options.features or p[2] in ("out", "turned"))]
    for k, (key, default, label, value, setting) in enumerate(pending):
        differ = asked = 0
        for assembly, base in used:
            if key.startswith(SEARCH_ONLY) and base["searches"] == 0:
                continue  # there was no search
            run = record(key, label, value, default, setting, assembly, max(60.0, 40 * base["seconds"]))
            if run["status"] == 2:  # outside its range
                break
            asked += 1
            differ += run.get("moves") != base["moves"]
        print("%4d of %d  %s = %s: %d of %d plans differ" % (k + 1, len(pending), key, value, differ, asked), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
