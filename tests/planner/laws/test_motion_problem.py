import numpy as np
import pytest

from surefoot.planner.laws.law import MotionProblem, StepContext
from surefoot.planner.references.zmp_reference import ZmpReference

pytestmark = pytest.mark.unit


def test_the_jerk_before_is_turned_into_the_plan_frame():
    before, turn = np.random.default_rng(0).normal(size=(50, 2)), np.array([[0.8, -0.6], [0.6, 0.8]])
    still = np.zeros((2, 2))
    reference = ZmpReference(np.zeros((9, 2)), np.zeros((9, 2)), np.ones((9, 2)), np.zeros(9), np.zeros((9, 2)))
    steps = StepContext(still, (1.0, -1.0), (False, False), None, 0.0, 0.0, still, still)
    problem = MotionProblem.after(before, np.zeros((2, 3)), (np.ones(9), np.ones(9), reference), steps, turn)
    turned = before @ turn
    np.testing.assert_array_max_ulp(problem.last_jerk, turned[0], 4)
    np.testing.assert_allclose(problem.fallback, np.vstack((turned[1:], np.zeros((1, 2)))), rtol=1e-14, atol=1e-16)
