"""The swing foot follows its curve."""

import numpy as np

from surefoot.wbc.model import RobotTerms
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tasks.task import angular_acceleration
from surefoot.wbc.types import Array, WbcReference


class SwingFoot:
    """Acceleration of the swing foot's sole, linear then angular, in the sole's frame; absent when both feet stand.

    A foot that leaves the ground rolling is seen from its toe edge (see ``RobotTerms.shift_foot``).
    """

    name, size = "swing foot", 6

    def __init__(self, weights: TaskWeights, gains: TaskGains, toe: float, length: float) -> None:
        """``toe``: toe edge from the sole's centre [m]; ``length``: size of the robot, by which rotations count [-]."""
        self.weight = weights.swing * np.repeat([1.0, length**2], 3)
        self._gains, self._toe = gains.swing, toe

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> tuple[float, ...]:
        """See ``Task.write``."""
        k = reference.swing_foot
        if k < 0:
            rows[:] = 0.0
            return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        np.multiply(terms.sole_jacobian[k], scale, out=rows[:, :-12])
        damping, R, velocity = self._gains[1], terms.contact_rotation[k], terms.sole_velocity[k]
        x, y, z = (self._linear(terms, reference, k) @ R).tolist()
        turning = reference.swing_angular_acceleration + damping * reference.swing_angular_velocity
        ahead = tuple((turning @ R).tolist())
        ax, ay, az = angular_acceleration(self._gains, R, velocity[3:], reference.swing_rotation, ahead)
        pitching = damping * reference.roll[1] + reference.roll[2] if k == reference.rolling_foot else 0.0
        vx, vy, vz = velocity[:3].tolist()
        bx, by, bz, px, py, pz = terms.sole_bias[k].tolist()
        linear = (x - damping * vx - bx, y - damping * vy - by, z - damping * vz - bz)
        return (*linear, ax - px, ay + pitching - py, az - pz)

    def _linear(self, terms: RobotTerms, reference: WbcReference, k: int) -> Array:
        """Linear acceleration in the world, but for the damping of the sole's own velocity, shape (3,) [m/s^2]."""
        stiffness, damping = self._gains
        wanted: Array = reference.swing_position - terms.contact_position[k]
        if k == reference.rolling_foot:
            wanted += self._toe * reference.swing_rotation[:, 0]
        wanted *= stiffness
        wanted += damping * reference.swing_velocity
        wanted += reference.swing_acceleration
        return wanted
