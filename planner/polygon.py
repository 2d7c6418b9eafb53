"""Convex polygons on the ground: soles, their hull, and the nearest point in it."""

import numpy as np
from scipy.spatial import ConvexHull

from planner.orientation import sole_angles, sole_rotation
from planner.types import Array, Footstep


def sole_corners(footstep: Footstep, half_size: Array) -> Array:
    """Corners of a sole seen from above, anticlockwise, shape (4, 2) [m].

    Args:
        footstep: where the sole stands.
        half_size: half of its length and width, shape (2,) [m].
    """
    signs = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    rotation = sole_rotation(footstep.yaw, *sole_angles(footstep.normal, footstep.yaw))
    return np.asarray(footstep.position[:2] + (signs * half_size) @ rotation[:2, :2].T)


def convex_hull(points: Array) -> Array:
    """Vertices of the convex hull, anticlockwise, shape (v, 2).

    Args:
        points: shape (n, 2) [m], at least three that are not on a line.
    """
    return np.asarray(points[ConvexHull(points).vertices])


def signed_distance(polygon: Array, point: Array) -> float:
    """Distance to the nearest edge's line, positive inside [m]; outside it is a lower bound of the true distance."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    offset = point - polygon
    return float(np.min((edge[:, 0] * offset[:, 1] - edge[:, 1] * offset[:, 0]) / np.hypot(edge[:, 0], edge[:, 1])))


def nearest_point(polygon: Array, point: Array) -> Array:
    """The point of a convex anticlockwise polygon nearest to another one, shape (2,) [m]."""
    if signed_distance(polygon, point) >= 0.0:
        return point
    edge = np.roll(polygon, -1, axis=0) - polygon
    along = np.einsum("ij,ij->i", point - polygon, edge) / np.einsum("ij,ij->i", edge, edge)
    candidates = polygon + np.clip(along, 0.0, 1.0)[:, None] * edge
    return np.asarray(candidates[np.argmin(np.sum((candidates - point) ** 2, axis=1))])
