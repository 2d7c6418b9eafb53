"""Soles that slip: what they tell after it, and what the covariance makes of what was refused."""

import numpy as np
import pytest

from surefoot.native.library import VARIABLE
from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.invariant_filter import InvariantFilter
from surefoot.wbc.estimation.kinematics import Footing, ImuMount
from surefoot.wbc.estimation.parameters import EstimatorParameters, GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import Stand
from surefoot.wbc.types import GRAVITY

pytestmark = pytest.mark.unit

PERIOD = 2e-3


@pytest.mark.parametrize("variable", ["", "0"])
def test_both_soles_that_slip_at_once_slip_once(robot, monkeypatch, variable):
    """On ground other than the believed, too: what pulls one sole to it leaves the other where it is.

    Soles that were landed by turns, each on the believed height, were found slipped at every tick from then on.
    """
    monkeypatch.setenv(VARIABLE, variable)
    believed, landed = [0.0], []
    land = SensedState._land
    monkeypatch.setattr(SensedState, "_land", lambda self, k, *rest: landed.append(k) or land(self, k, *rest))
    feet = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])
    up = np.array([0.0, 0.0, 1.0])
    footing = Footing(feet, np.zeros(2), (0.1, 0.05), lambda x, y: believed[0], lambda x, y: up)
    estimator = SensedState(robot.model, robot.frames.soles, ImuMount(), footing, PERIOD, EstimatorParameters())
    load, joints = np.zeros((2, 6)), robot.standing[7:].copy()
    load[:, 2] = 490.0

    def sense(tick):
        rate, force, torque = np.zeros(3), GRAVITY * up, np.zeros(len(joints))
        still = [Reading(values, 0.0, True) for values in (joints.copy(), torque, rate, rate, force, load)]
        return estimator.sense(Readings(PERIOD * tick, still[0], None, *still[1:])).state

    for tick in range(100):
        sense(tick)
    del landed[:]
    believed[0] = 3e-3
    # All joints of both legs turn at once, so that no sole is where it stood.
    joints[:] += 5e-3
    for tick in range(100, 200):
        state = sense(tick)
    assert sorted(landed) == [0, 1]
    assert np.abs(state.v[:6]).max() < 2e-2


def test_the_covariance_counts_what_was_taken_and_nothing_else():
    """Ticks without encoders, and ticks whose kinematics were refused, leave it as it is."""
    rng = np.random.default_rng(3)
    columns = rng.normal(size=(4, 3))
    stand = Stand(np.eye(3), columns, np.stack((np.eye(3),) * 2), np.zeros(3), np.zeros(3), np.zeros(4))
    filter_ = InvariantFilter(stand, SensorNoise(), GroundNoise())
    J, y, Y = 0.1 * rng.normal(size=(2, 6, 4)), stand.d - stand.p, stand.Z.copy()
    filter_.weigh(J)
    filter_.P[:] += 1e-6 * np.eye(len(filter_.P))
    began = filter_.P.copy()
    filter_.weigh(J)
    np.testing.assert_allclose(filter_.P, began, atol=1e-6 * np.abs(began).max())
    off = y + np.array([[0.02, 0.0, 0.0], [0.0, -0.03, 0.0]])
    assert filter_.correct(off, Y) == (0, 1)
    filter_.weigh(J)
    np.testing.assert_allclose(filter_.P, began, atol=1e-6 * np.abs(began).max())
    for _ in range(5):
        assert filter_.correct(y, Y) == ()
    filter_.weigh(J)
    assert np.trace(began - filter_.P) > 0.1 * np.trace(began[:15, :15])
    assert np.linalg.eigvalsh(began - filter_.P).min() > -1e-12
