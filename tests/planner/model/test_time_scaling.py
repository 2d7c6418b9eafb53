"""The clock of the gait, told to go another way in its time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.planner.model.time_scaling import CLOCK_ROUNDING, TimeScaling

pytestmark = pytest.mark.unit

T = 0.02


def going(rate, bend):
    """A clock that shows 100 and goes at a rate and its derivative by samples."""
    return TimeScaling(
        T, now=100.0, begun=100.0, way=1e6, length=1e6, coefficients=(0.0, rate, 0.5 * bend, 0.0, 0.0, 0.0)
    )


def shown(clock, times):
    return np.array(clock.at(np.asarray(times, dtype=float)))


def test_a_clock_goes_by_one_a_tick():
    clock = TimeScaling(T)
    for tick in range(5):
        assert (clock.now, clock.ticks, clock.steady) == (tick - 1.0, tick, True)
        assert clock.until(40.0) == 41.0 - tick
        clock = clock.advanced()


def test_a_clock_that_is_set_goes_on_from_there_by_one_a_tick():
    clock = going(0.7, 0.01).showing(107.5)
    assert clock.steady and clock.now == 107.5 and clock.course != TimeScaling(T).course
    assert clock.advanced().now == 108.5 and clock.until(110.0) == 2.5


@given(
    st.floats(0.5, 60.0), st.floats(0.5, 2.0), st.floats(0.2, 2.0), st.floats(-0.02, 0.02),
)  # fmt: skip
def test_a_scaled_clock_goes_on_from_its_rate_never_back_and_ends_at_its_own(way, ratio, rate, bend):
    clock = going(rate, bend).scaled(way, way * ratio)
    gone, speed, change = shown(clock, np.linspace(0.0, clock.length, 200))
    assert gone[0] == clock.now == 100.0
    assert gone[-1] == pytest.approx(100.0 + way)
    assert speed[0] == pytest.approx(rate)
    assert change[0] == pytest.approx(bend)
    assert speed[-1] == pytest.approx(1.0, abs=1e-6)
    assert shown(clock, [clock.length + 2.0])[0, 0] == pytest.approx(102.0 + way)
    assert speed.min() > 0.0


@given(
    st.floats(4.0, 60.0), st.floats(0.5, 2.0), st.floats(0.06, 0.2), st.floats(-0.05, 0.0),
)  # fmt: skip
def test_a_slow_clock_is_not_told_to_stay_slow(way, ratio, rate, bend):
    """Nor where it is slowing down so fast that no quintic goes on from that."""
    clock = going(rate, bend).scaled(way, way * ratio)
    _, speed, change = shown(clock, np.linspace(0.0, clock.length, 200))
    assert speed[0] == pytest.approx(rate)
    assert speed.min() > 0.0
    assert change[0] >= bend - 1e-9
    assert clock.length < 4.2 * way * ratio


@given(st.floats(5.0, 40.0), st.floats(0.6, 1.6))
def test_what_a_clock_foresees_is_what_it_shows(way, ratio):
    """At the ticks to come, until it shows the instant for which it was told, and in seconds in between."""
    clock = first = TimeScaling(T, now=10.0).scaled(way, ratio * way)
    told = 3.0
    foreseen = shown(first, np.arange(80.0))[0]
    for tick in range(80):
        assert clock.now == pytest.approx(foreseen[tick])
        assert tick + clock.until(10.0 + way) == pytest.approx(ratio * way)
        seconds, _, _ = first.seconds(told, told + tick * T)
        assert seconds - told == pytest.approx(T * (clock.now - first.now))
        assert clock.course == first.course
        clock = clock.advanced()
    assert clock.steady


@given(st.floats(8.0, 40.0), st.floats(0.6, 1.6))
def test_a_clock_that_has_begun_foresees_the_same_in_samples_and_in_seconds(way, ratio):
    """Also before it began, and when its quintic is over."""
    clock, told = TimeScaling(T, now=10.0).scaled(way, ratio * way), 3.0
    for _ in range(4):
        clock = clock.advanced()
    ahead = np.array([-6.0, -4.0, -1.5, 0.0, 2.5, 100.0])
    for k, (at, rate, bend) in enumerate(shown(clock, ahead).T):
        if k > 0:
            assert clock.after(ahead[k]) == pytest.approx(at)
        seconds = clock.seconds(told, told + T * ahead[k])
        assert seconds == pytest.approx((told + T * (at - clock.now), rate, bend / T), abs=1e-9)
    assert shown(clock, ahead)[0, :2] == pytest.approx([8.0, 10.0])


def test_a_clock_is_steady_from_the_end_of_its_quintic_on_to_rounding():
    clock = TimeScaling(T, now=10.0).scaled(12.0, 15.0)
    for sooner, steady in ((2.0, False), (0.5, True), (-0.5, True)):
        elapsed = TimeScaling(T, 22.0, 0, 10.0, 15.0 - sooner * CLOCK_ROUNDING, 12.0, 15.0, clock.coefficients)
        assert elapsed.steady is steady
    np.testing.assert_array_equal(shown(TimeScaling(T, now=7.0), [0.0, 2.0]), [[7.0, 9.0], [1.0, 1.0], [0.0, 0.0]])
