import numpy as np
import pytest
import qpsolvers

from surefoot.planner.laws.footstep_tvmpc import solve_problem
from surefoot.planner.laws.law import solve
from surefoot.planner.model.jerk import predict
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.types import CentroidalState, SolverStatus
from surefoot.planner.walk.gait import GaitParameters

pytestmark = pytest.mark.unit


def problem_at(stand, com=(0.0, 0.0), velocity=(0.0, 0.0), ticks=1, **parameters):
    gait = GaitParameters(lateral_step=0.1, initial_stand=0.0)
    planner = WalkingPlanner(gait, stand(), 0.075, 0.075, parameters=PlannerParameters(**parameters))
    for tick in range(ticks):
        state = CentroidalState(0.02 * tick, np.array([*com, 1.0]), np.array([*velocity, 0.0]))
        planner.update(state, stand())
    return planner.motion.qps


def kkt_residuals(qp, solver):
    solution = qpsolvers.solve_problem(qp.problem(), solver, **({"primal_tol": 1e-9} if solver == "daqp" else {}))
    return solution.x, solution.primal_residual(), solution.dual_residual(), solution.duality_gap()


@pytest.mark.parametrize("com", [(0.0, 0.0), (0.01, -0.02), (0.04, -0.1), (0.2, 0.3)])
def test_solution_passes_kkt_and_two_solvers_agree(stand, com):
    for qp in problem_at(stand, com, ticks=3):
        first, *residuals = kkt_residuals(qp, "daqp")
        second, *_ = kkt_residuals(qp, "quadprog")
        assert max(residuals) < 1e-8
        np.testing.assert_allclose(first, second, atol=1e-5)
        assert qp.P @ first @ first / 2 + qp.q @ first == pytest.approx(qp.P @ second @ second / 2 + qp.q @ second)


def test_cost_is_the_sum_of_squares_it_says(stand):
    """Along any two points the quadratic part equals that of the predicted ZMP errors and weights."""
    qp, p = problem_at(stand, (0.01, -0.02), ticks=3)[1], PlannerParameters()
    np.testing.assert_allclose(qp.P, qp.P.T, atol=1e-12)
    assert np.linalg.eigvalsh(qp.P).min() > 0.0
    z = np.random.default_rng(0).normal(size=14)
    zmp_rows, end_row = qp.G[:50, :12], qp.G[100, :12]
    expected = np.sum((zmp_rows @ z[:12]) ** 2) + p.terminal_weight * (end_row @ z[:12]) ** 2
    expected += p.jerk_weight * z[:10] @ z[:10] + p.step_weight * z[10:12] @ z[10:12]
    expected += p.zmp_slack[0] * z[12] ** 2 + p.terminal_slack[0] * z[13] ** 2
    assert 0.5 * z @ qp.P @ z == pytest.approx(expected)


def test_any_state_has_a_solution_and_its_slack_is_reported(stand):
    problem = problem_at(stand, (0.5, 0.5), (2.0, -2.0))
    prediction = predict(0.02, np.eye(50)[:, :10])
    solution = solve_problem(problem, prediction, ("daqp", "quadprog"), np.zeros((50, 2)))
    assert solution.solver is SolverStatus.SOLVED
    assert np.all(solution.zmp_slack + solution.terminal_slack > 0.1)


def test_rate_limit_bounds_every_change_of_jerk(stand):
    qp = problem_at(stand, (0.0, 0.02), jerk_limit=1.5, jerk_rate_limit=0.1)[1]
    moves = solve(qp, ("daqp", "quadprog")).z[:10]
    assert np.abs(np.diff(moves, prepend=0.0)).max() <= 0.1 + 1e-8
    assert np.abs(np.diff(moves, prepend=0.0)).max() > 0.09


def test_second_solver_is_used_and_said(stand):
    qp = problem_at(stand)[0]
    assert solve(qp, ("no-such-solver", "quadprog")).attempt == 1


def test_without_any_solver_the_fallback_jerk_is_kept(stand):
    problem, prediction = problem_at(stand), predict(0.02, np.eye(50)[:, :10])
    fallback = np.random.default_rng(0).normal(size=(50, 2))
    solution = solve_problem(problem, prediction, ("none", "neither"), fallback)
    assert solution.solver is SolverStatus.HELD
    np.testing.assert_array_equal(solution.jerk, fallback)
    assert np.isnan(solution.zmp_slack).all()
