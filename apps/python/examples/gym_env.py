"""A part in a simulator as an environment for reinforcement learning, with the interface of gymnasium.

    python3 gym_env.py [--sample peg_in_hole] [--part peg] [--episodes 3] [--seed 1]

Runs a random policy. With gymnasium installed, DisassemblyEnv is a gymnasium.Env; without, it has the same methods and spaces.
"""
import argparse

import numpy as np

import dismantle

try:
    import gymnasium
    from gymnasium.spaces import Box

    Base = gymnasium.Env
except ImportError:
    Base = object

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


class DisassemblyEnv(Base):
    """One part is pushed until it is out: its convex hull is apart from that of all other parts.

    action: (6,), each in [-1, 1]: share of the largest force (3) and torque (3), world axes.
    observation: (16,) float64: displacement of the centre in radii of the part (3), rotation as a quaternion w, x, y, z (4),
        velocity of the centre in radii per second (3), angular velocity in rad per second (3), mean normal of the contacts (3).
    reward: distance by which the centre moved away from where it was assembled, in radii; 10 when the part is out; each step
        costs 0.01.
    """

    metadata = {"render_modes": []}

    def __init__(self, assembly, part, simulator="sdf_penalty", force=200.0, duration=0.1, max_steps=200):
        """force: largest force. duration: seconds of a step. max_steps: an episode is truncated after this many steps."""
        self.world = dismantle.Simulator(simulator).world(assembly, part)
        self.duration, self.max_steps = float(duration), int(max_steps)
        self.radius = self.world.radius()
        self.largest = force * np.array([1.0] * 3 + [self.world.torque_arm()] * 3)
        self.action_space = Box(-1.0, 1.0, (6,), dtype=np.float64)
        self.observation_space = Box(-np.inf, np.inf, (16,), dtype=np.float64)
        self.steps = 0
        self.distance = 0.0

    def _displacement(self):
        x, y, z, w, qx, qy, qz = self.world.poses[0]
        centre, axis = self.world.center(), np.array([qx, qy, qz])
        turned = centre + 2 * np.cross(axis, np.cross(axis, centre) + w * centre)
        return (turned + np.array([x, y, z]) - centre) / self.radius

    def _observation(self):
        state = self.world.state[0]
        normals = self.world.contacts().normals
        mean = normals.mean(axis=0) if len(normals) else np.zeros(3)
        return np.concatenate([self._displacement(), state[3:7], state[7:10] / self.radius, state[10:13], mean])

    def reset(self, *, seed=None, options=None):
        """Puts the part back; options={"state": (1, 13)} begins elsewhere. Returns (observation, info)."""
        if Base is not object:
            super().reset(seed=seed)
        if seed is not None:
            self.action_space.seed(seed)
        self.world.reset()
        if options and "state" in options:
            self.world.state = options["state"]
        self.steps, self.distance = 0, float(np.linalg.norm(self._displacement()))
        return self._observation(), {}

    def step(self, action):
        """Returns (observation, reward, terminated, truncated, info)."""
        action = np.clip(np.asarray(action, dtype=np.float64), -1.0, 1.0)
        report = self.world.step(action * self.largest, self.duration)
        self.steps += 1
        distance = float(np.linalg.norm(self._displacement()))
        terminated = self.world.separated()
        reward = distance - self.distance - 0.01 + (10.0 if terminated else 0.0)
        self.distance = distance
        info = {"penetration": self.world.penetration(), "simulated_steps": report.steps, "stalled": report.stalled}
        return self._observation(), reward, terminated, self.steps >= self.max_steps and not terminated, info

    def close(self):
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
