"""Client against the real buoyancyd over UDP, in a network namespace."""
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import buoyancy
from support import BIN, SOURCE, TestCase, rows_of, without_preload

TIMEOUT = 60.0 * float(os.environ.get("BUOYANCY_TEST_TIMEOUT_FACTOR", "1"))
LONG_WAIT = dict(max_retries=100_000)  # CTest ends the test before

SCENE = """
[[body]]
id = 3
name = "crate"
shape = { type = "box", segments = [4, 4, 4] }
outputs = ["wrench", "loads"]
[body.drag]
linear = [10, 10, 10, 1, 1, 1]
[[body]]
id = 8
name = "rock"
shape = { type = "rock" }
"""

SEA = """
[water]
density = 1000
[[water.layer]]
below = -2
density = 1025
[[water.current.profile]]
height = 0
velocity = [0.8, 0, 0]
[[water.current.profile]]
height = -5
velocity = [0, 0.2, 0]
[[water.waves]]
type = "jonswap"
significant_wave_height = 0.7
peak_period = 4
"""

WAIT_FOR_CTRL_C = """
import buoyancy
with buoyancy.Client(max_retries=100_000) as client:
    try:
        client.request(1, (0, 0, 0), (1, 0, 0, 0))
    except KeyboardInterrupt:
        print("interrupted", flush=True)
"""


class Service:
    """buoyancyd with a scene, from ready to the end of the with block."""

    def __init__(self, scene):
        self.process = subprocess.Popen([BIN / "buoyancyd", "--scene", scene], stderr=subprocess.PIPE, text=True,
                                        env=without_preload())

    def __enter__(self):
        log = []
        for line in self.process.stderr:
            log.append(line)
            if "ready:" in line:
                # Its log must not fill the pipe.
                self.reader = threading.Thread(target=self.process.stderr.read)
                self.reader.start()
                return self
        raise RuntimeError("buoyancyd did not become ready: " + "".join(log))

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(TIMEOUT)
        self.reader.join(TIMEOUT)
        self.process.stderr.close()


class ExchangesMessagesWithTheService(TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = os.path.join(cls.folder.name, "scene.toml")
        with open(cls.path, "w", encoding="utf-8") as file:
            file.write(SCENE)
        cls.scene = buoyancy.Scene(cls.path)
        random = np.random.default_rng(3)
        cls.position = random.uniform(-1, 1, (40, 3))
        quaternion = random.normal(size=(40, 4))
        cls.quaternion = quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)
        cls.velocity = random.normal(size=(40, 3))

    def test_responses_equal_queries(self):
        with Service(self.path), buoyancy.Client(scene=self.scene, **LONG_WAIT) as client:
            ids = np.where(np.arange(40) % 2, 3, 8)
            result = client.request(ids, self.position, self.quaternion, linear_velocity=self.velocity, time=1.5)
            self.assertEqual(result.utime, 1_500_000)
            self.assert_same_bits(result.body_ids, ids.astype(np.int32))
            for body_id in (3, 8):
                rows = ids == body_id
                expected = self.scene.query(body_id, self.position[rows], self.quaternion[rows],
                                            linear_velocity=self.velocity[rows])
                self.assert_same_bits(rows_of(result)[rows], rows_of(expected))
            # One body at many poses; one body at one pose; all bodies; the same result again.
            many = client.request("rock", self.position, self.quaternion, utime=7)
            self.assert_same_bits(rows_of(many), rows_of(self.scene.query("rock", self.position, self.quaternion)))
            one = client.request(8, self.position[0], self.quaternion[0])
            self.assertEqual(one.force.tolist(), many.force[0].tolist())
            force = many.force
            self.assertIs(client.request("crate", self.position, self.quaternion, out=many), many)
            self.assert_same_bits(force, self.scene.query("crate", self.position, self.quaternion).force)
            everything = client.request(None, self.position[:2], self.quaternion[:2])
            self.assertEqual(everything.body_ids.tolist(), [3, 8])
            extrapolated = client.request(8, (0, 0, -1), (1, 0, 0, 0), linear_velocity=(0, 0, 1), lead_time=0.5)
            self.assertEqual(extrapolated.volume, client.request(8, (0, 0, -0.5), (1, 0, 0, 0)).volume)
            self.assertEqual((client.statistics["requests"], client.statistics["malformed"]), (7, 0))
            self.assertGreater(client.statistics["round_trip_p50"], 0)
            self.assertIsNone(client.reserve(2))

    def test_samples_of_the_water_equal_those_of_a_sea(self):
        path = os.path.join(self.folder.name, "sea.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(SEA + SCENE)
        sea = buoyancy.Sea(path)
        points = np.random.default_rng(5).uniform((-40, -40, -6), (40, 40, 1), (3_000, 3))
        x, y, z = points.T
        with Service(path), buoyancy.Client(**LONG_WAIT) as client:
            water = client.sample_water(points, time=12.5)
            self.assertEqual((water["status"], water["utime"]), (buoyancy.Status.OK, 12_500_000))
            self.assert_same_bits(water["elevation"], sea.elevation(x, y, 12.5))
            self.assert_same_bits(water["pressure"], sea.pressure(x, y, z, 12.5))
            below = z <= water["elevation"]
            self.assertGreater(np.count_nonzero(~below), 50)
            self.assert_same_bits(water["velocity"],
                                  np.where(below[:, None], sea.velocity(x, y, z, 12.5), 0.0))
            self.assert_same_bits(water["density"], np.where(np.minimum(z, water["elevation"]) < -2, 1025.0, 1000.0))
            self.assert_same_bits(client.sample_water(points, utime=12_500_000)["pressure"], water["pressure"])
            lost = client.sample_water([[0, 0, np.nan], [0, 0, -1]])
            self.assertEqual(lost["status"], buoyancy.Status.NON_FINITE_POSE)
            self.assertEqual(lost["pressure"].tolist(), [0, 0])
            self.assertEqual(client.sample_water(np.zeros((0, 3)))["velocity"].shape, (0, 3))
            with self.assertRaisesRegex(ValueError, r"points has shape \(3,\); expected \(n, 3\)"):
                client.sample_water((0, 0, -1))
            with self.assertRaisesRegex(buoyancy.ServiceError, "water at 400000 points"):
                client.sample_water(np.zeros((400_000, 3)))

    def test_status_has_the_fields_of_the_message(self):
        message = (SOURCE / "lcmtypes" / "service_status_t.lcm").read_text(encoding="utf-8")
        with Service(self.path), buoyancy.Client(scene=self.scene, **LONG_WAIT) as client:
            client.request(8, (0, 0, 0), (1, 0, 0, 0))
            status = client.status(timeout=TIMEOUT)
            self.assertEqual(list(status), re.findall(r"^  (?:int32_t|int64_t|double|string) (\w+);", message, re.M))
            self.assertEqual((status["scene_bodies"], status["scene"], status["requests"], status["bodies_ok"]),
                             (2, self.path, 1, 1))
            self.assertRegex(status["version"], r"^\d+\.\d+\.\d+$")
            self.assertGreater(client.status(timeout=TIMEOUT)["uptime"], status["uptime"])
            with self.assertRaisesRegex(ValueError, "timeout = 0; expected seconds above 0"):
                client.status(timeout=0)
        with buoyancy.Client() as client:
            with self.assertRaisesRegex(buoyancy.ServiceError, "no status for 0.01 s"):
                client.status(timeout=0.01)

    def test_another_scene_gets_a_warning(self):
        other = buoyancy.Scene.from_text(SCENE.replace("10, 10, 10", "10, 10, 11"))
        with Service(self.path), buoyancy.Client(scene=other, **LONG_WAIT) as client:
            with self.assertWarnsRegex(UserWarning, "another scene, from its file"):
                client.status(timeout=TIMEOUT)
                client.request(8, (0, 0, 0), (1, 0, 0, 0))

    def test_loads_and_unknown_bodies(self):
        with Service(self.path), buoyancy.Client(loads=True, **LONG_WAIT) as client:
            result = client.request([8, 3, 7], self.position[:3], self.quaternion[:3], linear_velocity=(1, 0, 0))
            self.assertEqual(result.status.tolist(), [0, 0, buoyancy.Status.UNKNOWN_BODY])
            expected = self.scene.query(3, self.position[1], self.quaternion[1], linear_velocity=(1, 0, 0)).loads
            self.assert_same_bits(result.loads.drag_force[1], expected.drag_force)
            self.assertEqual(result.loads.drag_force[0].tolist(), [0, 0, 0])
            with self.assertRaisesRegex(buoyancy.StatusError, "body 7: UNKNOWN_BODY"):
                result.raise_for_status()

    def test_no_service(self):
        with buoyancy.Client(timeout=0.01, max_retries=2) as client:
            with self.assertRaisesRegex(buoyancy.ServiceError, "no response for .* Start buoyancyd"):
                client.request(1, (0, 0, 0), (1, 0, 0, 0))
            self.assertEqual(client.statistics["unanswered"], 1)

    def test_closed_clients_and_bad_arguments(self):
        client = buoyancy.Client(scene=self.path, timeout=0.01, max_retries=0)
        pose = (0, 0, 0), (1, 0, 0, 0)
        refused = [
            (KeyError, "no body 7", lambda: client.request(7, *pose)),
            (TypeError, "body_ids is a float", lambda: client.request(1.5, *pose)),
            (ValueError, "names 2 bodies, but the poses are 1", lambda: client.request([3, 8], *pose)),
            (TypeError, "time and utime", lambda: client.request(3, *pose, time=1.0, utime=1)),
            (TypeError, "utime is .*expected integers", lambda: client.request(3, *pose, utime=1.5)),
            (ValueError, "position has shape", lambda: client.request(3, (0, 0), (1, 0, 0, 0))),
            (TypeError, "lead_time", lambda: client.request(3, *pose, lead_time="1")),
            (ValueError, "timeout = 0", lambda: buoyancy.Client(timeout=0)),
            (ValueError, "max_retries = -1", lambda: buoyancy.Client(max_retries=-1)),
            (buoyancy.ServiceError, "udp", lambda: buoyancy.Client("udpx://1")),
        ]
        for error, reason, call in refused:
            with self.subTest(reason=reason), self.assertRaisesRegex(error, reason):
                call()
        self.assertFalse(client.closed)
        client.close()
        client.close()
        self.assertTrue(client.closed)
        for call in (lambda: client.request(3, *pose), lambda: client.reserve(1), lambda: client.statistics):
            with self.assertRaisesRegex(buoyancy.ServiceError, "is closed; expected an open client"):
                call()

    def test_other_threads(self):
        client = buoyancy.Client(**LONG_WAIT)
        errors = []

        def wait():
            try:
                client.request(1, (0, 0, 0), (1, 0, 0, 0))
            except buoyancy.ServiceError as error:
                errors.append(str(error))

        waiting = threading.Thread(target=wait)
        waiting.start()
        # Refused once the other thread waits; a request of this thread that comes first has no response either.
        refused = 0
        while not errors and refused == 0:
            try:
                client.statistics
            except buoyancy.ServiceError as error:
                self.assertRegex(str(error), "in use by another thread")
                refused += 1
        client.close()
        waiting.join(TIMEOUT)
        self.assertRegex(errors[0], "was closed while it waited")
        self.assertTrue(client.closed)

    def test_ctrl_c_ends_the_wait(self):
        # The client waits once it has sent its request.
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
            listener.bind(("", 7667))
            listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                                socket.inet_aton("239.255.76.67") + socket.inet_aton("0.0.0.0"))
            listener.settimeout(TIMEOUT)
            process = subprocess.Popen([sys.executable, "-c", WAIT_FOR_CTRL_C], stdout=subprocess.PIPE, text=True)
            while b"BUOYANCY_STATES" not in listener.recv(65536):
                pass  # LCM's own test of the network
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.stdout.readline(), "interrupted\n")
        self.assertEqual(process.wait(TIMEOUT), 0)
        process.stdout.close()


if __name__ == "__main__":
    unittest.main()
