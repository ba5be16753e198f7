"""Sums masses, centres of mass and inertias of links that are one body."""
from dataclasses import dataclass

import numpy as np

from . import frames


@dataclass
class Mass:
    """Mass [kg], centre of mass [m] and inertia about it [kg m^2], in one frame."""

    mass: float
    center: np.ndarray
    inertia: np.ndarray
    possible: bool = True  # whether each inertia that is summed is one of a rigid body, or of a rod or a point


def of_link(link, pose, report):
    """The mass of a link's inertial in the frame of the body; `pose` is that of the link in that frame."""
    inertial, inertia = link.inertial, link.inertial.inertia
    low, middle, high = moments = np.linalg.eigvalsh(inertia)
    found = f"the principal moments {', '.join(f'{moment:.4g}' for moment in moments)} kg m^2"
    if inertial.mass == 0.0 and inertia.any():
        report.warn(f"link '{link.name}' has no mass, but {found}; expected a mass above 0, or no inertia. Its inertia "
                    "is left out: correct the model", inertial)
        inertia = np.zeros((3, 3))
    elif inertial.mass > 0.0 and not _is_possible(moments):
        report.warn(f"link '{link.name}': no rigid body has {found}; expected each above 0 and at most the sum of the "
                    "others. Likely cause: a mistyped number, or another unit. Correct the model", inertial)
    place = pose @ inertial.pose
    is_flat = low >= -1e-9 * high and _obeys_triangle(low, middle, high)
    return Mass(inertial.mass, place[:3, 3], _turned(inertia, place), inertial.mass == 0.0 or is_flat)


def of_solid(solid, density, pose):
    return Mass(density * solid.volume, frames.transform(pose, solid.centroid), _turned(density * solid.inertia, pose))


def total(masses):
    """The sum, by the parallel axis theorem; None without mass."""
    mass = sum(m.mass for m in masses)
    if not mass > 0:
        return None
    center = sum(m.mass * m.center for m in masses) / mass
    inertia = np.zeros((3, 3))
    for m in masses:
        d = m.center - center
        inertia += m.inertia + m.mass * (d @ d * np.eye(3) - np.outer(d, d))
    return Mass(mass, center, inertia, all(m.possible for m in masses) and _is_possible(np.linalg.eigvalsh(inertia)))


def _turned(inertia, pose):
    return pose[:3, :3] @ inertia @ pose[:3, :3].T


def _is_possible(moments):
    """Whether a rigid body can have these principal moments, in ascending order; the limits are the scene file's."""
    low, middle, high = moments
    return low > 1e-9 * high and _obeys_triangle(low, middle, high)


def _obeys_triangle(low, middle, high):
    return high <= low + middle + 0.01 * high
