"""Somebody else in a simulation: drives that hold some of the joints where they stand, or move them at random."""

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.joints import JointCommand, Servo
from surefoot.models.types import RobotDescription
from surefoot.scenarios.file.control import ControlSettings
from surefoot.scenarios.run.output import matching
from surefoot.streams import Stream, generator
from surefoot.wbc.types import Array

EVERY = 0.02
"""Time after which somebody who moves joints at random gives them other targets [s]."""

FARTHEST = 0.6
"""Farthest way of such targets from where the joints stood [rad]."""


def driven_joints(keys: ControlSettings, robot: RobotDescription) -> NDArray[np.bool_] | None:
    """Mark the joints that somebody else drives, bool, shape (nj,); None for none.

    Raises:
        ParameterError: a pattern names none.
    """
    if not keys.driven_joints:
        for name in ("driven_motion", "driven_told"):
            if getattr(keys, name) is not None:
                what = f"control.{name} without joints that somebody else drives"
                raise ParameterError(("control", name), what, "name them in control.driven_joints, or leave it out")
        return None
    driven = np.zeros(len(robot.joint_names), dtype=bool)
    for pattern in keys.driven_joints:
        driven[matching(pattern, robot.joint_names, ("control", "driven_joints", pattern))] = True
    legs = [name for name, one in zip(robot.joint_names, driven, strict=True) if one and name in robot.roles.legs]
    if legs:
        what = f"somebody else drives {legs[0]}, which is of a leg"
        raise ParameterError(("control", "driven_joints"), what, "leave the legs to the controller")
    return driven


class Somebody:
    """Drives joints of a simulated robot.

    Args:
        keys: of the scenario.
        robot: whose joints they are.
        posture: angles at the start, shape (nj,) [rad].
        seed: of the run.

    Attributes:
        joints: which are driven, bool, shape (nj,).
    """

    def __init__(self, keys: ControlSettings, robot: RobotDescription, posture: Array, seed: int) -> None:
        joints, names = driven_joints(keys, robot), robot.joint_names
        assert joints is not None
        self.joints = joints
        self._stiffness, self._damping = np.zeros(len(names)), np.zeros(len(names))
        for pattern, (stiffness, damping) in (keys.driven_joints or {}).items():
            chosen = matching(pattern, names, ("control", "driven_joints", pattern))
            self._stiffness[chosen], self._damping[chosen] = stiffness, damping
        self._start, self._target = posture.copy(), posture.copy()
        self._lower = np.maximum(robot.position_lower, posture - FARTHEST)
        self._upper = np.minimum(robot.position_upper, posture + FARTHEST)
        self._motion, self._rng = keys.driven_motion or 0.0, generator(seed, Stream.DRIVEN)
        self._changed = 0

    def command(self, now: float) -> JointCommand:
        """Command of the driven joints from an instant on [s]; none of the other joints."""
        if self._motion:
            while self._changed * EVERY <= now:
                step = self._rng.uniform(-self._motion, self._motion, len(self._target))
                moved = np.clip(self._target + step, self._lower, self._upper)
                self._target = np.where(self.joints, moved, self._start)
                self._changed += 1
        still = np.zeros_like(self._target)
        return JointCommand(still, Servo(self._target, still, self._stiffness, self._damping))
