#!/usr/bin/env python3
"""Thousands of floating crates as one vectorised environment, in the shape of Gymnasium's, without that package.

    client/examples/python/gym_environment.py [ENVIRONMENTS [STEPS]]

Each crate is pushed by a thruster (the action) and rewarded for staying upright at a height. One call evaluates the
water on all of them; the arrays of its result are used again in every step.
"""
import sys
import time

import numpy as np

import buoyancy

SCENE = """
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.5], segments = [4, 4, 4] }
"""
DENSITY, SIZE = 512.5, np.array([1.0, 1.0, 0.5])
GRAVITY = 9.80665


class FloatingCrates:
    """reset() and step() as a gymnasium.vector.VectorEnv: an array per quantity, a row per environment."""

    def __init__(self, environments, step=0.02, seed=0):
        self.scene = buoyancy.Scene.from_text(SCENE)
        self.count, self.dt = environments, step
        self.random = np.random.default_rng(seed)
        self.mass = DENSITY * SIZE.prod()
        squares = SIZE**2
        self.inertia = self.mass / 12 * (squares.sum() - squares)
        self.position = np.empty((environments, 3))
        self.quaternion = np.empty((environments, 4))
        self.velocity = np.empty((environments, 3))
        self.spin = np.empty((environments, 3))
        self.wrenches = None
        self.steps = 0

    def reset(self):
        self.position[:] = self.random.normal(0, 0.1, (self.count, 3))
        self.quaternion[:] = (1, 0, 0, 0)
        self.velocity[:] = 0
        self.spin[:] = self.random.normal(0, 0.1, (self.count, 3))
        self.steps = 0
        return self.observation(), {}

    def observation(self):
        return np.concatenate([self.position, self.quaternion, self.velocity, self.spin], axis=1)

    def step(self, action):
        """action: (environments,), a vertical force in units of the weight."""
        self.wrenches = self.scene.query(1, self.position, self.quaternion, time=self.steps * self.dt, out=self.wrenches)
        force = self.wrenches.force - 300.0 * self.velocity
        force[:, 2] += self.mass * GRAVITY * (np.clip(action, -0.5, 0.5) - 1)
        torque = self.wrenches.torque - 40.0 * self.spin
        # Semi-implicit Euler; the box is close enough to a cube to neglect the gyroscopic torque.
        self.velocity += self.dt / self.mass * force
        self.spin += self.dt * torque / self.inertia
        self.position += self.dt * self.velocity
        self.rotate(self.dt * self.spin)
        self.steps += 1
        failed = np.asarray(self.wrenches.status) != 0
        reward = 1.0 - np.abs(self.position[:, 2]) - np.linalg.norm(self.quaternion[:, 1:3], axis=1)
        truncated = np.full(self.count, self.steps >= 1000)
        return self.observation(), np.where(failed, -1.0, reward), failed, truncated, {}

    def rotate(self, angle):
        """Turns all bodies by small rotation vectors in the world frame."""
        w, x, y, z = self.quaternion.T
        a, b, c = angle.T / 2
        self.quaternion += np.stack([-a * x - b * y - c * z, a * w + b * z - c * y, b * w + c * x - a * z,
                                     c * w + a * y - b * x], axis=1)
        self.quaternion /= np.linalg.norm(self.quaternion, axis=1, keepdims=True)


def main():
    environments = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    steps = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    crates = FloatingCrates(environments)
    observation, _ = crates.reset()
    reward = np.zeros(environments)
    started = time.perf_counter()
    for _ in range(steps):
        action = -observation[:, 2] - 0.5 * observation[:, 9]  # pushes towards height 0
        observation, reward, terminated, truncated, _ = crates.step(action)
    seconds = time.perf_counter() - started
    print(f"{environments} environments, {steps} steps: mean reward {reward.mean():.3f}, "
          f"{terminated.sum()} terminated, {environments * steps / seconds:.3g} steps per second")


if __name__ == "__main__":
    main()
