"""How the robot stands when a run begins: the posture, its noise, and the feet as the planner first sees them."""

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.types import RobotDescription
from surefoot.planner.types import FeetState
from surefoot.scenarios.setup.walk import Walk
from surefoot.wbc.ik import PostureIk, PostureTarget
from surefoot.wbc.leaning import line_centre
from surefoot.wbc.limits import JointLimits
from surefoot.wbc.model import BodyFrames

Array = NDArray[np.float64]

STOPS_OFF = 1e-3
"""How far from the ends of their ranges joints are held, since a touchdown shakes them past where that is [rad]."""

SOLE_SINKAGE = 1.3e-4
"""How far the reference robot's soles sink into the simulated ground under its weight [m]."""


@dataclass(frozen=True, slots=True)
class Body:
    """A robot in the whole-body controller's terms.

    Attributes:
        robot: its description.
        model: its Pinocchio model.
        frames: the frames that the controller steers.
        limits: of its joints.
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """

    robot: RobotDescription
    model: pin.Model
    frames: BodyFrames
    limits: JointLimits
    leg_joints: NDArray[np.bool_]

    def ik(self, posture: Array) -> PostureIk:
        """Inverse kinematics near joint positions, shape (nj,) [rad]."""
        return PostureIk(self.model, self.frames, self.limits, posture)


def body_of(robot: RobotDescription) -> Body:
    """The body of a described robot."""
    return Body(
        robot=robot,
        model=pinocchio_model(robot),
        frames=frames_of(robot),
        limits=_limits(robot),
        leg_joints=np.isin(robot.joint_names, robot.roles.legs),
    )


def _limits(robot: RobotDescription) -> JointLimits:
    """Limits of the joints, a little inside their ranges; of knees that can bend both ways only the one that walks.

    Past straight, what should shorten a leg bends its knee the further the wrong way, into its stop.
    """
    off = np.minimum(STOPS_OFF, 0.25 * (robot.position_upper - robot.position_lower))
    lower, upper = robot.position_lower + off, robot.position_upper - off
    for knee, bend in zip(robot.joint_indices(robot.roles.knees), robot.roles.knee_bend, strict=True):
        (lower if bend > 0.0 else upper)[knee] = robot.straight_joint_positions[knee] + bend * off[knee]
    return JointLimits(robot.torque_limit, robot.velocity_limit, lower, upper)


def frames_of(robot: RobotDescription) -> BodyFrames:
    """The frames of a described robot that the controller steers."""
    leaning = 0.5 * robot.sole_width if robot.roles.feet_lean else None
    return BodyFrames(soles=robot.sole_sites, torso=robot.torso_body, leaning=leaning)


def start_posture(walk: Walk, body: Body) -> Array:
    """Configuration, shape (nq,), that stands with the CoM at its height over the middle of the feet.

    Raises:
        ParameterError: the legs cannot reach that stance.
    """
    feet, start, height, ground = walk.stance, walk.start, walk.standing_height, walk.start_height
    target = PostureTarget(feet.position, feet.yaw, np.array([start.x, start.y, ground + height]), start.yaw)
    robot = body.robot
    q = pin.neutral(body.model)
    q[:3] = start.x, start.y, ground + robot.leg_length
    q[3:7] = 0.0, 0.0, math.sin(0.5 * start.yaw), math.cos(0.5 * start.yaw)
    q[7:] = robot.nominal_joint_positions
    result = body.ik(robot.nominal_joint_positions).solve(target, q)
    if not result.reached:
        raise ParameterError(
            ("gait", "com_height"),
            f"robot '{robot.name}' cannot stand with gait.com_height {height:g} m and gait.step_width "
            f"{walk.gait.step_width:g} m, {result.error:.3f} m are missing",
            f"use for example {robot.com_height:g} m and {robot.hip_width:g} m",
        )
    return result.q


def disturbed(q: Array, walk: Walk, body: Body) -> Array:
    """The posture, shape (nq,), with the start noises on base position, base attitude and every joint.

    The legs then give way until both soles, wherever the noise has put and turned them, lie flat on the ground.

    Raises:
        ParameterError: they cannot.
    """
    start = walk.start
    if start.position_noise == 0.0 and start.angle_noise == 0.0:
        return q
    rng = np.random.default_rng(walk.seed)
    nv = body.model.nv
    offset = np.zeros(nv)
    offset[:3] = rng.uniform(-start.position_noise, start.position_noise, 3)
    offset[3:] = rng.uniform(-start.angle_noise, start.angle_noise, nv - 3)
    q = pin.integrate(body.model, q, offset)
    feet = feet_at(body, q)
    soles = feet.position.copy()
    soles[:, 2] = walk.start_height
    result = body.ik(q[7:]).solve(PostureTarget(soles, feet.yaw), q)
    if not result.reached:
        raise ParameterError(
            ("start", "angle_noise"),
            f"robot '{body.robot.name}' cannot stand with start.angle_noise {start.angle_noise:g} rad and "
            f"start.position_noise {start.position_noise:g} m: {result.error:.3f} m or rad are missing",
            "reduce them",
        )
    return result.q


def pressed(q: Array, length: float = 1.0) -> Array:
    """The configuration, shape (nq,), of a robot of a size [-], sunk in so far that the ground carries it at once."""
    sunk = q.copy()
    sunk[2] -= SOLE_SINKAGE * length
    return sunk


def feet_at(body: Body, q: Array) -> FeetState:
    """Soles of a standing configuration, shape (nq,), or the lines on which leaning ones stand."""
    position, rotation = _sole_placements(body, q)
    if body.frames.leaning is not None:
        lines = (line_centre(k, position[k], rotation[k], body.frames.leaning) for k in (0, 1))
        position = np.array(list(lines))
    return FeetState(position, np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0]), (True, True))


def _sole_placements(body: Body, q: Array) -> tuple[Array, Array]:
    data = body.model.createData()
    pin.framesForwardKinematics(body.model, data, q)
    placements = [data.oMf[body.model.getFrameId(name)] for name in body.frames.soles]
    return np.array([p.translation for p in placements]), np.array([p.rotation for p in placements])
