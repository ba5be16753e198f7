"""buoyancy-import: turns a vehicle as SDF, URDF or MJCF into a scene file of buoyancyd.

    python3 -m buoyancy.import_model MODEL [-o SCENE.toml]

Reading, grouping, converting and writing have modules of their own in buoyancy.importing; docs/importing.md describes
what becomes of each element. Exit status: 0 success, 1 a file could not be written, 2 the model or the arguments are
wrong.
"""
import argparse
import itertools
import math
import os
import re
import sys
import warnings
from pathlib import Path

import numpy as np

from . import _core
from .importing import bodies, frames, geometry, hydrodynamics, mass, scene_toml, sdf
from .importing.failure import ImportFailure, Report, fail
from .importing.file_search import FileSearch
from .importing.mjcf import MjcfReader
from .importing.model import DEFAULT_DENSITY
from .importing.urdf import read_urdf
from .importing.xml_file import XmlReader

_VOLUME_DIFFERENCE = 1e-3  # share of the volume from which a declared one is a warning
_CENTER_DIFFERENCE = 1e-4  # m
_OVERLAP = 1e-3  # share of the smaller part
_MAX_PAIRS = 200  # of parts whose overlap is computed
_LOADS = (  # tables and keys of the scene, the matrix of each, and its name in a report
    ("body.drag", "linear", "linear", "linear drag"),
    ("body.drag", "quadratic", "quadratic", "quadratic drag"),
    ("body.added_mass", "matrix", "added_mass", "added mass"),
)


class _HelpFormatter(argparse.HelpFormatter):
    """The headings and the width of the other programs' help."""

    def __init__(self, prog):
        super().__init__(prog, max_help_position=30, width=100)

    def add_usage(self, usage, actions, groups, prefix=None):
        super().add_usage(usage, actions, groups, "Usage: ")


def arguments(argv, version):
    parser = argparse.ArgumentParser(
        prog="buoyancy-import",
        usage="buoyancy-import [OPTIONS] MODEL",
        add_help=False,
        description="Turn a vehicle as SDF, URDF or MJCF into a scene file for buoyancyd. The report says what was "
        "changed and what was left out.",
        formatter_class=_HelpFormatter,
    )
    add, names = parser.add_argument_group("Options").add_argument, {"action": "append", "default": []}
    add("-h", "--help", action="help", help="Print this help message and exit")
    version_help = "Display program version information and exit"
    add("--version", action="version", version=f"buoyancy-import {version}", help=version_help)
    positional = "SDF, URDF or MJCF file, or the folder of an SDF model"
    parser.add_argument_group("Positionals").add_argument("model", metavar="MODEL", help=positional)
    add("-o", "--output", metavar="SCENE", help="Scene file to write; default: standard output")
    add("--model", dest="name", metavar="NAME", help="Model of a world file, or body of an MJCF file")
    add("--visual", action="store_true", help="Take the visual geometry, not the collision geometry")
    add("--links", action="store_true", help="Make each link a body, also where joints are fixed")
    add("--drop", **names, metavar="LINK", help="Leave out a link; may be repeated")
    keep = "Keep a link that is taken for a propeller or a sensor, or the mass of one without volume; may be repeated"
    add("--keep", **names, metavar="LINK", help=keep)
    add("--path", **names, metavar="DIR", help="Search models, packages and meshes here too; may be repeated")
    holes = "Close holes of all meshes if hemispheres over them hold at most this share of the volume"
    add("--close-holes", type=float, metavar="SHARE", help=holes)
    return parser.parse_args(argv)


def read_model(options, report):
    """The model, and the search for its files."""
    path = Path(options.model)
    if ".xacro" in path.suffixes:
        fail(path, "is a xacro file", "an expanded URDF", "a description with macros",
             f"Expand it: xacro {path.name} > {path.name.split('.')[0]}.urdf, with its arguments as name:=value")
    if path.is_dir():
        path = sdf.model_file(path)
    reader = XmlReader()
    root = reader.read(path)
    search = FileSearch(path, options.path)
    macro = next((element for element in root.walk() if element.tag.startswith("xacro:")), None)
    if macro is not None:
        fail(macro, "has elements of xacro", "an expanded URDF", "a description with macros",
             f"Expand it: xacro {path.name} > expanded.urdf")
    if root.tag == "robot":
        return read_urdf(root, report), search
    if root.tag in ("sdf", "gazebo"):
        return sdf.SdfReader(reader, search, report).read(root, options.name), search
    if root.tag == "mujoco":
        return MjcfReader(reader, search, report).read(root, options.name), search
    return fail(root, f"the root element is <{root.tag}>", "<sdf>, <robot> or <mujoco>",
                "a file of another kind", "Name the SDF, URDF or MJCF file")


class Importer:
    def __init__(self, options):
        self.options, self.report = options, Report()
        self.folder = Path(options.output).resolve().parent if options.output else Path.cwd()
        self.model, search = read_model(options, self.report)
        self.parts = geometry.PartMaker(search, self.report, options.close_holes)
        self.water = hydrodynamics.Hydrodynamics(self.model, self.report)
        self.text = scene_toml.SceneText()
        self.files = {}  # of meshes to write: name, contents
        self.bodies = []  # the names of the links of each

    def write(self):
        """Writes the scene and its meshes, with the warnings of whoever opens it."""
        self._write_scene()
        for name, contents in self.files.items():
            (self.folder / name).parent.mkdir(exist_ok=True)
            (self.folder / name).write_text(contents, encoding="utf-8")
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            try:
                _core.Scene.from_text(str(self.text), self.folder)
            except _core.Error as error:
                raise ImportFailure(
                    f"{self.model.element.where}: the scene that it becomes is refused: {error}{self._origin_of(error)}"
                ) from None
        for warning in found:
            self.report.warn(str(warning.message).replace("Scene.from_text(): ", "", 1))
        self.text.comment("")
        for title, sentences in (("Warnings", self.report.warnings), ("Not converted", self.report.not_converted)):
            self.text.comment(f"{title}:" if sentences else f"{title}: nothing")
            for sentence in sentences:
                self.text.comment(f"- {sentence}")
        if self.options.output:
            Path(self.options.output).write_text(str(self.text), encoding="utf-8")
        else:
            print(self.text, end="")

    def _origin_of(self, error):
        """Where the value is from that an error about the scene names: a comment of its line, or before it."""
        number = re.match(r"Scene\.from_text\(\):(\d+)", str(error))
        lines = str(self.text).splitlines()[: int(number.group(1))] if number else []
        comments = [line for line in lines if re.search(r"#.*\w:\d", line)]
        return f" The value is from: {comments[-1]}" if comments else ""

    def _write_scene(self):
        model = self.model
        self.text.comment(f"{model.name}: from {Path(self.options.model).name} ({model.format}) by buoyancy-import.")
        self._write_world()
        for number, group in enumerate(bodies.group_links(model, self.options, self.report), 1):
            self._write_body(number, group)
        imported = {link for body in self.bodies for link in body}
        for coefficients in self.water.coefficients:
            if coefficients.link not in imported:
                self.report.leave_out(f"coefficients of the link '{coefficients.link}', which is no body", coefficients)

    def _write_world(self):
        text, water, gravity, source = self.text, self.water.water, self.model.gravity, self.model.gravity_source
        if gravity is not None and any(gravity):
            length = math.hypot(*gravity)  # right for the smallest numbers, too
            text.table("world")
            text.key("gravity", length, f"m/s^2, {source}")
            text.key("up", scene_toml.vector([-c / length for c in gravity]), f"against gravity, {source}")
        elif gravity is not None:
            self.report.leave_out(f"gravity 0 ({source}): the scene has its default")
        text.table("water")
        value, source = water.get("density", (1025.0, "not stated by the model: sea water"))
        text.key("density", value, f"kg/m^3, {source}")
        if "level" in water:
            text.key("level", water["level"][0], f"m, {water['level'][1]}")
        for below, density, of in self.water.layers:
            text.table("[[water.layer]]")
            text.key("below", below, f"m, {of}")
            text.key("density", density, "kg/m^3")
        if "current" in water:
            text.table("water.current")
            text.key("velocity", scene_toml.vector(water["current"][0]), f"m/s, {water['current'][1]}")
        if self.water.waves is not None:
            components, source = self.water.waves
            text.table("[[water.waves]]")
            text.key("type", "components", f"the waves of the wavefield, {source}")
            names = ("amplitude", "angular_frequency", "direction", "phase")
            rows = ",\n  ".join(scene_toml.text(dict(zip(names, map(float, component)))) for component in components)
            text.lines.append(f"components = [  # m, rad/s, degrees towards which they run\n  {rows}]")

    def _write_body(self, number, group):
        text, model, root = self.text, self.model, group.root
        inverse = frames.inverse(root.pose)
        poses = {link.name: inverse @ link.pose for link in group.links}
        self.bodies.append(list(poses))
        name = model.name if root.name == model.canonical else f"{model.name} {root.name}"
        parts = [
            (link, self.parts.part(shape, poses[link.name] @ shape.pose))
            for link, shape in bodies.geometry_of(group, self.options)
        ]
        loads = [c for c in self.water.coefficients if c.link in poses]

        text.table("[[body]]")
        text.key("id", number, "numbered in the order of the model")
        text.key("name", name, f"its frame is that of the link '{root.name}', {root.source}")
        if len(group.links) > 1:
            text.comment("one body of the links " + ", ".join(poses))
        if loads:
            text.key("outputs", ["wrench", "loads"], "it has coefficients")
        for index, (link, part) in enumerate(parts):
            self._write_part(number, index, link, part)
        self._check_overlaps([part for _, part in parts], name)
        self._check_declared(parts, poses, name)
        if loads:
            self._write_loads(loads, poses)
        self._write_client(group, poses, name)

    def _write_part(self, number, index, link, part):
        text, shape = self.text, part.geometry
        text.table("[[body.part]]")
        text.key("name", shape.name, f"{'visual' if shape.visual else 'collision'} of '{link.name}', {shape.source}")
        if part.shape:
            text.key("shape", part.shape, part.note or f"{shape.kind}, {shape.source}")
        else:
            entry = {"file": self._mesh_file(number, index, part)}
            if part.scale != (1.0, 1.0, 1.0):
                entry["scale"] = list(part.scale)
            text.key("mesh", entry, part.note or f"{shape.uri}, {shape.source}")
            if part.close_holes is not None:
                text.key("close_holes", part.close_holes, "without it the mesh is not closed")
        if part.pose[:3, 3].any():
            position = scene_toml.vector(part.pose[:3, 3])
            text.key("position", position, f"m, in the frame of the body, {shape.source}")
        orientation = scene_toml.vector(frames.quaternion(part.pose[:3, :3]))
        if orientation[0] != 1:
            text.key("orientation", orientation, f"w, x, y, z, {shape.source}")

    def _mesh_file(self, number, index, part):
        if not part.contents:
            return os.path.relpath(part.file.resolve(), self.folder)
        if not self.options.output:
            fail(part.geometry.element,
                 f"{part.geometry.kind} '{part.geometry.name}' becomes a mesh file beside the scene",
                 "the name of a scene file", "the scene on standard output", "Name it with -o SCENE.toml")
        name = f"{Path(self.options.output).stem}.d/body{number}_part{index}{part.suffix}"
        self.files[name] = part.contents
        return name

    def _masses(self, link, pose):
        """The masses of a link: that of its inertial, or those of its geometry."""
        if not link.mass_from_geometry:
            return [mass.of_link(link, pose, self.report)] if link.inertial else []
        masses = []
        for shape in link.geometry:
            if not shape.visual or self.model.format != "SDF":
                solid = self.parts.part(shape, frames.IDENTITY).solid
                density = DEFAULT_DENSITY if shape.density is None else shape.density
                density = density if shape.mass is None else shape.mass / solid.volume
                masses.append(mass.of_solid(solid, density, pose @ shape.pose))
        return masses

    def _write_client(self, group, poses, name):
        text, model = self.text, self.model
        total = mass.total([m for link in group.links for m in self._masses(link, poses[link.name])])
        text.table("body.client")
        if total is None:
            self.report.warn(f"body '{name}' has no mass: buoyancy-client takes half the density of the water")
        else:
            heavy = [link for link in group.links if link.inertial or link.mass_from_geometry]
            sources = [(link.inertial or link).source for link in heavy]
            more = f" and {len(sources) - 4} more" if len(sources) > 4 else ""
            text.key("mass", total.mass, f"kg, {' + '.join(sources[:4])}{more}")
            text.key("center_of_mass", scene_toml.vector(total.center), "m, in the frame of the body")
            rows, columns = (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)
            entries = scene_toml.vector(total.inertia[rows, columns])
            if total.possible:
                entries = entries if any(entries[3:]) else entries[:3]
                text.key("inertia", entries, "kg m^2, about the centre of mass, in the axes of the body")
            else:
                found = ", ".join(f"{entry:.6g}" for entry in entries)
                self.report.leave_out(f"inertia [{found}] of '{name}': the scene has that of its volume")
        pose = model.pose @ group.root.pose
        text.key("position", scene_toml.vector(pose[:3, 3]), f"m, {model.source}")
        orientation = scene_toml.vector(frames.quaternion(pose[:3, :3]))
        text.key("orientation", orientation, f"w, x, y, z, {model.source}")

    def _write_loads(self, loads, poses):
        center, sums = poses[loads[0].link][:3, 3], {matrix: np.zeros((6, 6)) for matrix in hydrodynamics.MATRICES}
        for coefficients in loads:
            pose = poses[coefficients.link]
            offset, rotation = pose[:3, 3] - center, pose[:3, :3] @ coefficients.rotation
            if coefficients.matrices["quadratic"].any() and offset.any():
                self.report.warn(f"the quadratic drag of '{coefficients.link}' is moved to another centre as a matrix, "
                                 "which is an approximation", coefficients)
            for name, matrix in coefficients.matrices.items():
                sums[name] += frames.moved_6(frames.turned_6(matrix, rotation), offset)
        changed = "; ".join(dict.fromkeys(c.changed for c in loads))
        keys = []
        for table, key, name, what in _LOADS:
            source = ", ".join(dict.fromkeys(c.source_of(name) for c in loads if c.matrices[name].any()))
            matrix = hydrodynamics.admissible(sums[name], what, source, self.report, name == "added_mass")
            if matrix.any():
                keys.append((table, key, matrix, f"{changed}; {source}"))
        immersion = "none" if any(c.immersion == "none" for c in loads) else "volume"
        if immersion != "none":
            self.report.note("the coefficients are scaled by the submerged share of the volume; if they were measured "
                             'afloat, set immersion = "none"')
        for table, rows in itertools.groupby(keys, lambda row: row[0]):
            self.text.table(table)
            for _, key, matrix, comment in rows:
                self.text.key(key, scene_toml.coefficients(matrix), comment)
            self.text.key("center", scene_toml.vector(center), "m, the origin of the link")
            self.text.key("immersion", immersion, "what scales them where the body is partly out of the water")

    def _check_overlaps(self, parts, name):
        found, unknown = [], False
        for a, b in itertools.islice(itertools.combinations(parts, 2), _MAX_PAIRS):
            volume, smaller = geometry.overlap(a, b), min(a.solid.volume, b.solid.volume)
            unknown = unknown or volume is None
            if volume is not None and volume > _OVERLAP * smaller:
                share = f"({100 * volume / smaller:.3g} % of the smaller)"
                found.append((volume, f"'{a.geometry.name}' and '{b.geometry.name}' by {volume:.4g} m^3 {share}"))
        if found:
            found.sort(reverse=True)
            more = f", and {len(found) - 5} more pairs" if len(found) > 5 else ""
            self.report.warn(f"body '{name}': parts overlap: {', '.join(text for _, text in found[:5])}{more}; "
                             f"{sum(volume for volume, _ in found):.4g} m^3 in all. The scene displaces this water "
                             "twice: take it out of the model")
        if unknown:
            self.report.note(f"body '{name}' has several parts with meshes: buoyancyd --check reports whether they "
                             "overlap")

    def _check_declared(self, parts, poses, name):
        """Compares the volumes and centres of buoyancy that plugins declare with those of the geometry."""
        for declared in self.water.declared:
            if declared.link not in poses:
                continue
            own = [part for link, part in parts if link.name == declared.link] or [part for _, part in parts]
            volume = sum(part.solid.volume for part in own)
            if declared.volume is not None and abs(declared.volume - volume) > _VOLUME_DIFFERENCE * volume:
                self.report.warn(f"body '{name}': the model declares a volume of {declared.volume:.6g} m^3, its "
                                 f"geometry has {volume:.6g} m^3 ({100 * (volume / declared.volume - 1):+.3g} %). The "
                                 "scene uses the geometry: scaling lengths by "
                                 f"{(declared.volume / volume) ** (1 / 3):.5g} would match", declared)
            if declared.center is None:
                continue
            centroid = sum(p.solid.volume * frames.transform(p.pose, p.solid.centroid) for p in own) / volume
            center = frames.transform(poses[declared.link], declared.center)
            if math.dist(center, centroid) > _CENTER_DIFFERENCE:
                values = [", ".join(f"{c:.5g}" for c in scene_toml.vector(p)) for p in (center, centroid)]
                self.report.warn(f"body '{name}': the model declares the centre of buoyancy ({values[0]}) m, that of "
                                 f"its geometry is ({values[1]}) m. The scene uses the geometry", declared)


def _count(number, one, many):
    return f"{number} {one if number == 1 else many}"


def print_report(importer, target):
    report, model, output = importer.report, importer.model, importer.options.output
    links, count = _count(len(model.links), "link", "links"), _count(len(importer.bodies), "body", "bodies")
    lines = [f"{model.name}: {model.format}, {links}, {count}"]
    lines += [f"note: {sentence}" for sentence in report.notes]
    lines += [f"warning: {sentence}" for sentence in report.warnings]
    lines.append(f"not converted: {len(report.not_converted) or 'nothing'}")
    lines += [f"  - {sentence}" for sentence in report.not_converted]
    if output:
        lines.append(f"written: {output}; see how it floats: buoyancyd --scene {output} --check")
    print("\n".join(lines), file=target)


def main(argv=None, version="of the Python package buoyancy"):
    options = arguments(argv, version)
    try:
        importer = Importer(options)
        importer.write()
        print_report(importer, sys.stdout if options.output else sys.stderr)
        return 0
    except ImportFailure as failure:
        status, text = 2, str(failure)
    except (ArithmeticError, LookupError, RecursionError, TypeError, ValueError) as error:
        status = 2
        text = (
            f"{options.model}: cannot be imported ({type(error).__name__}: {error}); expected a valid model. Likely "
            "cause: an element with a value of another kind. Check the model with the tool of its format (gz sdf "
            "--check, check_urdf, MuJoCo's compile)."
        )
    except OSError as error:
        status, text = 1, f"{error.filename}: cannot be written: {error.strerror}"
    print(f"buoyancy-import: {' '.join(text.split())}", file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
