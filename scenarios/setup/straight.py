"""The robot upright with straight legs, in MuJoCo: what of its masses and shapes bounds a walk."""

import math
from functools import lru_cache

import mujoco
import numpy as np
from numpy.typing import NDArray

from surefoot.models.types import RobotDescription

Array = NDArray[np.float64]

HIP_SHARE = 0.67
"""Share of a hip's torque that swings a leg; the rest is for gravity and for a knee that is bent [-]."""

PITCH, ROLL, YAW = 1, 0, 2
"""Axes of the world about which an upright leg swings forward and sideways, and turns."""


def com_height(robot: RobotDescription) -> float:
    """CoM height above the soles [m]."""
    _, data = _upright(robot)
    return float(data.subtree_com[0, 2] - data.site(robot.sole_sites[0]).xpos[2])


def swing_acceleration(robot: RobotDescription) -> tuple[float, float]:
    """Of the left leg's sole with the share of its hip's torque, forward and sideways [m/s^2]."""
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
        reached.append(HIP_SHARE * robot.leg_length * limit / float(inertia[dof]))
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


def shank_outline(robot: RobotDescription, foot: int) -> Array:
    """Corners of the shank as seen from the side, shape (m, 2): ahead of the ankle and up along the shank [m]."""
    model, data = _upright(robot)
    _, knee, ankle = pitch_joints(robot, foot)
    knee, ankle = (model.joint(name).id for name in (knee, ankle))
    up = data.xanchor[knee] - data.xanchor[ankle]
    up[1] = 0.0
    up /= np.linalg.norm(up)
    ahead = np.array([up[2], 0.0, -up[0]])
    points = []
    for geom in np.flatnonzero((model.geom_bodyid == model.jnt_bodyid[knee]) & (model.geom_contype > 0)):
        local = _corners(model, int(geom))
        world = data.geom_xpos[geom] + local @ data.geom_xmat[geom].reshape(3, 3).T - data.xanchor[ankle]
        points.append(np.column_stack((world @ ahead, world @ up)))
    return np.concatenate(points) if points else np.zeros((0, 2))


def _nearest(robot: RobotDescription, joints: tuple[str, ...], axis: Array) -> str:
    """The one of some joints whose axis is nearest to one in the world, whichever way it points."""
    model, data = _upright(robot)
    return max(joints, key=lambda name: abs(float(data.xaxis[model.joint(name).id] @ axis)))


def _corners(model: mujoco.MjModel, geom: int) -> Array:
    """Points whose hull is a geom or holds it, in its own frame, shape (m, 3) [m]."""
    mesh = model.geom_dataid[geom]
    if mesh >= 0:
        first = model.mesh_vertadr[mesh]
        return np.asarray(model.mesh_vert[first : first + model.mesh_vertnum[mesh]], dtype=np.float64)
    centre, half = model.geom_aabb[geom][:3], model.geom_aabb[geom][3:]
    return np.asarray(centre + half * np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, -1).T)


def _upright(robot: RobotDescription) -> tuple[mujoco.MjModel, mujoco.MjData]:
    return _compiled(robot.mjcf, tuple(robot.straight_joint_positions.tolist()))


@lru_cache(maxsize=8)
def _compiled(mjcf: str, angles: tuple[float, ...]) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """A text with its joints at angles, all kinematics made; nobody may write to it."""
    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    data.qpos[7:] = angles
    mujoco.mj_forward(model, data)
    return model, data
