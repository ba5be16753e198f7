"""Poses, rotations and 6 x 6 matrices as arrays of numpy.

A pose X_AB is a 4 x 4 matrix: the rotation from B's axes to A's, and the position of B's origin in A. X_AB @ X_BC is
X_AC.
"""
import numpy as np

IDENTITY = np.eye(4)
# Forward, left, up to forward, right, down, as signs of the six axes; it is its own inverse.
REVERSED_Y_Z = np.array((1.0, -1.0, -1.0, 1.0, -1.0, -1.0))


def pose(position=(0.0, 0.0, 0.0), rotation=IDENTITY[:3, :3]):
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation, position
    return result


def inverse(a):
    return pose(-a[:3, :3].T @ a[:3, 3], a[:3, :3].T)


def transform(a, point):
    return a[:3, :3] @ point + a[:3, 3]


def from_quaternion(numbers):
    """The rotation matrix of a quaternion w, x, y, z of any length but 0, for which it is None."""
    length = np.linalg.norm(numbers)
    if not length > 0.0:
        return None
    w, x, y, z = np.array(numbers) / length
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )


def quaternion(r):
    """The quaternion w, x, y, z of a rotation matrix, with w of at least 0."""
    # The largest of the four is the root of a sum, and the others follow from it without loss of digits.
    squares = 1 + np.array((r[0, 0] + r[1, 1] + r[2, 2], *(2 * r[i, i] - np.trace(r) for i in range(3))))
    w = np.array((r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]))
    rows = np.diag(squares)
    rows[0, 1:] = rows[1:, 0] = w
    for i, j in ((0, 1), (0, 2), (1, 2)):
        rows[1 + i, 1 + j] = rows[1 + j, 1 + i] = r[i, j] + r[j, i]
    row = rows[np.argmax(squares)]
    return (-row if row[0] < 0 else row) / np.linalg.norm(row)


def about(axis, angle):
    """The rotation by `angle` [rad] about `axis`, of any length but 0, for which it is None."""
    return from_quaternion((np.cos(angle / 2) * np.linalg.norm(axis), *(np.sin(angle / 2) * np.array(axis))))


def from_rpy(roll, pitch, yaw):
    """Roll, pitch and yaw [rad] about the fixed axes x, y, z, in this order (SDF, URDF)."""
    return about((0, 0, 1), yaw) @ about((0, 1, 0), pitch) @ about((1, 0, 0), roll)


def turning_z_to(direction):
    """The smallest rotation that turns the axis z to a direction of any length but 0, for which it is None."""
    (x, y, z), length = direction, np.linalg.norm(direction)
    return from_quaternion((length + z, -y, x, 0.0) if z > (1e-12 - 1) * length else (0.0, length, 0.0, 0.0))


def turned_6(k, rotation):
    """A matrix from twists to wrenches, with both turned from axes B to A by the rotation R_AB."""
    blocks = np.kron(np.eye(2), rotation)
    return blocks @ k @ blocks.T


def moved_6(k, offset):
    """A matrix from twists to wrenches about another point: offset [m] is the old point seen from the new one."""
    x, y, z = offset
    lever = np.eye(6)
    lever[3:, :3] = ((0, -z, y), (z, 0, -x), (-y, x, 0))
    return lever @ k @ lever.T
