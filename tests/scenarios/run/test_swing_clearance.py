"""The height of swing soles over the ground, on invented poses."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.judge.feet import swing_clearance_min

pytestmark = pytest.mark.unit

LENGTH, WIDTH, TICKS = 0.22, 0.11, 200


def _run(
    height: np.ndarray, pitch: float = 0.0, boxes: tuple = (), x: float = 0.0, plane: float = 0.0
) -> SimpleNamespace:
    """The left foot swings at heights [m] over ticks, pitched heel up [rad]; the right one stands."""
    soles = np.zeros((TICKS, 2, 7))
    soles[:, :, 6] = 1.0
    soles[:, 0, 0], soles[:, 0, 2] = x, height
    soles[:, 0, 4], soles[:, 0, 6] = np.sin(pitch / 2), np.cos(pitch / 2)
    return SimpleNamespace(
        constants=SimpleNamespace(foot_length=LENGTH, foot_width=WIDTH, boxes=boxes, plane=plane),
        single_support=np.ones(TICKS, dtype=bool),
        sole=lambda foot: soles[:, foot],
        field=lambda topic, name: np.ones(TICKS),
    )


def test_level_sole_on_flat_ground() -> None:
    assert swing_clearance_min(_run(np.full(TICKS, 0.05))) == pytest.approx(0.05)


def test_lift_off_and_touchdown_do_not_count() -> None:
    height = np.full(TICKS, 0.05)
    height[: TICKS // 5] = height[-TICKS // 5 :] = 0.0
    assert swing_clearance_min(_run(height)) == pytest.approx(0.05)
    height[TICKS // 2] = 0.004
    assert swing_clearance_min(_run(height)) == pytest.approx(0.004)


def test_the_lowest_corner_of_a_pitched_sole_counts() -> None:
    lowest = 0.05 - 0.5 * LENGTH * np.sin(0.1)
    assert swing_clearance_min(_run(np.full(TICKS, 0.05), pitch=0.1)) == pytest.approx(lowest)


def test_a_tread_under_the_toe_counts() -> None:
    tread = (0.6, 0.0, 0.015, 0.5, 1.0, 0.015, *np.eye(3).ravel())
    assert swing_clearance_min(_run(np.full(TICKS, 0.05), boxes=(tread,))) == pytest.approx(0.02)
    assert swing_clearance_min(_run(np.full(TICKS, 0.05), boxes=(tread,), x=-0.1)) == pytest.approx(0.05)


def test_a_plane_that_lies_lower_is_farther_away() -> None:
    assert swing_clearance_min(_run(np.full(TICKS, 0.05), plane=-0.01)) == pytest.approx(0.06)


def test_without_a_swing_there_is_none() -> None:
    run = _run(np.full(TICKS, 0.05))
    run.single_support[:] = False
    assert swing_clearance_min(run) is None
