"""The offset table is used again by the value of its key, never because an object happens to be the same one."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.parameters import LegInertia, PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.window import OffsetTable
from surefoot.planner.references.zmp_reference import SupportKey
from surefoot.planner.types import CentroidalState
from surefoot.planner.walk.gait import GaitParameters

pytestmark = pytest.mark.unit

LINK = Link(0.4, 0.08, 0.45, 0.003)
LEG = LegInertia(0.06, LegChain(0.1, (0.0, 0.0, 0.25), LINK, LINK, 0.02, (0.03, 0.0, -0.05), (0.0, 0.0, 0.1)))
KEY = SupportKey(3, 2, 100.0, (True, False))


def test_a_table_holds_for_few_later_samples_of_an_equal_key():
    table = OffsetTable(110, KEY, np.zeros((200, 2)))
    assert [sample for sample in range(105, 120) if table.holds(sample, SupportKey(*KEY), 500)] == [111, 112, 113, 114]
    assert [sample for sample in range(105, 120) if table.holds(sample, KEY, 112)] == [111]


@pytest.mark.parametrize("change", [{"revision": 4}, {"landed": 3}, {"phase_start": 101.0}, {"free": (True, True)}])
def test_a_table_does_not_hold_for_another_support(change):
    assert not OffsetTable(110, KEY, np.zeros((200, 2))).holds(111, KEY._replace(**change), 500)


@pytest.mark.parametrize("copied", [False, True])
def test_plans_depend_on_values_and_not_on_objects(stand, copied):
    """Footholds replaced by equal ones change no plan; moved ones do, even of a step that was fixed before."""
    gait = GaitParameters(steps=2, initial_stand=0.0)
    plans = []
    for change in (False, True):
        planner = WalkingPlanner(gait, stand(), 0.2, 0.1, parameters=PlannerParameters(leg=LEG))
        for tick in range(4):
            stepper = planner._stepper
            if tick == 1:
                stepper.fix(stepper.footsteps.position[2])
            if change and tick == 2:
                if copied:
                    stepper.queue.footsteps = replace(stepper.footsteps)
                else:
                    stepper.fix(stepper.footsteps.position[2] + (0.05, 0.0, 0.0))
            state = CentroidalState(0.02 * tick, np.array([0.001 * tick, 0.0, 1.0]), np.zeros(3))
            plan = planner.update(state, stand())
        plans.append(plan)
    same = np.array_equal(plans[0].zmp_offset, plans[1].zmp_offset)
    assert same is copied
    assert np.abs(plans[0].zmp_offset).max() > 1e-3
