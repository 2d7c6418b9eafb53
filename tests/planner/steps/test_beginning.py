"""A walk that begins as another one did is not laid anew; one that begins otherwise in any number is."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.errors import ParameterError
from surefoot.planner import check
from surefoot.planner.check import check_walk
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site, Terrain, flat
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


def on(terrain, **changed):
    return Ground(terrain, np.array([0.075, 0.05]), PlannerParameters(reach_length=0.8, **changed))


@pytest.mark.parametrize("ground", [flat, stairs])
def test_what_begins_alike_is_laid_once_as_it_would_be_anew(stand, ground):
    kept = begun(WALK, stand(), on(ground()))
    assert begun(replace(WALK), stand(), on(ground())) is kept
    anew = Schedule.start(WALK, stand(), on(ground())).laid_out()
    assert len(kept.laid) == len(anew.laid)
    for one, other in zip(kept.laid, anew.laid, strict=True):
        np.testing.assert_array_equal(one.place.position, other.place.position)
        assert (one.lift_off, one.stride, one.course) == (other.lift_off, other.stride, other.course)


def test_any_other_number_is_another_beginning(stand):
    kept, feet = begun(WALK, stand(), on(stairs())), stand()
    moved = replace(feet, position=feet.position + np.array([1e-15, 0.0, 0.0]))
    others = (
        begun(WALK, moved, on(stairs())),
        begun(replace(WALK, swing_height=0.051), feet, on(stairs())),
        begun(WALK, feet, on(stairs(0.1001))),
        begun(WALK, feet, on(stairs(), touchdown_lead=0.021)),
    )
    assert all(other is not kept for other in others)
    assert others[0].steps[0].place.position[0] != kept.steps[0].place.position[0]


def test_of_a_terrain_that_others_made_nothing_is_kept(stand):
    class Theirs(Terrain):
        pass

    ground = on(Theirs())
    assert begun(WALK, stand(), ground) is not begun(WALK, stand(), ground)


def test_a_walk_that_has_passed_is_looked_at_once_and_one_that_is_refused_each_time(stand, monkeypatch):
    looked, look = [], check.check_height
    monkeypatch.setattr(check, "check_height", lambda *given: looked.append(1) or look(*given))
    walk = begun(replace(WALK, steps=3), stand(), on(flat()))
    check_walk(walk, SmoothHeight())
    once = len(looked)
    check_walk(replace(walk), SmoothHeight())
    assert len(looked) == once > 0
    far = begun(replace(WALK, steps=4, apex_ds=0.4), stand(), on(flat()))
    for _ in range(2):
        with pytest.raises(ParameterError, match="falls off"):
            check_walk(far, SmoothHeight())

    class Theirs(SmoothHeight):
        pass

    for _ in range(2):
        before = len(looked)
        check_walk(walk, Theirs())
        assert len(looked) > before
