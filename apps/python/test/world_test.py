import numpy as np
import pytest

import dismantle

SIMULATORS = ["sdf_penalty", "sdf_velocity"]


def rollout(world, seed, steps=15):
    rng = np.random.default_rng(seed)
    world.reset()
    states, contacts = [], []
    for _ in range(steps):
        arm = world.torque_arm()
        world.step(300 * rng.uniform(-1, 1, 6) * [1, 1, 1, arm, arm, arm], 0.05)
        states.append(world.state)
        c = world.contacts()
        contacts.append((c.points, c.normals, c.depths, c.parts))
    return states, contacts


def same(a, b):
    return all(x.tobytes() == y.tobytes() for x, y in zip(a[0], b[0])) and all(
        x.tobytes() == y.tobytes() for p, q in zip(a[1], b[1]) for x, y in zip(p, q))


@pytest.mark.parametrize("simulator", SIMULATORS)
def test_a_random_policy_is_repeatable_to_the_last_bit(simulator, peg, machine):
    for assembly, part in ((peg, "peg"), (machine, "pin_2"), (machine, "cap_2")):
        first = dismantle.Simulator(simulator).world(assembly, part)
        second = dismantle.Simulator(simulator).world(assembly, part)
        for seed in range(3):
            a = rollout(first, seed)
            assert same(a, rollout(first, seed))
            assert same(a, rollout(second, seed))
        assert not same(a, rollout(first, 99))


@pytest.mark.parametrize("simulator", SIMULATORS)
def test_a_state_can_be_put_back(simulator, peg, machine):
    rng = np.random.default_rng(1)
    for assembly, part in ((peg, "peg"), (machine, "pin_2"), (machine, "base")):
        world = dismantle.Simulator(simulator).world(assembly, part)
        for _ in range(6):
            world.step(100 * rng.uniform(-1, 1, 6), 0.05)
            state, wrench = world.state, 100 * rng.uniform(-1, 1, 6)
            ends = []
            for _ in range(3):
                world.state = state
                assert world.state.tobytes() == state.tobytes()
                world.step(wrench, 0.05)
                c = world.contacts()
                ends.append([world.state.tobytes(), c.points.tobytes(), c.depths.tobytes(), world.penetration()])
                for _ in range(3):  # what came before does not matter
                    world.step(100 * rng.uniform(-1, 1, 6), 0.05)
                    world.penetration(world.poses + rng.uniform(0, 0.01, (1, 7)) * [1, 1, 1, 0, 0, 0, 0])
            assert ends[0] == ends[1] == ends[2]
        world.reset()
        assert np.array_equal(world.state, [[0, 0, 0, 1] + [0] * 9])


@pytest.mark.parametrize("simulator", SIMULATORS)
def test_contacts(simulator, peg):
    world = dismantle.Simulator(simulator).world(peg, "peg")
    assert world.moving == ["peg"] and world.fixed == ["block"]
    world.poses = [[0.2, 0, 0, 1, 0, 0, 0]]  # into the wall of the hole
    contacts = world.contacts()
    assert len(contacts) > 0 and world.penetration() > 0
    assert contacts.points.shape == contacts.normals.shape == (len(contacts), 3)
    assert contacts.depths.shape == (len(contacts),) and contacts.parts.shape == (len(contacts), 2)
    assert np.allclose(np.linalg.norm(contacts.normals, axis=1), 1)
    assert contacts.depths.max() == pytest.approx(world.penetration())
    assert set(map(tuple, contacts.parts)) == {(peg["peg"].id, peg["block"].id)}
    deepest = contacts.normals[contacts.depths.argmax()]
    assert deepest[0] < -0.9  # pushes the peg back
    world.poses = [[0, 0, 50, 1, 0, 0, 0]]
    assert world.separated() and world.penetration() == 0
    assert world.separated([[0, 0, 50, 1, 0, 0, 0]]) and not world.separated([[0, 0, 0, 1, 0, 0, 0]])


def test_a_push_along_the_hole_takes_the_peg_out(peg):
    world = dismantle.Simulator().world(peg, "peg")
    for _ in range(100):
        report = world.step([0, 0, 200, 0, 0, 0])
        assert report.finite and report.poses.shape[1:] == (1, 7)
        assert np.array_equal(report.poses[-1], world.poses)
        if world.separated():
            break
    assert world.separated() and world.poses[0, 2] > 1
    locked = dismantle.Simulator().world(peg, "peg", space="translation")
    locked.step([0, 0, 200, 50, 50, 50])
    assert np.array_equal(locked.poses[0, 3:], [1, 0, 0, 0])


def test_a_part_is_moved_clear_of_what_it_cuts_into(peg):
    world = dismantle.Simulator().world(peg, "peg")
    rng = np.random.default_rng(2)
    for _ in range(10):
        world.poses = [[*rng.uniform(-0.02, 0.02, 2), rng.uniform(0, 0.3), 1, 0, 0, 0]]
        before, there = world.penetration(), world.poses
        world.project_to_clearance(1e-3)
        assert world.penetration() <= max(before, 1e-9)
        assert np.linalg.norm(world.poses[0, :3] - there[0, :3]) < 0.2


def test_a_contact_sample_is_kept_over_resets(peg):
    """A point of the peg's axis lies in no surface: contact is seen there only when it was told to be watched."""
    world = dismantle.Simulator().world(peg, "peg")
    vertices, block = peg["peg"].internal_vertices, peg["block"].internal_vertices
    axis = np.array([0.0, 0.0, np.mean([block[:, 2].min(), block[:, 2].max()])])
    in_the_wall = [[(vertices[:, 0].max() + block[:, 0].max()) / 2, 0, 0, 1, 0, 0, 0]]
    known = len(world.contacts(in_the_wall))
    world.add_contact_sample("peg", "block", axis)
    assert len(world.contacts(in_the_wall)) == known + 1
    world.reset()
    assert len(world.contacts(in_the_wall)) == known + 1
    with pytest.raises(ValueError, match="point"):
        world.add_contact_sample("peg", "block", [0, 0])


def test_bad_arguments_are_named(peg):
    simulator = dismantle.Simulator(parameters={"time_step": 2e-3})
    with pytest.raises(ValueError, match="no parameter 'timestep'"):
        dismantle.Simulator(parameters={"timestep": 1})
    dismantle.Simulator(parameters={"advanced": {"max_travel": 0.01}})
    with pytest.raises(ValueError, match="no advanced parameter 'time_step'"):
        dismantle.Simulator(parameters={"advanced": {"time_step": 1e-3}})
    with pytest.raises(dismantle.PluginError, match="max_travel"):
        dismantle.Simulator(parameters={"advanced": {"max_travel": -1.0}})
    with pytest.raises(TypeError, match="time_step: expected a number"):
        dismantle.Simulator(parameters={"time_step": "fast"})
    with pytest.raises(dismantle.PluginError, match="time_step"):
        dismantle.Simulator(parameters={"time_step": -1.0})
    with pytest.raises(KeyError, match="did you mean 'peg'"):
        simulator.world(peg, "pegg")
    with pytest.raises(ValueError, match="'rigid' or 'translation'"):
        simulator.world(peg, "peg", space="plane")
    with pytest.raises(ValueError, match="one of the moving"):
        simulator.world(peg, "peg", fixed=["peg", "block"])
    with pytest.raises(ValueError, match="twice"):
        simulator.world(peg, ["peg"], fixed=["block", "block"])
    world = simulator.world(peg, "peg")
    with pytest.raises(IndexError, match="no moving part 1"):
        world.radius(1)
    for bad in (np.zeros(5), np.zeros((2, 6)), [np.nan] * 6):
        with pytest.raises(ValueError, match="wrench"):
            world.step(bad)
    with pytest.raises(ValueError, match="duration"):
        world.step(np.zeros(6), -1)
    with pytest.raises(ValueError, match="quaternion"):
        world.poses = [[0, 0, 0, 2, 0, 0, 0]]
    with pytest.raises(ValueError, match=r"\(1, 13\)"):
        world.state = np.zeros((1, 7))
    with pytest.raises(IndexError):
        simulator.world(peg, 7)
    geometry = dismantle.Simulator("fcl")
    assert not geometry.capabilities.dynamics and geometry.capabilities.distance
    with pytest.raises(Exception, match=".+"):
        geometry.world(peg, "peg").step(np.zeros(6))


def test_worlds_do_what_each_would_do_alone_on_any_number_of_threads(peg):
    simulator = dismantle.Simulator("sdf_penalty", {"contact_spacing": 1.0})
    many = [simulator.worlds(peg, "peg", 3, threads=n) for n in (1, 2)]
    alone = [simulator.world(peg, "peg") for _ in range(3)]
    rng = np.random.default_rng(1)
    for k in range(6):
        if k == 3:
            for worlds in many:
                worlds.reset([1])
            alone[1].reset()
        if k == 4:
            for worlds in many:
                worlds.set_state(2, alone[0].state)
            alone[2].state = alone[0].state
        wrenches = 100 * rng.uniform(-1, 1, (3, 6))
        reports = [world.step(wrench, 0.05) for world, wrench in zip(alone, wrenches)]
        for worlds in many:
            told = worlds.step(wrenches, 0.05)
            assert told["steps"].tolist() == [r.steps for r in reports] and told["travel"].tolist() == [r.travel for r in reports]
            assert worlds.states.tobytes() == np.stack([world.state for world in alone]).tobytes()
            assert worlds.separated.tolist() == [world.separated() for world in alone]
            assert worlds.penetrations.tolist() == [world.penetration() for world in alone]
            for world, normal, way in zip(alone, worlds.mean_normals[:, 0], worlds.displacements[:, 0]):
                normals = world.contacts().normals
                assert np.allclose(normal, normals.mean(axis=0) if len(normals) else 0)
                centre = world.center()
                assert np.allclose(way, dismantle.transform(world.poses[0], centre[None])[0] - centre)


def test_worlds_say_what_is_wrong_with_a_call(peg):
    simulator = dismantle.Simulator()
    worlds = simulator.worlds(peg, "peg", 2)
    assert len(worlds) == 2
    with pytest.raises(ValueError, match=r"shape \(2, 6\)"):
        worlds.step(np.zeros(6))
    with pytest.raises(ValueError, match="not finite"):
        worlds.step(np.full((2, 6), np.nan))
    with pytest.raises(IndexError, match="no world 2"):
        worlds.reset([2])
    with pytest.raises(ValueError, match="count"):
        simulator.worlds(peg, "peg", 0)
