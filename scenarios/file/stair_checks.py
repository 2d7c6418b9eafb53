"""Checks of a walk on stairs: soles that stand on their treads, and risers that legs can climb."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from planner.footsteps import FootstepPlan, plan_footsteps
from planner.polygon import sole_corners
from planner.terrain import Terrain
from planner.types import Array
from scenarios.errors import Problem
from scenarios.file.commands import commanded
from scenarios.file.ground import terrain_of
from scenarios.file.height import standing_height
from scenarios.file.planner_setup import gait_parameters, square_stance
from scenarios.file.robots import RobotFacts
from scenarios.file.schema import Scenario

FOLDED = 0.5
"""Length of a leg with a deeply bent knee over its length with a straight one [-]."""

MOST_STEPS = 2000
"""Footsteps that are looked at; those after the last stair stand on its platform [-]."""


def stair_problems(scenario: Scenario, facts: RobotFacts) -> list[Problem]:
    """List what makes a staircase impossible for a robot and its gait."""
    if scenario.terrain.kind != "stairs":
        return []
    if scenario.gait.velocity:
        what = "gait.velocity on stairs, whose treads its footsteps would not meet"
        return [Problem(("gait", "velocity"), what, "give equal steps or gait.footsteps")]
    return list(_geometry(scenario)) or list(climb_problems(scenario, facts)) or list(_edges(scenario, facts))


def _geometry(scenario: Scenario) -> Iterator[Problem]:
    terrain = scenario.terrain
    if terrain.riser == 0.0:
        yield Problem(("terrain", "riser"), "terrain.riser 0 makes no stairs", "use more than 0 m, or kind flat")
    elif terrain.height_noise >= terrain.riser:
        what = f"terrain.height_noise {terrain.height_noise} m may swallow risers of {terrain.riser} m"
        yield Problem(("terrain", "height_noise"), what, "use less than terrain.riser")


def climb_problems(scenario: Scenario, facts: RobotFacts, risers: int = 1) -> Iterator[Problem]:
    """List a terrain.riser of which a step goes up so many at once, which the legs cannot.

    The hips are at their height above the lower foot while the other leg folds on the tread above.
    """
    hips = standing_height(scenario) - facts.com_above_hip
    highest = (hips - FOLDED * facts.leg_length) / risers
    if scenario.terrain.riser > highest:
        what = f"terrain.riser {scenario.terrain.riser} m is out of reach of legs {facts.leg_length:.3f} m long"
        yield Problem(("terrain", "riser"), what, f"use at most {highest:.3f} m")


def planned_soles(scenario: Scenario, facts: RobotFacts, terrain: Terrain) -> tuple[FootstepPlan, Array]:
    """The footsteps, and the corners of their soles, start feet first, shape (n + 2, 4, 2) [m]."""
    gait = gait_parameters(scenario)
    if not commanded(scenario.gait):
        gait = replace(gait, steps=min(gait.steps, MOST_STEPS))
    plan = plan_footsteps(gait, square_stance(scenario), terrain)
    half_size = 0.5 * np.array([facts.foot_length, facts.foot_width])
    soles = [plan.footstep(row) for row in range(plan.steps + 2)]
    return plan, np.array([sole_corners(sole, half_size) for sole in soles])


def _edges(scenario: Scenario, facts: RobotFacts) -> Iterator[Problem]:
    terrain = terrain_of(scenario)
    plan, corners = planned_soles(scenario, facts, terrain)
    margins = terrain.edge_margins(plan.position[:, :2], corners)
    beyond = np.flatnonzero(margins < -1e-9)
    if not len(beyond):
        return
    over = -float(margins[beyond[0]])
    if beyond[0] < 2:
        what = f"the feet would start {over:.3f} m over the edge of the first stair"
        yield Problem(("terrain", "start"), what, f"use at least {0.5 * facts.foot_length:.3f} m")
        return
    what = f"footstep {beyond[0] - 1} would stand {over:.3f} m over the edge of its tread"
    right = "give gait.step_length the depth of terrain.tread, and a tread longer than the foot"
    yield Problem(("terrain", "tread"), what, right)
