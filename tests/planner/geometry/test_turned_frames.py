"""Rotations about the vertical and of soles, held against those of scipy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from surefoot.planner.geometry.plane import frame_rotation, points_of_sole, wrap_angle, yaw_rotations
from surefoot.planner.types import Foot, Footstep

pytestmark = pytest.mark.unit

ANGLES = st.floats(-3.0, 3.0)


@given(ANGLES)
def test_a_frame_turns_about_the_vertical(yaw):
    turned = Rotation.from_euler("z", yaw).as_matrix()
    np.testing.assert_allclose(frame_rotation(yaw), turned[:2, :2], atol=1e-15)
    np.testing.assert_allclose(yaw_rotations(np.array([0.3, yaw]))[1], turned, atol=1e-15)


@given(st.floats(-30.0, 30.0))
def test_a_wrapped_angle_is_the_same_within_half_a_turn(angle):
    wrapped = wrap_angle(angle)
    assert -np.pi <= wrapped < np.pi
    assert (wrapped - angle) / (2.0 * np.pi) == pytest.approx(round((wrapped - angle) / (2.0 * np.pi)), abs=1e-12)


@given(ANGLES, st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_points_of_a_tilted_sole_are_seen_from_above(yaw, pitch, roll):
    turned = Rotation.from_euler("ZYX", (yaw, pitch, roll)).as_matrix()
    points = np.array([[0.1, 0.05], [-0.1, 0.05], [0.02, -0.03]])
    step = Footstep(Foot.LEFT, np.array([0.4, -0.3, 0.2]), yaw, turned[:, 2])
    # The heading of a tilted sole is that of its forward axis, which the angles have by their order.
    np.testing.assert_allclose(points_of_sole(step, points), step.position[:2] + points @ turned[:2, :2].T, atol=1e-12)
