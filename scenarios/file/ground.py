"""The ground of a scenario: what the planner believes of it, and what is there."""

from dataclasses import replace

import numpy as np

from planner.stairs import Direction, Stairs, staircase
from planner.terrain import Box, Terrain, flat
from scenarios.file.commands import commanded, gait_of
from scenarios.file.schema import Gait, Scenario

LANDING_TREADS = 3
"""Depth of a landing whose depth is not given, in treads: the gait keeps its rhythm on it."""

MOST_BEHIND = 0.03
"""How far behind mid-tread a foot stands at most: shanks lean forward and must not touch the edge ahead [m]."""

PLATFORM = 1.0
"""Level ground kept before the first and after the last footstep on a platform of stairs [m]."""


def terrain_of(scenario: Scenario) -> Terrain:
    """The ground as the planner believes it to be."""
    settings = scenario.terrain
    if settings.kind != "stairs":
        return flat(settings.friction)
    start = scenario.start
    return staircase(stairs_of(scenario), np.array([start.x, start.y]), start.yaw, settings.friction)


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


def start_height(scenario: Scenario) -> float:
    """Height of the ground on which the robot starts [m]."""
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


def _behind(scenario: Scenario) -> float:
    """How far behind mid-tread the feet stand: half of the room there, if the scenario says how long they are [m]."""
    foot = scenario.robot_options.foot_length
    return 0.0 if foot is None else min(MOST_BEHIND, max(0.0, 0.25 * (scenario.terrain.tread - foot)))


def _way(gait: Gait) -> float:
    """Way that the steps go at most [m]."""
    if not commanded(gait):
        return gait.steps * abs(gait.step_length)
    return sum(abs(stride.length) for stride in gait_of(gait).strides)


def _raised(box: Box, height: float) -> Box:
    up = np.array([0.0, 0.0, 0.5 * height])
    return replace(box, center=box.center + up, half_size=box.half_size + up)
