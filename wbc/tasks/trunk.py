"""Pelvis and torso stay upright and turn with the heading."""

import math

import numpy as np

from surefoot.wbc.model import RobotTerms
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tasks.task import Vector, angular_acceleration
from surefoot.wbc.types import Array, WbcReference


class _Upright:
    """Angular acceleration of a body towards upright at the heading of the reference."""

    size = 3

    def __init__(self, weights: TaskWeights, gains: TaskGains) -> None:
        self.weight = weights.orientation
        self._gains = gains.orientation
        self._desired = np.eye(3)

    def _wanted(self, reference: WbcReference, R: Array, velocity: Array) -> Vector:
        cosine, sine = math.cos(reference.heading), math.sin(reference.heading)
        self._desired[:2, :2] = ((cosine, -sine), (sine, cosine))
        turn = self._gains[1] * reference.heading_rate
        x, y, z = R[2].tolist()
        return angular_acceleration(self._gains, R, velocity, self._desired, (turn * x, turn * y, turn * z))


class Pelvis(_Upright):
    """Angular acceleration of the floating base, which is the pelvis: rows of the identity."""

    name = "pelvis"
    _axes = np.eye(3)

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Vector:
        """See ``Task.write``."""
        np.multiply(self._axes, scale, out=rows[:, 3:6])
        return self._wanted(reference, terms.base_rotation, terms.base_angular_velocity)


class Torso(_Upright):
    """Angular acceleration of the torso."""

    name = "torso"

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Vector:
        """See ``Task.write``."""
        np.multiply(terms.torso_jacobian, scale, out=rows[:, :-12])
        x, y, z = self._wanted(reference, terms.torso_rotation, terms.torso_velocity)
        bx, by, bz = terms.torso_bias.tolist()
        return x - bx, y - by, z - bz
