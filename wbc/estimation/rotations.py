"""Rotations as matrices: hat, exponential and logarithm; plain floats, which at this size are faster than arrays."""

import math

import numpy as np

from surefoot.wbc.types import Array

_SMALL = 1e-8
"""Angle below which series of second order are exact to rounding [rad]."""


def hat(a: Array) -> Array:
    """The matrix whose product with another vector is the cross product, shape (3, 3)."""
    x, y, z = a.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def exponential(a: Array) -> Array:
    """Rotation of a rotation vector, shape (3, 3); Rodrigues' formula."""
    x, y, z = a.tolist()
    square = x * x + y * y + z * z
    angle = math.sqrt(square)
    if angle < _SMALL:
        s, c = 1.0, 0.5
    else:
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / square
    return np.array(
        [
            [1.0 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y],
            [c * x * y + s * z, 1.0 - c * (x * x + z * z), c * y * z - s * x],
            [c * x * z - s * y, c * y * z + s * x, 1.0 - c * (x * x + y * y)],
        ]
    )


def logarithm(R: Array) -> Array:
    """Rotation vector of a rotation of less than half a turn, shape (3,) [rad]."""
    (a, b, c), (d, e, f), (g, h, i) = R.tolist()
    x, y, z = 0.5 * (h - f), 0.5 * (c - g), 0.5 * (d - b)
    sine, cosine = math.sqrt(x * x + y * y + z * z), 0.5 * (a + e + i - 1.0)
    scale = 1.0 if sine < _SMALL else math.atan2(sine, cosine) / sine
    return np.array([scale * x, scale * y, scale * z])


def from_quaternion(wxyz: tuple[float, float, float, float]) -> Array:
    """Rotation of a unit quaternion w x y z, shape (3, 3)."""
    w, x, y, z = wxyz
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion(R: Array) -> tuple[float, float, float, float]:
    """Unit quaternion x y z w of a rotation; by the largest of its four numbers (Shepperd 1978)."""
    (a, b, c), (d, e, f), (g, h, i) = R.tolist()
    trace = a + e + i
    if trace > 0.0:
        s = 2.0 * math.sqrt(trace + 1.0)
        q = (h - f) / s, (c - g) / s, (d - b) / s, 0.25 * s
    elif a >= e and a >= i:
        s = 2.0 * math.sqrt(1.0 + a - e - i)
        q = 0.25 * s, (b + d) / s, (c + g) / s, (h - f) / s
    elif e >= i:
        s = 2.0 * math.sqrt(1.0 + e - a - i)
        q = (b + d) / s, 0.25 * s, (f + h) / s, (c - g) / s
    else:
        s = 2.0 * math.sqrt(1.0 + i - a - e)
        q = (c + g) / s, (f + h) / s, 0.25 * s, (d - b) / s
    n = math.sqrt(sum(x * x for x in q))
    return q[0] / n, q[1] / n, q[2] / n, q[3] / n
