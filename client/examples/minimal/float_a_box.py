#!/usr/bin/python3
"""A complete simulator of one body, the box of scenes/box.toml, as in float_a_box.cpp. Usage: float_a_box.py [LCM URL]"""
import sys

import buoyancy
import numpy as np

mass, step, gravity = 256.25, 1e-3, np.array([0, 0, -9.80665])  # kg, s, m/s²
inertia = np.diag(mass / 12 * np.array([1.25, 1.25, 2.0]))  # kg m², about the mesh's axes
position, velocity, angular_velocity = np.array([0, 0, 0.75]), np.zeros(3), np.zeros(3)  # m, m/s, rad/s; world, z up
quaternion = np.array([0.98, 0.15, 0.1, 0]) / np.linalg.norm([0.98, 0.15, 0.1, 0])  # w, x, y, z

with buoyancy.Client(*sys.argv[1:2], max_retries=600) as client:
    for i in range(20_000):
        wrench = client.request(1, position, quaternion, linear_velocity=velocity, angular_velocity=angular_velocity,
                                utime=1000 * i)
        wrench.raise_for_status()  # a body that cannot be evaluated would fall
        w, x, y, z = quaternion
        rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                             [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                             [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
        inertia_W = rotation @ inertia @ rotation.T
        torque = wrench.torque - 40 * angular_velocity - np.cross(angular_velocity, inertia_W @ angular_velocity)
        velocity = velocity + step * ((wrench.force - 500 * velocity) / mass + gravity)  # semi-implicit Euler
        angular_velocity = angular_velocity + step * np.linalg.solve(inertia_W, torque)
        position = position + step * velocity
        a, b, c = step / 2 * angular_velocity
        quaternion = quaternion + np.array([-a * x - b * y - c * z, a * w + b * z - c * y,
                                            b * w + c * x - a * z, c * w + a * y - b * x])
        quaternion /= np.linalg.norm(quaternion)
print(f"draft {0.25 - position[2]:.6f} m")
