"""The next steps that a law of motion is told of."""

from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import walk_pendulum

from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import Foot

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("foot", list(Foot))
def test_the_next_steps_lie_on_the_sides_of_their_feet(stand, foot):
    """From the foothold before each, in the plan frame; and the nominal one may be kept."""
    profile, told = PROFILES["default"], []

    class Listening:
        def __init__(self, *given):
            self._law = profile.law(*given)

        def plan(self, problem):
            told.append(problem.steps)
            return self._law.plan(problem)

    gait = GaitParameters(steps=3, step_length=0.2, first_foot=foot, single_support=0.5, double_support=0.2)
    planner = WalkingPlanner(gait, stand(), 0.22, 0.11, profile=replace(profile, law=Listening))
    walk_pendulum(planner, stand(), 2.0, com=np.array([0.0, 0.0, gait.com_height]), substeps=1)
    assert len(told) > 50
    for steps in told:
        for n in (0, 1):
            if steps.increment[n].any():
                assert steps.side[n] == np.sign(steps.increment[n, 1])
                assert (steps.lower[n] <= 0.0).all() and (steps.upper[n] >= 0.0).all()
    assert {steps.side for steps in told} == {(1.0, -1.0), (-1.0, 1.0)}
