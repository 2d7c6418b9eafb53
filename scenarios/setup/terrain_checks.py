"""Checks of a walk on stairs, slopes and blocks: soles that stand on their faces, and rises that legs can climb."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from surefoot.planner.geometry import sole_corners
from surefoot.planner.ground.terrain import Terrain
from surefoot.planner.types import Array
from surefoot.planner.walk.footsteps import FootstepPlan, plan_footsteps
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.gait import commanded
from surefoot.scenarios.setup.ground import BLOCK_GAP, standing_height, terrain_of
from surefoot.scenarios.setup.planner import gait_parameters, square_stance
from surefoot.scenarios.setup.robot import RobotFacts

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


STEEPEST = 0.35
"""Inclination beyond which no ground is made; the ankle has to turn as far [rad]."""

_FLUSH = 1e-3
"""How far a neighbouring block may rise above the plane of a sole [m]."""

MOST_BLOCKS = 200
"""Blocks of a field, since every look at the ground goes through all of them [-]."""


def rough_problems(scenario: Scenario, facts: RobotFacts) -> list[Problem]:
    """List what makes a slope or a field of blocks impossible for a robot and its gait."""
    kind = scenario.terrain.kind
    if kind not in ("slope", "blocks"):
        return []
    return list(_steepness(scenario)) or list(_extent(scenario, facts)) or list(_face_edges(scenario, facts))


def _steepness(scenario: Scenario) -> Iterator[Problem]:
    terrain = scenario.terrain
    tilt, key = abs(terrain.angle), ("terrain", "angle")
    if terrain.kind == "slope" and tilt == 0.0:
        yield Problem(key, "terrain.angle 0 makes no slope", "use more or less than 0 rad, or kind flat")
    elif terrain.kind == "blocks" and terrain.angle < 0.0:
        yield Problem(key, f"terrain.angle {terrain.angle} rad is no half range", "use at least 0 rad")
    elif tilt > STEEPEST:
        yield Problem(key, f"terrain.angle {terrain.angle} rad is too steep", f"use at most {STEEPEST} rad")
    elif math.tan(tilt) >= terrain.friction:
        what = f"terrain.angle {terrain.angle} rad is steeper than terrain.friction {terrain.friction} holds"
        yield Problem(key, what, f"use less than {math.atan(terrain.friction):.3f} rad, or more friction")


def _extent(scenario: Scenario, facts: RobotFacts) -> Iterator[Problem]:
    terrain, gait = scenario.terrain, scenario.gait
    if terrain.kind == "slope":
        if terrain.height_noise > 0.0:
            what = "terrain.height_noise on a slope, which has one face only"
            yield Problem(("terrain", "height_noise"), what, "use 0, or kind stairs or blocks")
        return
    if gait.velocity:
        what = "gait.velocity on blocks, which are laid under given footsteps"
        yield Problem(("gait", "velocity"), what, "give equal steps or gait.footsteps")
    elif max(gait.steps, len(gait.footsteps)) > MOST_BLOCKS:
        yield Problem(("gait", "steps"), "a field of so many blocks", f"take at most {MOST_BLOCKS} steps")
    elif gait.step_width <= BLOCK_GAP:
        what = f"gait.step_width {gait.step_width} m leaves no width for blocks"
        yield Problem(("gait", "step_width"), what, f"use more than {BLOCK_GAP} m")
    else:
        yield from climb_problems(scenario, facts, risers=2)


def _face_edges(scenario: Scenario, facts: RobotFacts) -> Iterator[Problem]:
    terrain = terrain_of(scenario)
    plan, corners = planned_soles(scenario, facts, terrain)
    margins = terrain.edge_margins(plan.position[:, :2], corners)
    if np.any(plan.normal[:2, 2] < 1.0):
        right = f"use at least {0.5 * facts.foot_length:.3f} m, so that both feet stand level"
        yield Problem(("terrain", "start"), "the walk would start on the slope", right)
        return
    beyond = np.flatnonzero((margins < -1e-9) | (_buried(terrain, plan, corners) > _FLUSH))
    if not len(beyond):
        return
    step = int(beyond[0]) - 1
    who = f"footstep {step}" if step > 0 else "a start foot"
    if scenario.terrain.kind == "slope":
        what = f"{who} would stand across the edge of the slope"
        yield Problem(("terrain", "start"), what, "put the edge between two footsteps, or behind the last one")
        return
    what = f"{who} would not have the whole sole on its block"
    right = f"use more than the foot's {facts.foot_length:g} m and less than the way between two steps of a foot"
    yield Problem(("terrain", "tread"), what, f"{right}, or a wider gait.step_width")


def _buried(terrain: Terrain, plan: FootstepPlan, corners: Array) -> Array:
    """How far the ground is above each sole's plane at the worst of its corners, shape (n + 2,) [m]."""
    heights = terrain.heights(corners.reshape(-1, 2)).reshape(corners.shape[:2])
    tilt = plan.normal[:, :2] / plan.normal[:, 2:]
    offsets = np.einsum("nkj,nj->nk", corners - plan.position[:, None, :2], tilt)
    return np.asarray(np.max(heights - plan.position[:, 2:] + offsets, axis=1))
