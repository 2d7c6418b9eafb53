"""The reach of a foot that hips swing in a time, held against the swings that they would have to make."""

from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import LEGS

from surefoot.planner.geometry.quintic import between
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.reach import StepReach
from surefoot.planner.recovery.step_problem import StepProblem
from surefoot.planner.swing.leg_reach import ANYWHERE
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.types import Foot, Footstep

pytestmark = pytest.mark.unit

P = PlannerParameters()


def reach_of(swing, place, single):
    """The reach of legs in a left foot's step."""
    footstep = Footstep(Foot.LEFT, np.append(place, 0.0), 0.0)
    times = {"double": 0.0, "single": single, "cycle": 0.7, "shortest": 0.0}
    kinds = {"crosses": True, "last": False, "adapted": False}
    reach = StepReach(LEGS)
    reach.see(StepProblem(place=footstep, swing=np.array(swing), face=ANYWHERE, **times, **kinds))
    return reach


@pytest.mark.parametrize("speed", [(0.0, 0.0), (1.0, 0.4), (-0.8, -0.6)])
@pytest.mark.parametrize("time", [0.16, 0.2, 0.25, 0.3, 0.4])
@pytest.mark.parametrize(
    ("here", "place"), [((-0.35, 0.5), (0.3, -0.1)), ((0.3, -0.1), (0.0, 0.2)), ((0.1, -0.12), (0.05, 0.25))]
)
def test_a_way_around_the_stance_leg_lacks_what_hips_cannot_swing_of_it(time, here, place, speed):
    """Held against the swing that is bent so; from rest it lacks nothing in a long time, and beside the leg never."""
    here, place = np.array(here), np.array(place)
    reach = reach_of((here, speed), place, 2.0)
    length = time - P.touchdown_lead
    pose, target = np.append(here, np.zeros(4)), np.append(place, np.zeros(4))
    swing = start_swing(Foot.LEFT, (pose, target), (0.0, time / P.sample_time), SwingCourse(0.5, 0.0, 1.0, 0.05), P)
    level = swing.level.copy()
    for axis in (0, 1):
        level[:, axis] = between((here[axis], speed[axis], 0.0), (place[axis], 0.0, 0.0), length)
    swing, instants = replace(swing, level=level), np.linspace(0.0, length, 100)
    corner = LEGS.corner(swing.positions(instants)[:, :2], 1.0)
    bent = swing if corner is None else swing.around(corner, 0.1 * length)
    hardest = np.abs([bent.evaluate(at)[2, :2] / LEGS.acceleration for at in instants[:-1]]).max()
    expected = 0.0 if corner is None else (1.0 - 1.0 / max(hardest, 1.0)) * np.hypot(*(place - here))
    assert reach.shortfall(time, *place) == pytest.approx(expected, abs=0.03)
    assert any(speed) or reach.shortfall(2.0, *place) == 0.0
    assert reach_of(((0.1, 0.2), (1.0, 0.0)), (0.3, 0.3), time).shortfall(time, 0.3, 0.3) == 0.0


@pytest.mark.parametrize("speed", [(0.0, 0.0), (1.5, 0.3), (-0.8, -0.4)])
def test_a_foot_at_the_edge_is_swung_as_hard_as_the_hips_allow(speed):
    """A quintic to rest there, from where the foot is and as fast as it is, to within a tenth."""
    here, time = np.array([-0.2, 0.2]), 0.3
    reach = reach_of((here, speed), here, 5.0)
    for axis, sign in ((0, 1.0), (1, 1.0), (0, -1.0), (1, -1.0)):
        edge = sign * reach.swung(axis, sign, time + P.touchdown_lead)
        way, moving, u = edge - here[axis], speed[axis] * time, np.linspace(0.0, 1.0, 200)
        bend = way * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) + moving * (-36.0 * u + 96.0 * u**2 - 60.0 * u**3)
        assert np.abs(bend).max() / time**2 == pytest.approx(LEGS.acceleration[axis], rel=0.1)


@pytest.mark.parametrize("speed", [0.3, 1.2])
@pytest.mark.parametrize(("axis", "way"), [(0, 0.9), (0, -0.9), (1, 0.8)])
def test_a_foot_that_hips_could_not_swing_so_hard_gets_to_where_it_goes_in_its_own_time(axis, way, speed):
    """It may always be swung as hard as it nominally is."""
    here, moving, time = np.array([0.1, 0.2]), np.zeros(2), 0.15
    place = here.copy()
    place[axis] += way
    moving[axis] = np.sign(way) * speed
    reach = reach_of((here, moving), place, time)
    assert reach.swung(axis, np.sign(way), time) == pytest.approx(np.sign(way) * place[axis])
    assert reach.swung(axis, np.sign(way), 0.9 * time) < np.sign(way) * place[axis] - 0.05
