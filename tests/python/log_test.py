"""read_log gives the arrays of logs and CSV files, also of damaged ones."""
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import buoyancy
from support import BIN, SOURCE, WATERS, Reference, TestCase, without_preload

HEADER = "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n"
SCENE = SOURCE / "scenes" / "box.toml"


class ReadsRecordings(TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = Path(cls._folder.name)
        cls.rows = np.random.default_rng(4).uniform(-0.2, 0.2, (50, 13))
        cls.rows[:, 3:7] /= np.linalg.norm(cls.rows[:, 3:7], axis=1, keepdims=True)
        text = HEADER + "".join(f"{1000 * i},1,{','.join(map(repr, map(float, row)))}\n" for i, row in enumerate(cls.rows))
        (cls.folder / "poses.csv").write_text(text)
        for output in ("out.csv", "out.lcmlog"):
            subprocess.run([BIN / "buoyancy-replay", "--scene", SCENE, "poses.csv", output], cwd=cls.folder, check=True,
                           env=without_preload(), capture_output=True)

    def read(self, name, **keywords):
        return buoyancy.read_log(self.folder / name, **keywords)

    def test_poses_from_csv(self):
        log = self.read("poses.csv")
        states = log.states
        self.assertEqual((len(states), len(log.wrenches), log.corrupt_sections, log.rejected), (50, 0, (), 0))
        self.assert_same_bits(states.position, self.rows[:, :3])
        self.assert_same_bits(states.linear_velocity, self.rows[:, 7:10])
        self.assertEqual(states.utime.tolist(), list(range(0, 50_000, 1000)))
        self.assertEqual(set(states.body_id), {1})
        self.assertEqual(self.read("out.csv").states.position.shape, (0, 3))

    def test_wrenches_of_a_replay_equal_queries(self):
        states = self.read("poses.csv").states
        expected = buoyancy.Scene(SCENE).query(1, states.position, states.quaternion)
        for name in ("out.csv", "out.lcmlog"):
            log = self.read(name)
            wrenches = log.wrenches
            for column in ("status", "force", "torque", "volume", "center_of_buoyancy", "force_error_bound",
                           "torque_error_bound"):
                with self.subTest(name=name, column=column):
                    self.assert_same_bits(getattr(wrenches, column), getattr(expected, column))
            self.assertEqual(wrenches.utime.tolist(), states.utime.tolist())
        self.assertEqual(len(self.read("out.lcmlog", wrenches_channel="OTHER").wrenches), 0)

    def test_missing_messages(self):
        # An event has magic, number, time, and the lengths of channel and message before these.
        bytes_left = (self.folder / "out.lcmlog").read_bytes()
        events = []
        while bytes_left:
            size = 28 + sum(struct.unpack(">II", bytes_left[20:28]))
            events.append(bytes_left[:size])
            bytes_left = bytes_left[size:]
        path = self.folder / "holes.lcmlog"
        path.write_bytes(b"".join(events[:3] + events[5:40] + events[41:]))
        log = buoyancy.read_log(path)
        session = int(log.wrenches.session_id[0])
        first = int(log.wrenches.seq[0])
        self.assertEqual(log.missing_responses, {session: [(first + 3, first + 4), (first + 40, first + 40)]})
        self.assertEqual(log.missing_requests, {})
        self.assertEqual(self.read("out.lcmlog").missing_responses, {})

    def test_poses_and_wrenches_of_a_log(self):
        reference = Reference()
        for water in WATERS:
            log = buoyancy.read_log(reference.folder / f"{water}.lcmlog")
            self.assertEqual((len(log.states), len(log.wrenches), log.rejected), (6000, 6000, 0))
            for body_id in range(1, 7):
                rows = np.flatnonzero(log.states.body_id == body_id)
                self.assert_same_bits(log.states.position[rows], reference.position)
                self.assert_same_bits(log.states.quaternion[rows], reference.quaternion)
                self.assert_same_bits(log.states.angular_velocity[rows], reference.angular_velocity)
                self.assert_same_bits(log.states.utime[rows] / 1e6, reference.time)
                rows = np.flatnonzero(log.wrenches.body_id == body_id)
                self.assert_same_bits(log.wrenches.force[rows], reference.rows(water, body_id)[:, 1:4])

    def test_corrupt_parts_are_skipped_and_reported(self):
        # Every column, of wrenches and of poses, and rows that are too short and too long, after a line of nothing.
        for name, part in (("out.csv", "wrenches"), ("poses.csv", "states")):
            lines = (self.folder / name).read_text().splitlines()
            fields = lines[7].split(",")
            damaged = [fields[:column] + [text] + fields[column + 1:] for column in range(len(fields))
                       for text in ("", "x", fields[column] + "x")]
            for damage in (*damaged, fields[:-1], fields + ["1"], ["1", "2"]):
                (self.folder / "damaged.csv").write_text("\n".join([*lines[:7], " ", ",".join(damage), *lines[8:]]))
                log = self.read("damaged.csv")
                self.assertEqual(len(getattr(log, part)), 49, damage)
                self.assertEqual(len(log.corrupt_sections), 1)
                self.assertRegex(log.corrupt_sections[0], "^line 9: ")
        whole = bytearray((self.folder / "out.lcmlog").read_bytes())
        second = whole.index(struct.pack(">I", 0xEDA1DA01), 1)
        whole[second:second + 4] = b"\0\0\0\0"
        (self.folder / "damaged.lcmlog").write_bytes(whole)
        log = self.read("damaged.lcmlog")
        self.assertGreater(len(log.corrupt_sections), 0)
        self.assertLess(len(log.wrenches), 50)
        self.assertGreater(len(log.wrenches), 0)
        # Messages of another type on the channel.
        self.assertEqual(self.read("out.lcmlog", states_channel="BUOYANCY_WRENCHES", wrenches_channel="X").rejected, 50)

    def test_random_damage_never_crashes(self):
        random = np.random.default_rng(5)
        for name in ("out.lcmlog", "out.csv", "poses.csv"):
            whole = np.frombuffer((self.folder / name).read_bytes(), np.uint8)
            for _ in range(100):
                damaged = whole.copy()
                damaged[random.integers(0, damaged.size, 20)] = random.integers(0, 256, 20)
                path = self.folder / ("random" + Path(name).suffix)
                path.write_bytes(damaged[:random.integers(damaged.size)].tobytes())
                try:
                    buoyancy.read_log(path)
                except buoyancy.InputError:
                    self.assertEqual(path.suffix, ".csv")  # the header was hit

    def test_files_that_cannot_be_read(self):
        for name, reason in (("none.lcmlog", "No such file"), ("none.csv", "No such file"), ("a.txt", "ends in .lcmlog or .csv")):
            with self.assertRaisesRegex(buoyancy.InputError, reason):
                self.read(name)
        (self.folder / "other.csv").write_text("a,b,c\n1,2,3\n")
        with self.assertRaisesRegex(buoyancy.InputError, "header"):
            self.read("other.csv")
        with self.assertRaises(TypeError):
            buoyancy.read_log(3.5)
        (self.folder / "empty.csv").write_text("")
        self.assertEqual(len(self.read("empty.csv").states), 0)


if __name__ == "__main__":
    unittest.main()
