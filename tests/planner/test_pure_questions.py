"""A question changes nothing: all that goes from one tick to the next is the state, and nothing else remembers."""

from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import LEGS, walk_pendulum

from surefoot.planner.laws.dcm_feedback import DcmFeedback
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import CentroidalState

pytestmark = pytest.mark.unit

GAIT = GaitParameters(steps=4, step_length=0.1, com_height=1.0)
TOLD = ("com", "com_velocity", "com_acceleration", "jerk", "zmp", "zmp_offset", "zmp_reference")


def planner_of(profile, stand):
    return WalkingPlanner(GAIT, stand(), 0.22, 0.11, profile=PROFILES[profile], legs=LEGS)


def measured(tick, aside, stand):
    """A CoM that sways, and standing feet."""
    sway = 0.02 * np.sin(0.3 * tick) + aside
    return CentroidalState(0.02 * tick, np.array([0.01 * sway, sway, 1.0]), np.array([0.0, 0.01, 0.0])), stand()


@pytest.mark.parametrize("profile", [name for name, one in PROFILES.items() if one.planner is None])
def test_a_state_and_a_measurement_have_one_plan_whatever_was_asked_before(profile, stand):
    planner = planner_of(profile, stand)
    for tick in range(12):
        planner.update(*measured(tick, 0.0, stand))
    kept = planner.state
    plan = planner.update(*measured(12, 0.0, stand))
    for tick in range(13, 40):
        planner.update(*measured(tick, 0.01, stand))
    planner.state = kept
    again = planner.update(*measured(12, 0.0, stand))
    for name in TOLD:
        np.testing.assert_array_equal(getattr(again, name), getattr(plan, name), err_msg=name)
    assert [list(place.position) for place in again.footsteps] == [list(place.position) for place in plan.footsteps]
    assert (again.status.solver, again.status.age) == (plan.status.solver, plan.status.age)


def test_what_another_state_plans_is_seen(stand):
    planner = planner_of("preview", stand)
    for tick in range(12):
        planner.update(*measured(tick, 0.0, stand))
    kept = planner.state
    plan = planner.update(*measured(12, 0.0, stand))
    planner.state = planner_of("preview", stand).state
    planner.update(*measured(11, 0.0, stand))
    assert kept is not planner.state
    assert (planner.update(*measured(12, 0.0, stand)).jerk != plan.jerk).any()


told = []
"""Rotation of each frame in which `Remembering` was told its places."""


class Remembering:
    """Leaves places of the world to be told, and notes where it is told that they are."""

    PLACES = np.array([[0.3, -0.1], [1.0, 2.0], [0.0, 0.5]])

    def __init__(self, parameters, com_height):
        self.law = DcmFeedback(parameters, com_height)

    def plan(self, problem):
        here = self.PLACES @ problem.rotation
        if problem.memory is not None:
            np.testing.assert_allclose(problem.memory, here, atol=1e-12)
            told.append(problem.rotation)
        return replace(self.law.plan(problem), memory=here)


def test_what_a_law_leaves_to_be_told_is_turned_with_the_frame(stand):
    told.clear()
    gait = replace(GAIT, steps=6, step_length=0.05, turn=0.2)
    profile = replace(PROFILES["dcm"], law=Remembering)
    planner = WalkingPlanner(gait, stand(), 0.22, 0.11, profile=profile)
    walk_pendulum(planner, stand(), 5.0, com=np.array([0.0, 0.0, 1.0]))
    assert len(told) > 200
    assert np.ptp([rotation[1, 0] for rotation in told]) > 0.15
