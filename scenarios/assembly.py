"""Puts the parts of one run together: world, planner and whole-body controller for a scenario's robot."""

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from models.pinocchio import pinocchio_model
from models.types import RobotDescription
from planner.planner import WalkingPlanner
from planner.terrain import flat
from planner.types import FeetState
from scenarios.planner_setup import planner_parameters, square_stance, walking_planner
from scenarios.schema import Scenario
from scenarios.timeline import push_time
from sim.pushes import Push
from sim.world import World
from wbc.controller import Sole, WbcParameters, WholeBodyController
from wbc.ik import PostureIk, PostureTarget
from wbc.leg_mass import leg_mass_ratio
from wbc.limits import JointLimits
from wbc.model import BodyFrames

Array = NDArray[np.float64]

LEAST_BELIEVED_FRICTION = 0.05
"""The controller counts on at least this friction, so that its wrench cones keep an inside."""

_LEG_JOINTS = ("hip", "knee", "ankle")


@dataclass(frozen=True, slots=True)
class Rig:
    """Everything that one run needs.

    Attributes:
        world: the simulated robot, reset to its start.
        controller: the whole-body controller.
        planner: the walking planner.
    """

    world: World
    controller: WholeBodyController
    planner: WalkingPlanner


def assemble(scenario: Scenario, robot: RobotDescription) -> Rig:
    """Build world, controller and planner, with the robot standing at its start.

    Raises:
        ValueError: a part refuses its parameters, e.g. a start posture out of reach; one sentence says which and why.
    """
    model = pinocchio_model(robot)
    frames = BodyFrames(soles=robot.sole_sites, torso=robot.torso_body)
    limits = JointLimits(robot.torque_limit, robot.velocity_limit, robot.position_lower, robot.position_upper)
    terrain = flat(scenario.terrain.friction)
    posture = start_posture(scenario, robot, model, frames, limits)
    q = disturbed(posture, scenario, model, frames)
    world = World(robot, terrain, scenario.rates.physics, pushes(scenario, robot))
    world.reset(q)
    leg_joints = np.array([any(part in name for part in _LEG_JOINTS) for name in robot.joint_names])
    controller = WholeBodyController(
        model=model,
        frames=frames,
        sole=Sole(0.5 * robot.sole_length, 0.5 * robot.sole_width, max(terrain.friction, LEAST_BELIEVED_FRICTION)),
        limits=limits,
        posture=posture[7:],
        leg_joints=leg_joints,
        control_period=1.0 / scenario.rates.control,
        parameters=WbcParameters(),
    )
    parameters = planner_parameters(scenario, leg_mass_ratio(model, frames, posture, leg_joints))
    return Rig(world, controller, walking_planner(scenario, robot, terrain, feet_at(model, frames, q), parameters))


def pushes(scenario: Scenario, robot: RobotDescription) -> tuple[Push, ...]:
    """The scenario's pushes with their times and bodies resolved; a push without a body acts on the torso."""
    return tuple(
        Push(push_time(scenario.gait, p), p.duration, np.array(p.force), p.body or robot.torso_body)
        for p in scenario.pushes
    )


def start_posture(
    scenario: Scenario, robot: RobotDescription, model: pin.Model, frames: BodyFrames, limits: JointLimits
) -> Array:
    """Configuration, shape (nq,), that stands with the CoM at its height over the middle of the feet.

    Raises:
        ValueError: if the legs cannot reach that stance.
    """
    feet, start, height = square_stance(scenario), scenario.start, scenario.gait.com_height
    target = PostureTarget(feet.position, feet.yaw, np.array([start.x, start.y, height]), start.yaw)
    q = pin.neutral(model)
    q[:3] = start.x, start.y, robot.leg_length
    q[3:7] = 0.0, 0.0, math.sin(0.5 * start.yaw), math.cos(0.5 * start.yaw)
    q[7:] = robot.nominal_joint_positions
    result = PostureIk(model, frames, limits, robot.nominal_joint_positions).solve(target, q)
    if not result.reached:
        raise ValueError(
            f"robot '{robot.name}' cannot stand with gait.com_height {height:g} m and gait.step_width "
            f"{scenario.gait.step_width:g} m, {result.error:.3f} m are missing; "
            f"use for example {robot.com_height:g} m and {robot.hip_width:g} m"
        )
    return result.q


def disturbed(q: Array, scenario: Scenario, model: pin.Model, frames: BodyFrames) -> Array:
    """The posture, shape (nq,), with the start noises; no sole corner is left below the ground it stood on."""
    start = scenario.start
    if start.position_noise == 0.0 and start.angle_noise == 0.0:
        return q
    rng = np.random.default_rng(scenario.seed)
    offset = np.zeros(model.nv)
    offset[:3] = rng.uniform(-start.position_noise, start.position_noise, 3)
    offset[3:] = rng.uniform(-start.angle_noise, start.angle_noise, model.nv - 3)
    q = pin.integrate(model, q, offset)
    q[2] -= min(0.0, float(_sole_placements(model, frames, q)[0][:, 2].min()))
    return q


def feet_at(model: pin.Model, frames: BodyFrames, q: Array) -> FeetState:
    """Soles of a standing configuration, shape (nq,)."""
    position, rotation = _sole_placements(model, frames, q)
    return FeetState(position, np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0]), (True, True))


def _sole_placements(model: pin.Model, frames: BodyFrames, q: Array) -> tuple[Array, Array]:
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    placements = [data.oMf[model.getFrameId(name)] for name in frames.soles]
    return np.array([p.translation for p in placements]), np.array([p.rotation for p in placements])
