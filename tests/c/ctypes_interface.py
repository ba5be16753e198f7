#!/usr/bin/python3
"""Uses the C interface from Python by ctypes alone: compares with the table of write_comparison_table byte for byte.

    ctypes_interface.py LIBRARY TABLE
"""
import ctypes
import sys
from ctypes import POINTER, Structure, byref, c_char_p, c_double, c_int32, c_int64, c_size_t, c_void_p, sizeof

DOUBLES, INT32S, INT64S = POINTER(c_double), POINTER(c_int32), POINTER(c_int64)


class Sized(Structure):
    """A struct that begins with its size."""

    def __init__(self, **members):
        super().__init__(size=sizeof(self), **members)


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
        "mesh_load": [c_char_p, c_void_p, POINTER(c_void_p)],
        "mesh_create_64": [DOUBLES, c_int64, INT64S, c_int64, c_void_p, POINTER(c_void_p)],
        "mesh_free": [c_void_p],
        "mesh_query": [c_void_p, POINTER(Water), c_int32, c_double, POINTER(Poses), POINTER(Wrenches), c_int32],
        "sea_from_toml": [c_char_p, c_char_p, POINTER(c_void_p)],
        "sea_free": [c_void_p],
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


def main():
    compare_all(load(sys.argv[1]), sys.argv[2])


if __name__ == "__main__":
    main()
