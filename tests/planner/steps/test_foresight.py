from dataclasses import fields

import numpy as np
import pytest
from pendulum_walk import walk_pendulum

from surefoot.forces import Push
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.types import PhaseKind

pytestmark = pytest.mark.unit

GAIT = GaitParameters(lateral_step=0.1, turn=0.1, steps=2)
PUSH = Push(3.0, 0.1, np.array([0.0, 120.0, 0.0]))


class Blind:
    """Foresees nothing."""

    forgotten = staticmethod(Schedule.forgotten)

    def next_of(self, execution):
        return None


def walked(stand, pushes, blind=False):
    feet = stand(GAIT.step_width)
    planner = WalkingPlanner(GAIT, feet, 0.1, 0.075)
    if blind:
        planner._execution.foresight = Blind()
    return walk_pendulum(planner, feet, 6.0, com=np.array([0.0, 0.0, GAIT.com_height]), substeps=3, pushes=pushes).plans


@pytest.mark.parametrize("pushes", [(), (PUSH,)])
def test_plans_are_the_same_to_the_bit_with_foresight_and_without(stand, pushes):
    seen, blind = walked(stand, pushes), walked(stand, pushes, blind=True)
    for one, other in zip(seen, blind, strict=True):
        for field in fields(one):
            if isinstance(value := getattr(one, field.name), np.ndarray):
                np.testing.assert_array_equal(value, getattr(other, field.name))


def test_a_tick_in_which_a_foot_leaves_the_ground_finds_schedule_and_support_made(stand, monkeypatch):
    made, began, gone = [], [], Schedule.forgotten

    def told(self, clock):
        made.append(clock)
        return gone(self, clock)

    monkeypatch.setattr(Schedule, "forgotten", told)
    update = WalkingPlanner.update

    def counted(self, state, feet):
        count, support = len(made), self._preview._support
        plan = update(self, state, feet)
        if plan.phase.kind is PhaseKind.SINGLE and plan.phase.elapsed < 1e-9:
            began.append((len(made) - count, self._preview._support is support))
        return plan

    monkeypatch.setattr(WalkingPlanner, "update", counted)
    walked(stand, ())
    assert began == [(0, True)] * GAIT.steps
