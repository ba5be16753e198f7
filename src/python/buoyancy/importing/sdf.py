"""Reads SDF 1.4 to 1.12: a model file, the folder of a model, or a model of a world.

Frames follow SDF 1.7 and later: a pose is relative to `relative_to`, else to the frame that contains it; frames are
attached to links, and names such as arm::hand reach into nested models. Older files say `frame` for `relative_to`.
"""
import math

from . import frames
from .failure import ImportFailure, fail
from .model import Geometry, Inertial, Joint, Link, Model, Plugin, is_locked, report_buoyancy

_MAX_INCLUDES = 16
_ADDED_MASS_AXES = "xyzpqr"


class _Scope:
    """A model, or the world, as it is written: names, and the poses that they have relative to other names."""

    def __init__(self, element, name, parent=None, merged=False):
        self.element, self.name, self.parent, self.merged = element, name, parent, merged
        self.include = None  # the <include> that names this model
        self.entries = {}  # name: the element of a link, frame or joint
        self.models = {}  # name: a scope
        for child in element.all("link", "frame", "joint"):
            self.entries.setdefault(child.get("name", ""), child)

    def pose_of(self, name, where, visited=()):
        """The pose of a frame, in this model's own frame."""
        if name in ("__model__", "", "world") and name not in self.entries:
            return frames.IDENTITY
        if name in visited:
            fail(where.where, f"the frame '{name}' is relative to itself ({' -> '.join((*visited, name))})",
                 "frames without a cycle", "a relative_to that was mistyped", "Correct it")
        if name in self.entries:
            element = self.entries[name]
            default = {"link": "", "joint": element.child_text("child", ""), "frame": element.get("attached_to", "")}[
                element.tag
            ]
            return self.read_pose(element, default, (*visited, name))
        scope, rest = self.nested(name)
        if scope is None:
            known = ", ".join([*self.entries, *self.models]) or "none"
            fail(where.where, f"no frame is named '{name}'", f"one of: {known}",
                 "a frame of another model, or a misspelt name", "Correct relative_to or attached_to")
        outer = scope.model_pose((*visited, name))
        return outer if rest == "" else frames.compose(outer, scope.pose_of(rest, where))

    def nested(self, name):
        """The scope that a name leads into, and the rest of the name."""
        first, _, rest = name.partition("::")
        if first in self.models and not self.models[first].merged:
            return self.models[first], rest
        for scope in self.models.values():
            if scope.merged and (first in scope.entries or first in scope.models or scope.nested(name)[0]):
                return scope, name
        return None, ""

    def model_pose(self, visited=()):
        """The pose of this model's frame in its parent's, which may place another of its frames."""
        include = self.include
        element = self.element if include is None or include.find("pose") is None else include
        pose = self.parent.read_pose(element, "", visited)
        placed = include.child_text("placement_frame", "") if include is not None else ""
        placed = placed or self.element.get("placement_frame", "")
        if placed:
            pose = frames.compose(pose, frames.inverse(self.pose_of(placed, element)))
        return pose

    def read_pose(self, element, default, visited=()):
        found = element.find("pose")
        pose = frames.IDENTITY if found is None else parse_pose(found)
        relative = default
        if found is not None:
            relative = found.get("relative_to") or found.get("frame") or default
        return frames.compose(self.pose_of(relative, element, visited), pose)

    def link_of(self, name, where, visited=()):
        """The full name of the link that a frame is attached to."""
        if name == "world":
            return "world"
        if name in visited:
            fail(where.where, f"'{name}' is attached to itself", "a frame that is attached to a link",
                 "an attached_to that was mistyped", "Correct it")
        if name in self.entries:
            element = self.entries[name]
            if element.tag == "link":
                return self.prefix() + name
            attached = element.child_text("child", "") if element.tag == "joint" else element.get("attached_to", "")
            return self.link_of(attached or "__model__", where, (*visited, name))
        if name == "__model__":
            return self.canonical(where)
        scope, rest = self.nested(name)
        if scope is None:
            fail(where.where, f"no link or frame is named '{name}'",
                 f"one of: {', '.join(self.entries) or 'none'}", "a misspelt name, or a link of another model",
                 "Correct the joint")
        return scope.link_of(rest or "__model__", where)

    def canonical(self, where):
        stated = self.element.get("canonical_link", "")
        if stated:
            return self.link_of(stated, where)
        for element in self.entries.values():
            if element.tag == "link":
                return self.prefix() + element.get("name", "")
        for scope in self.models.values():
            return scope.canonical(where)
        return fail(where.where, f"the model '{self.name}' has no link", "a model with a link",
                    "an empty model", "Import another one")

    def prefix(self):
        if self.parent is None or self.parent.parent is None:
            return ""  # names of links begin below the model
        return self.parent.prefix() + ("" if self.merged else self.name + "::")


def parse_pose(element):
    numbers = (
        element.numbers((6, 7) if element.get("rotation_format") == "quat_xyzw" else 6)
        if element.text.strip()
        else [0.0] * 6
    )
    position, rotation = tuple(numbers[:3]), numbers[3:]
    if element.get("rotation_format") == "quat_xyzw":
        q = frames.normalized((rotation[3], *rotation[:3])) if len(rotation) == 4 else None
        if q is None:
            fail(element.where, "the quaternion of the pose is not one", "x y z and a quaternion x y z w",
                 "numbers " "that are missing", "Correct the pose")
        return (position, q)
    factor = math.pi / 180 if element.get("degrees", "") in ("true", "1") else 1.0
    return (position, frames.from_rpy(*(factor * angle for angle in rotation)))


class SdfReader:
    def __init__(self, reader, search, report):
        self.reader, self.search, self.report = reader, search, report

    def read(self, root, model_name):
        """The model of this name, or the only one; and the plugins of the world around it."""
        world = root.find("world")
        holder = world if world is not None else root
        candidates = []
        for element in holder.all("model", "include"):
            name = element.child_text("name", "") if element.tag == "include" else element.get("name", "")
            if element.tag == "include":
                # Only the include that is wanted is read: others may be missing here.
                name = name or element.child_text("uri", "").rstrip("/").split("/")[-1]
            candidates.append((name, element))
        moving = [item for item in candidates if len(candidates) == 1 or not item[1].flag("static")]
        chosen = [item for item in candidates if item[0] == model_name] if model_name else moving
        names = ", ".join(f"'{name}'" for name, _ in moving) or "none"
        if len(chosen) != 1:
            actual = f"has {len(moving)} models that are not static ({names})"
            if model_name:
                actual = f"has {len(chosen)} models of the name '{model_name}' (it has: {names})"
            fail(root.where, actual, "one model to import", "a world of several models, or a misspelt name",
                 "Choose one with --model NAME")
        outer = _Scope(holder, "")
        name, element = chosen[0]
        scope = self._scope(element, outer, 0)
        outer.models[scope.name] = scope
        model = Model(scope.name, element.source, "SDF", pose=scope.model_pose())
        if element.flag("static") or scope.element.flag("static"):
            self.report.note(f"the model is static: it is free in the scene ({element.source})")
        self._flatten(scope, frames.IDENTITY, model)
        model.canonical = scope.canonical(element)
        self._join_detachable(model)
        if world is not None:
            model.plugins += [Plugin(p.get("name", ""), p.get("filename", ""), p) for p in world.all("plugin")]
            gravity = world.find("gravity")
            if gravity is not None:
                model.gravity, model.gravity_source = tuple(gravity.numbers(3)), gravity.source
        return model

    def _scope(self, element, parent, depth):
        include, merged = None, False
        if element.tag == "include":
            include, merged = element, element.get("merge", "") in ("true", "1")
            element = self._included(include, depth)
        name = (include.child_text("name", "") if include is not None else "") or element.get("name", "")
        scope = _Scope(element, name, parent, merged)
        scope.include = include
        if depth > _MAX_INCLUDES:
            fail(element.where, "models are nested too deeply", f"at most {_MAX_INCLUDES} levels",
                 "a model that includes itself", "Break the cycle")
        for child in element.all("model", "include"):
            inner = self._scope(child, scope, depth + 1)
            scope.models[inner.name] = inner
        return scope

    def _included(self, include, depth):
        if depth > _MAX_INCLUDES:
            fail(include.where, "models include each other too deeply", f"at most {_MAX_INCLUDES} levels",
                 "a model that includes itself", "Break the cycle")
        uri = include.child_text("uri", "")
        found = self.search.find(uri, include, "model")
        root = self.reader.read(model_file(found) if found.is_dir() else found)
        model = root.find("model")
        if model is None:
            fail(root.where, "contains no model", "an SDF file with a model", f"'{uri}' names another file",
                 "Correct the uri")
        return model

    def _flatten(self, scope, pose, model):
        """Adds what a scope contains; `pose` is that of its frame in the model."""
        prefix = scope.prefix()
        for element in scope.element.all("link"):
            name = element.get("name", "")
            if prefix + name in model.links:
                fail(element.where, f"two links are named '{prefix + name}'", "names that differ",
                     "a copied link", "Rename one")
            place = frames.compose(pose, scope.pose_of(name, element))
            model.links[prefix + name] = self._link(scope, element, prefix + name, place, pose)
        for element in scope.element.all("joint"):
            ends = []
            for tag in ("parent", "child"):
                found = element.find(tag)
                text = element.child_text(tag, "")
                if found is not None and not text and found.find("link_name") is not None:
                    text = found.child_text("link_name", "")
                ends.append(scope.link_of(text, element))
            kind = element.get("type", "")
            locked = is_locked(kind, *(element.child_text(f"axis/limit/{end}", "") for end in ("lower", "upper")))
            model.joints.append(Joint(prefix + element.get("name", ""), *ends, kind == "fixed" or locked, locked))
        holders = [scope.element] + ([scope.include] if scope.include is not None else [])
        for holder in holders:
            for plugin in holder.all("plugin"):
                model.plugins.append(Plugin(plugin.get("name", ""), plugin.get("filename", ""), plugin, prefix))
        for inner in scope.models.values():
            self._flatten(inner, frames.compose(pose, inner.model_pose()), model)

    def _join_detachable(self, model):
        """Adds the joints that a plugin makes at the start, within the model, such as that of a drop weight."""
        for plugin in model.plugins:
            element = plugin.element
            if "DetachableJoint" not in plugin.name or element.child_text("child_model") != "__model__":
                continue
            parent, child = (plugin.prefix + element.child_text(f"{end}_link", "") for end in ("parent", "child"))
            if parent in model.links and child in model.links:
                model.joints.append(Joint(f"DetachableJoint of {child}", parent, child, True))
                self.report.note(f"link '{child}' is fixed to '{parent}', until it is dropped ({element.source})")

    def _link(self, scope, element, name, place, scope_pose):
        link = Link(name, place, element.source, has_sensor=bool(element.all("sensor")))

        def in_link(child):
            found = child.find("pose")
            relative = None if found is None else found.get("relative_to") or found.get("frame")
            if not relative:
                return frames.IDENTITY if found is None else parse_pose(found)
            in_model = frames.compose(scope_pose, scope.read_pose(child, ""))
            return frames.compose(frames.inverse(place), in_model)

        inertial = element.find("inertial")
        link.mass_from_geometry = inertial is not None and inertial.get("auto", "") in ("true", "1")
        if not link.mass_from_geometry:
            link.inertial = self._inertial(inertial, element, in_link)
        report_buoyancy(element, name, self.report)
        density = None if inertial is None else inertial.number("density")
        for child in element.all("collision", "visual"):
            geometry = child.find("geometry")
            if geometry is None:
                continue
            parsed = self._geometry(geometry, child, in_link(child))
            if parsed is not None:
                parsed.visual = child.tag == "visual"
                parsed.density = child.number("density", density)
                link.geometry.append(parsed)
        return link

    def _inertial(self, inertial, link, in_link):
        if inertial is None:
            self.report.note(f"the link '{link.get('name')}' has no inertial: SDF gives it 1 kg ({link.source})")
            return Inertial(1.0, (0, 0, 0), frames.IDENTITY[1], [[1, 0, 0], [0, 1, 0], [0, 0, 1]], link.source)
        pose = in_link(inertial)
        found = inertial.find("inertia")

        def entry(tag, default):
            return default if found is None else found.number(tag, default)

        xx, yy, zz = (entry(tag, 1.0) for tag in ("ixx", "iyy", "izz"))
        xy, xz, yz = (entry(tag, 0.0) for tag in ("ixy", "ixz", "iyz"))
        result = Inertial(
            inertial.number("mass", 1.0), pose[0], pose[1], [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], inertial.source
        )
        fluid = inertial.find("fluid_added_mass")
        if fluid is not None:
            added = frames.zeros()
            for i, row in enumerate(_ADDED_MASS_AXES):
                for j, column in enumerate(_ADDED_MASS_AXES[i:], i):
                    added[i][j] = added[j][i] = fluid.number(row + column, 0.0)
            result.fluid_added_mass, result.fluid_source = added, fluid.source
        return result

    def _geometry(self, geometry, holder, pose):
        shape = next(iter(geometry.children), None)
        name = holder.get("name", holder.tag)

        def lengths(*tags):
            values = []
            for tag in tags:
                if shape.find(tag) is None:
                    fail(shape.where, f"<{shape.tag}> of '{name}' has no <{tag}>", "a complete shape",
                         "a deleted line", "Add it")
                values += shape.find(tag).numbers()
            return tuple(values)

        common = {"pose": pose, "name": name, "source": holder.source, "element": holder}
        if shape is None or shape.tag == "empty":
            return None
        if shape.tag == "box":
            return Geometry("box", lengths("size"), **common)
        if shape.tag == "sphere":
            return Geometry("sphere", lengths("radius"), **common)
        if shape.tag in ("cylinder", "capsule", "cone"):
            return Geometry(shape.tag, lengths("radius", "length"), **common)
        if shape.tag == "ellipsoid":
            return Geometry("ellipsoid", lengths("radii"), **common)
        if shape.tag == "mesh":
            scale = tuple(shape.find("scale").numbers(3)) if shape.find("scale") is not None else (1.0, 1.0, 1.0)
            submesh = shape.find("submesh")
            return Geometry(
                "mesh",
                scale,
                uri=shape.child_text("uri", ""),
                submesh="" if submesh is None else submesh.child_text("name", ""),
                center_submesh=submesh is not None and submesh.flag("center"),
                **common,
            )
        if holder.tag == "collision":
            self.report.leave_out(f"{holder.tag} '{name}': <{shape.tag}> encloses no volume ({holder.source})")
        return None


def model_file(folder):
    """The newest SDF file that the model.config of a folder names."""
    from .xml_file import XmlReader

    config = folder / "model.config"
    if config.exists():
        named = [
            (element.get("version", "0"), element.text.strip())
            for element in XmlReader().read(config).all("sdf")
            if element.text.strip()
        ]
        if named:
            return folder / max(named, key=lambda pair: [int(n) if n.isdigit() else 0 for n in pair[0].split(".")])[1]
    if (folder / "model.sdf").exists():
        return folder / "model.sdf"
    raise ImportFailure(
        f"{folder}: has neither model.config nor model.sdf; expected the folder of an SDF model. "
        "Likely cause: another folder. Name the model file."
    )
