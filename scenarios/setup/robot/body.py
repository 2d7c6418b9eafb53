"""A robot in the whole-body controller's terms: its model, its feet, and what standing takes of its joints."""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.models.facts import safe_range
from surefoot.models.legs import leg_masses, point_mass
from surefoot.models.pinocchio import Scratch, pinocchio_model
from surefoot.models.types import RobotDescription
from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.parameters import LegInertia
from surefoot.planner.types import FeetState
from surefoot.wbc.body.ik import PostureIk, PostureTarget
from surefoot.wbc.body.leaning import line_centre
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames
from surefoot.wbc.body.statics import standing_torque

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Body:
    """A robot in the whole-body controller's terms.

    Attributes:
        robot: its description.
        model: its Pinocchio model.
        frames: the frames that the controller steers.
        limits: of its joints.
        leg_joints: which joints are leg joints, bool, shape (nj,).
        scratch: memory for what is worked out at once.
    """

    robot: RobotDescription
    model: pin.Model
    frames: BodyFrames
    limits: JointLimits
    leg_joints: NDArray[np.bool_]
    scratch: Scratch

    def ik(self, posture: Array) -> PostureIk:
        """Inverse kinematics near joint positions, shape (nj,) [rad]."""
        return PostureIk(self.model, self.frames, self.limits, posture)


@lru_cache(maxsize=8)
def body_of(robot: RobotDescription) -> Body:
    """The body of a described robot, made once for each; nobody may change its model."""
    model = pinocchio_model(robot)
    return Body(
        robot=robot,
        model=model,
        frames=frames_of(robot),
        limits=JointLimits(robot.torque_limit, robot.velocity_limit, *safe_range(robot)),
        leg_joints=np.isin(robot.joint_names, robot.roles.legs),
        scratch=Scratch(model),
    )


def frames_of(robot: RobotDescription) -> BodyFrames:
    """The frames of a described robot that the controller steers."""
    leaning = 0.5 * robot.sole_width if robot.roles.feet_lean else None
    return BodyFrames(soles=robot.sole_sites, torso=robot.torso_body, leaning=leaning)


def leg_inertia(model: pin.Model, frames: BodyFrames, q: Array, leg_joints: NDArray[np.bool_]) -> LegInertia:
    """The legs as the planner knows them.

    Args:
        model: the robot.
        frames: of its body.
        q: standing configuration, shape (nq,), soles level and side by side.
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """
    given = model, frames.soles, q, leg_joints
    masses = leg_masses(*given)
    links = {"thigh": Link(*masses.thigh), "shank": Link(*masses.shank)}
    return LegInertia(point_mass(*given), LegChain(**{**masses._asdict(), **links}))


def feet_at(body: Body, q: Array) -> FeetState:
    """Soles of a standing configuration, shape (nq,), or the lines on which leaning ones stand."""
    position, rotation = _sole_placements(body, q)
    if body.frames.leaning is not None:
        lines = (line_centre(k, position[k], rotation[k], body.frames.leaning) for k in (0, 1))
        position = np.array(list(lines))
    return FeetState(position, np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0]), (True, True))


def _sole_placements(body: Body, q: Array) -> tuple[Array, Array]:
    data = body.scratch.data
    pin.framesForwardKinematics(body.model, data, q)
    placements = [data.oMf[body.model.getFrameId(name)] for name in body.frames.soles]
    return np.array([p.translation for p in placements]), np.array([p.rotation for p in placements])


@dataclass(frozen=True, slots=True)
class TorqueMargin:
    """The share of their torque that the joints need to hold a posture.

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
    """The demand of standing on one foot; of the left and the right one the worse."""
    return max((standing(body, side)[0] for side in (1.0, -1.0)), key=lambda margin: margin.share)
