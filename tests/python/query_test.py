"""Queries of meshes and scenes give the service's numbers, from arrays of every kind."""
import array
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np

import buoyancy
from support import MESHES, SANITIZED, WATERS, Reference, TestCase, box, rows_of

# Prints by how much the peak of memory grows during a query of two million dry poses.
WITHOUT_COPY = """
import resource
import numpy as np
import buoyancy
from support import box
mesh = buoyancy.Mesh(*box())
position, quaternion = np.full((2_000_000, 3), 9.0), np.tile([1.0, 0, 0, 0], (2_000_000, 1))
result = mesh.query(position, quaternion)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
mesh.query(position, quaternion, out=result)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""


class HasTheBitsOfTheService(TestCase):
    @classmethod
    def setUpClass(cls):
        cls.reference = Reference()

    def test_of_meshes(self):
        for water, keys in WATERS.items():
            sea = buoyancy.Sea(**keys)
            for number, name in enumerate(MESHES, 1):
                with self.subTest(water=water, mesh=name):
                    mesh = self.reference.mesh(name)
                    result = mesh.query(self.reference.position, self.reference.quaternion, sea=sea,
                                        time=self.reference.time)
                    self.assert_same_bits(rows_of(result), self.reference.rows(water, number))
                    self.assertEqual(int(np.count_nonzero(result.status)), 2)

    def test_of_numbers_instead_of_a_sea(self):
        mesh = self.reference.mesh("rock")
        for water in ("rest", "tilted"):
            result = mesh.query(self.reference.position, self.reference.quaternion, **WATERS[water])
            self.assert_same_bits(rows_of(result), self.reference.rows(water, 1))

    def test_of_scenes(self):
        for water in WATERS:
            scene = self.reference.scene(water)
            for body in scene.bodies:
                with self.subTest(water=water, body=body.name):
                    result = scene.query(body.id, self.reference.position, self.reference.quaternion,
                                         linear_velocity=self.reference.linear_velocity,
                                         angular_velocity=self.reference.angular_velocity, time=self.reference.time)
                    self.assert_same_bits(rows_of(result), self.reference.rows(water, body.id))

    def test_of_loads(self):
        for water in WATERS:
            loads = self.reference.scene(water).query(
                "rov", self.reference.position, self.reference.quaternion,
                linear_velocity=self.reference.linear_velocity, angular_velocity=self.reference.angular_velocity,
                time=self.reference.time).loads
            expected = np.fromfile(self.reference.folder / f"{water}.6.loads.f64").reshape(-1, 39)
            self.assert_same_bits(loads.drag_force, expected[:, :3])
            self.assert_same_bits(loads.added_mass.reshape(-1, 36), expected[:, 3:])

    def test_one_by_one_and_on_several_threads(self):
        mesh = self.reference.mesh("knot")
        sea = buoyancy.Sea(**WATERS["waves"])
        expected = self.reference.rows("waves", 3)
        for i in range(0, 1000, 50):
            result = mesh.query(self.reference.position[i], self.reference.quaternion[i], sea=sea,
                                time=self.reference.time[i])
            row = np.concatenate([[result.status], result.force, result.torque, [result.volume],
                                  result.center_of_buoyancy, [result.force_error_bound, result.torque_error_bound]])
            self.assert_same_bits(row, expected[i])
        for threads in (1, 2, 3):
            result = mesh.query(self.reference.position, self.reference.quaternion, sea=sea, time=self.reference.time,
                                threads=threads)
            self.assert_same_bits(rows_of(result), expected)


class TakesArraysOfEveryKind(TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mesh = buoyancy.Mesh(*box())
        random = np.random.default_rng(1)
        cls.position = random.integers(-3, 4, (50, 3)) / 4.0  # exact in every type of float
        cls.quaternion = np.tile([0.5, 0.5, -0.5, 0.5], (50, 1))
        cls.expected = cls.mesh.query(cls.position, cls.quaternion)

    def check(self, position, quaternion):
        self.assert_same_bits(rows_of(self.mesh.query(position, quaternion)), rows_of(self.expected))

    def test_floats_of_other_sizes_and_strides(self):
        for dtype in (np.float64, np.float32, np.float16):
            self.check(self.position.astype(dtype), self.quaternion.astype(dtype))
        self.check(np.asfortranarray(self.position), np.asfortranarray(self.quaternion))
        self.check(self.position[::-1].copy()[::-1], np.repeat(self.quaternion, 2, axis=0)[::2])
        self.check(np.broadcast_to(self.position, (2, 50, 3))[1], self.quaternion)
        unaligned = np.frombuffer(b"x" + self.position.tobytes(), np.uint8)[1:].view(np.float64).reshape(50, 3)
        self.check(unaligned, self.quaternion)
        read_only = self.position.copy()
        read_only.flags.writeable = False
        self.check(read_only, self.quaternion)

    def test_integers(self):
        for dtype in (np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint16, np.uint32, np.uint64):
            position = np.abs(np.round(self.position)).astype(dtype)
            expected = self.mesh.query(position.astype(float), self.quaternion)
            self.assert_same_bits(rows_of(self.mesh.query(position, self.quaternion)), rows_of(expected))

    def test_lists_tuples_and_buffers(self):
        self.check(self.position.tolist(), self.quaternion.tolist())
        self.check([tuple(row) for row in self.position], list(self.quaternion))
        self.check(memoryview(array.array("d", self.position.ravel())).cast("B").cast("d", (50, 3)), self.quaternion)
        one = self.mesh.query((0, 0, -0.25), (1, 0, 0, 0))
        self.assertEqual(one.force.shape, (3,))
        self.assertIsInstance(one.volume, float)
        self.assertIs(one.status, buoyancy.Status.OK)
        self.assertEqual(one.volume, 0.75)
        self.assertEqual(self.mesh.query([np.float32(0), np.int16(0), np.float64(-0.25)], (1, 0, 0, 0)).volume, 0.75)

    def test_one_row_for_many(self):
        self.check(self.position, self.quaternion[0])
        many = self.mesh.query(self.position[0], self.quaternion)
        self.assertEqual(many.force.shape, (50, 3))
        times = self.mesh.query(self.position[0], self.quaternion[0], time=np.arange(7.0))
        self.assertEqual(times.force.shape, (7, 3))

    def test_no_poses(self):
        empty = self.mesh.query(np.empty((0, 3)), np.empty((0, 4)))
        self.assertEqual(empty.force.shape, (0, 3))
        self.assertEqual(empty.status.shape, (0,))
        self.assertTrue(empty.ok)
        empty.raise_for_status()
        # One row is repeated for no pose; a sanitizer sees what is written for one.
        for position, quaternion in ((np.empty((0, 3)), (1, 0, 0, 0)), ((0, 0, 0), np.empty((0, 4)))):
            self.assertEqual(self.mesh.query(position, quaternion).force.shape, (0, 3))
            self.assertEqual(self.mesh.hydrostatics(position, quaternion).stiffness.shape, (0, 6, 6))
        self.assertEqual(self.mesh.hydrostatics(np.empty((0, 3)), np.empty((0, 4))).stiffness.shape, (0, 6, 6))

    @unittest.skipIf(SANITIZED, "the sanitizer's allocator keeps memory")
    def test_float64_in_c_order_is_not_copied(self):
        done = subprocess.run([sys.executable, "-c", WITHOUT_COPY], cwd=Path(__file__).parent, capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLess(int(done.stdout), 20_000)  # KiB; a copy of the positions alone is 48,000


class ReusesResults(TestCase):
    def setUp(self):
        self.mesh = buoyancy.Mesh(*box())
        self.position = np.zeros((10, 3))
        self.quaternion = np.tile([1.0, 0, 0, 0], (10, 1))

    def test_out_is_filled_in_place(self):
        result = self.mesh.query(self.position, self.quaternion)
        force, status = result.force, result.status
        self.position[:, 2] = np.linspace(-1, 1, 10)
        self.quaternion[3] = 2
        again = self.mesh.query(self.position, self.quaternion, out=result)
        self.assertIs(again, result)
        fresh = self.mesh.query(self.position, self.quaternion)
        self.assert_same_bits(force, fresh.force)
        self.assert_same_bits(status, fresh.status)
        self.assertEqual(force[3].tolist(), [0, 0, 0])

    def test_arrays_outlive_their_result(self):
        force = self.mesh.query(self.position, self.quaternion).force
        expected = force.copy()
        for _ in range(100):
            self.mesh.query(self.position + 0.1, self.quaternion)
        self.assert_same_bits(force, expected)

    def test_out_of_another_shape_is_refused(self):
        result = self.mesh.query(self.position, self.quaternion)
        for position, quaternion in ((self.position[:9], self.quaternion[:9]), (self.position[0], self.quaternion[0])):
            with self.assertRaisesRegex(ValueError, "out is a result for"):
                self.mesh.query(position, quaternion, out=result)
        with self.assertRaisesRegex(TypeError, "expected a Wrenches"):
            self.mesh.query(self.position, self.quaternion, out=np.zeros((10, 3)))

    def test_loads_follow_the_body(self):
        scene = buoyancy.Scene.from_text(
            '[[body]]\nid = 1\nshape = { type = "box" }\noutputs = ["wrench", "loads"]\n'
            '[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\n'
            '[[body]]\nid = 2\nshape = { type = "box" }\n')
        result = scene.query(1, self.position, self.quaternion, linear_velocity=(1, 0, 0))
        drag = result.loads.drag_force
        self.assertEqual(drag[0].tolist(), [-0.5, 0, 0])
        self.quaternion[5] = 0
        scene.query(1, self.position, self.quaternion, linear_velocity=(1, 0, 0), out=result)
        self.assertEqual(drag[5].tolist(), [0, 0, 0])
        scene.query(2, self.position, self.quaternion, out=result)
        self.assertIsNone(result.loads)
        self.quaternion[4] = 0
        scene.query(1, self.position, self.quaternion, linear_velocity=(2, 0, 0), out=result)
        self.assertEqual(drag[0].tolist(), [-1.0, 0, 0])
        self.assertEqual(drag[4].tolist(), [0, 0, 0])
        one = scene.query(1, (0, 0, 0), (1, 0, 0, 0), linear_velocity=(1, 0, 0)).loads
        self.assertEqual(one.drag_force.tolist(), [-0.5, 0, 0])
        self.assertEqual((one.immersion, one.added_mass.shape), (0.5, (6, 6)))


class PlacesMeshes(TestCase):
    def setUp(self):
        self.vertices, self.faces = box(1.0)
        self.vertices = self.vertices * (4, 1, 2) + (1, 2, 3)

    def wrench(self, mesh):
        result = mesh.query((0, 0, -2), (0.8, 0.6, 0, 0))
        return [*result.force, *result.torque, result.volume]

    def test_by_factors_and_mirrors(self):
        for scale in (2.0, 1, (1, 1, 1.5), (-1, 1, 1), (-1, -2, -1), np.array([1, -1, -1])):
            placed = buoyancy.Mesh(self.vertices, self.faces, scale=scale)
            factors = np.broadcast_to(scale, 3)
            faces = self.faces[:, [0, 2, 1]] if np.prod(factors) < 0 else self.faces
            drawn = buoyancy.Mesh(self.vertices * factors, faces)
            self.assertFalse(placed.flipped)
            self.assertEqual(self.wrench(placed), self.wrench(drawn))

    def test_with_an_axis_up(self):
        x, y, z = self.vertices.T
        for up, turned in (("y", (x, -z, y)), ("-y", (x, z, -y)), ("-z", (x, -y, -z)), ("x", (-z, y, x)),
                           ("-x", (z, y, -x)), ("z", (x, y, z)), (None, (x, y, z))):
            placed = buoyancy.Mesh(self.vertices, self.faces, up=up)
            drawn = buoyancy.Mesh(np.stack(turned, axis=1), self.faces)
            self.assertEqual(self.wrench(placed), self.wrench(drawn))
        placed = buoyancy.Mesh(self.vertices, self.faces, up="y", scale=(1, -2, 1))
        drawn = buoyancy.Mesh(np.stack((x, z, 2 * y), axis=1), self.faces[:, [0, 2, 1]])
        self.assertEqual(self.wrench(placed), self.wrench(drawn))


class RepairsMeshesAsAsked(TestCase):
    def setUp(self):
        self.vertices, self.faces = box(2.0)

    def without(self, axis, value):
        in_plane = self.vertices[self.faces][:, :, axis] == value
        return self.faces[~in_plane.all(axis=1)]

    def test_holes_are_closed_up_to_a_share_of_the_volume(self):
        open_top = self.without(2, 1.0)
        mesh = buoyancy.Mesh(self.vertices, open_top, close_holes=0.4)
        self.assertAlmostEqual(mesh.volume, 8.0, places=12)
        self.assertIn("1 hole closed", mesh.report)
        with self.assertRaises(buoyancy.InputError) as refused:
            buoyancy.Mesh(self.vertices, open_top, close_holes=0.3)
        self.assertIn("37.6 %", refused.exception.report)

    def test_half_a_body_is_mirrored(self):
        vertices = self.vertices + [1.0, 0.0, 0.0]
        mesh = buoyancy.Mesh(vertices, self.without(0, -1.0), mirror="x")
        self.assertAlmostEqual(mesh.volume, 16.0, places=12)

    def test_rims_that_face_up_are_raised(self):
        mesh = buoyancy.Mesh(self.vertices, self.without(2, 1.0), freeboard=0.5)
        self.assertAlmostEqual(mesh.volume, 10.0, places=12)
        turned = buoyancy.Mesh(self.vertices, self.without(1, 1.0), freeboard=0.5, up="y")
        self.assertAlmostEqual(turned.volume, 10.0, places=12)

    def test_without_repair_a_doubled_box_counts_twice(self):
        doubled = np.concatenate((self.faces, self.faces))
        self.assertAlmostEqual(buoyancy.Mesh(self.vertices, doubled).volume, 8.0)
        self.assertAlmostEqual(buoyancy.Mesh(self.vertices, doubled, repair="none").volume, 16.0)


class ReportsMeshes(TestCase):
    def test_attributes(self):
        mesh = buoyancy.Mesh(*box(2.0), scale=0.5)
        self.assertEqual((mesh.volume, mesh.area, mesh.triangles, mesh.vertices), (1.0, 6.0, 12, 8))
        self.assertTrue(mesh.closed)
        self.assertEqual(mesh.center_of_mass.tolist(), [0, 0, 0])
        np.testing.assert_allclose(mesh.inertia, np.eye(3) / 6)
        self.assertEqual(mesh.bounding_box[0].tolist(), [-0.5] * 3)
        self.assertIn("closed", mesh.report)
        self.assertIn("12 triangles", repr(mesh))
        self.assertIsNone(mesh.intersecting_pairs)
        self.assertEqual(buoyancy.Mesh(*box(), count_intersections=True).intersecting_pairs, 0)

    def test_open_meshes(self):
        vertices, faces = box()
        lid = np.flatnonzero((vertices[faces][:, :, 2] == 0.5).all(axis=1))
        faces = np.delete(faces, lid, axis=0)
        with self.assertRaisesRegex(buoyancy.InputError, "boundary edges"):
            buoyancy.Mesh(vertices, faces)
        mesh = buoyancy.Mesh(vertices, faces, open="dry_boundary")
        self.assertFalse(mesh.closed)
        result = mesh.query([[0, 0, 0], [0, 0, -1]], (1, 0, 0, 0))
        self.assertEqual(result.status.tolist(), [buoyancy.Status.OK, buoyancy.Status.OPEN_EDGE_WET])
        self.assertEqual(result.volume[0], 0.5)

    def test_hydrostatics_of_a_box(self):
        mesh = buoyancy.Mesh(*box())
        for shape in ((3,), (4, 3)):
            hydrostatics = mesh.hydrostatics(np.zeros(shape), (1, 0, 0, 0), density=1000, gravity=10,
                                             center_of_mass=(0, 0, -0.25))
            stiffness = np.asarray(hydrostatics.stiffness)
            self.assertEqual(stiffness.shape, shape[:-1] + (6, 6))
            np.testing.assert_allclose(stiffness[..., 2, 2], 1e4)
            np.testing.assert_allclose(hydrostatics.waterplane_area, 1.0)
            np.testing.assert_allclose(hydrostatics.metacentric_radii, np.full(shape[:-1] + (2,), 1 / 6))
            # GM = KB + BM - KG, from the bottom.
            np.testing.assert_allclose(hydrostatics.metacentric_heights, np.full(shape[:-1] + (2,), 0.25 + 1 / 6 - 0.25))
            self.assertEqual(np.count_nonzero(hydrostatics.status), 0)


if __name__ == "__main__":
    unittest.main()
