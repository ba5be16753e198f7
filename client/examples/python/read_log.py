#!/usr/bin/env python3
"""Reads a recorded log into numpy, evaluates its poses again and compares.

    client/examples/python/read_log.py SCENE LOG

LOG: what lcm-logger recorded of a run, or a CSV file of poses (docs/replay.md).
"""
import sys

import numpy as np

import buoyancy


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    scene = buoyancy.Scene(sys.argv[1])
    log = buoyancy.read_log(sys.argv[2])
    for section in log.corrupt_sections:
        print("skipped:", section)
    states, wrenches = log.states, log.wrenches
    print(f"{len(states)} states, {len(wrenches)} wrenches")
    for body in scene.bodies:
        rows = np.flatnonzero(np.asarray(states.body_id) == body.id)
        if rows.size == 0:
            continue
        # Times are those of the messages, so that waves are at the same place.
        result = scene.query(body.id, states.position[rows], states.quaternion[rows],
                             linear_velocity=states.linear_velocity[rows],
                             angular_velocity=states.angular_velocity[rows], time=states.utime[rows] / 1e6)
        force = np.asarray(result.force)
        print(f"body {body.id} ({body.name}): {rows.size} states, largest upward force {force[:, 2].max():.3f} N, "
              f"error at most {np.max(result.force_error_bound):.1e} N")
        recorded = np.asarray(wrenches.force)[np.asarray(wrenches.body_id) == body.id]
        if recorded.shape == force.shape:
            print(f"  differs from the recorded forces by at most {np.abs(recorded - force).max():.1e} N")


if __name__ == "__main__":
    main()
