#!/usr/bin/env python3
"""Times of queries from Python beside those in C++, as a Markdown table. scripts/measure python runs it.

    bench/query_speed.py QUERY_SPEED DIRECTORY

Both programs take turns, since the speed of a machine changes within seconds; the medians of their best times count.
"""
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import buoyancy

ROUNDS, RUNS, SINGLE, POSES = 7, 15, 1000, 10_000


def torus(around, across):
    """Vertices and faces of a torus with its axis along z."""
    a, b = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    u, v = 2 * np.pi * a / around, 2 * np.pi * b / across
    radius = 1 + 0.4 * np.cos(v)
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), 0.4 * np.sin(v)], axis=-1).reshape(-1, 3)

    def index(i, j):
        return (i % around) * across + j % across

    corners = [index(a, b), index(a + 1, b), index(a + 1, b + 1), index(a, b + 1)]
    faces = np.stack([corners[0], corners[1], corners[2], corners[0], corners[2], corners[3]], axis=-1)
    return vertices, faces.reshape(-1, 3).astype(np.int64)


def best_time(task, clock=time.thread_time_ns):
    """Nanoseconds of the quickest of several runs: of this thread's processor time, unless the clock is another."""
    times = []
    for _ in range(RUNS):
        start = clock()
        task()
        times.append(clock() - start)
    return min(times)


def measure(program, folder, mesh, position, quaternion):
    """Median times [ns] by program: a pose per call, all poses on one thread, all poses on all threads."""
    rows = {"C++": [], "Python": []}
    one_by_one = [(position[i].copy(), quaternion[i].copy()) for i in range(SINGLE)]

    def single():
        for p, q in one_by_one:
            mesh.query(p, q)

    result = mesh.query(position, quaternion)
    for _ in range(ROUNDS):
        *times, total = map(float, subprocess.run([program, folder], check=True, capture_output=True, text=True).stdout.split())
        if total != sum(result.force[:, 2].tolist()):
            sys.exit("query_speed.py: the results of Python and C++ differ")
        rows["C++"].append(times)
        rows["Python"].append([best_time(single) / SINGLE,
                               best_time(lambda: mesh.query(position, quaternion, threads=1)),
                               best_time(lambda: mesh.query(position, quaternion), time.perf_counter_ns)])
    return {name: np.array([statistics.median(column) for column in zip(*times)]) for name, times in rows.items()}


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    random = np.random.default_rng(1)
    position = random.uniform(-0.5, 0.5, (POSES, 3))
    quaternion = random.normal(size=(POSES, 4))
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    np.hstack([position, quaternion]).tofile(folder / "poses.f64")
    print(f"`./scripts/measure python`, medians of {ROUNDS} interleaved runs, {POSES:,} poses of a torus; processor time on one "
          "thread, wall-clock time on all.\n")
    print("| triangles | one pose per call: C++, Python | more | 10,000 poses on one thread: C++, Python | ratio | on all "
          "threads: C++, Python |")
    print("|---|---|---|---|---|---|")
    for around, across in ((12, 8), (150, 100)):
        vertices, faces = torus(around, across)
        vertices.tofile(folder / "vertices.f64")
        faces.tofile(folder / "faces.i64")
        times = measure(program, folder, buoyancy.Mesh(vertices, faces), position, quaternion)
        cpp, python = times["C++"], times["Python"]
        print(f"| {len(faces):,} | {cpp[0] / 1e3:.2f}, {python[0] / 1e3:.2f} µs | {(python[0] - cpp[0]) / 1e3:.2f} µs | "
              f"{cpp[1] / 1e6:.2f}, {python[1] / 1e6:.2f} ms | {python[1] / cpp[1]:.3f} | "
              f"{cpp[2] / 1e6:.2f}, {python[2] / 1e6:.2f} ms |")


if __name__ == "__main__":
    main()
