import pickle

import numpy as np
import pytest

import dismantle
from shapes import cube


def test_arrays_come_back_as_they_went_in():
    rng = np.random.default_rng(1)
    for _ in range(20):
        lo = rng.uniform(-50, 50, 3)
        size = rng.uniform(1, 20, 3)
        meshes = {"left": cube(lo, lo + size), "right": cube(lo + [size[0], 0, 0], lo + size + [size[0], 0, 0])}
        assembly = dismantle.Assembly.from_meshes(meshes, unit="mm")
        assert assembly.names == ["left", "right"] and len(assembly) == 2 and assembly.unit == "mm"
        for name, (vertices, _) in meshes.items():
            part = assembly[name]
            for corner in vertices:
                assert np.abs(part.vertices - corner).max(axis=1).min() < 1e-9
            assert part.volume == pytest.approx(np.prod(size))
            internal = assembly.scale * (part.vertices - assembly.center)
            assert np.allclose(internal, part.internal_vertices, atol=1e-9)
        assert np.ptp(assembly.box, axis=0) == pytest.approx(size * [2, 1, 1])
        assert (assembly.box[1] - assembly.box[0]).max() * assembly.scale == pytest.approx(10)


def test_poses_convert_between_frames(box):
    rng = np.random.default_rng(2)
    vertices, internal = box[1].vertices, box[1].internal_vertices
    for _ in range(50):
        pose = np.concatenate([rng.normal(size=3), rng.normal(size=4)])
        pose[3:] /= np.linalg.norm(pose[3:])
        there = box.poses_to_input(pose)
        assert np.allclose(box.poses_to_internal(there), pose, atol=1e-12)
        moved = box.scale * (transformed(there[0], vertices) - box.center)
        assert np.allclose(moved, transformed(pose, internal), atol=1e-9)


def transformed(pose, points):
    w, axis = pose[3], pose[4:7]
    return points + 2 * np.cross(axis, np.cross(axis, points) + w * points) + pose[:3]


def test_what_is_read_is_what_was_made(box, tmp_path):
    box.write(tmp_path / "parts")
    loaded = dismantle.Assembly.load(tmp_path / "parts")
    assert sorted(loaded.names) == sorted(box.names)
    for name in box.names:
        assert loaded[name].volume == pytest.approx(box[name].volume, rel=1e-9)


def test_overlaps_are_told_in_input_units():
    for shift in (0.0, 100.0):
        for depth in (0.3, 0.5):
            meshes = {"a": cube([shift, 0, 0], [shift + 10, 10, 10]), "b": cube([shift + 10 - depth, 2, 2], [shift + 20, 8, 8])}
            overlap, = dismantle.Assembly.from_meshes(meshes).overlaps
            assert (overlap.a, overlap.b) == ("a", "b") and overlap.declared is None
            assert overlap.depth == pytest.approx(depth, rel=1e-6)
            assert overlap.contact in ("uniform_interference", "local_interference") and 0 <= overlap.share <= 1
            assert overlap.region.shape == (2, 3) and (overlap.region[0] <= overlap.at + 1e-9).all()
            assert shift + 10 - depth - 1e-6 <= overlap.at[0] <= shift + 10 + 1e-6


def test_overlaps_of_samples_have_their_class():
    for sample, known in (("pressed_pin", "uniform_interference"), ("gear_pair", "local_interference"),
                          ("part_in_solid", "inside")):
        overlaps = dismantle.Assembly.from_sample(sample).overlaps
        assert known in {o.contact for o in overlaps}, sample
        if sample == "pressed_pin":
            point, direction = overlaps[0].axis
            assert point.shape == (3,) and np.linalg.norm(direction) == pytest.approx(1)


def test_parts_that_are_left_out_are_told():
    plates = dismantle.Assembly.from_sample("same_plate_twice")
    (name, reason), = plates.excluded
    assert name not in plates.names and "duplicate" in reason


def test_what_the_user_declares_of_overlaps():
    named = {"constraints": {"overlap": [{"parts": ["peg", "block"], "depth": 0.25}]}}
    overlap, = dismantle.Assembly.from_sample("peg_in_hole", config=named).overlaps
    assert {overlap.a, overlap.b} == {"peg", "block"} and overlap.declared == pytest.approx(0.25)


def test_what_cannot_be_used_is_named(tmp_path):
    with pytest.raises(dismantle.InputError) as missing:
        dismantle.Assembly.load(tmp_path / "nothing")
    assert missing.value.subject == str(tmp_path / "nothing")
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "a.obj").write_text("v 1 2\nf 1 2 3\n")
    with pytest.raises(dismantle.InputError, match="a"):
        dismantle.Assembly.load(tmp_path / "broken")
    vertices, triangles = cube([0, 0, 0], [1, 1, 1])
    with pytest.raises(ValueError, match=r"part.*triangle 0 names vertex 99"):
        dismantle.Assembly.from_meshes({"part": (vertices, triangles + 99 - triangles[0, 0])})
    with pytest.raises(ValueError, match=r"\(N, 3\)"):
        dismantle.Assembly.from_meshes({"part": (vertices[:, :2], triangles)})
    with pytest.raises(KeyError, match="did you mean 'plate_1'"):
        dismantle.Assembly.from_sample("stacked_box")["plate_"]
    with pytest.raises(ValueError, match="did you mean 'stacked_box'"):
        dismantle.Assembly.from_sample("staked_box")


def test_assemblies_can_be_pickled(tmp_path, peg):
    made = dismantle.Assembly.from_meshes({"a": cube([0, 0, 0], [1, 1, 1]), "b": cube([0, 0, 1], [1, 1, 2])}, unit="mm")
    peg.write(tmp_path / "peg")
    loaded = dismantle.Assembly.load(tmp_path / "peg", set={"assembly.size": 5})
    for assembly in (peg, made, loaded):
        again = pickle.loads(pickle.dumps(assembly))
        assert again.names == assembly.names and again.sha256 == assembly.sha256 and again.scale == assembly.scale
        assert again.unit == assembly.unit and again.source == assembly.source
        for a, b in zip(assembly, again):
            assert a.vertices.tobytes() == b.vertices.tobytes()
    kept = pickle.dumps(loaded)
    for file in (tmp_path / "peg").glob("*.obj"):
        file.write_text(file.read_text() + "\n# another one\n")
    with pytest.raises(dismantle.InputError, match="have changed"):
        pickle.loads(kept)
