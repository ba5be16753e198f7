"""What every format is read into. Lengths in m, angles in rad, masses in kg; poses are in the frame of the model."""
from dataclasses import dataclass, field
from typing import Optional

from .frames import IDENTITY

# The density [kg/m^3] with which gz-sim and MuJoCo compute the mass of a body from its geometry.
DEFAULT_DENSITY = 1000.0


@dataclass
class Geometry:
    """A shape or a mesh, with its pose in the frame of its link.

    kind and size: box (x, y, z), sphere (r), cylinder and capsule (r, length without caps), cone (r, length),
    ellipsoid (three radii), mesh (three factors). Centred, with the axis along z.
    """

    kind: str
    size: tuple
    pose: tuple
    name: str
    source: str
    element: object
    uri: str = ""
    submesh: str = ""
    center_submesh: bool = False
    visual: bool = False
    density: Optional[float] = None  # of links whose mass follows from geometry
    mass: Optional[float] = None


@dataclass
class Inertial:
    """Mass, centre of mass in the frame of the link, inertia about it in axes that `rotation` turns to the link's."""

    mass: float
    center: tuple
    rotation: tuple
    inertia: list  # 3 x 3
    source: str
    fluid_added_mass: Optional[list] = None  # 6 x 6, about the origin of the link and in its axes
    fluid_source: str = ""


@dataclass
class Link:
    name: str
    pose: tuple
    source: str
    inertial: Optional[Inertial] = None
    mass_from_geometry: bool = False
    geometry: list = field(default_factory=list)
    has_sensor: bool = False


def report_buoyancy(element, name, report):
    """Reports what freefloating_gazebo reads from a link: an element that neither SDF nor URDF has."""
    for child in element.all("buoyancy"):
        report.leave_out(f"<buoyancy> of '{name}', of freefloating_gazebo: with its drag ({child.source})")


def is_locked(kind, lower="", upper=""):
    """Whether a joint that could move has limits of 0 and 0; the limits are text, and may be -inf or missing."""

    def is_zero(text):
        try:
            return float(text) == 0
        except ValueError:
            return False

    return kind in ("revolute", "prismatic") and is_zero(lower) and is_zero(upper)


@dataclass
class Joint:
    name: str
    parent: str  # a link, or "world"
    child: str
    fixed: bool
    locked: bool = False  # fixed by limits of 0 and 0, as hulls of several links and sensors are


@dataclass
class Plugin:
    """A plugin with the prefix of the model that it is written in, such as "arm::"."""

    name: str
    filename: str
    element: object
    prefix: str = ""


@dataclass
class Model:
    name: str
    source: str
    format: str
    links: dict = field(default_factory=dict)
    joints: list = field(default_factory=list)
    plugins: list = field(default_factory=list)
    pose: tuple = IDENTITY  # in the world
    gravity: Optional[tuple] = None
    gravity_source: str = ""
    canonical: str = ""  # the link whose frame a body prefers
