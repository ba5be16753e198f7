"""Buoyant forces and torques on triangle meshes, exact to rounding and with an error bound.

    import buoyancy
    hull = buoyancy.Mesh("hull.stl", scale=0.001)
    wrench = hull.query(position=(0, 0, -0.2), quaternion=(1, 0, 0, 0))
    print(wrench.force, wrench.torque, wrench.volume)

Mesh and Scene evaluate one pose or many in this process, in water at rest or in the waves of a Sea. Client sends poses
to buoyancyd over LCM. read_log reads what was recorded.

Units are SI. World frame W, body frame B; position is that of B's origin in W, quaternion (w, x, y, z) rotates B to W.
Arrays are numpy arrays of float64. docs/libraries.md describes the module.
"""
import importlib.util as _util

if _util.find_spec("numpy") is None:
    raise ImportError("buoyancy needs numpy, which cannot be imported; install the package python3-numpy")

__all__ = [
    "Body", "Client", "Error", "Hydrostatics", "InputError", "Loads", "Log", "Mesh", "RecordedStates",
    "RecordedWrenches", "Scene", "Sea", "ServiceError", "Status", "StatusError", "Wrenches", "read_log",
]


def __getattr__(name):
    """Import numpy and the extension module when the first of their names is used.

    Numpy may start threads, and buoyancy.testing has to enter a network of its own before.
    """
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    # Import numpy before any call: two threads would wait for each other if their calls imported it.
    import numpy  # noqa: F401

    from . import _core

    for each in __all__:
        value = getattr(_core, each)
        value.__module__ = __name__  # what users see in help() and in tracebacks is buoyancy.Mesh
        globals()[each] = value
    return globals()[name]


def __dir__():
    return sorted({*globals(), *__all__})
