"""Angles that sway between extremes: smooth wherever they are sent elsewhere, and at rest where they arrive."""

import numpy as np
import pytest

from surefoot.planner.swing.sway import SOONEST, STILL, Sway

pytestmark = pytest.mark.unit

STEP = 1e-5
AWAY = STILL.towards(0.08, 1.0, 1.5, SOONEST)


def assert_smooth(sways, changes):
    """Angle, rate and acceleration go over into those of the next sway where it takes over."""
    for before, after, time in zip(sways, sways[1:], changes, strict=False):
        assert after is not before
        np.testing.assert_allclose(after.evaluate(time), before.evaluate(time), atol=1e-12)


@pytest.mark.parametrize("time", [1.02, 1.1, 1.25, 1.37, 1.48])
def test_rate_and_acceleration_are_derivatives_of_the_angle(time):
    (before, _, _), (angle, rate, bend), (after, _, _) = (AWAY.evaluate(time + d) for d in (-STEP, 0.0, STEP))
    assert rate == pytest.approx((after - before) / (2.0 * STEP), abs=1e-7)
    assert bend == pytest.approx((after - 2.0 * angle + before) / STEP**2, abs=1e-4)
    assert rate > 0.0  # negative control: it moves


def test_it_comes_to_rest_at_its_extreme():
    assert AWAY.evaluate(1.0) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    assert AWAY.evaluate(1.5 - 1e-9) == pytest.approx((0.08, 0.0, 0.0), abs=1e-6)
    assert AWAY.evaluate(1.5) == AWAY.evaluate(9.0) == (0.08, 0.0, 0.0)


def test_nothing_jumps_where_it_is_sent_elsewhere():
    back = AWAY.towards(-0.08, 1.2, 1.7, SOONEST)
    sooner = back.towards(-0.08, 1.3, 1.55, SOONEST)
    gone = sooner.towards(0.0, 1.53, 1.54, SOONEST)
    assert_smooth((AWAY, back, sooner, gone), (1.2, 1.3, 1.53))
    assert gone.end == pytest.approx(1.53 + SOONEST)
    jumping = Sway(1.2, 1.7, -0.08, STILL.towards(-0.08, 1.2, 1.7, SOONEST).course)
    with pytest.raises(AssertionError):
        assert_smooth((AWAY, jumping), (1.2,))


def test_it_goes_on_as_it_was_where_nothing_is_new():
    assert AWAY.towards(0.08, 1.3, 1.5, SOONEST) is AWAY
    assert AWAY.towards(0.08, 1.3, 1.5 + 1e-7, SOONEST) is AWAY
    assert AWAY.towards(0.08, 1.6, 2.5, SOONEST) is AWAY
    assert STILL.towards(0.0, 3.0, np.inf, SOONEST) is STILL


def test_a_walk_that_stops_for_good_comes_to_rest():
    """A phase without an end asks for no time: the angle goes back as soon as it may."""
    back = AWAY.towards(0.0, 1.5, np.inf, SOONEST)
    assert back.evaluate(1.5 + SOONEST) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("time", "end", "ends"),
    [(0.5, 0.8, 0.8), (0.5, 0.52, 0.6), (0.96, 0.965, 1.0), (0.96, 1.3, 1.3), (0.93, 0.5, 1.0)],
)
def test_to_the_same_extreme_it_hurries_no_more_than_it_does_already(time, end, ends):
    """It takes a while at least, or as long as it would have taken."""
    way = STILL.towards(0.2, 0.0, 1.0, SOONEST)
    assert way.towards(0.2, time, end, SOONEST).end == pytest.approx(ends)
    assert way.towards(-0.1, time, time, SOONEST).end == pytest.approx(time + SOONEST)
