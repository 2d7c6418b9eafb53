"""A foot that is about to land ends the single support of a step that catches the body, where that captures more."""

import numpy as np
import pytest

from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import CentroidalState, FeetState, PhaseKind

pytestmark = pytest.mark.unit

P = PlannerParameters()
T = P.sample_time
LEGS = LegReach(0.36, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0))
GAIT = GaitParameters(initial_stand=0.0, single_support=0.6, double_support=0.2)

EARLY = 30
"""Tick in mid-swing at which the body is pushed."""


def walked(kicks, arrives=None):
    """Plans until the first landing.

    Args:
        kicks: speed to the left that the CoM gets at a tick, by tick [m/s].
        arrives: tick from which on the foot that swings is about to land; None where it never is.
    """
    feet = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))
    planner = WalkingPlanner(GAIT, feet, 0.22, 0.11, legs=LEGS, parameters=P)
    com, velocity, plans = np.array([0.0, 0.0, 1.0]), np.zeros(3), []
    for tick in range(90):
        plan = planner.update(CentroidalState(T * tick, com, velocity), feet)
        plans.append(plan)
        if plan.swing is None and any(one.swing is not None for one in plans):
            return plans
        com, velocity = plan.com[1], plan.com_velocity[1] + np.array([0.0, kicks.get(tick + 1, 0.0), 0.0])
        position, contact, arriving = feet.position.copy(), [True, True], [False, False]
        if plan.swing is not None:
            swing = plan.swing.foot
            position[swing] = plan.swing.evaluate(T * (tick + 1))[0, :3]
            contact[swing] = plan.phase.left < 1.5 * T
            arriving[swing] = arrives is not None and tick + 1 >= arrives
        feet = FeetState(position, feet.yaw, (contact[0], contact[1]), arriving=(arriving[0], arriving[1]))
    raise AssertionError("the foot never lands")


def decided(plans):
    """Tick of the plan from which on the place of the footstep is kept, as that of a step that catches is."""
    return next(k for k, plan in enumerate(plans) if plan.swing and plan.swing.touchdown_time - plan.time <= 0.0401)


@pytest.mark.parametrize("kick", [0.2, 0.3, 0.5, -0.2, -0.3])
@pytest.mark.parametrize("after", [-0.3, -0.1, 0.0, 0.1, 0.3])
def test_what_it_decides_captures_no_less_than_to_wait(kick, after):
    kicks = {EARLY: kick}
    tick = decided(walked(kicks)) + 1
    kicks[tick] = after
    waits, arrives = walked(kicks), walked(kicks, tick)
    assert tick < len(waits) and waits[tick].phase.kind is PhaseKind.SINGLE
    ends = arrives[tick].phase.kind is PhaseKind.DOUBLE
    gained = arrives[tick].balance.planned - waits[tick].balance.planned
    assert gained > 0.0 if ends else gained == 0.0


def test_it_ends_with_a_dcm_beyond_the_place_and_waits_with_one_short_of_it():
    kicks = {EARLY: 0.3}
    tick = decided(walked(kicks)) + 1
    beyond, short = (walked({**kicks, tick: after}, tick) for after in (0.3, -0.1))
    assert beyond[tick].phase.kind is PhaseKind.DOUBLE and len(beyond) == tick + 1
    assert beyond[tick].phase.elapsed == 0.0 and beyond[tick].phase.landed == beyond[tick - 1].phase.step
    assert short[tick].phase.kind is PhaseKind.SINGLE


def test_of_a_step_that_catches_nothing_it_is_not_heard():
    plain, told = walked({}), walked({}, 25)
    assert len(plain) == len(told)
    for one, other in zip(plain, told, strict=True):
        assert (one.phase.kind, one.phase.elapsed) == (other.phase.kind, other.phase.elapsed)
        np.testing.assert_array_equal(one.com, other.com)


def test_before_its_place_is_decided_the_foot_goes_on():
    plans = walked({EARLY: 0.3}, EARLY)
    assert len(plans) >= decided(walked({EARLY: 0.3})) + 1
