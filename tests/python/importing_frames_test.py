"""Frames, masses and bodies of imported models, compared with values computed by hand."""
import math
import unittest

from importing_support import ImportTestCase, box, fixed, inertial, link, mjcf, sdf, urdf

HALF = math.sqrt(0.5)


def pose(text, **attributes):
    names = "".join(f" {name}='{value}'" for name, value in attributes.items())
    return f"<pose{names}>{text}</pose>"


def placed(text, **attributes):
    """A link whose box has this pose."""
    return link(inside=box(pose=pose(text, **attributes)) + inertial())


def included(name, merge="", inside=""):
    return f"<include {merge}>{inside}<uri>model://{name}</uri>{pose('0 1 0 0 0 0')}</include>"


QUARTER = [HALF, 0, 0, HALF]  # a quarter turn about z
MOUNT = "<frame name='mount'>" + pose("5 0 0 0 0 90", degrees="true") + "</frame>"
HAND = link("hand", inertial(1) + box("palm"), pose("0 0 1 0 0 0"))
MERGED = "merge='true'"
OLD_ARM = link("arm", inertial(1) + box("arm box"), pose("0 0 2 0 0 0", frame="base"))
NESTED = f"<model name='arm'>{pose('1 0 0 0 0 90', degrees='true')}{HAND.replace('0 0 1 0', '0 2 0 0')}</model>"


class ImportsFramesOfSdf(ImportTestCase):
    # What is in the model; position and orientation of its last part.
    POSES = {
        "pose of collision is in its link": (placed("1 2 3 0 0 1.5707963267948966"), [1, 2, 3], QUARTER),
        # x to -z by pitch, then to -z by yaw: roll, pitch, yaw = 0, 90, 90 degrees is q_z q_y.
        "rpy turns about fixed axes": (placed("0 0 0 0 90 90", degrees="true"), [0, 0, 0], [0.5, -0.5, 0.5, 0.5]),
        "quaternion has w last": (placed("0 0 0 1 0 0 1", rotation_format="quat_xyzw"), [0, 0, 0], [HALF, HALF, 0, 0]),
        # The mount is at x = 5, turned by 90 degrees: its (1, 0, 0) is the model's (5, 1, 0).
        "relative_to follows frames": (MOUNT + placed("1 0 0 0 0 0", relative_to="mount"), [5, 1, 0], QUARTER),
        "relative_to model undoes pose of link": (
            placed("1 0 0 0 0 0", relative_to="__model__").replace("'base'>", "'base'>" + pose("3 0 0 0 0 0")),
            [-2, 0, 0],
            None,
        ),
        "frame is attached to link": (
            "<frame name='mount' attached_to='base'>" + pose("0 0 1 0 0 0") + "</frame>"
            + placed("0 1 0 0 0 0", relative_to="mount").replace("'base'>", "'base'>" + pose("7 0 0 0 0 0")),
            [0, 1, 1],
            None,
        ),
        "old files say frame": (link(pose=pose("0 4 0 0 0 0")) + OLD_ARM + fixed("base", "arm"), [0, 0, 2], None),
        "nested models compose": (link() + NESTED + fixed("base", "arm::hand"), [-1, 0, 0], QUARTER),
        "include is a nested model": (
            link() + included("arm", inside="<name>left</name>") + fixed("base", "left::hand"),
            [0, 1, 1],
            None,
        ),
        "merged include keeps names": (link() + included("arm", MERGED) + fixed("base", "hand"), [0, 1, 1], None),
        "so does one within another": (link() + included("body", MERGED) + fixed("base", "hand"), [0, 2, 1], None),
    }

    def test_poses(self):
        files = {
            "models/arm/model.config": "<model><sdf version='1.9'>arm.sdf</sdf></model>",
            "models/arm/arm.sdf": sdf(HAND),
            "body/model.sdf": sdf(included("arm", MERGED)),
        }
        for name, (inside, position, orientation) in self.POSES.items():
            with self.subTest(name):
                text = sdf(inside, version="1.6" if "old" in name else "1.9")
                part = self.import_model(text, files=files).body["part"][-1]
                self.assert_numbers(part.get("position", [0, 0, 0]), position)
                self.assert_numbers(part.get("orientation", [1, 0, 0, 0]), orientation or [1, 0, 0, 0])

    def test_pose_of_link_and_model_is_that_of_client(self):
        for attributes, expected in (("", [10, 0, 3]), ("placement_frame='base'", [10, 0, 0])):
            text = sdf(link(pose=pose("0 0 3 0 0 0")), pose=pose("10 0 0 0 0 0"), attributes=attributes)
            self.assert_numbers(self.import_model(text).body["client"]["position"], expected)

    def test_cycles_and_unknown_frames_are_refused(self):
        cycle = (
            "<frame name='a'>" + pose("0 0 0 0 0 0", relative_to="b") + "</frame>"
            "<frame name='b'>" + pose("0 0 0 0 0 0", relative_to="a") + "</frame>"
        )
        self.assert_refused(sdf(cycle + link(pose=pose("0 0 0 0 0 0", relative_to="a"))), "relative to itself")
        self.assert_refused(sdf(link(pose=pose("0 0 0 0 0 0", relative_to="nose"))), "'nose'", "model.sdf:1")

    def test_static_model_is_free(self):
        files = {"pier/model.sdf": sdf("<static>true</static>" + link())}
        included = "<sdf version='1.9'><world name='w'><include><uri>model://pier</uri></include></world></sdf>"
        for text in (files["pier/model.sdf"], included):
            self.assertIn("the model is static: it is free in the scene", self.import_model(text, files=files).output)
        self.assertNotIn("static", self.import_model(sdf(link())).output)

    def test_gravity_gives_up(self):
        text = (
            sdf(link())
            .replace("<model", "<world name='w'><gravity>0 0 9.8</gravity><model")
            .replace("</model>", "</model></world>")
        )
        self.assertEqual(self.import_model(text).scene["world"], {"gravity": 9.8, "up": [0, 0, -1]})


class SumsMassesOfLinks(ImportTestCase):
    def client(self, *arguments, **more):
        return self.import_model(*arguments, **more).body["client"]

    def test_fixed_links_add_up(self):
        # 2 kg at x = 0 and 1 kg at x = 3: the centre is at 1, and 2 + 4 kg m^2 come to y and z.
        model = (
            link(inside=box() + inertial(2, moments=(1, 1, 1)))
            + link("nose", inertial(1, moments=(1, 1, 1)), pose("3 0 0 0 0 0"))
            + fixed("base", "nose")
        )
        client = self.client(sdf(model))
        self.assertEqual(client["mass"], 3)
        self.assert_numbers(client["center_of_mass"], [1, 0, 0])
        self.assert_numbers(client["inertia"], [2, 8, 8])

    def test_inertia_is_turned_by_pose_of_inertial(self):
        for placed_at, moments, products, center, expected in (
            (pose("0 0 1 0 0 90", degrees="true"), (2, 3, 4), (0, 0, 0), [0, 0, 1], [3, 2, 4]),
            (pose("0 0 0 0 0 45", degrees="true"), (2, 3, 4), (0, 0, 0), [0, 0, 0], [2.5, 2.5, 4, -0.5, 0, 0]),
            ("", (20, 30, 40), (1, 2, 3), [0, 0, 0], [20, 30, 40, 1, 2, 3]),
        ):
            client = self.client(sdf(link(inside=box() + inertial(5, placed_at, moments, products))))
            self.assert_numbers(client["center_of_mass"], center)
            self.assert_numbers(client["inertia"], expected)

    def test_order_of_urdf(self):
        urdf = """<robot name='boat'><link name='base'><inertial><origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/>
          <mass value='5'/><inertia ixx='20' ixy='1' ixz='2' iyy='30' iyz='3' izz='40'/></inertial>
          <collision><geometry><box size='1 1 1'/></geometry></collision></link></robot>"""
        client = self.client(urdf, name="boat.urdf")
        # x to y, y to -x: Ixx' = Iyy, Ixy' = -Ixy, Ixz' = -Iyz, Iyz' = Ixz.
        self.assert_numbers(client["inertia"], [30, 20, 40, -1, -3, 2])
        self.assert_numbers(client["center_of_mass"], [0, 0, 1])

    def test_impossible_inertia_is_left_out(self):
        result = self.import_model(sdf(link(inside=box() + inertial(5, moments=(1, 1, 9)))))
        self.assertNotIn("inertia", result.body["client"])
        self.assertIn("no rigid body has the principal moments 1, 1, 9", result.output)
        self.assertIn("# - inertia [1, 1, 9, 0, 0, 0]", result.text)

    def test_inertia_of_one_link_is_checked(self):
        # The sum of both would be possible.
        nose = link("nose", inertial(1, moments=(1, 1, 9)))
        result = self.import_model(sdf(link() + nose + fixed("base", "nose")))
        self.assertNotIn("inertia", result.body["client"])
        self.assertIn("link 'nose': no rigid body has the principal moments 1, 1, 9", result.output)
        self.assertNotIn("link 'base'", result.output)

    def test_rod_among_links_counts(self):
        nose = link("nose", inertial(1, moments=(0, 1, 1)), pose("3 0 0 0 0 0"))
        result = self.import_model(sdf(link(inside=box() + inertial(2)) + nose + fixed("base", "nose")))
        self.assert_numbers(result.body["client"]["inertia"], [80, 97, 107])
        self.assertIn("link 'nose': no rigid body has the principal moments 0, 1, 1", result.output)

    def test_inertia_without_mass_is_left_out(self):
        ghost = link("ghost", inertial(0, moments=(1, 1, 9)))
        result = self.import_model(sdf(link() + ghost + fixed("base", "ghost")))
        self.assert_numbers(result.body["client"]["inertia"], [80, 90, 100])
        self.assertIn("link 'ghost' has no mass, but the principal moments 1, 1, 9", result.output)
        for model, name in (
            (urdf(mass=0), "boat.urdf"),
            (mjcf("<inertial pos='0 0 0' mass='0' diaginertia='1 1 1'/><geom type='box' size='1 1 1'/>"), "boat.xml"),
        ):
            self.assertIn("has no mass, but the principal moments", self.import_model(model, name=name).output)

    def test_automatic_inertia_follows_from_geometry(self):
        inside = box(size="2 1 1") + "<inertial auto='true'><density>600</density></inertial>"
        client = self.client(sdf(link(inside=inside), version="1.11"))
        self.assertEqual(client["mass"], 1200)
        self.assert_numbers(client["inertia"], [200, 500, 500])


class GroupsLinksIntoBodies(ImportTestCase):
    MODEL = sdf(
        link()
        + link("fin", box("fin box", "0.1 0.1 0.1") + inertial(1), pose("2 0 0 0 0 0"))
        + link("propeller", box("blade", "0.1 0.1 0.1") + inertial(3))
        + link("tether", inertial(4))
        + link("mast", inertial(5) + box("mast box", "0.1 0.1 1"))
        + fixed("base", "fin", "revolute")
        + fixed("base", "propeller", "revolute")
        + fixed("base", "tether", "ball")
        + fixed("base", "mast")
    )

    def test_moving_joints_separate_bodies(self):
        result = self.import_model(self.MODEL)
        self.assertEqual([body["name"] for body in result.bodies], ["vehicle", "vehicle fin"])
        self.assertEqual(result.body["client"]["mass"], 505)
        self.assertEqual(len(result.body["part"]), 2)
        self.assert_numbers(result.bodies[1]["client"]["position"], [2, 0, 0])
        self.assertIn("'propeller' (model.sdf:1), 3 kg: is a propeller", result.output)
        self.assertIn("'tether' (model.sdf:1), 4 kg: has no volume", result.output)
        self.assertIn("left out have 7 kg", result.output)
        self.assertIn("note: joint 'base to fin': the bodies of the scene move freely", result.output)
        joints = "note: joints 'base to fin', 'base to mast': the bodies of the scene move freely"
        self.assertIn(joints, self.import_model(self.MODEL, "--links").output)

    def test_kept_link_without_volume_is_a_mass(self):
        # The tether's 4 kg hang at x = 3 on a ball joint: of 509 kg the centre moves by 12 / 509.
        model = self.MODEL.replace("<link name='tether'>", "<link name='tether'>" + pose("3 0 0 0 0 0"))
        result = self.import_model(model, "--keep", "tether")
        self.assertIn("note: joint 'base to fin': the bodies of the scene move freely", result.output)
        self.assertEqual(result.body["client"]["mass"], 509)
        self.assert_numbers(result.body["client"]["center_of_mass"], [12 / 509, 0, 0])
        self.assertIn("'tether': its mass is fixed to 'base', with 'base to tether' at 0", result.output)
        self.assertIn("left out have 3 kg", result.output)
        loose = self.import_model(sdf(link() + link("weight", inertial(1))), "--keep", "weight")
        self.assertIn("'weight' (model.sdf:1), 1 kg: has no volume, nor what its joint hangs it on", loose.output)

    def test_joints_with_limits_of_zero_are_fixed(self):
        limits = "<axis><xyz>0 0 1</xyz><limit><lower>{}</lower><upper>{}</upper></limit></axis></joint>"
        sdf_model = sdf(link() + link("bow", box("bow box") + inertial(3)) + fixed("base", "bow", "revolute"))
        urdf_model = (
            "<robot name='vehicle'><link name='base'>{0}<inertial><mass value='500'/></inertial></link>"
            "<link name='bow'>{0}</link><joint name='base to bow' type='revolute'><parent link='base'/>"
            "<child link='bow'/><limit lower='{{}}' upper='{{}}'/></joint></robot>"
        ).format("<collision><geometry><box size='1 1 1'/></geometry></collision>")
        for model, name in ((sdf_model.replace("</joint>", limits), "boat.sdf"), (urdf_model, "boat.urdf")):
            result = self.import_model(model.format(0, 0), name=name)
            self.assertEqual(len(result.bodies), 1)
            self.assertIn("note: joint 'base to bow' with limits of 0 and 0: fixed", result.output)
            for ends in ((0, 1), (-1, 0), ("-inf", "inf")):
                self.assertEqual(len(self.import_model(model.format(*ends), name=name).bodies), 2)
        self.assertEqual(len(self.import_model(sdf_model).bodies), 2)
        # A limit that URDF does not state is 0.
        without = urdf_model.replace("lower='{}' upper='{}'", "effort='1'")
        self.assertEqual(len(self.import_model(without, name="boat.urdf").bodies), 1)

    def test_detachable_link_is_fixed(self):
        plugin = (
            "<plugin filename='gz-sim-detachable-joint-system' name='gz::sim::systems::DetachableJoint'>"
            "<parent_link>base</parent_link><child_model>{}</child_model><child_link>weight</child_link></plugin>"
        )
        model = link() + link("weight", inertial(20))
        result = self.import_model(sdf(model + plugin.format("__model__")))
        self.assertEqual(result.body["client"]["mass"], 520)
        self.assertIn("note: the model fixes link 'weight' to 'base' until it is dropped", result.output)
        self.assertEqual(self.import_model(sdf(model + plugin.format("tow"))).body["client"]["mass"], 500)

    def test_links_that_plugins_drive_are_propellers(self):
        names = ("gz::sim::systems::Thruster", "gz::sim::systems::MulticopterMotorModel", "gazebo_motor_model")
        model = link() + link("t0", box("blade") + inertial(1)) + fixed("base", "t0", "revolute")
        for name in names:
            driven = f"<plugin name='{name}' filename='f'><jointName>base to t0</jointName></plugin>"
            result = self.import_model(sdf(model + driven))
            self.assertIn("'t0' (model.sdf:1), 1 kg: is a propeller", result.output)
            self.assertIn(f"- thruster '{name}'", result.output)
        self.assertEqual(len(self.import_model(sdf(model)).bodies), 2)

    def test_specks_have_no_volume(self):
        speck = link("depth", box("speck", "1e-6 1e-6 1e-6") + inertial(0.01))
        result = self.import_model(sdf(link() + speck + fixed("base", "depth", "revolute")))
        self.assertEqual(len(result.bodies), 1)
        self.assertIn("'depth' (model.sdf:1), 0.01 kg: has no volume", result.output)

    def test_options_choose_links(self):
        self.assert_refused(self.MODEL, "'rudder'", options=("--drop", "rudder"))
        result = self.import_model(self.MODEL, "--keep", "propeller", "--drop", "fin", "--drop", "mast")
        self.assertEqual([body["name"] for body in result.bodies], ["vehicle", "vehicle propeller"])
        self.assertEqual(result.body["client"]["mass"], 500)

    def test_links_are_bodies_on_request(self):
        result = self.import_model(self.MODEL, "--links")
        self.assertEqual([body["client"]["mass"] for body in result.bodies], [500, 1, 5])

    def test_frame_of_body_is_that_of_its_root(self):
        # The child comes first in the file.
        model = (
            link("mast", inertial(1) + box("mast box"), pose("0 0 1 0 0 0"))
            + link(pose=pose("0 0 -1 0 0 0"))
            + fixed("base", "mast")
        )
        result = self.import_model(sdf(model))
        self.assert_numbers(result.body["part"][0]["position"], [0, 0, 2])
        self.assert_numbers(result.body["client"]["position"], [0, 0, -1])

    def test_world_needs_name_of_model(self):
        models = "".join(f"<model name='{name}'>{link()}</model>" for name in ("one", "two"))
        text = f"<sdf version='1.9'><world name='w'>{models}</world></sdf>"
        self.assert_refused(text, "'one', 'two'", "--model NAME")
        self.assertEqual(self.import_model(text, "--model", "two").body["name"], "two")

    def test_visual_geometry_is_taken_on_request(self):
        text = sdf(link(inside=box().replace("collision", "visual") + inertial()))
        self.assert_refused(text, "no body has a volume", "--visual")
        self.assertEqual(len(self.import_model(text, "--visual").body["part"]), 1)


class ImportsUrdf(ImportTestCase):
    def test_links_follow_joints(self):
        urdf = """<robot name='boat'>
          <link name='float'><inertial><mass value='10'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>
            </inertial><collision><origin xyz='1 0 0'/><geometry><box size='4 1 1'/></geometry></collision></link>
          <link name='base'/>
          <joint name='j' type='fixed'><parent link='base'/><child link='float'/>
            <origin xyz='0 2 0' rpy='0 0 1.5707963267948966'/></joint></robot>"""
        result = self.import_model(urdf, name="boat.urdf")
        self.assert_numbers(result.body["part"][0]["position"], [0, 3, 0])
        self.assertEqual(result.body["client"]["mass"], 10)


class ImportsMjcf(ImportTestCase):
    def test_bodies_without_joint_are_welded(self):
        model = """<mujoco><compiler angle='degree'/>
          <default><default class='hull'><geom density='500'/></default></default>
          <worldbody><body name='hull' pos='0 0 1' childclass='hull'><freejoint/>
            <geom type='box' size='1 0.5 0.25'/>
            <body name='mast' pos='0 0 1' euler='0 0 90'>
              <geom type='box' size='0.2 0.1 0.5' pos='1 0 0' mass='7'/></body>
          </body></worldbody></mujoco>"""
        result = self.import_model(model, name="boat.xml")
        body = result.body
        self.assertEqual(body["part"][0]["shape"], {"type": "box", "size": [2, 1, 0.5]})
        self.assert_numbers(body["part"][1]["position"], [0, 1, 1])
        self.assertEqual(body["client"]["mass"], 507)
        self.assert_numbers(body["client"]["position"], [0, 0, 1])
        self.assert_numbers(body["client"]["center_of_mass"], [0, 7 / 507, 7 / 507])

    def test_orientations(self):
        for text, expected in (
            ("quat='1 1 0 0'", [HALF, HALF, 0, 0]),
            ("axisangle='0 0 2 90'", [HALF, 0, 0, HALF]),
            ("xyaxes='0 1 0 -1 0 0'", [HALF, 0, 0, HALF]),
            ("zaxis='0 -1 0'", [HALF, HALF, 0, 0]),
            ("euler='90 0 90'", [0.5, 0.5, -0.5, 0.5]),
        ):
            model = f"""<mujoco><worldbody><body name='b'><freejoint/><geom type='box' size='1 1 1' {text}/></body>
              </worldbody></mujoco>"""
            part = self.import_model(model, name="b.xml").body["part"][0]
            self.assert_numbers(part["orientation"], expected)

    def test_order_of_full_inertia(self):
        model = """<mujoco><worldbody><body name='b'><freejoint/><inertial mass='2' pos='0 0 0.5'
          fullinertia='20 30 40 1 2 3'/><geom type='box' size='1 1 1'/></body></worldbody></mujoco>"""
        client = self.import_model(model, name="b.xml").body["client"]
        self.assert_numbers(client["inertia"], [20, 30, 40, 1, 2, 3])

    def test_fluid_is_reported(self):
        model = """<mujoco><option density='1000' viscosity='0.001'/><worldbody><body name='b'><freejoint/>
          <geom type='ellipsoid' size='1 0.5 0.5' fluidshape='ellipsoid'/></body></worldbody></mujoco>"""
        result = self.import_model(model, name="b.xml")
        for words in ("density = 1000", "viscosity = 0.001", 'fluidshape = "ellipsoid"'):
            self.assertIn(words, result.output)

    def test_body_of_several_needs_a_name(self):
        body = "<body {}><freejoint/><geom type='box' size='1 1 1'/></body>"
        named = body.format("name='b'")
        model = f"<mujoco><worldbody>{body.format('')}{named}</worldbody></mujoco>"
        words = ("2 bodies to choose from (one without a name, b.xml:1, 'b')", "and name it first")
        self.assert_refused(model, *words, name="b.xml")
        self.assertEqual(self.import_model(model, "--model", "b", name="b.xml").body["name"], "b")

    def test_what_holds_the_vehicle_is_reported(self):
        model = """<mujoco><option><flag gravity='disable'/></option><default><joint type='{}'/></default><worldbody>
          <body name='b'>{}<geom type='box' size='1 1 1'/></body></worldbody>
          <tendon><fixed name='cable'/></tendon><equality><connect name='hook'/></equality></mujoco>"""
        free = "it is free in the scene"
        for kind, joint, words in (
            ("slide", "<joint/>", f"the body 'b' moves on joints of the world: {free}"),
            ("slide", "", f"the body 'b' is fixed to the world: {free}"),
            ("slide", "<freejoint/>", None),
            ("free", "<joint/>", None),
        ):
            output = self.import_model(model.format(kind, joint), name="b.xml").output
            self.assertIn(words or "not converted: 3", output)
            self.assertEqual(free in output, words is not None)
            for left_out in ("gravity 0", "tendon 'cable' (fixed)", "equality 'hook' (connect)"):
                self.assertIn(f"- {left_out}", output)

    def test_capsule_runs_from_to(self):
        model = """<mujoco><worldbody><body name='b'><freejoint/><geom type='capsule' fromto='0 0 0 2 0 0' size='0.5'/>
          </body></worldbody></mujoco>"""
        result = self.import_model(model, name="b.xml")
        part = result.body["part"][0]
        self.assert_numbers(part["position"], [1, 0, 0])
        self.assert_numbers(part["orientation"], [HALF, 0, HALF, 0])
        volume = math.pi * 0.25 * 2 + 4 / 3 * math.pi * 0.125
        self.assertAlmostEqual(result.open().bodies[0].volume / volume, 1, delta=1e-3)
        self.assertAlmostEqual(result.body["client"]["mass"], 1000 * volume, places=6)


if __name__ == "__main__":
    unittest.main()
