import numpy as np
import pytest

from surefoot.wbc.body.limits import AccelerationBounds, JointLimits

pytestmark = pytest.mark.unit

DISCRETISATION = 1e-3
"""Change of an angle in a control period of 1 ms [rad]."""


def limits(**changes):
    values = {
        "torque": np.array([100.0]), "velocity": np.array([8.0]), "lower": np.array([0.0]), "upper": np.array([2.0]),
    }  # fmt: skip
    return JointLimits(**(values | changes))


def bounds(q, v, **changes):
    lower, upper = np.empty_like(q), np.empty_like(q)
    AccelerationBounds(limits(**changes)).write(q, v, lower, upper)
    return lower, upper


RUNS = [(0.3, -6.0, -500.0), (1.7, 6.0, 500.0), (0.05, -1.0, -500.0), (1.0, 0.0, 500.0)]
"""Start, rate and acceleration asked for, of joints that would leave their range."""


def run(start, rate, push, **changes):
    """Positions and velocities, shape (2000,) each, of a joint that is pushed as hard as the bounds allow for 2 s."""
    found, q, v, dt = [], np.array([start]), np.array([rate]), 1e-3
    for _ in range(2000):
        a = np.clip(push, *bounds(q, v, **changes))
        q, v = q + v * dt + 0.5 * a * dt * dt, v + a * dt
        found.append((q[0], v[0]))
    return np.array(found).T


@pytest.mark.parametrize(("start", "rate", "push"), RUNS)
def test_a_joint_that_obeys_the_bounds_stays_in_its_range(start, rate, push):
    q, v = run(start, rate, push)
    assert q.min() >= -DISCRETISATION
    assert q.max() <= 2.0 + DISCRETISATION
    assert np.abs(v).max() <= 8.0 + 1e-6
    assert abs(v[-1]) < 1e-6


@pytest.mark.parametrize(("start", "rate", "push"), RUNS)
def test_bounds_that_do_not_know_the_range_let_the_joint_leave_it(start, rate, push):
    """Negative control: the velocity bound alone would not keep the joint in."""
    q, v = run(start, rate, push, lower=np.array([-1e3]), upper=np.array([1e3]))
    assert q.min() < -0.1 or q.max() > 2.1
    assert np.abs(v).max() <= 8.0 + 1e-6


def test_the_velocity_bound_lets_a_joint_reach_its_share_of_the_limit_and_no_more():
    _, v = run(0.0, 0.0, 500.0, upper=np.array([1e3]))
    assert v.max() == pytest.approx(limits().velocity_share * 8.0, abs=1e-6)
    assert v.max() < 0.9 * 8.0


def test_the_velocity_limit_is_met_within_its_horizon():
    v = np.array([7.0])
    lower, upper = bounds(np.array([0.0]), v, lower=np.array([-1e3]), upper=np.array([1e3]))
    horizon, fastest = limits().velocity_horizon, limits().velocity_share * 8.0
    assert v + horizon * upper == pytest.approx(fastest)
    assert v + horizon * lower == pytest.approx(-fastest)


def test_bounds_never_cross():
    rng = np.random.default_rng(0)
    for q, v in zip(rng.uniform(-1, 3, (500, 1)), rng.uniform(-20, 20, (500, 1)), strict=True):
        lower, upper = bounds(q, v)
        assert lower <= upper
