"""Values that cross the planner's boundary. World frame, SI units; arrays are float64."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GRAVITY = 9.81
"""Gravitational acceleration [m/s^2], the value of the simulated world."""


class Foot(IntEnum):
    """Which foot; the value indexes every (2, ...) array of feet."""

    LEFT = 0
    RIGHT = 1

    @property
    def other(self) -> "Foot":
        """The opposite foot."""
        return Foot(1 - self)


class PhaseKind(IntEnum):
    """Support phase."""

    STAND = 0
    DOUBLE = 1
    SINGLE = 2


@dataclass(frozen=True, slots=True)
class Footstep:
    """A foothold.

    Attributes:
        foot: the foot that stands here.
        position: sole centre in the world frame, shape (3,) [m].
        yaw: heading of the sole about the world's z axis [rad].
    """

    foot: Foot
    position: Array
    yaw: float


@dataclass(frozen=True, slots=True)
class CentroidalState:
    """What the planner is told of the body at one instant.

    Attributes:
        time: instant [s].
        com: CoM position, shape (3,) [m].
        com_velocity: CoM velocity, shape (3,) [m/s].
    """

    time: float
    com: Array
    com_velocity: Array


@dataclass(frozen=True, slots=True)
class FeetState:
    """What the planner is told of the feet at one instant.

    Attributes:
        position: sole centres in the world frame, shape (2, 3) [m], left first.
        yaw: sole headings, shape (2,) [rad].
        contact: which feet feel the ground, (left, right).
    """

    position: Array
    yaw: Array
    contact: tuple[bool, bool]
