"""The feet as they are sensed for the controller, whoever tells of them."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.run.sensed import foot_sensing
from surefoot.wbc.estimation.estimate import Estimate
from surefoot.wbc.types import RobotState

pytestmark = pytest.mark.unit


@pytest.mark.parametrize("age", [0.0, 0.004])
def test_a_wrench_is_as_old_as_its_readings_and_what_infers_it_make_it(age):
    wrench = np.arange(12.0).reshape(2, 6)
    told = Estimate(RobotState(np.zeros(7), np.zeros(6)), wrench_age=age)
    felt = foot_sensing(told, wrench, True)
    assert (felt.wrench_age, felt.load_deviation, felt.normal_force) == (age, (0.0, 0.0), (2.0, 8.0))
    inferred = foot_sensing(told, wrench, True, SimpleNamespace(deviation=(3.0, 0.5), late=0.01))
    assert inferred.wrench_age == pytest.approx(age + 0.01)
    assert inferred.load_deviation == (3.0, 0.5)
