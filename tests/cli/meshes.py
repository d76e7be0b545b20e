"""Boxes and any other triangles in all formats that are read, as text or bytes."""
import base64
import io
import json
import struct
import zipfile


def box(lo, hi):
    """Vertices and outward triangles."""
    vertices = [tuple(float(hi[k] if i >> k & 1 else lo[k]) for k in range(3)) for i in range(8)]
    triangles = []
    for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
        triangles += [(a, b, c), (a, c, d)]
    return vertices, triangles


def obj(vertices, triangles):
    return "".join("v %r %r %r\n" % tuple(v) for v in vertices) + "".join("f %d %d %d\n" % tuple(i + 1 for i in t) for t in triangles)


def stl(vertices, triangles):
    data = bytes(80) + struct.pack("<I", len(triangles))
    for t in triangles:
        data += bytes(12) + b"".join(struct.pack("<3f", *vertices[i]) for i in t) + bytes(2)
    return data


def stl_text(vertices, triangles):
    text = "solid x\n"
    for t in triangles:
        text += "facet normal 0 0 0\nouter loop\n" + "".join("vertex %r %r %r\n" % tuple(vertices[i]) for i in t) + "endloop\nendfacet\n"
    return text + "endsolid x\n"


def off(vertices, triangles):
    return ("OFF\n%d %d 0\n" % (len(vertices), len(triangles)) + "".join("%r %r %r\n" % tuple(v) for v in vertices)
            + "".join("3 %d %d %d\n" % tuple(t) for t in triangles))


def _ply_header(kind, vertices, triangles):
    return (f"ply\nformat {kind} 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")


def ply(vertices, triangles):
    return (_ply_header("binary_little_endian", vertices, triangles).encode() + b"".join(struct.pack("<3f", *v) for v in vertices)
            + b"".join(struct.pack("<B3i", 3, *t) for t in triangles))


def ply_text(vertices, triangles):
    return (_ply_header("ascii", vertices, triangles) + "".join("%r %r %r\n" % tuple(v) for v in vertices)
            + "".join("3 %d %d %d\n" % tuple(t) for t in triangles))


def _gltf(vertices, triangles):
    points = b"".join(struct.pack("<3f", *v) for v in vertices)
    data = points + b"".join(struct.pack("<3I", *t) for t in triangles)
    corner = [[f(v[k] for v in vertices) for k in range(3)] for f in (min, max)]
    return data, {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "n"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(points)},
                        {"buffer": 0, "byteOffset": len(points), "byteLength": len(data) - len(points)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3", "min": corner[0], "max": corner[1]},
                      {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}]}


def gltf(vertices, triangles):
    data, scene = _gltf(vertices, triangles)
    scene["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps(scene)


def glb(vertices, triangles):
    data, scene = _gltf(vertices, triangles)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(data), b"BIN\0") + data)


def dae(vertices, triangles):
    numbers = " ".join("%r" % x for v in vertices for x in v)
    corners = " ".join(str(i) for t in triangles for i in t)
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh><source id="p"><float_array id="a" count="{3 * len(vertices)}">{numbers}</float_array>
<technique_common><accessor source="#a" count="{len(vertices)}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{len(triangles)}"><input semantic="VERTEX" source="#v" offset="0"/><p>{corners}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def threemf(vertices, triangles):
    points = "".join('<vertex x="%r" y="%r" z="%r"/>' % tuple(v) for v in vertices)
    faces = "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % tuple(t) for t in triangles)
    content = "http://schemas.openxmlformats.org/package/2006/"
    files = {
        "[Content_Types].xml": f'<?xml version="1.0"?><Types xmlns="{content}content-types"><Default Extension="rels" '
                               'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" '
                               'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>',
        "_rels/.rels": f'<?xml version="1.0"?><Relationships xmlns="{content}relationships"><Relationship Target="/3D/3dmodel.model" '
                       'Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
        "3D/3dmodel.model": '<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
                            f'<resources><object id="1" type="model" name="m"><mesh><vertices>{points}</vertices><triangles>{faces}'
                            '</triangles></mesh></object></resources><build><item objectid="1"/></build></model>'}
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return out.getvalue()


# Ending, writer.
FORMATS = (("obj", obj), ("stl", stl), ("stl", stl_text), ("off", off), ("ply", ply), ("ply", ply_text), ("glb", glb), ("gltf", gltf),
           ("dae", dae), ("3mf", threemf))
