"""A robot that falls gives way: what its joints' torques do to energy, ranges and limits."""

import numpy as np
import pytest

from surefoot.wbc.body.falling import GivingWay
from surefoot.wbc.body.limits import JointLimits

pytestmark = pytest.mark.unit

LIMITS = JointLimits(
    torque=np.array([300.0, 40.0, 100.0]),
    velocity=np.full(3, 12.0),
    lower=np.array([-0.1, -1.5, -0.1]),
    upper=np.array([2.4, 1.5, 0.1]),
)
RNG = np.random.default_rng(0)
STATES = [(RNG.uniform(-3.0, 3.0, 3), RNG.normal(0.0, 8.0, 3)) for _ in range(200)]
MIDDLE = 0.5 * (LIMITS.lower + LIMITS.upper)


def test_torques_are_within_limits_and_nothing_holds_who_rests_inside():
    law = GivingWay(LIMITS)
    for position, velocity in STATES:
        assert (np.abs(law.torque(position, velocity)) <= LIMITS.torque).all()
    assert not law.torque(MIDDLE, np.zeros(3)).any()


def test_within_the_range_they_only_take_energy():
    law = GivingWay(LIMITS)
    for _, velocity in STATES:
        assert (law.torque(MIDDLE, velocity) * velocity < 0.0).all()


def test_at_the_ends_of_a_range_they_turn_back():
    law, still = GivingWay(LIMITS), np.zeros(3)
    assert (law.torque(LIMITS.lower, still) > 0.0).all()
    assert (law.torque(LIMITS.upper, still) < 0.0).all()


def test_a_joint_that_comes_fast_stops_short_of_the_end():
    """A shank of 0.5 kg m^2 at the knee, unloaded, at half its limit of speed."""
    law, step, position, velocity = GivingWay(LIMITS), 1e-3, MIDDLE.copy(), np.array([6.0, 0.0, 0.0])
    for _ in range(2000):
        velocity = velocity + step * law.torque(position, velocity) / 0.5
        position = position + step * velocity
        assert position[0] < LIMITS.upper[0]
    assert abs(velocity[0]) < 0.1
