#!/usr/bin/env python3
"""Draws the curve of righting arms, GZ over heel, of a mesh that floats at its displacement.

    client/examples/python/righting_arm.py [MESH [DENSITY]] [--plot FILE.png]

All heels are evaluated in one call per step of the search for the draft: arrays of poses are much faster than a loop.
The plot needs matplotlib (python3-matplotlib); the table does not.
"""
import argparse

import numpy as np

import buoyancy

GRAVITY = 9.80665


def about_x(angle):
    """Quaternions (w, x, y, z) of rotations about the x axis."""
    zero = np.zeros_like(angle)
    return np.stack([np.cos(angle / 2), np.sin(angle / 2), zero, zero], axis=-1)


def righting_arms(mesh, density, heel):
    """GZ in metres for each heel in radians, about the centre of mass of a uniform body."""
    mass = density * mesh.volume
    center = np.asarray(mesh.center_of_mass)
    quaternion = about_x(heel)
    # The centre of mass in the world, relative to the mesh's origin.
    y = np.cos(heel) * center[1] - np.sin(heel) * center[2]
    reach = np.linalg.norm(np.subtract(*mesh.bounding_box)) + np.linalg.norm(center)
    low, high = np.full(heel.shape, -reach), np.full(heel.shape, reach)
    position = np.zeros(heel.shape + (3,))
    result = None
    for _ in range(60):  # bisection of all drafts at once
        position[:, 2] = (low + high) / 2
        result = mesh.query(position, quaternion, out=result)
        too_deep = np.asarray(result.force)[:, 2] > mass * GRAVITY
        low, high = np.where(too_deep, position[:, 2], low), np.where(too_deep, high, position[:, 2])
    result.raise_for_status()
    # Positive where the buoyancy turns the body back: the moment about x opposes the heel.
    arm = np.asarray(result.center_of_buoyancy)[:, 1] - y
    return -arm * np.sign(np.where(heel == 0, 1, heel))


def main():
    parser = argparse.ArgumentParser(description="Draw the righting arms of a floating mesh.")
    parser.add_argument("mesh", nargs="?", default="scenes/meshes/catamaran.obj")
    parser.add_argument("density", nargs="?", type=float, default=300.0, help="average, kg/m^3 (default: %(default)s)")
    parser.add_argument("--plot", metavar="FILE", help="also draw a picture; needs matplotlib")
    arguments = parser.parse_args()

    mesh = buoyancy.Mesh(arguments.mesh)
    degrees = np.arange(0.0, 91.0, 5.0)
    arms = righting_arms(mesh, arguments.density, np.radians(degrees))
    print("heel (degrees)  GZ (m)")
    for angle, arm in zip(degrees, arms):
        print(f"{angle:14.0f}  {arm:.6f}")
    if arguments.plot is None:
        return
    try:
        import matplotlib
    except ImportError:
        print("no picture: matplotlib is not installed (apt-get install python3-matplotlib)")
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot
    pyplot.plot(degrees, arms)
    pyplot.xlabel("heel (degrees)")
    pyplot.ylabel("GZ (m)")
    pyplot.grid()
    pyplot.savefig(arguments.plot)


if __name__ == "__main__":
    main()
