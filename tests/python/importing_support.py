"""What the tests of buoyancy-import share: models as text, and the scene and the report that become of them."""
import contextlib
import io
import tempfile
import tomllib
import unittest
from pathlib import Path

import buoyancy
from buoyancy import import_model

BOX_OBJ = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


class Imported:
    """Exit status, what was printed, and the scene that was written."""

    def __init__(self, folder, status, output, error):
        self.folder, self.status, self.output, self.error = folder, status, output, error
        path = folder / "scene.toml"
        self.text = path.read_text(encoding="utf-8") if path.exists() else ""
        self.scene = tomllib.loads(self.text)

    @property
    def bodies(self):
        return self.scene["body"]

    @property
    def body(self):
        return self.scene["body"][0]

    def open(self):
        return buoyancy.Scene(self.folder / "scene.toml")


class ImportTestCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_import(self, model, *options, name="model.sdf", files=None):
        """Imports the text of a model beside other files; every scene is one that the service loads."""
        for path, text in {**(files or {}), name: model}.items():
            (self.folder / path).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / path).write_text(text, encoding="utf-8")
        (self.folder / "scene.toml").unlink(missing_ok=True)
        output, error = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(error):
            status = import_model.main([str(self.folder / name), "-o", str(self.folder / "scene.toml"), *options])
        return Imported(self.folder, status, output.getvalue(), error.getvalue())

    def import_model(self, model, *options, **arguments):
        result = self.run_import(model, *options, **arguments)
        self.assertEqual(result.status, 0, result.error)
        return result

    def assert_refused(self, model, *words, **arguments):
        """One line on standard error with these words, exit status 2, and no scene."""
        result = self.run_import(model, *arguments.pop("options", ()), **arguments)
        self.assertEqual(result.status, 2)
        self.assertEqual(len(result.error.splitlines()), 1, result.error)
        for word in words:
            self.assertIn(word, result.error)
        self.assertEqual(result.text, "")

    def assert_numbers(self, actual, expected, tolerance=1e-9):
        self.assertEqual(len(actual), len(expected), actual)
        for a, b in zip(actual, expected):
            self.assertAlmostEqual(a, b, delta=tolerance * max(1.0, abs(b)))


def box(name="box", size="1 1 1", pose=""):
    return f"<collision name='{name}'>{pose}<geometry><box><size>{size}</size></box></geometry></collision>"


def inertial(mass=500, pose="", moments=(80, 90, 100), products=(0, 0, 0)):
    entries = dict(zip(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), (*moments, *products)))
    inside = "".join(f"<{key}>{value}</{key}>" for key, value in entries.items())
    return f"<inertial>{pose}<mass>{mass}</mass><inertia>{inside}</inertia></inertial>"


def link(name="base", inside=None, pose=""):
    return f"<link name='{name}'>{pose}{box() + inertial() if inside is None else inside}</link>"


def fixed(parent, child, kind="fixed"):
    return f"<joint name='{parent} to {child}' type='{kind}'><parent>{parent}</parent><child>{child}</child></joint>"


def sdf(inside, version="1.9", pose="", attributes=""):
    return f"<sdf version='{version}'><model name='vehicle' {attributes}>{pose}{inside}</model></sdf>"


def urdf(mass=5, moments=(20, 30, 40), joints="", links=""):
    entries = " ".join(f"i{axis}{axis}='{moment}'" for axis, moment in zip("xyz", moments))
    return (
        f"<robot name='boat'><link name='base'><inertial><mass value='{mass}'/>"
        f"<inertia {entries} ixy='0' ixz='0' iyz='0'/></inertial>"
        f"<collision><geometry><box size='1 1 1'/></geometry></collision></link>{links}{joints}</robot>"
    )


def urdf_joint(parent, child):
    return f"<joint name='{parent} to {child}' type='fixed'><parent link='{parent}'/><child link='{child}'/></joint>"


def mjcf(inside="<geom type='box' size='1 1 1'/>"):
    return f"<mujoco><worldbody><body name='b'><freejoint/>{inside}</body></worldbody></mujoco>"


def world(*plugins, model=None, gravity=""):
    inside = model or f"<model name='vehicle'>{link()}</model>"
    return f"<sdf version='1.9'><world name='sea'>{gravity}{''.join(plugins)}{inside}</world></sdf>"
