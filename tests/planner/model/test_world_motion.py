import numpy as np
import pytest

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.model.jerk import jerk_model, predict, zmp_response
from surefoot.planner.model.world_motion import WorldMotion, advanced

pytestmark = pytest.mark.unit

T, N = 0.02, 50


def test_an_axis_advances_as_its_model_says():
    rng, (A, B) = np.random.default_rng(0), jerk_model(T)
    for _ in range(20):
        state, jerk = rng.normal(size=3), rng.normal()
        np.testing.assert_allclose(advanced(tuple(state), jerk, T), A @ state + B * jerk, rtol=1e-14)


def test_a_plan_in_the_world_is_that_of_the_prediction_turned_and_moved():
    rng = np.random.default_rng(1)
    motion, prediction = WorldMotion(T, N), predict(T, np.eye(N))
    for _ in range(5):
        state, jerk, shifts = rng.normal(size=(2, 3)), rng.normal(size=(N, 2)), rng.normal(size=(2, 2))
        stiffness, height = rng.uniform(5.0, 15.0, N + 1), rng.normal(size=(3, N + 1))
        offset, point, gain = rng.normal(size=(3, N + 1, 2))
        R, origin = frame_rotation(rng.uniform(-3.0, 3.0)), rng.normal(size=2)
        found = motion.of(state, jerk, shifts, (stiffness, height, offset, point, gain), (R, origin))
        com = prediction.state @ state.T + prediction.samples @ jerk
        zmp = zmp_response(com, stiffness) + offset
        turned = np.dstack((com @ R.T, height))
        turned[0, :, :2] += origin
        wanted = turned, jerk @ R.T, zmp @ R.T + origin, offset @ R.T, (point + gain @ shifts) @ R.T + origin
        for one, other in zip(found, wanted, strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-11)
        first = motion.local(turned[0, 0], turned[1, 0], turned[2, 0], (R, origin))
        np.testing.assert_allclose(first, state, rtol=1e-12, atol=1e-12)


def test_plans_are_fresh_at_every_call():
    motion, rest = WorldMotion(T, N), np.zeros((N, 2))
    ahead = np.ones(N + 1), np.zeros((3, N + 1)), *np.zeros((3, N + 1, 2))
    frame = np.eye(2), np.zeros(2)
    first = motion.of(np.ones((2, 3)), rest, np.zeros((2, 2)), ahead, frame)
    kept = [part.copy() for part in first]
    motion.of(np.zeros((2, 3)), rest, np.zeros((2, 2)), ahead, frame)
    for one, other in zip(first, kept, strict=True):
        np.testing.assert_array_equal(one, other)
