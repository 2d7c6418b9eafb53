"""What the sensors of the simulated robot say at one instant."""

import numpy as np
from numpy.typing import NDArray

from surefoot.values import dataclass

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Measurement:
    """Sensors and truth at one instant; the joint order is that of the robot description.

    The arrays are buffers of the world, overwritten by its next `measure()`: copy what must live longer.

    Joint state, gyro and true state are those of `time`; torques, accelerometer and wrenches are those of the physics
    step that ended at `time` (after a reset: those of the torques that it was given); the external force is the mean
    since the measurement before, so that a push of any length leaves its whole impulse in the sum.

    Attributes:
        time: instant [s].
        joint_position: encoders, shape (nj,) [rad].
        joint_velocity: encoders, shape (nj,) [rad/s].
        joint_torque: applied by the motors, after their limits, shape (nj,) [N m].
        gyro: angular velocity of the IMU in its frame, shape (3,) [rad/s].
        accelerometer: specific force (acceleration minus gravity) of the IMU in its frame, shape (3,) [m/s^2].
        wrench: force and torque that the ground exerts on the left and the right foot, at the sole centre in the sole
            frame, shape (2, 6) [N, N m].
        q: true configuration in Pinocchio's convention, shape (7 + nj,) [m, -, rad].
        v: true velocity in Pinocchio's convention, shape (6 + nj,) [m/s, rad/s].
        external_force: sum of the pushes, mean over the `World.advance` that ended at `time`, world, shape (3,) [N].
        nonfoot_contact: whether anything but the feet touches the terrain.
        self_contact: whether the robot touches itself; a foot's wrench then holds that touch, too.
    """

    time: float
    joint_position: Array
    joint_velocity: Array
    joint_torque: Array
    gyro: Array
    accelerometer: Array
    wrench: Array
    q: Array
    v: Array
    external_force: Array
    nonfoot_contact: bool
    self_contact: bool
