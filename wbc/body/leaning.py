"""Feet that lean sideways with their shanks: legs without a joint that rolls the foot, which stands on a side edge.

Such a leg has five joints. Its sole moves in five directions at will; how it rolls about its long axis follows from
where the hip is. So it touches the ground along one of its long edges, a line about which it is free to turn. It is
seen from a frame on that line, turned back to level. There the moment about the line is zero, and five of the six
motions are the leg's. It is the outer edge, since the body comes over a foot from the inner side, but for a leg that
leans far the other way.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from surefoot.wbc.types import Array

if TYPE_CHECKING:
    import pinocchio as pin

INWARD, OVER = 0.1, 0.02
"""Angle by which a foot leans inward when it stands on its inner edge, and within which around it the line goes over
from one edge to the other [rad]."""

FREE = 3
"""Row of a sole's motion, and of its wrench, that belongs to the line."""

_OUTWARD = (1.0, -1.0)


def line_frame(foot: int, rotation: Array, half_width: float) -> "pin.SE3":
    """Frame of the line on which a leaning sole stands, as seen from the sole's: x along the line, y level.

    Args:
        foot: 0 the left one, 1 the right one.
        rotation: of the sole in the world, shape (3, 3).
        half_width: of the sole [m].
    """
    import pinocchio as pin  # a verdict needs the line's centre alone

    lean, beside = _line(foot, rotation, half_width)
    return pin.SE3(pin.utils.rotate("x", -lean), np.array([0.0, beside, 0.0]))


def line_centre(foot: int, position: Array, rotation: Array, half_width: float) -> Array:
    """Centre of the line in the world, shape (3,) [m]; position, shape (3,) [m], and rotation are those of the sole."""
    _, beside = _line(foot, rotation, half_width)
    return np.asarray(position + rotation @ np.array([0.0, beside, 0.0]))


def _line(foot: int, rotation: Array, half_width: float) -> tuple[float, float]:
    """Angle by which a sole leans [rad], and how far beside its centre the line is, left positive [m]."""
    lean, outward = math.atan2(rotation[2, 1], rotation[2, 2]), _OUTWARD[foot]
    share = min(max((INWARD - outward * lean) / OVER, -1.0), 1.0)
    return lean, outward * share * half_width
