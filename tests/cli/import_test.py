"""Colours, structure and units of the input in every format: from the files to plan.json and plan.glb."""
import base64
import io
import json
import os
import struct
import zipfile

import meshes
from program import CliTest

QUICK = ("--path-timeout", "0", "--timeout", "0", "--set", "run.path_steps=2000", "--format", "json")

# Three boxes side by side: name, corner, colour, assemblies.
PARTS = (("base", (0, 0, 0), "#ff0000", ["gearbox"]), ("gear", (1, 0, 0), "#00ff00", ["gearbox", "train"]),
         ("lid", (0, 0, 1), "#0000ff", ["gearbox", "train"]))
UNIT = meshes.box((0, 0, 0), (1, 1, 1))


def rgb(colour):
    return [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]


def glb(scale=1.0):
    """One mesh per part, in nodes that are moved, below nodes that group them. Channels of 0 and 1 are the same in linear light."""
    points = b"".join(struct.pack("<3f", *v) for v in UNIT[0])
    data = points + b"".join(struct.pack("<3I", *t) for t in UNIT[1])
    scene = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "file", "children": [1], "scale": [scale] * 3}, {"name": "gearbox", "children": [2, 3]},
                  {"name": "base", "mesh": 0, "translation": PARTS[0][1]}, {"name": "train", "children": [4, 5], "translation": [0, 0, 0.5]},
                  {"name": "gear", "mesh": 1, "translation": [1, 0, -0.5]}, {"name": "lid", "mesh": 2, "translation": [0, 0, 0.5]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": rgb(p[2]) + [1]}} for p in PARTS],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": i}]} for i in range(3)],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(points)},
                        {"buffer": 0, "byteOffset": len(points), "byteLength": len(data) - len(points)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5125, "count": 36, "type": "SCALAR"}]}
    return data, scene


def glb_bytes(scale=1.0):
    data, scene = glb(scale)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data


def gltf_text():
    data, scene = glb()
    scene["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps(scene)


def threemf(unit):
    """Objects with a base material each, placed by transforms, two of them as components of another."""
    mesh = ("<mesh><vertices>" + "".join('<vertex x="%r" y="%r" z="%r"/>' % v for v in UNIT[0]) + "</vertices><triangles>"
            + "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % t for t in UNIT[1]) + "</triangles></mesh>")
    objects = "".join(f'<object id="{i + 2}" type="model" name="{p[0]}" pid="1" pindex="{i}">{mesh}</object>' for i, p in enumerate(PARTS))
    materials = '<basematerials id="1">' + "".join(f'<base name="{p[0]} paint" displaycolor="{p[2].upper()}FF"/>' for p in PARTS) + "</basematerials>"
    move = "1 0 0 0 1 0 0 0 1 "
    model = (f'<?xml version="1.0"?><model unit="{unit}" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>{materials}{objects}'
             f'<object id="9" type="model" name="train"><components><component objectid="3" transform="{move}1 0 0"/>'
             f'<component objectid="4" transform="{move}0 0 1"/></components></object></resources>'
             '<build><item objectid="2"/><item objectid="9"/></build></model>')
    base = zipfile.ZipFile(io.BytesIO(meshes.threemf(*UNIT)))
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name in base.namelist():
            archive.writestr(name, model if name.endswith(".model") else base.read(name))
    return out.getvalue()


def moved(corner):
    return [tuple(x + c for x, c in zip(v, corner)) for v in UNIT[0]], UNIT[1]


def obj_groups():
    text, base = "mtllib paint.mtl\no gearbox\n", 0
    for name, corner, _, _ in PARTS:
        vertices, triangles = moved(corner)
        text += "".join("v %r %r %r\n" % v for v in vertices) + f"g {name}\nusemtl {name} paint\n"
        text += "".join("f %d %d %d\n" % tuple(i + 1 + base for i in t) for t in triangles)
        base += len(vertices)
    return text


def paint():
    return "".join("newmtl %s paint\nKa 1 1 1\nKd %r %r %r\nd 1\n" % (p[0], *rgb(p[2])) for p in PARTS)


class Imports(CliTest):
    def put(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())

    def plan(self, source):
        done = self.run_program("plan", source, *QUICK, "-o", "out", status=0)
        plan = json.loads(self.read("out", "plan.json"))
        self.assertEqual(self.result_of(done)["status"], "complete")
        self.run_program("verify", "out/plan.json", "-q", status=0)
        return plan, done.stderr

    def colours_of_glb(self):
        with open(self.path("out", "plan.glb"), "rb") as file:
            data = file.read()
        length = struct.unpack("<I", data[12:16])[0]
        scene = json.loads(data[20:20 + length])
        found = {}
        for node in scene["nodes"]:
            if "mesh" not in node:
                continue
            material = scene["materials"][scene["meshes"][node["mesh"]]["primitives"][0]["material"]]
            found[node["name"]] = "#" + "".join("%02x" % round(255 * c) for c in material["pbrMetallicRoughness"]["baseColorFactor"][:3])
        return found

    def check_parts(self, plan, colours=True, parents=None):
        parts = {p["name"]: p for p in plan["assembly"]["parts"]}
        self.assertEqual(sorted(parts), sorted(p[0] for p in PARTS))
        for name, _, colour, assemblies in PARTS:
            self.assertEqual(parts[name].get("color"), colour if colours else None, name)
            if parents is not None:
                self.assertEqual(parts[name].get("parents", []), parents(assemblies), name)
        if colours:
            self.assertEqual(self.colours_of_glb(), {p[0]: p[2] for p in PARTS})

    def check_box(self, plan, size):
        lo, hi = plan["assembly"]["bbox"]
        for k, edge in enumerate((2, 1, 2)):
            self.assertAlmostEqual(hi[k] - lo[k], edge * size, 5)

    def test_glb_with_transforms(self):
        for name, content, size in (("a.glb", glb_bytes(), 1), ("b.gltf", gltf_text(), 1), ("c.glb", glb_bytes(0.001), 0.001)):
            self.put("g/" + name, content)
            plan, _ = self.plan("g/" + name)
            self.check_parts(plan, parents=lambda a: a)
            self.check_box(plan, size)
            self.assertEqual(plan["assembly"]["unit"], "m")

    def test_3mf_with_components(self):
        for word, unit in (("millimeter", "mm"), ("inch", "inch"), ("meter", "m")):
            self.put("m/a.3mf", threemf(word))
            plan, _ = self.plan("m/a.3mf")
            self.check_parts(plan, parents=lambda a: a[1:])  # the file knows of no gearbox
            self.check_box(plan, 1)
            self.assertEqual(plan["assembly"]["unit"], unit)

    def test_obj_groups(self):
        self.put("o/a.obj", obj_groups())
        self.put("o/paint.mtl", paint())
        plan, _ = self.plan("o/a.obj")
        self.check_parts(plan, parents=lambda a: a[:1])
        self.check_box(plan, 1)
        self.assertNotIn("unit", plan["assembly"])
        os.remove(self.path("o", "paint.mtl"))  # a mesh without its paint is a mesh
        plan, _ = self.plan("o/a.obj")
        self.check_parts(plan, colours=False, parents=lambda a: a[:1])

    def test_folder_of_stl(self):
        for k, (name, corner, _, _) in enumerate(PARTS):
            self.put(f"s/{name}.stl", (meshes.stl_text if k == 1 else meshes.stl)(*moved(corner)))
        plan, _ = self.plan("s")
        self.check_parts(plan, colours=False, parents=lambda a: [])
        self.check_box(plan, 1)

    def test_formats_mixed_in_a_folder(self):
        self.put("x/base.stl", meshes.stl(*moved(PARTS[0][1])))
        self.put("x/gear.obj", "mtllib p.mtl\nusemtl gear paint\n" + meshes.obj(*moved(PARTS[1][1])))
        self.put("x/p.mtl", paint())
        self.put("x/lid.3mf", meshes.threemf(*moved(PARTS[2][1])))
        plan, said = self.plan("x")
        parts = {p["name"]: p for p in plan["assembly"]["parts"]}
        self.assertEqual([parts[n].get("color") for n in ("base", "gear", "lid")], [None, "#00ff00", None])
        self.check_box(plan, 1)
        self.assertEqual(plan["assembly"]["unit"], "mm", "the only unit that a file states")
        self.put("x/lid.3mf", meshes.threemf(*moved(PARTS[2][1])))
        self.put("x/nut.glb", meshes.glb(*moved((1, 0, 1))))
        plan, said = self.plan("x")
        self.assertIn("different length units", said)
        self.assertNotIn("unit", plan["assembly"])
