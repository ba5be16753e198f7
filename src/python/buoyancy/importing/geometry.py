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

import numpy as np

from .. import _core
from . import frames
from .failure import ImportFailure, fail, one_of
from .xml_file import XmlReader

SIDES, BANDS = 128, 64
SPHERE_SEGMENTS = 96
_HOLES = 0.01  # share of the volume up to which holes are closed if a mesh does not close otherwise
_LENGTHS = (1e-12, 1e6)  # m, of shapes; --check warns of large ones much earlier
_GRID = 32  # points along each axis of the box in which an overlap is sampled


@dataclass
class Solid:
    """Volume [m^3], centroid [m] and, for a density of 1, inertia about the centroid [m^5], in the geometry's frame."""

    volume: float
    centroid: np.ndarray
    inertia: np.ndarray
    box: np.ndarray  # its two corners


def solid_of(geometry):
    """The solid of a shape, in closed form."""
    size, count = geometry.size, {"box": 3, "ellipsoid": 3, "sphere": 1}.get(geometry.kind, 2)
    if len(size) != count or any(not _LENGTHS[0] < c < _LENGTHS[1] for c in size):
        fail(geometry.element, f"{geometry.kind} '{geometry.name}' has the size {list(size)}",
             f"{count} lengths from {_LENGTHS[0]:g} to {_LENGTHS[1]:g} m", "a size that is missing or in another unit",
             "Correct the model")
    kind, centroid = geometry.kind, np.zeros(3)
    if kind in ("box", "sphere", "ellipsoid"):
        half = size * 3 if kind == "sphere" else tuple(c / 2 for c in size) if kind == "box" else size
        factor, share = (8, 3) if kind == "box" else (4 / 3 * math.pi, 5)
        volume = factor * math.prod(half)
        x, y, z = (volume * c * c / share for c in half)
        moments = (y + z, x + z, x + y)
    else:
        radius, length = size
        half = (radius, radius, length / 2)
        volume = math.pi * radius**2 * length
        axial, across = volume * radius**2 / 2, volume * (3 * radius**2 + length**2) / 12
        if kind == "cone":
            volume, centroid = volume / 3, np.array((0.0, 0.0, -length / 4))
            axial, across = 0.3 * volume * radius**2, volume * (0.15 * radius**2 + 0.0375 * length**2)
        elif kind == "capsule":
            caps = 4 / 3 * math.pi * radius**3
            axial += 0.4 * caps * radius**2
            across += caps * (0.4 * radius**2 + length**2 / 4 + 0.375 * length * radius)
            volume, half = volume + caps, (radius, radius, length / 2 + radius)
        moments = (across, across, axial)
    return Solid(volume, centroid, np.diag(moments), np.array((-np.array(half), half)))


def _surface_of_revolution(rings):
    """Vertices and faces of a surface: rings of SIDES points (radii along x and y, height), closed by two points."""
    around = [2 * math.pi * i / SIDES for i in range(SIDES)]
    vertices = [(rx * math.cos(a), ry * math.sin(a), z) for rx, ry, z in rings[1:-1] for a in around]
    top, last, faces = len(vertices), len(vertices) - SIDES, []
    vertices += [(0, 0, rings[0][2]), (0, 0, rings[-1][2])]
    for i in range(SIDES):
        after = (i + 1) % SIDES
        faces.append((top, i, after))
        for ring in range(0, last, SIDES):
            a, b = ring + i, ring + after
            faces += [(a, a + SIDES, b + SIDES), (a, b + SIDES, b)]
        faces.append((top + 1, last + after, last + i))
    return vertices, faces


def _mesh_of_shape(geometry):
    size = geometry.size
    angles = [math.pi * i / BANDS for i in range(BANDS + 1)]
    if geometry.kind == "ellipsoid":
        return _surface_of_revolution(
            [(size[0] * math.sin(a), size[1] * math.sin(a), size[2] * math.cos(a)) for a in angles]
        )
    radius, length = size
    cap = [(radius * math.sin(a), radius * math.sin(a), length / 2 + radius * math.cos(a)) for a in angles]
    upper = cap[: BANDS // 2 + 1]
    return _surface_of_revolution(upper + [(rx, ry, -z) for rx, ry, z in reversed(upper)])


@dataclass
class Part:
    """A geometry of a body: what the scene file says of it, and its pose in the body's frame."""

    geometry: object
    pose: np.ndarray
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
        part, kind, size = Part(geometry, pose), geometry.kind, geometry.size
        if kind == "mesh":
            self._read_mesh(part)
            return part
        part.solid = solid_of(geometry)
        if kind == "box":
            part.shape = {"type": "box", "size": list(size)}
            return part
        if kind in ("capsule", "ellipsoid"):
            vertices, faces = _mesh_of_shape(geometry)
            lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices]
            lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
            part.contents, part.suffix = "\n".join(lines) + "\n", ".obj"
            part.note = f"{kind} {list(size)} as a mesh of {SIDES} meridians and {BANDS} bands"
            volume = _core.Mesh(vertices, faces).volume
        else:
            height = {} if kind == "sphere" else {"height": size[1]}
            segments = SPHERE_SEGMENTS if kind == "sphere" else SIDES
            part.shape = {"type": kind, "radius": size[0], **height, "segments": segments}
            if kind == "cone":
                part.pose = pose @ frames.pose((0.0, 0.0, -size[1] / 2))
                part.note = "moved by half its height: a cone of a scene has its base at z = 0"
            volume = part.solid.volume * _inscribed_share(kind)
        lack = 100 * (1 - volume / part.solid.volume)
        part.note = f"{part.note or kind}; {volume:.6g} m^3, {lack:.2g} % less than a round one"
        self.report.note(f"{kind}: a polyhedron, with {lack:.1g} % less volume")
        return part

    def _read_mesh(self, part):
        geometry = part.geometry
        part.file, part.scale = self.search.find(geometry.uri, geometry.element, "mesh file"), geometry.size
        if part.file.is_dir() or any(c == 0 for c in part.scale):
            fail(geometry.element, f"the mesh '{geometry.uri}' is a folder, or its scale {list(part.scale)} has a 0",
                 "a mesh file and factors that are not 0", "a uri that was cut off", "Correct the model")
        if geometry.submesh:
            part.contents, part.suffix = _submesh(part.file, geometry), part.file.suffix
            part.note = f"the submesh '{geometry.submesh}' of {part.file.name}"
        key = (part.file, part.scale, geometry.submesh)
        if key not in self._meshes:
            self._meshes[key] = self._load(part)
        part.solid, part.close_holes = self._meshes[key]
        if geometry.center_submesh:
            part.pose = part.pose @ frames.pose(-part.solid.box.sum(axis=0) / 2)
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
            self.report.note(f"mesh '{part.file.name}' has another axis than z up in its file: its coordinates are "
                             "used as they are, as Gazebo does")
        if close_holes is not None:
            self.report.warn(f"mesh '{part.file.name}' is not closed: close_holes = {close_holes} closes its holes; "
                             f"its volume is then {mesh.volume:.6g} m^3")
        return Solid(mesh.volume, mesh.center_of_mass, mesh.inertia, np.array(mesh.bounding_box)), close_holes


def _inscribed_share(kind):
    """The ratio of the volume of a scene's faceted sphere, cylinder or cone to that of the round one."""
    if kind != "sphere":
        return SIDES / (2 * math.pi) * math.sin(2 * math.pi / SIDES)
    # Frusta between n + 2 circles of latitude, each an n-gon.
    n = SPHERE_SEGMENTS
    angles = np.linspace(0, math.pi, n + 2)
    p, q, heights = np.sin(angles[:-1]), np.sin(angles[1:]), -np.diff(np.cos(angles))
    return (heights * (p * p + p * q + q * q)).sum() / 3 * n / 2 * math.sin(2 * math.pi / n) / (4 / 3 * math.pi)


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
        root, names = XmlReader().read(path, geometry.element), []
        titles = {e.get("id"): (e.get("id"), e.get("name")) for e in root.walk() if e.tag == "geometry"}
        if _keep_instances(root, name, titles, names, False):
            return _xml_text(root)
    else:
        return fail(geometry.element, f"<submesh> of '{path.name}'", "a submesh of .obj or .dae",
                    "another format", "Save the submesh as a file of its own")
    return fail(geometry.element, f"'{path.name}' has no submesh '{name}'", one_of(names), "a misspelt name",
                "Correct <submesh>")


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


def _contains(geometry, points):
    """Which of the rows of `points`, in the frame of a shape, the shape contains."""
    kind, size = geometry.kind, geometry.size
    if kind == "box":
        return np.all(2 * abs(points) < size, axis=1)
    if kind in ("sphere", "ellipsoid"):
        return ((points / size) ** 2).sum(axis=1) < 1
    radius, length = size
    z, across = points[:, 2], points[:, 0] ** 2 + points[:, 1] ** 2
    beyond = abs(z) - length / 2
    if kind == "capsule":
        return across + np.maximum(beyond, 0.0) ** 2 < radius**2
    limit = radius if kind == "cylinder" else radius * (0.5 - z / length)
    return (beyond <= 0) & (across < limit**2)


def overlap(a, b):
    """The volume [m^3] that two shapes share, sampled in the box that they share; None for a mesh."""
    if "mesh" in (a.geometry.kind, b.geometry.kind):
        return None
    poses, boxes = [_center(part) for part in (a, b)], []
    for part, pose in zip((a, b), poses):
        corners = np.array([frames.transform(pose, corner) for corner in itertools.product(*part.solid.box.T)])
        boxes.append((corners.min(axis=0), corners.max(axis=0)))
    low, high = np.maximum(boxes[0][0], boxes[1][0]), np.minimum(boxes[0][1], boxes[1][1])
    if np.any(high - low <= 1e-9):
        return 0.0
    axes = [low[i] + (high[i] - low[i]) * (np.arange(_GRID) + 0.5) / _GRID for i in range(3)]
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    inside = [_contains(p.geometry, (points - pose[:3, 3]) @ pose[:3, :3]) for p, pose in zip((a, b), poses)]
    return np.mean(inside[0] & inside[1]) * math.prod(high - low)


def _center(part):
    """The pose of the shape's centre; a cone in a scene has its origin in its base."""
    return part.pose @ frames.pose((0.0, 0.0, part.geometry.size[1] / 2)) if part.geometry.kind == "cone" else part.pose
