"""Seeds of the fuzz targets, from the project's own samples: make_seeds(program, step_seeds, source, folder)."""

import io
import json
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import zipfile

SMALL = ["peg_in_hole", "l_slot", "stacked_box"]  # samples of few triangles

SUITE = """schema: 1
name: seed
assemblies: [{sample: peg_in_hole, category: slide, part: peg}]
planners: {bfs: {config: CONFIGS/bfs.yaml}}
seeds: 1..2
limits: {path_timeout: 5, timeout: 10, wall: 60, memory: 4096}
"""


def read_obj(file):
    vertices, triangles = [], []
    for line in file.read_text().splitlines():
        words = line.split()
        if words and words[0] == "v":
            vertices.append(tuple(float(w) for w in words[1:4]))
        if words and words[0] == "f":
            triangles.append(tuple(int(w.split("/")[0]) - 1 for w in words[1:4]))
    return vertices, triangles


def stl_text(vertices, triangles):
    lines = ["solid seed"]
    for t in triangles:
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += [" vertex %r %r %r" % vertices[i] for i in t]
        lines += [" endloop", "endfacet"]
    return "\n".join(lines + ["endsolid seed", ""]).encode()


def stl_binary(vertices, triangles):
    out = bytes(80) + struct.pack("<I", len(triangles))
    for t in triangles:
        out += struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *vertices[i]) for i in t) + bytes(2)
    return out


def ply(vertices, triangles, form):
    order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[form]
    head = ("ply\nformat %s 1.0\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\n"
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n"
            % (form, len(vertices), len(triangles))).encode()
    if order is None:
        rows = ["%r %r %r" % v for v in vertices] + ["3 %d %d %d" % t for t in triangles]
        return head + ("\n".join(rows) + "\n").encode()
    body = b"".join(struct.pack(order + "3d", *v) for v in vertices)
    return head + body + b"".join(struct.pack(order + "B3i", 3, *t) for t in triangles)


def off(vertices, triangles):
    rows = ["OFF", "%d %d 0" % (len(vertices), len(triangles))]
    rows += ["%r %r %r" % v for v in vertices] + ["3 %d %d %d" % t for t in triangles]
    return ("\n".join(rows) + "\n").encode()


def model_3mf(vertices, triangles):
    xml = ['<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">',
           '<resources><object id="1" name="peg &amp; pin" type="model"><mesh><vertices>']
    xml += ['<vertex x="%r" y="%r" z="%r"/>' % v for v in vertices]
    xml += ["</vertices><triangles>"] + ['<triangle v1="%d" v2="%d" v3="%d"/>' % t for t in triangles]
    xml += ['</triangles></mesh></object></resources><build><item objectid="1"/></build></model>']
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                         '<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/'
                         '2013/01/3dmodel"/></Relationships>')
        archive.writestr("3D/3dmodel.model", "".join(xml))
    return out.getvalue()


def dae(vertices, triangles):
    numbers = " ".join("%r" % x for v in vertices for x in v)
    corners = " ".join(str(i) for t in triangles for i in t)
    return ('<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
            '<unit meter="0.001" name="mm"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>'
            '<source id="p"><float_array id="a" count="%d">%s</float_array><technique_common><accessor source="#a" count="%d"'
            ' stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>'
            '</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
            '<triangles count="%d"><input semantic="VERTEX" source="#v" offset="0"/><p>%s</p></triangles></mesh></geometry>'
            '</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n" name="n"><instance_geometry url="#g"/>'
            '</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>'
            % (3 * len(vertices), numbers, len(vertices), len(triangles), corners)).encode()


def gltf():
    positions = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    import base64
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "n", "mesh": 0, "translation": [1, 2, 3]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(positions).decode()}],
    }).encode()


def step_stream(vertices, triangles):
    def text(s):
        return struct.pack("<I", len(s)) + s

    def record(tag, payload):
        return tag + struct.pack("<I", len(payload)) + payload

    body = text(b"block") + struct.pack("<I", 1) + text(b"all") + struct.pack("<I", 2) + text(b"1") + text(b"1.1") + text(b"block")
    body += b"\1\1\2\3\4" + text(b"") + b"\0"
    body += struct.pack("<QQ", len(vertices), len(triangles))
    return (b"\x10DSMREAD2" + record(b"U", text(b"mm")) + record(b"S", text(b"reading") + struct.pack("<II", 0, 1)) +
            record(b"W", text(b"careful")) + record(b"B", body) +
            record(b"V", b"".join(struct.pack("<3d", *v) for v in vertices)) +
            record(b"T", b"".join(struct.pack("<3I", *t) for t in triangles)) + record(b"Z", struct.pack("<I", 1)))


def prepare(vertices, triangles):
    """As prepare.cpp reads it: coordinates are bytes."""
    most = max(abs(x) for v in vertices for x in v)
    part = bytes([min(len(vertices), 31), min(len(triangles), 63), 9])
    for v in vertices[:31]:
        part += bytes(round(100 * x / most) % 256 for x in v)
    for t in triangles[:63]:
        part += bytes(i % 256 for i in t)
    return bytes([3]) + part + part


def make_seeds(program, step_seeds, source, folder):
    source, folder = pathlib.Path(source), pathlib.Path(folder)

    def save(target, name, data):
        (folder / target).mkdir(parents=True, exist_ok=True)
        (folder / target / name).write_bytes(data)

    def run(*arguments):
        subprocess.run([str(program), *map(str, arguments)], check=False, capture_output=True)

    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        names = [line.split()[0].rstrip(":") for line in subprocess.run(
            [str(program), "sample", "list"], check=True, capture_output=True, text=True).stdout.splitlines()
            if line[:1].isalpha()]
        for sample in names:
            run("sample", sample, "-o", scratch / sample)
            files = sorted((scratch / sample).glob("*.obj"))
            if not files or sum(f.stat().st_size for f in files) > 40000:
                continue
            # Short ones of several kinds: what is found, what is proved, what is forced.
            run("plan", scratch / sample, "-o", scratch / (sample + "_plan"), "--seed", "1", "--timeout", "10",
                "--path-timeout", "3", "--threads", "1", "-q")
            plan = scratch / (sample + "_plan") / "plan.json"
            if plan.exists():
                save("plan", sample + ".json", json.dumps(json.loads(plan.read_text())).encode())
            glb = scratch / (sample + "_plan") / "plan.glb"
            if glb.exists() and glb.stat().st_size < 60000:
                save("assimp", sample + ".glb", b"\0" + glb.read_bytes())
        for sample in SMALL:
            for file in sorted((scratch / sample).glob("*.obj")):
                stem = sample + "_" + file.stem
                mesh = read_obj(file)
                save("obj", stem, file.read_bytes())
                save("stl", stem + "_text", stl_text(*mesh))
                save("stl", stem + "_binary", stl_binary(*mesh))
                for form in ("ascii", "binary_little_endian", "binary_big_endian"):
                    save("ply", stem + "_" + form, ply(*mesh, form))
                save("off", stem, off(*mesh))
                save("assimp", stem + ".3mf", b"\2" + model_3mf(*mesh))
                save("assimp", stem + ".dae", b"\3" + dae(*mesh))
                save("step_stream", stem, step_stream(*mesh))
                save("prepare", stem, prepare(*mesh))
        save("assimp", "triangle.gltf", b"\1" + gltf())
        save("obj", "quads", b"mtllib a.mtl\no a\ng x\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl m\nf 1/1/1 2//2 -2 \\\n -1\n")
        for file in sorted((source / "configs").rglob("*.yaml")):
            target = "suite" if file.parent.name == "bench" else "configuration"
            save(target, "_".join(file.relative_to(source / "configs").parts), file.read_bytes())
        suite = scratch / "suite.yaml"
        suite.write_text(SUITE.replace("CONFIGS", str(source / "configs")))
        save("suite", "small.yaml", suite.read_bytes())
        run("bench", suite, "-o", scratch / "bench")
        for file in (scratch / "bench").glob("*.db"):
            save("results", file.name, file.read_bytes())
    if step_seeds and pathlib.Path(step_seeds).exists():
        (folder / "step_file").mkdir(parents=True, exist_ok=True)
        # What Open CASCADE's writer leaks is not what is tested.
        subprocess.run([str(step_seeds), str(folder / "step_file")], check=True, capture_output=True,
                       env=dict(os.environ, ASAN_OPTIONS="detect_leaks=0"))
    for target in ("assimp", "configuration", "obj", "off", "plan", "ply", "prepare", "results", "step_stream", "stl", "suite"):
        if not any((folder / target).glob("*")):
            raise RuntimeError("no seeds for %s in %s" % (target, folder))


def copy_regressions(source, folder):
    """Inputs that once broke something are tried first."""
    for file in sorted((pathlib.Path(source) / "test/fuzz/regressions").glob("*/*")):
        target = pathlib.Path(folder) / file.parent.name
        target.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target / ("regression_" + file.name))
