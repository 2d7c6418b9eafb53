"""A quintic goes from one position, velocity and acceleration to others, and its derivatives are its own."""

import numpy as np
import pytest

from surefoot.planner.geometry import quintic

pytestmark = pytest.mark.unit

TIMES = (0.02, 0.37, 1.0, 2.5)


def ways():
    rng = np.random.default_rng(4)
    for time in TIMES:
        for _ in range(5):
            start, end = rng.normal(size=(2, 3))
            yield tuple(start.tolist()), tuple(end.tolist()), time


@pytest.mark.parametrize(("start", "end", "time"), [*ways()])
def test_a_quintic_meets_both_states(start, end, time):
    course = quintic.between(start, end, time)
    assert len(course) == 6
    for state, at in ((start, 0.0), (end, time)):
        for known, law, power in zip(state, (quintic.value, quintic.slope, quintic.bend), range(3), strict=True):
            size = max(map(abs, (*start, *end))) / min(time, 1.0) ** (2 + power)
            assert law(course, at) == pytest.approx(known, abs=1e-13 * size)


@pytest.mark.parametrize(("start", "end", "time"), [*ways()])
def test_slope_and_bend_are_finite_differences(start, end, time):
    course, h = quintic.between(start, end, time), 1e-5 * time
    for share in (0.1, 0.5, 0.8):
        t = share * time
        rise = quintic.value(course, t + h) - quintic.value(course, t - h)
        turn = quintic.slope(course, t + h) - quintic.slope(course, t - h)
        largest = max(abs(quintic.bend(course, s * time)) for s in np.linspace(0.0, 1.0, 21))
        assert quintic.slope(course, t) == pytest.approx(rise / (2.0 * h), abs=1e-6 * largest * time)
        assert quintic.bend(course, t) == pytest.approx(turn / (2.0 * h), abs=1e-6 * largest)


def test_from_rest_to_rest_the_middle_is_half_way():
    """At the middle of a way from rest to rest it is half way, at 15 / 8 of the mean speed, and turns about."""
    course = quintic.between((1.0, 0.0, 0.0), (3.0, 0.0, 0.0), 0.5)
    assert quintic.value(course, 0.25) == pytest.approx(2.0)
    assert quintic.slope(course, 0.25) == pytest.approx(15.0 / 8.0 * 2.0 / 0.5)
    assert quintic.bend(course, 0.25) == pytest.approx(0.0, abs=1e-12)
