"""A part in a simulator as environments for reinforcement learning, with the interface of gymnasium.

    python3 gym_env.py [--sample peg_in_hole] [--part peg] [--episodes 3] [--seed 1]

Runs a random policy. With gymnasium installed, DisassemblyEnv is a gymnasium.Env and VectorDisassemblyEnv a gymnasium.vector.VectorEnv;
without, they have the same methods and spaces.
"""
import argparse

import numpy as np

import dismantle

try:
    import gymnasium
    from gymnasium.spaces import Box
    from gymnasium.vector import VectorEnv
    from gymnasium.vector.utils import batch_space

    Base = gymnasium.Env
except ImportError:
    Base = VectorEnv = object

    class Box:
        """What this file needs of gymnasium.spaces.Box."""

        def __init__(self, low, high, shape, dtype=np.float64):
            self.low, self.high = np.full(shape, low, dtype), np.full(shape, high, dtype)
            self.shape, self.dtype = tuple(shape), np.dtype(dtype)
            self.np_random = np.random.default_rng()

        def seed(self, seed=None):
            self.np_random = np.random.default_rng(seed)

        def sample(self):
            low, high = np.maximum(self.low, -1e6), np.minimum(self.high, 1e6)
            return self.np_random.uniform(low, high).astype(self.dtype)

        def contains(self, x):
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

    def batch_space(space, n):
        return Box(space.low.flat[0], space.high.flat[0], (n, *space.shape), space.dtype)


def coarse(assembly, part):
    """Parameters of sdf_penalty for learning: contact points and time steps by the size of the part, not by the verifier's tolerance.

    A part then cuts in by up to half of that tolerance where it would cut in by a fifth of it, at ten times the speed.
    """
    corners = assembly[part].internal_vertices
    radius = np.linalg.norm(corners.max(axis=0) - corners.min(axis=0)) / 2
    return {"contact_spacing": 0.2 * radius, "advanced": {"max_travel": float(np.clip(0.02 * radius, 1e-4, 0.1))}}


class _Task:
    """Observations and rewards of equal worlds; the same for one and for many environments."""

    def __init__(self, assembly, part, count, simulator, force, threads):
        simulator = simulator or dismantle.Simulator("sdf_penalty", coarse(assembly, part))
        self.worlds = simulator.worlds(assembly, part, count, threads=threads)
        self.radius = self.worlds.radius()
        self.largest = force * np.array([1.0] * 3 + [self.worlds.torque_arm()] * 3)
        self.distance = np.zeros(count)
        self.reset()

    def reset(self, which=None):
        self.worlds.reset(which)
        self.note_distance()

    def note_distance(self):
        self.way = self.worlds.displacements[:, 0] / self.radius
        before, self.distance = self.distance, np.sqrt((self.way * self.way).sum(axis=1))
        return self.distance - before

    def observations(self):
        out = np.empty((len(self.distance), 16))
        states = self.worlds.states[:, 0]
        out[:, :3] = self.way
        out[:, 3:13] = states[:, 3:]
        out[:, 7:10] /= self.radius
        out[:, 13:] = self.worlds.mean_normals[:, 0]
        return out

    def step(self, actions, duration):
        """actions: (N, 6). Returns rewards, out (bool) and what the worlds report."""
        actions = np.minimum(np.maximum(np.asarray(actions, dtype=np.float64), -1.0), 1.0)
        report = self.worlds.step(actions * self.largest, duration)
        out = self.worlds.separated
        return self.note_distance() - 0.01 + 10.0 * out, out, report


ACTIONS = Box(-1.0, 1.0, (6,), dtype=np.float64)
OBSERVATIONS = Box(-np.inf, np.inf, (16,), dtype=np.float64)


class DisassemblyEnv(Base):
    """One part is pushed until it is out: its convex hull is apart from that of all other parts.

    action: (6,), each in [-1, 1]: share of the largest force (3) and torque (3), world axes.
    observation: (16,) float64: displacement of the centre in radii of the part (3), rotation as a quaternion w, x, y, z (4),
        velocity of the centre in radii per second (3), angular velocity in rad per second (3), mean normal of the contacts (3).
    reward: distance by which the centre moved away from where it was assembled, in radii; 10 when the part is out; each step
        costs 0.01.
    """

    metadata = {"render_modes": []}

    def __init__(self, assembly, part, simulator=None, force=200.0, duration=0.1, max_steps=200):
        """simulator: a Simulator; None: a fast one, coarse(). force: largest force. duration: seconds of a step. max_steps: an episode
        is truncated after this many steps."""
        self.task = _Task(assembly, part, 1, simulator, force, 1)
        self.duration, self.max_steps, self.steps = float(duration), int(max_steps), 0
        self.action_space = Box(-1.0, 1.0, (6,), dtype=np.float64)
        self.observation_space = OBSERVATIONS

    def reset(self, *, seed=None, options=None):
        """Puts the part back; options={"state": (1, 13)} begins elsewhere. Returns (observation, info)."""
        if Base is not object:
            super().reset(seed=seed)
        if seed is not None:
            self.action_space.seed(seed)
        self.task.reset()
        if options and "state" in options:
            self.task.worlds.set_state(0, options["state"])
            self.task.note_distance()
        self.steps = 0
        return self.task.observations()[0], {}

    def step(self, action):
        """Returns (observation, reward, terminated, truncated, info)."""
        rewards, out, report = self.task.step(np.asarray(action)[np.newaxis], self.duration)
        self.steps += 1
        terminated = bool(out[0])
        info = {"penetration": float(self.task.worlds.penetrations[0]), "simulated_steps": int(report["steps"][0]),
                "stalled": bool(report["stalled"][0])}
        return self.task.observations()[0], float(rewards[0]), terminated, self.steps >= self.max_steps and not terminated, info

    def close(self):
        pass


class VectorDisassemblyEnv(VectorEnv):
    """N environments as DisassemblyEnv in one call, on `threads` cores. Results do not depend on their number.

    Each array has one row per environment. An environment that has ended begins anew in the next step, whose action it ignores:
    gymnasium's AutoresetMode.NEXT_STEP.
    """

    metadata = {"render_modes": []}

    def __init__(self, assembly, part, num_envs, simulator=None, force=200.0, duration=0.1, max_steps=200, threads=1):
        self.task = _Task(assembly, part, num_envs, simulator, force, threads)
        self.num_envs, self.duration, self.max_steps = num_envs, float(duration), int(max_steps)
        self.single_action_space, self.single_observation_space = ACTIONS, OBSERVATIONS
        self.action_space, self.observation_space = batch_space(ACTIONS, num_envs), batch_space(OBSERVATIONS, num_envs)
        self.steps = np.zeros(num_envs, dtype=np.int64)
        self.ended = np.zeros(num_envs, dtype=bool)

    def reset(self, *, seed=None, options=None):
        """Puts all parts back. Returns (observations, infos)."""
        if seed is not None:
            self.action_space.seed(seed)
        self.task.reset()
        self.steps[:], self.ended[:] = 0, False
        return self.task.observations(), {}

    def step(self, actions):
        """Returns (observations, rewards, terminations, truncations, infos)."""
        begins = self.ended
        rewards, out, report = self.task.step(np.where(begins[:, np.newaxis], 0.0, actions), self.duration)
        self.steps += 1
        if begins.any():
            self.task.reset(np.flatnonzero(begins))
            self.steps[begins], rewards[begins], out[begins] = 0, 0.0, False
        truncated = (self.steps >= self.max_steps) & ~out
        self.ended = out | truncated
        infos = {"penetration": self.task.worlds.penetrations, "simulated_steps": report["steps"], "stalled": report["stalled"]}
        return self.task.observations(), rewards, out, truncated, infos

    def close(self, **kwargs):
        pass


def run_episode(env, policy, seed):
    """Rewards and observations of one episode. policy: observation -> action."""
    observation, _ = env.reset(seed=seed)
    rewards, observations = [], [observation]
    while True:
        observation, reward, terminated, truncated, _ = env.step(policy(observation))
        rewards.append(reward)
        observations.append(observation)
        if terminated or truncated:
            return np.array(rewards), np.array(observations), terminated


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sample", default="peg_in_hole")
    parser.add_argument("--part", default="peg")
    parser.add_argument("--episodes", type=int, default=3)
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    env = DisassemblyEnv(dismantle.Assembly.from_sample(arguments.sample), arguments.part, max_steps=arguments.steps)
    for episode in range(arguments.episodes):
        rewards, _, out = run_episode(env, lambda _: env.action_space.sample(), arguments.seed + episode)
        print(f"episode {episode + 1}: {len(rewards)} steps, return {rewards.sum():.3f}, {'out' if out else 'not out'}")


if __name__ == "__main__":
    main()
