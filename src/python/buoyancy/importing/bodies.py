"""Which links become a body, and which are left out.

Links that fixed joints connect are one body, whose frame is that of the root link: the one that is no child of such a
joint. A body on a moving joint is left out if it has no volume, or is a propeller or a sensor, unless --keep names it:
then it is a body, or without volume a mass in the body on the other side of its joint.
"""
import re
from dataclasses import dataclass

from .failure import fail, one_of
from .geometry import solid_of

_PROPELLER = re.compile(r"prop(?!erty)|thruster|rotor(?!y)|screw|impeller", re.IGNORECASE)
_SENSOR = re.compile(
    r"sensor|camera|(^|_)imu|(^|_)gps|dvl|lidar|laser|sonar|altimeter|magnetometer|antenna|hydrophone", re.IGNORECASE
)
_MIN_VOLUME = 1e-9  # m^3: what is smaller stands for a link whose shape does not matter
_THRUSTER_PLUGIN = re.compile(r"thrust|motor_?model", re.IGNORECASE)
_DRIVEN = ("joint_name", "jointName", "link_name", "linkName")


@dataclass
class Group:
    root: object  # the link whose frame the body has
    links: list


def group_links(model, options, report):
    """The bodies of a model, in the order of their links."""
    for name in [*options.drop, *options.keep]:
        if name not in model.links:
            fail(model.element, f"no link is named '{name}'", one_of(model.links),
                 "a misspelt name of --drop or --keep", "Correct the option")
    kept = {name: link for name, link in model.links.items() if name not in options.drop}
    for name in options.drop:
        report.leave_out(f"link '{name}': --drop")
    leader = {name: name for name in kept}

    def find(name):
        while leader[name] != name:
            leader[name] = leader[leader[name]]  # so that a long chain is not followed again and again
            name = leader[name]
        return name

    children = set()
    locked = [joint.name for joint in model.joints if joint.locked]
    if locked and not options.links:
        report.note(f"{_joints(locked)} with limits of 0 and 0: fixed")
    for joint in model.joints:
        if "world" in (joint.parent, joint.child) and joint.fixed:
            report.note(f"joint '{joint.name}' fixes the model to the world: it is free in the scene")
        if joint.parent not in kept or joint.child not in kept:
            continue
        link = kept[joint.child]
        if link.name in options.keep and not joint.fixed and not geometry_of(Group(link, [link]), options):
            report.note(f"link '{link.name}': its mass is fixed to '{joint.parent}', with '{joint.name}' at 0")
        elif options.links or not joint.fixed:
            continue
        leader[find(joint.child)] = find(joint.parent)
        children.add(joint.child)
    groups = {}
    for name in kept:
        groups.setdefault(find(name), []).append(name)
    result = []
    for names in groups.values():
        roots = [name for name in names if name not in children]
        root = model.canonical if model.canonical in roots else roots[0]
        result.append(Group(kept[root], [kept[name] for name in names]))
    result = _without_accessories(model, result, options, report)
    body = {link.name: number for number, group in enumerate(result) for link in group.links}
    left = [j.name for j in model.joints if j.parent in body and body[j.parent] != body.get(j.child, body[j.parent])]
    if left:
        report.note(f"{_joints(left)}: the bodies of the scene move freely, your simulator joins them")
    return result


def _joints(names):
    more = f" and {len(names) - 4} more" if len(names) > 4 else ""
    return f"joint{'s' if len(names) > 1 else ''} {', '.join(map(repr, names[:4]))}{more}"


def _without_accessories(model, groups, options, report):
    moving = {joint.child: joint.name for joint in model.joints if not joint.fixed}
    driven = set()
    for plugin in model.plugins:
        if _THRUSTER_PLUGIN.search(plugin.name + plugin.filename):
            driven.update(plugin.prefix + plugin.element.text_of(key) for key in _DRIVEN)
    result, lost = [], 0.0
    for group in groups:
        names = [link.name for link in group.links]
        reason = ""
        if not geometry_of(group, options):
            reason = "has no volume"
            if any(name in options.keep for name in names):
                reason += ", nor what its joint hangs it on"
        elif model.canonical in names or any(name in options.keep for name in names):
            reason = ""
        elif any(name in driven or moving.get(name) in driven for name in names) or _PROPELLER.search(group.root.name):
            reason = "is a propeller"
        elif any(link.has_sensor for link in group.links) or _SENSOR.search(group.root.name):
            reason = "is a sensor"
        if not reason:
            result.append(group)
            continue
        mass = sum(link.inertial.mass for link in group.links if link.inertial)
        lost += mass
        report.leave_out(
            f"link{'s' if len(names) > 1 else ''} {', '.join(map(repr, names))} ({group.root.source}), "
            f"{mass:.6g} kg: {reason}" + ("" if reason.startswith("has no volume") else "; --keep keeps it")
        )
    if lost > 0:
        report.warn(f"the links that are left out have {lost:.6g} kg, which no body of the scene has; --keep adds the "
                    "mass of a link on a joint")
    if not result:
        kind, other = ("visual", "collision") if options.visual else ("collision", "visual")
        option = "without --visual" if options.visual else "with --visual"
        has_other = any(g.visual != options.visual for group in groups for link in group.links for g in link.geometry)
        fail(model.element, f"no body has a volume in its {kind} geometry", "boxes, cylinders or meshes",
             "a model for another purpose",
             f"Import the {other} geometry {option}" if has_other else "Add geometry to its links")
    return result


def geometry_of(group, options):
    """The geometry that displaces water, with its link."""
    return [
        (link, geometry)
        for link in group.links
        for geometry in link.geometry
        if geometry.visual == options.visual
        and (geometry.kind == "mesh" or solid_of(geometry).volume > _MIN_VOLUME)
    ]
