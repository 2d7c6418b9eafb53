"""An estimator that is given the measurement may say how sure it is, as one that senses does."""

import numpy as np
import pytest

from surefoot.errors import PartError
from surefoot.parts.guard import OWN_GUARD, Guard
from surefoot.scenarios.run.sensed import Senses
from surefoot.sim.measurement import Measurement
from surefoot.wbc.estimation.estimate import Deviation, Estimate
from surefoot.wbc.types import RobotState

pytestmark = pytest.mark.unit

DEVIATION = Deviation(np.zeros(3), np.array([0.1, 0.2, 0.3]), np.zeros(2), np.zeros(2), 0.0, 4.0, 3.0)


class Sure:
    """Hands the truth on, with a deviation."""

    is_truth = False

    def __init__(self, deviation=DEVIATION, wrench=None, lacking=0):
        self.given = deviation, wrench, lacking

    def estimate(self, measurement):
        deviation, wrench, lacking = self.given
        state = RobotState(measurement.q, measurement.v[lacking:])
        return Estimate(state, wrench, deviation=deviation)


def measured():
    q, v = np.concatenate((np.zeros(6), [1.0], np.ones(4))), np.arange(10.0)
    return Measurement.of_state(0.5, q, v, np.zeros(4), np.full((2, 6), 7.0))


def test_its_deviation_is_handed_on_with_the_wrench_of_the_sensors():
    seen = measured()
    estimate = Senses(Sure(), OWN_GUARD)(seen)
    assert estimate.deviation is DEVIATION
    assert np.array_equal(estimate.wrench, seen.wrench) and np.array_equal(estimate.state.v, seen.v)


def test_its_own_wrench_counts_before_that_of_the_sensors():
    assert np.array_equal(Senses(Sure(wrench=np.ones((2, 6))), OWN_GUARD)(measured()).wrench, np.ones((2, 6)))


@pytest.mark.parametrize(
    ("keys", "why"),
    [
        ({"lacking": 1}, "gave v of shape"),
        ({"wrench": np.ones(6)}, "gave wrench of shape"),
        ({"deviation": Deviation(*([np.zeros(2)] * 4), 0.0, 0.0, 0.0)}, "gave deviation.com of shape"),
    ],
)
def test_what_does_not_fit_is_refused(keys, why):
    with pytest.raises(PartError, match=why):
        Senses(Sure(**keys), Guard("estimator 'sure' of this test"))(measured())
