"""Hulls of soles, held against qhull."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.maths.polygon import convex_hull, flatness

pytestmark = pytest.mark.unit

SOLE = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * (0.11, 0.055)


def turned(yaw: float) -> np.ndarray:
    return SOLE @ np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])


@pytest.fixture
def rng():
    return np.random.default_rng(0)


@pytest.mark.parametrize("far", [0.0, 10.0, -3000.0])
def test_it_is_that_of_qhull(far, rng):
    for _ in range(300):
        soles = [turned(yaw) + rng.normal(size=2) for yaw in rng.uniform(-1, 1, 2)]
        points = np.concatenate(soles) + far
        found, right = convex_hull(points), points[ConvexHull(points).vertices]
        first = int(np.argmin(np.lexsort(right.T[::-1]).argsort()))
        np.testing.assert_array_equal(found, np.roll(right, -first, axis=0))


def test_it_goes_round_anticlockwise_and_keeps_only_what_stands_out(rng):
    for size in (3, 8, 40):
        hull = convex_hull(rng.normal(size=(size, 2)))
        edges = np.roll(hull, -1, axis=0) - hull
        following = np.roll(edges, -1, axis=0)
        assert np.all(edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0] > 0.0)


@pytest.mark.parametrize("far", [0.0, 100.0, 1e4])
@pytest.mark.parametrize("noise", [0.0, 1e-16, 1e-14])
def test_feet_side_by_side_or_on_one_spot_make_four_corners(far, noise, rng):
    """Rounding makes no edge a micrometre long that points anywhere."""
    for yaw in (0.0, 0.3):
        way = np.array([-np.sin(yaw), np.cos(yaw)])
        for apart in (0.0, 0.2):
            points = np.concatenate([turned(yaw), turned(yaw) + apart * way]) + far
            points += rng.uniform(-noise, noise, points.shape)
            assert len(convex_hull(points)) == 4


@pytest.mark.parametrize("middle", [(0.0, 0.0), (3.0, -5.0), (-7.0, 2.0)])
def test_a_shape_is_as_flat_in_a_mirror_and_turned_by_a_quarter(middle, rng):
    """Flatness grows with the square of its extent, whichever way it is long."""
    points = rng.uniform(-1.0, 1.0, (7, 2)) * (0.3, 0.02)
    flat = flatness(points + middle, 7)
    for way in ((points + middle)[:, ::-1], -points - middle, (points + middle) * (1.0, -1.0)):
        assert flatness(np.ascontiguousarray(way), 7) == pytest.approx(flat)
    about = points - points.mean(axis=0)
    assert flatness(10.0 * about, 7) == pytest.approx(100.0 * flatness(about, 7))
