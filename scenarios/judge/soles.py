"""Soles by their poses: axes, headings and corners, for many at once."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SIGNS = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
"""Of the corners along and across a sole, in order around it."""


def rotations(quaternions: Array) -> Array:
    """Rotation matrices of quaternions x y z w, shape (n, 3, 3)."""
    x, y, z, w = quaternions.T
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.moveaxis(np.array(rows), -1, 0)


def forward(quaternions: Array) -> Array:
    """Forward axes x y seen from above, of quaternions x y z w of shape (..., 4), shape (..., 2)."""
    x, y, z, w = np.moveaxis(quaternions, -1, 0)
    return np.stack((1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)), axis=-1)


def headings(quaternions: Array) -> Array:
    """Headings of quaternions x y z w of shape (..., 4), shape (...) [rad]."""
    axis = forward(quaternions)
    return np.asarray(np.arctan2(axis[..., 1], axis[..., 0]))


def corners(poses: Array, length: float, width: float) -> Array:
    """Corners of soles of any orientation, in order, shape (n, 4, 3) [m].

    Args:
        poses: x y z qx qy qz qw, shape (n, 7).
        length: of a sole [m].
        width: of a sole [m].
    """
    local = np.column_stack((0.5 * _SIGNS * (length, width), np.zeros(4)))
    return np.asarray(poses[:, None, :3] + np.einsum("nij,kj->nki", rotations(poses[:, 3:]), local))


def level_corners(places: Array, length: float, width: float) -> Array:
    """Corners of level soles seen from above, in order, shape (n, 4, 2) [m].

    Args:
        places: x y and a heading last, what is between does not matter, shape (n, 3 or more) [m, rad].
        length: of a sole [m].
        width: of a sole [m].
    """
    local = 0.5 * _SIGNS * (length, width)
    cosine, sine = np.cos(places[:, -1, None]), np.sin(places[:, -1, None])
    x = places[:, 0, None] + cosine * local[:, 0] - sine * local[:, 1]
    y = places[:, 1, None] + sine * local[:, 0] + cosine * local[:, 1]
    return np.stack((x, y), axis=2)
