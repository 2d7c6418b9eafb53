"""Planar frames and angles."""

import math

import numpy as np

from planner.types import Array


def frame_rotation(yaw: float) -> Array:
    """Rotation from a frame of that heading to the world, shape (2, 2)."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s], [s, c]])


def wrap_angle(angle: float) -> float:
    """The same angle in [-pi, pi) [rad]."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi
