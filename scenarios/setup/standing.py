"""What standing takes of the joints' torque, on both feet and on one."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.scenarios.setup.stance import Body
from surefoot.wbc.ik import PostureTarget
from surefoot.wbc.statics import standing_torque

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TorqueMargin:
    """How much of their torque the joints need to hold a posture.

    Attributes:
        joint: the one that needs most of its own; empty where the posture cannot be taken.
        share: of its limit [-].
        needed: its torque [N m].
    """

    joint: str
    share: float
    needed: float


def standing(body: Body, side: float) -> tuple[TorqueMargin, Array]:
    """Torque that standing takes with the CoM at its nominal height, and the configuration, shape (nq,).

    Args:
        body: that stands, with the feet below its hips or as near as its shanks come.
        side: where the CoM is: midway (0), over the left sole, which then bears all (1), or the right one (-1).
    """
    robot = body.robot
    half = 0.5 * max(robot.hip_width, robot.shank_spacing)
    soles = np.array([[0.0, half, 0.0], [0.0, -half, 0.0]])
    target = PostureTarget(soles, np.zeros(2), np.array([0.0, side * half, robot.com_height]), 0.0)
    q = pin.neutral(body.model)
    q[2] = robot.leg_length
    q[7:] = robot.nominal_joint_positions
    ik = body.ik(robot.nominal_joint_positions)
    found = ik.solve(target, q)
    if not found.reached:  # the pelvis rolls where a hip ends, see `surefoot.wbc.tasks.trunk.HipStops`
        found = ik.solve(replace(target, rolling=True), found.q)
    if not found.reached:
        return TorqueMargin("", math.inf, math.inf), found.q
    foot = None if side == 0.0 else int(side < 0.0)
    torque = standing_torque(body.model, body.frames, found.q, foot=foot)
    shares = np.abs(torque) / robot.torque_limit
    worst = int(np.argmax(shares))
    return TorqueMargin(robot.joint_names[worst], float(shares[worst]), float(abs(torque[worst]))), found.q


def on_one_foot(body: Body) -> TorqueMargin:
    """What standing on one foot takes; of the left and the right one the worse."""
    return max((standing(body, side)[0] for side in (1.0, -1.0)), key=lambda margin: margin.share)
