#!/usr/bin/env python3
"""Measures what a person would notice about plans: changes of direction, directions, support.

    tools/measure_plans.py DIR...                      # folders that `dismantle plan -o` has written
    tools/measure_plans.py --plan build/release/dismantle --inputs data/cad/* --out DIR [-- OPTIONS OF plan]

Each DIR holds plan.json and plan.glb. Steps are read as assembly operations, the last step of the disassembly first;
the direction of an operation is that of the last stretch of the insertion, for a screw that of its axis. Columns:

  steps       steps of the disassembly; `forced`: of these, forced ones
  changes     operations whose direction differs by more than 1 degree from that of the operation before
  directions  different directions, within 1 degree
  no axis     operations along none of the six axes of the input, within 1 degree
  below       operations that move upwards, within 45 degrees, as the assembly lies during the step
  turns       operations for which the assembly lies differently than for the one before
  fall        operations after which nothing is under a part that was put in: neither a part that is there nor the
              table. Geometric: no sample of the surface that faces downwards has a surface of another part, or the
              table, below it within 2 % of the size of the assembly. A part of a group counts if the whole group has
              nothing under it.
  always      of these, those of which it is true with all other parts there, too: as drawn nothing is under them, and no
              order helps while the assembly lies like this

Exit status: 0; 1 when a plan could not be made or read, which the table says.
"""
import argparse
import csv
import json
import math
import pathlib
import struct
import subprocess
import sys

ANGLE = math.radians(1)
NEAR = 0.02  # of the size of the assembly
SAMPLES = 3000  # of a part at most, on the surface that faces downwards
COLUMNS = ("name", "status", "parts", "steps", "forced", "changes", "directions", "no axis", "below", "turns", "fall", "always", "cost")


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a) if length > 0 else None


def angle(a, b):
    return math.acos(max(-1.0, min(1.0, dot(a, b))))


def rotated(q, p):
    w, x, y, z = q
    t = (2 * (y * p[2] - z * p[1]), 2 * (z * p[0] - x * p[2]), 2 * (x * p[1] - y * p[0]))
    return (p[0] + w * t[0] + y * t[2] - z * t[1], p[1] + w * t[1] + z * t[0] - x * t[2],
            p[2] + w * t[2] + x * t[1] - y * t[0])


def placed(pose, p):
    return tuple(a + b for a, b in zip(rotated(pose[3:], p), pose[:3]))


def screw_axis(start, pose, along):
    """Unit, as `along`; None for what is no screw. A centre beside the axis goes round it; a hinge hardly moves along it."""
    (w, *a), (v, *b) = start[3:], pose[3:]
    axis = tuple(v * p - w * q + x for p, q, x in zip(a, b, (a[2] * b[1] - a[1] * b[2], a[0] * b[2] - a[2] * b[0],
                                                             a[1] * b[0] - a[0] * b[1])))  # of start * pose^-1
    advance = dot(along, axis)
    if abs(advance) <= max(0.01 * math.sqrt(dot(axis, axis)), 1e-8) * math.sqrt(dot(along, along)):
        return None
    return unit(tuple(math.copysign(1, advance) * x for x in axis))


# ---- shapes, from the animation


def glb_parts(file, centre=(0, 0, 0)):
    """Vertices and triangles of each part as assembled, by name, in the axes of the input; `centre`: assembly.center
    of the plan. Nodes of parts hold their place before the animation begins."""
    data = file.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    scene, blob = json.loads(data[20:20 + length]), 28 + length

    def accessor(index):
        a = scene["accessors"][index]
        view = scene["bufferViews"][a["bufferView"]]
        code, width = {5126: ("f", 4), 5125: ("I", 4), 5123: ("H", 2), 5121: ("B", 1)}[a["componentType"]]
        count = {"SCALAR": 1, "VEC3": 3}[a["type"]]
        stride = view.get("byteStride", width * count)
        start = blob + view.get("byteOffset", 0) + a.get("byteOffset", 0)
        if count == 1:
            return [struct.unpack_from("<" + code, data, start + i * stride)[0] for i in range(a["count"])]
        return [struct.unpack_from(f"<{count}{code}", data, start + i * stride) for i in range(a["count"])]

    parts = {}
    for node in scene["nodes"]:
        if "mesh" not in node:
            continue
        points, triangles = [], []
        for primitive in scene["meshes"][node["mesh"]]["primitives"]:
            own = accessor(primitive["attributes"]["POSITION"])
            order = accessor(primitive["indices"]) if "indices" in primitive else list(range(len(own)))
            triangles += [tuple(len(points) + i for i in order[k:k + 3]) for k in range(0, len(order), 3)]
            points += own
        x, y, z, w = node.get("rotation", (0, 0, 0, 1))
        place = (*(a + b for a, b in zip(node.get("translation", (0, 0, 0)), centre)), w, x, y, z)
        parts[node["name"]] = ([placed(place, p) for p in points], triangles)
    return parts


class Shapes:
    """The parts as assembled, in a frame whose z is up."""

    def __init__(self, meshes, up):
        helper = (1, 0, 0) if abs(up[0]) < 0.9 else (0, 1, 0)
        x = unit(tuple(h - dot(helper, up) * u for h, u in zip(helper, up)))
        y = (up[1] * x[2] - up[2] * x[1], up[2] * x[0] - up[0] * x[2], up[0] * x[1] - up[1] * x[0])
        self.points = {n: [(dot(x, p), dot(y, p), dot(up, p)) for p in pts] for n, (pts, _) in meshes.items()}
        self.triangles = {n: t for n, (_, t) in meshes.items()}
        every = [p for pts in self.points.values() for p in pts]
        self.size = max(max(p[k] for p in every) - min(p[k] for p in every) for k in range(3))
        self.low = {n: min(p[2] for p in pts) for n, pts in self.points.items()}
        self.cell = self.size / 40
        self.grids, self.sampled = {}, {}

    def grid(self, name):
        if name not in self.grids:
            cells = {}
            pts = self.points[name]
            for a, b, c in self.triangles[name]:
                xs, ys = [pts[i][0] for i in (a, b, c)], [pts[i][1] for i in (a, b, c)]
                for i in range(math.floor(min(xs) / self.cell), math.floor(max(xs) / self.cell) + 1):
                    for j in range(math.floor(min(ys) / self.cell), math.floor(max(ys) / self.cell) + 1):
                        cells.setdefault((i, j), []).append((pts[a], pts[b], pts[c]))
            self.grids[name] = cells
        return self.grids[name]

    def samples(self, name):
        """Points on all triangles that face downwards, as dense as the cells: a rod touches what it lies in with a small
        part of its long triangles."""
        if name not in self.sampled:
            pts, found = self.points[name], []
            step = self.cell / 2
            for a, b, c in ([pts[i] for i in t] for t in self.triangles[name]):
                if (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]) >= 0:
                    continue
                edges = max(math.dist(a, b), math.dist(b, c), math.dist(c, a))
                n = max(1, min(60, math.ceil(edges / step)))
                for i in range(n):
                    for j in range(n - i):
                        u, v = (i + 1 / 3) / n, (j + 1 / 3) / n
                        found.append(tuple(p + u * (q - p) + v * (r - p) for p, q, r in zip(a, b, c)))
            stride = -(-len(found) // SAMPLES) if found else 1
            self.sampled[name] = found[::stride]
        return self.sampled[name]

    def has_under(self, point, other):
        """Is a surface of `other` just below the point, or just above it (a part may cut in a little)?"""
        x, y, z = point
        for a, b, c in self.grid(other).get((math.floor(x / self.cell), math.floor(y / self.cell)), ()):
            area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
            if abs(area) < 1e-12 * self.size ** 2:
                continue
            u = ((b[0] - x) * (c[1] - y) - (c[0] - x) * (b[1] - y)) / area
            v = ((c[0] - x) * (a[1] - y) - (a[0] - x) * (c[1] - y)) / area
            if u < -1e-9 or v < -1e-9 or u + v > 1 + 1e-9:
                continue
            if -NEAR * self.size <= u * a[2] + v * b[2] + (1 - u - v) * c[2] - z <= 0.1 * NEAR * self.size:
                return True
        return False

    def stands(self, moving, present):
        if min(self.low[n] for n in moving) <= min(self.low[n] for n in present) + NEAR * self.size:
            return True  # on the table, beside what is there
        return any(self.has_under(p, other) for n in moving for p in self.samples(n) for other in present)


# ---- the steps of a plan


def operations(plan):
    """(step, moving, present, direction, up), in the order of assembly; without intermediate placements."""
    groups = [[p["name"] for p in plan["assembly"]["parts"]]]
    found = []
    for step in plan["disassembly"]:
        moving = [m["part"] for m in step["moves"]]
        group = next(g for g in groups if moving[0] in g)
        leaving = [n for list_ in step["separates"] for n in list_ if n in moving] if step.get("separates") else []
        if not leaving:
            continue
        rest = [n for n in group if n not in leaving]
        groups.remove(group)
        groups += [rest, leaving]
        poses = step["moves"][moving.index(leaving[0])]["poses"]
        centre = plan["centres"].get(leaving[0], (0, 0, 0))
        start = placed(poses[0], centre)
        direction = None
        for pose in poses[1:]:
            along = tuple(a - b for a, b in zip(start, placed(pose, centre)))
            if math.sqrt(dot(along, along)) > 1e-9:
                direction = screw_axis(poses[0], pose, along) or unit(along)
                break
        up = step.get("up") or plan.get("objective", {}).get("up") or (0, 0, 1)
        found.append((step, leaving, rest, direction, unit(up)))
    return found[::-1]


def measure(folder):
    plan = json.loads((folder / "plan.json").read_text())
    meshes = glb_parts(folder / "plan.glb", plan["assembly"]["center"])
    plan["centres"] = {name: tuple((min(p[k] for p in pts) + max(p[k] for p in pts)) / 2 for k in range(3))
                       for name, (pts, _) in meshes.items()}
    row = dict.fromkeys(COLUMNS[5:-1], 0)
    row.update(name=folder.name, status=plan["status"], parts=len(plan["assembly"]["parts"]),
               steps=len(plan["disassembly"]), forced=sum("forced" in s for s in plan["disassembly"]),
               cost=plan.get("objective", {}).get("cost", ""))
    axes = [tuple(s if k == j else 0 for k in range(3)) for j in range(3) for s in (1, -1)]
    shapes, seen, last, last_up = {}, [], None, None
    for _, moving, present, direction, up in operations(plan):
        if last_up is not None and angle(up, last_up) > ANGLE:
            row["turns"] += 1
        last_up = up
        if direction is not None:
            if last is not None and angle(direction, last) > ANGLE:
                row["changes"] += 1
            last = direction
            if all(angle(direction, d) > ANGLE for d in seen):
                seen.append(direction)
            row["no axis"] += all(angle(direction, a) > ANGLE for a in axes)
            row["below"] += dot(direction, up) > math.cos(math.radians(45))
        if up not in shapes:
            shapes[up] = Shapes(meshes, up)
        if present and not shapes[up].stands(moving, present):
            row["fall"] += 1
            others = [p["name"] for p in plan["assembly"]["parts"] if p["name"] not in moving]
            row["always"] += not shapes[up].stands(moving, others)
    row["directions"] = len(seen)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--plan", metavar="PROGRAM", help="plan the inputs first, with this program")
    parser.add_argument("--inputs", nargs="*", default=[], type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, help="folder for these plans, one folder each")
    parser.add_argument("--csv", type=pathlib.Path, help="write the table there, too")
    own, options = sys.argv[1:], []
    if "--" in own:
        own, options = own[:own.index("--")], own[own.index("--") + 1:]
    args = parser.parse_args(own)
    if bool(args.plan) != bool(args.out) or bool(args.plan) != bool(args.inputs):
        parser.error("--plan, --inputs and --out belong together")
    folders, failed = list(args.folders), False
    for source in args.inputs:
        folder = args.out / source.name
        subprocess.run([args.plan, "plan", str(source), "-o", str(folder), "-q", *options], check=False)
        folders.append(folder)
    rows = []
    for folder in folders:
        try:
            rows.append(measure(folder))
        except (OSError, ValueError, KeyError, StopIteration, struct.error) as e:
            print(f"{folder}: {type(e).__name__}: {e}", file=sys.stderr)
            failed = True
    total = {c: sum(r[c] for r in rows) for c in COLUMNS[2:-1]}
    total.update(name=f"{len(rows)} plans", status="", cost="")
    width = max(len(r["name"]) for r in [*rows, total]) + 1
    print("name".ljust(width) + "".join(c.rjust(12) for c in COLUMNS[1:]))
    for row in [*rows, total]:
        cells = (f"{row[c]:.4g}" if isinstance(row[c], float) else str(row[c]) for c in COLUMNS[1:])
        print(row["name"].ljust(width) + "".join(c.rjust(12) for c in cells))
    if args.csv:
        with args.csv.open("w", newline="") as out:
            writer = csv.DictWriter(out, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
