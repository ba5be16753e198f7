"""Buoyant forces and torques on triangle meshes, exact to rounding and with an error bound.

    import buoyancy
    hull = buoyancy.Mesh("hull.stl", scale=0.001)
    wrench = hull.query(position=(0, 0, -0.2), quaternion=(1, 0, 0, 0))
    print(wrench.force, wrench.torque, wrench.volume)

Mesh and Scene evaluate one pose or many in this process, in water at rest or in the waves of a Sea. Client sends poses
to buoyancyd over LCM. read_log reads what was recorded.

Units are SI. World frame W, body frame B; position is that of B's origin in W, quaternion (w, x, y, z) rotates B to W.
Arrays are numpy arrays of float64, or memoryviews where numpy is not installed. docs/libraries.md describes the module.
"""
from ._core import (
    Body,
    Client,
    Error,
    Hydrostatics,
    InputError,
    Loads,
    Log,
    Mesh,
    RecordedStates,
    RecordedWrenches,
    Scene,
    Sea,
    ServiceError,
    Status,
    StatusError,
    Wrenches,
    read_log,
)

__all__ = [
    "Body",
    "Client",
    "Error",
    "Hydrostatics",
    "InputError",
    "Loads",
    "Log",
    "Mesh",
    "RecordedStates",
    "RecordedWrenches",
    "Scene",
    "Sea",
    "ServiceError",
    "Status",
    "StatusError",
    "Wrenches",
    "read_log",
]

# What users see in help() and in tracebacks is buoyancy.Mesh.
for _name in __all__:
    globals()[_name].__module__ = __name__
del _name
