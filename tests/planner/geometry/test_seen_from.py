"""Footholds, points and corners of soles as seen from a foot or a pose."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.geometry.plane import (
    corners,
    forward,
    headings,
    level_corners,
    points_seen_from,
    rotations,
    seen_from,
)
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


@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
def test_points_are_seen_from_poses_as_they_were_laid_from_them(x, y, yaw, ahead, left):
    laid = np.array([[ahead, left], [left, ahead]]) @ sole_rotation(yaw, 0.0, 0.0)[:2, :2].T + (x, y)
    pose = np.array([x, y, 0.7, yaw])
    seen = points_seen_from(pose, laid)
    np.testing.assert_allclose(seen, [[ahead, left], [left, ahead]], atol=1e-12)
    np.testing.assert_allclose(points_seen_from(np.stack((pose, pose)), laid), seen)


@given(NUMBERS, NUMBERS, NUMBERS)
def test_corners_of_level_soles_are_those_of_soles_of_any_orientation(x, y, yaw):
    half = 0.5 * yaw
    poses = np.array([[x, y, 0.3, 0.0, 0.0, math.sin(half), math.cos(half)]])
    level = level_corners(np.array([[x, y, yaw]]), 0.24, 0.1)
    np.testing.assert_allclose(level, corners(poses, 0.24, 0.1)[:, :, :2], atol=1e-12)
    np.testing.assert_allclose(level_corners(np.array([[x, y, 9.0, yaw]]), 0.24, 0.1), level)


@given(NUMBERS, NUMBERS, NUMBERS)
def test_headings_are_those_of_the_forward_axis(roll, pitch, yaw):
    R = sole_rotation(yaw, 0.3 * roll, 0.3 * pitch)
    x, y, z, w = Rotation.from_matrix(R).as_quat()
    quaternion = np.array([x, y, z, w])
    np.testing.assert_allclose(forward(quaternion), R[:2, 0], atol=1e-12)
    assert headings(quaternion) == pytest.approx(math.atan2(R[1, 0], R[0, 0]))
    np.testing.assert_allclose(rotations(quaternion[None])[0], R, atol=1e-12)
