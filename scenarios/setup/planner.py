"""The planner's side of a scenario, in the planner's terms; knows no robot model and no simulator."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.parameters import LegInertia, PlannerParameters, StepAdaptation
from surefoot.planner.plan import Planner
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.types import FeetState
from surefoot.planner.walk.gait import GaitParameters
from surefoot.scenarios.file.schema import Gait, Scenario
from surefoot.scenarios.setup.gait import commanded, gait_of, longest_landing, step_region
from surefoot.scenarios.setup.ground import height_profile, landing_search, start_height

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription


SHORTEST_REACH, LONGEST_REACH = 0.4, 0.8
"""Least and greatest bound on how far ahead of its stance foot a footstep may be planned, whatever the gait [m]."""


def square_stance(scenario: Scenario) -> FeetState:
    """Where the feet stand at the start: side by side at the start position and heading, on the ground there."""
    start = scenario.start
    left = 0.5 * scenario.gait.step_width * np.array([-math.sin(start.yaw), math.cos(start.yaw), 0.0])
    origin = np.array([start.x, start.y, start_height(scenario)])
    return FeetState(np.array([origin + left, origin - left]), np.full(2, start.yaw), (True, True))


def gait_parameters(scenario: Scenario) -> GaitParameters:
    """The scenario's gait in the planner's terms."""
    return gait_of(scenario.gait)


def planner_profile(scenario: Scenario) -> Profile:
    """The formulation that the scenario asks for."""
    profile: Profile = PROFILES[scenario.planner.profile]
    return profile


def step_reach(gait: Gait) -> float:
    """How far ahead of its stance foot the planner may place a footstep: a decimetre beyond the gait's own [m]."""
    own = longest_landing(gait) if commanded(gait) else abs(gait.step_length)
    return min(max(own + 0.1, SHORTEST_REACH), LONGEST_REACH)


def planner_parameters(scenario: Scenario, leg: LegInertia) -> PlannerParameters:
    """The profile's parameters with what the scenario changes of them; a pendulum's legs have no inertia."""
    settings = scenario.planner
    chosen: dict[str, Any] = {
        "horizon": settings.horizon,
        "moves": None if settings.control_horizon is None else tuple(range(settings.control_horizon)),
        "jerk_limit": settings.jerk_limit,
        "jerk_rate_limit": settings.jerk_rate_limit,
        "search": landing_search(scenario),
    }
    return replace(
        planner_profile(scenario).parameters,
        sample_time=settings.sample_time,
        leg=leg,
        reach_length=step_reach(scenario.gait),
        step_adaptation=StepAdaptation(settings.step_adaptation),
        **{name: value for name, value in chosen.items() if value is not None},
    )


def walking_planner(
    scenario: Scenario, robot: "RobotDescription", terrain: Terrain, feet: FeetState, parameters: PlannerParameters
) -> Planner:
    """The planner of a scenario for start feet; its adaptation leaves at least half the planned gap between soles.

    Raises:
        ValueError: it cannot plan this gait; one sentence says why.
    """
    sole = (robot.sole_length, robot.sole_width)
    region = step_region(parameters, sole)
    gait = gait_of(scenario.gait, region)
    near, far = parameters.reach_width
    adapting = replace(parameters, reach_width=(max(near, robot.sole_width + 0.5 * region.gap), far))
    profile = planner_profile(scenario)
    make = profile.planner or WalkingPlanner
    return make(gait, feet, *sole, terrain, adapting, height_profile(scenario), profile)
