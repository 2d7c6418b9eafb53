"""Torques of a robot that falls: its joints give way, so that nothing stiff meets the ground.

A whole-body controller that still tries to balance drives joints into their stops and saturates torques on the way
down. Dampers at all joints let gravity fold the legs at rates far below the joints' limits, and take the energy of the
fall out. Soft stops before the ends of the ranges keep joints inside.
"""

import numpy as np

from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.types import Array

DAMPING = 0.05
"""Torque of a damper at 1 rad/s over the largest torque of its joint, of the reference robot [s/rad]."""

STOP, STIFFNESS = 0.15, 2.0
"""Distance from the end of its range at which a joint is turned back, at most a quarter of the range [rad].

The second is the torque that turns it back for each radian, over the joint's largest torque [1/rad].
"""


class GivingWay:
    """Dampers and soft stops at all joints.

    Args:
        limits: of the joints.
        size: of the robot.
    """

    def __init__(self, limits: JointLimits, size: Similarity = REFERENCE_SIZE) -> None:
        before = np.minimum(STOP, 0.25 * (limits.upper - limits.lower))
        self._damping = DAMPING * size.time
        self._most, self._lower, self._upper = limits.torque, limits.lower + before, limits.upper - before

    def torque(self, position: Array, velocity: Array) -> Array:
        """Joint torques within their limits, shape (nj,) [N·m]; of position and velocity, shape (nj,) [rad, rad/s]."""
        inside = np.clip(position, self._lower, self._upper)
        share = STIFFNESS * (inside - position) - self._damping * velocity
        return np.asarray(self._most * np.clip(share, -1.0, 1.0))
