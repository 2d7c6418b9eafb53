"""Readings of a robot's sensors at one instant, each with its age: all that an estimator gets."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Reading:
    """Values of one sensor.

    Attributes:
        values: as the sensor says them, shape (n,) by its channel [SI]; its own array, which nobody writes to again.
        age: time since the instant that they are of [s].
        fresh: whether they came since the control tick before; False for values that are held.
    """

    values: Array
    age: float
    fresh: bool


@dataclass(frozen=True)
class Readings:
    """All sensors at one control tick; the joint order is that of the robot description.

    Attributes:
        time: of the tick, by the robot's clock [s].
        joint_position: encoders, shape (nj,) [rad].
        joint_velocity: of encoders that say one, shape (nj,) [rad/s]; None where it must be observed.
        joint_torque: of the motors, shape (nj,) [N·m].
        angular_velocity: gyroscope, in the frame of the IMU, at the instant of the reading, shape (3,) [rad/s].
        mean_angular_velocity: that over the control period that ended there: the rotation vector from the IMU's axes at
            its beginning to those at its end, over its length, shape (3,) [rad/s].
        specific_force: accelerometer, acceleration less gravity in the axes of the IMU as they turn, mean over that
            period: the change of velocity less that by gravity, turned back from half the way, shape (3,) [m/s^2].
        wrench: that the ground exerts on each foot, at the sole centre in the sole frame, left first, shape (2, 6)
            [N, N·m]; None for a robot without such sensors.
    """

    time: float
    joint_position: Reading
    joint_velocity: Reading | None
    joint_torque: Reading
    angular_velocity: Reading
    mean_angular_velocity: Reading
    specific_force: Reading
    wrench: Reading | None
