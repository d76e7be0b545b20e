import copy
import html
import json
import pickle
import re

import numpy as np
import pytest

import dismantle
from planners_for_tests import LINES

# Short searches without proofs.
QUICK = {**LINES, "immobility": {"provers": []}}


def without_times(text):
    """A plan without what varies between runs."""

    def clean(value):
        if isinstance(value, dict):
            return {k: clean(v) for k, v in value.items() if k != "seconds"}
        return [clean(v) for v in value] if isinstance(value, list) else value

    return clean(json.loads(text))


def test_round_trip(box, peg, machine, tmp_path):
    for assembly in (box, peg, machine):
        for seed in (1, 7):
            plan = dismantle.run(assembly, seed=seed)
            text = plan.to_json()
            assert dismantle.Plan.from_json(text).to_json() == text
            plan.write(tmp_path / "plan.json")
            again = dismantle.Plan.read(tmp_path / "plan.json")
            assert again.to_json() == text and again.seed == seed and again.info == {}
            for step, same in zip(plan.steps, again.steps):
                assert step.parts == same.parts
                for part in step.parts:
                    assert np.array_equal(step.moves[part], same.moves[part])


def test_same_plan_as_the_command_line(program, tmp_path):
    for sample in ("stacked_box", "machine"):
        folder = tmp_path / sample
        program("sample", sample, "-o", folder)
        program("plan", folder, "-o", tmp_path / f"{sample}.out", "--seed", 5, "-q")
        theirs = (tmp_path / f"{sample}.out" / "plan.json").read_text()
        plan = dismantle.run(folder, seed=5)
        assert plan.complete
        assert without_times(plan.to_json()) == without_times(theirs)
        assert dismantle.verify(plan).complete
        plan.write(tmp_path / "mine.json")
        program("verify", tmp_path / "mine.json", "--assembly", folder)


def test_poses_are_those_of_the_format(box):
    plan = dismantle.run(box)
    for step, written in zip(plan.steps, json.loads(plan.to_json())["disassembly"]):
        for move in written["moves"]:
            poses = step.moves[move["part"]]
            assert poses.shape == (len(move["poses"]), 7) and poses.dtype == np.float64
            assert np.array_equal(poses, np.array(move["poses"]))
            assert np.allclose(np.linalg.norm(poses[:, 3:], axis=1), 1)
    first = next(iter(plan.steps[0].moves.values()))
    assert np.allclose(first[0], [0, 0, 0, 1, 0, 0, 0])


def test_forced_steps_are_told_and_are_not_valid_motions():
    clip = dismantle.Assembly.from_sample("snap_fit")
    plan = dismantle.run(clip, config=QUICK)
    assert plan.status == "forced" and not plan.complete and plan.forced
    for step in plan.steps:
        assert (step.forced is not None) == (step.number in plan.forced)
        if step.forced:
            assert step.forced.part in step.parts and step.forced.other in set(clip.names) - set(step.parts)
            assert step.forced.depth > step.forced.assembled >= 0 and step.forced.at.shape == (3,) and step.forced.reason
    check = dismantle.verify(plan, clip)
    assert check.valid and not check.complete and check.forced == len(plan.forced)
    assert dismantle.run(clip, config=QUICK, set={"run.force": "off"}).status == "partial"
    # A wrong depth is detected.
    lie = json.loads(plan.to_json())
    for step in lie["disassembly"]:
        if "forced" in step:
            step["forced"]["depth"] *= 0.5
    assert not dismantle.verify(dismantle.Plan.from_json(json.dumps(lie)), clip).valid
    again = dismantle.Plan.from_json(plan.to_json())
    assert again.forced == plan.forced and again.status == "forced" and "FORCED" in again.summary().upper()


def test_overlaps_that_steps_make_use_of_are_named():
    pin = dismantle.Assembly.from_sample("pressed_pin")
    plan = dismantle.run(pin, set={"verify.named_overlap": 0.0})
    assert plan.complete
    (overlap,), (used,) = plan.overlaps, [o for step in plan.steps for o in step.overlaps]
    (measured,) = pin.overlaps
    assert overlap.depth == pytest.approx(measured.depth, rel=1e-9) and overlap.contact == measured.contact
    assert {used.part, used.other} == {overlap.a, overlap.b}
    assert used.assembled == pytest.approx(overlap.depth, rel=1e-6)
    assert used.depth <= used.allowed + 0.01 / plan.scale + 1e-9


def test_constraints_on_overlaps_mean_the_same_wherever_they_are_given():
    """What the user says of a pair counts for an assembly that was loaded without it, too."""
    names = dismantle.Assembly.from_sample("pressed_pin").names
    forbid = {**QUICK, "constraints": {"overlap": [{"parts": names, "depth": 0.0}]}}
    plans = [dismantle.run(dismantle.Assembly.from_sample("pressed_pin", config=config), config=forbid)
             for config in (None, forbid)]
    assert without_times(plans[0].to_json()) == without_times(plans[1].to_json())
    assert plans[0].overlaps[0].declared == 0 and plans[0].status == "forced"
    with pytest.raises(dismantle.Error, match="constraints.overlap"):
        dismantle.run(dismantle.Assembly.from_sample("pressed_pin", config=forbid), config=QUICK)
    with pytest.raises(dismantle.ConfigError, match="did you mean"):
        dismantle.run(dismantle.Assembly.from_sample("pressed_pin"), config={"constraints": {"flexible": [names[0] + "s"]}})
    soft = {**QUICK, "constraints": {"flexible": [names[0]]}}
    assert dismantle.run(dismantle.Assembly.from_sample("pressed_pin"), config=soft).overlaps[0].declared > 0


def test_a_proof_is_part_of_the_plan():
    box = dismantle.Assembly.from_sample("closed_box")
    plan = dismantle.run(box, set={"run.force": "off"})
    assert not plan.steps and plan.certificates
    proved = [u for u in plan.unsolved if u.certificate is not None]
    assert proved and all(u.outcome == dismantle.Outcome.infeasible for u in proved)
    for u in proved:
        proof = plan.certificates[u.certificate]
        assert u.part in proof.parts and proof.text and proof.kind in {p["id"] for p in dismantle.plugins("immobility_prover")}
    check = dismantle.verify(plan, box)
    assert check.valid and check.certificates == len(plan.certificates)
    assert proved[0].part in plan.explain() and proved[0].part in plan.explain(proved[0].part)


def test_a_plan_that_was_tampered_with_is_not_valid(box):
    plan = dismantle.run(box)
    tampered = json.loads(plan.to_json())
    tampered["disassembly"].reverse()
    for number, step in enumerate(tampered["disassembly"], 1):
        step["step"], step["after"] = number, []
    check = dismantle.verify(dismantle.Plan.from_json(json.dumps(tampered)), box)
    assert not check and not check.valid and check.problems
    assert dismantle.verify(plan, box).valid


def test_what_is_wrong_with_a_plan_file_is_placed(tmp_path):
    (tmp_path / "plan.json").write_text('{"format": "dismantle.plan",\n "version": [}')
    with pytest.raises(dismantle.InputError, match=re.escape(str(tmp_path / "plan.json"))):
        dismantle.Plan.read(tmp_path / "plan.json")
    with pytest.raises(dismantle.InputError, match="no such file"):
        dismantle.Plan.read(tmp_path / "none.json")


def test_interpolation_is_a_screw_motion():
    rng = np.random.default_rng(3)
    for _ in range(50):
        a, b = rng.normal(size=(2, 7))
        for pose in (a, b):
            pose[3:] /= np.linalg.norm(pose[3:])
        assert np.allclose(dismantle.interpolate(a, b, 0), a)
        end = dismantle.interpolate(a, b, 1)
        assert np.allclose(end[:3], b[:3]) and abs(abs(end[3:] @ b[3:]) - 1) < 1e-12
        # The reverse motion passes through the same poses.
        u = rng.uniform()
        there, back = dismantle.interpolate(a, b, u), dismantle.interpolate(b, a, 1 - u)
        assert np.allclose(there[:3], back[:3]) and abs(abs(there[3:] @ back[3:]) - 1) < 1e-9


def test_a_plan_goes_to_other_processes_and_back(box):
    plan = dismantle.run(box, seed=3)
    for again in (pickle.loads(pickle.dumps(plan)), copy.deepcopy(plan)):
        assert again.to_json() == plan.to_json() and again.info == plan.info
    outcome = dismantle.Outcome.infeasible
    assert pickle.loads(pickle.dumps(outcome)) == outcome
    with pytest.raises(dismantle.ConfigError) as error:
        dismantle.run(box, set={"path_planner.type": "bsf"})
    again = pickle.loads(pickle.dumps(error.value))
    assert str(again) == str(error.value) and again.diagnostics == error.value.diagnostics


def test_the_animation_is_gltf(box, peg, tmp_path):
    plan = dismantle.run(box, seed=1)
    plan.write_glb(tmp_path / "plan.glb", box)
    data = (tmp_path / "plan.glb").read_bytes()
    assert data[:4] == b"glTF" and int.from_bytes(data[8:12], "little") == len(data)
    content = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])
    assert {n["name"] for n in content["nodes"]} >= set(box.names)
    with pytest.raises(dismantle.InputError):
        plan.write_glb(tmp_path / "other.glb", peg)


def test_a_plan_has_a_page_and_a_table_for_notebooks(box):
    plan = dismantle.run(box, seed=1)
    page = plan.page(box)
    assert page.lower().startswith("<!doctype html>")
    shown = plan.show(box, height=300)._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "height: 300px" in shown and html.escape(page) in shown
    table = plan._repr_html_()
    assert table.count("<tr>") == len(plan.steps) + 1 and all(html.escape(name) in table for s in plan.steps for name in s.parts)
