"""The true values of a simulated robot at one instant, from which its sensors read."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def is_rotation(quaternion: Array) -> bool:
    """Return true if four numbers, shape (4,), are those of a rotation but for rounding."""
    return bool(0.81 < float(np.vdot(quaternion, quaternion)) < 1.21)


@dataclass(frozen=True)
class Measurement:
    """Sensors and truth at one instant; the joint order is that of the robot description.

    The arrays are buffers of the world, overwritten by its next `measure()`: copy what must live longer.

    Joint state, gyro and true state are those of `time`. Torques, accelerometer and wrenches are those of the physics
    step that ended at `time`; after a reset, those of the torques that it was given. The external force is the mean
    since the measurement before, so that a push of any length leaves its whole impulse in the sum.

    Attributes:
        time: instant [s].
        joint_position: encoders, shape (nj,) [rad].
        joint_velocity: encoders, shape (nj,) [rad/s].
        joint_torque: applied by the motors, after their limits, shape (nj,) [N m]; NaN where it is not known.
        gyro: angular velocity of the IMU in its frame, shape (3,) [rad/s].
        accelerometer: specific force (acceleration minus gravity) of the IMU in its frame, shape (3,) [m/s^2].
        wrench: force and torque that the ground exerts on the left and the right foot, at the sole centre in the sole
            frame, shape (2, 6) [N, N m]; NaN where no foot feels any.
        q: true configuration in Pinocchio's convention, shape (7 + nj,) [m, -, rad].
        v: true velocity in Pinocchio's convention, shape (6 + nj,) [m/s, rad/s].
        external_force: sum of the pushes, mean over the `World.advance` that ended at `time`, world, shape (3,) [N];
            NaN where it is not known.
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

    @classmethod
    def of_state(
        cls,
        time: float,
        q: Array,
        v: Array,
        joint_torque: Array | None = None,
        wrench: Array | None = None,
        external_force: Array | None = None,
    ) -> "Measurement":
        """Make the measurement of a robot whose state is known from elsewhere, with no IMU and nothing that touches it.

        Args:
            time: instant [s].
            q: configuration in Pinocchio's convention, shape (7 + nj,) [m, -, rad].
            v: velocity in Pinocchio's convention, shape (6 + nj,) [m/s, rad/s].
            joint_torque: shape (nj,) [N m]; None where it is not known.
            wrench: of the soles in their frames, shape (2, 6) [N, N m]; None where it is not known.
            external_force: sum of the pushes, mean since the measurement before, world, shape (3,) [N]; None
                where it is not known.
        """
        torque = np.full(len(v) - 6, np.nan) if joint_torque is None else joint_torque
        felt = np.full((2, 6), np.nan) if wrench is None else wrench
        unseen = np.full(3, np.nan)
        pushed = unseen if external_force is None else external_force
        return cls(time, q[7:], v[6:], torque, v[3:6], unseen, felt, q, v, pushed, False, False)
