"""Types of the module; its docstrings describe it (help(buoyancy)).

ArrayLike is what has numbers: an array of floats or integers, a list or tuple of them, or an object with the buffer
protocol. (K,) and so on are shapes. Attributes that are Final are properties without a setter.
"""
import enum
from os import PathLike
from typing import Any, Final, Literal, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int32]
LongArray = npt.NDArray[np.int64]
ArrayLike = npt.ArrayLike
Path = Union[str, "PathLike[str]"]
Method = Literal["hierarchical", "exact", "exact_surface", "fast", "fast_surface", "improved"]

class Error(Exception): ...
class InputError(Error, ValueError):
    report: Optional[str]  # of a mesh that is refused
class ServiceError(Error, RuntimeError): ...
class StatusError(Error, ValueError): ...

class Status(enum.IntEnum):
    OK = 0
    UNKNOWN_BODY = 1
    NON_FINITE_POSE = 2
    BAD_QUATERNION = 3
    NON_FINITE_TWIST = 4
    BAD_LEAD_TIME = 5
    OPEN_EDGE_WET = 6
    OUT_OF_RANGE = 7
    NO_SEA = 8
    BAD_CONDITION = 9
    NOT_CERTIFIED = 10

class Wrenches:
    force: Final[Array]  # (K, 3) or (3,), N
    torque: Final[Array]  # (K, 3) or (3,), N m
    volume: Final[Union[Array, float]]  # (K,), m^3
    center_of_buoyancy: Final[Array]  # (K, 3) or (3,), m, relative to the position
    force_error_bound: Final[Union[Array, float]]  # (K,), N
    torque_error_bound: Final[Union[Array, float]]  # (K,), N m
    status: Final[Union[IntArray, Status]]  # (K,)
    ok: Final[bool]
    loads: Final[Optional[Loads]]
    body_ids: Final[Optional[IntArray]]
    utime: Final[Optional[int]]
    def raise_for_status(self) -> None: ...
    def __len__(self) -> int: ...

class Loads:
    immersion: Final[Union[Array, float]]  # (K,)
    buoyancy_force: Final[Array]  # (K, 3), N
    buoyancy_torque: Final[Array]  # (K, 3), N m
    drag_force: Final[Array]  # (K, 3), N
    drag_torque: Final[Array]  # (K, 3), N m
    added_mass_force: Final[Array]  # (K, 3), N
    added_mass_torque: Final[Array]  # (K, 3), N m
    added_mass: Final[Array]  # (K, 6, 6), kg, kg m, kg m^2
    damping: Final[Array]  # (K, 6, 6), N, N m per m/s, rad/s
    water_velocity: Final[Array]  # (K, 3), m/s

class Hydrostatics:
    status: Final[Union[IntArray, Status]]  # (K,)
    volume: Final[Union[Array, float]]  # (K,), m^3
    center_of_buoyancy: Final[Array]  # (K, 3), m
    wetted_area: Final[Union[Array, float]]  # (K,), m^2
    waterplane_area: Final[Union[Array, float]]  # (K,), m^2
    waterplane_centroid: Final[Array]  # (K, 3), m
    waterplane_second_moments: Final[Array]  # (K, 2), m^4
    waterplane_axes: Final[Array]  # (K, 2, 3)
    metacentric_radii: Final[Array]  # (K, 2), m
    metacenters: Final[Array]  # (K, 2, 3), m
    metacentric_heights: Final[Array]  # (K, 2), m
    stiffness: Final[Array]  # (K, 6, 6), N, N m per m, rad
    def __len__(self) -> int: ...

class Sea:
    def __init__(
        self,
        path: Optional[Path] = None,
        *,
        level: float = 0.0,
        density: float = 1025.0,
        gravity: float = 9.80665,
        up: ArrayLike = (0, 0, 1),
        depth: float = ...,
        wave_pressure: Literal["wheeler", "hydrostatic"] = "wheeler",
        time_origin: int = 0,
        ramp: float = 0.0,
        waves: Union[Mapping[str, Any], Sequence[Mapping[str, Any]]] = ...,
        current: Mapping[str, Any] = ...,
        layer: Sequence[Mapping[str, Any]] = ...,
    ) -> None: ...
    @staticmethod
    def from_grid(
        elevation: ArrayLike,  # (rows, columns), m
        origin: ArrayLike,
        spacing: ArrayLike,
        level: float = 0.0,
        periodic: bool = False,
        up: ArrayLike = (0, 0, 1),
        gravity: float = 9.80665,
        density: float = 1025.0,
    ) -> Sea: ...
    def elevation(self, x: ArrayLike, y: ArrayLike, t: ArrayLike, *, threads: int = 0) -> Union[Array, float]: ...
    def velocity(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, t: ArrayLike, *, threads: int = 0
    ) -> Array: ...  # (..., 3), m/s
    def acceleration(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, t: ArrayLike, *, threads: int = 0
    ) -> Array: ...  # (..., 3), m/s^2
    def pressure(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, t: ArrayLike, *, threads: int = 0
    ) -> Union[Array, float]: ...  # Pa
    level: Final[float]
    density: Final[float]
    gravity: Final[float]
    up: Final[Array]
    current: Final[Array]  # m/s, at the level
    axes: Final[Tuple[Array, Array]]
    has_waves: Final[bool]

class Mesh:
    def __init__(
        self,
        source: Union[Path, ArrayLike],
        faces: Optional[ArrayLike] = None,
        *,
        scale: ArrayLike = 1.0,  # a number, or factors of x, y and z
        open: Literal["refuse", "dry_boundary"] = "refuse",
        count_intersections: bool = False,
        up: Optional[Literal["x", "y", "z", "-x", "-y", "-z"]] = None,
        repair: Literal["automatic", "none"] = "automatic",
        close_holes: Optional[float] = None,  # above 0: a share of the volume
        mirror: Optional[Literal["x", "y", "z"]] = None,
        freeboard: Optional[float] = None,  # above 0: m
    ) -> None: ...
    def query(
        self,
        position: ArrayLike,
        quaternion: ArrayLike,
        *,
        level: float = 0.0,
        density: float = 1025.0,
        gravity: float = 9.80665,
        up: ArrayLike = (0, 0, 1),
        method: Method = "hierarchical",
        tolerance: float = 0.0,
        sea: Optional[Sea] = None,
        time: ArrayLike = 0.0,
        threads: int = 0,
        out: Optional[Wrenches] = None,
    ) -> Wrenches: ...
    def hydrostatics(
        self,
        position: ArrayLike,
        quaternion: ArrayLike,
        *,
        level: float = 0.0,
        density: float = 1025.0,
        gravity: float = 9.80665,
        up: ArrayLike = (0, 0, 1),
        center_of_mass: Optional[ArrayLike] = None,
        threads: int = 0,
    ) -> Hydrostatics: ...
    name: Final[str]
    format: Final[str]
    report: Final[str]
    volume: Final[float]  # m^3
    area: Final[float]  # m^2
    triangles: Final[int]
    vertices: Final[int]
    components: Final[int]
    closed: Final[bool]
    flipped: Final[bool]
    boundary_edges: Final[int]
    non_manifold_edges: Final[int]
    misoriented_edges: Final[int]
    degenerate_faces: Final[int]
    dropped_faces: Final[int]
    duplicate_faces: Final[int]
    intersecting_pairs: Final[Optional[int]]
    bounding_box: Final[Tuple[Array, Array]]  # m
    center_of_mass: Final[Array]  # (3,), m
    inertia: Final[Array]  # (3, 3), m^5: times the density kg m^2

class Body:
    id: Final[int]
    name: Final[str]
    method: Final[str]
    tolerance: Final[float]
    volume: Final[float]  # m^3
    triangles: Final[int]
    report: Final[str]
    reference_point: Final[Array]  # (3,), m
    center_of_mass: Final[Optional[Array]]  # (3,), m
    outputs: Final[Tuple[str, ...]]
    position: Final[Array]  # (3,), m
    quaternion: Final[Array]  # (4,)

class Scene:
    def __init__(self, path: Path) -> None: ...
    @staticmethod
    def from_text(text: str, directory: Optional[Path] = None) -> Scene: ...
    def query(
        self,
        body_id: Union[int, str],
        position: ArrayLike,
        quaternion: ArrayLike,
        *,
        linear_velocity: Optional[ArrayLike] = None,
        angular_velocity: Optional[ArrayLike] = None,
        time: ArrayLike = 0.0,
        threads: int = 0,
        out: Optional[Wrenches] = None,
        sea: Optional[Sea] = None,
    ) -> Wrenches: ...
    def hydrostatics(
        self, body_id: Union[int, str], position: ArrayLike, quaternion: ArrayLike, *, threads: int = 0
    ) -> Hydrostatics: ...
    bodies: Final[Tuple[Body, ...]]
    name: Final[str]
    has_waves: Final[bool]
    level: Final[float]
    density: Final[float]
    gravity: Final[float]
    up: Final[Array]

class Client:
    def __init__(
        self,
        lcm_url: Optional[str] = None,
        scene: Union[Scene, Path, None] = None,
        *,
        timeout: float = 0.1,
        max_retries: int = 50,
        interval: Optional[float] = None,
        loads: bool = False,
        states_channel: str = "BUOYANCY_STATES",
        wrenches_channel: str = "BUOYANCY_WRENCHES",
        loads_channel: str = "BUOYANCY_LOADS",
        status_channel: str = "BUOYANCY_STATUS",
        water_points_channel: str = "BUOYANCY_WATER_POINTS",
        water_samples_channel: str = "BUOYANCY_WATER_SAMPLES",
    ) -> None: ...
    def request(
        self,
        body_ids: Union[int, str, Sequence[Union[int, str]], npt.NDArray[np.integer[Any]], None],
        position: ArrayLike,
        quaternion: ArrayLike,
        *,
        linear_velocity: Optional[ArrayLike] = None,
        angular_velocity: Optional[ArrayLike] = None,
        time: Optional[float] = 0.0,
        utime: Optional[int] = None,
        lead_time: float = 0.0,
        out: Optional[Wrenches] = None,
    ) -> Wrenches: ...
    def sample_water(
        self, points: ArrayLike, *, time: Optional[float] = 0.0, utime: Optional[int] = None
    ) -> Mapping[str, Union[Array, Status, int]]: ...
    def reserve(self, bodies: int) -> Optional[str]: ...
    def status(self, timeout: float = 2.0) -> Mapping[str, Union[int, float, str]]: ...
    def close(self) -> None: ...
    closed: Final[bool]
    statistics: Final[Mapping[str, Union[int, float]]]
    def __enter__(self) -> Client: ...
    def __exit__(self, *args: object) -> None: ...

class RecordedStates:
    timestamp: Final[LongArray]  # (N,), us
    utime: Final[LongArray]
    session_id: Final[LongArray]
    seq: Final[LongArray]
    body_id: Final[IntArray]
    lead_time: Final[Array]  # (N,), s
    position: Final[Array]  # (N, 3), m
    quaternion: Final[Array]  # (N, 4)
    linear_velocity: Final[Array]  # (N, 3), m/s
    angular_velocity: Final[Array]  # (N, 3), rad/s
    def __len__(self) -> int: ...

class RecordedWrenches:
    timestamp: Final[LongArray]  # (N,), us
    utime: Final[LongArray]
    session_id: Final[LongArray]
    seq: Final[LongArray]
    body_id: Final[IntArray]
    status: Final[IntArray]  # (N,)
    force: Final[Array]  # (N, 3), N
    torque: Final[Array]  # (N, 3), N m
    volume: Final[Array]  # (N,), m^3
    center_of_buoyancy: Final[Array]  # (N, 3), m
    force_error_bound: Final[Array]  # (N,), N
    torque_error_bound: Final[Array]  # (N,), N m
    def __len__(self) -> int: ...

class Log:
    states: Final[RecordedStates]
    wrenches: Final[RecordedWrenches]
    corrupt_sections: Final[Tuple[str, ...]]
    missing_requests: Final[Mapping[int, Sequence[Tuple[int, int]]]]
    missing_responses: Final[Mapping[int, Sequence[Tuple[int, int]]]]
    rejected: Final[int]

def read_log(
    path: Path, *, states_channel: str = "BUOYANCY_STATES", wrenches_channel: str = "BUOYANCY_WRENCHES"
) -> Log: ...
