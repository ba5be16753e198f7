"""A Sea takes the keys of the scene file and gives the motion of its water."""
import tempfile
import unittest

import numpy as np

import buoyancy
from support import SOURCE, TestCase


class DescribesWaterInMotion(TestCase):
    def test_regular_wave(self):
        sea = buoyancy.Sea(waves=dict(type="regular", height=0.5, period=4.0, phase=30))
        omega = 2 * np.pi / 4
        x, t = np.linspace(-20, 20, 41)[:, None], np.linspace(0, 4, 9)
        expected = 0.25 * np.cos(omega**2 / 9.80665 * x - omega * t + np.radians(30))
        np.testing.assert_allclose(sea.elevation(x, 3.0, t), expected, atol=1e-12)
        point = sea.velocity(1.0, 2.0, -1.0, 0.5)
        self.assertEqual(point.shape, (3,))
        h = 1e-3
        later, earlier = (np.asarray(sea.velocity(1.0, 2.0, -1.0, 0.5 + d)) for d in (h, -h))
        np.testing.assert_allclose(sea.acceleration(1.0, 2.0, -1.0, 0.5), (later - earlier) / (2 * h), atol=1e-3)

    def test_waves_ride_on_the_current(self):
        waves = dict(type="regular", height=0.5, period=4.0)
        still = buoyancy.Sea(waves=waves)
        sea = buoyancy.Sea(waves=waves, current=dict(velocity=[1.5, 0.5, 0.0]))
        self.assertEqual(sea.current.tolist(), [1.5, 0.5, 0.0])
        self.assertAlmostEqual(sea.elevation(7.0 + 15.0, 5.0, 10.0), still.elevation(7.0, 0.0, 10.0), delta=1e-12)
        np.testing.assert_allclose(np.asarray(sea.velocity(22.0, 5.0, -1.0, 10.0)) - [1.5, 0.5, 0.0],
                                   still.velocity(7.0, 0.0, -1.0, 10.0), atol=1e-12)
        box = '[[body]]\nid = 1\nshape = { type = "box" }\n'
        scene = buoyancy.Scene.from_text('[water]\nwaves = "received"\n' + box)
        with self.assertRaisesRegex(buoyancy.InputError, "a current of .1.5, 0.5, 0. m/s; expected the scene's"):
            scene.query(1, (0, 0, 0), (1, 0, 0, 0), sea=sea)

    def test_shapes(self):
        sea = buoyancy.Sea(waves=[dict(type="jonswap", significant_wave_height=1, peak_period=5, spreading=10)])
        self.assertIsInstance(sea.elevation(0, 0, 0), float)
        self.assertIsInstance(sea.pressure(0, 0, -1, 0), float)
        self.assertEqual(sea.elevation(np.zeros((2, 1)), np.zeros(3), 0).shape, (2, 3))
        self.assertEqual(sea.velocity(np.zeros((2, 1)), 0, np.zeros(3), np.zeros((4, 1, 1))).shape, (4, 2, 3, 3))
        self.assertEqual(sea.elevation([], 0, 0).shape, (0,))
        one_by_one = [[sea.elevation(x, y, t) for y in (1, 2)] for x, t in ((0, 0.5), (3, 1.5))]
        self.assert_same_bits(sea.elevation([[0.0], [3.0]], [1, 2], [[0.5], [1.5]]), np.array(one_by_one))
        with self.assertRaisesRegex(ValueError, r"y has shape \(2,\), which does not fit \(3,\)"):
            sea.elevation([1, 2, 3], [1, 2], 0)

    def test_water_at_rest(self):
        sea = buoyancy.Sea(level=1.5, density=1000, gravity=10)
        self.assertFalse(sea.has_waves)
        self.assertEqual((sea.level, sea.density, sea.gravity), (1.5, 1000.0, 10.0))
        self.assertEqual(sea.pressure([0, 0], 0, [0.5, 2], 0).tolist(), [1e4, 0.0])
        self.assertEqual(sea.elevation(0, 0, 0), 0.0)

    def test_layers_and_a_current_that_changes_with_the_depth(self):
        profile = [dict(height=0.0, velocity=[1, 0, 0]), dict(height=-4.0, velocity=[0, 0, 0])]
        sea = buoyancy.Sea(density=850, gravity=10, layer=[dict(below=-1.0, density=1000)], current=dict(profile=profile))
        self.assertEqual(sea.pressure(0, 0, [-1, -2], 0).tolist(), [8500.0, 18500.0])
        self.assertEqual(sea.velocity(0, 0, -2, 0).tolist(), [0.5, 0, 0])
        self.assertEqual(sea.current.tolist(), [1, 0, 0])

    def test_keys_are_those_of_the_scene_file(self):
        with self.assertRaisesRegex(buoyancy.InputError, "unknown key 'levle'.*nearest known key is 'level'"):
            buoyancy.Sea(levle=1)
        with self.assertRaisesRegex(buoyancy.InputError, "peak_period = -1; expected a number from"):
            buoyancy.Sea(waves=dict(type="jonswap", peak_period=-1, significant_wave_height=1))
        with self.assertRaisesRegex(buoyancy.InputError, "received"):
            buoyancy.Sea(waves="received")
        with self.assertRaisesRegex(TypeError, "level is None"):
            buoyancy.Sea(level=None)
        for level in (1e300, 123456789012345680000.0, -0.1, 5e-324, 1 / 3):
            self.assertEqual(buoyancy.Sea(level=level).level, level)
        self.assertEqual(buoyancy.Sea(level=np.float32(0.5), up=np.array([0, 2.0, 0])).up.tolist(), [0, 1, 0])
        components = [dict(amplitude=0.5, angular_frequency=0.8), dict(amplitude=np.float64(0.2), angular_frequency=1)]
        self.assertTrue(buoyancy.Sea(waves={"type": "components", "components": components}).has_waves)

    def test_of_a_grid(self):
        x, y = 0.25 * np.arange(60) - 3.0, 0.5 * np.arange(40) - 5.0
        plane = 0.3 + 0.1 * x + 0.02 * y[:, None]
        sea = buoyancy.Sea.from_grid(plane, origin=(-3.0, -5.0), spacing=(0.25, 0.5), level=1.0, density=1000, gravity=10)
        self.assertEqual((sea.level, sea.density, sea.gravity, sea.has_waves), (1.0, 1000.0, 10.0, True))
        self.assertEqual(repr(sea), "<buoyancy.Sea of a grid of 40 x 60 elevations>")
        points = np.linspace(-2.9, 11.7, 30), np.linspace(-4.9, 14.4, 30)
        expected = 0.3 + 0.1 * points[0] + 0.02 * points[1]
        np.testing.assert_allclose(sea.elevation(*points, np.linspace(0, 1e3, 30)), expected, atol=1e-12)
        np.testing.assert_allclose(sea.pressure(*points, 0.5, 0), 1e4 * (0.5 + expected), rtol=1e-9)
        np.testing.assert_array_equal(sea.velocity(*points, 0.5, 0), np.zeros((30, 3)))
        self.assertTrue(np.isnan(sea.elevation(-3.01, 0, 0)))

    def test_load_in_a_grid(self):
        vertices = np.array([[x, y, z] for x in (-.5, .5) for y in (-.5, .5) for z in (-.5, .5)])
        faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                 [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        box = buoyancy.Mesh(vertices, faces)
        calm = buoyancy.Sea.from_grid(np.full((8, 8), 0.25), origin=(-4, -4), spacing=1)
        position = [[0, 0, 0.25], [1, 1, 5], [1, -1, -5], [3.9, 0, 0]]
        result = box.query(position, [[1, 0, 0, 0]] * 4, sea=calm)
        weight = 1025 * 9.80665
        np.testing.assert_allclose(result.force[:3, 2], [0.5 * weight, 0, weight], atol=1e-3 * weight)
        self.assertTrue(np.all(np.abs(result.force[:3, 2] - [0.5 * weight, 0, weight]) <= result.force_error_bound[:3]))
        self.assertEqual([buoyancy.Status(status).name for status in result.status], ["OK"] * 3 + ["OUT_OF_RANGE"])
        # The wave of a component sea with the same pressure.
        waves = buoyancy.Sea(wave_pressure="hydrostatic", waves=dict(type="regular", height=0.3, period=1.6, direction=30))
        axis = 0.05 * np.arange(200) - 5
        samples = buoyancy.Sea.from_grid(waves.elevation(axis, axis[:, None], 0.7), origin=(-5, -5), spacing=0.05)
        one, other = (box.query([0.2, 0.1, 0.1], [0.9, 0.1, 0.2, 0.3743], sea=sea, time=0.7, tolerance=1e-5)
                      for sea in (waves, samples))
        np.testing.assert_allclose(one.force, other.force, atol=3e-5 * weight)
        np.testing.assert_allclose(one.torque, other.torque, atol=3e-5 * weight)

    def test_drag_in_a_grid_at_rest(self):
        scene = buoyancy.Scene.from_text('[water]\nwaves = "received"\n[[body]]\nid = 1\nshape = { type = "box" }\n'
                                         '[body.drag]\nlinear = [40, 40, 40, 1, 1, 1]\n')
        still, grid = (scene.query(1, (0, 0, -5), (1, 0, 0, 0), linear_velocity=(2, 0, 0), angular_velocity=(0, 0, 0), sea=sea)
                       for sea in (buoyancy.Sea(), buoyancy.Sea.from_grid(np.zeros((9, 9)), (-4, -4), 1)))
        np.testing.assert_allclose(grid.force, still.force, rtol=1e-3)
        self.assertLess(grid.force[0], -1.0)

    def test_what_is_no_grid_is_refused(self):
        def sea(elevation=np.zeros((4, 5)), origin=(0, 0), spacing=(1, 1), **keys):
            return buoyancy.Sea.from_grid(elevation, origin, spacing, **keys)
        sea()
        for error, text, keys in (
                (ValueError, r"elevation has shape \(5,\); expected \(rows, columns\)", dict(elevation=np.zeros(5))),
                (ValueError, r"origin has shape \(3,\)", dict(origin=(1, 2, 3))),
                (TypeError, "spacing", dict(spacing="1")),
                (TypeError, "elevation", dict(elevation=np.zeros((4, 4), dtype=complex))),
                (buoyancy.InputError, "3 rows and 5 columns; expected 4 to 4096", dict(elevation=np.zeros((3, 5)))),
                (buoyancy.InputError, r"elevation.0..1. = nan", dict(elevation=np.full((4, 4), [0, np.nan, 0, 0]))),
                (buoyancy.InputError, r"spacing.1. = 0; expected", dict(spacing=(1, 0))),
                (buoyancy.InputError, "density = -1", dict(density=-1)),
                (buoyancy.InputError, "up = 0, 0, 0; expected a direction", dict(up=(0, 0, 0)))):
            with self.assertRaisesRegex(error, text):
                sea(**keys)

    def test_deep_files_are_refused(self):
        for text in ("a" + ".a" * 50_000 + " = 1", "[" + "a." * 50_000 + "a]", "a = " + "[" * 1_000_000):
            with tempfile.NamedTemporaryFile("w", suffix=".toml") as scene:
                scene.write("\n" + text)
                scene.flush()
                with self.assertRaisesRegex(buoyancy.InputError, r"\.toml:2: more than 32 levels of tables"):
                    buoyancy.Sea(scene.name)

    def test_text_is_escaped(self):
        for text in ('"', "\\", "\n", "]]", "\x00", "\x7f", "é", '"\n[world]\ngravity = 0\n#'):
            with self.assertRaises(buoyancy.InputError):
                buoyancy.Sea(wave_pressure=text)
            with self.assertRaises(buoyancy.InputError):
                buoyancy.Sea(**{text: 1})

    def test_of_a_scene_file(self):
        sea = buoyancy.Sea(SOURCE / "scenes" / "hull_in_waves.toml")
        self.assertTrue(sea.has_waves)
        with self.assertRaisesRegex(TypeError, "a scene file and keys"):
            buoyancy.Sea(SOURCE / "scenes" / "hull_in_waves.toml", level=1)


if __name__ == "__main__":
    unittest.main()
