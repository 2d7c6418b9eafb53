"""The state of the invariant filter, what is where in its error, and how an error moves it."""

from typing import Any

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.wbc.types import Array

TURN_AT, VELOCITY_AT, POSITION_AT, FOOT_AT, SOLE_AT, GYRO_AT, FORCE_AT, OFFSETS_AT = 0, 3, 6, 9, 15, 21, 24, 27
"""Indices at which each part of the error begins: R, v, p, d, Z, biases of gyroscope and accelerometer, offsets.

Feet and soles are the left one, then the right one; all but the offsets are of three numbers each.
"""

TURN, VELOCITY, POSITION = (slice(at, at + 3) for at in (TURN_AT, VELOCITY_AT, POSITION_AT))
FOOT, SOLE = (tuple(slice(at + 3 * k, at + 3 * k + 3) for k in (0, 1)) for at in (FOOT_AT, SOLE_AT))
GYRO, FORCE, OFFSETS = slice(GYRO_AT, FORCE_AT), slice(FORCE_AT, OFFSETS_AT), slice(OFFSETS_AT, None)

AXES = 3
"""Offsets that are of the mount, the last ones: how the IMU is turned about its axes from where it should be."""


class Stand:
    """The places of IMU and soles as the filter believes them, in arrays that stay where they are.

    Attributes:
        R: orientation of the IMU in the world, shape (3, 3).
        columns: velocity and position of the IMU, left and right sole centre, world axes, shape (4, 3) [m/s, m].
        Z: orientations of the soles, shape (2, 3, 3).
        gyro_bias: shape (3,) [rad/s].
        force_bias: of the accelerometer, shape (3,) [m/s^2].
        offsets: of the encoders of the chain, then of the mount about the axes of the IMU, shape (m + 3,) [rad].
    """

    def __init__(self, R: Array, columns: Array, Z: Array, gyro_bias: Array, force_bias: Array, offsets: Array) -> None:
        self.R, self.columns, self.Z = R, columns, Z
        self.gyro_bias, self.force_bias, self.offsets = gyro_bias, force_bias, offsets
        self._R, self._columns, self._Z = R, columns, Z
        self._gyro_bias, self._force_bias, self._offsets = gyro_bias, force_bias, offsets
        self._E, self._moved = np.zeros((3, 3)), np.zeros((3, 3))

    def __reduce__(self) -> tuple[Any, ...]:
        return Stand, (self.R, self.columns, self.Z, self.gyro_bias, self.force_bias, self.offsets)

    @property
    def v(self) -> Array:
        """Velocity of the IMU, shape (3,) [m/s]."""
        velocity: Array = self.columns[0]
        return velocity

    @property
    def p(self) -> Array:
        """Position of the IMU, shape (3,) [m]."""
        position: Array = self.columns[1]
        return position

    @property
    def d(self) -> Array:
        """Sole centres, shape (2, 3) [m]."""
        return self.columns[2:]

    @property
    def mounting(self) -> Array:
        """Offsets of the mount, shape (3,) [rad]."""
        return self.offsets[-AXES:]

    def move(self, x: Array) -> None:
        """Apply exp(x) from the left; of the group's V-matrix the identity is taken, for small x.

        Args:
            x: an error, shape (27 + m + 3,).
        """
        self._turn(algebra.vector(x), self._R)
        for i in range(4):
            at = algebra.rotate(self._E, algebra.row(self._columns, i))
            algebra.put_row(self._columns, i, algebra.add(at, algebra.vector(x[VELOCITY_AT + 3 * i :])))
        for k in range(2):
            self._turn(algebra.vector(x[SOLE_AT + 3 * k :]), self._Z[k])
        for i in range(3):
            self._gyro_bias[i] += x[GYRO_AT + i]
            self._force_bias[i] += x[FORCE_AT + i]
        for i in range(len(self._offsets)):
            self._offsets[i] += x[OFFSETS_AT + i]

    def give(self, k: int, way: Array) -> algebra.Vector:
        """Move a sole on the springs of the ground; returns how it has turned about world axes [rad].

        Args:
            k: foot.
            way: roll and pitch in its own axes, and how far it rises, shape (3,) [rad, rad, m].
        """
        Z = self._Z[k]
        turned = algebra.rotate(Z, (way[0], way[1], 0.0))
        self._columns[2 + k, 2] += way[2]
        self._turn(turned, Z)
        return turned

    def _turn(self, turned: algebra.Vector, R: Array) -> None:
        """Turn a rotation, shape (3, 3), about world axes; `_E` is left as the turn."""
        algebra.rotation_of(turned, self._E)
        algebra.compose(self._E, R, self._moved)
        linear.copy(self._moved, R)
