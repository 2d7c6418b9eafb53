"""The kernel that makes a plan's motion at once against the three steps of its law, which others take one by one."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.laws.footstep_tvmpc import FootstepTvmpc
from surefoot.planner.laws.law import MotionProblem, StepContext
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.swing.step_region import reachable_shifts
from surefoot.planner.types import SolverStatus

pytestmark = pytest.mark.unit

P = PROFILES["default"].parameters


def problem_of(seed: int) -> MotionProblem:
    rng, count = np.random.default_rng(seed), P.horizon + P.preview + 1
    ramp = np.clip((np.arange(count)[:, None] - (20, 90)) / 25, 0.0, 1.0)
    stiffness = 9.0 + np.sin(0.1 * np.arange(count))
    reference = ZmpReference(ramp @ [[0.2, 0.1], [0.3, -0.2]], ramp, np.full((count, 2), 0.03), np.zeros(count))
    increment, free = np.full((2, 2), 0.2), (True, True)
    bounds = reachable_shifts(P, increment, 1.0, free, np.zeros(2), 0.4)
    steps = StepContext(increment, (1.0, -1.0), free, np.zeros(2), 0.4, 0.2, *bounds)
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    before, ahead = rng.normal(size=(P.horizon, 2)), (stiffness, np.sqrt(stiffness) + 0.1, reference)
    return MotionProblem.after(before, 0.1 * rng.normal(size=(2, 3)), ahead, steps, turn)


def test_the_motion_is_that_of_the_three_steps_to_the_bit(kernels):
    law = FootstepTvmpc(P, 1.0)
    for seed in range(5):
        problem = problem_of(seed)
        built, whole = law.build(problem), law.plan(problem)
        motion = law.interpret(problem, built, law.solve(built))
        for name in ("jerk", "shifts", "zmp_slack", "terminal_slack", "solver"):
            np.testing.assert_array_equal(getattr(whole, name), getattr(motion, name))


def test_qps_are_those_of_their_plan_whenever_they_are_looked_at(kernels):
    law, problem = FootstepTvmpc(P, 1.0), problem_of(0)
    motion, built = law.plan(problem), law.build(problem)
    law.plan(problem_of(1))
    for found, right in zip(motion.qps, built.axes, strict=True):
        for name in ("P", "q", "G", "h", "lower", "upper"):
            np.testing.assert_array_equal(getattr(found, name), getattr(right, name))


def test_where_an_axis_is_not_solved_the_jerk_before_is_kept(kernels):
    law, problem = FootstepTvmpc(P, 1.0), problem_of(0)
    problem.state[:, 1:] = np.nan
    motion = law.plan(problem)
    assert motion.solver is SolverStatus.HELD
    np.testing.assert_allclose(motion.jerk[:-1], (problem.before @ problem.rotation)[1:], atol=1e-12)
    assert not motion.jerk[-1].any()


def test_a_law_with_a_step_of_its_own_takes_it(kernels):
    class Halved(FootstepTvmpc):
        def solve(self, built):
            return tuple(replace(solution, z=0.5 * solution.z) for solution in super().solve(built))

    problem = problem_of(0)
    whole = FootstepTvmpc(P, 1.0).plan(problem)
    np.testing.assert_array_equal(Halved(P, 1.0).plan(problem).shifts, 0.5 * whole.shifts)


def test_the_jerk_before_is_turned_once_it_is_asked_for():
    problem = problem_of(0)
    turned = problem.before @ problem.rotation
    np.testing.assert_array_equal(problem.last_jerk, turned[0])
    np.testing.assert_array_equal(problem.fallback, np.vstack((turned[1:], np.zeros((1, 2)))))
    with pytest.raises(AttributeError, match="no attribute 'jerk'"):
        _ = problem.jerk
