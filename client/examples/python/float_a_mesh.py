#!/usr/bin/env python3
"""Floats a mesh: finds by bisection the height at which it displaces its own mass. Run it in the project's folder."""
import buoyancy

hull = buoyancy.Mesh("scenes/meshes/catamaran.obj")
mass = 300.0 * hull.volume  # kg, of a body of 300 kg/m³ on average
low, high = -1.0, 1.0       # m, of the mesh's origin above the water: too deep, too high
for _ in range(60):
    z = (low + high) / 2
    wrench = hull.query(position=(0, 0, z), quaternion=(1, 0, 0, 0))
    low, high = (z, high) if wrench.force[2] > mass * 9.80665 else (low, z)
print(f"{mass:.1f} kg float at z = {z:.4f} m and displace {wrench.volume:.4f} m³")
