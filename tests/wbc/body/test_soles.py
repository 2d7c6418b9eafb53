"""Soles turned level about an edge of theirs, and their yaws."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.body import soles
from surefoot.wbc.body.model import VERTICAL

pytestmark = pytest.mark.unit

TOE, HEEL = 0.1, -0.08


@pytest.mark.parametrize("pitch", [0.0, 0.3, -0.2])
def test_a_foot_turned_about_an_edge_is_where_it_stood(pitch):
    """Its toe edge stays where it is, or its heel edge where its toes are up, whatever its yaw and roll."""
    ahead = HEEL if pitch < 0.0 else TOE
    position, rotation = np.zeros((2, 3)), np.zeros((2, 3, 3))
    flat, yaw = np.array([[0.2, 0.1, 0.05], [-0.3, -0.1, 0.0]]), np.array([0.7, -2.5])
    for k in range(2):
        upright = pin.utils.rotate("z", yaw[k])
        edge = flat[k] + upright @ [ahead, 0.0, 0.0]
        rotation[k] = upright @ pin.utils.rotate("y", pitch) @ pin.utils.rotate("x", 0.1)
        position[k] = edge - rotation[k] @ [ahead, 0.0, 0.0]
    np.testing.assert_allclose(soles.level(position, rotation, TOE, HEEL, VERTICAL), flat, atol=1e-15)
    np.testing.assert_allclose(soles.yaws(rotation), yaw, atol=1e-15)
    assert not pitch or np.abs(soles.level(position, rotation, 0.0, 0.0, VERTICAL) - flat).max() > 1e-3


@pytest.mark.parametrize("pitch", [0.3, -0.2])
def test_a_foot_on_a_slope_turns_flat_on_it_and_not_level(pitch):
    slope, rotation = pin.utils.rotate("x", 0.1) @ pin.utils.rotate("y", -0.17), np.zeros((2, 3, 3))
    ahead = HEEL if pitch < 0.0 else TOE
    rotation[:] = slope @ pin.utils.rotate("y", pitch)
    position = (slope[:, 0] - rotation[0, :, 0]) * ahead + np.array([[0.2, 0.1, 0.05], [-0.3, -0.1, 0.0]])
    found = soles.level(position, rotation, TOE, HEEL, np.tile(slope[:, 2], (2, 1)))
    np.testing.assert_allclose(found, [[0.2, 0.1, 0.05], [-0.3, -0.1, 0.0]], atol=1e-15)


def test_a_foot_that_points_straight_down_is_turned_nowhere():
    down = np.array([pin.utils.rotate("y", np.pi / 2.0)] * 2)
    down[:, :2, 0] = 0.0
    np.testing.assert_allclose(
        soles.level(np.zeros((2, 3)), down, TOE, HEEL, VERTICAL), [[0.0, 0.0, -TOE]] * 2, atol=1e-15
    )
