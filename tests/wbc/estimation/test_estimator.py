"""The estimator as a whole, apart from any walk."""

import numpy as np
import pinocchio as pin
import pytest

from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.footing import Footing, ImuMount
from surefoot.wbc.estimation.parameters import EstimatorParameters, GroundNoise
from surefoot.wbc.types import GRAVITY

pytestmark = pytest.mark.unit


PERIOD = 2e-3


class Standing:
    """A robot that stands still under its estimator."""

    def __init__(self, robot, parameters=None):
        feet, up = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.array([0.0, 0.0, 1.0])
        footing = Footing(feet, np.zeros(2), (0.1, 0.05), lambda x, y: 0.0, lambda x, y: up)
        names, parameters = robot.frames.soles, parameters or EstimatorParameters()
        self.inner = SensedState(robot.model, names, ImuMount(), footing, PERIOD, parameters)
        self.joints, self.rate, self.force, self.tick = robot.standing[7:].copy(), np.zeros(3), GRAVITY * up, -1

    def sense(self, share=0.5, fresh=True):
        """The estimate of the next tick, with a share of the weight on the left foot, encoders fresh or not."""
        load = np.zeros((2, 6))
        load[:, 2] = 980.0 * share, 980.0 * (1.0 - share)
        load[:, 3] = 5.0 * share, -7.0 * share
        self.tick += 1
        encoders = Reading(self.joints, 0.0, fresh)
        torque, rate, force, wrench = (
            Reading(values, 0.0, True) for values in (np.zeros_like(self.joints), self.rate, self.force, load)
        )
        return self.inner.sense(Readings(PERIOD * self.tick, encoders, None, torque, rate, rate, force, wrench))


def test_standing_soles_sink_by_all_that_their_loads_change(robot):
    """Springs give by the change of the wrench over any time, in however many ticks it came."""
    standing, give = Standing(robot), GroundNoise().depth / (GRAVITY * sum(i.mass for i in robot.model.inertias))
    for _ in range(6):
        first = standing.sense().wrench
    state = standing.inner.filter.stand
    place, turn = state.d.copy(), state.Z.copy()
    for share in np.repeat(np.linspace(0.5, 0.7, 8), 5):
        # Without encoders nothing else moves the soles.
        last = standing.sense(share, fresh=False).wrench
    changed = last - first
    assert np.abs(changed[:, 2]).min() > 50.0
    np.testing.assert_allclose(state.d[:, 2] - place[:, 2], -give * changed[:, 2], rtol=1e-9)
    for k in (0, 1):
        rolled = pin.log3(state.Z[k] @ turn[k].T)
        assert rolled[0] == pytest.approx(-give * changed[k, 3] / 0.05**2, rel=1e-6)


@pytest.mark.parametrize("lost", ["joints", "rate"])
def test_first_readings_that_are_not_finite_make_a_state_that_is_not(robot, lost):
    """The controller says so then, in a sentence."""
    standing = Standing(robot)
    {"joints": standing.joints, "rate": standing.rate}[lost][0] = np.nan
    state = standing.sense().state
    assert not np.isfinite(state.q).all() or not np.isfinite(state.v).all()
