"""The ground of a scenario, as the planner believes it to be and as it is, and the CoM height over it."""

import math
from dataclasses import replace

import numpy as np

from surefoot.planner.ground.blocks import Blocks
from surefoot.planner.ground.slope import Slope
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Box, Site, Terrain, flat
from surefoot.planner.parameters import GroundSearch, PlannerParameters
from surefoot.planner.references.com_height import (
    BENT_KNEES,
    BentKneeHeight,
    HeightProfile,
    PaperHeight,
    Rise,
    SmoothHeight,
)
from surefoot.planner.types import FeetState
from surefoot.planner.walk.footsteps import FootstepPlan, plan_footsteps
from surefoot.scenarios.file.schema import Gait, Scenario
from surefoot.scenarios.setup.gait import commanded, gait_of

LANDING_TREADS = 3
"""Depth of a landing whose depth is not given, in treads: the gait keeps its rhythm on it."""

MOST_BEHIND = 0.03
"""How far behind mid-tread a foot stands at most: shanks lean forward and must not touch the edge ahead [m]."""

BLOCK_GAP = 0.02
"""Between blocks for the left and the right foot [m]."""

_STREAM = 2
"""Random numbers of the blocks, apart from those of other things with the same seed."""

HEEL_ROOM = 0.015
"""Distance of the heel from the riser behind it on the way down [m]."""

PLATFORM = 1.0
"""Level ground kept before the first and after the last footstep on a platform of stairs [m]."""


def terrain_of(scenario: Scenario) -> Terrain:
    """The ground as the planner believes it to be."""
    settings, start = scenario.terrain, scenario.start
    origin = np.array([start.x, start.y])
    site = Site(origin, start.yaw, settings.friction, lambda: _footsteps(scenario), _random(scenario))
    if settings.kind == "stairs":
        return stairs_of(scenario).build(site)
    if settings.kind == "slope":
        return slope_of(scenario).build(site)
    if settings.kind == "blocks":
        return blocks_of(scenario).build(site)
    return flat(settings.friction)


def true_terrain_of(scenario: Scenario) -> Terrain:
    """The ground as it is: every tread higher or lower than believed, by the seed; where the robot starts is known."""
    terrain, noise = terrain_of(scenario), scenario.terrain.height_noise
    if noise == 0.0:
        return terrain
    start = np.array([[scenario.start.x, scenario.start.y]])
    errors = np.random.default_rng(scenario.seed).uniform(-noise, noise, len(terrain.boxes))
    boxes = [
        box if box.top(start)[1][0] >= 0.0 else _raised(box, error)
        for box, error in zip(terrain.boxes, errors, strict=True)
    ]
    return replace(terrain, boxes=tuple(boxes))


def landing_search(scenario: Scenario) -> GroundSearch:
    """How a swing foot that has not felt the ground goes on downwards.

    Where the ground has steps its heights are believed less: a foot that finds no tread by the end of single support
    hurries after one that lies lower, since waiting for it costs balance.
    """
    stepped = scenario.terrain.kind in ("stairs", "blocks")
    return GroundSearch(hurry_after=PlannerParameters().touchdown_lead) if stepped else GroundSearch()


def start_height(scenario: Scenario) -> float:
    """Height of the ground on which the robot starts [m]."""
    if scenario.terrain.kind == "blocks":
        return blocks_of(scenario).middle
    return terrain_of(scenario).height(scenario.start.x, scenario.start.y)


def stairs_of(scenario: Scenario) -> Stairs:
    """The staircase of a scenario, from the middle of the start feet along the start heading."""
    settings, gait = scenario.terrain, scenario.gait
    fitted = gait.step_length - 0.5 * settings.tread + _behind(scenario)
    return Stairs(
        riser=settings.riser,
        tread=settings.tread,
        count=settings.count,
        direction=Direction(settings.direction),
        start=fitted if settings.start is None else settings.start,
        landing=LANDING_TREADS * settings.tread if settings.landing is None else settings.landing,
        beyond=_way(gait) + PLATFORM,
    )


def slope_of(scenario: Scenario) -> Slope:
    """The slope of a scenario, along the start heading; by default its edge is half a step ahead of the start."""
    settings, gait = scenario.terrain, scenario.gait
    start = 0.5 * gait.step_length if settings.start is None else settings.start
    return Slope(settings.angle, start, _way(gait) + PLATFORM, PLATFORM)


def blocks_of(scenario: Scenario) -> Blocks:
    """The blocks of a scenario; left and right ones stand side by side with a gap between them."""
    settings = scenario.terrain
    return Blocks(settings.riser, settings.angle, settings.tread, scenario.gait.step_width - BLOCK_GAP)


def _footsteps(scenario: Scenario) -> FootstepPlan:
    """The footsteps of a scenario on level ground."""
    start = scenario.start
    left = 0.5 * scenario.gait.step_width * np.array([-math.sin(start.yaw), math.cos(start.yaw), 0.0])
    origin = np.array([start.x, start.y, 0.0])
    feet = FeetState(np.array([origin + left, origin - left]), np.full(2, start.yaw), (True, True))
    return plan_footsteps(gait_of(scenario.gait), feet, flat())


def _random(scenario: Scenario) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(scenario.seed, spawn_key=(_STREAM,)))


def _behind(scenario: Scenario) -> float:
    """How far behind mid-tread the feet stand: half of the room there, if the scenario says how long they are [m].

    Going down the heel also keeps its distance from the riser behind it, or the swing would have to go over that.
    """
    foot = scenario.robot_options.foot_length
    if foot is None:
        return 0.0
    room = 0.5 * (scenario.terrain.tread - foot)
    behind = min(MOST_BEHIND, max(0.0, 0.5 * room))
    return behind if scenario.terrain.direction != "down" else min(behind, max(0.0, room - HEEL_ROOM))


def _way(gait: Gait) -> float:
    """Way that the steps go at most [m]."""
    if not commanded(gait):
        return gait.steps * abs(gait.step_length)
    return sum(abs(stride.length) for stride in gait_of(gait).strides)


def _raised(box: Box, height: float) -> Box:
    up = np.array([0.0, 0.0, 0.5 * height])
    return replace(box, center=box.center + up, half_size=box.half_size + up)


def height_profile(scenario: Scenario) -> HeightProfile:
    """The height law: where the CoM climbs follows from the fidelity unless the scenario says it.

    The paper's profile has the paper's own law, in double support and with its jumps. A pendulum can do what the paper
    does, and climbs in double support; legs cannot, and climb in single support.
    """
    if scenario.planner.profile == "paper" and scenario.planner.knee == "stretched":
        return PaperHeight()
    place = scenario.planner.rise or ("double" if scenario.fidelity == "pendulum" else "single")
    rise = Rise(place)
    return BentKneeHeight(rise) if scenario.planner.knee == "bent" else SmoothHeight(rise)


def standing_height(scenario: Scenario) -> float:
    """CoM height over the soles at which the walk begins and ends [m]."""
    return scenario.gait.com_height - (BENT_KNEES if scenario.planner.knee == "bent" else 0.0)


def start_com_height(scenario: Scenario) -> float:
    """CoM height in the world at the start [m]."""
    return start_height(scenario) + standing_height(scenario)
