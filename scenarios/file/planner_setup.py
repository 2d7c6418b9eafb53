"""The planner's side of a scenario, in the planner's terms; knows no robot model and no simulator."""

import math
from typing import TYPE_CHECKING

import numpy as np

from planner.gait import GaitParameters
from planner.parameters import LegInertia, PlannerParameters, StepAdaptation
from planner.planner import WalkingPlanner
from planner.terrain import Terrain
from planner.types import FeetState
from scenarios.file.ground import start_height
from scenarios.file.height import height_profile
from scenarios.file.schema import Scenario

if TYPE_CHECKING:
    from models.types import RobotDescription


def square_stance(scenario: Scenario) -> FeetState:
    """Where the feet stand at the start: side by side at the start position and heading, on the ground there."""
    start = scenario.start
    left = 0.5 * scenario.gait.step_width * np.array([-math.sin(start.yaw), math.cos(start.yaw), 0.0])
    origin = np.array([start.x, start.y, start_height(scenario)])
    return FeetState(np.array([origin + left, origin - left]), np.full(2, start.yaw), (True, True))


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
    """The scenario's planner settings in the planner's terms; a pendulum's legs have no inertia."""
    settings = scenario.planner
    return PlannerParameters(
        sample_time=settings.sample_time,
        horizon=settings.horizon,
        jerk_limit=settings.jerk_limit,
        jerk_rate_limit=math.inf if settings.jerk_rate_limit is None else settings.jerk_rate_limit,
        leg=leg,
        step_adaptation=StepAdaptation(settings.step_adaptation),
    )


def walking_planner(
    scenario: Scenario, robot: "RobotDescription", terrain: Terrain, feet: FeetState, parameters: PlannerParameters
) -> WalkingPlanner:
    """The planner of a scenario for start feet.

    Raises:
        ValueError: it cannot plan this gait; one sentence says why.
    """
    sole, gait = (robot.sole_length, robot.sole_width), gait_parameters(scenario)
    return WalkingPlanner(gait, feet, *sole, terrain, parameters, height_profile(scenario))
