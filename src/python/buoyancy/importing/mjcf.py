"""Reads MJCF, the format of MuJoCo: bodies without a joint are part of their parent.

Defaults, <frame>, <include>, and the angles and orders of <compiler> are followed; <replicate>, <attach> and
<flexcomp> are errors.
"""
import math

import numpy as np

from . import frames
from .failure import choose, fail, one_of
from .model import DEFAULT_DENSITY, Geometry, Inertial, Joint, Link, Model, symmetric

_JOINTS = ("joint", "freejoint")
_GENERATED = ("replicate", "attach", "flexcomp", "composite")
_SIZES = {"box": 3, "sphere": 1, "cylinder": 2, "capsule": 2, "ellipsoid": 3}


class MjcfReader:
    def __init__(self, reader, search, report):
        self.reader, self.search, self.report = reader, search, report
        self.defaults, self.meshes, self.compiler = {"main": {}}, {}, {}

    def read(self, root, model_name):
        self._include(root)
        for element in root.all("compiler"):
            self.compiler.update(element.attributes)
        for element in root.all("default"):
            self._read_defaults(element, {}, "main")
        for asset in root.all("asset"):
            for mesh in (self._merged(element, None) for element in asset.all("mesh")):
                name = mesh.get("name") or mesh.get("file", "").rsplit("/", 1)[-1].rsplit(".", 1)[0]
                self.meshes[name] = mesh
        bodies = {
            body: (pose, childclass)
            for world in root.all("worldbody")
            for body, pose, childclass in self._elements("body", world)
        }
        tops = [(body.get("name", ""), body) for body in bodies]
        moving = [top for top in tops if top[1].all(*_JOINTS)]
        body = choose(root, tops, moving or tops, model_name, "bodies")
        pose, childclass = bodies[body]
        model = Model(body.get("name") or root.get("model") or "vehicle", body, "MJCF")
        self._read_body(body, "", frames.IDENTITY, childclass, model)
        # The frame of the model is that of its first body.
        model.pose = pose @ self._pose(body)
        self._read_options(root, model)
        joints = [self._merged(joint, childclass).get("type", "hinge") for joint in body.all("joint")]
        if "free" not in joints and not body.all("freejoint"):
            held = "moves on joints of" if joints else "is fixed to"
            self.report.note(f"the body '{model.name}' {held} the world: it is free in the scene", body)
        for other in bodies:
            if other is not body:
                self.report.leave_out(f"body '{other.get('name', '')}' beside the vehicle", other)
        for actuators in root.all("actuator"):
            for actuator in actuators.children:
                target = actuator.get("joint") or actuator.get("site") or actuator.get("tendon") or ""
                self.report.leave_out(f"actuator '{actuator.get('name', '')}' ({actuator.tag}) on '{target}': a force "
                                      "of your simulator", actuator)
        for section in root.all("equality", "tendon"):
            for child in section.children:
                self.report.leave_out(f"{section.tag} '{child.get('name', '')}' ({child.tag}): a constraint of your "
                                      "simulator", child)
        return model

    def _include(self, element):
        children = []
        for child in element.children:
            included = child
            if child.tag == "include":
                included = self.reader.read(self.search.find(child.get("file", ""), child), child)
            self._include(included)
            children += [child] if included is child else included.children
        element.children = children

    def _read_defaults(self, element, inherited, name):
        values = {tag: dict(attributes) for tag, attributes in inherited.items()}
        for child in element.children:
            if child.tag != "default":
                values.setdefault(child.tag, {}).update(child.attributes)
        self.defaults[name] = values
        for child in element.all("default"):
            self._read_defaults(child, values, child.get("class", "main"))

    def _merged(self, element, childclass):
        """The element with the attributes of its default class, too."""
        name = element.get("class") or childclass or "main"
        if name not in self.defaults:
            fail(element, f"the class '{name}' does not exist", one_of(self.defaults),
                 "a misspelt class, or a file that is not included", "Correct it")
        return element.with_attributes({**self.defaults[name].get(element.tag, {}), **element.attributes})

    def _elements(self, tag, parent, pose=frames.IDENTITY, childclass=None):
        """The elements of a tag in an element and in its frames: element, pose of what contains it, class."""
        found = []
        for child in parent.children:
            inner = child.get("childclass") or childclass
            if child.tag == tag:
                found.append((child, pose, inner))
            elif child.tag == "frame":
                found += self._elements(tag, child, pose @ self._pose(child), inner)
            elif child.tag in _GENERATED:
                fail(child, f"<{child.tag}>", "bodies that are written out", "a model that MuJoCo generates",
                     "Save the compiled model (mj_saveLastXML) and import that")
        return found

    def _read_body(self, body, parent, pose, childclass, model):
        name = body.get("name") or f"body{len(model.links)}"
        link = Link(name, pose, body, has_sensor=bool(body.all("camera")))
        model.add(link)
        if parent:
            joints = body.all(*_JOINTS)
            joint = joints[0].get("name", "") if joints else ""
            model.joints.append(Joint(joint or f"joint of {name}", parent, name, not joints, body))
        else:
            model.canonical = name
        for geom, offset, geom_class in self._elements("geom", body, childclass=childclass):
            link.geometry += self._geometry(self._merged(geom, geom_class), offset, name)
        inertial = body.find("inertial")
        if inertial is not None:
            moments = inertial.numbers("fullinertia", 6) or inertial.numbers("diaginertia", 3, [0.0] * 3)
            mass = inertial.number("mass", 0.0, minimum=0.0)
            link.inertial = Inertial(mass, self._pose(inertial), symmetric(*moments), inertial)
        mode = self.compiler.get("inertiafromgeom", "auto")
        link.mass_from_geometry = mode == "true" or (mode == "auto" and inertial is None)
        for child, offset, child_class in self._elements("body", body, childclass=childclass):
            self._read_body(child, name, pose @ offset @ self._pose(child), child_class, model)

    def _pose(self, element):
        return frames.pose(element.numbers("pos", 3, [0.0] * 3), self._rotation(element))

    def _rotation(self, element):
        def angle(value):
            return value if self.compiler.get("angle", "degree") == "radian" else math.radians(value)

        quaternion, axis_angle = element.numbers("quat", 4), element.numbers("axisangle", 4)
        euler, both, z = element.numbers("euler", 3), element.numbers("xyaxes", 6), element.numbers("zaxis", 3)
        rotation = frames.IDENTITY[:3, :3]
        if quaternion:
            rotation = frames.from_quaternion(quaternion)
        elif axis_angle:
            rotation = frames.about(axis_angle[:3], angle(axis_angle[3]))
        elif euler:
            for letter, value in zip(self.compiler.get("eulerseq", "xyz"), euler):
                turn = frames.about([float(letter.lower() == name) for name in "xyz"], angle(value))
                rotation = rotation @ turn if letter.islower() else turn @ rotation
        elif both:
            normal = np.cross(both[:3], both[3:])
            columns = np.array((both[:3], np.cross(normal, both[:3]), normal)).T
            lengths = np.linalg.norm(columns, axis=0)
            rotation = columns / lengths if all(lengths > 0) else None
        elif z:
            rotation = frames.turning_z_to(z)
        if rotation is None:
            fail(element, "a quaternion or an axis of length 0, or two axes along one line", "a rotation",
                 "numbers that are missing", "Correct it")
        return rotation

    def _geometry(self, geom, offset, body):
        kind = geom.get("type", "mesh" if "mesh" in geom.attributes else "sphere")
        name = geom.get("name") or f"geom of {body}"
        if geom.get("fluidshape", "none") != "none":
            self.report.leave_out(f"fluidshape = \"{geom.get('fluidshape')}\" of '{name}', fluidcoef "
                                  f"{geom.get('fluidcoef', 'default')}: drag and lift of MuJoCo's ellipsoid model; "
                                  "give [body.drag] and [body.added_mass] instead", geom)
        visual = geom.get("contype", "1") == "0" and geom.get("conaffinity", "1") == "0"
        result = Geometry(kind, (), offset @ self._pose(geom), name, geom, visual)
        result.density = geom.number("density", DEFAULT_DENSITY, minimum=0.0)
        result.mass = geom.number("mass", minimum=0.0)
        if kind == "mesh":
            self._read_mesh(result)
            return [result]
        if kind not in _SIZES:
            if not visual:
                self.report.leave_out(f"geom '{name}': type \"{kind}\" encloses no volume", geom)
            return []
        size = geom.numbers("size", default=[])
        if "fromto" in geom.attributes and kind != "sphere":
            ends = np.reshape(geom.numbers("fromto", 6), (2, 3))
            axis = ends[1] - ends[0]
            if not axis.any():
                fail(geom, f"fromto of '{name}' has two equal points", "two different ends", "a typing error",
                     "Correct one of them, or give pos and size")
            result.pose = offset @ frames.pose((ends[0] + ends[1]) / 2, frames.turning_z_to(axis))
            # The size states one radius, or half of one side.
            size = [*(size[:1] * (_SIZES[kind] - 1)), float(np.linalg.norm(axis)) / 2]
        if len(size) < _SIZES[kind]:
            fail(geom, f"size of '{name}' has {len(size)} numbers", f"{_SIZES[kind]} for a {kind}",
                 "another type, or a default class that is missing", "Correct the geom")
        # MuJoCo's sizes are halves.
        sizes = {"box": tuple(2 * c for c in size[:3]), "sphere": (size[0],), "ellipsoid": tuple(size[:3])}
        result.size = sizes.get(kind) or (size[0], 2 * size[1])
        return [result]

    def _read_mesh(self, result):
        geom, name = result.element, result.element.get("mesh", "")
        if name not in self.meshes:
            fail(geom, f"the mesh '{name}' does not exist", one_of(self.meshes), "an asset of another file",
                 "Add the <mesh> to <asset>")
        mesh = self.meshes[name]
        if "file" not in mesh.attributes:
            fail(mesh, f"the mesh '{name}' has no file", "a mesh in a file", "vertices in the model",
                 "Save the mesh as a file")
        rotation = frames.from_quaternion(mesh.numbers("refquat", 4, [1.0, 0.0, 0.0, 0.0]))
        if rotation is None:
            fail(mesh, "refquat has the length 0", "a rotation", "numbers that are missing", "Correct it")
        result.pose = result.pose @ frames.inverse(frames.pose(mesh.numbers("refpos", 3, [0.0] * 3), rotation))
        result.size = tuple(mesh.numbers("scale", 3, [1.0] * 3))
        folder, file = self.compiler.get("meshdir", self.compiler.get("assetdir", "")), mesh.get("file")
        result.uri = file if not folder or file.startswith("/") else f"{folder}/{file}"

    def _read_options(self, root, model):
        model.gravity, model.gravity_source = [0.0, 0.0, -9.81], "MuJoCo's default"
        for option in root.all("option"):
            if "gravity" in option.attributes:
                model.gravity, model.gravity_source = option.numbers("gravity", 3), option.source
            if option.text_of("flag/gravity") == "disable":
                model.gravity, model.gravity_source = [0.0] * 3, option.find("flag").source
            for key, unit in (("density", "kg/m^3"), ("viscosity", "Pa s"), ("wind", "m/s")):
                if key in option.attributes:
                    self.report.leave_out(f"{key} = {option.get(key)} {unit} of <option>: the fluid of MuJoCo's own "
                                          "drag, without buoyancy; set it to 0 there", option)
