"""The module beside threads, child processes, and without numpy."""
import os
import subprocess
import sys
import threading
import time
import unittest

import numpy as np

import buoyancy
from support import SANITIZED, SOURCE, Reference, TestCase, box, rows_of

TIMEOUT = 60.0 * float(os.environ.get("BUOYANCY_TEST_TIMEOUT_FACTOR", "1"))


class WorksWithThreadsAndProcesses(TestCase):
    @classmethod
    def setUpClass(cls):
        cls.reference = Reference()

    def test_results_do_not_depend_on_threads(self):
        mesh = self.reference.mesh("rock")
        expected = self.reference.rows("rest", 1)
        results = []

        def query():
            for _ in range(20):
                results.append(rows_of(mesh.query(self.reference.position, self.reference.quaternion)))

        threads = [threading.Thread(target=query) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(TIMEOUT)
        self.assertEqual(len(results), 80)
        for result in results:
            self.assert_same_bits(result, expected)

    def test_python_runs_during_a_query(self):
        mesh = self.reference.mesh("rock")
        position = np.tile(self.reference.position, (200, 1))
        quaternion = np.tile(self.reference.quaternion, (200, 1))
        started, ended = threading.Event(), threading.Event()
        times = []

        def query():
            times.append(time.perf_counter())
            started.set()
            mesh.query(position, quaternion, method="exact_surface")
            times.append(time.perf_counter())
            ended.set()

        mesh.query(position[0], quaternion[0], method="exact_surface")  # prepares the method
        thread = threading.Thread(target=query)
        thread.start()
        started.wait(TIMEOUT)
        longest, last = 0.0, time.perf_counter()
        while not ended.is_set():
            now = time.perf_counter()
            longest, last = max(longest, now - last), now
        thread.join(TIMEOUT)
        # With the lock held, this thread would stand still for nearly all of the query.
        self.assertLess(longest, 0.7 * (times[1] - times[0]))

    def test_meshes_are_imported_beside_threads(self):
        stop = threading.Event()

        def busy():
            while not stop.is_set():
                sum(range(1000))

        thread = threading.Thread(target=busy)
        thread.start()
        try:
            path = next((SOURCE / "scenes" / "meshes").glob("*.obj"))
            meshes = []
            importers = [threading.Thread(target=lambda: meshes.append(buoyancy.Mesh(path))) for _ in range(4)]
            for importer in importers:
                importer.start()
            for importer in importers:
                importer.join(TIMEOUT)
        finally:
            stop.set()
            thread.join(TIMEOUT)
        self.assertEqual(len({mesh.volume for mesh in meshes}), 1)
        self.assertEqual(len(meshes), 4)

    def test_forked_children_give_the_same_results(self):
        mesh = self.reference.mesh("rock")
        position, quaternion = (np.tile(array, (20, 1)) for array in (self.reference.position, self.reference.quaternion))
        expected = rows_of(mesh.query(position, quaternion, threads=2))
        children = []
        for threads in (0, 1, 2, 3):
            child = os.fork()
            if child == 0:
                same = np.array_equal(rows_of(mesh.query(position, quaternion, threads=threads)), expected)
                os._exit(0 if same else 1)
            children.append(child)
        # A child that hangs is killed, which its status says.
        killer = threading.Timer(TIMEOUT, lambda: [os.kill(child, 9) for child in children])
        killer.start()
        statuses = [os.waitpid(child, 0)[1] for child in children]
        killer.cancel()
        self.assertEqual(statuses, [0] * 4)

    def test_children_forked_during_a_query_do_not_hang(self):
        mesh = self.reference.mesh("rock")
        position, quaternion = (np.tile(array, (20, 1)) for array in (self.reference.position, self.reference.quaternion))
        expected = rows_of(mesh.query(position, quaternion, threads=2))
        stop = threading.Event()

        def query():
            while not stop.is_set():
                mesh.query(position, quaternion, threads=2)

        thread = threading.Thread(target=query)
        thread.start()
        children = []
        try:
            for _ in range(10):
                child = os.fork()
                if child == 0:
                    same = np.array_equal(rows_of(mesh.query(position, quaternion)), expected)
                    os._exit(0 if same else 1)
                children.append(child)
        finally:
            stop.set()
            thread.join(TIMEOUT)
        killer = threading.Timer(TIMEOUT, lambda: [os.kill(child, 9) for child in children])
        killer.start()
        statuses = [os.waitpid(child, 0)[1] for child in children]
        killer.cancel()
        self.assertEqual(statuses, [0] * 10)

    def test_a_thread_in_a_query_survives_the_end_of_the_interpreter(self):
        script = ("import sys, threading, buoyancy\n"
                  "mesh = buoyancy.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],\n"
                  "                     [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])\n"
                  "begun = threading.Event()\n"
                  "def query():\n"
                  "    while True:\n"
                  "        mesh.query((0, 0, 0), (1, 0, 0, 0))\n"
                  "        begun.set()\n"
                  "for _ in range(3): threading.Thread(target=query, daemon=True).start()\n"
                  "begun.wait()\n")
        for _ in range(5):
            done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=TIMEOUT,
                                  check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


WITHOUT_NUMPY = """
import array, sys
sys.modules["numpy"] = None
import buoyancy
points = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
         (1, 5, 7), (1, 7, 3)]
mesh = buoyancy.Mesh(points, faces)
one = mesh.query((0, 0, -0.25), (1, 0, 0, 0))
assert isinstance(one.force, memoryview) and one.force.format == "d" and one.force.shape == (3,), one.force
assert one.volume == 0.75 and one.status is buoyancy.Status.OK
position = memoryview(array.array("d", [0, 0, -0.25, 0, 0, 5])).cast("B").cast("d", (2, 3))
many = mesh.query(position, (1, 0, 0, 0))
assert many.force.shape == (2, 3) and many.volume.tolist() == [0.75, 0.0] and many.status.tolist() == [0, 0]
assert many.force[0, 2] == one.force[2]
force = many.force
del many
assert force[0, 2] == one.force[2]
assert mesh.hydrostatics((0, 0, 0), (1, 0, 0, 0)).stiffness.shape == (6, 6)
assert mesh.hydrostatics(position, (1, 0, 0, 0)).waterplane_area.tolist() == [1.0, 0.0]
assert buoyancy.Sea().elevation([0, 1], 0, 0).tolist() == [0.0, 0.0]
try:
    mesh.query("abc", (1, 0, 0, 0))
except TypeError:
    print("done")
"""


class WorksWithoutNumpy(TestCase):
    def test_results_are_memoryviews(self):
        done = subprocess.run([sys.executable, "-c", WITHOUT_NUMPY], capture_output=True, text=True, timeout=TIMEOUT)
        self.assertEqual((done.returncode, done.stdout), (0, "done\n"), done.stderr)


if __name__ == "__main__":
    unittest.main()
