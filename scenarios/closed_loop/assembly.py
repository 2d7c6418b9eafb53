"""Puts the parts of one run together: world, planner and whole-body controller for a scenario's robot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.types import RobotDescription
from planner.leg_chain import LegChain, Link
from planner.parameters import LegInertia
from planner.planner import WalkingPlanner
from planner.terrain import flat
from scenarios.closed_loop.start_pose import Body, body_of, disturbed, feet_at, pressed, start_posture
from scenarios.file.planner_setup import planner_parameters, walking_planner
from scenarios.file.schema import Scenario
from scenarios.file.timeline import push_time
from sim.pushes import Push
from sim.world import World
from wbc.controller import Sole, WbcParameters, WholeBodyController
from wbc.leg_mass import LinkMass, leg_mass
from wbc.statics import standing_torque

Array = NDArray[np.float64]

LEAST_BELIEVED_FRICTION = 0.05
"""The controller counts on at least this friction, so that its wrench cones keep an inside."""


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
    body, terrain = body_of(robot), flat(scenario.terrain.friction)
    posture = start_posture(scenario, body)
    q = pressed(disturbed(posture, scenario, body))
    world = World(robot, terrain, scenario.rates.physics, pushes(scenario, robot))
    world.reset(q, torque=standing_torque(body.model, body.frames, q))
    controller = WholeBodyController(
        model=body.model,
        frames=body.frames,
        sole=Sole(0.5 * robot.sole_length, 0.5 * robot.sole_width, max(terrain.friction, LEAST_BELIEVED_FRICTION)),
        limits=body.limits,
        posture=posture[7:],
        leg_joints=body.leg_joints,
        control_period=1.0 / scenario.rates.control,
        parameters=WbcParameters(),
    )
    parameters = planner_parameters(scenario, leg_inertia(body, posture))
    return Rig(world, controller, walking_planner(scenario, robot, terrain, feet_at(body, q), parameters))


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
