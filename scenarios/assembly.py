"""Puts the parts of one run together: world, planner and whole-body controller for a scenario's robot."""

import math
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from models.pinocchio import pinocchio_model
from models.types import RobotDescription
from planner.gait import GaitParameters
from planner.parameters import LegInertia, PlannerParameters, StepAdaptation
from planner.planner import WalkingPlanner
from planner.terrain import Terrain, flat
from planner.types import FeetState
from scenarios.schema import Scenario
from scenarios.timeline import push_time
from sim.pushes import Push
from sim.world import World
from wbc.controller import Sole, WbcParameters, WholeBodyController
from wbc.ik import PostureIk, PostureTarget
from wbc.leg_mass import leg_mass
from wbc.limits import JointLimits
from wbc.model import BodyFrames
from wbc.statics import standing_torque

Array = NDArray[np.float64]

LEAST_BELIEVED_FRICTION = 0.05
"""The controller counts on at least this friction, so that its wrench cones keep an inside."""

SOLE_SINKAGE = 5e-5
"""How far the soles sink into the simulated ground under the robot's weight [m]."""

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
    q = pressed(disturbed(posture, scenario, robot, model, frames, limits))
    world = World(robot, terrain, scenario.rates.physics, pushes(scenario, robot))
    world.reset(q, torque=standing_torque(model, frames, q))
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
    parameters = planner_parameters(scenario, leg_inertia(model, frames, posture, leg_joints))
    return Rig(world, controller, walking_planner(scenario, robot, terrain, feet_at(model, frames, q), parameters))


def walking_planner(
    scenario: Scenario, robot: RobotDescription, terrain: Terrain, feet: FeetState, parameters: PlannerParameters
) -> WalkingPlanner:
    """The planner of a scenario for start feet."""
    return WalkingPlanner(gait_parameters(scenario), feet, robot.sole_length, robot.sole_width, terrain, parameters)


def gait_parameters(scenario: Scenario) -> GaitParameters:
    """The scenario's gait in the planner's terms."""
    gait = scenario.gait
    return GaitParameters(
        steps=gait.steps,
        step_length=gait.step_length,
        step_width=gait.step_width,
        lateral_step=gait.lateral_step,
        turn=gait.turn,
        single_support=gait.single_support,
        double_support=gait.double_support,
        swing_height=gait.swing_height,
        com_height=gait.com_height,
        initial_stand=gait.initial_stand,
        apex_ss=gait.apex_single,
        apex_ds=gait.apex_double,
    )


def planner_parameters(scenario: Scenario, leg: LegInertia) -> PlannerParameters:
    """The scenario's planner settings in the planner's terms; a pendulum has legs without inertia."""
    settings = scenario.planner
    return PlannerParameters(
        sample_time=settings.sample_time,
        horizon=settings.horizon,
        jerk_limit=settings.jerk_limit,
        jerk_rate_limit=math.inf if settings.jerk_rate_limit is None else settings.jerk_rate_limit,
        leg=leg,
        step_adaptation=StepAdaptation(settings.step_adaptation),
    )


def leg_inertia(model: pin.Model, frames: BodyFrames, q: Array, leg_joints: Array) -> LegInertia:
    """The robot's legs as the planner sees them, from its start posture q, shape (nq,)."""
    leg = leg_mass(model, frames, q, leg_joints)
    return LegInertia(leg.ratio, leg.lever)


def pushes(scenario: Scenario, robot: RobotDescription) -> tuple[Push, ...]:
    """The scenario's pushes with their times and bodies resolved; a push without a body acts on the torso."""
    return tuple(
        Push(push_time(scenario.gait, p), p.duration, np.array(p.force), p.body or robot.torso_body)
        for p in scenario.pushes
    )


def square_stance(scenario: Scenario) -> FeetState:
    """Where the feet stand at the start: side by side at the start position and heading."""
    start = scenario.start
    left = 0.5 * scenario.gait.step_width * np.array([-math.sin(start.yaw), math.cos(start.yaw), 0.0])
    origin = np.array([start.x, start.y, 0.0])
    return FeetState(np.array([origin + left, origin - left]), np.full(2, start.yaw), (True, True))


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
            f"{scenario.gait.step_width:g} m: {result.error:.3f} m are missing; lower the CoM or narrow the stance"
        )
    return result.q


def disturbed(
    q: Array, scenario: Scenario, robot: RobotDescription, model: pin.Model, frames: BodyFrames, limits: JointLimits
) -> Array:
    """The posture, shape (nq,), with the start noises on base position, base attitude and every joint.

    The legs then give way until both soles, wherever the noise has put and turned them, lie flat on the ground.

    Raises:
        ValueError: if they cannot.
    """
    start = scenario.start
    if start.position_noise == 0.0 and start.angle_noise == 0.0:
        return q
    rng = np.random.default_rng(scenario.seed)
    offset = np.zeros(model.nv)
    offset[:3] = rng.uniform(-start.position_noise, start.position_noise, 3)
    offset[3:] = rng.uniform(-start.angle_noise, start.angle_noise, model.nv - 3)
    q = pin.integrate(model, q, offset)
    feet = feet_at(model, frames, q)
    soles = feet.position * np.array([1.0, 1.0, 0.0])
    result = PostureIk(model, frames, limits, q[7:]).solve(PostureTarget(soles, feet.yaw), q)
    if not result.reached:
        raise ValueError(
            f"robot '{robot.name}' cannot stand with start.angle_noise {start.angle_noise:g} rad and "
            f"start.position_noise {start.position_noise:g} m: {result.error:.3f} m or rad are missing; reduce them"
        )
    return result.q


def pressed(q: Array) -> Array:
    """The configuration, shape (nq,), sunk in so far that the ground carries it from the first instant."""
    sunk = q.copy()
    sunk[2] -= SOLE_SINKAGE
    return sunk


def feet_at(model: pin.Model, frames: BodyFrames, q: Array) -> FeetState:
    """Soles of a standing configuration, shape (nq,)."""
    position, rotation = _sole_placements(model, frames, q)
    return FeetState(position, np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0]), (True, True))


def _sole_placements(model: pin.Model, frames: BodyFrames, q: Array) -> tuple[Array, Array]:
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    placements = [data.oMf[model.getFrameId(name)] for name in frames.soles]
    return np.array([p.translation for p in placements]), np.array([p.rotation for p in placements])
