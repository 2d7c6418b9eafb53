"""Puts the parts of one run together: world, planner and whole-body controller for a scenario's robot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.belief import with_com_raised, with_mass_scaled
from models.pinocchio import limb_shapes, pinocchio_model
from models.types import RobotDescription
from planner.leg_chain import LegChain, Link
from planner.parameters import LegInertia
from planner.planner import WalkingPlanner
from scenarios.closed_loop.start_pose import Body, body_of, disturbed, feet_at, pressed, start_posture
from scenarios.file.ground import terrain_of, true_terrain_of
from scenarios.file.planner_setup import planner_parameters, walking_planner
from scenarios.file.schema import BeliefErrors, Scenario
from scenarios.file.timeline import push_time
from sim.pushes import Push
from sim.world import World
from wbc.controller import Sole, WbcParameters, WholeBodyController
from wbc.leg_mass import LinkMass, leg_mass
from wbc.model import RobotTerms
from wbc.statics import standing_torque

Array = NDArray[np.float64]

LEAST_BELIEVED_FRICTION = 0.05
"""The controller counts on at least this friction, so that its wrench cones keep an inside."""


@dataclass(frozen=True, slots=True)
class Rig:
    """Everything that one run needs.

    Attributes:
        world: the simulated robot, reset to its start.
        truth: terms of the simulated robot, for the record; the controller's own when its model is right.
        controller: the whole-body controller.
        planner: the walking planner.
    """

    world: World
    truth: RobotTerms
    controller: WholeBodyController
    planner: WalkingPlanner


def assemble(scenario: Scenario, robot: RobotDescription) -> Rig:
    """Build world, controller and planner, with the robot standing at its start.

    Controller and planner believe in the robot as described; the simulated one differs by the scenario's errors.

    Raises:
        ValueError: a part refuses its parameters, e.g. a start posture out of reach; one sentence says which and why.
    """
    body, terrain = body_of(robot), terrain_of(scenario)
    posture = start_posture(scenario, body)
    q = pressed(disturbed(posture, scenario, body))
    actual = true_robot(scenario.errors, robot)
    world = World(actual, true_terrain_of(scenario), scenario.rates.physics, pushes(scenario, robot))
    world.reset(q, torque=standing_torque(body.model, body.frames, q))
    controller = WholeBodyController(
        model=body.model,
        frames=body.frames,
        sole=Sole(0.5 * robot.sole_length, 0.5 * robot.sole_width, believed_friction(scenario)),
        limits=body.limits,
        posture=posture[7:],
        leg_joints=body.leg_joints,
        control_period=1.0 / scenario.rates.control,
        parameters=WbcParameters(),
        limbs=limb_shapes(robot, body.model),
    )
    parameters = planner_parameters(scenario, leg_inertia(body, posture))
    truth = controller.terms if actual is robot else RobotTerms(pinocchio_model(actual), body.frames)
    return Rig(world, truth, controller, walking_planner(scenario, robot, terrain, feet_at(body, q), parameters))


def true_robot(errors: BeliefErrors, robot: RobotDescription) -> RobotDescription:
    """The robot as it is; itself when nothing about its mass is believed wrongly."""
    if errors.com_height != 0.0:
        robot = with_com_raised(robot, -errors.com_height)
    if errors.mass_scale != 1.0:
        robot = with_mass_scaled(robot, 1.0 / errors.mass_scale)
    return robot


def believed_friction(scenario: Scenario) -> float:
    """Friction coefficient that the controller counts on."""
    return max(scenario.terrain.friction + scenario.errors.friction, LEAST_BELIEVED_FRICTION)


def leg_inertia(body: Body, q: Array) -> LegInertia:
    """The robot's legs as the planner sees them, from its start posture q, shape (nq,)."""
    leg = leg_mass(body.model, body.frames, q, body.leg_joints)
    chain = LegChain(
        hip_half_width=leg.hip_half_width,
        trunk=leg.trunk,
        thigh=_link(leg.thigh),
        shank=_link(leg.shank),
        foot_mass=leg.foot_mass,
        foot_centre=leg.foot_centre,
        ankle=leg.ankle,
    )
    return LegInertia(leg.ratio, chain)


def _link(link: LinkMass) -> Link:
    return Link(link.length, link.mass, link.centre, link.inertia)


def pushes(scenario: Scenario, robot: RobotDescription) -> tuple[Push, ...]:
    """The scenario's pushes with their times and bodies resolved; a push without a body acts on the torso."""
    return tuple(
        Push(push_time(scenario.gait, p), p.duration, np.array(p.force), p.body or robot.torso_body)
        for p in scenario.pushes
    )
