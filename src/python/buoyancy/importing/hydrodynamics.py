"""What plugins of other simulators become in a scene: a table by the name of the plugin.

Everything is converted to the conventions of the scene file: positive numbers oppose a motion and add inertia, in the
order x, y, z, roll, pitch, yaw, in the axes of a link. docs/importing.md has the tables by key; loads are about the
origin of the link.
"""
import itertools
import math
import re
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from . import frames
from .failure import fail, one_of

MATRICES = ("linear", "quadratic", "added_mass")
_FORCES, _VELOCITIES = "xyzkmn", "uvwpqr"
_ADDED_MASS_AXES = "xyzpqr"
# xU, xUabsU, xUU, xDotU, and the same with underscores or other capitals: x_u, x_u_abs_u, x_dot_u.
_COEFFICIENT = re.compile(r"([xyzkmn])(dot)?([uvwpqr])(?:(abs)?([uvwpqr]))?")
_NAMED_LINKS = ("link_name", "joint_name", "linkName", "jointName", "bodyName")
_VRX_DEFAULTS = {"linear": [20.0] * 6, "quadratic": [0.0] * 6, "added_mass": [5.0, 5.0, 0.1, 0.1, 0.1, 1.0]}
_WAVE_DEFAULTS = {
    "number": 3, "period": 5.0, "scale": 1.1, "angle": 0.4, "gain": 1.0, "amplitude": 0.0, "phase": 0.0
}
_AIR = 100.0  # kg/m^3: a layer that is lighter is the air above the water
_MAX_LAYERS = 16  # of a scene, below the water at its surface
# Keys of plugins whose buoyancy is not that of the geometry.
_GEOMETRY = "buoyancy follows from the geometry"
_UUV_SHAPE = ("metacentric_width", "metacentric_length", "submerged_height")
_VRX_SHAPE = ("hullRadius", "boatWidth", "boatLength", "wave_model")
_SURFACE_SHAPE = ("vehicle_length", "vehicle_width", "hull_radius", "hull_length", "points", "buoyancy")
_SURFACE_DRAG = ("linear_drag", "angular_drag")
_UUV_MATRICES = {
    "added_mass": "added_mass",
    "linear_damping": "linear",
    "quadratic_damping": "quadratic",
    "linear_damping_forward_speed": "",
}
# Drag coefficients of cylinders in uuv_simulator, up to a ratio of length to diameter.
_CD_ALONG = ((1, 0.91), (2, 0.85), (4, 0.87), (math.inf, 0.99))
_CD_ACROSS = ((1, 0.63), (2, 0.68), (5, 0.74), (10, 0.82), (math.inf, 0.98))


def _matrices():
    return {matrix: np.zeros((6, 6)) for matrix in MATRICES}


@dataclass
class Coefficients:
    """The coefficients of one link, in its axes and about its origin."""

    link: str
    source: str
    changed: str
    immersion: str = "volume"
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))  # from the axes of the coefficients to the link's
    matrices: dict = field(default_factory=_matrices)
    lines: dict = field(default_factory=dict)  # of each matrix: the elements that it is read from

    def read_from(self, matrix, element):
        self.lines.setdefault(matrix, []).append(element)

    def source_of(self, matrix):
        """File and lines of the elements, or those of the plugin."""
        elements = self.lines.get(matrix)
        if not elements:
            return self.source
        first, last = (function(element.line for element in elements) for function in (min, max))
        return elements[0].source if first == last else f"{elements[0].source.rsplit(':', 1)[0]}:{first}-{last}"


@dataclass
class Declared:
    """What a plugin says of the buoyancy of a link."""

    link: str
    source: str
    volume: Optional[float] = None
    center: Optional[list] = None


class Hydrodynamics:
    """Reads the plugins of a model."""

    def __init__(self, model, report):
        self.model, self.report = model, report
        self.coefficients, self.declared = [], []
        self.water = {}  # key: (value, source)
        self.layers = []  # (height below which it begins, density, source), from the top down
        self.waves = None  # (components, source)
        for link in model.links.values():
            added = link.inertial and link.inertial.element.find("fluid_added_mass")
            if added:
                result = Coefficients(link.name, added.source, "fluid_added_mass as it is")
                for i, row in enumerate(_ADDED_MASS_AXES):
                    for j, column in enumerate(_ADDED_MASS_AXES[i:], i):
                        value = added.number(row + column, 0.0)
                        result.matrices["added_mass"][[i, j], [j, i]] = value
                self.coefficients.append(result)
        self.stated = []  # elements of plugins whose density is the second choice
        for plugin in model.plugins:
            self._read(plugin)
        for element in self.stated:
            self._read_water(element, {"water_density": "density", "waterDensity": "density"})

    def _read(self, plugin):
        names = f"{plugin.name} {plugin.filename}"
        for pattern, reader in _PLUGINS:
            if re.search(pattern, names, re.IGNORECASE) and reader(self, plugin, plugin.element):
                return
        links = [element.text.strip() for element in plugin.element.walk() if element.tag in _NAMED_LINKS]
        of = f" of {', '.join(dict.fromkeys(links))}" if links else ""
        kind = next((kind for pattern, kind in _KINDS if re.search(pattern, names, re.IGNORECASE)), "plugin")
        self.report.leave_out(f"{kind} '{plugin.name}' ({plugin.filename}){of}, {plugin.source}")

    def _link(self, plugin, name, element):
        """The full name of a link that a plugin names, or None."""
        for full in (plugin.prefix + name, name):
            if full in self.model.links:
                return full
        self.report.warn(f"plugin '{plugin.name}' is for the link '{name}', which does not exist: its coefficients are "
                         f"left out; expected {one_of(self.model.links)}", element)
        return None

    def _set_water(self, key, value, element):
        if key == "density" and not value > 0:
            fail(element, f"the density of the water is {value:g} kg/m^3", "above 0 kg/m^3",
                 "a mistyped number", "Correct the model")
        if key in self.water and self.water[key][0] != value:
            self.report.warn(f"{key} of the water is {self.water[key][0]} ({self.water[key][1]}) and {value} "
                             f"({element.source}): the first is used")
        self.water.setdefault(key, (value, element.source))

    def _read_water(self, element, tags):
        """Reads the keys of the water that have these tags."""
        for tag, key in tags.items():
            value = element.number(tag)
            if value is not None:
                self._set_water(key, value, element.find(tag))

    def _leave_out(self, element, tags, why, equals=" ", of=""):
        """Reports the children that have one of these tags, and their text."""
        for child in itertools.chain.from_iterable(map(element.all, tags)):
            text = child.text.strip()
            self.report.leave_out(f"<{child.tag}>{equals + text if text else ''}{of}: {why}", child)

    def gz_hydrodynamics(self, plugin, element):
        keys = _coefficients(element)
        if not keys or element.find("link_name") is None:
            return False
        link = self._link(plugin, element.text_of("link_name"), element)
        if link is None:
            return True
        # gz-sim takes xUU for u^2 since 2023; its ancestors took it for |u| u.
        old = "gz::" not in plugin.name
        result = Coefficients(link, element.source, "negated: gz-sim writes derivatives")
        for matrix, row, column, absolute, second, child in keys:
            value, with_abs = child.number(), f"<{child.tag[:2]}abs{child.tag[2:]}>"
            if matrix == "added_mass" and element.flag("disable_added_mass"):
                self.report.leave_out(f"<{child.tag}> = {value:g}: disable_added_mass is set", child)
            elif matrix != "quadratic" or (second == column and (absolute or old)):
                result.matrices[matrix][row, column] -= value
                result.read_from(matrix, child)
                if matrix == "quadratic" and not absolute:
                    self.report.note(f"<{child.tag}> is taken as {with_abs}, as this plugin does", child)
            elif value != 0:
                square = "a coefficient of u^2, which pushes backwards"
                why = square if second == column else "a product of two velocities"
                self.report.leave_out(f"<{child.tag}> = {value:g}: {why}; if |u| u is meant, write {with_abs}", child)
        if element.flag("disable_coriolis"):
            self.report.note("disable_coriolis: the Coriolis terms of added mass act in the scene", element)
        self.stated.append(element)
        current = element.numbers("default_current", 3)
        if current is not None:
            self._set_water("current", tuple(current), element.find("default_current"))
        tables = dict.fromkeys(c.tag for c in element.children if c.tag.startswith("lookup_current"))
        self._leave_out(element, tables, "a current from a table")
        self.coefficients.append(result)
        return True

    def gz_buoyancy(self, plugin, element):
        graded = element.find("graded_buoyancy")
        if graded is None:
            uniform = element.find("uniform_fluid_density")
            self._set_water("density", element.number("uniform_fluid_density", 1000.0), uniform or element)
        else:
            self._graded_buoyancy(graded)
        enabled, name = element.all("enable"), self.model.name
        own = [child for child in enabled if name in child.text.strip().split("::")]
        if enabled and not own:
            self.report.warn(f"<enable> does not name '{name}': it has no buoyancy in Gazebo, but in the scene",
                             enabled[0])
        for child in own:
            if child.text.strip() != name:
                self.report.note(f"<enable> {child.text.strip()}: every body of the scene is buoyant", child)
        return True

    def _graded_buoyancy(self, graded):
        """Each density holds from its height (z) up to the next; the default one below all of them."""
        changes = sorted(((change.number("above_depth", 0.0), change.number("density", 0.0), change)
                          for change in graded.all("density_change")), key=lambda change: change[0])
        below = graded.number("default_density", 1000.0)
        source = graded.find("default_density") or graded
        is_water, layers = below >= _AIR, []
        for height, density, change in changes:
            stated = f"graded buoyancy: {density:g} kg/m^3 above {height:g} m"
            if is_water and density < _AIR:
                self._set_water("level", height, change)
                self.report.leave_out(f"graded buoyancy: the {density:g} kg/m^3 above {height:g} m are air, whose "
                                      "buoyancy is left out", change)
                break
            if density > below:
                self.report.leave_out(f"{stated}: the fluid under it is lighter, so that it would sink", change)
            elif density < below:
                layers.insert(0, (height, below, source))
                below, source = density, change
        level = self.water.get("level", (0.0,))[0]
        while layers and layers[0][0] >= level:
            self.report.leave_out(f"graded buoyancy: {below:g} kg/m^3 above {layers[0][0]:g} m: the water of the scene "
                                  f"ends at its level, {level:g} m", source)
            _, below, source = layers.pop(0)
        if len(layers) > _MAX_LAYERS:
            fail(graded, f"{len(layers) + 1} layers of water", f"at most {_MAX_LAYERS + 1}", "",
                 "Combine those that differ least")
        self._set_water("density", below, source)
        if self.water["density"][0] == below:
            self.layers = [(height, density, of.source) for height, density, of in layers]

    def simple_hydrodynamics(self, plugin, element):
        """VRX: positive coefficients, some with defaults other than 0, in the axes of the inertial pose."""
        name = element.text_of("link_name") or element.text_of("bodyName")
        if not name:
            return False
        link = self._link(plugin, name, element)
        if link is None:
            return True
        changed = 'as it is, with VRX\'s defaults; measured afloat: immersion "none"'
        result = Coefficients(link, element.source, changed, immersion="none")
        result.matrices = {matrix: np.diag(values) for matrix, values in _VRX_DEFAULTS.items()}
        inertial = self.model.links[link].inertial
        if inertial:
            result.rotation = inertial.pose[:3, :3]
        for matrix, row, column, _, second, child in _coefficients(element):
            value = child.number()
            if row == column and second in (None, column):
                result.matrices[matrix][row, row] = value
                result.read_from(matrix, child)
            else:
                self.report.leave_out(f"<{child.tag}> = {value:g}: VRX has no such key", child)
        self.coefficients.append(result)
        self._read_water(element, {"waterLevel": "level", "waterDensity": "density"})
        self._leave_out(element, _VRX_SHAPE, _GEOMETRY)
        return True

    def surface(self, plugin, element):
        """VRX: buoyancy of points of a hull; water level, density and waves are used."""
        self._read_water(element, {"fluid_level": "level", "fluid_density": "density"})
        for tags, why in ((_SURFACE_SHAPE, _GEOMETRY), (_SURFACE_DRAG, "give [body.drag] instead")):
            self._leave_out(element, tags, why, " = ", f" of '{plugin.name}'")
        self.wavefield(plugin, element)
        return True

    def wavefield(self, plugin, element):
        fields = [e for e in element.walk() if e.tag == "wavefield" and e.find("wave") is not None]
        if fields:
            self._waves(fields[0].find("wave"))
            return True
        messages = [e for e in element.walk() if "wavefield" in e.get("topic", "")]
        for message in messages:
            pairs = re.findall(
                r'key:\s*"(\w+)"\s*value\s*\{[^{}]*?(?:double_value|int_value|string_value|bool_value):'
                r'\s*"?([^"\s}]+)',
                message.text,
            )
            self._waves(message.with_attributes(dict(pairs)))
        return bool(messages)

    def _waves(self, element):
        """The components of VRX's wave field: model PMS (a spectrum in three lines) or CWR."""
        number, period, scale, angle, gain, amplitude, phase = (
            element.number(key, default) for key, default in _WAVE_DEFAULTS.items()
        )
        axes, model, number = element.numbers("direction", (1, 2), [0.0]), element.text_of("model", "PMS"), int(number)
        direction = math.atan2(axes[1], axes[0]) if len(axes) == 2 else axes[0]
        is_spectrum = model == "PMS"
        is_known = model in ("PMS", "CWR") and number <= (3 if is_spectrum else 100)
        if not is_known or period < 1e-3 or not 0.01 <= scale <= 100:
            self.report.leave_out(f"wavefield: model {model}, {number} waves of {period:g} s", element)
            return
        omega = 2 * math.pi / period
        spacing = (omega * (1 - 1 / scale), omega * (scale - 1 / scale) / 2, omega * (scale - 1))
        components = []
        for i in range(number):
            n = i - (1 if is_spectrum else number // 2)
            if is_spectrum:
                own = omega * scale**n
                density = 0.0081 * 9.81**2 / own**5 * math.exp(-1.25 * (omega / own) ** 4)
                height = gain * math.sqrt(max(0.0, 2 * density * spacing[i]))
            else:
                own, height = omega / math.sqrt(scale**n), scale**n * amplitude
            if height > 0:
                components.append((height, own, math.degrees(direction + n * angle), math.degrees(phase)))
        if components and self.waves is None:
            self.waves = (components, element.source)
        if element.number("steepness"):
            self.report.leave_out(f"wavefield: steepness {element.text_of('steepness')}, waves of Gerstner; those of "
                                  "the scene are linear", element)
        if element.text_of("tau") and components:
            self.report.leave_out(f"wavefield: tau {element.text_of('tau')} s, the growth of the waves at the start; "
                                  "[water] has ramp", element)

    def underwater_object(self, plugin, element):
        """uuv_simulator and Plankton: damping negative, added mass positive, axes forward, right, down."""
        links = [child for child in element.all("link") if child.find("hydrodynamic_model") or child.find("volume")]
        if not links:
            return False
        density = element.number("fluid_density", 1028.0)
        self._set_water("density", density, element.find("fluid_density") or element)
        for child in links:
            link = self._link(plugin, child.get("name", ""), child)
            if link is not None:
                self._declared_buoyancy(child, link, density)
                self._underwater_model(child, link, density)
        return True

    def _declared_buoyancy(self, element, link, density):
        volume, inertial = element.number("volume"), self.model.links[link].inertial
        if element.flag("neutrally_buoyant") and inertial is not None:
            volume = inertial.mass / density
        if volume is not None:
            volume = _of_either(element, "scaling_volume", 1.0) * (volume + _of_either(element, "offset_volume", 0.0))
            if not volume > 0:
                fail((element.find("volume") or element),
                     f"the plugin declares a volume of {volume:g} m^3 for the link '{link}'", "above 0 m^3",
                     "a mistyped number, or a scaling or offset of another vehicle", "Correct or remove <volume>")
        self.declared.append(Declared(link, element.source, volume, element.numbers("center_of_buoyancy", 3)))
        self._leave_out(element, _UUV_SHAPE, "stability follows from the geometry")

    def _underwater_model(self, element, link, density):
        model = element.find("hydrodynamic_model")
        if model is None:
            return
        kind = model.text_of("type", "fossen")
        changed = "damping negated, y and z reversed (uuv_simulator's axes are forward, right, down)"
        result = Coefficients(link, model.source, changed)
        added, linear, quadratic, forward = (self._matrix(model, tag, result) for tag in _UUV_MATRICES)
        if kind in _SHAPES:
            result.changed += f"; coefficients of a {kind}, with {density:g} kg/m^3"
            keys, set_matrices = _SHAPES[kind]
            lengths = [model.number(key, 0.0, minimum=0.0) for key in keys]
            if all(lengths) and (kind != "cylinder" or model.text_of("axis") in ("i", "j", "k")):
                set_matrices(model, density, added, quadratic, *lengths)
            else:
                self.report.leave_out(f"hydrodynamic model '{kind}': its lengths are not stated", model)
        elif kind != "fossen":
            self.report.leave_out(f"hydrodynamic model '{kind}', which is not known", model)
        scale_added, scale_damping = (_of_either(element, f"scaling_{key}", 1.0) for key in ("added_mass", "damping"))
        offsets = [
            _of_either(element, f"offset_{key}", 0.0) for key in ("added_mass", "linear_damping", "nonlin_damping")
        ]
        if (scale_added, scale_damping) != (1.0, 1.0) or any(offsets):
            result.changed += "; scaling and offsets applied"
        for i, j in zip(*np.nonzero(quadratic - np.diag(np.diag(quadratic)))):
            self.report.leave_out(f"quadratic_damping, row {i + 1}, column {j + 1}: uuv_simulator uses only the "
                                  f"diagonal ({model.find('quadratic_damping').source})")
        signs, own = np.outer(frames.REVERSED_Y_Z, frames.REVERSED_Y_Z), np.eye(6)
        result.matrices = {
            "added_mass": signs * scale_added * (added + own * offsets[0]),
            "linear": -signs * scale_damping * (linear + own * offsets[1]),
            "quadratic": -own * scale_damping * (quadratic + own * offsets[2]),
        }
        if forward.any() or _of_either(element, "offset_lin_forward_speed_damping", 0.0):
            words = " ".join(model.text_of("linear_damping_forward_speed").split())
            self.report.leave_out(f"linear_damping_forward_speed {words}, times the speed u forwards; at a cruising "
                                  "speed u, add -u times it to `linear`, with y and z reversed", model)
        self.coefficients.append(result)

    @staticmethod
    def _matrix(model, tag, result):
        numbers = model.numbers(tag, (6, 36))
        if numbers is None:
            return np.zeros((6, 6))
        result.read_from(_UUV_MATRICES[tag], model.find(tag))
        return np.diag(numbers) if len(numbers) == 6 else np.reshape(numbers, (6, 6))

    def current(self, plugin, element):
        """The ocean current of uuv_simulator, Plankton and DAVE: mean speed and two angles [rad]."""
        constant = element.find("constant_current")
        if constant is None:
            return False
        speed = constant.number("velocity/mean", 0.0)
        horizontal, vertical = (constant.number(f"{name}_angle/mean", 0.0) for name in ("horizontal", "vertical"))
        level = speed * math.cos(vertical)
        velocity = (level * math.cos(horizontal), level * math.sin(horizontal), speed * math.sin(vertical))
        self._set_water("current", velocity, constant)
        self._leave_out(element, ("transient_current", "tidal_oscillation"), "the current of a scene is constant")
        if any(constant.number(f"{name}/noiseAmp", 0.0) for name in ("velocity", "horizontal_angle", "vertical_angle")):
            self.report.leave_out("the noise of the current", constant)
        return True


def _coefficients(element):
    """The keys of SNAME's derivatives: matrix, row, column, whether it has abs, second column, element."""
    result = []
    for child in element.children:
        match = _COEFFICIENT.fullmatch(child.tag.replace("_", "").lower())
        if match and child.text.strip():
            force, dot, velocity, absolute, second = match.groups()
            row, column = _FORCES.index(force), _VELOCITIES.index(velocity)
            second = _VELOCITIES.index(second) if second else None
            matrix = "added_mass" if dot else "linear" if second is None else "quadratic"
            result.append((matrix, row, column, bool(absolute), second, child))
    return result


def _of_either(link, key, default):
    """A number of a <link> of uuv_simulator, or of its <hydrodynamic_model>."""
    return link.number(f"hydrodynamic_model/{key}", link.number(key, default))


def _sphere(model, density, added, quadratic, radius):
    np.fill_diagonal(added[:3, :3], 2 / 3 * density * math.pi * radius**3)
    np.fill_diagonal(quadratic[:3, :3], -0.5 * density * 0.5 * math.pi * radius**2)


def _cylinder(model, density, added, quadratic, radius, length):
    """Sets the matrices as uuv_simulator does, whose added mass along the axis is that of a length of 1 m."""
    slenderness, section = length / (2 * radius), density * math.pi * radius**2
    along, across = (next(cd for limit, cd in table if slenderness <= limit) for table in (_CD_ALONG, _CD_ACROSS))
    for i, axis in enumerate("ijk"):
        if axis == model.text_of("axis"):
            added[i, i], quadratic[i, i] = section, -0.5 * along * section
        else:
            added[i, i], quadratic[i, i] = section * length, -0.5 * across * radius * length * density
            added[3 + i, 3 + i] = section * length**3 / 12


def _box(model, density, added, quadratic, length, width, height):
    areas = np.array((width * height, length * height, length * width))
    np.fill_diagonal(quadratic[:3, :3], -0.5 * model.number("cd", 1.0) * areas * density)


_SHAPES = {  # of uuv_simulator: their lengths, and what sets the matrices
    "sphere": (("radius",), _sphere),
    "cylinder": (("radius", "length"), _cylinder),
    "box": (("length", "width", "height"), _box),
}
_KINDS = (
    ("thrust|propeller|motor_?model", "thruster"),
    ("lift.?drag|fin_", "fin"),
    ("buoyancy.?engine", "tank"),
)
# The first reader that knows a plugin converts it; a reader returns False if the plugin has none of its keys.
_PLUGINS = (
    (r"simple_?hydrodynamics|usv_gazebo_dynamics", Hydrodynamics.simple_hydrodynamics),
    (r"underwater_object|uuv_plugin", Hydrodynamics.underwater_object),
    (r"::Hydrodynamics|hydrodynamics-system|HydrodynamicsPlugin", Hydrodynamics.gz_hydrodynamics),
    (r"systems::Buoyancy\b|gz-sim\d*-buoyancy-system|gazebo\d*-buoyancy-system", Hydrodynamics.gz_buoyancy),
    (r"vrx::Surface|systems::Surface|libSurface|surface-system|PolyhedraBuoyancyDrag", Hydrodynamics.surface),
    (r"current", Hydrodynamics.current),
    (r"wave|publisher", Hydrodynamics.wavefield),
)


def admissible(matrix, what, source, report, symmetric=False):
    """The matrix, changed where a scene file would refuse it; every change is reported."""
    largest = abs(matrix).max()
    result = np.where(abs(matrix) > 1e-12 * largest, matrix, 0.0)  # the rest is rounding of rotations
    if symmetric:
        worst = abs(result - result.T).max()
        if worst > 1e-9 * largest:
            report.warn(f"{what} is not symmetric (by up to {worst:.6g}): the mean of both elements is used ({source})")
        result = (result + result.T) / 2
    for i in range(6):
        if result[i, i] < 0:
            report.warn(f"{what} has {result[i, i]:.6g} in row {i + 1}, column {i + 1}, which would drive the motion; "
                        "expected a number of the other sign. It is left out, with its row and column: correct the "
                        f"sign in the model if it was mistyped ({source})")
            report.leave_out(f"{what}, row and column {i + 1}: {result[i, i]:.6g} has the wrong sign ({source})")
            result[i, :] = result[:, i] = 0.0
    if not _is_semidefinite(result):
        diagonal = np.diag(np.diag(result))
        lost = [f"row {i + 1}, column {j + 1}: {result[i, j]:.6g}" for i, j in zip(*np.nonzero(result - diagonal))]
        report.warn(f"{what} would drive some motion: it is not positive semidefinite. Only its diagonal is used "
                    f"({source})")
        report.leave_out(f"elements of {what} off the diagonal: {'; '.join(lost)} ({source})")
        result = diagonal
    return result


def _is_semidefinite(matrix):
    """Whether the eigenvalues of the symmetric part, scaled to a diagonal of ones, are at least 0, within 1e-7."""
    middle, scale = (matrix + matrix.T) / 2, np.sqrt(np.diag(matrix))
    scale[scale == 0.0] = 1.0
    unit = middle / np.outer(scale, scale)
    # Beside a 0 on the diagonal there may be nothing.
    return not np.any(unit[np.diag(matrix) == 0.0]) and np.linalg.eigvalsh(unit)[0] >= -1e-7
