"""Sums masses, centres of mass and inertias of links that are one body."""
from dataclasses import dataclass

import numpy as np

from . import frames


@dataclass
class Mass:
    """Mass [kg], centre of mass [m] and inertia about it [kg m^2], in one frame."""

    mass: float
    center: tuple
    inertia: list
    possible: bool = True  # whether each inertia that is summed is one of a rigid body, or of a rod or a point


def of_link(link, pose, report):
    """The mass of a link's inertial in the frame of the body; `pose` is that of the link in that frame."""
    inertial, inertia = link.inertial, link.inertial.inertia
    low, middle, high = principal_moments(inertia)
    moments = f"the principal moments {low:.4g}, {middle:.4g}, {high:.4g} kg m^2"
    if inertial.mass == 0.0 and any(map(any, inertia)):
        report.warn(
            f"link '{link.name}' has no mass, but {moments}; expected a mass above 0, or no inertia. Its inertia is "
            f"left out: correct the model ({inertial.source})"
        )
        inertia = [[0.0] * 3 for _ in range(3)]
    elif inertial.mass > 0.0 and not is_possible(inertia):
        report.warn(
            f"link '{link.name}': no rigid body has {moments}; expected each above 0 and at most the sum of the "
            f"others. Likely cause: a mistyped number, or another unit. Correct the model ({inertial.source})"
        )
    rotation = frames.product(pose[1], inertial.rotation)
    return Mass(
        inertial.mass,
        frames.transform(pose, inertial.center),
        frames.turned(inertia, rotation),
        inertial.mass == 0.0 or (low >= -1e-9 * high and _obeys_triangle(low, middle, high)),
    )


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
    return Mass(mass, center, inertia, all(m.possible for m in masses) and is_possible(inertia))


def principal_moments(inertia):
    """Eigenvalues of a symmetric 3 x 3 matrix, ascending."""
    return np.linalg.eigvalsh(inertia)


def is_possible(inertia):
    """Whether a rigid body can have this inertia; the limit is that of the scene file."""
    low, middle, high = principal_moments(inertia)
    return low > 1e-9 * high and _obeys_triangle(low, middle, high)


def _obeys_triangle(low, middle, high):
    return high <= low + middle + 0.01 * high
