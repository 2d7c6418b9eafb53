"""How far hips swing a foot in a time, held against the swings that they would have to make."""

import numpy as np
import pytest
from pendulum_walk import LEGS

from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.types import Foot

pytestmark = pytest.mark.unit

P = PlannerParameters()


@pytest.mark.parametrize("time", [0.16, 0.2, 0.25, 0.3, 0.4])
@pytest.mark.parametrize(("here", "place"), [((-0.35, 0.5), (0.3, -0.1)), ((0.3, -0.1), (0.0, 0.2))])
def test_a_way_around_the_stance_leg_lacks_what_hips_cannot_swing_of_it(time, here, place):
    """Held against the swing that is bent so; in a long time it lacks nothing, and beside the leg it never does."""
    here, place = np.array(here), np.array(place)
    swung = np.array([here, np.zeros(2)])
    lacking = LEGS.shortfall(swung, 1.0, np.array([time, 2.0]), np.tile(place, (1, 2, 1)))[0]
    length = time - P.touchdown_lead
    pose, target = np.append(here, np.zeros(4)), np.append(place, np.zeros(4))
    swing = start_swing(Foot.LEFT, pose, target, 0.0, time / P.sample_time, SwingCourse(0.5, 0.0, 1.0, 0.05), P)
    instants = np.linspace(0.0, length, 100)
    bent = swing.around(LEGS.corner(swing.positions(instants)[:, :2], 1.0), 0.1 * length)
    hardest = np.abs([bent.evaluate(at)[2, :2] / LEGS.acceleration for at in instants[:-1]]).max()
    expected = (1.0 - 1.0 / max(hardest, 1.0)) * np.hypot(*(place - here))
    np.testing.assert_allclose(lacking, (expected, 0.0), atol=0.03)
    beside = np.array([(0.1, 0.2), (1.0, 0.0)])
    assert LEGS.shortfall(beside, 1.0, np.array([time]), np.array([[[0.3, 0.3]]]))[0, 0] == 0.0


@pytest.mark.parametrize("speed", [(0.0, 0.0), (1.5, 0.3), (-0.8, -0.4)])
def test_a_foot_at_the_edge_is_swung_as_hard_as_the_hips_allow(speed):
    """A quintic to rest there, from where the foot is and as fast as it is, to within a tenth."""
    here, time = np.array([-0.2, 0.2]), 0.3
    front, left, back, right = LEGS.edges(np.array([here, speed]), here, np.array([time + P.touchdown_lead, 5.0]))[:, 0]
    for axis, edge in ((0, front), (1, left), (0, -back), (1, -right)):
        way, moving, u = edge - here[axis], speed[axis] * time, np.linspace(0.0, 1.0, 200)
        bend = way * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) + moving * (-36.0 * u + 96.0 * u**2 - 60.0 * u**3)
        assert np.abs(bend).max() / time**2 == pytest.approx(LEGS.acceleration[axis], rel=0.1)
