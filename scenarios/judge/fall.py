"""What a fall is: the one rule that ends a run and that a log is judged by; for one tick or for all of them at once."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

FALLEN_HEIGHT = 0.6
"""Share of the nominal CoM height above the feet below which a robot has fallen."""

FALLEN_TILT = math.radians(60.0)
"""Torso tilt beyond which a robot has fallen [rad]."""

LOST_DISTANCE = 1.0
"""Distance of a pendulum's DCM from its ZMP beyond which no foot could catch it: it has fallen [m]."""


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


def lost(dcm: NDArray[np.float64], zmp: NDArray[np.float64]) -> Any:
    """Whether a pendulum has fallen: its DCM is out of reach of any foot.

    Args:
        dcm: shape (2,) or (n, 2) [m].
        zmp: likewise.

    Returns:
        a truth value, or shape (n,).
    """
    offset = dcm - zmp
    return np.hypot(offset[..., 0], offset[..., 1]) > LOST_DISTANCE
