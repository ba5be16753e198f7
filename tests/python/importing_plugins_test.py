"""What plugins of other simulators become, compared with values computed by hand and with docs/importing.md."""
import math
import re
import tomllib
import unittest

from importing_support import ImportTestCase, box, fixed, inertial, link, sdf, world
from support import SOURCE

GZ = "filename='gz-sim-hydrodynamics-system' name='gz::sim::systems::Hydrodynamics'"
VRX = "filename='libSimpleHydrodynamics.so' name='vrx::SimpleHydrodynamics'"
UUV = "filename='libuuv_underwater_object_ros_plugin.so' name='uuv_plugin'"


def plugin(names, **keys):
    inside = "".join(f"<{key}>{value}</{key}>" for key, value in keys.items())
    return f"<plugin {names}><link_name>base</link_name>{inside}</plugin>"


def uuv(model, inside="", density="<fluid_density>1000</fluid_density>", name="base"):
    return (
        f"<plugin {UUV}>{density}<link name='{name}'>{inside}<hydrodynamic_model>{model}</hydrodynamic_model></link>"
        "</plugin>"
    )


def element(i, j, matrix):
    return matrix[6 * i + j]


SECTION = 1000 * math.pi / 4  # of cylinders and spheres of 1 m, with the density of water
# Plugins, and the tables that they become.
COEFFICIENTS = {
    "gz-sim is negated": (
        plugin(GZ, xU=-4, yV=-6, xUabsU=-18, nRabsR=-2, xDotU=-5.5, nDotR=-0.5),
        {"linear": [4, 6, 0, 0, 0, 0], "quadratic": [18, 0, 0, 0, 0, 2], "center": [0, 0, 0], "immersion": "volume"},
        {"matrix": [5.5, 0, 0, 0, 0, 0.5], "center": [0, 0, 0], "immersion": "volume"},
    ),
    "both spellings are read": (
        plugin(GZ, x_u=-4, x_u_abs_u=-18, x_dot_u=-5),
        {"linear": [4, 0, 0, 0, 0, 0], "quadratic": [18, 0, 0, 0, 0, 0]},
        {"matrix": [5, 0, 0, 0, 0, 0]},
    ),
    "VRX keeps signs and has defaults": (
        plugin(VRX, xU=95, xUU=150, yV=105, nDotR=40),
        {"linear": [95, 105, 20, 20, 20, 20], "quadratic": [150, 0, 0, 0, 0, 0], "immersion": "none"},
        {"matrix": [5, 5, 0.1, 0.1, 0.1, 40]},
    ),
    "fossen has scaling and offsets": (
        uuv(
            "<type>fossen</type><added_mass>1 2 3 4 5 6</added_mass><linear_damping>-1 -2 -3 -4 -5 -6</linear_damping>"
            "<quadratic_damping>-1 -1 -1 -1 -1 -1</quadratic_damping><scaling_added_mass>2</scaling_added_mass>"
            "<offset_added_mass>1</offset_added_mass><scaling_damping>3</scaling_damping>"
            "<offset_linear_damping>-1</offset_linear_damping><offset_nonlin_damping>0.5</offset_nonlin_damping>"
        ),
        {"linear": [6, 9, 12, 15, 18, 21], "quadratic": [1.5] * 6},
        {"matrix": [4, 6, 8, 10, 12, 14]},
    ),
    "sphere": (
        uuv("<type>sphere</type><radius>0.5</radius>"),
        {"quadratic": [0.5 * 0.5 * SECTION] * 3 + [0] * 3},
        {"matrix": [1000 * 2 / 3 * math.pi / 8] * 3 + [0] * 3},
    ),
    "cylinder": (
        uuv("<type>cylinder</type><radius>0.5</radius><length>3</length><axis>i</axis>"),
        {"quadratic": [0.5 * 0.87 * SECTION, 0.5 * 0.74 * 1500, 0.5 * 0.74 * 1500, 0, 0, 0]},
        {"matrix": [SECTION, 3 * SECTION, 3 * SECTION, 0, SECTION * 27 / 12, SECTION * 27 / 12]},
    ),
    "box": (
        uuv("<type>box</type><cd>2</cd><length>4</length><width>2</width><height>1</height>"),
        {"quadratic": [2000, 4000, 8000, 0, 0, 0]},
        {},
    ),
}


class ConvertsHydrodynamics(ImportTestCase):
    def loads(self, plugin_text, inside=None):
        return self.import_model(sdf((inside or link()) + plugin_text))

    def test_coefficients(self):
        for name, (text, *expected) in COEFFICIENTS.items():
            body = self.loads(text).body
            self.assertEqual(body["outputs"], ["wrench", "loads"])
            for table, values in zip(("drag", "added_mass"), expected):
                for key, value in values.items():
                    with self.subTest(name, key=key):
                        if key == "immersion":
                            self.assertEqual(body[table][key], value)
                        else:
                            self.assert_numbers(body[table][key], value)

    def test_gz_sim_cross_terms_have_row_and_column(self):
        body = self.loads(
            plugin(
                GZ, yV=-6, nR=-5, yR=1, nV=0.5, yVabsV=-3, nRabsR=-4, yRabsR=-0.5, yDotV=-7, nDotR=-8, yDotR=2, nDotV=2
            )
        ).body
        linear, quadratic, added = (body["drag"]["linear"], body["drag"]["quadratic"], body["added_mass"]["matrix"])
        self.assertEqual((element(1, 5, linear), element(5, 1, linear)), (-1, -0.5))
        self.assertEqual((element(1, 5, quadratic), element(5, 1, quadratic)), (0.5, 0))
        self.assertEqual((element(1, 5, added), element(5, 1, added), element(5, 5, added)), (-2, -2, 8))

    def test_square_without_sign_has_no_counterpart(self):
        result = self.loads(plugin(GZ, xU=-4, xUU=-18, yVabsR=-3))
        self.assertNotIn("quadratic", result.body["drag"])
        self.assertIn("<xUU> = -18: a coefficient of u^2", result.output)
        self.assertIn("<yVabsR> = -3: a product of two velocities", result.output)
        old = self.loads(plugin(GZ.replace("gz::sim", "ignition::gazebo"), xUU=-18))
        self.assertEqual(old.body["drag"]["quadratic"][0], 18)

    def test_fluid_added_mass_keeps_its_sign(self):
        numbers = "<xx>5</xx><yy>6</yy><zz>7</zz><pp>1</pp><qq>2</qq><rr>3</rr><yr>0.5</yr>"
        added = f"<fluid_added_mass>{numbers}</fluid_added_mass>"
        inside = box() + inertial().replace("</inertial>", added + "</inertial>")
        matrix = self.loads("", link(inside=inside)).body["added_mass"]["matrix"]
        self.assertEqual([element(i, i, matrix) for i in range(6)], [5, 6, 7, 1, 2, 3])
        self.assertEqual((element(1, 5, matrix), element(5, 1, matrix)), (0.5, 0.5))

    def test_wrong_sign_is_reported_and_left_out(self):
        result = self.loads(plugin(GZ, xU=4, yV=-6))
        self.assertEqual(result.body["drag"]["linear"], [0, 6, 0, 0, 0, 0])
        self.assertIn("linear drag has -4 in row 1, column 1", result.output)
        self.assertIn("# - linear drag, row and column 1: -4 has the wrong sign", result.text)

    def test_matrix_that_drives_loses_its_cross_terms(self):
        result = self.loads(plugin(GZ, yV=-1, nR=-1, yR=-5, nV=-5))
        self.assertEqual(result.body["drag"]["linear"], [0, 1, 0, 0, 0, 1])
        self.assertIn("row 2, column 6: 5; row 6, column 2: 5", result.text)

    def test_usv_plugin_of_gazebo_classic(self):
        text = (
            "<plugin filename='libusv_gazebo_dynamics_plugin.so' name='usv'><bodyName>base</bodyName>"
            "<waterLevel>0.5</waterLevel><waterDensity>997.8</waterDensity><xU>51</xU>"
            "<hullRadius>0.2</hullRadius></plugin>"
        )
        result = self.loads(text)
        self.assertEqual(result.body["drag"]["linear"][0], 51)
        self.assertEqual(result.scene["water"], {"density": 997.8, "level": 0.5})
        self.assertIn("<hullRadius> 0.2", result.output)

    def test_fossen_reverses_y_and_z(self):
        numbers = [0.0] * 36
        for i, value in enumerate((50, 60, 70, 8, 9, 10)):
            numbers[7 * i] = value
        for i, j, value in ((0, 4, -6), (1, 3, 5), (1, 5, 4)):  # one of each pair belongs to x, or both or none
            numbers[6 * i + j] = numbers[6 * j + i] = value
        model = (
            f"<type>fossen</type><added_mass>{' '.join(map(str, numbers))}</added_mass>"
            "<linear_damping>-4 -6 -5 -1 -2 -3</linear_damping>"
            "<quadratic_damping>-18 -21 -37 -1 -1 -1</quadratic_damping>"
        )
        body = self.loads(uuv(model)).body
        matrix = body["added_mass"]["matrix"]
        self.assertEqual([element(i, i, matrix) for i in range(6)], [50, 60, 70, 8, 9, 10])
        self.assertEqual([element(0, 4, matrix), element(1, 3, matrix), element(1, 5, matrix)], [6, -5, 4])
        self.assertEqual(body["drag"]["linear"], [4, 6, 5, 1, 2, 3])
        self.assertEqual(body["drag"]["quadratic"], [18, 21, 37, 1, 1, 1])

    def test_forward_speed_is_reported(self):
        result = self.loads(
            uuv(
                "<type>fossen</type><linear_damping>-1 -1 -1 -1 -1 -1</linear_damping>"
                "<linear_damping_forward_speed>0 0 0 0 0 -7</linear_damping_forward_speed>"
            )
        )
        self.assertIn("linear_damping_forward_speed 0 0 0 0 0 -7", result.output)

    def test_declared_buoyancy_is_compared(self):
        inside = "<volume>1.1</volume><center_of_buoyancy>0 0 0.1</center_of_buoyancy>"
        output = self.loads(uuv("<type>fossen</type>", inside)).output
        self.assertIn("declares a volume of 1.1 m^3, its geometry has 1 m^3 (-9.09 %)", output)
        self.assertIn("declares the centre of buoyancy (0, 0, 0.1) m, that of its geometry is (0, 0, 0) m", output)
        scaled = self.loads(uuv("<type>fossen</type>", "<volume>0.5</volume><scaling_volume>2</scaling_volume>"))
        self.assertNotIn("declares", scaled.output)
        neutral = self.loads(uuv("<type>fossen</type>", "<neutrally_buoyant>1</neutrally_buoyant>"))
        self.assertIn("declares a volume of 0.5 m^3", neutral.output)

    def test_impossible_volumes_and_densities_are_refused(self):
        for inside, density, words in (
            ("<volume>-1</volume>", 1000, "declares a volume of -1 m^3 for the link 'base'"),
            ("<volume>nan</volume>", 1000, "<volume> is 'nan'"),
            ("<volume>1</volume><offset_volume>-1</offset_volume>", 1000, "declares a volume of 0 m^3"),
            ("<neutrally_buoyant>1</neutrally_buoyant>", 0, "the density of the water is 0 kg/m^3"),
        ):
            with self.subTest(inside=inside):
                text = uuv("<type>fossen</type>", inside, f"<fluid_density>{density}</fluid_density>")
                self.assert_refused(sdf(link() + text), words, "model.sdf:1")

    def test_coefficients_of_turned_link(self):
        # The nose is turned by 90 degrees about z: its x is the body's y. It is at x = 2.
        model = link() + link("nose", inertial(1), "<pose degrees='true'>2 0 0 0 0 90</pose>") + fixed("base", "nose")
        text = plugin(GZ, xU=-1, yV=-2, xUabsU=-3, xDotU=-4).replace(">base<", ">nose<")
        body = self.loads(text, model).body
        self.assertEqual(body["drag"]["linear"], [2, 1, 0, 0, 0, 0])
        self.assertEqual(body["drag"]["quadratic"], [0, 3, 0, 0, 0, 0])
        self.assertEqual(body["added_mass"]["matrix"], [0, 4, 0, 0, 0, 0])
        self.assertEqual(body["drag"]["center"], [2, 0, 0])

    def test_coefficients_of_two_links_add_up(self):
        # Sway drag 3 at x = 2, seen from the base: 3 in sway, 6 between sway and yaw, 12 in yaw.
        model = link() + link("nose", inertial(1), "<pose>2 0 0 0 0 0</pose>") + fixed("base", "nose")
        text = plugin(GZ, yV=-1) + plugin(GZ, yV=-3).replace(">base<", ">nose<")
        linear = self.loads(text, model).body["drag"]["linear"]
        self.assertEqual([element(i, j, linear) for i, j in ((1, 1), (1, 5), (5, 1), (5, 5))], [4, 6, 6, 12])

    def test_buoyancy_of_links_is_reported(self):
        buoyancy = "<buoyancy><damping xyz='1 2 3'/></buoyancy>"
        shape = "<collision><geometry><box size='1 1 1'/></geometry></collision>"
        urdf = f"<robot name='vehicle'><link name='base'>{shape}{buoyancy}</link></robot>"
        for text, name in ((sdf(link(inside=box() + buoyancy)), "boat.sdf"), (urdf, "boat.urdf")):
            self.assertIn("- <buoyancy> of 'base', of freefloating_gazebo", self.import_model(text, name=name).output)

    def test_unknown_links_and_plugins_are_named(self):
        result = self.loads(
            plugin(GZ, xU=-1).replace(">base<", ">bow<")
            + "<plugin name='gz::sim::systems::Thruster' filename='gz-sim-thruster-system'>"
            "<joint_name>shaft</joint_name></plugin>"
            + "<plugin name='gz::sim::systems::LiftDrag' filename='gz-sim-lift-drag-system'>"
            "<link_name>fin</link_name></plugin><plugin name='mine' filename='libmine.so'/>"
        )
        for words in (
            "the link 'bow', which does not exist",
            "thruster 'gz::sim::systems::Thruster'",
            "of shaft",
            "fin 'gz::sim::systems::LiftDrag'",
            "plugin 'mine' (libmine.so)",
        ):
            self.assertIn(words, result.output)
            if words[0] != "t" or "thruster" in words:
                self.assertIn(words, result.text)


class ConvertsWater(ImportTestCase):
    BUOYANCY = "<plugin filename='gz-sim-buoyancy-system' name='gz::sim::systems::Buoyancy'>{}</plugin>"

    def test_uniform_density(self):
        text = world(self.BUOYANCY.format("<uniform_fluid_density>998</uniform_fluid_density>"))
        self.assertEqual(self.import_model(text).scene["water"]["density"], 998)

    def test_density_of_hydrodynamics_is_second_choice(self):
        for key in ("water_density", "waterDensity"):
            text = f"<model name='vehicle'>{link() + plugin(GZ, xU=-1, **{key: 998})}</model>"
            self.assertEqual(self.import_model(world(model=text)).scene["water"]["density"], 998)
            buoyancy = self.BUOYANCY.format("<uniform_fluid_density>1020</uniform_fluid_density>")
            result = self.import_model(world(buoyancy, model=text))
            self.assertEqual(result.scene["water"]["density"], 1020)
            self.assertIn("density of the water is 1020.0 (model.sdf:1) and 998.0 (model.sdf:1)", result.output)

    def graded(self, default, *changes):
        inside = f"<default_density>{default}</default_density>" + "".join(
            f"<density_change><above_depth>{height}</above_depth><density>{density}</density></density_change>"
            for height, density in changes
        )
        return self.BUOYANCY.format(f"<graded_buoyancy>{inside}</graded_buoyancy>")

    def test_graded_buoyancy_gives_layers_and_level(self):
        for default, changes, water in (
            (1000, [(0, 1)], {"density": 1000, "level": 0}),
            (1020, [], {"density": 1020}),
            (1020, [(-5, 1000), (2, 1)],
             {"density": 1000, "level": 2, "layer": [{"below": -5, "density": 1020}]}),
            # In whatever order, and with a height that changes nothing.
            (1030, [(0, 1.2), (-1, 850), (-4, 1030), (-3, 1000)],
             {"density": 850, "level": 0,
              "layer": [{"below": -1, "density": 1000}, {"below": -3, "density": 1030}]}),
            # Without air the water ends at the level of the scene, which is 0.
            (1030, [(-2, 1000)], {"density": 1000, "layer": [{"below": -2, "density": 1030}]}),
        ):
            result = self.import_model(world(self.graded(default, *changes)))
            self.assertEqual(result.scene["water"], water)
            self.assertEqual("are air" in result.text, "level" in water)

    def test_layers_that_no_scene_has_are_reported(self):
        for default, changes, water, words in (
            (1000, [(-2, 1030), (1, 1)], {"density": 1000, "level": 1},
             "1030 kg/m^3 above -2 m: the fluid under it is lighter"),
            (1030, [(3, 1000)], {"density": 1030},
             "1000 kg/m^3 above 3 m: the water of the scene ends at its level, 0 m"),
        ):
            result = self.import_model(world(self.graded(default, *changes)))
            self.assertEqual(result.scene["water"], water)
            self.assertIn(words, result.text)
        many = [(-20 + i, 1000 - i) for i in range(18)]
        self.assert_refused(world(self.graded(1001, *many)), "19 layers of water; expected at most 17")

    def test_enabled_entities_are_those_of_the_model(self):
        for names, words in (
            (["vehicle"], None),
            (["raft", "vehicle::base"], "note: <enable> vehicle::base: every body of the scene is buoyant"),
            (["raft", "buoy"], "warning: <enable> does not name 'vehicle'"),
        ):
            inside = "".join(f"<enable>{name}</enable>" for name in names)
            output = self.import_model(world(self.BUOYANCY.format(inside))).output
            self.assertNotIn("<enable> raft", output)
            if words is None:
                self.assertNotIn("enable", output)
            else:
                self.assertIn(words, output)

    def test_current_has_two_angles(self):
        text = (
            "<plugin filename='libuuv_underwater_current_ros_plugin.so' name='underwater_current_plugin'>"
            "<constant_current><velocity><mean>2</mean></velocity><horizontal_angle><mean>0.5</mean></horizontal_angle>"
            "<vertical_angle><mean>0.25</mean></vertical_angle></constant_current></plugin>"
        )
        self.assert_numbers(
            self.import_model(world(text)).scene["water"]["current"]["velocity"],
            [2 * math.cos(0.5) * math.cos(0.25), 2 * math.sin(0.5) * math.cos(0.25), 2 * math.sin(0.25)],
        )

    def test_current_of_gz_sim(self):
        text = sdf(link() + plugin(GZ, xU=-1, default_current="0.3 0.1 0"))
        self.assertEqual(self.import_model(text).scene["water"]["current"]["velocity"], [0.3, 0.1, 0])

    def test_surface_of_vrx_has_waves(self):
        wave = (
            "<wave><model>CWR</model><number>3</number><period>4</period><amplitude>0.1</amplitude><scale>2</scale>"
            "<angle>0.5</angle><direction>0 1</direction></wave>"
        )
        text = (
            "<plugin filename='libSurface.so' name='vrx::Surface'><link_name>base</link_name>"
            "<fluid_level>1</fluid_level>"
            f"<hull_radius>0.2</hull_radius><linear_drag>25</linear_drag><wavefield>{wave}</wavefield></plugin>"
        )
        result = self.import_model(sdf(link() + text))
        water = result.scene["water"]
        self.assertEqual(water["level"], 1)
        self.assertIn("<hull_radius> = 0.2 of 'vrx::Surface': buoyancy follows from the geometry", result.text)
        self.assertIn("<linear_drag> = 25 of 'vrx::Surface': give [body.drag] instead", result.text)
        omega = math.pi / 2
        expected = [
            (0.05, omega * math.sqrt(2), 90 - math.degrees(0.5)),
            (0.1, omega, 90),
            (0.2, omega / math.sqrt(2), 90 + math.degrees(0.5)),
        ]
        for component, (amplitude, frequency, direction) in zip(water["waves"][0]["components"], expected):
            self.assert_numbers(
                [component[key] for key in ("amplitude", "angular_frequency", "direction")],
                [amplitude, frequency, direction],
            )

    def test_spectrum_of_vrx(self):
        wave = "<wave><model>PMS</model><number>3</number><period>5</period><gain>0.5</gain><scale>1.1</scale></wave>"
        text = f"<plugin filename='libSurface.so' name='vrx::Surface'><wavefield>{wave}</wavefield></plugin>"
        components = self.import_model(sdf(link() + text)).scene["water"]["waves"][0]["components"]
        peak = 2 * math.pi / 5
        density = 0.0081 * 9.81**2 / peak**5 * math.exp(-1.25)
        middle = 0.5 * math.sqrt(2 * density * peak * (1.1 - 1 / 1.1) / 2)
        self.assert_numbers([components[1]["amplitude"], components[1]["angular_frequency"]], [middle, peak])
        self.assertAlmostEqual(components[2]["angular_frequency"], 1.1 * peak)


class FollowsConversionTables(ImportTestCase):
    """The examples of docs/importing.md, as XML and as the tables that they become."""

    def blocks(self, heading):
        page = (SOURCE / "docs" / "importing.md").read_text(encoding="utf-8")
        section = page.split(f"\n### {heading}\n")[1]
        return (
            re.search(r"```xml\n(.*?)```", section, re.DOTALL).group(1),
            tomllib.loads(re.search(r"```toml\n(.*?)```", section, re.DOTALL).group(1)),
        )

    def compare(self, model, expected):
        result = self.import_model(model)
        for table in ("drag", "added_mass"):
            for key, value in expected["body"][0][table].items():
                self.assertEqual(result.body[table][key], value, (table, key))
        return result

    def test_gz_sim(self):
        xml, expected = self.blocks("gz-sim")
        result = self.compare(sdf(link("base_link") + xml), expected)
        self.assertEqual(result.scene["water"]["current"], expected["water"]["current"])

    def test_vrx(self):
        xml, expected = self.blocks("VRX")
        self.compare(sdf(link("base_link") + xml), expected)

    def test_uuv_simulator(self):
        xml, expected = self.blocks("uuv_simulator")
        self.compare(sdf(link() + f"<plugin {UUV}><link name='base'>{xml}</link></plugin>"), expected)


if __name__ == "__main__":
    unittest.main()
