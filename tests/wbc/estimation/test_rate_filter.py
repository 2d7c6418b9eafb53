"""Laws of the filter of the gyroscope: its gain is that of its noises, it follows jumps, and knows how wrong it is."""

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from surefoot.wbc.estimation.rates import RateFilter

pytestmark = pytest.mark.unit

PERIOD, DENSITY, PLAN = 0.002, 2e-4, 0.02


def followed(seed, density=DENSITY, jump=0.0, told=True, ticks=3000):
    """Errors of the filter and of its readings, and the deviations that it says, of a body that turns as planned."""
    rng, noise = np.random.default_rng(seed), DENSITY / np.sqrt(PERIOD)
    rate, errors, read, said = np.zeros(3), [], [], []
    filter_ = RateFilter(rate + noise * rng.normal(size=3), PERIOD, density, PLAN)
    for tick in range(1, ticks):
        gained = 10.0 * PERIOD * np.array([np.sin(0.1 * tick), np.cos(0.07 * tick), 1.0 if tick % 200 < 100 else -1.0])
        rate = rate + gained + PLAN * np.sqrt(PERIOD) * rng.normal(size=3)
        if jump and tick % 250 == 0:
            rate = rate + jump
        reading = rate + noise * rng.normal(size=3)
        filter_.update(reading, gained if told else None, 1)
        errors.append(filter_.rate - rate)
        read.append(reading - rate)
        said.append(filter_.deviation)
    return np.array(errors), np.array(read), np.array(said)


def test_gain_and_deviation_are_those_of_the_riccati_equation():
    one, noise = np.eye(1), DENSITY**2 / PERIOD
    prior = solve_discrete_are(one, one, PLAN**2 * PERIOD * one, noise * one).item()
    filter_ = RateFilter(np.zeros(3), PERIOD, DENSITY, PLAN)
    for _ in range(300):
        filter_.update(np.zeros(3), np.zeros(3), 1)
    gain = prior / (prior + noise)
    assert filter_.deviation == pytest.approx(np.sqrt(gain * noise))
    filter_.update(np.array([1e-3, 0.0, -1e-3]), np.zeros(3), 1)
    np.testing.assert_allclose(filter_.rate, [gain * 1e-3, 0.0, -gain * 1e-3])


@pytest.mark.parametrize("seed", range(3))
def test_errors_are_as_large_as_it_says_and_smaller_than_those_of_the_readings(seed):
    errors, read, said = followed(seed)
    squares = float(np.mean((errors / said[:, None]) ** 2))
    assert 0.7 < squares < 1.3
    assert np.sqrt(np.mean(errors**2)) < 0.6 * np.sqrt(np.mean(read**2))
    # From both sides: who is told the wrong density is too sure, or not sure enough.
    for density, low, high in ((0.3 * DENSITY, 2.0, np.inf), (5.0 * DENSITY, 0.0, 0.7)):
        wrong, _, believed = followed(seed, density)
        assert low < float(np.mean((wrong / believed[:, None]) ** 2)) < high


def test_a_jump_that_nobody_planned_is_followed_within_two_ticks():
    errors, read, said = followed(5, jump=0.1)
    jumps = np.arange(249, len(errors), 250)
    after = np.abs(errors[jumps + 2])
    assert after.max() < 0.02 and said[jumps].min() > 1.5 * np.median(said)
    assert np.sqrt(np.mean(errors**2)) < np.sqrt(np.mean(read**2))


def test_without_a_plan_and_without_noise_the_reading_is_taken():
    errors, read, _ = followed(1, told=False, ticks=50)
    np.testing.assert_allclose(errors, read, atol=1e-15)
    exact = RateFilter(np.zeros(3), PERIOD, 0.0, PLAN)
    exact.update(np.ones(3), np.zeros(3), 1)
    np.testing.assert_array_equal(exact.rate, np.ones(3))
    assert exact.deviation == 0.0


def test_lost_readings_make_it_less_sure():
    filters = [RateFilter(np.zeros(3), PERIOD, DENSITY, PLAN) for _ in range(2)]
    for filter_, ticks in zip(filters, (1, 10), strict=True):
        for _ in range(100):
            filter_.update(np.zeros(3), np.zeros(3), ticks)
    assert filters[1].deviation > 1.3 * filters[0].deviation


def test_a_jump_counts_as_a_change_as_large_as_it_was():
    """Its gain is that of a variance P with y² = P + R, of the readings' variance R."""
    filter_, noise, jump = RateFilter(np.zeros(3), PERIOD, DENSITY, PLAN), DENSITY**2 / PERIOD, 0.05
    filter_.update(np.array([jump, 0.0, 0.0]), np.zeros(3), 1)
    assert filter_.rate[0] == pytest.approx(jump - noise / jump, rel=1e-12)
