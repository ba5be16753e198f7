"""buoyancy.testing: the fixture for pytest and the class that it is made of."""
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import buoyancy
from buoyancy.testing import Service, ServiceError
from support import BIN, SOURCE, without_preload

try:
    import pytest  # noqa: F401
except ImportError:
    pytest = None

BOX = '[[body]]\nid = 1\nshape = { type = "box", size = [1, 1, 1] }\n'
PROGRAM = BIN / "buoyancyd"


def lift_of_half_a_box(url):
    with buoyancy.Client(lcm_url=url, timeout=5.0) as client:
        return client.request(1, (0, 0, 0), (1, 0, 0, 0)).force[2]


def run_pytest(folder, *wrapper, **environment):
    return subprocess.run([*wrapper, sys.executable, "-m", "pytest", "-p", "no:cacheprovider", folder],
                          env={**os.environ, "BUOYANCYD": str(PROGRAM), **environment}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def state_of(pid):
    """The letter of a process's state, None if there is no such process."""
    try:
        return Path("/proc", pid, "stat").read_text().rsplit(")", 1)[1].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return None


class StartsTheService(unittest.TestCase):
    def test_on_an_address_of_its_own(self):
        with Service(scene_text="[water]\ndensity = 1000\n" + BOX, program=PROGRAM) as fresh, \
                Service(scene_text=BOX, program=PROGRAM) as salt:
            self.assertNotEqual(fresh.lcm_url, salt.lcm_url)
            self.assertAlmostEqual(lift_of_half_a_box(fresh.lcm_url), 500.0 * 9.80665, delta=1e-9)
            self.assertAlmostEqual(lift_of_half_a_box(salt.lcm_url), 512.5 * 9.80665, delta=1e-9)

    def test_and_stops_it(self):
        with Service(SOURCE / "scenes/box.toml", arguments=["--mode", "latest"], program=PROGRAM) as service:
            self.assertTrue(service.is_running)
            self.assertIn("mode latest", service.log)
        self.assertFalse(service.is_running)
        self.assertEqual(service.stop(), 0)
        self.assertFalse(Path("/proc", str(service.pid)).exists())

    def test_that_outlives_the_thread_that_started_it(self):
        services = []
        thread = threading.Thread(target=lambda: services.append(Service(scene_text=BOX, program=PROGRAM)))
        thread.start()
        thread.join()
        self.assertAlmostEqual(lift_of_half_a_box(services[0].lcm_url), 512.5 * 9.80665, delta=1e-9)
        self.assertEqual(services[0].stop(), 0)

    def test_and_removes_the_scene_that_it_wrote(self):
        with tempfile.TemporaryDirectory() as folder:
            before, tempfile.tempdir = tempfile.tempdir, folder
            try:
                with Service(scene_text=BOX, program=PROGRAM):
                    self.assertTrue(os.listdir(folder))
                self.assertFalse(os.listdir(folder))
            finally:
                tempfile.tempdir = before

    def test_or_says_why_not(self):
        for options, reason in (
            (dict(scene_text=BOX + BOX), "the same id"),
            (dict(scene="no/such.toml"), "no/such.toml"),
            (dict(scene_text=BOX, program="/no/such/buoyancyd"), "set \\$BUOYANCYD"),
        ):
            with self.assertRaisesRegex(ServiceError, reason):
                Service(**{"program": PROGRAM, **options})
        for options in ({}, dict(scene="a", scene_text="b")):
            with self.assertRaisesRegex(ValueError, "one of scene and scene_text"):
                Service(**options)

    def test_that_ends_with_the_test_process(self):
        script = ("import os, buoyancy.testing as t\n"
                  f"print(t.Service({str(SOURCE / 'scenes/box.toml')!r}, program={str(PROGRAM)!r}).pid, flush=True)\n"
                  "os.kill(os.getpid(), 9)")
        run = subprocess.run([sys.executable, "-c", script], text=True, stdout=subprocess.PIPE)
        self.assertEqual(run.returncode, -signal.SIGKILL)
        # Its new parent may take a moment to reap it.
        while state_of(run.stdout.strip()) not in ("Z", None):
            time.sleep(0.01)


@unittest.skipIf(pytest is None, "pytest is not installed")
class RunsUnderPytest(unittest.TestCase):
    def test_the_example(self):
        run = run_pytest(SOURCE / "client/examples/testing")
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertNotIn("The log of buoyancyd", run.stdout)

    def test_a_failure_shows_the_log(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "conftest.py").write_text('pytest_plugins = ["buoyancy.testing"]\n')
            Path(folder, "test_that_fails.py").write_text(
                "import os\n"
                f"SCENE = {BOX!r}\n"
                "def test_fails(buoyancy_service):\n"
                "    buoyancy_service(scene_text=SCENE)\n"
                "    assert False\n"
                "def test_whose_service_dies(buoyancy_service):\n"
                "    os.kill(buoyancy_service(scene_text=SCENE).pid, 9)\n")
            run = run_pytest(folder)
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertRegex(run.stdout, "(?s)The log of buoyancyd.*ready:")
        self.assertIn("buoyancyd ended with exit code", run.stdout)

    # In a new network namespace the loopback is down and there is no route.
    def test_without_root_and_without_a_multicast_route(self):
        wrapper = ["unshare", "--net"]
        if os.geteuid() == 0:
            wrapper += ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
        else:
            wrapper.append("--user")
        if subprocess.run([*wrapper, "unshare", "--user", "--net", "true"], stderr=subprocess.DEVNULL,
                          env=without_preload()).returncode != 0:
            self.skipTest("no user namespaces here")
        with tempfile.TemporaryDirectory() as folder:
            os.chmod(folder, 0o755)
            for name in ("conftest.py", "test_service_round_trip.py"):
                text = (SOURCE / "client/examples/testing" / name).read_text()
                # numpy starts threads, after which the kernel would refuse.
                Path(folder, name).write_text(text.replace("import buoyancy\n", "import buoyancy, numpy\n"))
            run = run_pytest(folder, *wrapper)
        self.assertEqual(run.returncode, 0, run.stdout)


if __name__ == "__main__":
    unittest.main()
