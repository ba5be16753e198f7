"""Meshes, shapes, hostile and broken models, and the program itself."""
import os
import re
import subprocess
import sys
import unittest
import warnings

import numpy as np
from importing_support import BOX_OBJ, ImportTestCase, box, fixed, inertial, link, mjcf, sdf, urdf, urdf_joint

from buoyancy.importing import xml_file


def mesh(uri, inside="", name="hull", pose=""):
    return f"<collision name='{name}'>{pose}<geometry><mesh><uri>{uri}</uri>{inside}</mesh></geometry></collision>"


class ImportsGeometry(ImportTestCase):
    def test_factors_of_scale(self):
        inside = mesh("hull.obj", "<scale>2 3 0.5</scale>", pose="<pose>1 0 0 0 0 0</pose>") + inertial(1500)
        result = self.import_model(sdf(link(inside=inside)), files={"hull.obj": BOX_OBJ})
        part = result.body["part"][0]
        self.assertEqual(part["mesh"], {"file": "hull.obj", "scale": [2, 3, 0.5]})
        self.assertEqual(part["position"], [1, 0, 0])
        self.assertAlmostEqual(result.open().bodies[0].volume, 3)

    def test_uris_are_searched(self):
        files = {"other/boat/meshes/hull.obj": BOX_OBJ}
        for uri in (
            "model://boat/meshes/hull.obj",
            "package://boat/meshes/hull.obj",
            "boat/meshes/hull.obj",
            f"file://{self.folder}/other/boat/meshes/hull.obj",
        ):
            text = sdf(link(inside=mesh(uri) + inertial()))
            result = self.import_model(text, "--path", str(self.folder / "other"), files=files)
            self.assertEqual(result.body["part"][0]["mesh"]["file"], "other/boat/meshes/hull.obj")
        os.environ["GZ_SIM_RESOURCE_PATH"] = str(self.folder / "other")
        self.addCleanup(os.environ.pop, "GZ_SIM_RESOURCE_PATH")
        self.import_model(sdf(link(inside=mesh("model://boat/meshes/hull.obj") + inertial())))

    def test_other_schemes_are_searched_like_models(self):
        for uri in ("model://boat/hull.obj", "models://boat/hull.obj"):
            result = self.import_model(
                sdf(link(inside=mesh(uri) + inertial())),
                name="worlds/boat.sdf",
                files={"models/boat/hull.obj": BOX_OBJ},
            )
            self.assertEqual(result.body["part"][0]["mesh"]["file"], "models/boat/hull.obj")

    def test_files_of_fuel_are_searched_in_its_folders(self):
        url = "https://fuel.gazebosim.org/1.0/Owner/models/My Boat"
        cache = "fuel/fuel.gazebosim.org/owner/models/my boat"
        os.environ["GZ_FUEL_CACHE_PATH"] = str(self.folder / "fuel")
        self.addCleanup(os.environ.pop, "GZ_FUEL_CACHE_PATH")
        text = sdf(link(inside=mesh(f"{url}/2/files/meshes/hull.obj") + inertial()))
        included = f"<sdf version='1.9'><world name='w'><include><uri>{url}</uri></include></world></sdf>"
        self.assert_refused(included, f"gz fuel download -u '{url}'", "/owner/models. ")
        # The newest version comes first, and a folder beside the model before those of the cache.
        for root in (f"{cache}/9", f"{cache}/10", "My Boat"):
            files = {f"{root}/meshes/hull.obj": BOX_OBJ, f"{root}/model.sdf": sdf(link(root[-2:]))}
            result = self.import_model(text, files=files)
            self.assertEqual(result.body["part"][0]["mesh"]["file"], f"{root}/meshes/hull.obj")
            scene = self.import_model(included, name="w.sdf").text
            self.assertIn(f"its frame is that of the link '{root[-2:]}'", scene)

    def test_missing_mesh_names_places(self):
        text = sdf(link(inside=mesh("model://boat/hull.obj") + inertial()))
        self.assert_refused(
            text,
            "'model://boat/hull.obj' is not found",
            "/elsewhere/boat",
            "--path",
            "model.sdf:1",
            options=("--path", "/elsewhere"),
        )

    def test_submesh_is_cut_out(self):
        lines = BOX_OBJ.splitlines()
        second = [
            line if line[0] != "v" else f"v {float(line.split()[1]) + 5} {' '.join(line.split()[2:])}" for line in lines
        ]
        second = [
            "f " + " ".join(str(int(n) + 8) for n in line.split()[1:]) if line[0] == "f" else line for line in second
        ]
        files = {"two.obj": "\n".join(["o first", *lines, "o second", *second])}
        submesh = "<submesh><name>second</name><center>{}</center></submesh>"
        result = self.import_model(sdf(link(inside=mesh("two.obj", submesh.format("false")) + inertial())), files=files)
        body = result.open().bodies[0]
        self.assertAlmostEqual(body.volume, 1)
        np.testing.assert_allclose(result.open().query(1, [0, 0, -9], [1, 0, 0, 0]).center_of_buoyancy, [5.5, 0.5, 0.5])
        self.assertEqual(result.body["part"][0]["mesh"]["file"], "scene.d/body1_part0.obj")
        result = self.import_model(sdf(link(inside=mesh("two.obj", submesh.format("true")) + inertial())))
        np.testing.assert_allclose(
            result.open().query(1, [0, 0, -9], [1, 0, 0, 0]).center_of_buoyancy, [0, 0, 0], atol=1e-9
        )
        self.assert_refused(
            sdf(link(inside=mesh("two.obj", "<submesh><name>third</name></submesh>") + inertial())),
            "no submesh 'third'",
            "first, second",
            name="third.sdf",
        )

    SHAPES = {
        "<sphere><radius>0.5</radius></sphere>": np.pi / 6,
        "<cylinder><radius>0.5</radius><length>2</length></cylinder>": np.pi / 2,
        "<capsule><radius>0.5</radius><length>2</length></capsule>": np.pi / 2 + np.pi / 6,
        "<ellipsoid><radii>1 0.5 0.25</radii></ellipsoid>": np.pi / 6,
        "<cone><radius>0.5</radius><length>2</length></cone>": np.pi / 6,
    }

    def test_shapes(self):
        for shape, volume in self.SHAPES.items():
            inside = f"<collision name='c'><geometry>{shape}</geometry></collision>" + inertial()
            scene = self.import_model(sdf(link(inside=inside), version="1.12")).open()
            self.assertAlmostEqual(scene.bodies[0].volume / volume, 1, delta=1.2e-3)
            wrench = scene.query(1, [0, 0, -9], [1, 0, 0, 0])
            expected = [0, 0, -0.5] if "cone" in shape else [0, 0, 0]
            np.testing.assert_allclose(wrench.center_of_buoyancy, expected, atol=1e-9)

    def test_shape_overlaps_box_by_its_upper_half(self):
        # Both are turned by 1 rad about x, and the box begins at the middle of the shape.
        above = box("b", "4 4 4", f"<pose>9 {-2 * np.sin(1)} {2 * np.cos(1)} 1 0 0</pose>")
        for shape, volume in self.SHAPES.items():
            turned = f"<collision name='c'><pose>9 0 0 1 0 0</pose><geometry>{shape}</geometry></collision>"
            output = self.import_model(sdf(link(inside=above + turned + inertial()), version="1.12")).output
            found = re.search(r"'b' and 'c' by ([0-9.]+) m\^3", output)
            expected = volume / (8 if "cone" in shape else 2)
            self.assertAlmostEqual(float(found.group(1)) / expected, 1, delta=0.03)

    def test_overlapping_boxes_count_twice(self):
        inside = box("a", "2 1 1") + box("b", "2 1 1", "<pose>1.5 0 0 0 0 0</pose>") + inertial()
        self.assertIn(
            "'a' and 'b' by 0.5 m^3 (25 % of the smaller)", self.import_model(sdf(link(inside=inside))).output
        )
        apart = inside.replace("1.5 0 0", "2 0 0")
        self.assertNotIn("overlap", self.import_model(sdf(link(inside=apart))).output)

    def test_millimetres_are_recognised(self):
        inside = mesh("hull.obj", "<scale>1000 1000 1000</scale>") + inertial(416)
        result = self.import_model(sdf(link(inside=inside)), files={"hull.obj": BOX_OBJ})
        self.assertRegex(result.output, "warning: body 1: mass over volume .* 0.001 .* 416 kg/m\\^3")
        with self.assertWarns(UserWarning) as opened:
            result.open()
        for text in (result.output, result.text):
            self.assertIn(str(opened.warning).partition(": ")[2], text)

    def test_holes_are_closed_aloud(self):
        lines = BOX_OBJ.splitlines()
        # A box without its narrow end.
        open_box = "\n".join(line for line in lines if line != "f 4 1 5 8")
        text = sdf(link(inside=mesh("hull.obj", "<scale>100 1 0.1</scale>") + inertial()))
        result = self.import_model(text, files={"hull.obj": open_box})
        self.assertEqual(result.body["part"][0]["close_holes"], 0.01)
        self.assertIn("close_holes = 0.01 closes its holes", result.output)
        closed = mesh("box.obj", name="box", pose="<pose>9 0 0 0 0 0</pose>")
        text = sdf(link(inside=mesh("hull.obj") + closed + inertial()))
        self.assert_refused(text, "boundary edges", "--close-holes SHARE", files={"box.obj": BOX_OBJ})
        result = self.import_model(text, "--close-holes", "2")
        self.assertEqual([part.get("close_holes") for part in result.body["part"]], [2, None])
        self.assertIn("warning: mesh 'hull.obj' is not closed: close_holes = 2.0 closes its holes", result.output)

    def test_axis_up_of_collada_is_a_note(self):
        # A tetrahedron with y up in its file: Gazebo takes its coordinates as they are.
        geometry = (
            "<geometry id='g'><mesh><source id='p'><float_array id='a' count='12'>0 0 0 1 0 0 0 1 0 0 0 1</float_array>"
            "<technique_common><accessor source='#a' count='4' stride='3'><param name='X' type='float'/>"
            "<param name='Y' type='float'/><param name='Z' type='float'/></accessor></technique_common></source>"
            "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices><triangles count='4'>"
            "<input semantic='VERTEX' source='#v' offset='0'/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh>"
            "</geometry>"
        )
        collada = (
            "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><asset>"
            f"<up_axis>Y_UP</up_axis></asset><library_geometries>{geometry}</library_geometries><library_visual_scenes>"
            "<visual_scene id='s'><node><instance_geometry url='#g'/></node></visual_scene></library_visual_scenes>"
            "<scene><instance_visual_scene url='#s'/></scene></COLLADA>"
        )
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = self.import_model(
                sdf(link(inside=mesh("hull.dae") + inertial(100))), files={"hull.dae": collada}
            )
        self.assertIn("note: mesh 'hull.dae' has another axis than z up in its file", result.output)
        self.assertEqual(result.error, "")

    def test_body_floats_as_computed_by_hand(self):
        # A catamaran of two boxes 4 x 0.5 x 1: 820 kg displace 0.8 m^3, 0.2 m deep.
        inside = box("port", "4 0.5 1", "<pose>0 1 0 0 0 0</pose>") + box(
            "starboard", "4 0.5 1", "<pose>0 -1 0 0 0 0</pose>"
        )
        scene = self.import_model(sdf(link(inside=inside + inertial(820)))).open()
        wrench = scene.query(1, [0, 0, 0.3], [1, 0, 0, 0])
        np.testing.assert_allclose(wrench.force, [0, 0, 820 * 9.80665], rtol=1e-12, atol=1e-9)
        np.testing.assert_allclose(wrench.torque, 0, atol=1e-9)


def hull(size="1 1 1", **attributes):
    """A box in MJCF."""
    return "<geom type='box' size='{}' {}/>".format(size, " ".join(f"{k}='{v}'" for k, v in attributes.items()))


INCLUDE = "<include><uri>model://arm</uri></include>"
AB = "<link name='a'/><link name='b'/>"
WAVE = "<plugin filename='libSurface.so' name='vrx::Surface'><wavefield><wave>{}</wave></wavefield></plugin>"
# Files, and words of the errors; for an SDF model also words of its path.
REFUSED = {
    "model.sdf": (
        ("hello", "is not XML"),
        ("<?xml version='1.0' encoding='UTF-9'?><sdf/>", "unknown encoding: UTF-9"),
        ("<html/>", "root element is <html>"),
        ("<sdf version='1.9'><model name='a'>", "is not XML"),
        ("<sdf version='1.9'>\n<model name=a/></sdf>", "model.sdf:2: is not XML", "without quotes"),
        (sdf(box()), "/sdf/model[vehicle]: the model 'vehicle' has no link"),
        (sdf(link(inside=box(size="1 1") + inertial())), "size [1.0, 1.0]", "3 lengths from 1e", "/collision[box]: "),
        (sdf(link(inside=box(size="1 nan 1") + inertial())), "'1 nan 1'", "finite numbers", "/geometry/box/size: "),
        (sdf(link(inside=box(size="1 1 -1") + inertial())), "3 lengths", "/link[base]/collision[box]: "),
        (sdf(link(inside=box(size="1 1 1e-320") + inertial())), "3 lengths", "/link[base]/collision[box]: "),
        (sdf(link(inside=box(size="") + inertial())), "<box> of 'box' has no size", "/collision[box]/geometry/box: "),
        (sdf(link(pose="<pose>0 0 ${z}</pose>")), "template that was not expanded", "/link[base]/pose: "),
        (sdf(link(pose="<pose rotation_format='quat_xyzw'>1 2 3 0 0 0 0</pose>")), "length 0", "/link[base]/pose: "),
        (sdf(link(inside=box() + inertial("1e13"))), "<mass> is '1e13'", "up to 1e+12", "/inertial/mass: "),
        (sdf(link(inside=mesh("a" * 5000))), "is not found", "/collision[hull]: "),
        (sdf(link(inside=mesh(f"https://fuel.gazebosim.org/1.0/owner/models/{'a' * 5000}"))), "is not found"),
        (sdf(link() + "<frame><pose/></frame>"), "the <frame> has no name", "/sdf/model[vehicle]/frame: "),
        (sdf(link() + fixed("base", "mast")), "no link, joint or frame is named 'mast'", "/joint[base to mast]: "),
        (sdf(link() + fixed("base", "base")), "connects 'base' with itself", "/joint[base to base]: "),
        (
            sdf(link() + link("mast") + fixed("base", "mast") + fixed("mast", "base", "revolute")),
            "closes a circle (",
            "/sdf/model[vehicle]/joint[",
        ),
        (sdf(link() + WAVE.format("<direction>north</direction>")), "<direction> is 'north'", "/wave/direction: "),
        (
            sdf(link() + WAVE.format("<model>CWR</model><amplitude>1e6</amplitude>")),
            "model[vehicle]: the scene that it becomes is refused",
            "# the waves of the wavefield, model.sdf:1",
        ),
    ),
    "boat.urdf": (
        (urdf(links="<link name='a'/>", joints=urdf_joint("a", "a")), "connects 'a' with itself", "/joint[a to a]: "),
        (urdf(links=AB, joints=urdf_joint("a", "b") + urdf_joint("b", "a")), "a circle (", "/robot[boat]/joint["),
        ("<robot xmlns:xacro='x'><xacro:macro/></robot>", "elements of xacro", "/robot/xacro:macro: "),
        ("<robot name='r'><link name='a'/><link name='b'/></robot>", "2 root links (a, b)"),
        (urdf(joints=urdf_joint("base", "c")), "'c', which does not exist", "/robot[boat]/joint[base to c]: "),
        (urdf(joints="<link name='base'/>"), "two of the model are named 'base'", "/robot[boat]/link[base]: "),
    ),
    "boat.urdf.xacro": (("<robot/>", "Expand it: xacro boat.urdf.xacro"),),
    "boat.xml": (
        (mjcf(hull(name="pod", fromto="1 2 3 1 2 3")), "two equal points", "/worldbody/body[b]/geom[pod]: "),
        (mjcf("<geom type='capsule' fromto='0 0 0 1 0 0'/>"), "has 1 numbers", "2 for a capsule"),
        (mjcf(hull(quat="0 0 0 0")), "a quaternion or an axis of length 0"),
        (mjcf(hull(xyaxes="1 0 0 2 0 0")), "two axes along one line"),
        (mjcf(hull(zaxis="0 0 0")), "an axis of length 0"),
        (mjcf(hull(**{"class": "none"})), "the class 'none' does not exist", "one of: main"),
        (mjcf("<replicate/>"), "<replicate>", "mj_saveLastXML"),
        (mjcf("<geom type='mesh' mesh='hull'/>"), "the mesh 'hull' does not exist", "one of: none"),
    ),
}


class RefusesBrokenModels(ImportTestCase):
    def test_broken_models(self):
        for name, cases in REFUSED.items():
            for model, *words in cases:
                with self.subTest(words=words):
                    self.assert_refused(model, f"/{name}", *words, name=name)

    def test_errors_of_included_files_have_path_through_both(self):
        for name, content, words in (
            ("arm.config", "", "/sdf/model[vehicle]/include: "),
            ("model.config", "<model/>", "has neither model.config nor model.sdf"),
            ("model.sdf", sdf(link(pose="<pose>x</pose>")), "[vehicle]/include/sdf/model[vehicle]/link[base]/pose: "),
            ("model.config", "<model><sdf>none.sdf</sdf></model>", "none.sdf: cannot be read"),
        ):
            with self.subTest(words=words):
                self.assert_refused(sdf(link() + INCLUDE), "model.sdf:1: /sdf", words, files={f"arm/{name}": content})

    def test_entities(self):
        bomb = "<!DOCTYPE sdf [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;'>]><sdf version='1.9'>&b;</sdf>"
        self.assert_refused(bomb, "document type", "model.sdf:1")
        outside = "<!DOCTYPE sdf SYSTEM 'file:///etc/passwd'><sdf version='1.9'/>"
        self.assert_refused(outside, "document type")

    def test_depth_and_size(self):
        self.assert_refused("<a>" * 5000 + "</a>" * 5000, "nested at most 200 deep")
        limit = xml_file.MAX_BYTES
        self.addCleanup(setattr, xml_file, "MAX_BYTES", limit)
        xml_file.MAX_BYTES = 1024 * 1024
        self.assert_refused("<sdf>" + " " * (1024 * 1024) + "</sdf>", "more than 1 MiB")

    def test_model_that_includes_itself(self):
        text = sdf(link() + "<include><uri>model://vehicle</uri></include>")
        self.assert_refused(text, "too deeply", name="vehicle/model.sdf")

    def test_masses(self):
        automatic = "<inertial auto='true'><density>{}</density></inertial>"
        explicit = "<inertial pos='0 0 0' mass='{}' diaginertia='1 1 1'/><geom type='box' size='1 1 1'/>"
        for name, model in (
            ("model.sdf", sdf(link(inside=box() + inertial("{}")))),
            ("model.sdf", sdf(link(inside=box() + automatic), version="1.11")),
            ("boat.urdf", urdf("{}")),
            ("boat.xml", mjcf(explicit)),
            ("boat.xml", mjcf("<geom type='box' size='1 1 1' mass='{}'/>")),
            ("boat.xml", mjcf("<geom type='box' size='1 1 1' density='{}'/>")),
        ):
            with self.subTest(model=model):
                self.assert_refused(model.format("-2"), "is -2", "at least 0", f"{name}:1", name=name)
                self.assert_refused(model.format("nan"), "is 'nan'", "finite numbers", f"{name}:1", name=name)

    def test_closed_chain_is_reported(self):
        rods = [link(name, box(f"{name} box") + inertial()) for name in ("left", "right", "top")]
        pins = [("base", "left"), ("base", "right"), ("left", "top"), ("right", "top")]
        result = self.import_model(sdf(link() + "".join(rods) + "".join(fixed(*pin, "revolute") for pin in pins)))
        self.assertEqual(len(result.bodies), 4)
        self.assertIn("'top' is the child of the joints 'left to top', 'right to top': a closed chain", result.output)

    def test_text_in_pieces(self):
        result = self.import_model(sdf(link(inside=box(size="1 <x/>2.<y/>5 <!-- z -->&#51;") + inertial())))
        self.assertEqual(result.body["part"][0]["shape"]["size"], [1, 2.5, 3])

    def test_frames_that_are_nested_too_deeply(self):
        frames = [
            f"<frame name='f{i}'><pose relative_to='f{i + 1}'/></frame><frame name='g{i}' attached_to='g{i + 1}'/>"
            for i in range(2000)
        ]
        for name in ("f0", "g0"):
            pose = f"<pose relative_to='{name}'/>"
            self.assert_refused(sdf(link(pose=pose) + "".join(frames)), "more than 200 others")

    def test_missing_file(self):
        result = self.run_import(sdf(link()), "--path", "/nowhere")
        self.assertEqual(result.status, 0)
        done = subprocess.run(
            [sys.executable, "-m", "buoyancy.import_model", "none.sdf"], capture_output=True, text=True, check=False
        )
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("none.sdf: cannot be read", done.stderr)


class PrintsScene(ImportTestCase):
    def test_without_output(self):
        (self.folder / "model.sdf").write_text(sdf(link()), encoding="utf-8")
        done = subprocess.run(
            [sys.executable, "-m", "buoyancy.import_model", self.folder / "model.sdf"],
            capture_output=True,
            text=True,
            check=True,
        )
        self.assertIn("[[body]]", done.stdout)
        self.assertIn("not converted: nothing", done.stderr)

    def test_every_value_has_its_source(self):
        text = self.import_model(sdf(link())).text
        for line in text.splitlines():
            if " = " in line and not line.startswith("#"):
                self.assertIn("#", line)
        self.assertIn("# kg, model.sdf:1", text)

    def test_unwritable_output(self):
        result = self.run_import(sdf(link()), "-o", str(self.folder / "none" / "scene.toml"))
        self.assertEqual(result.status, 1)
        self.assertEqual(len(result.error.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
