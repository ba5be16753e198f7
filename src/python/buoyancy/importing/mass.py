"""Sums masses, centres of mass and inertias of links that are one body."""
import math
from dataclasses import dataclass

from . import frames


@dataclass
class Mass:
    """Mass [kg], centre of mass [m] and inertia about it [kg m^2], in one frame."""

    mass: float
    center: tuple
    inertia: list


def of_inertial(inertial, pose):
    """The mass of a link's inertial in the frame of the body; `pose` is that of the link in that frame."""
    rotation = frames.product(pose[1], inertial.rotation)
    return Mass(inertial.mass, frames.transform(pose, inertial.center), frames.turned(inertial.inertia, rotation))


def of_solid(solid, density, pose):
    inertia = [[density * value for value in row] for row in solid.inertia]
    return Mass(density * solid.volume, frames.transform(pose, solid.centroid), frames.turned(inertia, pose[1]))


def total(masses):
    """The sum, by the parallel axis theorem; None without mass."""
    mass = sum(m.mass for m in masses)
    if not mass > 0:
        return None
    center = tuple(sum(m.mass * m.center[i] for m in masses) / mass for i in range(3))
    inertia = [[0.0] * 3 for _ in range(3)]
    for m in masses:
        d = frames.subtract(m.center, center)
        square = sum(c * c for c in d)
        for i in range(3):
            for j in range(3):
                inertia[i][j] += m.inertia[i][j] + m.mass * ((square if i == j else 0.0) - d[i] * d[j])
    return Mass(mass, center, inertia)


def principal_moments(inertia):
    """Eigenvalues of a symmetric 3 x 3 matrix, ascending, in closed form."""
    off = inertia[0][1] ** 2 + inertia[0][2] ** 2 + inertia[1][2] ** 2
    mean = sum(inertia[i][i] for i in range(3)) / 3
    spread = math.sqrt((sum((inertia[i][i] - mean) ** 2 for i in range(3)) + 2 * off) / 6)
    if spread == 0:
        return [mean] * 3
    b = [[(inertia[i][j] - (mean if i == j else 0.0)) / spread for j in range(3)] for i in range(3)]
    determinant = (
        b[0][0] * (b[1][1] * b[2][2] - b[1][2] * b[2][1])
        - b[0][1] * (b[1][0] * b[2][2] - b[1][2] * b[2][0])
        + b[0][2] * (b[1][0] * b[2][1] - b[1][1] * b[2][0])
    )
    angle = math.acos(max(-1.0, min(1.0, determinant / 2))) / 3
    largest = mean + 2 * spread * math.cos(angle)
    smallest = mean + 2 * spread * math.cos(angle + 2 * math.pi / 3)
    return [smallest, 3 * mean - largest - smallest, largest]


def is_possible(inertia):
    """Whether a rigid body can have this inertia; the limit is that of the scene file."""
    low, middle, high = principal_moments(inertia)
    return low > 0 and high <= low + middle + 0.01 * high
