"""A walk of a robot of another size is the same walk: lengths times λ, times times √λ, at every tick."""

import math
from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import walk_pendulum

from surefoot.forces import Push
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.com_height import Rise, SmoothHeight
from surefoot.planner.steps.commands import Command
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import FeetState, Twist
from surefoot.similarity import REFERENCE_SIZE, Similarity

pytestmark = pytest.mark.unit

QUARTER = Similarity(0.25, 0.25**3)
"""Lengths a quarter, times a half: powers of two, so that not even rounding differs."""

QUARTER_PARAMETERS = QUARTER.scaled(PROFILES["default"].parameters)
LENGTHS = ("step_length", "step_width", "lateral_step", "swing_height", "com_height", "apex_ss", "apex_ds")
TIMES = ("single_support", "double_support", "initial_stand")


def walked(size, profile="default", push=0.0, ahead=0.0, place=None, stairs=False, parameters=None, **keys):
    """The trace of a short walk of a robot of this size; all numbers are those of full size."""
    length, time = size.length, size.time
    given = {
        "steps": 2,
        "single_support": 0.4,
        "double_support": 0.16,
        "initial_stand": 0.06,
        "swing_height": 0.06,
    } | keys
    full = GaitParameters(**given)
    gait = replace(
        full,
        **{name: length * getattr(full, name) for name in LENGTHS},
        **{name: time * getattr(full, name) for name in TIMES},
    )
    position = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]) * length
    feet = FeetState(position, np.zeros(2), (True, True))
    # An arm of the force per mass is a length over a time squared: gravity's own, the same for all.
    legs = LegReach(0.36 * length, 0.2 * length, 0.115 * length, 0.12 * length, 0.24 * length, (60.0, 50.0))
    climb = Stairs(0.1, 0.3, 3, Direction.UP, 0.15, 0.9, 2.0)
    lengths = {name: length * getattr(climb, name) for name in ("riser", "tread", "start", "landing", "beyond")}
    terrain = replace(climb, **lengths).build(Site(np.zeros(2), 0.0, 0.8)) if stairs else None
    heights = SmoothHeight(Rise.SINGLE)
    parameters = parameters or size.scaled(PROFILES[profile].parameters)
    parameters = replace(parameters, reach_length=0.7 * length)
    planner = WalkingPlanner(
        gait, feet, 0.22 * length, 0.11 * length, terrain, parameters, heights, PROFILES[profile], None, legs
    )
    if place is not None:
        planner.command(Command(places=(Twist(*(length * np.array(place[:2])).tolist(), place[2]),)))
    # The pendulum is as heavy at all sizes; what counts is the force per mass.
    pushes = (Push(0.5 * time, 0.1 * time, 100.0 * np.array([ahead, push, 0.0])),)
    com = np.array([0.0, 0.0, gait.com_height])
    return walk_pendulum(planner, feet, 1.3 * time, com=com, pushes=pushes, substeps=1)


STORIES = {
    "walk": {"step_length": 0.3},
    "heel-off": {"step_length": 0.5, "heel_off": 0.5},
    "push": {"step_length": 0.2, "push": 4.0},
    "push ahead": {"step_length": 0.2, "ahead": 6.0},
    "stand": {"steps": 0, "push": 6.0},
    "place": {"steps": 0, "step_length": 0.2, "place": (0.5, 0.1, 0.4)},
    "near place": {"steps": 0, "step_length": 0.2, "place": (0.02, 0.0, 0.0)},
    "stairs": {"step_length": 0.3, "stairs": True},
    **{
        profile: {"step_length": 0.1, "double_support": 0.4, "profile": profile}
        for profile in PROFILES
        if profile not in ("default", "paper")  # the stories before are of the one, and the other falls
    },
}


@pytest.mark.parametrize("story", STORIES)
def test_a_small_robot_walks_the_same_walk_scaled(story):
    full, small = (walked(size, **STORIES[story]) for size in (REFERENCE_SIZE, QUARTER))
    assert full.fall_time is None and small.fall_time is None
    for name, factor in (("time", QUARTER.time), ("com", 0.25), ("zmp", 0.25), ("zmp_reference", 0.25)):
        np.testing.assert_allclose(getattr(small, name), factor * getattr(full, name), rtol=1e-9, atol=1e-9 * factor)
    for ours, theirs in zip(small.plans, full.plans, strict=True):
        places, others = ([step.position for step in plan.footsteps] for plan in (ours, theirs))
        np.testing.assert_allclose(places, 0.25 * np.array(others), rtol=1e-9, atol=1e-9)
        assert ours.phase.left == pytest.approx(QUARTER.time * theirs.phase.left, rel=1e-9, abs=1e-9)
        if theirs.swing is not None:
            way, other = ours.swing.evaluate(ours.time)[0], theirs.swing.evaluate(theirs.time)[0]
            np.testing.assert_allclose(way[:3], 0.25 * other[:3], rtol=1e-9, atol=1e-9)


def test_one_number_of_the_reference_is_enough_to_tell():
    full = walked(REFERENCE_SIZE, **STORIES["push"])
    small = walked(QUARTER, **STORIES["push"], parameters=replace(QUARTER_PARAMETERS, jerk_weight=1e-6))
    assert not np.allclose(small.com, 0.25 * full.com, rtol=1e-6, atol=1e-6)


def test_a_robot_of_any_size_walks_the_same_walk_scaled():
    size = Similarity((50 / 65) ** 2, 0.2)
    full, other = (walked(one, **STORIES["walk"]) for one in (REFERENCE_SIZE, size))
    assert size.time == pytest.approx(math.sqrt(size.length), rel=1e-15)
    np.testing.assert_allclose(other.com, size.length * full.com, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(other.time, size.time * full.time)
