"""Poses (position, quaternion w x y z), rotations and 6 x 6 matrices, as tuples and lists of numbers.

A pose X_AB has the position of B's origin in A, and the rotation from B's axes to A's. compose(X_AB, X_BC) is X_AC.
"""
import math

IDENTITY = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
# Forward, left, up to forward, right, down, as signs of the six axes; it is its own inverse.
REVERSED_Y_Z = (1.0, -1.0, -1.0, 1.0, -1.0, -1.0)


def normalized(q):
    length = math.sqrt(sum(c * c for c in q))
    return tuple(c / length for c in q) if length > 0.0 else None


def product(a, b):
    w, x, y, z = a
    s, u, v, t = b
    return (
        w * s - x * u - y * v - z * t,
        w * u + x * s + y * t - z * v,
        w * v - x * t + y * s + z * u,
        w * t + x * v - y * u + z * s,
    )


def from_rpy(roll, pitch, yaw):
    """Roll, pitch and yaw [rad] about the fixed axes x, y, z, in this order (SDF, URDF)."""
    return product(about((0, 0, 1), yaw), product(about((0, 1, 0), pitch), about((1, 0, 0), roll)))


def about(axis, angle):
    """The rotation by `angle` [rad] about `axis`, of any length but 0."""
    unit = normalized((0.0, *axis)) or (0.0, 0.0, 0.0, 0.0)
    return (math.cos(angle / 2), *(c * math.sin(angle / 2) for c in unit[1:]))


def from_columns(x, y, z):
    """The quaternion of the rotation matrix with these columns."""
    candidates = (1 + x[0] + y[1] + z[2], 1 + x[0] - y[1] - z[2], 1 - x[0] + y[1] - z[2], 1 - x[0] - y[1] + z[2])
    largest = candidates.index(max(candidates))
    rows = (
        (candidates[0], y[2] - z[1], z[0] - x[2], x[1] - y[0]),
        (y[2] - z[1], candidates[1], x[1] + y[0], z[0] + x[2]),
        (z[0] - x[2], x[1] + y[0], candidates[2], y[2] + z[1]),
        (x[1] - y[0], z[0] + x[2], y[2] + z[1], candidates[3]),
    )
    return normalized(rows[largest])


def turning_z_to(direction):
    """The smallest rotation that turns the axis z to `direction`."""
    x, y, z = normalized((0.0, *direction))[1:]
    if z < -1 + 1e-12:
        return (0.0, 1.0, 0.0, 0.0)
    return normalized((1 + z, -y, x, 0.0))


def matrix(q):
    """Rows of the rotation matrix."""
    w, x, y, z = q
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def rotate(q, v):
    return tuple(sum(row[i] * v[i] for i in range(3)) for row in matrix(q))


def conjugate(q):
    return (q[0], -q[1], -q[2], -q[3])


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def compose(a, b):
    return (add(a[0], rotate(a[1], b[0])), normalized(product(a[1], b[1])))


def inverse(a):
    q = conjugate(a[1])
    return (tuple(-c for c in rotate(q, a[0])), q)


def transform(a, point):
    return add(a[0], rotate(a[1], point))


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(len(b))) for j in range(len(b[0]))] for i in range(len(a))]


def transpose(a):
    return [list(column) for column in zip(*a)]


def turned(inertia, q):
    """R I Rᵀ of a 3 x 3 matrix."""
    rotation = matrix(q)
    return multiply(multiply(rotation, inertia), transpose(rotation))


def zeros():
    return [[0.0] * 6 for _ in range(6)]


def diagonal(numbers):
    return [[numbers[i] if i == j else 0.0 for j in range(6)] for i in range(6)]


def turned_6(k, q):
    """A matrix from twists to wrenches, with both turned from axes B to A by the rotation q_AB."""
    rotation = matrix(q)
    blocks = [[rotation[i % 3][j % 3] if i // 3 == j // 3 else 0.0 for j in range(6)] for i in range(6)]
    return multiply(multiply(blocks, k), transpose(blocks))


def moved_6(k, offset):
    """A matrix from twists to wrenches about another point: offset [m] is the old point seen from the new one."""
    x, y, z = offset
    lever = diagonal([1.0] * 6)
    for i, row in enumerate(((0, -z, y), (z, 0, -x), (-y, x, 0))):
        lever[3 + i][:3] = row
    return multiply(multiply(lever, k), transpose(lever))


def is_right_angled(q):
    """Whether the rotation only exchanges and reverses axes."""
    return all(min(abs(c), abs(abs(c) - 1)) < 1e-9 for row in matrix(q) for c in row)
