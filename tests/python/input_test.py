"""Bad input raises an exception that says what is wrong, and never ends the process."""
import copy
import functools
import pickle
import tempfile
import unittest
from pathlib import Path

import numpy as np

import buoyancy
from support import SOURCE, TestCase, box


class RefusesBadInput(TestCase):
    @classmethod
    def setUpClass(cls):
        cls.vertices, cls.faces = box()
        cls.mesh = buoyancy.Mesh(cls.vertices, cls.faces)
        cls.scene = buoyancy.Scene.from_text('[[body]]\nid = 4\nname = "buoy"\nshape = { type = "box" }\n')
        cls.position, cls.quaternion = np.zeros((5, 3)), np.tile([1.0, 0, 0, 0], (5, 1))

    def refused(self, error, reason, function, *arguments, **keywords):
        with self.subTest(reason=reason), self.assertRaisesRegex(error, reason):
            function(*arguments, **keywords)

    def test_shapes(self):
        query, p, q = self.mesh.query, self.position, self.quaternion
        self.refused(ValueError, r"position has shape \(5, 4\); expected \(3,\)", query, q, q)
        self.refused(ValueError, r"quaternion has shape \(5, 3\)", query, p, p)
        self.refused(ValueError, r"position has shape \(\)", query, 1.0, q)
        self.refused(ValueError, r"position has shape \(1, 5, 3\)", query, p[None], q)
        self.refused(ValueError, "quaternion is for 4 poses, but position for 5", query, p, q[:4])
        self.refused(ValueError, "quaternion is for 1 poses", query, p, q[:1])
        self.refused(ValueError, "rows of different lengths", query, [[0, 0, 0], [0, 0]], q[:2])
        self.refused(ValueError, r"position has shape \(0,\)", query, [], q)
        self.refused(ValueError, "time is for 3 poses", query, p, q, time=np.zeros(3))
        self.refused(ValueError, "linear_velocity has shape", self.scene.query, 4, p, q, linear_velocity=np.zeros((5, 2)))
        self.refused(ValueError, "dimensions", query, np.zeros([1] * 9), q)
        itself = []
        itself.append(itself)
        self.refused(ValueError, "sequences within sequences", query, itself, q)

    def test_types(self):
        query, p, q = self.mesh.query, self.position, self.quaternion
        for bad in (None, "text", b"bytes", object(), {}, p.astype(complex), p.astype(bool), p.astype(object),
                    p.astype(str), p.astype(">f8"), p.astype("M8[s]"), np.zeros(5, "f8,f8,f8"), [[True, 0, 0]] * 5,
                    [["0", 0, 0]] * 5, [[None, 0, 0]] * 5, p.astype(np.longdouble), [[1j, 0, 0]] * 5, {1, 2, 3}):
            self.refused(TypeError, "position is .*; expected numbers", query, bad, q)
        self.refused(TypeError, "unexpected keyword argument 'levle'", query, p, q, levle=1)
        self.refused(TypeError, "missing the argument 'quaternion'", query, p)
        self.refused(TypeError, "at most 2 positional", query, p, q, 0.0)
        self.refused(TypeError, "multiple values for argument 'position'", query, p, q, position=p)
        self.refused(TypeError, "level is", query, p, q, level="0")
        self.refused(TypeError, "density is", query, p, q, density=True)
        self.refused(TypeError, "gravity is", query, p, q, gravity=None)
        self.refused(TypeError, "method is", query, p, q, method=3)
        self.refused(TypeError, "expected a Sea", query, p, q, sea=3)
        self.refused(OverflowError, "too large", query, [[10**400, 0, 0]] * 5, q)

    def test_numbers(self):
        query, p, q = self.mesh.query, self.position, self.quaternion
        self.refused(buoyancy.InputError, "up = 0, 0, 0", query, p, q, up=(0, 0, 0))
        self.refused(ValueError, "up has shape", query, p, q, up=(0, 1))
        self.refused(ValueError, 'method = "exct"; expected one of fast', query, p, q, method="exct")
        self.refused(buoyancy.InputError, "center_of_mass", self.mesh.hydrostatics, p, q, center_of_mass=(0, 0, np.inf))
        sea = buoyancy.Sea(level=2.0, waves=dict(type="regular", height=0.1, period=3))
        self.refused(ValueError, "level = 1 but the sea's is 2", query, p, q, level=1, sea=sea)
        self.refused(ValueError, "up = .* but the sea's is", query, p, q, up=(0, 1, 0), sea=sea)
        self.refused(buoyancy.InputError, "exact", query, p, q, method="exact", sea=sea)
        query(p, q, level=2.0, sea=sea)
        for x in np.linspace(0, 5, 50):  # what a sea states itself is no contradiction
            tilted = buoyancy.Sea(up=(x, 0.7 - 0.3 * x, 1))
            query(p, q, up=tilted.up, sea=tilted)

    def test_limits(self):
        query, p, q = self.mesh.query, self.position, self.quaternion
        tiny, inf = 5e-324, np.inf
        for name, valid, invalid in (("level", (-1e300, 1e300), (np.nan, inf, -inf)),
                                     ("density", (0, 1e300), (-tiny, np.nan, inf)),
                                     ("gravity", (0, 1e300), (-tiny, np.nan, inf)),
                                     ("tolerance", (0, 1), (-tiny, np.nextafter(1, 2), np.nan, inf))):
            for value in valid:
                query(p, q, **{name: value})
            for value in invalid:
                self.refused(buoyancy.InputError, f"{name} = .*; expected", query, p, q, **{name: value})
        longest = 9.2e12
        for seconds in (-longest, longest, [longest] * 5):
            query(p, q, time=seconds)
        beyond = np.nextafter(longest, inf)
        for seconds in (-beyond, beyond, inf, np.nan, [beyond] * 5):
            self.refused(ValueError, "time is .*; expected finite seconds", query, p, q, time=seconds)

    def test_limits_of_threads(self):
        p, q = self.position, self.quaternion
        sea = buoyancy.Sea(waves=dict(type="regular", height=0.1, period=3))
        calls = [functools.partial(call, p, q) for call in (self.mesh.query, self.mesh.hydrostatics)]
        calls += [functools.partial(call, 4, p, q) for call in (self.scene.query, self.scene.hydrostatics)]
        calls += [functools.partial(sea.elevation, 0, 0, 0)]
        calls += [functools.partial(call, 0, 0, 0, 0) for call in (sea.velocity, sea.acceleration, sea.pressure)]
        for call in calls:
            for threads in (0, 1, 1024):
                call(threads=threads)
            for threads in (-1, 1025, 2**70, 1.5, True, "1"):
                self.refused(ValueError, "threads is .*; expected a whole number from 0 .* to 1024", call, threads=threads)

    def test_poses_that_are_wrong_have_a_status(self):
        position, quaternion = self.position.copy(), self.quaternion.copy()
        position[1, 2], quaternion[2], quaternion[3, 1] = np.nan, 0, np.inf
        result = self.mesh.query(position, quaternion)
        self.assertEqual([buoyancy.Status(status).name for status in result.status],
                         ["OK", "NON_FINITE_POSE", "BAD_QUATERNION", "NON_FINITE_POSE", "OK"])
        self.assertFalse(result.ok)
        self.assertEqual(result.force[1:4].tolist(), [[0, 0, 0]] * 3)
        self.refused(buoyancy.StatusError, "pose 1: NON_FINITE_POSE: .*2 more of 5", result.raise_for_status)

    def test_meshes(self):
        v, f = self.vertices, self.faces
        self.refused(buoyancy.InputError, "boundary edges", buoyancy.Mesh, v, f[:-1])
        self.refused(buoyancy.InputError, "vertex index 8; .*count from 1", buoyancy.Mesh, v, f + 1)
        self.refused(buoyancy.InputError, "vertex index -1", buoyancy.Mesh, v, f - 1)
        self.refused(ValueError, r"faces has 18446744073709551615; expected integers below 2\^63", buoyancy.Mesh, v,
                     (f - 1).astype(np.uint64))
        self.refused(buoyancy.InputError, "no face", buoyancy.Mesh, v, np.empty((0, 3), int))
        self.refused(buoyancy.InputError, "not finite|finite", buoyancy.Mesh, np.where(v == 0.5, np.nan, v), f)
        self.refused(TypeError, "faces is an array of float64; expected integers", buoyancy.Mesh, v, f.astype(float))
        self.refused(ValueError, r"faces has shape \(12, 2\)", buoyancy.Mesh, v, f[:, :2])
        self.refused(ValueError, r"vertices has shape \(24,\)", buoyancy.Mesh, v.ravel(), f)
        self.refused(TypeError, "no faces", buoyancy.Mesh, v)
        self.refused(TypeError, "no faces", buoyancy.Mesh, None)
        self.refused(TypeError, "a path and faces", buoyancy.Mesh, "hull.stl", f)
        self.refused(buoyancy.InputError, "no such file", buoyancy.Mesh, "/nowhere/hull.stl")
        self.refused(ValueError, "null byte", buoyancy.Mesh, "hull\0.stl")
        self.refused(buoyancy.InputError, "scale = 0", buoyancy.Mesh, v, f, scale=0)
        self.refused(buoyancy.InputError, r"scale = -1; .* such as scale=\(-1, 1, 1\)", buoyancy.Mesh, v, f, scale=-1)
        self.refused(buoyancy.InputError, "scale = nan", buoyancy.Mesh, v, f, scale=np.nan)
        self.refused(buoyancy.InputError, "scale = 1, 0, 1; expected finite factors", buoyancy.Mesh, v, f,
                     scale=(1, 0, 1), up="y")
        self.refused(buoyancy.InputError, "scale = 1, inf, 1", buoyancy.Mesh, v, f, scale=(1, np.inf, 1))
        self.refused(ValueError, r"scale has shape \(2,\)", buoyancy.Mesh, v, f, scale=(1, 1))
        self.refused(TypeError, "scale is a str", buoyancy.Mesh, v, f, scale="1")
        self.refused(ValueError, 'up = "w"; expected one of x, y, z, -x, -y, -z', buoyancy.Mesh, v, f, up="w")
        self.refused(TypeError, "up is a tuple; expected text", buoyancy.Mesh, v, f, up=(0, 1, 0))
        self.refused(ValueError, 'open = "yes"', buoyancy.Mesh, v, f, open="yes")
        self.refused(ValueError, 'repair = "no"; expected one of "automatic", "none"', buoyancy.Mesh, v, f, repair="no")
        self.refused(ValueError, 'mirror = "w"; expected one of "x", "y", "z"', buoyancy.Mesh, v, f, mirror="w")
        self.refused(TypeError, "", buoyancy.Mesh, v, f, mirror=1)
        self.refused(buoyancy.InputError, "close_holes = 0; expected a finite number above 0", buoyancy.Mesh, v, f,
                     close_holes=0)
        self.refused(buoyancy.InputError, "freeboard = nan", buoyancy.Mesh, v, f, freeboard=np.nan)
        self.refused(buoyancy.InputError, "x from -0.5 to 0.5", buoyancy.Mesh, v, f, mirror="x")
        self.refused(buoyancy.Error, "no such file", buoyancy.Scene, "/nowhere/scene.toml")

    def test_a_refused_mesh_has_a_report(self):
        v, f = self.vertices, self.faces
        with self.assertRaises(buoyancy.InputError) as refused:
            buoyancy.Mesh(v, f[:-1])
        self.assertIn("1: 3 edges", refused.exception.report)
        self.assertIn("boundary edges", str(refused.exception))
        with self.assertRaises(buoyancy.InputError) as unread:
            buoyancy.Mesh("/nowhere/hull.stl")
        self.assertIsNone(unread.exception.report)

    def test_bodies_of_a_scene(self):
        query, p, q = self.scene.query, self.position, self.quaternion
        self.refused(KeyError, r"no body 7; it has 4 \(buoy\)", query, 7, p, q)
        self.refused(KeyError, "no body 'crate'", query, "crate", p, q)
        self.refused(KeyError, "no body 4294967300", query, 2**32 + 4, p, q)
        self.refused(TypeError, "body_id is None", query, None, p, q)
        self.refused(TypeError, "body_id", query, 4.0, p, q)
        sea = buoyancy.Sea(waves=dict(type="regular", height=0.1, period=3))
        self.refused(buoyancy.InputError, 'waves = "received"', query, 4, p, q, sea=sea)
        self.refused(buoyancy.InputError, r"Scene.from_text\(\):2", buoyancy.Scene.from_text, "[[body]]\nidd = 1\n")

    def test_objects_that_were_never_initialised(self):
        for type_ in (buoyancy.Mesh, buoyancy.Scene, buoyancy.Sea, buoyancy.Wrenches, buoyancy.Body, buoyancy.Loads,
                      buoyancy.Hydrostatics):
            empty = type_.__new__(type_)
            for name in dir(empty):
                if name.startswith("_"):
                    continue
                self.refused(TypeError, "never initialised|arguments|missing",
                             lambda name=name, empty=empty: (lambda value: value() if callable(value) else value)(
                                 getattr(empty, name)))
            self.refused(TypeError, "never initialised", repr, empty) if "__repr__" in vars(type_) else None
        for value in (self.mesh, self.scene, self.mesh.query((0, 0, 0), (1, 0, 0, 0))):
            self.refused(TypeError, "pickle", pickle.dumps, value)
            self.refused(TypeError, "pickle", copy.copy, value)
        self.refused(TypeError, "constructor", buoyancy.Wrenches)


class TakesNamesThatAreNotUtf8(TestCase):
    def test_of_files(self):
        with self.assertRaisesRegex(buoyancy.InputError, r"missing\\xff.obj: no such file"):
            buoyancy.Mesh("missing\udcff.obj")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "hull\udcff.obj")
            path.write_bytes((SOURCE / "scenes/meshes/catamaran.obj").read_bytes())
            mesh = buoyancy.Mesh(path)
        self.assertEqual(mesh.name, str(path))
        self.assertIn("hull\udcff.obj", mesh.report)
        self.assertIn("hull\udcff.obj", repr(mesh))


class SurvivesRandomArrays(TestCase):
    def test_exceptions_only(self):
        random = np.random.default_rng(20)
        vertices, faces = box()
        mesh = buoyancy.Mesh(vertices, faces)
        scene = buoyancy.Scene.from_text('[[body]]\nid = 1\nshape = { type = "box" }\n')
        sea = buoyancy.Sea(waves=dict(type="regular", height=0.1, period=3))
        reused = mesh.query(np.zeros((3, 3)), (1, 0, 0, 0))
        dtypes = ["f8", "f4", "f2", ">f8", "i8", "i4", "u1", "u8", "c16", "?", "O", "S3", "U2", "M8[s]", "f8,i4", "g"]
        special = [0.0, 1.0, -1.0, np.nan, np.inf, -np.inf, 1e308, -1e308, 5e-324, 1e-3]

        def any_array():
            kind = random.integers(6)
            shape = tuple(random.integers(0, 5, random.integers(0, 4))) if kind else (random.integers(0, 4), 3)
            values = random.choice(special, shape) if random.integers(2) else random.normal(size=shape)
            with np.errstate(all="ignore"):
                try:
                    value = np.asarray(values).astype(dtypes[random.integers(len(dtypes)) if kind > 2 else 0])
                except (TypeError, ValueError):
                    return values
            if value.ndim and random.integers(3) == 0:
                value = value[::-1] if random.integers(2) else np.asfortranarray(value)
            choice = random.integers(12)
            if choice == 0:
                return value.tolist()
            if choice == 1 and value.dtype != object:
                return value.tobytes()
            if choice == 2:
                return [None, "x", [], [[]], {}, (1, [2]), float("nan"), 10**30, memoryview(b"abc"), value.T][
                    random.integers(10)]
            return value

        def good_or_any(good):
            return good if random.integers(3) else any_array()

        calls = [
            lambda: mesh.query(good_or_any(np.zeros((3, 3))), good_or_any(np.tile([1.0, 0, 0, 0], (3, 1))),
                               out=reused if random.integers(2) else None, time=good_or_any(0.0)),
            lambda: mesh.query(good_or_any((0, 0, 0)), good_or_any((1, 0, 0, 0)), up=good_or_any((0, 0, 1)),
                               level=good_or_any(0.0), density=good_or_any(1.0), sea=None if random.integers(2) else sea),
            lambda: scene.query(good_or_any(1), good_or_any((0, 0, 0)), good_or_any((1, 0, 0, 0)),
                                linear_velocity=any_array(), angular_velocity=any_array(), time=any_array()),
            lambda: mesh.hydrostatics(good_or_any((0, 0, 0)), good_or_any((1, 0, 0, 0)), center_of_mass=any_array()),
            lambda: buoyancy.Mesh(good_or_any(vertices), good_or_any(faces), scale=1.0),
            lambda: sea.elevation(any_array(), good_or_any(0.0), good_or_any(0.0)),
            lambda: sea.velocity(any_array(), any_array(), good_or_any(-1.0), good_or_any(0.0)),
            lambda: buoyancy.Sea(level=any_array(), waves=any_array()),
        ]
        refused = 0
        for _ in range(10_000):
            try:
                calls[random.integers(len(calls))]()
            except (TypeError, ValueError, KeyError, OverflowError):
                refused += 1
        self.assertGreater(refused, 2_500)
        self.assertLess(refused, 10_000)


if __name__ == "__main__":
    unittest.main()
