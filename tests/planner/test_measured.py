"""The DCM of what is measured, and how sure it is."""

import math

import numpy as np
import pytest

from surefoot.planner.measured import Measured
from surefoot.planner.types import CentroidalState, FeetState

pytestmark = pytest.mark.unit

OMEGA = 3.2
FEET = FeetState(np.zeros((2, 3)), np.zeros(2), (True, True))


def on_a_pendulum(cop: np.ndarray, grows: np.ndarray, dies: np.ndarray, time: float) -> Measured:
    """x = p + a exp(ω t) + b exp(-ω t), which solves x'' = ω² (x - p)."""
    growing, dying = grows * math.exp(OMEGA * time), dies * math.exp(-OMEGA * time)
    com, velocity = cop + growing + dying, OMEGA * (growing - dying)
    return Measured(CentroidalState(time, np.append(com, 0.8), np.append(velocity, 0.3)), FEET)


@pytest.mark.parametrize("time", [0.0, 0.4])
def test_the_dcm_is_twice_what_diverges_and_knows_nothing_of_what_converges(time):
    rng = np.random.default_rng(3)
    for _ in range(20):
        cop, grows, dies, others = rng.normal(size=(4, 2))
        *dcm, omega = on_a_pendulum(cop, grows, dies, time).dcm(OMEGA)
        np.testing.assert_allclose(dcm, cop + 2.0 * grows * math.exp(OMEGA * time), atol=1e-12)
        np.testing.assert_allclose(dcm, on_a_pendulum(cop, grows, others, time).dcm(OMEGA)[:2], atol=1e-12)
        assert omega == OMEGA


def test_two_deviations_of_the_dcm_are_those_of_its_errors():
    deviation = (0.004, 0.02)
    rng = np.random.default_rng(5)
    errors = rng.normal(size=(20_000, 2)) * deviation
    doubted = Measured(CentroidalState(0.0, np.zeros(3), np.zeros(3), deviation=deviation), FEET)
    assert doubted.dcm_uncertainty(OMEGA) == pytest.approx(2.0 * np.std(errors[:, 0] + errors[:, 1] / OMEGA), rel=0.02)
    assert Measured(CentroidalState(0.0, np.zeros(3), np.zeros(3)), FEET).dcm_uncertainty(OMEGA) == 0.0


def test_what_is_not_finite_is_refused():
    with pytest.raises(ValueError, match="not finite at 1 s"):
        Measured(CentroidalState(1.0, np.array([0.0, math.nan, 0.8]), np.zeros(3)), FEET)
