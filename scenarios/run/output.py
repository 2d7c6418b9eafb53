"""The output of a controller to the joints: torques, or targets with gains that the drives follow by themselves."""

import math
import re
from collections.abc import Mapping, Sequence

import numpy as np

from surefoot.errors import ParameterError
from surefoot.joints import JointCommand, Servo
from surefoot.models.types import RobotDescription, nearest
from surefoot.scenarios.file.control import ControlSettings
from surefoot.similarity import Similarity
from surefoot.wbc.types import Array

STIFFNESS, DAMPING = 1.0, 0.01
"""Gains of targets over the largest torque of a joint, of the reference robot [1/rad, s/rad]."""


class Output:
    """Makes commands of what the whole-body controller has decided.

    Targets are those of the middle of the period for which they hold, on the motion that is planned: a joint that moves
    as planned then gets the planned torque in the mean. All else the drives pull it back to that motion, and on, where
    the next command fails to come.

    Args:
        keys: of the scenario.
        robot: whose joints they are.
        size: of it.
        rate: of the control ticks [Hz].

    Attributes:
        rate: of the commands [Hz].
        period: time for which one holds [s].
        holds: whether it holds for longer than a control tick.
        servo: whether targets are given.

    Raises:
        ParameterError: keys do not fit together, or to the robot.
    """

    def __init__(self, keys: ControlSettings, robot: RobotDescription, size: Similarity, rate: int) -> None:
        self.rate = keys.output_rate or rate
        self.period, self.holds, self.servo = 1.0 / self.rate, self.rate != rate, keys.output == "position"
        if self.rate > rate:
            what = f"control.output_rate {self.rate} Hz is more than rates.control {rate} Hz"
            raise ParameterError(("control", "output_rate"), what, f"use at most {rate} Hz")
        self._folded = keys.feed_forward is False
        self._gains: tuple[Array, Array] | None = None
        if keys.output != "position":
            for name in ("stiffness", "damping", "gains", "feed_forward"):
                if getattr(keys, name) is not None:
                    what = f"control.{name} of an output that is torque"
                    raise ParameterError(("control", name), what, "leave it out, or let control.output be position")
        else:
            share = STIFFNESS if keys.stiffness is None else keys.stiffness
            damping = DAMPING * size.time if keys.damping is None else keys.damping
            self._gains = share * robot.torque_limit, damping * robot.torque_limit
            self._set(keys.gains or {}, robot.joint_names)
            if self._folded and not self._gains[0].all():
                what = "targets without feed-forward for joints without stiffness"
                raise ParameterError(("control", "feed_forward"), what, "give them stiffness, or feed_forward true")

    def _set(self, gains: Mapping[str, tuple[float, float]], names: tuple[str, ...]) -> None:
        for pattern, pair in gains.items():
            chosen = matching(pattern, names, ("control", "gains", pattern))
            assert self._gains is not None
            for gain, value in zip(self._gains, pair, strict=True):
                gain[chosen] = value

    def after(self, now: float) -> float:
        """From when on the next command is due [s]."""
        return (math.floor(now * self.rate + 1e-6) + 1.0 - 1e-6) * self.period

    def command(self, torque: Array, position: Array, velocity: Array, acceleration: Array) -> JointCommand:
        """The targets of a torque that is to act for a period.

        Args:
            torque: shape (nj,) [N·m], as are the others.
            position: now [rad].
            velocity: now [rad/s].
            acceleration: as planned [rad/s^2].
        """
        assert self._gains is not None
        stiffness, damping = self._gains
        half = 0.5 * self.period
        speed = velocity + half * acceleration
        # The mean over the period of the motion that is planned.
        place = position + half * velocity + (2.0 / 3.0) * half * half * acceleration
        if self._folded:
            place = place + (torque + damping * speed) / stiffness
            return JointCommand(np.zeros_like(torque), Servo(place, np.zeros_like(speed), stiffness, damping))
        return JointCommand(torque.copy(), Servo(place, speed, stiffness, damping))


def matching(pattern: str, names: Sequence[str], key: tuple[str | int, ...], where: str = "") -> list[int]:
    """Indices of the joints whose whole name a regular expression matches.

    Args:
        pattern: the expression.
        names: of the joints.
        key: that it is of, for messages.
        where: beginning of a message, where a key holds many expressions.

    Raises:
        ParameterError: it is none, or matches none.
    """
    try:
        found = [index for index, name in enumerate(names) if re.fullmatch(pattern, name)]
    except re.error as error:
        raise ParameterError(key, f"{where}'{pattern}' is no regular expression, {error}", "mend it") from None
    if not found:
        raise ParameterError(key, f"{where}no joint is called '{pattern}'", nearest(pattern, names))
    return found
