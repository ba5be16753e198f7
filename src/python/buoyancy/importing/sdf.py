"""Reads SDF 1.4 to 1.12: a model file, the folder of a model, or a model of a world.

Frames follow SDF 1.7 and later: a pose is relative to `relative_to`, else to the frame that contains it; frames are
attached to links, and names such as arm::hand reach into nested models. Older files say `frame` for `relative_to`.
"""
import math

import numpy as np

from . import frames
from .failure import choose, fail, one_of
from .model import Inertial, Joint, Link, Model, Plugin, read_geometry, read_inertial, read_joint, report_buoyancy
from .xml_file import XmlReader

_MAX_CHAIN = 200  # of frames that are relative to each other


class _Scope:
    """A model, or the world, as it is written: names, and the poses that they have relative to other names."""

    def __init__(self, element, name, parent=None, include=None):
        self.element, self.name, self.parent = element, name, parent
        self.include = include  # the <include> that names this model
        self.merged = include is not None and include.flag("merge")
        self.entries = {}  # name: the element of a link, frame or joint
        self.models = {}  # name: a scope
        for child in element.all("link", "frame", "joint"):
            if not child.get("name"):
                fail(child, f"the <{child.tag}> has no name", "an attribute name", "a deleted line", "Name it")
            self.entries.setdefault(child.get("name"), child)

    def pose_of(self, name, where, visited=()):
        """The pose of a frame, in this model's own frame."""
        if name in ("__model__", "", "world") and name not in self.entries:
            return frames.IDENTITY
        visited = _visited(visited, name, where)
        if name in self.entries:
            return self.read_pose(self.entries[name], self._attached(name), visited)
        scope, rest = self._nested(name, where)
        return scope.model_pose(visited) @ scope.pose_of(rest, where)

    def _attached(self, name):
        """The name of the frame that a frame or joint is attached to; of a link it is empty, the model."""
        element = self.entries[name]
        return {"link": "", "joint": element.text_of("child"), "frame": element.get("attached_to", "")}[element.tag]

    def has(self, name):
        """Whether a name is one of this model, or of the models that are merged into it."""
        merged = (scope for scope in self.models.values() if scope.merged)
        return name in self.entries or name in self.models or any(scope.has(name) for scope in merged)

    def _nested(self, name, where):
        """The scope that a name leads into, and the rest of the name."""
        first, _, rest = name.partition("::")
        if first in self.models and not self.models[first].merged:
            return self.models[first], rest
        for scope in self.models.values():
            if scope.merged and scope.has(first):
                return scope, name
        return fail(where, f"no link, joint or frame is named '{name}'", one_of([*self.entries, *self.models]),
                    "one of another model, or a misspelt name", "Correct the name")

    def model_pose(self, visited=()):
        """The pose of this model's frame in its parent's, which may place another of its frames."""
        include = self.include
        element = self.element if include is None or include.find("pose") is None else include
        pose = self.parent.read_pose(element, "", visited)
        placed = include.text_of("placement_frame") if include is not None else ""
        placed = placed or self.element.get("placement_frame", "")
        return pose @ frames.inverse(self.pose_of(placed, element)) if placed else pose

    def read_pose(self, element, default, visited=()):
        relative = _relative_to(element) or default
        return self.pose_of(relative, element, visited) @ _pose(element)

    def link_of(self, name, where, visited=()):
        """The full name of the link that a frame is attached to."""
        if name == "world":
            return "world"
        visited = _visited(visited, name, where)
        if name in self.entries:
            if self.entries[name].tag == "link":
                return self.prefix() + name
            return self.link_of(self._attached(name) or "__model__", where, visited)
        if name == "__model__":
            return self.canonical(where)
        scope, rest = self._nested(name, where)
        return scope.link_of(rest or "__model__", where)

    def canonical(self, where):
        stated = self.element.get("canonical_link", "")
        if stated:
            return self.link_of(stated, where)
        for name, element in self.entries.items():
            if element.tag == "link":
                return self.prefix() + name
        for scope in self.models.values():
            return scope.canonical(where)
        return fail(where, f"the model '{self.name}' has no link", "a model with a link", "an empty model",
                    "Import another one")

    def prefix(self):
        if self.parent is None or self.parent.parent is None:
            return ""  # names of links begin below the model
        return self.parent.prefix() + ("" if self.merged else self.name + "::")


def _visited(visited, name, where):
    """The names that lead to a frame, with another one."""
    if name in visited or len(visited) > _MAX_CHAIN:
        fail(where, f"the frame '{name}' is relative to itself, or to more than {_MAX_CHAIN} others "
             f"({' -> '.join((*visited[-5:], name))})", "frames without a cycle",
             "a relative_to or attached_to that was mistyped", "Correct it")
    return (*visited, name)


def _relative_to(element):
    pose = element.find("pose")
    return "" if pose is None else pose.get("relative_to") or pose.get("frame") or ""


def _pose(holder):
    """The <pose> of an element, in the frame that it is relative to."""
    element = holder.find("pose")
    if element is None:
        return frames.IDENTITY
    is_quaternion = element.get("rotation_format") == "quat_xyzw"
    numbers = element.numbers("", 7 if is_quaternion else 6, [0.0] * 6)
    position, rotation = numbers[:3], numbers[3:]
    if len(rotation) == 3:
        factor = math.pi / 180 if element.flag("degrees") else 1.0
        return frames.pose(position, frames.from_rpy(*(factor * angle for angle in rotation)))
    turned = frames.from_quaternion((rotation[3], *rotation[:3]))
    if turned is None:
        fail(element, "the quaternion of the pose has the length 0", "x y z and a quaternion x y z w",
             "numbers that are missing", "Correct the pose")
    return frames.pose(position, turned)


class SdfReader:
    def __init__(self, reader, search, report):
        self.reader, self.search, self.report = reader, search, report

    def read(self, root, model_name):
        """The model of this name, or the only one; and the plugins of the world around it."""
        world = root.find("world")
        holder = world if world is not None else root
        candidates = []
        for element in holder.all("model", "include"):
            # Only the include that is wanted is read: others may be missing here.
            name = element.text_of("name") or element.text_of("uri").rstrip("/").split("/")[-1]
            candidates.append((name, element))
        moving = [item for item in candidates if len(candidates) == 1 or not item[1].flag("static")]
        element = choose(root, candidates, moving, model_name, "models")
        scope = self._scope(element, _Scope(holder, ""))
        model = Model(scope.name or "vehicle", element, "SDF", pose=scope.model_pose())
        if element.flag("static") or scope.element.flag("static"):
            self.report.note("the model is static: it is free in the scene", element)
        self._flatten(scope, frames.IDENTITY, model)
        model.canonical = scope.canonical(element)
        self._join_detachable(model)
        model.links_below_joints(self.report)
        if world is not None:
            model.plugins += [Plugin(plugin) for plugin in world.all("plugin")]
            gravity = world.find("gravity")
            if gravity is not None:
                model.gravity, model.gravity_source = gravity.numbers("", 3), gravity.source
        return model

    def _scope(self, element, parent):
        include, name = None, ""
        if element.tag == "include":
            include, name = element, element.text_of("name")
            element = self._included(include)
        scope = _Scope(element, name or element.get("name", ""), parent, include)
        parent.models[scope.name] = scope
        for child in element.all("model", "include"):
            self._scope(child, scope)
        return scope

    def _included(self, include):
        uri = include.text_of("uri")
        found = self.search.find(uri, include, "model")
        root = self.reader.read(model_file(found, include) if found.is_dir() else found, include)
        model = root.find("model")
        if model is None:
            fail(root, "contains no model", "an SDF file with a model", f"'{uri}' names another file",
                 "Correct the uri")
        return model

    def _flatten(self, scope, pose, model):
        """Adds what a scope contains; `pose` is that of its frame in the model."""
        prefix = scope.prefix()
        for element in scope.element.all("link"):
            place = pose @ scope.pose_of(element.get("name"), element)
            model.add(self._link(scope, element, prefix + element.get("name"), place, pose))
        for element in scope.element.all("joint"):
            ends = (
                scope.link_of(element.text_of(end) or element.text_of(f"{end}/link_name"), element)
                for end in ("parent", "child")
            )
            limits = [element.text_of(f"axis/limit/{end}") for end in ("lower", "upper")]
            model.joints.append(read_joint(element, prefix + element.get("name"), *ends, limits))
        for holder in (scope.element, *([scope.include] if scope.include is not None else [])):
            model.plugins += [Plugin(plugin, prefix) for plugin in holder.all("plugin")]
        for inner in scope.models.values():
            self._flatten(inner, pose @ inner.model_pose(), model)

    def _join_detachable(self, model):
        """Adds the joints that a plugin makes at the start, within the model, such as that of a drop weight."""
        for plugin in model.plugins:
            element = plugin.element
            if "DetachableJoint" not in plugin.name or element.text_of("child_model") != "__model__":
                continue
            parent, child = (plugin.prefix + element.text_of(f"{end}_link") for end in ("parent", "child"))
            if parent in model.links and child in model.links:
                model.joints.append(Joint(f"DetachableJoint of {child}", parent, child, True, element))
                self.report.note(f"the model fixes link '{child}' to '{parent}' until it is dropped", element)

    def _link(self, scope, element, name, place, scope_pose):
        link = Link(name, place, element, has_sensor=bool(element.all("sensor")))

        def in_link(child):
            if not _relative_to(child):
                return _pose(child)
            return frames.inverse(place) @ scope_pose @ scope.read_pose(child, "")

        inertial, density = element.find("inertial"), None
        if inertial is None:
            self.report.note(f"the link '{element.get('name')}' has no inertial: SDF gives it 1 kg", link)
            link.inertial = Inertial(1.0, frames.IDENTITY, np.eye(3), element)
        else:
            link.mass_from_geometry = inertial.flag("auto")
            density = inertial.number("density", minimum=0.0)
            if not link.mass_from_geometry:
                link.inertial = read_inertial(inertial, in_link(inertial), 1.0, 1.0)
        report_buoyancy(element, name, self.report)
        for child in element.all("collision", "visual"):
            for geometry in read_geometry(child, in_link(child), child.get("name", child.tag), self.report):
                geometry.density = child.number("density", density, minimum=0.0)
                link.geometry.append(geometry)
        return link


def model_file(folder, element=None):
    """The newest SDF file that the model.config of a folder names; `element` names the folder."""
    config = folder / "model.config"
    if config.exists():
        versions = XmlReader().read(config, element).all("sdf")
        named = [(version.get("version", "0"), version.text.strip()) for version in versions if version.text.strip()]
        if named:
            return folder / max(named, key=lambda pair: [int(n) if n.isdecimal() else 0 for n in pair[0].split(".")])[1]
    if (folder / "model.sdf").exists():
        return folder / "model.sdf"
    return fail(f"{element.where}: {folder}" if element else folder, "has neither model.config nor model.sdf",
                "the folder of an SDF model", "another folder", "Name the model file")
