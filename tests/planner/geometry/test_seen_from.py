"""A foothold seen from its stance foot."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.geometry.plane import seen_from
from surefoot.planner.types import Foot, Footstep, Twist

pytestmark = pytest.mark.unit

NUMBERS = st.floats(-3.0, 3.0)
TILT = sole_rotation(0.4, 0.1, -0.2)[:, 2]


@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
def test_it_is_the_same_wherever_both_are(x, y, yaw, ahead, left, turn):
    """Laid ahead of a stance foot at the origin, and both moved together over the ground."""
    there = Footstep(Foot.LEFT, np.array([ahead, left, 0.1]), turn, TILT, step=3, touchdown_time=1.5)
    moved = sole_rotation(yaw, 0.0, 0.0)
    stance = Footstep(Foot.RIGHT, np.array([x, y, 0.2]), yaw)
    place = Footstep(Foot.LEFT, stance.position + moved @ there.position, yaw + turn, moved @ TILT, 3, 1.5)
    seen = seen_from(stance, place)
    np.testing.assert_allclose(seen.position, there.position, atol=1e-12)
    np.testing.assert_allclose(seen.normal, TILT, atol=1e-12)
    assert seen.yaw == pytest.approx(turn, abs=1e-12)
    assert (seen.foot, seen.step, seen.touchdown_time) == (Foot.LEFT, 3, 1.5)


def test_a_foot_lies_on_its_own_side_until_legs_cross():
    for foot in Foot:
        assert Twist(0.2, 0.0, 0.0, 0.18).landing(foot).beside == pytest.approx(0.18)
        assert Twist(0.2, -0.3 * foot.side, 0.0, 0.18).landing(foot).beside == pytest.approx(-0.12)
