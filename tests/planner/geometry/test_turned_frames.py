"""Rotations about the vertical and of soles, held against those of scipy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from surefoot.planner.geometry.orientation import roll_sole, sole_rotation
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


@pytest.mark.parametrize("pivot", [0.1, -0.08])
def test_a_sole_that_rolls_keeps_its_edge_in_place(pivot):
    """The edge is where the level sole has it, and the velocity of the centre is the derivative of its place."""

    def rolled(t):
        level = np.array([0.4 + 0.3 * t, -0.2 * t, 0.1, 0.7 + 0.5 * t, 0.1 - 0.2 * t, -0.15 + 0.3 * t])
        rates, pitch = np.array([0.3, -0.2, 0.0, 0.5, -0.2, 0.3]), 0.4 - 0.6 * t
        centre, velocity = np.empty(3), np.empty(3)
        roll_sole(level, rates, pivot, pitch, -0.6, centre, velocity)
        edge = level[:3] + sole_rotation(*level[3:]) @ [pivot, 0.0, 0.0]
        lifted = sole_rotation(*level[3:]) @ Rotation.from_euler("y", pitch).as_matrix() @ [pivot, 0.0, 0.0]
        np.testing.assert_allclose(centre + lifted, edge, atol=1e-15)
        return centre, velocity

    step = 1e-5
    difference = (rolled(step)[0] - rolled(-step)[0]) / (2.0 * step)
    np.testing.assert_allclose(rolled(0.0)[1], difference, atol=1e-8)
