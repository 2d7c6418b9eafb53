from dataclasses import replace

import numpy as np
import pytest
import qpsolvers

from surefoot.planner.laws.footstep_tvmpc import FootstepTvmpc
from surefoot.planner.laws.law import MotionProblem, StepContext
from surefoot.planner.laws.qp import OPTIONS, solve
from surefoot.planner.model.dcm import nominal_dcm
from surefoot.planner.parameters import SOLVERS, PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.step_region import reachable_shifts
from surefoot.planner.types import CentroidalState, SolverStatus

pytestmark = pytest.mark.unit


def problem_at(stand, com=(0.0, 0.0), velocity=(0.0, 0.0), ticks=1, **parameters):
    gait = GaitParameters(lateral_step=0.1, initial_stand=0.0)
    planner = WalkingPlanner(gait, stand(), 0.075, 0.075, parameters=PlannerParameters(**parameters))
    for tick in range(ticks):
        state = CentroidalState(0.02 * tick, np.array([*com, 1.0]), np.array([*velocity, 0.0]))
        planner.update(state, stand())
    return planner.motion.qps


def kkt_residuals(qp, solver):
    solution = qpsolvers.solve_problem(qp.problem(), solver, **OPTIONS[solver])
    return solution.x, solution.primal_residual(), solution.dual_residual(), solution.duality_gap()


@pytest.mark.parametrize("com", [(0.0, 0.0), (0.01, -0.02), (0.04, -0.1), (0.2, 0.3)])
def test_solution_passes_kkt_and_two_solvers_agree(stand, com):
    for qp in problem_at(stand, com, ticks=3):
        first, *residuals = kkt_residuals(qp, SOLVERS[0])
        second, *_ = kkt_residuals(qp, SOLVERS[1])
        assert max(residuals) < 1e-8
        np.testing.assert_allclose(first, second, atol=1e-5)
        assert qp.P @ first @ first / 2 + qp.q @ first == pytest.approx(qp.P @ second @ second / 2 + qp.q @ second)


def tick_of(fallback=None, **parameters):
    """A tick with everything varying, and the law for it; with a limit on its rate the moves are the whole jerk."""
    p = PlannerParameters(jerk_rate_limit=1e3, **parameters)
    rng, count = np.random.default_rng(4), p.horizon + p.preview + 1
    ramp = np.clip((np.arange(count)[:, None] - (20, 90)) / 25, 0.0, 1.0)
    stiffness = 9.0 + np.sin(0.1 * np.arange(count))
    reference = ZmpReference(ramp @ [[0.2, 0.1], [0.3, -0.2]], ramp, np.full((count, 2), 0.03), np.zeros(count))
    increment, free = np.full((2, 2), 0.2), (True, True)
    bounds = reachable_shifts(p, increment, 1.0, free, np.zeros(2), 0.4)
    steps = StepContext(increment, (1.0, -1.0), free, np.zeros(2), 0.4, 0.2, *bounds)
    fallback = np.zeros((p.horizon, 2)) if fallback is None else fallback
    state, omega = rng.normal(size=(2, 3)), np.sqrt(stiffness) + 0.1
    problem = MotionProblem(state, stiffness, omega, reference, steps, np.zeros(2), fallback, np.eye(2))
    return FootstepTvmpc(p, 1.0), problem, p


def cost_of(z, axis, problem, p):
    """The cost in words: the jerk of each block through the integrator, sample by sample, and what it costs."""
    t, (x, v, a), shifts = p.sample_time, problem.state[axis], z[10:12]
    target, gain, cost = problem.reference.point[:, axis], problem.reference.gain, 0.0
    for k in range(p.horizon):
        u = z[sum(start <= k for start in p.moves) - 1]
        x, v, a = x + t * v + t**2 / 2 * a + t**3 / 6 * u, v + t * a + t**2 / 2 * u, a + t * u
        cost += (x - a / problem.stiffness[k + 1] - target[k + 1] - gain[k + 1] @ shifts) ** 2
    n = p.horizon
    viable = nominal_dcm(problem.stiffness[n:], problem.omega[n:], (target + gain @ shifts)[n:, None], t)[0, 0]
    cost += p.terminal_weight * (x + v / problem.omega[n] - viable) ** 2
    cost += p.jerk_weight * z[:10] @ z[:10] + p.step_weight * shifts @ shifts
    return cost + sum(c[0] * s**2 + c[1] * s for c, s in ((p.zmp_slack, z[12]), (p.terminal_slack, z[13])))


def test_cost_is_the_sum_of_squares_it_says():
    law, problem, p = tick_of(jerk_weight=1e-3)
    for axis, qp in enumerate(law.build(problem).axes):
        np.testing.assert_allclose(qp.P, qp.P.T, atol=1e-12)
        assert np.linalg.eigvalsh(qp.P).min() > 0.0
        for z in np.random.default_rng(axis).normal(size=(5, 14)) * [*[5.0] * 10, 0.1, 0.1, 0.1, 0.1]:
            expected = cost_of(z, axis, problem, p) - cost_of(np.zeros(14), axis, problem, p)
            assert 0.5 * z @ qp.P @ z + qp.q @ z == pytest.approx(expected, rel=1e-9)


def test_any_state_has_a_solution_and_its_slack_is_reported():
    law, problem, _ = tick_of()
    problem = replace(problem, state=np.array([[0.5, 2.0, 0.0], [0.5, -2.0, 0.0]]))
    motion = law.plan(problem)
    assert motion.solver is SolverStatus.SOLVED
    assert np.all(motion.zmp_slack + motion.terminal_slack > 0.1)


def test_rate_limit_bounds_every_change_of_jerk(stand):
    qp = problem_at(stand, (0.0, 0.02), jerk_limit=1.5, jerk_rate_limit=0.1)[1]
    moves = solve(qp).z[:10]
    assert np.abs(np.diff(moves, prepend=0.0)).max() <= 0.1 + 1e-8
    assert np.abs(np.diff(moves, prepend=0.0)).max() > 0.09


def test_second_solver_is_used_and_said(stand):
    qp = problem_at(stand)[0]
    assert solve(qp, ("no-such-solver", SOLVERS[1])).attempt == 1
    np.testing.assert_allclose(solve(qp, ("no-such-solver", SOLVERS[1])).z, solve(qp).z, atol=1e-5)


def test_both_solvers_find_out_what_has_no_solution(stand):
    qp = problem_at(stand)[0]
    impossible = replace(qp, G=np.vstack((qp.G[:1], -qp.G[:1])), h=np.array([-1.0, 0.5]))
    for name in SOLVERS:
        assert solve(impossible, (name,)).z is None


def test_without_any_solver_the_fallback_jerk_is_kept():
    fallback = np.random.default_rng(0).normal(size=(50, 2))
    law, problem, _ = tick_of(fallback, solvers=("none", "neither"))
    motion = law.plan(problem)
    assert motion.solver is SolverStatus.HELD
    np.testing.assert_array_equal(motion.jerk, fallback)
    assert np.isnan(motion.zmp_slack).all()
    assert not motion.shifts.any()


def test_the_three_steps_are_the_plan():
    law, problem, _ = tick_of()
    built = law.build(problem)
    motion, whole = law.interpret(problem, built, law.solve(built)), law.plan(problem)
    np.testing.assert_array_equal(motion.jerk, whole.jerk)
    np.testing.assert_array_equal(motion.shifts, whole.shifts)
    halved = tuple(replace(solution, z=0.5 * solution.z) for solution in law.solve(built))
    np.testing.assert_allclose(law.interpret(problem, built, halved).jerk, 0.5 * whole.jerk)
