"""Types of the module; its docstrings describe it (help(buoyancy)).

An Array is a numpy.ndarray, or a memoryview where numpy is not installed. ArrayLike is what has numbers: an array of
floats or integers, a list or tuple of them, or an object with the buffer protocol. (K,) and so on are shapes.
"""
import enum
from os import PathLike
from typing import Any, Literal, Mapping, Optional, Sequence, Tuple, Union

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
    @property
    def force(self) -> Array: ...  # (K, 3) or (3,), N
    @property
    def torque(self) -> Array: ...  # (K, 3) or (3,), N m
    @property
    def volume(self) -> Union[Array, float]: ...  # (K,), m^3
    @property
    def center_of_buoyancy(self) -> Array: ...  # (K, 3) or (3,), m, relative to the position
    @property
    def force_error_bound(self) -> Union[Array, float]: ...  # (K,), N
    @property
    def torque_error_bound(self) -> Union[Array, float]: ...  # (K,), N m
    @property
    def status(self) -> Union[IntArray, Status]: ...  # (K,)
    @property
    def ok(self) -> bool: ...
    @property
    def loads(self) -> Optional[Loads]: ...
    @property
    def body_ids(self) -> Optional[IntArray]: ...
    @property
    def utime(self) -> Optional[int]: ...
    def raise_for_status(self) -> None: ...
    def __len__(self) -> int: ...

class Loads:
    @property
    def immersion(self) -> Union[Array, float]: ...  # (K,)
    @property
    def buoyancy_force(self) -> Array: ...  # (K, 3), N
    @property
    def buoyancy_torque(self) -> Array: ...  # (K, 3), N m
    @property
    def drag_force(self) -> Array: ...  # (K, 3), N
    @property
    def drag_torque(self) -> Array: ...  # (K, 3), N m
    @property
    def added_mass_force(self) -> Array: ...  # (K, 3), N
    @property
    def added_mass_torque(self) -> Array: ...  # (K, 3), N m
    @property
    def added_mass(self) -> Array: ...  # (K, 6, 6), kg, kg m, kg m^2
    @property
    def damping(self) -> Array: ...  # (K, 6, 6), N, N m per m/s, rad/s
    @property
    def water_velocity(self) -> Array: ...  # (K, 3), m/s

class Hydrostatics:
    @property
    def status(self) -> Union[IntArray, Status]: ...  # (K,)
    @property
    def volume(self) -> Union[Array, float]: ...  # (K,), m^3
    @property
    def center_of_buoyancy(self) -> Array: ...  # (K, 3), m
    @property
    def wetted_area(self) -> Union[Array, float]: ...  # (K,), m^2
    @property
    def waterplane_area(self) -> Union[Array, float]: ...  # (K,), m^2
    @property
    def waterplane_centroid(self) -> Array: ...  # (K, 3), m
    @property
    def waterplane_second_moments(self) -> Array: ...  # (K, 2), m^4
    @property
    def waterplane_axes(self) -> Array: ...  # (K, 2, 3)
    @property
    def metacentric_radii(self) -> Array: ...  # (K, 2), m
    @property
    def metacenters(self) -> Array: ...  # (K, 2, 3), m
    @property
    def metacentric_heights(self) -> Array: ...  # (K, 2), m
    @property
    def stiffness(self) -> Array: ...  # (K, 6, 6), N, N m per m, rad
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
    ) -> None: ...
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
    @property
    def level(self) -> float: ...
    @property
    def density(self) -> float: ...
    @property
    def gravity(self) -> float: ...
    @property
    def up(self) -> Array: ...
    @property
    def current(self) -> Array: ...  # m/s
    @property
    def axes(self) -> Tuple[Array, Array]: ...
    @property
    def has_waves(self) -> bool: ...

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
    @property
    def name(self) -> str: ...
    @property
    def format(self) -> str: ...
    @property
    def report(self) -> str: ...
    @property
    def volume(self) -> float: ...  # m^3
    @property
    def area(self) -> float: ...  # m^2
    @property
    def triangles(self) -> int: ...
    @property
    def vertices(self) -> int: ...
    @property
    def components(self) -> int: ...
    @property
    def closed(self) -> bool: ...
    @property
    def flipped(self) -> bool: ...
    @property
    def boundary_edges(self) -> int: ...
    @property
    def non_manifold_edges(self) -> int: ...
    @property
    def misoriented_edges(self) -> int: ...
    @property
    def degenerate_faces(self) -> int: ...
    @property
    def dropped_faces(self) -> int: ...
    @property
    def duplicate_faces(self) -> int: ...
    @property
    def intersecting_pairs(self) -> Optional[int]: ...
    @property
    def bounding_box(self) -> Tuple[Array, Array]: ...  # m
    @property
    def center_of_mass(self) -> Array: ...  # (3,), m
    @property
    def inertia(self) -> Array: ...  # (3, 3), m^5: times the density kg m^2

class Body:
    @property
    def id(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def method(self) -> str: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def volume(self) -> float: ...  # m^3
    @property
    def triangles(self) -> int: ...
    @property
    def report(self) -> str: ...
    @property
    def reference_point(self) -> Array: ...  # (3,), m
    @property
    def center_of_mass(self) -> Optional[Array]: ...  # (3,), m
    @property
    def outputs(self) -> Tuple[str, ...]: ...
    @property
    def position(self) -> Array: ...  # (3,), m
    @property
    def quaternion(self) -> Array: ...  # (4,)

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
    @property
    def bodies(self) -> Tuple[Body, ...]: ...
    @property
    def name(self) -> str: ...
    @property
    def has_waves(self) -> bool: ...
    @property
    def level(self) -> float: ...
    @property
    def density(self) -> float: ...
    @property
    def gravity(self) -> float: ...
    @property
    def up(self) -> Array: ...

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
    def reserve(self, bodies: int) -> Optional[str]: ...
    def status(self, timeout: float = 2.0) -> Mapping[str, Union[int, float, str]]: ...
    def close(self) -> None: ...
    @property
    def closed(self) -> bool: ...
    @property
    def statistics(self) -> Mapping[str, Union[int, float]]: ...
    def __enter__(self) -> Client: ...
    def __exit__(self, *args: object) -> None: ...

class RecordedStates:
    @property
    def timestamp(self) -> LongArray: ...  # (N,), us
    @property
    def utime(self) -> LongArray: ...
    @property
    def session_id(self) -> LongArray: ...
    @property
    def seq(self) -> LongArray: ...
    @property
    def body_id(self) -> IntArray: ...
    @property
    def lead_time(self) -> Array: ...  # (N,), s
    @property
    def position(self) -> Array: ...  # (N, 3), m
    @property
    def quaternion(self) -> Array: ...  # (N, 4)
    @property
    def linear_velocity(self) -> Array: ...  # (N, 3), m/s
    @property
    def angular_velocity(self) -> Array: ...  # (N, 3), rad/s
    def __len__(self) -> int: ...

class RecordedWrenches:
    @property
    def timestamp(self) -> LongArray: ...  # (N,), us
    @property
    def utime(self) -> LongArray: ...
    @property
    def session_id(self) -> LongArray: ...
    @property
    def seq(self) -> LongArray: ...
    @property
    def body_id(self) -> IntArray: ...
    @property
    def status(self) -> IntArray: ...  # (N,)
    @property
    def force(self) -> Array: ...  # (N, 3), N
    @property
    def torque(self) -> Array: ...  # (N, 3), N m
    @property
    def volume(self) -> Array: ...  # (N,), m^3
    @property
    def center_of_buoyancy(self) -> Array: ...  # (N, 3), m
    @property
    def force_error_bound(self) -> Array: ...  # (N,), N
    @property
    def torque_error_bound(self) -> Array: ...  # (N,), N m
    def __len__(self) -> int: ...

class Log:
    @property
    def states(self) -> RecordedStates: ...
    @property
    def wrenches(self) -> RecordedWrenches: ...
    @property
    def corrupt_sections(self) -> Tuple[str, ...]: ...
    @property
    def missing_requests(self) -> Mapping[int, Sequence[Tuple[int, int]]]: ...
    @property
    def missing_responses(self) -> Mapping[int, Sequence[Tuple[int, int]]]: ...
    @property
    def rejected(self) -> int: ...

def read_log(
    path: Path, *, states_channel: str = "BUOYANCY_STATES", wrenches_channel: str = "BUOYANCY_WRENCHES"
) -> Log: ...
