"""Reads MJCF, the format of MuJoCo: bodies without a joint are part of their parent.

Defaults, <frame>, <include>, and the angles and orders of <compiler> are followed; <replicate>, <attach> and
<flexcomp> are errors.
"""
import math

from . import frames
from .failure import fail
from .model import DEFAULT_DENSITY, Geometry, Inertial, Joint, Link, Model

_MAX_INCLUDES = 16
_JOINTS = ("joint", "freejoint")
_SIZES = {"box": 3, "sphere": 1, "cylinder": 2, "capsule": 2, "ellipsoid": 3}


class MjcfReader:
    def __init__(self, reader, search, report):
        self.reader, self.search, self.report = reader, search, report
        self.defaults, self.meshes, self.compiler = {"main": {}}, {}, {}

    def read(self, root, model_name):
        self._include(root, 0)
        for element in root.all("compiler"):
            self.compiler.update(element.attributes)
        for element in root.all("default"):
            self._read_defaults(element, {}, "main")
        for asset in root.all("asset"):
            for mesh in asset.all("mesh"):
                values = self._merged(mesh, None)
                name = values.get("name") or values.get("file", "").rsplit("/", 1)[-1].rsplit(".", 1)[0]
                self.meshes[name] = (mesh, values)
        tops = [body for world in root.all("worldbody") for body in self._bodies(world)]
        moving = [top for top in tops if top[0].all(*_JOINTS)]
        chosen = [top for top in tops if top[0].get("name") == model_name] if model_name else (moving or tops)
        if len(chosen) != 1:
            names = ", ".join(
                f"'{top[0].get('name')}'" if top[0].get("name") else f"one without a name, {top[0].source}"
                for top in moving or tops
            ) or "none"
            fail(root.where, f"has {len(chosen)} bodies to choose from ({names})", "one body of <worldbody>",
                 "a scene of several vehicles, or a misspelt name",
                 "Choose one with --model NAME, and name it first if it has no name")
        body, pose, childclass = chosen[0]
        model = Model(body.get("name") or root.get("model", "vehicle"), body.source, "MJCF")
        self._read_body(body, "", frames.IDENTITY, childclass, model)
        # The frame of the model is that of its first body.
        model.pose = frames.compose(pose, self._pose(body, {}))
        self._read_options(root, model)
        joints = [self._merged(joint, childclass).get("type", "hinge") for joint in body.all("joint")]
        if "free" not in joints and not body.all("freejoint"):
            held = "moves on joints of" if joints else "is fixed to"
            self.report.note(f"the body '{model.name}' {held} the world: it is free in the scene ({body.source})")
        for other, _, _ in tops:
            if other is not body:
                self.report.leave_out(f"body '{other.get('name', '')}' beside the vehicle ({other.source})")
        for actuators in root.all("actuator"):
            for actuator in actuators.children:
                target = actuator.get("joint") or actuator.get("site") or actuator.get("tendon") or ""
                self.report.leave_out(
                    f"actuator '{actuator.get('name', '')}' ({actuator.tag}) on '{target}': a force "
                    f"of your simulator ({actuator.source})"
                )
        for section in root.all("equality", "tendon"):
            for child in section.children:
                self.report.leave_out(
                    f"{section.tag} '{child.get('name', '')}' ({child.tag}): a constraint of your simulator "
                    f"({child.source})"
                )
        return model

    def _include(self, element, depth):
        children = []
        for child in element.children:
            if child.tag == "include":
                if depth >= _MAX_INCLUDES:
                    fail(child.where, "files include each other too deeply", f"at most {_MAX_INCLUDES} levels",
                         "a file that includes itself", "Break the cycle")
                included = self.reader.read(self.search.find(child.get("file", ""), child))
                self._include(included, depth + 1)
                children += included.children
            else:
                self._include(child, depth)
                children.append(child)
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
        """The attributes of an element with those of its default class."""
        name = element.get("class") or childclass or "main"
        if name not in self.defaults:
            fail(element.where, f"the class '{name}' does not exist", f"one of: {', '.join(self.defaults)}",
                 "a misspelt class, or a file that is not included", "Correct it")
        return {**self.defaults[name].get(element.tag, {}), **element.attributes}

    def _bodies(self, parent, pose=frames.IDENTITY, childclass=None):
        """The bodies in an element and in its frames: element, pose of what contains it, class."""
        found = []
        for child in parent.children:
            if child.tag == "body":
                found.append((child, pose, child.get("childclass") or childclass))
            elif child.tag == "frame":
                inner = frames.compose(pose, self._pose(child, {}))
                found += self._bodies(child, inner, child.get("childclass") or childclass)
            elif child.tag in ("replicate", "attach", "flexcomp", "composite"):
                fail(child.where, f"<{child.tag}>", "bodies that are written out",
                     "a model that MuJoCo generates",
                     "Save the compiled model (mj_saveLastXML) and import that")
        return found

    def _geoms(self, parent, pose=frames.IDENTITY, childclass=None):
        found = []
        for child in parent.children:
            if child.tag == "geom":
                found.append((child, pose, childclass))
            elif child.tag == "frame":
                inner = frames.compose(pose, self._pose(child, {}))
                found += self._geoms(child, inner, child.get("childclass") or childclass)
        return found

    def _read_body(self, body, parent, pose, childclass, model):
        name = body.get("name") or f"body{len(model.links)}"
        if name in model.links:
            fail(body.where, f"two bodies are named '{name}'", "names that differ", "a copied body", "Rename one")
        link = Link(name, pose, body.source, has_sensor=bool(body.all("camera")))
        model.links[name] = link
        if parent:
            joints = body.all(*_JOINTS)
            joint = joints[0].get("name", "") if joints else ""
            model.joints.append(Joint(joint or f"joint of {name}", parent, name, not joints))
        else:
            model.canonical = name
        for geom, offset, geom_class in self._geoms(body, childclass=childclass):
            parsed = self._geometry(geom, offset, self._merged(geom, geom_class), name)
            if parsed is not None:
                link.geometry.append(parsed)
        inertial = body.find("inertial")
        link.inertial = None if inertial is None else self._inertial(inertial)
        mode = self.compiler.get("inertiafromgeom", "auto")
        link.mass_from_geometry = mode == "true" or (mode == "auto" and inertial is None)
        for child, offset, child_class in self._bodies(body, childclass=childclass):
            place = frames.compose(pose, frames.compose(offset, self._pose(child, {})))
            self._read_body(child, name, place, child_class, model)

    def _inertial(self, element):
        pose = self._pose(element, {})
        full = element.attribute_numbers("fullinertia", 6)
        if full:
            xx, yy, zz, xy, xz, yz = full
            inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        else:
            xx, yy, zz = element.attribute_numbers("diaginertia", 3, [0.0] * 3)
            inertia = [[xx, 0.0, 0.0], [0.0, yy, 0.0], [0.0, 0.0, zz]]
        return Inertial(element.attribute_numbers("mass", 1, [0.0])[0], pose[0], pose[1], inertia, element.source)

    def _angle(self, value):
        return value if self.compiler.get("angle", "degree") == "radian" else math.radians(value)

    def _pose(self, element, inherited):
        values = {**inherited, **element.attributes}

        def numbers(name, count):
            return element.numbers(count, values[name], f"{name} of <{element.tag}>") if name in values else None

        q = (1.0, 0.0, 0.0, 0.0)
        if numbers("quat", 4):
            q = frames.normalized(numbers("quat", 4))
        elif numbers("axisangle", 4):
            *axis, angle = numbers("axisangle", 4)
            q = frames.about(axis, self._angle(angle))
        elif numbers("euler", 3):
            for letter, angle in zip(self.compiler.get("eulerseq", "xyz"), numbers("euler", 3)):
                axis = [float(letter.lower() == name) for name in "xyz"]
                turn = frames.about(axis, self._angle(angle))
                q = frames.product(q, turn) if letter.islower() else frames.product(turn, q)
        elif numbers("xyaxes", 6):
            both = numbers("xyaxes", 6)
            x = frames.normalized((0.0, *both[:3]))
            along = sum(a * b for a, b in zip(x[1:], both[3:]))
            y = frames.normalized((0.0, *(b - along * a for a, b in zip(x[1:], both[3:]))))
            q = frames.from_columns(x[1:], y[1:], frames.product(x, y)[1:])
        elif numbers("zaxis", 3):
            q = frames.turning_z_to(numbers("zaxis", 3))
        if q is None:
            fail(element.where, "a quaternion of length 0", "a rotation", "numbers that are missing", "Correct it")
        return (tuple(numbers("pos", 3) or (0.0, 0.0, 0.0)), q)

    def _geometry(self, geom, offset, values, body):
        kind = values.get("type", "mesh" if "mesh" in values and "type" not in values else "sphere")
        name = values.get("name") or f"geom of {body}"

        def numbers(key, count=None):
            return geom.numbers(count, values[key], f"{key} of '{name}'") if key in values else None

        if values.get("fluidshape", "none") != "none":
            self.report.leave_out(
                f"fluidshape = \"{values['fluidshape']}\" of '{name}', fluidcoef "
                f"{values.get('fluidcoef', 'default')}: drag and lift of MuJoCo's ellipsoid model; "
                f"give [body.drag] and [body.added_mass] instead ({geom.source})"
            )
        pose = self._pose(geom, {key: value for key, value in values.items()})
        size = list(numbers("size") or [])
        if "fromto" in values and kind in ("capsule", "cylinder", "box", "ellipsoid"):
            ends = numbers("fromto", 6)
            axis = frames.subtract(ends[3:], ends[:3])
            if not any(axis):
                fail(geom.where, f"fromto of '{name}' has two equal points", "two different ends", "a typing error",
                     "Correct one of them, or give pos and size")
            pose = (tuple((a + b) / 2 for a, b in zip(ends[:3], ends[3:])), frames.turning_z_to(axis))
            half = math.sqrt(sum(c * c for c in axis)) / 2
            size = [size[0], half] if kind in ("capsule", "cylinder") else [size[0], size[0], half]
        visual = values.get("contype", "1") == "0" and values.get("conaffinity", "1") == "0"
        density = numbers("density", 1)
        mass = numbers("mass", 1)
        common = {
            "pose": frames.compose(offset, pose),
            "name": name,
            "source": geom.source,
            "element": geom,
            "visual": visual,
            "density": density[0] if density else DEFAULT_DENSITY,
            "mass": mass[0] if mass else None,
        }
        if kind == "mesh":
            return self._mesh(geom, values.get("mesh", ""), common)
        if kind not in _SIZES:
            if not visual:
                self.report.leave_out(f"geom '{name}': type \"{kind}\" encloses no volume ({geom.source})")
            return None
        if len(size) < _SIZES[kind]:
            fail(geom.where, f"size of '{name}' has {len(size)} numbers", f"{_SIZES[kind]} for a {kind}",
                 "another type, or a default class that is missing", "Correct the geom")
        # MuJoCo's sizes are halves.
        sizes = {"box": tuple(2 * c for c in size[:3]), "sphere": (size[0],), "ellipsoid": tuple(size[:3])}
        return Geometry(kind, sizes.get(kind) or (size[0], 2 * size[1]), **common)

    def _mesh(self, geom, name, common):
        if name not in self.meshes:
            fail(geom.where, f"the mesh '{name}' does not exist", f"one of: {', '.join(self.meshes) or 'none'}",
                 "an asset of another file", "Add the <mesh> to <asset>")
        mesh, values = self.meshes[name]
        if "file" not in values:
            fail(mesh.where, f"the mesh '{name}' has no file", "a mesh in a file", "vertices in the model",
                 "Save the mesh as a file")
        scale = mesh.numbers(3, values["scale"], "scale") if "scale" in values else [1.0, 1.0, 1.0]
        reference = (
            tuple(mesh.numbers(3, values.get("refpos", "0 0 0"), "refpos")),
            frames.normalized(mesh.numbers(4, values.get("refquat", "1 0 0 0"), "refquat")),
        )
        pose = frames.compose(common.pop("pose"), frames.inverse(reference))
        folder = self.compiler.get("meshdir", self.compiler.get("assetdir", ""))
        uri = values["file"] if not folder or values["file"].startswith("/") else f"{folder}/{values['file']}"
        return Geometry("mesh", tuple(scale), uri=uri, pose=pose, **common)

    def _read_options(self, root, model):
        model.gravity, model.gravity_source = (0.0, 0.0, -9.81), "MuJoCo's default"
        for option in root.all("option"):
            if "gravity" in option.attributes:
                model.gravity, model.gravity_source = (tuple(option.attribute_numbers("gravity", 3)), option.source)
            flag = option.find("flag")
            if flag is not None and flag.get("gravity") == "disable":
                model.gravity, model.gravity_source = ((0.0, 0.0, 0.0), flag.source)
            for key, unit in (("density", "kg/m^3"), ("viscosity", "Pa s"), ("wind", "m/s")):
                if key in option.attributes:
                    self.report.leave_out(
                        f"{key} = {option.get(key)} {unit} of <option>: the fluid of MuJoCo's own "
                        f"drag, without buoyancy; set it to 0 there ({option.source})"
                    )
