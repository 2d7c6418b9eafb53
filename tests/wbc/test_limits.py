import numpy as np
import pytest

from wbc.limits import JointLimits

pytestmark = pytest.mark.unit


def limits(**changes):
    values = {
        "torque": np.array([100.0]), "velocity": np.array([8.0]), "lower": np.array([0.0]), "upper": np.array([2.0]),
    }  # fmt: skip
    return JointLimits(**(values | changes))


@pytest.mark.parametrize(("start", "rate", "push"), [(0.3, -6.0, -500.0), (1.7, 6.0, 500.0), (0.01, -1.0, -500.0)])
def test_a_joint_that_obeys_the_bounds_stays_in_its_range(start, rate, push):
    q, v, dt = np.array([start]), np.array([rate]), 1e-3
    worst_speed = abs(rate)
    for _ in range(2000):
        lower, upper = limits().acceleration_bounds(q, v)
        a = np.clip(push, lower, upper)
        q = q + v * dt + 0.5 * a * dt * dt
        v = v + a * dt
        worst_speed = max(worst_speed, abs(v[0]))
        assert -1e-3 <= q[0] <= 2.0 + 1e-3
    assert worst_speed <= 8.0 + 1e-6


def test_without_the_bounds_the_joint_leaves_its_range():
    q, v = 0.3, -6.0
    for _ in range(100):
        q, v = q + v * 1e-3, v - 0.5
    assert q < 0.0


def test_bounds_never_cross():
    rng = np.random.default_rng(0)
    q, v = rng.uniform(-1, 3, 1000), rng.uniform(-20, 20, 1000)
    lower, upper = limits().acceleration_bounds(q, v)
    assert (lower <= upper).all()
