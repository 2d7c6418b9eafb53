"""A body as a judge sees it: the roles of its joints, and the definition of a fall."""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.models.types import WITHOUT_ROLL

Array = NDArray[np.float64]


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
    """Return true if no joint rolls the feet, which then stand on side edges (see `surefoot.wbc.body.leaning`)."""
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
    """Return true if a body has fallen: it is low, its torso lies, or more than its feet touches the ground.

    Args:
        height: CoM above the lower sole, a number or shape (n,) [m].
        nominal: height of the CoM above the soles in the gait [m].
        tilt: angle of the torso from the vertical, a number or shape (n,) [rad].
        touching: not zero where something but a foot touches the ground, a number or shape (n,) [N or -].

    Returns:
        a truth value, or shape (n,).
    """
    return (height < FALLEN_HEIGHT * nominal) | (tilt > FALLEN_TILT) | (touching != 0)


def lost(dcm: NDArray[np.float64], zmp: NDArray[np.float64], length: float = 1.0) -> Any:
    """Return true if a pendulum has fallen: its DCM is out of reach of any foot.

    Args:
        dcm: shape (2,) or (n, 2) [m].
        zmp: shape (2,) or (n, 2) [m].
        length: size of the robot (see `surefoot.similarity`) [-].

    Returns:
        a truth value, or shape (n,).
    """
    offset = dcm - zmp
    return np.hypot(offset[..., 0], offset[..., 1]) > LOST_DISTANCE * length
