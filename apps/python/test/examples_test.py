import importlib.util
import subprocess
import sys

import numpy as np
import pytest

import dismantle


@pytest.fixture(scope="module")
def gym_env(source):
    spec = importlib.util.spec_from_file_location("gym_env", source / "apps/python/examples/gym_env.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_environment_has_the_interface_of_gymnasium(gym_env, peg):
    env = gym_env.DisassemblyEnv(peg, "peg", max_steps=12)
    observation, info = env.reset(seed=3)
    assert env.observation_space.contains(observation) and info == {}
    for k in range(12):
        action = env.action_space.sample()
        assert env.action_space.contains(action)
        observation, reward, terminated, truncated, info = env.step(action)
        assert env.observation_space.contains(observation) and np.isfinite(reward) and info["penetration"] >= 0
        assert isinstance(terminated, bool) and truncated == (k == 11 and not terminated)
        if terminated:
            break


def test_the_same_seed_gives_the_same_episode(gym_env, machine):
    env = gym_env.DisassemblyEnv(machine, "pin_2", max_steps=10)
    for seed in range(3):
        a, b = (gym_env.run_episode(env, lambda _: env.action_space.sample(), seed) for _ in range(2))
        assert a[0].tobytes() == b[0].tobytes() and a[1].tobytes() == b[1].tobytes()
    other = gym_env.run_episode(env, lambda _: env.action_space.sample(), 99)
    assert other[1].tobytes() != a[1].tobytes()


def test_a_good_policy_is_rewarded(gym_env, peg):
    env = gym_env.DisassemblyEnv(peg, "peg", max_steps=100)
    rewards, _, out = gym_env.run_episode(env, lambda _: np.array([0, 0, 1, 0, 0, 0]), 1)
    idle, _, stayed = gym_env.run_episode(env, lambda _: np.zeros(6), 1)
    assert out and not stayed and rewards.sum() > 10 > idle.sum()


def test_many_environments_do_what_each_would_do_alone(gym_env, peg):
    many = gym_env.VectorDisassemblyEnv(peg, "peg", 2, max_steps=3, threads=2)
    alone = gym_env.DisassemblyEnv(peg, "peg", max_steps=3)
    observations, _ = many.reset(seed=1)
    assert observations.shape == (2, 16) and many.action_space.sample().shape == (2, 6)
    actions = np.random.default_rng(1).uniform(-1, 1, (8, 2, 6))
    told = [many.step(a) for a in actions]
    for n in range(2):
        assert np.array_equal(observations[n], alone.reset()[0])
        begins = False
        for k in range(8):
            observation, reward, out, truncated, _ = (*alone.reset(), False, False, {}) if begins else alone.step(actions[k, n])
            reward = 0.0 if begins else reward
            assert np.array_equal(told[k][0][n], observation) and told[k][1][n] == reward
            assert (told[k][2][n], told[k][3][n]) == ((False, False) if begins else (out, truncated))
            begins = not begins and (out or truncated)


def test_the_fast_simulator_of_the_environment_keeps_the_tolerance_of_the_verifier(gym_env, peg):
    env = gym_env.DisassemblyEnv(peg, "peg")
    exact = dismantle.Simulator("sdf_penalty", {"contact_spacing": 0.05}).world(peg, "peg")
    env.reset(seed=1)
    deepest = steps = 0
    for _ in range(30):
        info = env.step(env.action_space.sample())[4]
        steps = max(steps, info["simulated_steps"])
        deepest = max(deepest, exact.penetration(env.task.worlds.states[0, :, :7]))
    assert deepest < 0.01 and steps <= 12


def test_it_runs_as_a_program(source):
    out = subprocess.run([sys.executable, source / "apps/python/examples/gym_env.py", "--episodes", "2", "--steps", "5"],
                         capture_output=True, text=True, check=True).stdout
    assert out.count("episode") == 2
