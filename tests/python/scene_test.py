"""Scenes: their bodies, and queries in water that comes in messages."""
import tempfile
import unittest
import warnings
from pathlib import Path

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


COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>{}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 2 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


class WarnsOfMeshesOnTheirSide(TestCase):
    def test_of_files_whose_up_axis_is_not_up(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, axis in ("side", "Y_UP"), ("upright", "Z_UP"):
                Path(folder, name + ".dae").write_text(COLLADA.format(axis))
                Path(folder, name + ".toml").write_text('[[body]]\nid = 1\nmesh = "{}.dae"\n'.format(name))
            expected = r"side.*has y up in its file.*orientation = \[0.707106781187, 0.707106781187, 0, 0\]"
            with self.assertWarnsRegex(UserWarning, 'Pass up="y"; in a scene file, orientation = '):
                mesh = buoyancy.Mesh(Path(folder, "side.dae"))
            np.testing.assert_array_equal(mesh.bounding_box, [(0, 0, 0), (2, 1, 1)])
            with self.assertWarnsRegex(UserWarning, expected):
                buoyancy.Scene(Path(folder, "side.toml"))
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                buoyancy.Mesh(Path(folder, "upright.dae"))
                buoyancy.Scene(Path(folder, "upright.toml"))
                with self.assertRaises(UserWarning):
                    buoyancy.Mesh(Path(folder, "side.dae"))
                for scale in (1, 1, 1), (1, -1, 1):
                    mesh = buoyancy.Mesh(Path(folder, "side.dae"), up="y", scale=scale)
                    self.assertEqual((mesh.bounding_box[0][2], mesh.bounding_box[1][2]), (0, 1))
                with self.assertRaises(UserWarning):
                    buoyancy.Mesh(Path(folder, "side.dae"), up="x")


if __name__ == "__main__":
    unittest.main()
