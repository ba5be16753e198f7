"""Reads URDF. Its inertia has the order Ixx Ixy Ixz Iyy Iyz Izz; plugins are those of <gazebo> elements."""
from . import frames
from .failure import fail
from .model import Geometry, Inertial, Joint, Link, Model, Plugin, is_locked, report_buoyancy


def read_urdf(root, report):
    model = Model(root.get("name", "vehicle"), root.source, "URDF")
    for element in root.all("link"):
        name = element.get("name", "")
        if name in model.links:
            fail(element.where, f"two links are named '{name}'", "names that differ",
                 "a macro that was used twice", "Rename one")
        model.links[name] = _link(element, name, report)
    _place(root, model)
    for gazebo in root.all("gazebo"):
        for plugin in gazebo.all("plugin"):
            model.plugins.append(Plugin(plugin.get("name", ""), plugin.get("filename", ""), plugin))
        link = model.links.get(gazebo.get("reference", ""))
        if link is not None and gazebo.all("sensor"):
            link.has_sensor = True
    return model


def _origin(element):
    origin = element.find("origin")
    if origin is None:
        return frames.IDENTITY
    return (
        tuple(origin.attribute_numbers("xyz", 3, [0.0] * 3)),
        frames.from_rpy(*origin.attribute_numbers("rpy", 3, [0.0] * 3)),
    )


def _link(element, name, report):
    link = Link(name, frames.IDENTITY, element.source)
    inertial = element.find("inertial")
    if inertial is not None:
        mass, inertia = inertial.find("mass"), inertial.find("inertia")
        value = 0.0 if mass is None else mass.attribute_numbers("value", 1, [0.0])[0]
        entry = {
            key: 0.0 if inertia is None else inertia.attribute_numbers(key, 1, [0.0])[0]
            for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        }
        pose = _origin(inertial)
        link.inertial = Inertial(
            value,
            pose[0],
            pose[1],
            [
                [entry["ixx"], entry["ixy"], entry["ixz"]],
                [entry["ixy"], entry["iyy"], entry["iyz"]],
                [entry["ixz"], entry["iyz"], entry["izz"]],
            ],
            inertial.source,
        )
    report_buoyancy(element, name, report)
    for child in element.all("collision", "visual"):
        geometry = child.find("geometry")
        shape = None if geometry is None else next(iter(geometry.children), None)
        if shape is None:
            continue
        common = {
            "pose": _origin(child),
            "name": child.get("name", f"{child.tag} of {name}"),
            "source": child.source,
            "element": child,
            "visual": child.tag == "visual",
        }
        if shape.tag == "mesh":
            scale = shape.attribute_numbers("scale", (1, 3), [1.0])
            link.geometry.append(
                Geometry("mesh", tuple(scale * (3 if len(scale) == 1 else 1)), uri=shape.get("filename", ""), **common)
            )
        elif shape.tag == "box":
            link.geometry.append(Geometry("box", tuple(shape.attribute_numbers("size", 3, [0.0] * 3)), **common))
        elif shape.tag == "sphere":
            link.geometry.append(Geometry("sphere", tuple(shape.attribute_numbers("radius", 1, [0.0])), **common))
        elif shape.tag in ("cylinder", "capsule"):
            size = shape.attribute_numbers("radius", 1, [0.0]) + shape.attribute_numbers("length", 1, [0.0])
            link.geometry.append(Geometry(shape.tag, tuple(size), **common))
        else:
            report.leave_out(f"{child.tag} of '{name}': <{shape.tag}> is no shape of URDF ({child.source})")
    return link


def _place(root, model):
    """Reads the joints and follows them from the root link."""
    origins, children = {}, {}
    for element in root.all("joint"):
        ends = [
            element.find(tag).get("link", "") if element.find(tag) is not None else "" for tag in ("parent", "child")
        ]
        for link in ends:
            if link not in model.links:
                fail(element.where,
                     f"the joint '{element.get('name')}' names the link '{link}', which does not exist",
                     f"one of: {', '.join(model.links) or 'none'}",
                     "a link that was renamed, or a macro not expanded", "Correct the joint")
        if ends[1] in origins:
            fail(element.where, f"the link '{ends[1]}' is the child of two joints", "a tree of links",
                 "a joint that was copied", "Remove one of them")
        origins[ends[1]] = _origin(element)
        children.setdefault(ends[0], []).append(ends[1])
        kind, limit = element.get("type", ""), element.find("limit")
        limits = () if limit is None else (limit.get("lower", "0"), limit.get("upper", "0"))
        locked = is_locked(kind, *limits)
        model.joints.append(Joint(element.get("name", ""), *ends, kind == "fixed" or locked, locked))
    roots = [name for name in model.links if name not in origins]
    if len(roots) != 1:
        fail(root.where, f"has {len(roots)} root links ({', '.join(roots) or 'each is the child of a joint'})",
             "a tree of links with one root", "a joint that is missing, or a cycle",
             "Connect the links by joints")
    model.canonical = roots[0]
    waiting = [roots[0]]
    while waiting:
        parent = waiting.pop()
        for child in children.get(parent, []):
            model.links[child].pose = frames.compose(model.links[parent].pose, origins[child])
            waiting.append(child)
