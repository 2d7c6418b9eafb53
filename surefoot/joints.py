"""The values that pass between a controller and the joints of a robot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Servo:
    """Targets that the drives of the joints follow by themselves, with gains that never change.

    Attributes:
        position: shape (nj,) [rad].
        velocity: shape (nj,) [rad/s].
        stiffness: shape (nj,) [N·m/rad].
        damping: shape (nj,) [N·m·s/rad].
    """

    position: Array
    velocity: Array
    stiffness: Array
    damping: Array


@dataclass(frozen=True)
class JointCommand:
    """The command of the joints until the next one; the joint order is that of the robot description.

    Attributes:
        torque: of the motors, which a servo adds to, shape (nj,) [N·m].
        servo: targets to be followed; None for the torque alone.
    """

    torque: Array
    servo: Servo | None = None

    def with_joints(self, chosen: NDArray[np.bool_], other: "JointCommand") -> "JointCommand":
        """The same with another command for some joints, bool, shape (nj,) [-]."""
        mine, theirs = (one.servo or no_servo(len(one.torque)) for one in (self, other))
        names = ("position", "velocity", "stiffness", "damping")
        servo = Servo(*(np.where(chosen, getattr(theirs, name), getattr(mine, name)) for name in names))
        return JointCommand(np.where(chosen, other.torque, self.torque), servo)

    def torque_at(self, position: Array, velocity: Array) -> Array:
        """Torque at joint angles and speeds, before the limits of the motors, shape (nj,) [N·m].

        Args:
            position: shape (nj,) [rad].
            velocity: shape (nj,) [rad/s].
        """
        s = self.servo
        if s is None:
            return self.torque
        return self.torque + s.stiffness * (s.position - position) + s.damping * (s.velocity - velocity)


def no_servo(joints: int) -> Servo:
    """One that adds no torque."""
    zero = np.zeros(joints)
    return Servo(zero, zero, zero, zero)
