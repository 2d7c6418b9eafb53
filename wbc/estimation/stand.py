"""The state of the invariant filter, and what is where in its error."""

from dataclasses import dataclass

import pinocchio as pin

from surefoot.wbc.types import Array

TURN, VELOCITY, POSITION = slice(0, 3), slice(3, 6), slice(6, 9)
FOOT, SOLE = (slice(9, 12), slice(12, 15)), (slice(15, 18), slice(18, 21))
GYRO, FORCE, OFFSETS = slice(21, 24), slice(24, 27), slice(27, None)
"""Places in the error: R, v, p, d, Z, biases of gyroscope and accelerometer, offsets of encoders and mount."""

AXES = 3
"""Offsets that are of the mount, the last ones: how the IMU is turned about its axes from where it should be."""


@dataclass(slots=True)
class Stand:
    """Where the filter believes that the IMU and the soles are, in arrays that stay where they are.

    Attributes:
        R: orientation of the IMU in the world, shape (3, 3).
        columns: velocity and position of the IMU, left and right sole centre, world axes, shape (4, 3) [m/s, m].
        Z: orientations of the soles, shape (2, 3, 3).
        gyro_bias: shape (3,) [rad/s].
        force_bias: of the accelerometer, shape (3,) [m/s^2].
        offsets: of the encoders of the chain, then of the mount about the axes of the IMU, shape (m + 3,) [rad].
    """

    R: Array
    columns: Array
    Z: Array
    gyro_bias: Array
    force_bias: Array
    offsets: Array

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
        """Apply exp(x) from the left; of the group's V-matrix the identity is taken, for small x."""
        E = pin.exp3(x[TURN])
        self.R[:] = E @ self.R
        self.columns[:] = self.columns @ E.T + x[3:15].reshape(4, 3)
        for k in (0, 1):
            self.Z[k] = pin.exp3(x[SOLE[k]]) @ self.Z[k]
        self.gyro_bias += x[GYRO]
        self.force_bias += x[FORCE]
        self.offsets += x[OFFSETS]
