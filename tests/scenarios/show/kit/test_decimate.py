"""Fewer points, every extreme."""

import numpy as np
import pytest

from surefoot.scenarios.show.kit.figures import kept, kept_of_path, steps

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("n", [0, 1, 7, 200, 201, 999, 12_345])
def test_rows_ascend_and_are_few(n):
    rows = kept(np.random.default_rng(n).normal(size=n), buckets=50)
    assert np.all(np.diff(rows) > 0)
    assert len(rows) <= 4 * 50 + 1
    assert n == 0 or (rows[0] == 0 and rows[-1] == n - 1)
    if n <= 200:
        assert len(rows) == n


def test_the_extremes_of_every_bucket_stay():
    values = np.random.default_rng(0).normal(size=10_000)
    values[[17, 4_321]] = 50.0, -50.0
    drawn = np.full(values.shape, np.nan)
    rows = kept(values, buckets=100)
    drawn[rows] = values[rows]
    table, thinned = values.reshape(100, 100), drawn.reshape(100, 100)
    np.testing.assert_array_equal(np.nanmax(thinned, axis=1), table.max(axis=1))
    np.testing.assert_array_equal(np.nanmin(thinned, axis=1), table.min(axis=1))


def test_a_gap_stays_a_gap():
    values = np.zeros(10_000)
    values[5_050] = np.nan
    rows = kept(values, buckets=100)
    assert np.isnan(values[rows]).sum() == 1
    assert len(kept(np.full(10_000, np.nan), buckets=100)) > 0


def test_a_path_keeps_the_extremes_of_both_coordinates():
    points = np.random.default_rng(1).normal(size=(9_999, 2))
    rows = kept_of_path(points)
    np.testing.assert_array_equal(np.ptp(points[rows], axis=0), np.ptp(points, axis=0))


def test_steps_are_where_a_bound_changes():
    low, high = np.array([0.0, 0, 0, 1, 1, 1]), np.array([2.0, 2, 3, 3, 3, 3])
    assert steps(low, high).tolist() == [0, 2, 3, 5]
    assert steps(np.zeros(1)).tolist() == [0]
