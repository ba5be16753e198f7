"""What plugins of other simulators become in a scene: a table by the name of the plugin.

Everything is converted to the conventions of the scene file: positive numbers oppose a motion and add inertia, in the
order x, y, z, roll, pitch, yaw, in the axes of a link. docs/importing.md has the tables by key; loads are about the
origin of the link.
"""
import math
import re
from dataclasses import dataclass, field
from typing import Optional

from . import frames

_FORCES, _VELOCITIES = "xyzkmn", "uvwpqr"
# xU, xUabsU, xUU, xDotU, and the same with underscores or other capitals: x_u, x_u_abs_u, x_dot_u.
_COEFFICIENT = re.compile(r"([xyzkmn])(dot)?([uvwpqr])(?:(abs)?([uvwpqr]))?")
_VRX_ADDED_MASS = (5.0, 5.0, 0.1, 0.1, 0.1, 1.0)
_VRX_LINEAR = 20.0
_AIR = 100.0  # kg/m^3: a layer that is lighter is the air above the water


@dataclass
class Coefficients:
    """The coefficients of one link, in its axes and about its origin."""

    link: str
    source: str
    linear: list = field(default_factory=frames.zeros)
    quadratic: list = field(default_factory=frames.zeros)
    added_mass: list = field(default_factory=frames.zeros)
    immersion: str = "volume"
    rotation: tuple = frames.IDENTITY[1]  # from the axes of the coefficients to those of the link
    changed: str = ""
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
    center: Optional[tuple] = None


class Hydrodynamics:
    """Reads the plugins of a model."""

    def __init__(self, model, report):
        self.model, self.report = model, report
        self.coefficients, self.declared = [], []
        self.water = {}  # key: (value, source)
        self.waves = None  # (components, source)
        for link in model.links.values():
            inertial = link.inertial
            if inertial is not None and inertial.fluid_added_mass is not None:
                self.coefficients.append(
                    Coefficients(
                        link.name,
                        inertial.fluid_source,
                        added_mass=inertial.fluid_added_mass,
                        changed="fluid_added_mass as it is",
                    )
                )
        self.stated_density = None  # the element of a plugin that has no other use for it
        for plugin in model.plugins:
            self._read(plugin)
        if self.stated_density is not None:
            self.set_water("density", self.stated_density.numbers(1)[0], self.stated_density)

    def _read(self, plugin):
        names = f"{plugin.name} {plugin.filename}"
        for pattern, reader in _PLUGINS:
            if pattern.search(names) and reader(self, plugin):
                return
        links = [
            element.text.strip()
            for element in plugin.element.walk()
            if element.tag in ("link_name", "joint_name", "linkName", "jointName", "bodyName")
        ]
        of = f" of {', '.join(dict.fromkeys(links))}" if links else ""
        self.report.leave_out(f"{_kind(names)} '{plugin.name}' ({plugin.filename}){of}, {plugin.element.source}")

    def _link(self, plugin, name, element):
        """The full name of a link that a plugin names, or None."""
        for full in (plugin.prefix + name, name):
            if full in self.model.links:
                return full
        self.report.warn(
            f"plugin '{plugin.name}' is for the link '{name}', which does not exist: its coefficients are "
            f"left out; expected one of: {', '.join(self.model.links)} ({element.source})"
        )
        return None

    def set_water(self, key, value, element):
        if key in self.water and self.water[key][0] != value:
            self.report.warn(
                f"{key} of the water is {self.water[key][0]} ({self.water[key][1]}) and {value} "
                f"({element.source}): the first is used"
            )
        self.water.setdefault(key, (value, element.source))

    def gz_hydrodynamics(self, plugin):
        element = plugin.element
        keys = _coefficients(element)
        if not keys or element.find("link_name") is None:
            return False
        link = self._link(plugin, element.child_text("link_name", ""), element)
        if link is None:
            return True
        # gz-sim takes xUU for u^2 since 2023; its ancestors took it for |u| u.
        old = "gz::" not in plugin.name
        result = Coefficients(link, element.source, changed="negated: gz-sim writes derivatives")
        no_added_mass = element.flag("disable_added_mass")
        for (row, dot, column, absolute, second), child in keys:
            value = child.numbers(1)[0]
            if dot:
                if no_added_mass:
                    self.report.leave_out(f"<{child.tag}> = {value:g}: disable_added_mass is set ({child.source})")
                else:
                    result.added_mass[row][column] -= value
                    result.read_from("added_mass", child)
            elif second is None:
                result.linear[row][column] -= value
                result.read_from("linear", child)
            elif second == column and (absolute or old):
                result.quadratic[row][column] -= value
                result.read_from("quadratic", child)
                if not absolute:
                    self.report.note(
                        f"<{child.tag}> is taken as <{child.tag[:2]}abs{child.tag[2:]}>, as this plugin "
                        f"does ({child.source})"
                    )
            elif value != 0:
                why = (
                    "a coefficient of u^2, which pushes backwards"
                    if second == column
                    else "a product of two velocities"
                )
                self.report.leave_out(
                    f"<{child.tag}> = {value:g}: {why}; if |u| u is meant, write "
                    f"<{child.tag[:2]}abs{child.tag[2:]}> ({child.source})"
                )
        if element.flag("disable_coriolis"):
            self.report.note(f"disable_coriolis: the Coriolis terms of added mass act in the scene ({element.source})")
        self.stated_density = self.stated_density or element.find("water_density") or element.find("waterDensity")
        current = element.find("default_current")
        if current is not None:
            self.set_water("current", tuple(current.numbers(3)), current)
        for child in element.children:
            if child.tag.startswith("lookup_current"):
                self.report.leave_out(f"<{child.tag}> {child.text.strip()}: a current from a table ({child.source})")
        self._add(result)
        return True

    def gz_buoyancy(self, plugin):
        element = plugin.element
        uniform, graded = element.find("uniform_fluid_density"), element.find("graded_buoyancy")
        if graded is None:
            if uniform is not None:
                self.set_water("density", uniform.numbers(1)[0], uniform)
            else:
                self.set_water("density", 1000.0, element)
        else:
            default = graded.number("default_density", 1000.0)
            self.set_water("density", default, graded)
            for layer in graded.all("density_change"):
                height, density = layer.number("above_depth", 0.0), layer.number("density", 0.0)
                if density < _AIR and default >= _AIR and "level" not in self.water:
                    self.set_water("level", height, layer)
                    self.report.leave_out(
                        f"graded buoyancy: the {density:g} kg/m^3 above {height:g} m are air, whose "
                        f"buoyancy is left out ({layer.source})"
                    )
                else:
                    self.report.leave_out(
                        f"graded buoyancy: {density:g} kg/m^3 above {height:g} m; the water of the "
                        f"scene has {default:g} kg/m^3 everywhere ({layer.source})"
                    )
        enabled = [(child.text.strip(), child.source) for child in element.all("enable")]
        own = [item for item in enabled if self.model.name in item[0].split("::")]
        if enabled and not own:
            self.report.warn(
                f"<enable> does not name '{self.model.name}': it has no buoyancy in Gazebo, but in the scene "
                f"({enabled[0][1]})"
            )
        for name, source in own:
            if name != self.model.name:
                self.report.note(f"<enable> {name}: every body of the scene is buoyant ({source})")
        return True

    def simple_hydrodynamics(self, plugin):
        """VRX: positive coefficients, some with defaults other than 0, in the axes of the inertial pose."""
        element = plugin.element
        named = element.find("link_name") or element.find("bodyName")
        if named is None:
            return False
        link = self._link(plugin, named.text.strip(), element)
        if link is None:
            return True
        numbers = {"linear": [_VRX_LINEAR] * 6, "quadratic": [0.0] * 6, "added_mass": list(_VRX_ADDED_MASS)}
        inertial = self.model.links[link].inertial
        result = Coefficients(
            link,
            element.source,
            immersion="none",
            rotation=inertial.rotation if inertial else frames.IDENTITY[1],
            changed='as it is, with VRX\'s defaults; measured afloat: immersion "none"',
        )
        for (row, dot, column, absolute, second), child in _coefficients(element):
            value = child.numbers(1)[0]
            if row != column or second not in (None, column):
                self.report.leave_out(f"<{child.tag}> = {value:g}: VRX has no such key ({child.source})")
                continue
            matrix = "added_mass" if dot else "linear" if second is None else "quadratic"
            numbers[matrix][row] = value
            result.read_from(matrix, child)
        for matrix, values in numbers.items():
            setattr(result, matrix, frames.diagonal(values))
        self._add(result)
        for tag, key in (("waterLevel", "level"), ("waterDensity", "density")):
            found = element.find(tag)
            if found is not None:
                self.set_water(key, found.numbers(1)[0], found)
        for tag in ("hullRadius", "boatWidth", "boatLength", "wave_model"):
            if element.find(tag) is not None:
                self.report.leave_out(
                    f"<{tag}> {element.child_text(tag, '')}: buoyancy follows from the geometry "
                    f"({element.find(tag).source})"
                )
        return True

    def surface(self, plugin):
        """VRX: buoyancy of points of a hull; water level, density and waves are used."""
        element = plugin.element
        for tag, key in (("fluid_level", "level"), ("fluid_density", "density")):
            found = element.find(tag)
            if found is not None:
                self.set_water(key, found.numbers(1)[0], found)
        for tag in (
            "vehicle_length",
            "vehicle_width",
            "hull_radius",
            "hull_length",
            "points",
            "buoyancy",
            "linear_drag",
            "angular_drag",
        ):
            found = element.find(tag)
            if found is not None:
                value = f" = {found.text.strip()}" if found.text.strip() else ""
                why = "give [body.drag] instead" if "drag" in tag else "buoyancy follows from the geometry"
                self.report.leave_out(f"<{tag}>{value} of '{plugin.name}': {why} ({found.source})")
        self.wavefield(plugin)
        return True

    def wavefield(self, plugin):
        holder = next((e for e in plugin.element.walk() if e.tag == "wavefield" and e.find("wave") is not None), None)
        if holder is not None:
            wave = holder.find("wave")
            values = {child.tag: child.text.strip() for child in wave.children}
            self._waves(values, wave)
            return True
        messages = [e for e in plugin.element.walk() if "wavefield" in e.get("topic", "")]
        for message in messages:
            pairs = re.findall(
                r'key:\s*"(\w+)"\s*value\s*\{[^{}]*?(?:double_value|int_value|string_value|bool_value):'
                r'\s*"?([^"\s}]+)',
                message.text,
            )
            self._waves(dict(pairs), message)
        return bool(messages)

    def _waves(self, values, element):
        """The components of VRX's wave field: model PMS (a spectrum in three lines) or CWR."""

        def value(key, default):
            return element.numbers(1, values[key], f"<{key}>")[0] if key in values else default

        number, period = int(value("number", 3)), value("period", 5.0)
        scale, angle, gain, amplitude = (
            value("scale", 1.1),
            value("angle", 0.4),
            value("gain", 1.0),
            value("amplitude", 0),
        )
        phase, model = value("phase", 0.0), values.get("model", "PMS")
        words = values.get("direction", "0").split()
        direction = math.atan2(float(words[1]), float(words[0])) if len(words) == 2 else value("direction", 0.0)
        if model not in ("PMS", "CWR") or period <= 0 or scale <= 0 or number > (3 if model == "PMS" else 100):
            self.report.leave_out(f"wavefield: model {model}, {number} waves of {period:g} s ({element.source})")
            return
        omega = 2 * math.pi / period
        spacing = (omega * (1 - 1 / scale), omega * (scale - 1 / scale) / 2, omega * (scale - 1))
        components = []
        for i in range(number):
            n = i - (1 if model == "PMS" else number // 2)
            if model == "PMS":
                own = omega * scale**n
                density = 0.0081 * 9.81**2 / own**5 * math.exp(-1.25 * (omega / own) ** 4)
                height = gain * math.sqrt(max(0.0, 2 * density * spacing[i]))
            else:
                own, height = omega / math.sqrt(scale**n), scale**n * amplitude
            if height > 0:
                components.append((height, own, math.degrees(direction + n * angle), math.degrees(phase)))
        if components and self.waves is None:
            self.waves = (components, element.source)
        if value("steepness", 0.0):
            self.report.leave_out(
                f"wavefield: steepness {values['steepness']}, waves of Gerstner; those of the scene are "
                f"linear ({element.source})"
            )
        if "tau" in values and components:
            self.report.leave_out(
                f"wavefield: tau {values['tau']} s, the growth of the waves at the start; "
                f"[water] has ramp ({element.source})"
            )

    def underwater_object(self, plugin):
        """uuv_simulator and Plankton: damping negative, added mass positive, axes forward, right, down."""
        element = plugin.element
        links = [
            child
            for child in element.all("link")
            if child.find("hydrodynamic_model") is not None or child.find("volume") is not None
        ]
        if not links:
            return False
        density = element.number("fluid_density", 1028.0)
        self.set_water("density", density, element.find("fluid_density") or element)
        for child in links:
            link = self._link(plugin, child.get("name", ""), child)
            if link is not None:
                self._declared_buoyancy(child, link, density)
                self._underwater_model(child, link, density)
        return True

    def _declared_buoyancy(self, element, link, density):
        declared = Declared(link, element.source)
        volume, inertial = element.number("volume"), self.model.links[link].inertial
        if element.flag("neutrally_buoyant") and inertial is not None:
            volume = inertial.mass / density
        if volume is not None:
            model = element.find("hydrodynamic_model") or element
            factor = element.number("scaling_volume", model.number("scaling_volume", 1.0))
            offset = element.number("offset_volume", model.number("offset_volume", 0.0))
            declared.volume = max(0.0, factor * (volume + offset))
        center = element.find("center_of_buoyancy")
        if center is not None:
            declared.center = tuple(center.numbers(3))
        self.declared.append(declared)
        for tag in ("metacentric_width", "metacentric_length", "submerged_height"):
            if element.find(tag) is not None:
                self.report.leave_out(
                    f"<{tag}> {element.child_text(tag, '')}: stability follows from the geometry "
                    f"({element.find(tag).source})"
                )

    def _underwater_model(self, element, link, density):
        model = element.find("hydrodynamic_model")
        if model is None:
            return
        kind = model.child_text("type", "fossen")
        result = Coefficients(
            link,
            model.source,
            changed="damping negated, y and z reversed (uuv_simulator's axes are " "forward, right, down)",
        )

        def read(tag):
            found = model.find(tag)
            if found is None or not found.text.strip():
                return frames.zeros()
            numbers = found.numbers((6, 36))
            result.read_from(
                {"added_mass": tag, "linear_damping": "linear", "quadratic_damping": "quadratic"}.get(tag), found
            )
            return frames.diagonal(numbers) if len(numbers) == 6 else [numbers[6 * i : 6 * i + 6] for i in range(6)]

        def number(tag, default):
            return model.number(tag, element.number(tag, default))

        matrices = {
            tag: read(tag)
            for tag in ("added_mass", "linear_damping", "quadratic_damping", "linear_damping_forward_speed")
        }
        if kind in _SHAPES:
            result.changed += f"; coefficients of a {kind}, with {density:g} kg/m^3"
            if not _SHAPES[kind](model, density, matrices):
                self.report.leave_out(f"hydrodynamic model '{kind}': its lengths are not stated ({model.source})")
        elif kind != "fossen":
            self.report.leave_out(f"hydrodynamic model '{kind}', which is not known ({model.source})")
        scales = {"added_mass": number("scaling_added_mass", 1.0), "damping": number("scaling_damping", 1.0)}
        offsets = {
            "added_mass": number("offset_added_mass", 0.0),
            "linear": number("offset_linear_damping", 0.0),
            "quadratic": number("offset_nonlin_damping", 0.0),
        }
        if set(scales.values()) != {1.0} or set(offsets.values()) != {0.0}:
            result.changed += "; scaling and offsets applied"

        signs = frames.REVERSED_Y_Z
        for i in range(6):
            for j in range(6):
                sign, own = signs[i] * signs[j], float(i == j)
                result.added_mass[i][j] = (
                    sign * scales["added_mass"] * (matrices["added_mass"][i][j] + own * offsets["added_mass"])
                )
                result.linear[i][j] = (
                    -sign * scales["damping"] * (matrices["linear_damping"][i][j] + own * offsets["linear"])
                )
                if i == j:
                    result.quadratic[i][j] = -scales["damping"] * (
                        matrices["quadratic_damping"][i][j] + offsets["quadratic"]
                    )
                elif matrices["quadratic_damping"][i][j]:
                    self.report.leave_out(
                        f"quadratic_damping, row {i + 1}, column {j + 1}: uuv_simulator uses only the "
                        f"diagonal ({model.find('quadratic_damping').source})"
                    )
        forward = matrices["linear_damping_forward_speed"]
        if any(value for row in forward for value in row) or number("offset_lin_forward_speed_damping", 0.0):
            words = " ".join(model.child_text("linear_damping_forward_speed", "").split())
            self.report.leave_out(
                f"linear_damping_forward_speed {words}, times the speed u forwards; at a cruising speed "
                f"u, add -u times it to `linear`, with y and z reversed ({model.source})"
            )
        self._add(result)

    def current(self, plugin):
        """The ocean current of uuv_simulator, Plankton and DAVE: mean speed and two angles [rad]."""
        constant = plugin.element.find("constant_current")
        if constant is None:
            return False
        speed = constant.number("velocity/mean", 0.0)
        horizontal, vertical = (constant.number(f"{name}_angle/mean", 0.0) for name in ("horizontal", "vertical"))
        self.set_water(
            "current",
            (
                speed * math.cos(horizontal) * math.cos(vertical),
                speed * math.sin(horizontal) * math.cos(vertical),
                speed * math.sin(vertical),
            ),
            constant,
        )
        for child in plugin.element.all("transient_current", "tidal_oscillation"):
            self.report.leave_out(f"<{child.tag}>: the current of a scene is constant ({child.source})")
        if any(constant.number(f"{name}/noiseAmp", 0.0) for name in ("velocity", "horizontal_angle", "vertical_angle")):
            self.report.leave_out(f"the noise of the current ({constant.source})")
        return True

    def _add(self, coefficients):
        self.coefficients.append(coefficients)


def _coefficients(element):
    """The keys of SNAME's derivatives: ((row, is added mass, column, has abs, second column), element)."""
    result = []
    for child in element.children:
        match = _COEFFICIENT.fullmatch(child.tag.replace("_", "").lower())
        if match and child.text.strip():
            force, dot, velocity, absolute, second = match.groups()
            result.append(
                (
                    (
                        _FORCES.index(force),
                        bool(dot),
                        _VELOCITIES.index(velocity),
                        bool(absolute),
                        _VELOCITIES.index(second) if second else None,
                    ),
                    child,
                )
            )
    return result


def _sphere(model, density, matrices):
    radius = model.number("radius")
    if radius is None:
        return False
    for i in range(3):
        matrices["added_mass"][i][i] = 2 / 3 * density * math.pi * radius**3
        matrices["quadratic_damping"][i][i] = -0.5 * density * 0.5 * math.pi * radius**2
    return True


def _cylinder(model, density, matrices):
    """Sets the matrices as uuv_simulator does, whose added mass along the axis is that of a length of 1 m."""
    radius, length, axis = model.number("radius"), model.number("length"), model.child_text("axis", "")
    if radius is None or length is None or axis not in ("i", "j", "k"):
        return False
    slenderness = length / (2 * radius)
    along = next(cd for limit, cd in ((1, 0.91), (2, 0.85), (4, 0.87), (math.inf, 0.99)) if slenderness <= limit)
    across = next(
        cd for limit, cd in ((1, 0.63), (2, 0.68), (5, 0.74), (10, 0.82), (math.inf, 0.98)) if slenderness <= limit
    )
    section = density * math.pi * radius**2
    for i in range(3):
        is_axis = i == "ijk".index(axis)
        matrices["added_mass"][i][i] = section if is_axis else section * length
        matrices["quadratic_damping"][i][i] = -0.5 * (
            along * section if is_axis else across * radius * length * density
        )
        if not is_axis:
            matrices["added_mass"][3 + i][3 + i] = section * length**3 / 12
    return True


def _box(model, density, matrices):
    sides = [model.number(name) for name in ("length", "width", "height")]
    if None in sides:
        return False
    for i in range(3):
        area = sides[(i + 1) % 3] * sides[(i + 2) % 3]
        matrices["quadratic_damping"][i][i] = -0.5 * model.number("cd", 1.0) * area * density
    return True


_SHAPES = {"sphere": _sphere, "cylinder": _cylinder, "box": _box}


def _kind(names):
    for pattern, kind in (("thrust|propeller|motor_?model", "thruster"), ("lift.?drag|fin_", "fin"), ("buoyancy.?engine", "tank")):
        if re.search(pattern, names, re.IGNORECASE):
            return kind
    return "plugin"


def _named(pattern):
    return re.compile(pattern, re.IGNORECASE)


# The first reader that knows a plugin converts it; a reader returns False if the plugin has none of its keys.
_PLUGINS = (
    (_named(r"simple_?hydrodynamics|usv_gazebo_dynamics"), Hydrodynamics.simple_hydrodynamics),
    (_named(r"underwater_object|uuv_plugin"), Hydrodynamics.underwater_object),
    (_named(r"::Hydrodynamics|hydrodynamics-system|HydrodynamicsPlugin"), Hydrodynamics.gz_hydrodynamics),
    (_named(r"systems::Buoyancy\b|gz-sim\d*-buoyancy-system|gazebo\d*-buoyancy-system"), Hydrodynamics.gz_buoyancy),
    (_named(r"vrx::Surface|systems::Surface|libSurface|surface-system|PolyhedraBuoyancyDrag"), Hydrodynamics.surface),
    (_named(r"current"), Hydrodynamics.current),
    (_named(r"wave|publisher"), Hydrodynamics.wavefield),
)


def with_body_frame(coefficients, pose):
    """The matrices turned to the body's axes, the link's origin in the body, and the rotation; `pose` is the link's."""
    rotation = frames.product(pose[1], coefficients.rotation)
    return (
        [
            frames.turned_6(matrix, rotation)
            for matrix in (coefficients.linear, coefficients.quadratic, coefficients.added_mass)
        ],
        pose[0],
        rotation,
    )


def admissible(matrix, what, source, report, symmetric=False):
    """The matrix, changed where a scene file would refuse it; every change is reported."""
    result = [list(row) for row in matrix]
    if symmetric:
        worst = max(abs(result[i][j] - result[j][i]) for i in range(6) for j in range(i + 1))
        scale = max(abs(value) for row in result for value in row) or 1.0
        if worst > 1e-9 * scale:
            report.warn(f"{what} is not symmetric (by up to {worst:.6g}): the mean of both elements is used ({source})")
        result = [[(result[i][j] + result[j][i]) / 2 for j in range(6)] for i in range(6)]
    for i in range(6):
        if result[i][i] < 0:
            report.warn(
                f"{what} has {result[i][i]:.6g} in row {i + 1}, column {i + 1}, which would drive the motion; "
                f"expected a number of the other sign. It is left out, with its row and column: correct the sign "
                f"in the model if it was mistyped ({source})"
            )
            report.leave_out(f"{what}, row and column {i + 1}: {result[i][i]:.6g} has the wrong sign ({source})")
            for j in range(6):
                result[i][j] = result[j][i] = 0.0
    if not _is_semidefinite(result):
        lost = [
            f"row {i + 1}, column {j + 1}: {result[i][j]:.6g}"
            for i in range(6)
            for j in range(6)
            if i != j and result[i][j]
        ]
        report.warn(
            f"{what} would drive some motion: it is not positive semidefinite. Only its diagonal is used ({source})"
        )
        report.leave_out(f"elements of {what} off the diagonal: {'; '.join(lost)} ({source})")
        result = [[result[i][j] if i == j else 0.0 for j in range(6)] for i in range(6)]
    return [[value + 0.0 if abs(value) > 1e-12 else 0.0 for value in row] for row in result]


def _is_semidefinite(matrix):
    """Whether Cholesky's decomposition of the symmetric part, scaled to a diagonal of ones, succeeds within 1e-7."""
    scale = [math.sqrt(matrix[i][i]) for i in range(6)]
    if any(i != j and (matrix[i][j] + matrix[j][i]) and not scale[i] * scale[j] for i in range(6) for j in range(6)):
        return False
    lower = frames.zeros()
    for i in range(6):
        for j in range(i + 1):
            unit = scale[i] * scale[j] or 1.0
            rest = (matrix[i][j] + matrix[j][i]) / 2 / unit + (1e-7 if i == j else 0.0)
            rest -= sum(lower[i][k] * lower[j][k] for k in range(j))
            if i == j and rest < 0:
                return False
            lower[i][j] = math.sqrt(rest) if i == j else rest / lower[j][j]
    return True
