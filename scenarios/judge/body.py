"""What a body is to a judge: where its soles are, what its joints are for, and what a fall is."""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.models.types import WITHOUT_ROLL
from surefoot.planner.geometry import CORNERS

Array = NDArray[np.float64]


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
    local = np.column_stack((0.5 * CORNERS * (length, width), np.zeros(4)))
    return np.asarray(poses[:, None, :3] + np.einsum("nij,kj->nki", rotations(poses[:, 3:]), local))


def level_corners(places: Array, length: float, width: float) -> Array:
    """Corners of level soles seen from above, in order, shape (n, 4, 2) [m].

    Args:
        places: x y and a heading last, what is between does not matter, shape (n, 3 or more) [m, rad].
        length: of a sole [m].
        width: of a sole [m].
    """
    local = 0.5 * CORNERS * (length, width)
    cosine, sine = np.cos(places[:, -1, None]), np.sin(places[:, -1, None])
    x = places[:, 0, None] + cosine * local[:, 0] - sine * local[:, 1]
    y = places[:, 1, None] + sine * local[:, 0] + cosine * local[:, 1]
    return np.stack((x, y), axis=2)


Roles = Mapping[str, Sequence[str]]
"""Names of joints or bodies by role: knees, left_leg, right_leg, torso."""

_LEG = re.compile(r"hip|knee|ankle|leg")


def knees(names: Sequence[str], roles: Roles) -> list[int]:
    """Indices of the knees among the joints."""
    found = roles.get("knees")
    return [i for i, name in enumerate(names) if ("knee" in name if found is None else name in found)]


def leg(names: Sequence[str], roles: Roles, side: str) -> list[int]:
    """Indices of the joints of the ``left`` or ``right`` leg."""
    found = roles.get(f"{side}_leg")
    if found is None:
        return [i for i, name in enumerate(names) if side_of(name) == side and _LEG.search(name)]
    return [i for i, name in enumerate(names) if name in found]


def side_of(name: str) -> str:
    """The side that a joint's name tells: left, right or none."""
    return next((side for side in ("left", "right") if side in name), "")


def feet_lean(roles: Roles) -> bool:
    """Whether no joint rolls the feet, which then stand on side edges (see `surefoot.wbc.leaning`)."""
    return len(roles.get("left_leg", ())) == WITHOUT_ROLL


def torso(roles: Roles) -> str:
    """Name of the torso's body."""
    return next(iter(roles.get("torso", ())), "torso")


FALLEN_HEIGHT = 0.6
"""Share of the nominal CoM height above the feet below which a robot has fallen."""

FALLEN_TILT = math.radians(60.0)
"""Torso tilt beyond which a robot has fallen [rad]."""

LOST_DISTANCE = 1.0
"""Distance of a pendulum's DCM from its ZMP beyond which no foot could catch it, for the reference robot: it has
fallen [m]."""


def lies(height: Any, nominal: float, tilt: Any, touching: Any) -> Any:
    """Whether a body has fallen: it is low, its torso lies, or more than its feet touches the ground.

    Args:
        height: CoM above the lower sole, a number or shape (n,) [m].
        nominal: height of the CoM above the soles in the gait [m].
        tilt: angle of the torso from the vertical, likewise [rad].
        touching: not zero where something but a foot touches the ground, likewise.

    Returns:
        a truth value, or shape (n,).
    """
    return (height < FALLEN_HEIGHT * nominal) | (tilt > FALLEN_TILT) | (touching != 0)


def lost(dcm: NDArray[np.float64], zmp: NDArray[np.float64], length: float = 1.0) -> Any:
    """Whether a pendulum has fallen: its DCM is out of reach of any foot.

    Args:
        dcm: shape (2,) or (n, 2) [m].
        zmp: likewise.
        length: size of the robot (see `surefoot.similarity`) [-].

    Returns:
        a truth value, or shape (n,).
    """
    offset = dcm - zmp
    return np.hypot(offset[..., 0], offset[..., 1]) > LOST_DISTANCE * length
