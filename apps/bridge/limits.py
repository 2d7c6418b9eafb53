"""The limits of a plant on its commands: no more than its joints may, no faster than they may, and gently at first."""

import numpy as np

from surefoot.joints import JointCommand, Servo, no_servo
from surefoot.models.types import RobotDescription
from surefoot.sim.measurement import Array
from surefoot.similarity import Similarity

TORQUE_RATE = 300.0
"""Largest torques by which a commanded torque may change in a second, of the reference robot [1/s]."""

MARGIN = 1e-6
"""Share of its limit by which a torque may miss it, for rounding [-]."""

HOLD_STIFFNESS, HOLD_DAMPING = 3.0, 0.08
"""Gains of joints that are held at the start, over their largest torque, of the reference robot [1/rad, s/rad]."""

DAMPING = 0.05
"""Damping of joints that are let go, over their largest torque, of the reference robot [s/rad]."""


class Limits:
    """The limits of a robot's joints, tick by tick.

    A torque is at most the largest of its joint, and changes at most by a rate. A target is at most so far from its
    joint as its stiffness makes twice the largest torque of, and moves no faster than the joint can.

    Args:
        robot: whose joints they are.
        size: of it.
        period: of the ticks [s].
        rate: by which torques may change, as `TORQUE_RATE`; infinite for no such limit.

    Attributes:
        damping: joints that are let go.
    """

    def __init__(self, robot: RobotDescription, size: Similarity, period: float, rate: float = TORQUE_RATE) -> None:
        self._most = robot.torque_limit
        self._speed = robot.velocity_limit
        self._step = rate / size.time * period * self._most
        self._before = np.zeros_like(self._most)
        zero = np.zeros_like(self._most)
        self._hold = HOLD_STIFFNESS * self._most, HOLD_DAMPING * size.time * self._most
        self.damping = JointCommand(zero, Servo(zero, zero, zero, DAMPING * size.time * self._most))

    def begin(self, torque: Array) -> None:
        """Start from torques, shape (nj,) [N·m]."""
        self._before = torque

    def holding(self, position: Array, torque: Array) -> JointCommand:
        """Joints held where they are by torques and stiff drives, shape (nj,) each [rad, N·m]."""
        return JointCommand(torque, Servo(position, np.zeros_like(position), *self._hold))

    def within(self, command: JointCommand, position: Array) -> tuple[JointCommand, bool]:
        """The part of a command that may be done, and true if that is less than all.

        Args:
            command: for this tick.
            position: of the joints now, shape (nj,) [rad].
        """
        asked, most = command.torque, self._most
        low, high = np.maximum(-most, self._before - self._step), np.minimum(most, self._before + self._step)
        self._before = torque = np.minimum(np.maximum(asked, low), high)
        limited = bool((np.abs(torque - asked) > MARGIN * most).any())
        servo = command.servo
        if servo is None:
            return JointCommand(torque), limited
        stiff = servo.stiffness > 0.0
        room = np.divide(2.0 * most, servo.stiffness, out=np.full_like(most, np.inf), where=stiff)
        target = np.minimum(np.maximum(servo.position, position - room), position + room)
        speed = np.minimum(np.maximum(servo.velocity, -self._speed), self._speed)
        limited = limited or bool((target != servo.position).any()) or bool((speed != servo.velocity).any())
        return JointCommand(torque, Servo(target, speed, servo.stiffness, servo.damping)), limited


def blended(one: JointCommand, other: JointCommand, share: float) -> JointCommand:
    """A command between two: its torque is so much of the other one's, and all else of the one's, in any state."""
    torque = (1.0 - share) * one.torque + share * other.torque
    mine, theirs = (command.servo or no_servo(len(torque)) for command in (one, other))
    stiffness = (1.0 - share) * mine.stiffness + share * theirs.stiffness
    damping = (1.0 - share) * mine.damping + share * theirs.damping
    pulls = (1.0 - share) * mine.stiffness * mine.position + share * theirs.stiffness * theirs.position
    drags = (1.0 - share) * mine.damping * mine.velocity + share * theirs.damping * theirs.velocity
    position, velocity = (
        np.divide(moment, gain, out=np.zeros_like(torque), where=gain > 0.0)
        for moment, gain in ((pulls, stiffness), (drags, damping))
    )
    return JointCommand(torque, Servo(position, velocity, stiffness, damping))
