"""Soles turned level about their toe edges, and their yaws."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.body import soles

pytestmark = pytest.mark.unit

TOE = 0.1


@pytest.mark.parametrize("pitch", [0.0, 0.3, -0.2])
def test_a_foot_turned_about_its_toe_edge_is_where_it_stood(pitch):
    """Its toe edge stays where it is, whatever its yaw and roll."""
    position, rotation = np.zeros((2, 3)), np.zeros((2, 3, 3))
    flat, yaw = np.array([[0.2, 0.1, 0.05], [-0.3, -0.1, 0.0]]), np.array([0.7, -2.5])
    for k in range(2):
        upright = pin.utils.rotate("z", yaw[k])
        edge = flat[k] + upright @ [TOE, 0.0, 0.0]
        rotation[k] = upright @ pin.utils.rotate("y", pitch) @ pin.utils.rotate("x", 0.1)
        position[k] = edge - rotation[k] @ [TOE, 0.0, 0.0]
    np.testing.assert_allclose(soles.level(position, rotation, TOE), flat, atol=1e-15)
    np.testing.assert_allclose(soles.yaws(rotation), yaw, atol=1e-15)
    assert not pitch or np.abs(soles.level(position, rotation, 0.0) - flat).max() > 1e-3


def test_a_foot_that_points_straight_down_is_turned_nowhere():
    down = np.array([pin.utils.rotate("y", np.pi / 2.0)] * 2)
    down[:, :2, 0] = 0.0
    np.testing.assert_allclose(soles.level(np.zeros((2, 3)), down, TOE), [[0.0, 0.0, -TOE]] * 2, atol=1e-15)
