import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.maths.polygon import convex_hull
from surefoot.planner.geometry.plane import nearest_point, signed_distance, sole_corners
from surefoot.planner.types import Foot, Footstep

pytestmark = pytest.mark.unit


def test_hull_holds_all_points_and_is_made_of_them():
    points = np.random.default_rng(0).normal(size=(40, 2))
    hull = convex_hull(points)
    assert min(signed_distance(hull, p) for p in points) >= -1e-12
    assert all(any(np.array_equal(v, p) for p in points) for v in hull)


def test_hull_far_from_the_origin_drops_points_inside_edges():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0]]) + 100.0
    assert len(convex_hull(square)) == 4


def test_nearest_point_is_optimal():
    rng = np.random.default_rng(1)
    hull = convex_hull(rng.normal(size=(12, 2)))
    for point in rng.normal(scale=3.0, size=(50, 2)):
        nearest = nearest_point(hull, point)
        assert signed_distance(hull, nearest) > -1e-9
        if signed_distance(hull, point) < 0.0:
            assert np.all((hull - nearest) @ (point - nearest) <= 1e-9)


def test_sole_is_anticlockwise_and_turned():
    corners = sole_corners(Footstep(Foot.LEFT, np.array([1.0, 2.0, 0.0]), np.pi / 2), np.array([0.11, 0.05]))
    np.testing.assert_allclose(np.ptp(corners, axis=0), [0.1, 0.22])
    assert signed_distance(corners, np.array([1.0, 2.0])) == pytest.approx(0.05)


def test_hull_of_soles_is_that_of_qhull_from_its_leftmost_corner():
    rng, half = np.random.default_rng(2), np.array([0.11, 0.05])
    for turned in np.concatenate((np.zeros(20), rng.uniform(-3.0, 3.0, 40))):
        place, way = rng.normal(size=2), np.array([rng.uniform(-0.4, 0.4), -0.2])
        feet = (Footstep(foot, np.append(at, 0.0), turned) for foot, at in zip(Foot, (place, place + way), strict=True))
        points = np.concatenate([sole_corners(foot, half) for foot in feet])
        hull, wanted = convex_hull(points), points[ConvexHull(points).vertices]
        assert hull[0].tolist() == min(points.tolist())
        np.testing.assert_array_equal(hull, np.roll(wanted, -wanted.tolist().index(hull[0].tolist()), axis=0))
