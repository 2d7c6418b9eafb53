"""How the robot stands when a run begins: the posture, its noise, and the feet as the planner first sees them."""

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.models.joints import meeting_point, world_axis
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.types import RobotDescription
from surefoot.planner.model.leg_chain import LegChain, Link, Vector
from surefoot.planner.parameters import LegInertia
from surefoot.planner.types import FeetState
from surefoot.scenarios.setup.walk import Walk
from surefoot.wbc.ik import PostureIk, PostureTarget
from surefoot.wbc.limits import JointLimits
from surefoot.wbc.model import BodyFrames

Array = NDArray[np.float64]

_ON_THE_LINE = 1e-9
"""A link's CoM that is nearer to the line between its joints, in lengths of the link, lies on it [-]."""

STOPS_OFF = 1e-3
"""How far from the ends of their ranges joints are held, since a touchdown shakes them past where that is [rad]."""

SOLE_SINKAGE = 5e-5
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
    return BodyFrames(soles=robot.sole_sites, torso=robot.torso_body)


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
    """Soles of a standing configuration, shape (nq,)."""
    position, rotation = _sole_placements(body, q)
    return FeetState(position, np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0]), (True, True))


def _sole_placements(body: Body, q: Array) -> tuple[Array, Array]:
    data = body.model.createData()
    pin.framesForwardKinematics(body.model, data, q)
    placements = [data.oMf[body.model.getFrameId(name)] for name in body.frames.soles]
    return np.array([p.translation for p in placements]), np.array([p.rotation for p in placements])


def leg_inertia(model: pin.Model, frames: BodyFrames, q: Array, leg_joints: NDArray[np.bool_]) -> LegInertia:
    """The legs' inertia, from a standing configuration; both legs alike.

    The knee is the leg joint that is farthest from its neighbours in the chain; what is above it in the leg belongs to
    the thigh, what is below the next joint to the foot; hip and ankle are where the axes there come nearest to
    each other. The joints count as in one plane, CoMs may lie beside it.

    Args:
        model: the robot.
        frames: its soles, left and right.
        q: standing configuration, shape (nq,), soles level and side by side.
        leg_joints: which joints are leg joints, bool, shape (nj,).
    """
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    com = pin.centerOfMass(model, data, q)
    heading = data.oMi[1].rotation[:, 0]
    R = np.column_stack((heading, np.cross([0.0, 0.0, 1.0], heading), (0.0, 0.0, 1.0)))
    total, joints = pin.computeTotalMass(model), 6 + np.flatnonzero(leg_joints)
    left, right = (_leg(model, data, name, leg_joints) for name in frames.soles)
    legs = left.thigh.mass + left.shank.mass + left.foot.mass
    below = sum(part.mass * part.lever for leg in (left, right) for part in (leg.thigh, leg.shank, leg.foot))
    trunk = (total * com - below) / (total - 2.0 * legs)
    middle = 0.5 * (left.hip + right.hip)
    chain = LegChain(
        hip_half_width=0.5 * float(np.linalg.norm(left.hip - right.hip)),
        trunk=_mirrored((trunk - middle) @ R),
        thigh=_link(left.thigh, left.hip, left.knee, R, total),
        shank=_link(left.shank, left.knee, left.ankle, R, total),
        foot_mass=left.foot.mass / total,
        foot_centre=_mirrored((left.foot.lever - left.ankle) @ R),
        ankle=_mirrored((left.ankle - left.sole) @ R),
        foot_outward=_measured((left.foot.lever - left.ankle) @ R[:, 1]),
        rolls_first=left.rolls_first,
    )
    return LegInertia(float(np.mean([_point_mass(model, name, q, joints) for name in frames.soles])), chain)


@dataclass(frozen=True, slots=True)
class _Leg:
    """Joints and link inertias of a leg in the world frame, and whether its ankle rolls first."""

    hip: Array
    knee: Array
    ankle: Array
    sole: Array
    thigh: pin.Inertia
    shank: pin.Inertia
    foot: pin.Inertia
    rolls_first: bool


def _leg(model: pin.Model, data: pin.Data, sole: str, leg_joints: NDArray[np.bool_]) -> _Leg:
    frame = model.getFrameId(sole)
    chain = [j for j in model.supports[model.frames[frame].parentJoint] if j > 1 and leg_joints[j - 2]]
    at = [data.oMi[j].translation.copy() for j in chain]
    apart = np.linalg.norm(np.diff(at, axis=0), axis=1)
    knee = 1 + int(np.argmax(apart[1:] * apart[:-1]))
    groups = chain[:knee], chain[knee : knee + 1], chain[knee + 1 :]
    thigh, shank, foot = (_lumped(model, data, joints) for joints in groups)
    hip, ankle = (_pivot(model, data, group) for group in (groups[0], groups[2]))
    below, rolls_first = data.oMf[frame].translation.copy(), _pitching(model, data, groups[2]) != groups[2][0]
    return _Leg(hip, at[knee], ankle, below, thigh, shank, foot, rolls_first)


def _pitching(model: pin.Model, data: pin.Data, joints: list[int]) -> int:
    """The joint of a hip or an ankle whose axis is nearest to the lateral one."""
    lateral = data.oMi[1].rotation[:, 1]
    return max(joints, key=lambda joint: abs(float(world_axis(model, data, joint) @ lateral)))


def _pivot(model: pin.Model, data: pin.Data, joints: list[int]) -> Array:
    """The point of a hip or an ankle on its pitch axis, nearest to all its axes: what a link swings about."""
    meeting = meeting_point(model, data, joints)
    pitch = _pitching(model, data, joints)
    axis, origin = world_axis(model, data, pitch), data.oMi[pitch].translation
    return np.asarray(origin + axis * float(axis @ (meeting - origin)))


def _lumped(model: pin.Model, data: pin.Data, joints: list[int]) -> pin.Inertia:
    total = pin.Inertia.Zero()
    for joint in joints:
        total += data.oMi[joint].act(model.inertias[joint])
    return total


def _link(part: pin.Inertia, upper: Array, lower: Array, R: Array, total: float) -> Link:
    """A link between two joints, seen from the side of a body whose axes are the columns of R."""
    line, pitch = lower - upper, R[:, 1]
    along = line - (line @ pitch) * pitch
    length = float(np.linalg.norm(along))
    lever = part.lever - upper
    centre, ahead = float(lever @ along) / length**2, float(lever @ np.cross(along, pitch)) / length**2
    inertia = float(pitch @ part.inertia @ pitch) / total
    outward = _measured((lever - centre * line) @ pitch)
    return Link(length, part.mass / total, centre, inertia, ahead if abs(ahead) > _ON_THE_LINE else 0.0, outward)


def _measured(distance: float) -> float:
    """A distance without the rounding of where it was measured [m]."""
    return round(float(distance), 9)


def _mirrored(vector: Array) -> Vector:
    """A vector of both legs' mean: nothing to the left."""
    return float(vector[0]), 0.0, float(vector[2])


def _point_mass(model: pin.Model, sole: str, q: Array, joints: NDArray[np.intp]) -> float:
    """μ whose momentum L = Σ μ m (r_k - c)_z (r_k' - c')_x is that of one sole at 1 m/s forward [-]."""
    data = model.createData()
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    heading, frame = data.oMi[1].rotation[:, 0], model.getFrameId(sole)
    J = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:, joints]
    v = np.zeros(model.nv)
    v[joints] = np.linalg.lstsq(J, np.concatenate([heading, np.zeros(3)]), rcond=None)[0]
    momentum = pin.computeCentroidalMomentum(model, data, q, v)
    mass = pin.computeTotalMass(model)
    pitch = momentum.angular @ np.cross([0.0, 0.0, 1.0], heading) / mass
    height = float(data.com[0][2] - data.oMf[frame].translation[2])
    return float(-pitch / (height * (1.0 - 2.0 * (momentum.linear @ heading) / mass)))
