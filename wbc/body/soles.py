"""Soles turned level, and where they point: the feet that a planner, to which they are flat, is given."""

import math

import numpy as np

from surefoot.wbc.types import Array


def level(position: Array, rotation: Array, toe: float, heel: float, normal: Array) -> Array:
    """Centres of the soles if each foot turned flat on the ground about an edge of it, shape (2, 3) [m].

    Args:
        position: of the soles' centres in the world, shape (2, 3) [m].
        rotation: of the soles in the world, shape (2, 3, 3).
        toe: line about which a foot turns whose heel is up, ahead of the sole's centre [m].
        heel: that about which one turns whose toes are up [m].
        normal: of the ground under each of them, shape (2, 3) [-].
    """
    found = np.empty((2, 3))
    for k in range(2):
        x, y, z = rotation[k, 0, 0], rotation[k, 1, 0], rotation[k, 2, 0]
        up = x * normal[k, 0] + y * normal[k, 1] + z * normal[k, 2]
        edge = heel if up > 0.0 else toe
        u, v, w = x - up * normal[k, 0], y - up * normal[k, 1], z - up * normal[k, 2]
        # A foot on its toes points nowhere.
        flat = 1.0 / max(math.hypot(math.hypot(u, v), w), 1e-9)
        found[k, 0] = position[k, 0] + edge * (x - u * flat)
        found[k, 1] = position[k, 1] + edge * (y - v * flat)
        found[k, 2] = position[k, 2] + edge * (z - w * flat)
    return np.asarray(found)


def yaws(rotation: Array) -> Array:
    """Angles about the world's vertical of the soles' long axes, shape (2,) [rad]; rotations of shape (2, 3, 3)."""
    return np.array([math.atan2(rotation[k, 1, 0], rotation[k, 0, 0]) for k in range(2)])
