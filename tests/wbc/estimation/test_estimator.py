"""The estimator as a whole, apart from any walk."""

import numpy as np
import pytest

from surefoot.readings import Reading, Readings
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.footing import Footing, ImuMount
from surefoot.wbc.estimation.parameters import EstimatorParameters

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("lost", ["joints", "rate"])
def test_first_readings_that_are_not_finite_make_a_state_that_is_not(robot, lost):
    """The controller says so then, in a sentence."""
    said = {"joints": robot.standing[7:].copy(), "rate": np.zeros(3), "force": np.array([0.0, 0.0, 9.81])}
    said[lost][0] = np.nan
    load = np.zeros((2, 6))
    load[:, 2] = 490.0
    joints, rate, force, torque, wrench = (
        Reading(values, 0.0, True) for values in (*said.values(), np.zeros(robot.nv - 6), load)
    )
    feet = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])
    footing = Footing(feet, np.zeros(2), (0.1, 0.05), lambda x, y: 0.0, lambda x, y: np.array([0.0, 0.0, 1.0]))
    estimator = SensedState(robot.model, robot.frames.soles, ImuMount(), footing, 2e-3, EstimatorParameters())
    state = estimator.sense(Readings(0.0, joints, None, torque, rate, rate, force, wrench)).state
    assert not np.isfinite(state.q).all() or not np.isfinite(state.v).all()
