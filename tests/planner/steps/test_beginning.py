"""A walk begins with the steps that are laid, as many in sight as its first plans look at."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.errors import ParameterError
from surefoot.planner.check import check_walk
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site, flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.com_height import SmoothHeight
from surefoot.planner.steps.beginning import begun
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground

pytestmark = pytest.mark.unit

WALK = GaitParameters(steps=6, step_length=0.28, initial_stand=0.1)


def stairs(riser=0.1):
    return Stairs(riser, 0.28, 4, Direction.UP, start=0.14, landing=1.0, beyond=2.0).build(Site(np.zeros(2), 0.0, 0.8))


def on(terrain):
    return Ground(terrain, np.array([0.075, 0.05]), PlannerParameters(reach_length=0.8))


@pytest.mark.parametrize("ground", [flat, stairs])
def test_a_walk_begins_laid_out_and_in_sight(stand, ground):
    walk = begun(WALK, stand(), on(ground()), 100.0)
    anew = Schedule.start(WALK, stand(), on(ground())).with_nominal_steps()
    assert len(walk.nominal_steps) == len(anew.nominal_steps) == WALK.steps + 2
    for one, other in zip(walk.nominal_steps, anew.nominal_steps, strict=True):
        np.testing.assert_array_equal(one.place.position, other.place.position)
        assert (one.lift_off, one.stride, one.course) == (other.lift_off, other.stride, other.course)
    assert walk.last.lift_off > 100.0
    assert len(begun(WALK, stand(), on(ground())).steps) == 2


def test_a_walk_that_would_be_refused_on_its_way_is_refused_before(stand):
    check_walk(begun(replace(WALK, steps=3), stand(), on(flat())), SmoothHeight())
    with pytest.raises(ParameterError, match="falls off"):
        check_walk(begun(replace(WALK, steps=4, apex_ds=0.4), stand(), on(flat())), SmoothHeight())
