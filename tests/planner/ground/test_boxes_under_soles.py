"""Boxes of the ground that soles touch, and those that carry them."""

import numpy as np
import pytest

from surefoot.planner.ground.terrain import Box, Terrain

pytestmark = pytest.mark.unit


def test_soles_and_boxes_meet_as_rectangles_do():
    half = np.array([0.1, 0.05])
    turned = np.pi / 4
    rotation = np.eye(3)
    rotation[:2, :2] = [[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]]
    box = Box(np.zeros(3), np.array([0.1, 0.1, 0.01]), rotation)
    soles = np.array([[0.0, 0.0, 0.0], [0.23, 0.0, 0.0], [0.25, 0.0, 0.0], [0.17, 0.17, 0.0], [0.0, 0.2, np.pi / 2]])
    assert box.touched(soles, half).tolist() == [True, True, False, False, True]


def test_no_sole_stands_on_ground_that_is_buried():
    def box(x, length, height):
        return Box(np.array([x, 0.0, 0.5 * height]), 0.5 * np.array([length, 1.0, height]), np.eye(3))

    half, sole = np.array([0.1, 0.05]), np.zeros((1, 3))
    hidden, tread = box(0.0, 0.4, 0.004), box(0.0, 0.3, 0.05)
    assert Terrain((hidden,)).carries(sole, half, 0)
    assert not Terrain((hidden, tread)).carries(sole, half, 0)
    assert Terrain((hidden, tread)).carries(sole, half, 1)
    assert Terrain((hidden, tread)).carries(np.array([[0.1, 0.0, 0.0]]), half, 0)
    assert Terrain((box(0.0, 0.001, 0.004), box(2.0, 0.1, 0.05))).carries(sole, half, 0)
    assert not Terrain((hidden,)).carries(np.array([[0.5, 0.0, 0.0]]), half, 0)
