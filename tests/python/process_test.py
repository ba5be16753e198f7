"""The module beside threads and child processes, and without numpy."""
import ctypes
import functools
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import weakref
from pathlib import Path

import numpy as np

import buoyancy
from support import SANITIZED, SOURCE, WATERS, Reference, TestCase, box, rows_of

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

    def test_arrays_of_a_query_cannot_be_resized(self):
        mesh = self.reference.mesh("rock")
        for name in ("position", "quaternion"):
            # np.tile() makes views, which numpy resizes never.
            arrays = {"position": np.tile(self.reference.position, (100, 1)).copy(),
                      "quaternion": np.tile(self.reference.quaternion, (100, 1)).copy()}
            thread = threading.Thread(target=lambda: mesh.query(**arrays, method="exact_surface"))
            thread.start()
            deadline = time.monotonic() + TIMEOUT
            while weakref.getweakrefcount(arrays[name]) == 0 and time.monotonic() < deadline:
                pass
            with self.assertRaisesRegex(ValueError, "referenced"):
                arrays[name].resize((1, 1), refcheck=False)
            thread.join(TIMEOUT)
            self.assertEqual(weakref.getweakrefcount(arrays[name]), 0)

    def test_a_signal_ends_a_long_query(self):
        mesh = self.reference.mesh("rock")
        count = 20 * len(self.reference.position)
        position, quaternion = np.tile(self.reference.position, (20, 1)), np.tile(self.reference.quaternion, (20, 1))
        sea = buoyancy.Sea(**WATERS["waves"])
        points = np.zeros(2_000_000)
        out = mesh.query(position, quaternion, sea=sea, tolerance=1e-2)

        class Interrupted(Exception):
            pass

        def interrupt(*_):
            raise Interrupted

        before = signal.signal(signal.SIGALRM, interrupt)
        try:
            for call in (lambda: mesh.query(position, quaternion, method="exact_surface", out=out),
                         lambda: sea.elevation(points, points, np.arange(2_000_000.0))):
                out.force[:] = np.nan
                signal.setitimer(signal.ITIMER_REAL, 0.01)
                with self.assertRaises(Interrupted):
                    call()
                    self.fail("the call was too short")
            self.assertTrue(np.isnan(out.force[count - 1]).any(), "the query went on")
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)

    def test_results_do_not_depend_on_the_rounding_mode(self):
        mesh, sea = self.reference.mesh("rock"), buoyancy.Sea(**WATERS["waves"])
        poses = self.reference.position, self.reference.quaternion

        def results(mesh, sea):
            return [rows_of(mesh.query(*poses)), rows_of(mesh.query(*poses, sea=sea, tolerance=1e-3)),
                    sea.elevation(0.5, np.arange(9.0), 3.0), mesh.hydrostatics(*poses).stiffness]

        expected = results(mesh, sea)
        math = ctypes.CDLL("libm.so.6")
        before = math.fegetround()
        for mode in (0x400, 0x800, 0xC00):  # of x86
            self.assertEqual(math.fesetround(mode), 0)
            try:
                found = results(self.reference.mesh("rock"), buoyancy.Sea(**WATERS["waves"]))
                self.assertEqual(math.fegetround(), mode)
            finally:
                math.fesetround(before)
            for left, right in zip(found, expected, strict=True):
                self.assert_same_bits(left, right)

    def test_text_has_decimal_points_in_every_locale(self):
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "comma.src")
            source.write_text('LC_NUMERIC\ndecimal_point ","\nthousands_sep "."\ngrouping 3;3\nEND LC_NUMERIC\n')
            subprocess.run(["localedef", "--no-archive", "-c", "-i", source, "-f", "/dev/null", Path(folder, "xx_XX")],
                           stderr=subprocess.DEVNULL)
            program = """
import locale, sys
import numpy as np, buoyancy
sys.path.insert(0, sys.argv[1])
from support import box
locale.setlocale(locale.LC_ALL, "xx_XX")
assert locale.format_string("%.1f", 0.5) == "0,5"
mesh = buoyancy.Mesh(*box(1.5))
assert "3.375 m" in mesh.report, mesh.report
try:
    mesh.query([0, 0, 0], [1, 0, 0, 0], time=1e300)
except ValueError as error:
    assert "1e+300" in str(error), error
try:
    buoyancy.Sea(density=-0.5)
except buoyancy.InputError as error:
    assert "-0.5" in str(error), error
"""
            subprocess.run([sys.executable, "-c", program, Path(__file__).parent], check=True, timeout=TIMEOUT,
                           env={**os.environ, "LOCPATH": folder})

    def expect_in_children(self, expected, calls):
        """Makes each call in a child process of its own. A child that hangs is killed, which its status says."""
        children = []
        for call in calls:
            child = os.fork()
            if child == 0:
                os._exit(0 if np.array_equal(rows_of(call()), expected) else 1)
            children.append(child)
        killer = threading.Timer(TIMEOUT, lambda: [os.kill(child, 9) for child in children])
        killer.start()
        statuses = [os.waitpid(child, 0)[1] for child in children]
        killer.cancel()
        self.assertEqual(statuses, [0] * len(calls))

    def test_forked_children_give_the_same_results(self):
        mesh = self.reference.mesh("rock")
        position, quaternion = (np.tile(array, (20, 1)) for array in (self.reference.position, self.reference.quaternion))
        expected = rows_of(mesh.query(position, quaternion, threads=2))
        self.expect_in_children(expected, [functools.partial(mesh.query, position, quaternion, threads=threads)
                                           for threads in (0, 1, 2, 3)])

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
        try:
            self.expect_in_children(expected, [functools.partial(mesh.query, position, quaternion)] * 10)
        finally:
            stop.set()
            thread.join(TIMEOUT)

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


class NeedsNumpy(TestCase):
    def test_an_import_without_it_names_the_package(self):
        program = "import sys; sys.modules['numpy'] = None; import buoyancy"
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=TIMEOUT)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "(?m)^ImportError: buoyancy needs numpy, .* install the package python3-numpy$")

    def test_only_when_it_is_used(self):
        # buoyancy.testing enters a network of its own before numpy starts threads.
        program = ("import sys, buoyancy.testing; before = 'numpy' in sys.modules\n"
                   "buoyancy.Sea; print(before, 'numpy' in sys.modules)")
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=TIMEOUT)
        self.assertEqual((done.returncode, done.stdout), (0, "False True\n"), done.stderr)


if __name__ == "__main__":
    unittest.main()
