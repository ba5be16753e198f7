#!/usr/bin/python3
"""Uses the C interface from Python by ctypes alone: compares with the table of write_comparison_table byte for byte, and
calls it with 10,000 random malformed arguments, after which the process is still alive.

    ctypes_interface.py LIBRARY TABLE
    ctypes_interface.py LIBRARY --malformed
"""
import ctypes
import random
import sys
from ctypes import POINTER, Structure, byref, c_char_p, c_double, c_int32, c_int64, c_size_t, c_void_p, sizeof

DOUBLES, INT32S, INT64S = POINTER(c_double), POINTER(c_int32), POINTER(c_int64)


class Sized(Structure):
    """A struct that begins with its size."""

    def __init__(self, **members):
        super().__init__(size=sizeof(self), **members)


class MeshOptions(Sized):
    _fields_ = [("size", c_size_t), ("scale", c_double), ("open", c_int32), ("count_intersecting_pairs", c_int32)]


class Water(Sized):
    _fields_ = [("size", c_size_t), ("level", c_double), ("density", c_double), ("gravity", c_double),
                ("up", c_double * 3), ("sea", c_void_p)]


class Poses(Sized):
    _fields_ = [("size", c_size_t), ("count", c_int64), ("positions", DOUBLES), ("quaternions", DOUBLES),
                ("linear_velocities", DOUBLES), ("angular_velocities", DOUBLES), ("utimes", INT64S),
                ("utime_count", c_int64)]


class Wrenches(Sized):
    _fields_ = [("size", c_size_t), ("statuses", INT32S), ("forces", DOUBLES), ("torques", DOUBLES),
                ("volumes", DOUBLES), ("centers_of_buoyancy", DOUBLES), ("force_error_bounds", DOUBLES),
                ("torque_error_bounds", DOUBLES)]


def load(path):
    library = ctypes.CDLL(path)
    library.buoyancy_last_error.restype = c_char_p
    library.buoyancy_version.restype = c_char_p
    library.buoyancy_error_name.restype = c_char_p
    signatures = {
        "mesh_load": [c_char_p, POINTER(MeshOptions), POINTER(c_void_p)],
        "mesh_create": [DOUBLES, c_int64, INT32S, c_int64, POINTER(MeshOptions), POINTER(c_void_p)],
        "mesh_create_64": [DOUBLES, c_int64, INT64S, c_int64, POINTER(MeshOptions), POINTER(c_void_p)],
        "mesh_free": [c_void_p],
        "mesh_query": [c_void_p, POINTER(Water), c_int32, c_double, POINTER(Poses), POINTER(Wrenches), c_int32],
        "sea_from_toml": [c_char_p, c_char_p, POINTER(c_void_p)],
        "sea_free": [c_void_p],
        "sea_elevations": [c_void_p, c_int64, DOUBLES, DOUBLES, INT64S, c_int64, DOUBLES, c_int32],
        "scene_from_toml": [c_char_p, c_char_p, POINTER(c_void_p)],
        "scene_free": [c_void_p],
        "scene_query": [c_void_p, c_int32, POINTER(Poses), POINTER(Wrenches), c_void_p, c_int32],
    }
    for name, arguments in signatures.items():
        function = getattr(library, f"buoyancy_{name}")
        function.argtypes, function.restype = arguments, c_int32
    return library


def check(library, error):
    if error != 0:
        sys.exit(f"{library.buoyancy_error_name(error).decode()}: {library.buoyancy_last_error().decode()}")


class Table:
    def __init__(self, path):
        with open(path, "rb") as file:
            self.bytes = file.read()
        self.offset = 0

    def next_bytes(self, count):
        start, self.offset = self.offset, self.offset + (count + 7) // 8 * 8
        return self.bytes[start:start + count]

    def next(self, kind, count):
        return (kind * count).from_buffer_copy(self.next_bytes(sizeof(kind) * count))


def compare(library, table):
    vertex_count, face_count, n, utime_count, method, body_id, text_bytes, path_bytes = table.next(c_int64, 8)
    tolerance, level, density, gravity, *up = table.next(c_double, 7)
    text, path = table.next_bytes(text_bytes), table.next_bytes(path_bytes)
    vertices, faces = table.next(c_double, 3 * vertex_count), table.next(c_int64, 3 * face_count)
    poses = Poses(count=n, positions=table.next(c_double, 3 * n), quaternions=table.next(c_double, 4 * n),
                  linear_velocities=table.next(c_double, 3 * n), angular_velocities=table.next(c_double, 3 * n),
                  utimes=table.next(c_int64, utime_count), utime_count=utime_count)
    arrays = {"statuses": (c_int32 * n)()}
    for name, numbers in [("forces", 3), ("torques", 3), ("volumes", 1), ("centers_of_buoyancy", 3),
                          ("force_error_bounds", 1), ("torque_error_bounds", 1)]:
        arrays[name] = (c_double * (numbers * n))()
    wrenches = Wrenches(**arrays)
    mesh, sea, scene = c_void_p(), c_void_p(), c_void_p()
    if body_id >= 0:
        check(library, library.buoyancy_scene_from_toml(text, None, byref(scene)))
        check(library, library.buoyancy_scene_query(scene, body_id, byref(poses), byref(wrenches), None, 0))
        check(library, library.buoyancy_scene_free(scene))
    else:
        if path:
            check(library, library.buoyancy_mesh_load(path, None, byref(mesh)))
        else:
            check(library, library.buoyancy_mesh_create_64(vertices, vertex_count, faces, face_count, None, byref(mesh)))
        if text:
            check(library, library.buoyancy_sea_from_toml(text, None, byref(sea)))
        water = Water(level=level, density=density, gravity=gravity, up=(c_double * 3)(*up), sea=sea)
        check(library, library.buoyancy_mesh_query(mesh, byref(water), method, tolerance, byref(poses),
                                                   byref(wrenches), 0))
        check(library, library.buoyancy_sea_free(sea))
        check(library, library.buoyancy_mesh_free(mesh))
    for name, array in arrays.items():
        if bytes(array) != table.next_bytes(sizeof(array)):
            sys.exit(f"the {name} differ from those of C++")


def compare_all(library, path):
    table = Table(path)
    cases, = table.next(c_int64, 1)
    for _ in range(cases):
        compare(library, table)
    if cases != 11 or table.offset != len(table.bytes):
        sys.exit("the table is not complete")
    print(f"{cases} cases are equal to those of C++ bit for bit")


CUBE_VERTICES = [float(i >> axis & 1) for i in range(8) for axis in (2, 1, 0)]
CUBE_FACES = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]
ODD_NUMBERS = [float("nan"), float("inf"), -float("inf"), 1e308, -1e308, 5e-324, 0.0, -1.0, 1e9]
ODD_COUNTS = [-1, -2**63, 2**63 - 1, 2**62, 2**61 + 1, 2**41, -12]


class Malformed:
    """Calls with random arguments. Arrays are as long as any count that the library accepts with them."""

    def __init__(self, library):
        self.functions = library
        self.random = random.Random(24)
        self.successes = self.failures = 0

    def judge(self, error):
        self.successes += error == 0
        self.failures += error != 0
        if error != 0 and not (0 < error < 7 and len(self.functions.buoyancy_last_error()) > 20):
            sys.exit(f"code {error}: {self.functions.buoyancy_last_error()}")
        return error == 0

    def odd(self, probability):
        return self.random.random() < probability

    def count(self, meant):
        return self.random.choice(ODD_COUNTS) if self.odd(0.05) else meant

    def doubles(self, numbers):
        if self.odd(0.03):
            return None
        chosen = [self.random.choice(ODD_NUMBERS) if self.odd(0.01) else number for number in numbers]
        return (c_double * len(chosen))(*chosen)

    def handle(self, mesh):
        return self.random.choice([None, 1, 0xdeadbeef, 2**63, mesh]) if self.odd(0.1) else mesh

    def options(self):
        if self.odd(0.6):
            return None
        options = MeshOptions(scale=self.random.choice([1.0, 0.5, 1000.0] + ODD_NUMBERS), open=self.random.randrange(-1, 3),
                              count_intersecting_pairs=self.random.randrange(-1, 3))
        if self.odd(0.1):
            options.size = self.random.randrange(100)
        return byref(options)

    def create(self):
        faces = [self.random.randrange(-2**31, 2**31) if self.odd(0.003) else face for face in CUBE_FACES]
        if self.odd(0.1):
            self.random.shuffle(faces)
        mesh = c_void_p()
        narrow = self.odd(0.5)
        array = None if self.odd(0.03) else ((c_int32 if narrow else c_int64) * 36)(*faces)
        function = self.functions.buoyancy_mesh_create if narrow else self.functions.buoyancy_mesh_create_64
        error = function(self.doubles(CUBE_VERTICES), self.count(self.random.choice([8, 8, 8, 7, 0])), array,
                         self.count(self.random.choice([12, 12, 12, 11, 1, 0])), self.options(),
                         None if self.odd(0.02) else byref(mesh))
        return mesh if self.judge(error) else None

    def query(self, mesh):
        n = self.random.randrange(5)
        poses = Poses(count=self.count(n), positions=self.doubles([0.1, 0.2, -0.3] * n),
                      quaternions=self.doubles([0.6, 0.0, 0.8, 0.0] * n), utime_count=self.count(self.random.choice([0, 1])),
                      utimes=(c_int64 * 5)(*[self.random.randrange(-2**63, 2**63) for _ in range(5)]))
        forces, statuses = (c_double * 15)(), (c_int32 * 5)()
        wrenches = Wrenches(forces=forces, statuses=None if self.odd(0.2) else statuses)
        water = Water(level=0.0, density=1025.0, gravity=9.81, up=(c_double * 3)(0.0, 0.0, 1.0))
        if self.odd(0.2):
            setattr(water, self.random.choice(["level", "density", "gravity"]), self.random.choice(ODD_NUMBERS))
        if self.odd(0.1):
            water.up[2] = self.random.choice(ODD_NUMBERS)
        if self.odd(0.05):
            water.sea = self.handle(mesh.value)
        for struct in (poses, wrenches, water):
            if self.odd(0.03):
                struct.size = self.random.randrange(200)
        self.judge(self.functions.buoyancy_mesh_query(
            self.handle(mesh.value), None if self.odd(0.3) else byref(water), self.random.randrange(-1, 7),
            self.random.choice([0.0, 0.01, 1.0] + ODD_NUMBERS), None if self.odd(0.02) else byref(poses),
            None if self.odd(0.02) else byref(wrenches), self.random.choice([0, 1, 2, -1, 2**31 - 1])))

    def text(self):
        text = bytearray(b"[water]\nlevel = 0.5\nwaves = { type = \"regular\", height = 0.3, period = 3 }\n\0")
        for _ in range(self.random.randrange(4)):
            text[self.random.randrange(len(text) - 1)] = self.random.randrange(256)
        sea, heights = c_void_p(), (c_double * 4)()
        place = (c_double * 4)(*[self.random.choice(ODD_NUMBERS) for _ in range(4)])
        if self.judge(self.functions.buoyancy_sea_from_toml(bytes(text), None, byref(sea))):
            self.judge(self.functions.buoyancy_sea_elevations(sea, self.count(4), place, place, (c_int64 * 1)(2**63 - 1), 1,
                                                            heights, 1))
        self.judge(self.functions.buoyancy_sea_free(self.handle(sea.value)))
        self.functions.buoyancy_sea_free(sea)

    def run(self, calls):
        while self.successes + self.failures < calls:
            mesh = self.create()
            if mesh is not None:
                for _ in range(3):
                    self.query(mesh)
                self.judge(self.functions.buoyancy_mesh_free(mesh))
                self.query(mesh)  # it was freed
                self.judge(self.functions.buoyancy_mesh_free(mesh))
            self.text()
        print(f"{self.successes} calls succeeded, {self.failures} returned an error with its reason")
        if min(self.successes, self.failures) < calls / 5:
            sys.exit("the arguments are not as mixed as they should be")


def main():
    library = load(sys.argv[1])
    if sys.argv[2] == "--malformed":
        Malformed(library).run(10000)
    else:
        compare_all(library, sys.argv[2])


if __name__ == "__main__":
    main()
