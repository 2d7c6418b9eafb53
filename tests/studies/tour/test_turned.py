"""A walk whose limp arm is punched turns, in place of jumping off its stance foot, and steps as far as it must."""

from dataclasses import replace

import numpy as np
import pytest
from enough import at_least

from surefoot.models import RobotOptions, describe
from surefoot.planner.swing import leg_reach
from surefoot.studies.tour import ride, rows
from surefoot.studies.tour.rules import drawn
from surefoot.wbc.parameters import TaskWeights

pytestmark = pytest.mark.physics

SEED = 1084
"""Seed of a tour whose first punch hits the right upper arm as the left foot swings."""


UPRIGHT = (("wbc.weights.upright_catching", 1.0), ("wbc.balance.beyond_catching", 0.0))
"""Keys of a trunk that takes no part, so that what is looked at is all that catches the body."""


def ride_of(seed, force, *keys):
    """A tour with punches of a force at most [N], of a robot with these keys and a trunk that takes no part."""
    arms = rows.ROWS["arms"]
    tour = drawn(seed, len(describe("g1", RobotOptions()).joint_names), lambda _: force)
    return ride.Ride(replace(arms, keys=(*arms.keys, *UPRIGHT, *keys)), seed, tour=tour)


def highest(weight):
    """Greatest height of the CoM over its plan until the foot that was swung has landed [m], and when that is [s]."""
    tour = ride_of(SEED, 375.0, ("wbc.weights.turning_catching", weight))
    controller, most = tour.walker.controller, -np.inf
    while True:
        tour.step()
        plan, time = controller.planning.plan, tour._tick / tour.entrant.rate
        if plan.phase.landed > 0 or time > 1.0:
            return most, time
        most = max(most, float(controller.terms.com[2] - plan.com[0, 2]))


def test_a_punch_on_a_limp_arm_does_not_lift_it_off_its_stance_foot():
    """Held to its heading as in the walk it jumps by centimetres, and its foot comes later."""
    (turning, soon), (stiff, late) = (highest(weight) for weight in (TaskWeights().turning_catching, 1.0))
    assert turning < 0.01 < 0.02 < stiff
    assert soon < late


def standing(monkeypatch, stride):
    """Tell whether it stands 3.5 s after punches backward on a shoulder, eight of 430 to 500 N at most."""
    monkeypatch.setattr(leg_reach, "STRIDE", stride)
    # So it stands, when the second punch comes, where these forces tell both strides apart.
    monkeypatch.setattr(rows, "FASTEST", (0.4, 0.2, 0.8))
    for force in range(430, 510, 10):
        yield ride_of(8, float(force)).run(8.6).completed


def test_a_body_that_runs_backward_is_caught_by_steps_as_far_as_its_own_leg_reaches(monkeypatch):
    """With steps no farther than both legs span flat, each lands short of the DCM by as much as the one before."""
    assert at_least(5, standing(monkeypatch, leg_reach.STRIDE))
    assert at_least(6, (not stood for stood in standing(monkeypatch, 2.0)))
