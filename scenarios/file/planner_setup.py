"""The planner's side of a scenario, in the planner's terms; knows no robot model and no simulator."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from planner.gait import GaitParameters
from planner.parameters import LegInertia, PlannerParameters, StepAdaptation
from planner.planner import WalkingPlanner
from planner.terrain import Terrain
from planner.types import FeetState
from scenarios.file.commands import gait_of, step_region
from scenarios.file.schema import Scenario

if TYPE_CHECKING:
    from models.types import RobotDescription


def square_stance(scenario: Scenario) -> FeetState:
    """Where the feet stand at the start: side by side at the start position and heading."""
    start = scenario.start
    left = 0.5 * scenario.gait.step_width * np.array([-math.sin(start.yaw), math.cos(start.yaw), 0.0])
    origin = np.array([start.x, start.y, 0.0])
    return FeetState(np.array([origin + left, origin - left]), np.full(2, start.yaw), (True, True))


def gait_parameters(scenario: Scenario) -> GaitParameters:
    """The scenario's gait in the planner's terms."""
    return gait_of(scenario.gait)


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
    sole = (robot.sole_length, robot.sole_width)
    region = step_region(parameters, sole)
    gait = gait_of(scenario.gait, region)
    parameters = replace(parameters, reach_width=(region.nearest(0.0), region.width[1]))
    return WalkingPlanner(gait, feet, *sole, terrain, parameters)
