"""Reads URDF. Its inertia has the order Ixx Ixy Ixz Iyy Iyz Izz; plugins are those of <gazebo> elements."""
from . import frames
from .failure import fail, one_of
from .model import Link, Model, Plugin, read_geometry, read_inertial, read_joint, report_buoyancy


def read_urdf(root, report):
    model = Model(root.get("name") or "vehicle", root, "URDF")
    for element in root.all("link"):
        model.add(_link(element, element.get("name", ""), report))
    _place(root, model, report)
    for gazebo in root.all("gazebo"):
        model.plugins += [Plugin(plugin) for plugin in gazebo.all("plugin")]
        link = model.links.get(gazebo.get("reference", ""))
        if link is not None and gazebo.all("sensor"):
            link.has_sensor = True
    return model


def _origin(element):
    position = element.numbers("origin/xyz", 3, [0.0] * 3)
    return frames.pose(position, frames.from_rpy(*element.numbers("origin/rpy", 3, [0.0] * 3)))


def _link(element, name, report):
    link, inertial = Link(name, frames.IDENTITY, element), element.find("inertial")
    if inertial is not None:
        link.inertial = read_inertial(inertial, _origin(inertial), 0.0, 0.0, "mass/value")
    report_buoyancy(element, name, report)
    for child in element.all("collision", "visual"):
        title = child.get("name", f"{child.tag} of {name}")
        link.geometry += read_geometry(child, _origin(child), title, report)
    return link


def _place(root, model, report):
    """Reads the joints and follows them from the root link."""
    children = {}
    for element in root.all("joint"):
        ends = [element.text_of(f"{end}/link") for end in ("parent", "child")]
        for link in ends:
            if link not in model.links:
                fail(element, f"the joint names the link '{link}', which does not exist", one_of(model.links),
                     "a link that was renamed, or a macro not expanded", "Correct the joint")
        if ends[1] in children:
            fail(element, f"the link '{ends[1]}' is the child of two joints", "a tree of links",
                 "a joint that was copied", "Remove one of them")
        children[ends[1]] = element
        missing = "0" if element.find("limit") else ""
        limits = [element.text_of(f"limit/{end}", missing) for end in ("lower", "upper")]
        model.joints.append(read_joint(element, element.get("name", ""), *ends, limits))
    roots = [name for name in model.links if name not in children]
    if len(roots) != 1:
        fail(root, f"has {len(roots)} root links ({', '.join(roots) or 'each is the child of a joint'})",
             "a tree of links with one root", "a joint that is missing, or a cycle", "Connect the links by joints")
    model.canonical = roots[0]
    for name, (joint,) in model.links_below_joints(report):
        model.links[name].pose = model.links[joint.parent].pose @ _origin(joint.element)
