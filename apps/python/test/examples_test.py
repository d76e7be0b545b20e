import importlib.util
import subprocess
import sys

import numpy as np
import pytest


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


def test_it_runs_as_a_program(source):
    out = subprocess.run([sys.executable, source / "apps/python/examples/gym_env.py", "--episodes", "2", "--steps", "5"],
                         capture_output=True, text=True, check=True).stdout
    assert out.count("episode") == 2
