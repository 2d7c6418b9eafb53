"""The posture in which a run begins: over its feet, with the start noises, as believed, and pressed into the ground."""

import math

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import wrap_angle
from surefoot.scenarios.setup.robot.body import Body, feet_at
from surefoot.scenarios.setup.walk import Walk
from surefoot.streams import generator
from surefoot.wbc.body.ik import PostureTarget

Array = NDArray[np.float64]

SOLE_SINKAGE = 1.3e-4
"""Depth by which the reference robot's soles sink into the simulated ground under its weight [m]."""


def start_posture(walk: Walk, body: Body) -> Array:
    """Configuration, shape (nq,), that stands with the CoM at its height over the middle of the feet.

    Raises:
        ParameterError: the legs cannot reach that stance.
    """
    feet = walk.ground.stance
    start = walk.start
    height = walk.standing_height
    ground = walk.ground.start_height
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
    rng = generator(walk.seed)
    nv = body.model.nv
    offset = np.zeros(nv)
    offset[:3] = rng.uniform(-start.position_noise, start.position_noise, 3)
    offset[3:] = rng.uniform(-start.angle_noise, start.angle_noise, nv - 3)
    q = pin.integrate(body.model, q, offset)
    feet = feet_at(body, q)
    soles = feet.position.copy()
    soles[:, 2] = walk.ground.start_height
    result = body.ik(q[7:]).solve(PostureTarget(soles, feet.yaw), q)
    if not result.reached:
        raise ParameterError(
            ("start", "angle_noise"),
            f"robot '{body.robot.name}' cannot stand with start.angle_noise {start.angle_noise:g} rad and "
            f"start.position_noise {start.position_noise:g} m: {result.error:.3f} m or rad are missing",
            "reduce them",
        )
    return result.q


def at_believed_start(q: Array, walk: Walk, body: Body) -> Array:
    """The configuration, shape (nq,), in which a robot that only senses takes itself to stand when it stands like q.

    No sensor tells where it is in the world, nor where it looks: the middle and the heading of its feet are those that
    it believes at the start.
    """
    believed, feet = walk.ground.stance, feet_at(body, q)
    turn = -float(np.mean([wrap_angle(yaw) for yaw in feet.yaw - believed.yaw]))
    turned = pin.SE3(pin.utils.rotate("z", turn), np.zeros(3))
    middle = pin.SE3(np.eye(3), believed.position.mean(axis=0))
    base = middle * turned * pin.SE3(np.eye(3), -feet.position.mean(axis=0)) * pin.XYZQUATToSE3(q[:7])
    return np.concatenate((pin.SE3ToXYZQUAT(base), q[7:]))


def pressed(q: Array, length: float = 1.0) -> Array:
    """The configuration, shape (nq,), of a robot of a size [-], sunk in so far that the ground carries it at once."""
    sunk = q.copy()
    sunk[2] -= SOLE_SINKAGE * length
    return sunk
