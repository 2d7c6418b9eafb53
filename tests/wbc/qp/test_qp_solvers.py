"""Every solver finds the minimiser of whole-body QPs, with and without active inequalities."""

import numpy as np
import pytest
from scipy.optimize import nnls

from surefoot.wbc.qp.data import EQUALITY_ROWS, FOOT_ROWS, UNBOUNDED, QpLayout, allocate
from surefoot.wbc.qp.solvers import Daqp, equalities_only, make_solver

pytestmark = pytest.mark.unit

NAMES = ("equality-first", "daqp", "proxqp")


def kkt_residual(qp, x):
    """Norm of what no admissible multipliers balance, relative to the gradient; the active set is read off x."""
    n, eq = x.size, EQUALITY_ROWS
    values = np.concatenate([x, qp.A @ x])
    rows, tolerance = np.vstack([np.eye(n), qp.A]), 1e-5
    free = np.zeros(values.size, dtype=bool)
    free[n : n + eq] = True
    low = ~free & (values < qp.bounds_lower + tolerance)
    high = ~free & (values > qp.bounds_upper - tolerance)
    columns = np.vstack([rows[free], -rows[free], -rows[low], rows[high]]).T
    gradient = qp.H @ x + qp.g
    scale = np.linalg.norm(columns, axis=0)
    return nnls(columns / scale, -gradient)[1] / np.linalg.norm(qp.g), int(low.sum() + high.sum())


@pytest.mark.parametrize("name", NAMES)
def test_the_answer_satisfies_the_kkt_conditions(problems, name):
    solver, active = make_solver(name), []
    for qp in problems:
        solution = solver.solve(qp)
        assert solution is not None
        assert solution.violation == pytest.approx(qp.violation(solution.x), abs=1e-10)
        assert solution.violation <= 1e-6
        residual, count = kkt_residual(qp, solution.x)
        assert residual < 1e-6
        active.append(count)
    assert min(active) == 0
    assert max(active) > 3


@pytest.mark.parametrize("name", [name for name in NAMES if name != "daqp"])
def test_all_solvers_agree(problems, name):
    solver, other = make_solver("daqp"), make_solver(name)
    for qp in problems:
        x, found = solver.solve(qp).x, other.solve(qp).x
        np.testing.assert_allclose(found, x, atol=1e-5 * max(1.0, np.abs(x).max()))


def test_a_wrong_answer_does_not_pass_the_kkt_check(problems):
    qp = problems[0]
    x = make_solver("daqp").solve(qp).x
    assert kkt_residual(qp, x + 1e-3 * np.ones_like(x))[0] > 1e-4


@pytest.mark.parametrize("name", NAMES)
def test_an_infeasible_problem_gets_no_answer(problems, name):
    qp = problems[0].copy()
    row = qp.g.size + EQUALITY_ROWS
    qp.A[EQUALITY_ROWS] = 0.0
    qp.bounds_lower[row], qp.bounds_upper[row] = 1.0, 2.0
    solution = make_solver(name).solve(qp)
    assert solution is None or solution.violation > 0.1


@pytest.mark.parametrize("soft", [None, np.array([3, 4])])
def test_what_lets_go_of_soles_counts_all_violations_but_theirs(problems, soft):
    """And breaks the rows of a sole where they contradict the dynamics, which it keeps."""
    for qp in (problem.copy() for problem in problems):
        n, held = qp.g.size, np.arange(2 * FOOT_ROWS)
        held = held[qp.A[held, : n - 2 * FOOT_ROWS].any(axis=1)]
        assert held.size
        qp.A[held[1]] = qp.A[held[0]]
        qp.bounds_lower[n + held[:2]] = qp.bounds_upper[n + held[:2]] = -5.0, 5.0
        assert Daqp(soft=soft).solve(qp) is None
        solution = Daqp(1e-6, soft=soft, lets_go=True).solve(qp)
        broken = np.concatenate((n + held, np.zeros(0, dtype=int) if soft is None else soft))
        assert np.abs(qp.A[held[:2]] @ solution.x - (-5.0, 5.0)).max() > 1.0
        assert solution.violation == pytest.approx(qp.violation(solution.x, broken), abs=1e-12)
        assert solution.violation < 1e-4


@pytest.mark.parametrize("name", NAMES)
def test_a_failure_does_not_poison_the_next_solve(problems, name):
    solver, fresh = make_solver(name), make_solver(name)
    poisoned = problems[0].copy()
    poisoned.g[:] = np.nan
    solver.solve(problems[0])
    solution = solver.solve(poisoned)
    assert solution is None or not solution.violation <= 1e-3
    after = solver.solve(problems[1])
    np.testing.assert_allclose(after.x, fresh.solve(problems[1]).x, atol=1e-5)


def test_equalities_alone_are_met_and_optimal(problems):
    for qp in problems:
        x, n = equalities_only(qp).x, qp.g.size
        E, e = qp.A[:EQUALITY_ROWS], qp.bounds_lower[n : n + EQUALITY_ROWS]
        np.testing.assert_allclose(E @ x, e, atol=1e-7)
        null = np.linalg.svd(E)[2][EQUALITY_ROWS:]
        assert np.abs(null @ (qp.H @ x + qp.g)).max() < 1e-6 * np.linalg.norm(qp.g)


def test_contradicting_equalities_have_no_minimiser(problems):
    for qp in (problem.copy() for problem in problems):
        row = qp.g.size + 1
        qp.A[1] = qp.A[0]
        qp.bounds_lower[row] = qp.bounds_upper[row] = qp.bounds_lower[row - 1] + 1.0
        solution = equalities_only(qp)
        assert solution is None or solution.violation > 0.49


def test_violation_measures_bounds_and_rows(problems):
    qp = problems[0]
    x = make_solver("daqp").solve(qp).x
    i = int(np.argmax(qp.bounds_upper[: x.size] < UNBOUNDED))
    beyond = x.copy()
    beyond[i] = qp.bounds_upper[i] + 1e4
    assert qp.violation(beyond) >= 1e4
    beyond[i] = np.nan
    assert np.isnan(qp.violation(beyond))
    layout = QpLayout(31, 16)
    assert allocate(layout).violation(np.zeros(layout.variables)) == 0.0


def test_an_unknown_solver_is_refused():
    with pytest.raises(ValueError, match="choose one of daqp, equality-first, proxqp"):
        make_solver("simplex")
