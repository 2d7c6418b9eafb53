"""The facts of a robot's description that bound its walks: lengths, size, and the joints of its legs.

Masses and shapes are those of the robot upright with straight legs, in MuJoCo.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from surefoot.models.convert import Coordinates
from surefoot.models.inertia import LEAST_MASS
from surefoot.models.types import RobotDescription
from surefoot.similarity import REFERENCE_SIZE, Similarity

if TYPE_CHECKING:
    from surefoot.engines.windowless import mujoco

Array = NDArray[np.float64]

PITCH, ROLL, YAW = 1, 0, 2
"""Axes of the world about which an upright leg swings forward and sideways, and turns."""

_ALONG = 0.7
"""Share of its axis that points along another one, of a joint that turns about that [-]."""

CLEAR = 0.04
"""Lateral room between the shanks, or the soles, of a reference robot that walks straight ahead [m]."""


STOPS_OFF = 1e-3
"""Distance at which joints are held from the ends of their ranges, since a touchdown shakes them past that [rad]."""

HIPS, SHANKS = 0.2, 0.11
"""Distance between the hips of the reference robot, and of its soles at which its shanks keep apart [m]."""


@dataclass(frozen=True, slots=True)
class RobotFacts:
    """Numbers of a robot that bound a scenario.

    Attributes:
        bodies: names of its bodies.
        leg_length: hip centre to sole with the knee straight [m].
        hip_width: distance between the hip centres [m].
        com_above_hip: CoM height over the hip centres, standing straight [m].
        foot_length: of the soles [m].
        foot_width: of the soles [m].
        shank_spacing: lateral distance of the soles at which upright shanks keep apart [m].
        swing_acceleration: of the sole of a straight leg, forward and sideways, by the torque of its hip [m/s^2].
        ankle_torque: of the joints that pitch and roll the left foot [N m].
        pelvis_free: whether it turns, and lists, with joints of their own; see `pelvis_free`.
        size: against the reference robot, without what it carries.
    """

    bodies: tuple[str, ...]
    leg_length: float
    hip_width: float
    com_above_hip: float
    foot_length: float
    foot_width: float
    shank_spacing: float
    swing_acceleration: tuple[float, float]
    ankle_torque: tuple[float, float] = (math.inf, math.inf)
    pelvis_free: tuple[bool, bool] = (False, False)
    size: Similarity = REFERENCE_SIZE

    def leg_span(self, com_height: float) -> float:
        """Largest distance between two soles, CoM over their middle at a height, less the hip width sideways [m]."""
        span = longest_step(self.leg_length, com_height - self.com_above_hip, self.hip_width, self.hip_width)
        return 0.0 if math.isnan(span) else span


def longest_step(
    leg_length: float, hip_height: float, hip_width: float, step_width: float, raised: float = 0.0
) -> float:
    """Longest step with the CoM, at touchdown, where both legs are straight; halfway between feet with flat soles.

    Each leg then spans its part of the step forward, half the difference of foot and hip spacing sideways and the hip
    height upward. A foot that lands on its heel is higher.

    Args:
        leg_length: hip centre to sole with the knee straight [m].
        hip_height: hip centre above the soles at touchdown [m].
        hip_width: distance between the hip centres [m].
        step_width: lateral distance between the soles' centres [m].
        raised: height of the centre of the sole that lands [m].

    Returns:
        forward distance between the soles' centres [m]; NaN when the hips are out of reach of feet side by side.
    """
    sideways = (step_width - hip_width) / 2
    behind, ahead = (leg_length**2 - height**2 - sideways**2 for height in (hip_height, hip_height - raised))
    return math.sqrt(behind) + math.sqrt(ahead) if behind >= 0 else math.nan


def facts_of(robot: RobotDescription, payload: float = 0.0) -> RobotFacts:
    """Derive the facts of a robot that bound a scenario.

    Args:
        robot: the robot.
        payload: mass that it carries by its options, which its size goes without [kg].
    """
    return RobotFacts(
        bodies=robot.bodies,
        leg_length=robot.leg_length,
        hip_width=robot.hip_width,
        com_above_hip=com_height(robot) - robot.leg_length,
        foot_length=robot.sole_length,
        foot_width=robot.sole_width,
        shank_spacing=robot.shank_spacing,
        swing_acceleration=swing_acceleration(robot),
        ankle_torque=ankle_torque(robot),
        pelvis_free=pelvis_free(robot),
        size=size_of(robot, payload),
    )


def size_of(robot: RobotDescription, payload: float) -> Similarity:
    """Size of a robot against the reference robot, without the payload that it carries [kg]."""
    return Similarity.of(robot.leg_length, float(robot.mass) - payload)


def stance_widening(robot: RobotDescription | RobotFacts, size: Similarity) -> float:
    """Distance by which a robot has to stand wider than the scaled reference robot, for its hips or shanks [m]."""
    if size == REFERENCE_SIZE:
        return 0.0
    return max(0.0, robot.hip_width - size.length * HIPS, robot.shank_spacing - size.length * SHANKS)


def similar_com_height(value: float, before: RobotFacts, after: RobotFacts) -> float:
    """CoM height at which the legs are bent as much: the hips at the same share of the leg's length [m].

    Args:
        value: that of the robot before [m].
        before: facts of it.
        after: of the other one.
    """
    return after.size.length / before.size.length * (value - before.com_above_hip) + after.com_above_hip


def similar_step_width(value: float, before: RobotFacts, after: RobotFacts, nearer: float = math.inf) -> float:
    """Step width for another robot: scaled, and wider by what its shanks or soles need to stay clear of each other [m].

    Feet that may land anywhere keep all the room between them that they have in the scenario as it was written. Those
    that come by a known way nearer than the width keep `CLEAR` of it: a wider step is not a similar one, its CoM sways
    further, and the moment about the vertical that the stance sole has to hold while a leg swings grows with it.

    Args:
        value: that of the robot before [m].
        before: facts of it.
        after: of the other one.
        nearer: how much nearer than that feet land in the walk as it was written; infinite where nobody knows [m].
    """
    length = after.size.length / before.size.length
    wider = 0.0
    for name in ("shank_spacing", "foot_width"):
        own, other = getattr(before, name), getattr(after, name)
        spare = max(0.0, value - nearer - own - CLEAR * before.size.length)
        wider = max(wider, other - length * (own + spare))
    return length * value + wider


def similar_tread(value: float, before: RobotFacts, after: RobotFacts) -> float:
    """Depth of a tread for another robot: scaled, and deeper by what its soles are longer than scaled ones [m].

    So no sole lands nearer to an edge.

    Args:
        value: that of the robot before [m].
        before: facts of it.
        after: of the other one.
    """
    length = after.size.length / before.size.length
    return length * value + max(0.0, after.foot_length - length * before.foot_length)


def safe_range(robot: RobotDescription) -> tuple[Array, Array]:
    """Least and greatest positions of the joints, a little inside their ranges, each of shape (nj,) [rad].

    Of knees that can bend both ways it is only the one that walks: past straight, what should shorten a leg bends its
    knee the further the wrong way, into its stop.
    """
    off = np.minimum(STOPS_OFF, 0.25 * (robot.position_upper - robot.position_lower))
    lower, upper = robot.position_lower + off, robot.position_upper - off
    for knee, bend in zip(robot.joint_indices(robot.roles.knees), robot.roles.knee_bend, strict=True):
        (lower if bend > 0.0 else upper)[knee] = robot.straight_joint_positions[knee] + bend * off[knee]
    return lower, upper


def knees_straight(robot: RobotDescription) -> tuple[float, ...]:
    """Angles of the knees with straight legs, in the order of the joints; empty where they are zero [rad]."""
    joints = zip(robot.joint_names, robot.straight_joint_positions, strict=True)
    angles = tuple(float(angle) for name, angle in joints if name in robot.roles.knees)
    return angles if any(angles) else ()


def knees_turn(robot: RobotDescription) -> tuple[float, ...]:
    """Turn of each shank for an angle of its knee, in the order of the joints; empty where all are 1 [-]."""
    knees = [name for name in robot.joint_names if name in robot.roles.knees]
    turns = tuple(_turn(robot, knee) for knee in knees)
    return turns if any(turn != 1.0 for turn in turns) else ()


def knee_turn(robot: RobotDescription, foot: int) -> float:
    """Turn of a shank against its thigh for an angle of the knee, more than 1 where joints follow it [-]."""
    return _turn(robot, robot.roles.knees[foot])


def _turn(robot: RobotDescription, joint: str) -> float:
    following = [one for one in robot.couplings if one.leader == joint]
    if not following:
        return 1.0
    model, data = _upright(robot)
    axis = data.xaxis[model.joint(joint).id]
    shares = (one.ratio * float(axis @ data.xaxis[model.joint(one.follower).id]) for one in following)
    return abs(1.0 + sum(shares))


def named_roles(robot: RobotDescription) -> dict[str, tuple[str, ...]]:
    """Names of the robot's joints and bodies by their role, as its description has them."""
    roles = robot.roles
    legs = {"left_leg": roles.left_leg, "right_leg": roles.right_leg}
    return {"knees": roles.knees, **legs, "torso": (robot.torso_body,)}


def com_height(robot: RobotDescription) -> float:
    """CoM height above the soles [m]."""
    _, data = _upright(robot)
    return float(data.subtree_com[0, 2] - data.site(robot.sole_sites[0]).xpos[2])


def swing_acceleration(robot: RobotDescription) -> tuple[float, float]:
    """Acceleration of the left leg's sole by the torque of its hip, forward and sideways [m/s^2].

    That of a straight leg. A leg that is bent as in a gait has less inertia, which makes up for what gravity takes.
    """
    from surefoot.engines.windowless import mujoco

    model, data = _upright(robot)
    hips = robot.roles.left_leg[: robot.roles.left_leg.index(robot.roles.knees[0])]
    reached = []
    for axis in (PITCH, ROLL):
        name = _nearest(robot, hips, np.eye(3)[axis])
        unit, inertia = np.zeros((2, model.nv))
        dof = model.joint(name).dofadr[0]
        unit[dof] = 1.0
        mujoco.mj_mulM(model, data, inertia, unit)
        limit = float(robot.torque_limit[robot.joint_names.index(name)])
        reached.append(robot.leg_length * limit / float(inertia[dof]))
    return reached[0], reached[1]


def ankle_torque(robot: RobotDescription) -> tuple[float, float]:
    """Largest torque of the left ankle's joints that pitch and roll the foot; the roll's infinite without one [N m]."""
    leg = robot.roles.left_leg
    ankles = leg[leg.index(robot.roles.knees[0]) + 1 :]
    pitch, roll = (_nearest(robot, ankles, np.eye(3)[axis]) for axis in (PITCH, ROLL))
    pitching, rolling = (float(robot.torque_limit[robot.joint_names.index(name)]) for name in (pitch, roll))
    return pitching, rolling if roll != pitch else math.inf


def ankle_pitch(robot: RobotDescription, foot: int) -> tuple[int, float, float]:
    """Index of the joint that pitches a foot, its position under an upright shank [rad], the sign of its bending."""
    model, data = _upright(robot)
    names = pitch_joints(robot, foot)
    knee, ankle = (model.joint(name).id for name in names[1:])
    index = robot.joint_names.index(names[2])
    shank, sign = data.xanchor[knee] - data.xanchor[ankle], -math.copysign(1.0, float(data.xaxis[ankle, 1]))
    lean = math.atan2(float(shank[0]), float(shank[2]))
    return index, float(robot.straight_joint_positions[index]) - sign * lean, sign


def pitch_joints(robot: RobotDescription, foot: int) -> tuple[str, str, str]:
    """The joints of a leg that pitch thigh, shank and foot: beside the knee those whose axes are nearest to its."""
    leg, knee = (robot.roles.left_leg, robot.roles.right_leg)[foot], robot.roles.knees[foot]
    model, data = _upright(robot)
    axis, at = data.xaxis[model.joint(knee).id], leg.index(knee)
    return _nearest(robot, leg[:at], axis), knee, _nearest(robot, leg[at + 1 :], axis)


def yaw_joint(robot: RobotDescription, foot: int) -> str:
    """The joint of a leg above its knee that turns the foot about the vertical."""
    leg, knee = (robot.roles.left_leg, robot.roles.right_leg)[foot], robot.roles.knees[foot]
    return _nearest(robot, leg[: leg.index(knee)], np.eye(3)[YAW])


def pelvis_free(robot: RobotDescription) -> tuple[bool, bool]:
    """Return true where the pelvis can turn, and where it can list, under a torso that does not.

    The waist needs a joint for each. Hips that pitch or roll before they turn leave neither free. With a pitched thigh
    the joint that carries the body sideways would have to move, too.
    """
    if yaw_joint(robot, 0) != robot.roles.left_leg[0]:
        return False, False
    model, data = _upright(robot)
    axes = [np.abs(data.xaxis[model.joint(name).id]) for name in robot.roles.waist]
    turns, lists = (any(axis[along] > _ALONG for axis in axes) for along in (YAW, ROLL))
    return turns, lists


def shank_outline(robot: RobotDescription, foot: int) -> Array:
    """Corners of the shank as seen from the side, shape (m, 2): ahead of the ankle and up along the shank [m]."""
    model, data = _upright(robot)
    _, knee, ankle = pitch_joints(robot, foot)
    leg = (robot.roles.left_leg, robot.roles.right_leg)[foot]
    behind = [one.follower for one in robot.couplings if one.leader == knee]
    below = (int(model.joint(name).bodyid[0]) for name in (*(behind or [knee])[-1:], *leg[leg.index(knee) + 1 :]))
    shank = next(body for body in below if model.body_mass[body] > LEAST_MASS)
    knee, ankle = (model.joint(name).id for name in (knee, ankle))
    up = data.xanchor[knee] - data.xanchor[ankle]
    up[1] = 0.0
    up /= np.linalg.norm(up)
    ahead = np.array([up[2], 0.0, -up[0]])
    points = []
    for geom in np.flatnonzero((model.geom_bodyid == shank) & (model.geom_contype > 0)):
        local = _corners(model, int(geom))
        world = data.geom_xpos[geom] + local @ data.geom_xmat[geom].reshape(3, 3).T - data.xanchor[ankle]
        points.append(np.column_stack((world @ ahead, world @ up)))
    return np.concatenate(points) if points else np.zeros((0, 2))


def _nearest(robot: RobotDescription, joints: tuple[str, ...], axis: Array) -> str:
    """The one of some joints whose axis is nearest to one in the world, whichever way it points."""
    model, data = _upright(robot)
    return max(joints, key=lambda name: abs(float(data.xaxis[model.joint(name).id] @ axis)))


def _corners(model: "mujoco.MjModel", geom: int) -> Array:
    """Points whose hull is a geom or holds it, in its own frame, shape (m, 3) [m]."""
    mesh = model.geom_dataid[geom]
    if mesh >= 0:
        first = model.mesh_vertadr[mesh]
        return np.asarray(model.mesh_vert[first : first + model.mesh_vertnum[mesh]], dtype=np.float64)
    centre, half = model.geom_aabb[geom][:3], model.geom_aabb[geom][3:]
    return np.asarray(centre + half * np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, -1).T)


def _upright(robot: RobotDescription) -> "tuple[mujoco.MjModel, mujoco.MjData]":
    return _compiled(robot.mjcf, tuple(robot.straight_joint_positions.tolist()))


@lru_cache(maxsize=8)
def _compiled(mjcf: str, angles: tuple[float, ...]) -> "tuple[mujoco.MjModel, mujoco.MjData]":
    """A text with its joints at angles, kept since dozens of facts need it (50 ms); nobody may write to it."""
    from surefoot.engines.windowless import mujoco

    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    Coordinates(model).bend(np.array(angles), data.qpos)
    mujoco.mj_forward(model, data)
    return model, data
