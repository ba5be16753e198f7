"""What every format is read into. Lengths in m, angles in rad, masses in kg; poses are in the frame of the model."""
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from typing import Optional

import numpy as np

from . import frames
from .failure import fail

# The density [kg/m^3] with which gz-sim and MuJoCo compute the mass of a body from its geometry.
DEFAULT_DENSITY = 1000.0
# Shapes of SDF and URDF, and what their sizes consist of.
_SIZES = {
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "cone": ("radius", "length"),
    "ellipsoid": ("radii",),
}


class _Written:
    """What an element of a file describes."""

    @property
    def source(self):
        return self.element.source


@dataclass
class Geometry(_Written):
    """A shape or a mesh, with its pose in the frame of its link.

    kind and size: box (x, y, z), sphere (r), cylinder and capsule (r, length without caps), cone (r, length),
    ellipsoid (three radii), mesh (three factors). Centred, with the axis along z.
    """

    kind: str
    size: tuple
    pose: np.ndarray
    name: str
    element: object
    visual: bool
    uri: str = ""
    submesh: str = ""
    center_submesh: bool = False
    density: Optional[float] = None  # of links whose mass follows from geometry
    mass: Optional[float] = None


@dataclass
class Inertial(_Written):
    """Mass, pose of the centre of mass in the frame of the link, and the inertia about it in the axes of that pose."""

    mass: float
    pose: np.ndarray
    inertia: np.ndarray
    element: object


@dataclass
class Link(_Written):
    name: str
    pose: np.ndarray
    element: object
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
    locked: bool = False  # fixed by limits of 0 and 0, as hulls of several links and sensors are


@dataclass
class Plugin(_Written):
    """A plugin with the prefix of the model that it is written in, such as "arm::"."""

    element: object
    prefix: str = ""

    @property
    def name(self):
        return self.element.get("name", "")

    @property
    def filename(self):
        return self.element.get("filename", "")


@dataclass
class Model(_Written):
    name: str
    element: object
    format: str
    links: dict = field(default_factory=dict)
    joints: list = field(default_factory=list)
    plugins: list = field(default_factory=list)
    pose: np.ndarray = field(default_factory=frames.pose)  # in the world
    gravity: Optional[list] = None
    gravity_source: str = ""
    canonical: str = ""  # the link whose frame a body prefers

    def add(self, link):
        if link.name in self.links:
            fail(link.element, f"two of the model are named '{link.name}'", "names that differ",
                 "a copied link, or a macro that was used twice", "Rename one")
        self.links[link.name] = link

    def links_below_joints(self, report):
        """The links that are the child of joints, parents first: name, joints. Refuses joints in a circle."""
        joints = {}  # of each child: parent, joint
        for joint in self.joints:
            if joint.parent == joint.child:
                fail(joint.element, f"the joint '{joint.name}' connects '{joint.parent}' with itself",
                     "two different links", "a name that was copied", "Correct its parent or its child")
            if joint.parent in self.links and joint.child in self.links:
                joints.setdefault(joint.child, {})[joint.parent] = joint
        try:
            order = list(TopologicalSorter(joints).static_order())
        except CycleError as error:
            circle = error.args[1]
            joint = joints[circle[1]][circle[0]]
            fail(joint.element, f"the joint '{joint.name}' closes a circle ({' -> '.join(circle)})", "a tree of links",
                 "a joint whose parent and child are exchanged", "Correct or remove one of its joints")
        result = [(name, [*joints[name].values()]) for name in order if name in joints]
        for child, above in result:
            if len(above) > 1:
                names = ", ".join(repr(joint.name) for joint in above)
                report.warn(f"the link '{child}' is the child of the joints {names}: a closed chain, which only your "
                            f"simulator can hold together ({above[-1].element.source})")
        return result


def read_inertial(element, pose, mass, moment, path="mass"):
    """An <inertial> of SDF or URDF; `mass` and `moment` are what it has where it does not state them."""
    xx, yy, zz = (element.number(f"inertia/{key}", moment) for key in ("ixx", "iyy", "izz"))
    xy, xz, yz = (element.number(f"inertia/{key}", 0.0) for key in ("ixy", "ixz", "iyz"))
    return Inertial(element.number(path, mass, minimum=0.0), pose, symmetric(xx, yy, zz, xy, xz, yz), element)


def read_joint(element, name, parent, child, limits):
    """A joint of SDF or URDF; the texts of its limits may be -inf, or empty. With limits of 0 and 0 it is fixed."""

    def is_zero(text):
        try:
            return float(text) == 0
        except ValueError:
            return False

    kind = element.get("type")
    locked = kind in ("revolute", "prismatic") and all(map(is_zero, limits))
    return Joint(name, parent, child, kind == "fixed" or locked, element, locked)


def report_buoyancy(element, name, report):
    """Reports what freefloating_gazebo reads from a link: an element that neither SDF nor URDF has."""
    for child in element.all("buoyancy"):
        report.leave_out(f"<buoyancy> of '{name}', of freefloating_gazebo: with its drag", child)


def symmetric(xx, yy, zz, xy=0.0, xz=0.0, yz=0.0):
    return np.array(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))


def read_geometry(holder, pose, name, report):
    """The shape or mesh of a <collision> or <visual> of SDF or URDF, in a list; empty if it encloses no volume."""
    geometry = holder.find("geometry")
    shape = next(iter(geometry.children if geometry else ()), None)
    if shape is None or shape.tag == "empty":
        return []
    common = {"pose": pose, "name": name, "element": holder, "visual": holder.tag == "visual"}
    if shape.tag == "mesh":
        scale = shape.numbers("scale", (1, 3), [1.0])
        mesh = Geometry("mesh", tuple(scale * 3 if len(scale) == 1 else scale), **common)
        mesh.uri, mesh.submesh = shape.text_of("uri") or shape.text_of("filename"), shape.text_of("submesh/name")
        mesh.center_submesh = shape.flag("submesh/center")
        return [mesh]
    if shape.tag not in _SIZES:
        if holder.tag == "collision":
            report.leave_out(f"{holder.tag} '{name}': <{shape.tag}> encloses no volume", holder)
        return []
    sizes = [(key, shape.numbers(key)) for key in _SIZES[shape.tag]]
    for key, size in sizes:
        if size is None:
            fail(shape, f"<{shape.tag}> of '{name}' has no {key}", "a complete shape", "a deleted line", "Add it")
    return [Geometry(shape.tag, tuple(number for _, size in sizes for number in size), **common)]
