"""Scenes: their bodies, and queries in water that comes in messages."""
import unittest

import numpy as np

import buoyancy
from support import SOURCE, TestCase, rows_of


class QueriesBodies(TestCase):
    def test_bodies_of_a_file(self):
        scene = buoyancy.Scene(SOURCE / "scenes" / "crate.toml")
        body, = scene.bodies
        self.assertEqual((body.id, body.name, body.method), (1, "crate", "hierarchical"))
        self.assertEqual(body.outputs, ("wrench", "loads"))
        self.assertEqual(body.quaternion.shape, (4,))
        self.assertEqual((scene.level, scene.gravity, scene.has_waves), (0.0, 9.80665, False))
        self.assertEqual(scene.query(1, body.position, body.quaternion).force.tolist(),
                         scene.query("crate", body.position, body.quaternion).force.tolist())

    def test_a_body_outlives_its_scene(self):
        body = buoyancy.Scene(SOURCE / "scenes" / "box.toml").bodies[0]
        self.assertIn("triangles", body.report)

    def test_a_sea_that_comes_in_messages(self):
        body = '[[body]]\nid = 1\nshape = { type = "box" }\n'
        waves = dict(type="regular", height=0.4, period=4)
        received = buoyancy.Scene.from_text('[water]\nwaves = "received"\n' + body)
        described = buoyancy.Scene.from_text('[water]\nwaves = { type = "regular", height = 0.4, period = 4 }\n' + body)
        position, time = np.linspace((0, 0, -1), (5, 0, 1), 20), np.linspace(0, 4, 20)
        result = received.query(1, position, (1, 0, 0, 0), time=time)
        self.assertEqual(set(result.status), {buoyancy.Status.NO_SEA})
        result = received.query(1, position, (1, 0, 0, 0), time=time, sea=buoyancy.Sea(waves=waves))
        self.assert_same_bits(rows_of(result), rows_of(described.query(1, position, (1, 0, 0, 0), time=time)))

    def test_hydrostatics(self):
        scene = buoyancy.Scene.from_text(
            '[[body]]\nid = 1\nshape = { type = "box" }\n[body.client]\ncenter_of_mass = [0, 0, 0]\n'
            '[[body]]\nid = 2\nmethod = "exact"\nshape = { type = "sphere" }\n')
        self.assertEqual(scene.hydrostatics(1, (0, 0, 0), (1, 0, 0, 0)).waterplane_area, 1.0)
        self.assertTrue(np.isfinite(scene.hydrostatics(1, (0, 0, 0), (1, 0, 0, 0)).metacentric_heights).all())
        with self.assertRaisesRegex(buoyancy.InputError, 'Add "hydrostatics" to its outputs'):
            scene.hydrostatics(2, (0, 0, 0), (1, 0, 0, 0))


if __name__ == "__main__":
    unittest.main()
