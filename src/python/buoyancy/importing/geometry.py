"""Volumes, centroids and inertias of shapes and meshes, and meshes of the shapes that a scene file lacks.

A capsule and an ellipsoid become OBJ files beside the scene, as polyhedra inscribed in them: SIDES meridians, and BANDS
bands of latitude, half of them on each cap of a capsule. What they lack in volume is in the report.
"""
import itertools
import math
import tempfile
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Optional
from xml.sax.saxutils import escape, quoteattr

from .. import _core
from . import frames
from .failure import ImportFailure, fail
from .xml_file import XmlReader

SIDES, BANDS = 128, 64
SPHERE_SEGMENTS = 96
_HOLES = 0.01  # share of the volume up to which holes are closed if a mesh does not close otherwise
_MAX_LENGTH = 1e6  # m, of a shape; --check warns much earlier
_GRID = 32  # points along each axis of the box in which an overlap is sampled


@dataclass
class Solid:
    """Volume [m^3], centroid [m] and, for a density of 1, inertia about the centroid [m^5], in the geometry's frame."""

    volume: float
    centroid: tuple
    inertia: list
    low: tuple  # corners of its box
    high: tuple


def solid_of(geometry):
    """The solid of a shape, in closed form."""
    size, count = geometry.size, {"box": 3, "ellipsoid": 3, "sphere": 1}.get(geometry.kind, 2)
    if len(size) != count or any(not 0 < c < _MAX_LENGTH for c in size):
        fail(geometry.element.where, f"{geometry.kind} '{geometry.name}' has the size {list(size)}",
             f"{count} lengths above 0, in m", "a size that is missing or in another unit", "Correct the model")
    kind, centroid = geometry.kind, (0.0, 0.0, 0.0)
    if kind == "box":
        volume, half = math.prod(size), tuple(c / 2 for c in size)
        x, y, z = (volume * c * c / 12 for c in size)
        moments = (y + z, x + z, x + y)
    elif kind in ("sphere", "ellipsoid"):
        half = size if kind == "ellipsoid" else size * 3
        volume = 4 / 3 * math.pi * math.prod(half)
        x, y, z = (volume * c * c / 5 for c in half)
        moments = (y + z, x + z, x + y)
    else:
        radius, length = size
        half = (radius, radius, length / 2)
        volume = math.pi * radius**2 * length
        axial, across = volume * radius**2 / 2, volume * (3 * radius**2 + length**2) / 12
        if kind == "cone":
            volume, centroid = volume / 3, (0.0, 0.0, -length / 4)
            axial, across = 0.3 * volume * radius**2, volume * (0.15 * radius**2 + 0.0375 * length**2)
        elif kind == "capsule":
            caps = 4 / 3 * math.pi * radius**3
            axial += 0.4 * caps * radius**2
            across += caps * (0.4 * radius**2 + length**2 / 4 + 0.375 * length * radius)
            volume, half = volume + caps, (radius, radius, length / 2 + radius)
        moments = (across, across, axial)
    inertia = [[moments[i] if i == j else 0.0 for j in range(3)] for i in range(3)]
    return Solid(volume, centroid, inertia, tuple(-c for c in half), half)


def _surface_of_revolution(rings):
    """OBJ text of a surface: rings of SIDES points (radii along x and y, height), closed by a point at both ends."""
    lines, top, bottom = [], rings[0][2], rings[-1][2]
    for rx, ry, z in rings[1:-1]:
        for i in range(SIDES):
            angle = 2 * math.pi * i / SIDES
            lines.append(f"v {rx * math.cos(angle)!r} {ry * math.sin(angle)!r} {z!r}")
    lines += [f"v 0 0 {top!r}", f"v 0 0 {bottom!r}"]
    count = len(rings) - 2
    for i in range(SIDES):
        after = (i + 1) % SIDES
        lines.append(f"f {count * SIDES + 1} {i + 1} {after + 1}")
        for ring in range(count - 1):
            a, b = ring * SIDES + i + 1, ring * SIDES + after + 1
            lines += [f"f {a} {a + SIDES} {b + SIDES}", f"f {a} {b + SIDES} {b}"]
        last = (count - 1) * SIDES
        lines.append(f"f {count * SIDES + 2} {last + after + 1} {last + i + 1}")
    return "\n".join(lines) + "\n"


def _mesh_of_shape(geometry):
    size = geometry.size
    if geometry.kind == "ellipsoid":
        angles = [math.pi * i / BANDS for i in range(BANDS + 1)]
        return _surface_of_revolution(
            [(size[0] * math.sin(a), size[1] * math.sin(a), size[2] * math.cos(a)) for a in angles]
        )
    radius, length = size
    rings = []
    for sign in (1, -1):
        cap = [math.pi * i / BANDS for i in range(BANDS // 2 + 1)]
        ring = [(radius * math.sin(a),) * 2 + (sign * (length / 2 + radius * math.cos(a)),) for a in cap]
        rings += ring if sign > 0 else ring[::-1]
    return _surface_of_revolution(rings)


@dataclass
class Part:
    """A geometry of a body: what the scene file says of it, and its pose in the body's frame."""

    geometry: object
    pose: tuple
    shape: Optional[dict] = None  # of a shape
    file: Optional[Path] = None  # of a mesh
    contents: str = ""  # of a mesh that is written beside the scene
    suffix: str = ""  # of its name
    scale: tuple = (1.0, 1.0, 1.0)
    close_holes: Optional[float] = None
    solid: Optional[Solid] = None
    note: str = ""


class PartMaker:
    """Makes the parts of bodies; a mesh that several use is read once."""

    def __init__(self, search, report, close_holes):
        self.search, self.report, self.close_holes = search, report, close_holes
        self._meshes = {}

    def part(self, geometry, pose):
        part = Part(geometry, pose)
        size = geometry.size
        if geometry.kind == "mesh":
            self._read_mesh(part)
            return part
        part.solid = solid_of(geometry)
        if geometry.kind == "box":
            part.shape = {"type": "box", "size": list(size)}
        elif geometry.kind == "sphere":
            part.shape = {"type": "sphere", "radius": size[0], "segments": SPHERE_SEGMENTS}
        elif geometry.kind in ("cylinder", "cone"):
            part.shape = {"type": geometry.kind, "radius": size[0], "height": size[1], "segments": SIDES}
            if geometry.kind == "cone":  # whose base is at z = 0 in a scene
                part.pose = frames.compose(pose, ((0.0, 0.0, -size[1] / 2), frames.IDENTITY[1]))
                part.note = "moved by half its height: a cone of a scene has its base at z = 0"
        else:
            part.contents, part.suffix = _mesh_of_shape(geometry), ".obj"
            part.note = f"{geometry.kind} {list(size)} as a mesh of {SIDES} meridians and {BANDS} bands"
        if geometry.kind in ("capsule", "ellipsoid"):
            self._note_volume(part, self._volume_of_text(part.contents))
        elif geometry.kind != "box":
            self._note_volume(part, part.solid.volume * _inscribed_share(geometry.kind))
        return part

    def _note_volume(self, part, volume):
        kind, share = part.geometry.kind, 1 - volume / part.solid.volume
        part.note = f"{part.note or kind}; {volume:.6g} m^3, {100 * share:.2g} % less than a round one"
        self.report.note(f"{kind}: a polyhedron, with {100 * share:.1g} % less volume")

    @staticmethod
    def _volume_of_text(text):
        vertices, faces = [], []
        for line in text.splitlines():
            kind, *words = line.split()
            (vertices if kind == "v" else faces).append([float(w) if kind == "v" else int(w) - 1 for w in words])
        return _core.Mesh(vertices, faces).volume

    def _read_mesh(self, part):
        geometry = part.geometry
        part.file, part.scale = self.search.find(geometry.uri, geometry.element, "mesh file"), geometry.size
        if part.file.is_dir() or any(c == 0 for c in part.scale):
            fail(geometry.element.where,
                 f"the mesh '{geometry.uri}' is a folder, or its scale {list(part.scale)} has a " "0",
                 "a mesh file and factors that are not 0", "a uri that was cut off", "Correct the model")
        if geometry.submesh:
            part.contents, part.suffix = _submesh(part.file, geometry), part.file.suffix
            part.note = f"the submesh '{geometry.submesh}' of {part.file.name}"
        key = (part.file, part.scale, geometry.submesh)
        if key not in self._meshes:
            self._meshes[key] = self._load(part)
        part.solid, part.close_holes = self._meshes[key]
        if geometry.center_submesh:
            middle = tuple(-(a + b) / 2 for a, b in zip(part.solid.low, part.solid.high))
            part.pose = frames.compose(part.pose, (middle, frames.IDENTITY[1]))
            part.note += ", its box centred"

    def _load(self, part):
        path = part.file
        with tempfile.TemporaryDirectory() as folder:
            if part.contents:
                path = Path(folder) / ("submesh" + part.suffix)
                path.write_text(part.contents, encoding="utf-8")
            for close_holes in (None, _HOLES if self.close_holes is None else self.close_holes):
                try:
                    with warnings.catch_warnings(record=True) as caught:
                        warnings.simplefilter("always")
                        mesh = _core.Mesh(path, scale=list(part.scale), close_holes=close_holes)
                    break
                except _core.InputError as error:
                    failure = error
            else:
                raise ImportFailure(
                    f"{part.geometry.element.where}: {failure} With larger holes to close: "
                    "--close-holes SHARE; the other geometry of the links: --visual; without this "
                    "link: --drop LINK."
                ) from None
        if caught:  # the only warning of a mesh alone: its file has another axis up
            self.report.note(
                f"mesh '{part.file.name}' has another axis than z up in its file: its coordinates are used as they "
                "are, as Gazebo does"
            )
        if close_holes is not None:
            self.report.warn(
                f"mesh '{part.file.name}' is not closed: close_holes = {close_holes} closes its holes; "
                f"its volume is then {mesh.volume:.6g} m^3"
            )
        low, high = mesh.bounding_box
        solid = Solid(
            mesh.volume,
            tuple(map(float, mesh.center_of_mass)),
            [[float(mesh.inertia[i][j]) for j in range(3)] for i in range(3)],
            tuple(map(float, low)),
            tuple(map(float, high)),
        )
        return solid, close_holes


def _inscribed_share(kind):
    """The ratio of the volume of a scene's faceted sphere, cylinder or cone to that of the round one."""
    if kind != "sphere":
        return SIDES / (2 * math.pi) * math.sin(2 * math.pi / SIDES)
    # Frusta between n + 2 circles of latitude, each an n-gon.
    n, volume = SPHERE_SEGMENTS, 0.0
    angles = [math.pi * i / (n + 1) for i in range(n + 2)]
    for a, b in zip(angles, angles[1:]):
        p, q = math.sin(a), math.sin(b)
        volume += (math.cos(a) - math.cos(b)) * (p * p + p * q + q * q) / 3
    return volume * n / 2 * math.sin(2 * math.pi / n) / (4 / 3 * math.pi)


def _submesh(path, geometry):
    """The text of a mesh file with one mesh alone: by object or group of OBJ, by node or geometry of Collada."""
    name, suffix = geometry.submesh, path.suffix.lower()
    if suffix == ".obj":
        kept, found, names = [], False, []
        current = ""
        for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
            words = line.split()
            if words and words[0] in ("o", "g"):
                current = " ".join(words[1:])
                names.append(current)
            elif words and words[0] in ("v", "f") and (words[0] == "v" or current == name):
                kept.append(line)
                found = found or words[0] == "f"
        if found:
            return "\n".join(kept) + "\n"
    elif suffix == ".dae":
        root, names = XmlReader().read(path), []
        titles = {e.get("id"): (e.get("id"), e.get("name")) for e in root.walk() if e.tag == "geometry"}
        if _keep_instances(root, name, titles, names, False):
            return _xml_text(root)
    else:
        return fail(geometry.element.where, f"<submesh> of '{path.name}'", "a submesh of .obj or .dae",
                    "another format", "Save the submesh as a file of its own")
    return fail(geometry.element.where, f"'{path.name}' has no submesh '{name}'",
                f"one of: {', '.join(names) or 'none'}", "a misspelt name", "Correct <submesh>")


def _keep_instances(element, name, titles, names, chosen):
    """Removes the instances of geometry but those of this name; returns whether any is left."""
    if element.tag == "node":
        own = (element.get("id"), element.get("name"))
        names += [title for title in own if title]
        chosen = chosen or name in own
    kept, found = [], False
    for child in element.children:
        if child.tag == "instance_geometry":
            of_geometry = titles.get(child.get("url", "").lstrip("#"), ())
            names += [title for title in of_geometry if title]
            if not chosen and name not in of_geometry:
                continue
            found = True
        found = _keep_instances(child, name, titles, names, chosen) or found
        kept.append(child)
    element.children = kept
    return found


def _xml_text(element):
    attributes = "".join(f" {key}={quoteattr(value)}" for key, value in element.attributes.items())
    inside = escape(element.text) + "".join(map(_xml_text, element.children))
    return f"<{element.tag}{attributes}>{inside}</{element.tag}>"


def _contains(part, point):
    """Whether a shape contains a point in its own frame."""
    x, y, z = point
    kind, size = part.geometry.kind, part.geometry.size
    if kind == "box":
        return all(2 * abs(c) < s for c, s in zip(point, size))
    if kind == "sphere":
        return x * x + y * y + z * z < size[0] ** 2
    if kind == "ellipsoid":
        return sum((c / s) ** 2 for c, s in zip(point, size)) < 1
    radius, length = size
    beyond = abs(z) - length / 2
    if kind == "capsule":
        return x * x + y * y + max(beyond, 0.0) ** 2 < radius**2
    if beyond > 0:
        return False
    limit = radius if kind == "cylinder" else radius * (0.5 - z / length)
    return x * x + y * y < limit**2


def overlap(a, b):
    """The volume [m^3] that two shapes share, sampled on a grid unless both are boxes along the axes; None for a mesh."""
    if "mesh" in (a.geometry.kind, b.geometry.kind):
        return None
    boxes = []
    for part in (a, b):
        corners = [
            frames.transform(_shape_pose(part), corner)
            for corner in itertools.product(*zip(part.solid.low, part.solid.high))
        ]
        boxes.append(([min(c[i] for c in corners) for i in range(3)], [max(c[i] for c in corners) for i in range(3)]))
    low = [max(box[0][i] for box in boxes) for i in range(3)]
    high = [min(box[1][i] for box in boxes) for i in range(3)]
    if any(h - l <= 1e-9 for l, h in zip(low, high)):
        return 0.0
    if all(part.geometry.kind == "box" and frames.is_right_angled(part.pose[1]) for part in (a, b)):
        return math.prod(h - l for l, h in zip(low, high))
    axes = [[l + (h - l) * (i + 0.5) / _GRID for i in range(_GRID)] for l, h in zip(low, high)]
    inverses = [(p[0], frames.matrix(frames.conjugate(p[1]))) for p in map(_shape_pose, (a, b))]
    inside = 0
    for point in itertools.product(*axes):
        for part, (origin, rotation) in zip((a, b), inverses):
            offset = frames.subtract(point, origin)
            if not _contains(part, [sum(r * c for r, c in zip(row, offset)) for row in rotation]):
                break
        else:
            inside += 1
    return inside / _GRID**3 * math.prod(h - l for l, h in zip(low, high))


def _shape_pose(part):
    """The pose of the shape's centre; a cone in a scene has its origin in its base."""
    if part.geometry.kind != "cone":
        return part.pose
    return frames.compose(part.pose, ((0.0, 0.0, part.geometry.size[1] / 2), frames.IDENTITY[1]))
