import numpy as np
import pytest

from surefoot.wbc.limits import AccelerationBounds, JointLimits

pytestmark = pytest.mark.unit

DISCRETISATION = 1e-3
"""What a control period of 1 ms adds [rad]."""


def limits(**changes):
    values = {
        "torque": np.array([100.0]), "velocity": np.array([8.0]), "lower": np.array([0.0]), "upper": np.array([2.0]),
    }  # fmt: skip
    return JointLimits(**(values | changes))


def bounds(q, v):
    lower, upper = np.empty_like(q), np.empty_like(q)
    AccelerationBounds(limits()).write(q, v, lower, upper)
    return lower, upper


@pytest.mark.parametrize(
    ("start", "rate", "push"), [(0.3, -6.0, -500.0), (1.7, 6.0, 500.0), (0.05, -1.0, -500.0), (1.0, 0.0, 500.0)]
)
def test_a_joint_that_obeys_the_bounds_stays_in_its_range(start, rate, push):
    q, v, dt = np.array([start]), np.array([rate]), 1e-3
    worst_speed = abs(rate)
    for _ in range(2000):
        lower, upper = bounds(q, v)
        a = np.clip(push, lower, upper)
        q = q + v * dt + 0.5 * a * dt * dt
        v = v + a * dt
        worst_speed = max(worst_speed, abs(v[0]))
        assert -DISCRETISATION <= q[0] <= 2.0 + DISCRETISATION
    assert worst_speed <= 8.0 + 1e-6
    assert abs(v[0]) < 1e-6


def test_without_the_bounds_the_joint_leaves_its_range():
    q, v = 0.3, -6.0
    for _ in range(100):
        q, v = q + v * 1e-3, v - 0.5
    assert q < 0.0


def test_bounds_never_cross():
    rng = np.random.default_rng(0)
    for q, v in zip(rng.uniform(-1, 3, (500, 1)), rng.uniform(-20, 20, (500, 1)), strict=True):
        lower, upper = bounds(q, v)
        assert lower <= upper
