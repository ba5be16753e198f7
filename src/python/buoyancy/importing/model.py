"""What every format is read into. Lengths in m, angles in rad, masses in kg; poses are in the frame of the model."""
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from typing import Optional

from .failure import fail
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


@dataclass
class Joint:
    name: str
    parent: str  # a link, or "world"
    child: str
    fixed: bool
    element: object


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
    element: object
    format: str
    links: dict = field(default_factory=dict)
    joints: list = field(default_factory=list)
    plugins: list = field(default_factory=list)
    pose: tuple = IDENTITY  # in the world
    gravity: Optional[tuple] = None
    gravity_source: str = ""
    canonical: str = ""  # the link whose frame a body prefers

    def check_joints(self, report):
        """Refuses joints in a circle, and warns of a link that is the child of several joints."""
        joints = {}  # of each child: parent, joint
        for joint in self.joints:
            if joint.parent == joint.child:
                fail(joint.element.where, f"the joint '{joint.name}' connects '{joint.parent}' with itself",
                     "two different links", "a name that was copied", "Correct its parent or its child")
            if joint.parent in self.links and joint.child in self.links:
                joints.setdefault(joint.child, {})[joint.parent] = joint
        try:
            TopologicalSorter(joints).prepare()
        except CycleError as error:
            circle = error.args[1]
            joint = joints[circle[1]][circle[0]]
            fail(joint.element.where, f"the joint '{joint.name}' closes a circle ({' -> '.join(circle)})",
                 "a tree of links", "a joint whose parent and child are exchanged",
                 "Correct or remove one of its joints")
        for child, parents in joints.items():
            if len(parents) > 1:
                names, last = [f"'{joint.name}'" for joint in parents.values()], [*parents.values()][-1]
                report.warn(
                    f"the link '{child}' is the child of the joints {', '.join(names)}: a closed chain, which only "
                    f"your simulator can hold together ({last.element.source})"
                )
