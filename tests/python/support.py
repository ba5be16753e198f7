"""What the tests of the module share."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import buoyancy

SOURCE = Path(os.environ["BUOYANCY_SOURCE"])
BIN = Path(os.environ["BUOYANCY_BIN"])
SANITIZED = "BUOYANCY_SANITIZED" in os.environ
MESHES = ("rock", "sphere", "knot", "hull", "cone")
WATERS = {
    "rest": {},
    "tilted": dict(gravity=3.7, up=(0.3, -0.2, 2), level=0.1, density=998.2),
    "waves": dict(depth=30, waves=dict(type="jonswap", significant_wave_height=0.5, peak_period=4.0, frequencies=40,
                                       seed=3)),
}


def without_preload():
    """The environment of a program that is instrumented itself."""
    return {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}


class Reference:
    """What python_reference wrote: poses, meshes, scenes, and the service's wrenches."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)
        subprocess.run([BIN / "python_reference", self.folder], check=True, env=without_preload())
        poses = np.fromfile(self.folder / "poses.f64").reshape(-1, 13)
        self.position = np.ascontiguousarray(poses[:, :3])
        self.quaternion = np.ascontiguousarray(poses[:, 3:7])
        self.linear_velocity = np.ascontiguousarray(poses[:, 7:10])
        self.angular_velocity = np.ascontiguousarray(poses[:, 10:])
        self.time = np.fromfile(self.folder / "utimes.i64", np.int64) / 1e6

    def mesh(self, name):
        return buoyancy.Mesh(np.fromfile(self.folder / f"{name}.vertices.f64").reshape(-1, 3),
                             np.fromfile(self.folder / f"{name}.faces.i64", np.int64).reshape(-1, 3))

    def scene(self, water):
        return buoyancy.Scene(self.folder / f"{water}.toml")

    def rows(self, water, body_id):
        return np.fromfile(self.folder / f"{water}.{body_id}.f64").reshape(-1, 13)


def rows_of(result):
    """A result in the columns of Reference.rows()."""
    return np.column_stack([result.status, result.force, result.torque, result.volume, result.center_of_buoyancy,
                            result.force_error_bound, result.torque_error_bound])


def box(size=1.0):
    """Vertices and faces of a cube about the origin."""
    vertices = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                      [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    return (vertices - 0.5) * size, faces


class TestCase(unittest.TestCase):
    def assert_same_bits(self, left, right):
        left, right = np.ascontiguousarray(left), np.ascontiguousarray(right)
        self.assertEqual(left.dtype, right.dtype)
        self.assertEqual(left.shape, right.shape)
        differing = np.flatnonzero(left.view(np.uint8).reshape(-1) != right.view(np.uint8).reshape(-1))
        self.assertEqual(differing.size, 0, f"{differing.size} bytes differ")
