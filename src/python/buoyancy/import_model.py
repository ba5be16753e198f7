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
import sys
import warnings
from pathlib import Path

from . import _core
from .importing import bodies, frames, geometry, hydrodynamics, mass, scene_toml, sdf
from .importing.failure import ImportFailure, Report, fail
from .importing.file_search import FileSearch
from .importing.mjcf import MjcfReader
from .importing.urdf import read_urdf
from .importing.xml_file import XmlReader

_PLAUSIBLE_DENSITY = (20.0, 20000.0)  # kg/m^3, those of --check
_UNITS = (0.001, 0.01, 0.0254, 0.3048, 1000.0)
_VOLUME_DIFFERENCE = 1e-3  # share of the volume from which a declared one is a warning
_CENTER_DIFFERENCE = 1e-4  # m
_OVERLAP = 1e-3  # share of the smaller part
_MAX_PAIRS = 200  # of parts whose overlap is computed


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
    options = parser.add_argument_group("Options")
    options.add_argument("-h", "--help", action="help", help="Print this help message and exit")
    options.add_argument(
        "--version",
        action="version",
        version=f"buoyancy-import {version}",
        help="Display program version information and exit",
    )
    parser.add_argument_group("Positionals").add_argument(
        "model", metavar="MODEL", help="SDF, URDF or MJCF file, or the folder of an SDF model"
    )
    options.add_argument("-o", "--output", metavar="SCENE", help="Scene file to write; default: standard output")
    options.add_argument("--model", dest="name", metavar="NAME", help="Model of a world file, or body of an MJCF file")
    options.add_argument("--visual", action="store_true", help="Take the visual geometry, not the collision geometry")
    options.add_argument("--links", action="store_true", help="Make each link a body, also where joints are fixed")
    options.add_argument(
        "--drop", action="append", default=[], metavar="LINK", help="Leave out a link; may be repeated"
    )
    options.add_argument(
        "--keep",
        action="append",
        default=[],
        metavar="LINK",
        help="Keep a link that is taken for a propeller or a sensor, or the mass of one without volume; may be "
        "repeated",
    )
    options.add_argument(
        "--path",
        action="append",
        default=[],
        metavar="DIR",
        help="Search models, packages and meshes here too; may be repeated",
    )
    options.add_argument(
        "--close-holes",
        type=float,
        metavar="SHARE",
        help="Close holes of all meshes if hemispheres over them hold at most this share of the volume",
    )
    return parser.parse_args(argv)


def read_model(path, options, report):
    """The model, and the search for its files."""
    path = Path(path)
    if ".xacro" in path.suffixes:
        fail(path, "is a xacro file", "an expanded URDF", "a description with macros",
             f"Expand it: xacro {path.name} > {path.name.split('.')[0]}.urdf, with its arguments as name:=value")
    if path.is_dir():
        path = sdf.model_file(path)
    reader = XmlReader()
    root = reader.read(path)
    search = FileSearch(path, options.path)
    if any(element.tag.startswith("xacro:") for element in root.walk()):
        fail(path, "has elements of xacro", "an expanded URDF", "a description with macros",
             f"Expand it: xacro {path.name} > expanded.urdf")
    if root.tag == "robot":
        return read_urdf(root, report), search
    if root.tag in ("sdf", "gazebo"):
        return sdf.SdfReader(reader, search, report).read(root, options.name), search
    if root.tag == "mujoco":
        return MjcfReader(reader, search, report).read(root, options.name), search
    return fail(root.where, f"the root element is <{root.tag}>", "<sdf>, <robot> or <mujoco>",
                "a file of another kind", "Name the SDF, URDF or MJCF file")


class Importer:
    def __init__(self, options):
        self.options, self.report = options, Report()
        self.model, search = read_model(options.model, options, self.report)
        self.parts = geometry.PartMaker(search, self.report, options.close_holes)
        self.water = hydrodynamics.Hydrodynamics(self.model, self.report)
        self.text = scene_toml.SceneText()
        self.files = {}  # of meshes to write: name, contents
        self.bodies = []

    def scene(self):
        text, model = self.text, self.model
        text.comment(f"{model.name}: from {Path(self.options.model).name} ({model.format}) by buoyancy-import.")
        self._write_world()
        for number, group in enumerate(bodies.group_links(model, self.options, self.report), 1):
            self._write_body(number, group)
        imported = {link for body in self.bodies for link in body}
        for coefficients in self.water.coefficients:
            if coefficients.link not in imported:
                self.report.leave_out(
                    f"coefficients of the link '{coefficients.link}', which is no body ({coefficients.source})"
                )
        text.comment("")
        for title, sentences in (("Warnings", self.report.warnings), ("Not converted", self.report.not_converted)):
            text.comment(f"{title}:" if sentences else f"{title}: nothing")
            for sentence in sentences:
                text.comment(f"- {sentence}")
        return str(text)

    def _write_world(self):
        text, model, water = self.text, self.model, self.water.water
        if model.gravity is not None and any(model.gravity):
            length = math.sqrt(sum(c * c for c in model.gravity))
            text.table("world")
            text.key("gravity", length, f"m/s^2, {model.gravity_source}")
            text.key(
                "up",
                scene_toml.vector([-c / length for c in model.gravity]),
                f"against gravity, {model.gravity_source}",
            )
        elif model.gravity is not None:
            self.report.leave_out(f"gravity 0 ({model.gravity_source}): the scene has its default")
        text.table("water")
        value, source = water.get("density", (1025.0, "not stated by the model: sea water"))
        if not value > 0:
            raise ImportFailure(
                f"{source}: the density of the fluid is {value:g} kg/m^3; expected above 0. Likely cause: "
                "a mistyped number. Correct the model."
            )
        text.key("density", value, f"kg/m^3, {source}")
        if "level" in water:
            text.key("level", water["level"][0], f"m, {water['level'][1]}")
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
        poses = {link.name: frames.compose(inverse, link.pose) for link in group.links}
        self.bodies.append([link.name for link in group.links])
        name = model.name if root.name == model.canonical else f"{model.name} {root.name}"
        parts = []
        for link, shape in bodies.geometry_of(group, self.options):
            parts.append((link, self.parts.part(shape, frames.compose(poses[link.name], shape.pose))))
        loads = [c for c in self.water.coefficients if c.link in poses]

        text.table("[[body]]")
        text.key("id", number, "numbered in the order of the model")
        text.key("name", name, f"its frame is that of the link '{root.name}', {root.source}")
        if len(group.links) > 1:
            text.comment("one body of the links " + ", ".join(link.name for link in group.links))
        if loads:
            text.key("outputs", ["wrench", "loads"], "it has coefficients")
        for index, (link, part) in enumerate(parts):
            self._write_part(number, index, link, part)
        self._check_overlaps(parts, name)
        total = self._mass(group, poses)
        self._check_volume(parts, total, name)
        self._check_declared(parts, poses, name)
        if loads:
            self._write_loads(loads, poses)
        self._write_client(
            total, root, [link for link in group.links if link.inertial or link.mass_from_geometry], name
        )

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
        if any(part.pose[0]):
            text.key("position", scene_toml.vector(part.pose[0]), f"m, in the frame of the body, {shape.source}")
        q = scene_toml.quaternion(part.pose[1])
        if abs(q[0]) != 1:
            text.key("orientation", q, f"w, x, y, z, {shape.source}")

    def _mesh_file(self, number, index, part):
        output = self.options.output
        folder = Path(output).resolve().parent if output else Path.cwd()
        if not part.contents:
            return os.path.relpath(part.file.resolve(), folder)
        if not output:
            raise ImportFailure(
                f"{part.geometry.element.where}: {part.geometry.kind} '{part.geometry.name}' becomes a mesh "
                "file beside the scene; expected the name of a scene file. Name it with -o SCENE.toml."
            )
        name = f"{Path(output).stem}.d/body{number}_part{index}{part.suffix}"
        self.files[name] = part.contents
        return name

    def _mass(self, group, poses):
        masses = []
        for link in group.links:
            if link.mass_from_geometry:
                for shape in link.geometry:
                    if shape.visual and self.model.format == "SDF":
                        continue
                    solid = self.parts.part(shape, frames.IDENTITY).solid
                    density = shape.mass / solid.volume if shape.mass is not None else shape.density
                    density = 1000.0 if density is None else density
                    masses.append(mass.of_solid(solid, density, frames.compose(poses[link.name], shape.pose)))
            elif link.inertial:
                masses.append(mass.of_inertial(link.inertial, poses[link.name]))
        return mass.total(masses)

    def _write_client(self, total, root, links, name):
        text = self.text
        text.table("body.client")
        if total is None:
            self.report.warn(f"body '{name}' has no mass: buoyancy-client takes half the density of the water")
        else:
            source = " + ".join(f"{link.inertial.source if link.inertial else link.source}" for link in links[:4])
            source += f" and {len(links) - 4} more" if len(links) > 4 else ""
            text.key("mass", total.mass, f"kg, {source}")
            text.key("center_of_mass", scene_toml.vector(total.center), "m, in the frame of the body")
            i = total.inertia
            entries = scene_toml.vector([i[0][0], i[1][1], i[2][2], i[0][1], i[0][2], i[1][2]])
            if mass.is_possible(i):
                text.key(
                    "inertia",
                    entries if any(entries[3:]) else entries[:3],
                    "kg m^2, about the centre of mass, in the axes of the body",
                )
            else:
                moments = ", ".join(f"{m:.4g}" for m in mass.principal_moments(i))
                self.report.warn(
                    f"body '{name}': no rigid body has the principal moments {moments} kg m^2; expected each "
                    "above 0 and at most the sum of the others. The inertia of the volume is used instead: "
                    "correct the model"
                )
                self.report.leave_out(f"inertia [{', '.join(f'{e:.6g}' for e in entries)}] of '{name}'")
        pose = frames.compose(self.model.pose, root.pose)
        text.key("position", scene_toml.vector(pose[0]), f"m, {self.model.source}")
        text.key("orientation", scene_toml.quaternion(pose[1]), f"w, x, y, z, {self.model.source}")

    def _write_loads(self, loads, poses):
        center, sums = None, [frames.zeros() for _ in range(3)]
        for coefficients in loads:
            matrices, origin, rotation = hydrodynamics.with_body_frame(coefficients, poses[coefficients.link])
            center = origin if center is None else center
            offset = frames.subtract(origin, center)
            if any(any(row) for row in matrices[1]):
                if not frames.is_right_angled(rotation):
                    self.report.warn(
                        f"the quadratic drag of '{coefficients.link}' is turned with its link: exact only "
                        f"for right angles ({coefficients.source})"
                    )
                if any(offset):
                    self.report.warn(
                        f"the quadratic drag of '{coefficients.link}' is moved to another centre as a matrix, "
                        f"which is an approximation ({coefficients.source})"
                    )
            for total, matrix in zip(sums, matrices):
                moved = frames.moved_6(matrix, offset)
                for i, j in itertools.product(range(6), repeat=2):
                    total[i][j] += moved[i][j]
        changed = "; ".join(dict.fromkeys(c.changed for c in loads))
        keys = []
        for table, key, name, what, total in zip(
            ("body.drag", "body.drag", "body.added_mass"),
            ("linear", "quadratic", "matrix"),
            ("linear", "quadratic", "added_mass"),
            ("linear drag", "quadratic drag", "added mass"),
            sums,
        ):
            source = ", ".join(dict.fromkeys(c.source_of(name) for c in loads if any(map(any, getattr(c, name)))))
            matrix = hydrodynamics.admissible(total, what, source, self.report, key == "matrix")
            if any(map(any, matrix)):
                keys.append((table, key, matrix, f"{changed}; {source}"))
        immersion = "none" if any(c.immersion == "none" for c in loads) else "volume"
        if immersion != "none":
            self.report.note(
                "the coefficients are scaled by the submerged share of the volume; if they were measured "
                'afloat, set immersion = "none"'
            )
        for table, rows in itertools.groupby(keys, lambda row: row[0]):
            self.text.table(table)
            for _, key, matrix, comment in rows:
                self.text.key(key, scene_toml.coefficients(matrix), comment)
            self.text.key("center", scene_toml.vector(center), "m, the origin of the link")
            self.text.key("immersion", immersion, "what scales them where the body is partly out of the water")

    def _check_overlaps(self, parts, name):
        found, unknown = [], False
        for a, b in itertools.islice(itertools.combinations([part for _, part in parts], 2), _MAX_PAIRS):
            volume = geometry.overlap(a, b)
            unknown = unknown or volume is None
            smaller = min(a.solid.volume, b.solid.volume)
            if volume is not None and volume > _OVERLAP * smaller:
                found.append(
                    (
                        volume,
                        f"'{a.geometry.name}' and '{b.geometry.name}' by {volume:.4g} m^3 "
                        f"({100 * volume / smaller:.3g} % of the smaller)",
                    )
                )
        if found:
            found.sort(reverse=True)
            more = f", and {len(found) - 5} more pairs" if len(found) > 5 else ""
            self.report.warn(
                f"body '{name}': parts overlap: {', '.join(text for _, text in found[:5])}{more}; "
                f"{sum(volume for volume, _ in found):.4g} m^3 in all. The scene displaces this water twice: "
                "take it out of the model"
            )
        if unknown:
            self.report.note(
                f"body '{name}' has several parts with meshes: buoyancyd --check reports whether they overlap"
            )

    def _check_volume(self, parts, total, name):
        volume = sum(part.solid.volume for _, part in parts)
        if total is None or not volume > 0:
            return
        density, (low, high) = total.mass / volume, _PLAUSIBLE_DENSITY
        if low <= density <= high:
            return
        # Choose, of the units that make the density plausible, the one that brings it nearest to that of water.
        plausible = [unit for unit in _UNITS if low <= density / unit**3 <= high]
        unit = min(plausible, key=lambda u: abs(math.log(density / u**3 / 1000)), default=None)
        hint = (
            "Check the mass and the scale of the meshes"
            if unit is None
            else f"scale = {unit:g} gives {density / unit ** 3:.4g} kg/m^3"
        )
        self.report.warn(
            f"body '{name}': mass over volume = {total.mass:.6g} kg / {volume:.6g} m^3 = {density:.4g} kg/m^3; "
            f"expected {low:g} to {high:g} kg/m^3. Likely cause: a mesh in another unit than metres, or a "
            f"mass of another body. {hint}"
        )

    def _check_declared(self, parts, poses, name):
        for declared in self.water.declared:
            if declared.link not in poses:
                continue
            own = [part for link, part in parts if link.name == declared.link] or [part for _, part in parts]
            volume = sum(part.solid.volume for part in own)
            if declared.volume is not None and abs(declared.volume - volume) > _VOLUME_DIFFERENCE * volume:
                self.report.warn(
                    f"body '{name}': the model declares a volume of {declared.volume:.6g} m^3, its geometry has "
                    f"{volume:.6g} m^3 ({100 * (volume / declared.volume - 1) if declared.volume else 0:+.3g} "
                    f"%). The scene uses the geometry: scaling lengths by "
                    f"{(declared.volume / volume) ** (1 / 3):.5g} would match ({declared.source})"
                )
            if declared.center is None:
                continue
            centroid = tuple(
                sum(part.solid.volume * frames.transform(part.pose, part.solid.centroid)[i] for part in own) / volume
                for i in range(3)
            )
            center = frames.transform(poses[declared.link], declared.center)
            if math.dist(center, centroid) > _CENTER_DIFFERENCE:
                values = [", ".join(f"{c:.5g}" for c in scene_toml.vector(p)) for p in (center, centroid)]
                self.report.warn(
                    f"body '{name}': the model declares the centre of buoyancy ({values[0]}) m, that of its "
                    f"geometry is ({values[1]}) m. The scene uses the geometry ({declared.source})"
                )


def _count(number, one, many):
    return f"{number} {one if number == 1 else many}"


def print_report(importer, target):
    report = importer.report
    lines = [
        f"{importer.model.name}: {importer.model.format}, {_count(len(importer.model.links), 'link', 'links')}, "
        f"{_count(len(importer.bodies), 'body', 'bodies')}"
    ]
    for title, sentences in (("note", report.notes), ("warning", report.warnings)):
        lines += [f"{title}: {sentence}" for sentence in sentences]
    lines.append(f"not converted: {len(report.not_converted) or 'nothing'}")
    lines += [f"  - {sentence}" for sentence in report.not_converted]
    if importer.options.output:
        lines.append(
            f"written: {importer.options.output}; see how it floats: buoyancyd --scene {importer.options.output} "
            "--check"
        )
    print("\n".join(lines), file=target)


def write(importer, scene):
    """Checks the scene as buoyancyd would, and writes it and its meshes."""
    output = importer.options.output
    folder = Path(output).resolve().parent if output else Path.cwd()
    for name, contents in importer.files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(contents, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the importer has warnings of its own, and --check the others
        try:
            _core.Scene.from_text(scene, folder)
        except _core.Error as error:
            raise ImportFailure(f"{importer.options.model}: the scene that it becomes is refused: {error}") from None
    if output:
        Path(output).write_text(scene, encoding="utf-8")
    else:
        print(scene, end="")


def main(argv=None, version="of the Python package buoyancy"):
    options = arguments(argv, version)
    try:
        importer = Importer(options)
        write(importer, importer.scene())
        print_report(importer, sys.stdout if options.output else sys.stderr)
    except ImportFailure as failure:
        print(f"buoyancy-import: {' '.join(str(failure).split())}", file=sys.stderr)
        return 2
    except (ArithmeticError, LookupError, RecursionError, ValueError) as error:
        print(
            f"buoyancy-import: {options.model}: cannot be imported ({type(error).__name__}: {error}); expected a valid "
            "model. Likely cause: an element with a value of another kind. Check the model with the tool of its format "
            "(gz sdf --check, check_urdf, MuJoCo's compile).",
            file=sys.stderr,
        )
        return 2
    except OSError as error:
        print(f"buoyancy-import: {error.filename}: cannot be written: {error.strerror}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
