"""The boxes around a stance foot in which legs let a foot land."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.planner.swing.boxes import landing_boxes

pytestmark = pytest.mark.unit

MOST, HIPS, BESIDE, CLEAR, ACROSS = 0.6, 0.2, 0.12, 0.25, 0.1
ANYWHERE = np.array([[-np.inf, -np.inf], [np.inf, np.inf]])


def boxes(side, face=ANYWHERE, count=3):
    """Lower and upper corners, shape (count, 2) each."""
    low, high = np.full((count, 2), np.nan), np.full((count, 2), np.nan)
    landing_boxes(low, high, (MOST, HIPS, BESIDE, CLEAR), ACROSS, side, face, count)
    return low, high


def allowed(x, y, side):
    """The law in words: beside the stance foot at any stride, across it only with the feet one ahead of the other."""
    out = side * y
    within = abs(x) <= MOST and out <= MOST + HIPS
    return within and (out >= BESIDE or (out >= -ACROSS and abs(x) >= CLEAR))


@given(st.floats(-0.8, 0.8), st.floats(-1.0, 1.0), st.sampled_from([1.0, -1.0]))
def test_a_foot_may_land_where_legs_neither_cross_nor_touch(x, y, side):
    low, high = boxes(side)
    inside = ((low <= (x, y)) & ((x, y) <= high)).all(axis=1)
    assert inside.any() == allowed(x, y, side)


def test_boxes_beyond_the_stance_foot_are_ahead_and_behind():
    low, high = boxes(1.0)
    assert (low[1, 0], high[1, 0]) == (CLEAR, MOST)
    assert (low[2, 0], high[2, 0]) == (-MOST, -CLEAR)
    assert (low[:, 1] == (BESIDE, -ACROSS, -ACROSS)).all()


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_chosen_face_bounds_each_box(side):
    face = np.array([[-0.3, -0.2], [0.4, 0.3]])
    (low, high), (free_low, free_high) = boxes(side, face), boxes(side)
    assert (low == np.maximum(free_low, face[0])).all()
    assert (high == np.minimum(free_high, face[1])).all()


def test_without_crossing_there_is_one_box():
    low, high = boxes(-1.0, count=1)
    assert low.tolist() == [[-MOST, -(MOST + HIPS)]]
    assert high.tolist() == [[MOST, -BESIDE]]
