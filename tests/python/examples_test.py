"""The examples run, and print what physics says."""
import re
import subprocess
import sys
import unittest

from support import SOURCE, Reference, TestCase


class RunsExamples(TestCase):
    def run_example(self, name, *arguments):
        done = subprocess.run([sys.executable, SOURCE / "client" / "examples" / "python" / name, *map(str, arguments)],
                              cwd=SOURCE, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_float_a_mesh(self):
        mass, height, volume = map(float, re.fullmatch(
            r"([\d.]+) kg float at z = ([\d.]+) m and displace ([\d.]+) m³\n", self.run_example("float_a_mesh.py")).groups())
        self.assertAlmostEqual(mass / 1025, volume, places=3)
        self.assertTrue(0 < height < 0.5)

    def test_float_a_mesh_is_what_the_readme_shows(self):
        readme = (SOURCE / "README.md").read_text(encoding="utf-8")
        example = (SOURCE / "client/examples/python/float_a_mesh.py").read_text(encoding="utf-8")
        shown = re.search(r"```python\n(.*?)```", readme, re.DOTALL)[1]
        self.assertEqual(shown, example[example.index("import buoyancy"):])
        self.assertIn(f"The ten lines print `{self.run_example('float_a_mesh.py').strip()}`", readme)

    def test_righting_arm(self):
        rows = self.run_example("righting_arm.py").splitlines()[1:]
        arms = {float(angle): float(arm) for angle, arm in (row.split() for row in rows)}
        self.assertAlmostEqual(arms[0.0], 0.0, places=6)
        # Two hulls apart: the arm is at most half the distance between them, and large at a small heel.
        self.assertTrue(0.5 < arms[10.0] < 1.5)

    def test_read_log(self):
        reference = Reference()
        output = self.run_example("read_log.py", reference.folder / "waves.toml", reference.folder / "waves.lcmlog")
        self.assertIn("6000 states, 6000 wrenches", output)
        self.assertEqual(output.count("differs from the recorded forces by at most 0.0e+00 N"), 6)

    def test_gym_environment(self):
        reward = re.search(r"64 environments, 200 steps: mean reward ([-\d.]+), 0 terminated",
                           self.run_example("gym_environment.py", 64, 200))
        self.assertGreater(float(reward[1]), 0.9)


if __name__ == "__main__":
    unittest.main()
