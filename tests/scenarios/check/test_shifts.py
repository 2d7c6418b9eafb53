"""Shifts of noisy series: found where they are, seldom where there is none."""

import numpy as np
import pytest

from surefoot.scenarios.check.shifts import LEAST, shifts

pytestmark = pytest.mark.unit


def test_of_series_without_a_shift_few_are_told_to_have_one():
    random = np.random.default_rng(1)
    assert sum(bool(shifts(np.exp(0.1 * random.normal(size=60)).tolist())) for _ in range(400)) <= 4
    assert sum(bool(shifts(np.exp(0.1 * random.standard_t(3, size=60)).tolist())) for _ in range(400)) <= 12
    assert shifts([1.0] * 60) == []
    assert shifts((1.0 + 0.01 * random.normal(size=60)).tolist()) == []  # less than any clock is good for


@pytest.mark.parametrize("factor", [1.5, 0.6])
def test_a_shift_is_found_where_it_is_and_one_slow_run_is_none(factor):
    random, near = np.random.default_rng(2), 0
    for _ in range(100):
        values = np.exp(0.1 * random.normal(size=60))
        values[40:] *= factor
        values[20] *= 10.0
        found = shifts(values.tolist())
        near += len(found) == 1 and abs(found[0] - 40) <= 2
    assert near >= 95


def test_two_shifts_are_two_and_what_is_too_short_or_no_time_has_none():
    assert shifts([1.0] * 10 + [2.0] * 10 + [1.0] * 10) == [10, 20]
    assert shifts([1.0] * (LEAST - 1) + [9.0] * LEAST) == []
    assert shifts([0.0] * 10 + [1.0] * 10) == []
    assert shifts([]) == []
