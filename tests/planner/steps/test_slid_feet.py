"""Feet that slide under a robot that stands: the plan goes with them."""

import numpy as np
import pytest
from pendulum_walk import LEGS

from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import CentroidalState, FeetState, PhaseKind

pytestmark = pytest.mark.unit

GAIT = GaitParameters(steps=0, single_support=0.5, double_support=0.12, com_height=0.95)
TICKS = 150


def stands(stand, ways):
    """The last plan of a robot whose feet have slid by this in the end, shape (2, 2) [m], with its CoM between them."""
    planner = WalkingPlanner(GAIT, stand(), 0.22, 0.11, legs=LEGS)
    for tick in range(TICKS):
        feet = stand()
        position = feet.position.copy()
        position[:, :2] += min(1.0, tick / 100.0) * np.array(ways)
        com = np.array([*position[:, :2].mean(axis=0), GAIT.com_height])
        state = CentroidalState(tick * planner.parameters.sample_time, com, np.zeros(3))
        plan = planner.update(state, FeetState(position, feet.yaw, feet.contact))
    assert plan.phase.kind is PhaseKind.STAND
    return planner, plan


@pytest.mark.parametrize("ways", [((0.0, 0.3), (0.0, 0.3)), ((0.03, 0.02), (0.01, 0.0)), ((0.018, 0.0), (0.0, 0.0))])
def test_a_robot_that_stands_stands_over_its_feet_wherever_they_have_slid(stand, ways):
    """The ZMP reference is between them, and their own polygon is the one that supports."""
    planner, plan = stands(stand, ways)
    middle = np.mean(ways, axis=0)
    np.testing.assert_allclose(plan.zmp[-1][:2], middle, atol=5e-3)
    where = stand().position[:, :2] + ways
    for number in (-1, 0):
        place = planner.schedule.step(number).place
        assert np.hypot(*(place.position[:2] - where[place.foot])) < 5e-3
    assert plan.balance.planned > 0.0


def test_soles_that_creep_by_millimetres_move_no_plan(stand):
    """Sinking and rocking under a load is no slide."""
    planner, _ = stands(stand, ((0.003, 0.003), (-0.003, 0.003)))
    for number in (-1, 0):
        place = planner.schedule.step(number).place
        np.testing.assert_array_equal(place.position, stand().position[place.foot])
