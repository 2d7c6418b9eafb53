"""Active inequalities from the factors of the equalities, against DAQP."""

import numpy as np
import pytest

import surefoot
from surefoot.wbc.qp.data import UNBOUNDED, QpLayout, allocate
from surefoot.wbc.qp.range_space import EqualityQp, InequalityQp
from surefoot.wbc.qp.solvers import Daqp, EqualityFirst

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(("name", "robot"), [("walk-brisk", "humanoid100"), ("walk-level", "g1")])
def test_the_minimisers_of_a_walk_are_those_of_daqp(name, robot):
    compared, daqp = [], Daqp()
    with surefoot.Simulation(surefoot.load(name, {"robot": robot})) as simulation:
        controller = simulation.controller
        while simulation.time < 2.4:
            simulation.advance()
            solution = simulation.look().report
            if solution.iterations:
                qp, mine = controller.qp, EqualityFirst().solve(controller.qp)
                right = daqp.solve(qp)
                np.testing.assert_allclose(mine.x, right.x, rtol=0.0, atol=1e-9 * max(1.0, np.abs(right.x).max()))
                compared.append(mine.violation)
    assert len(compared) > 10
    assert max(compared) < 1e-7


def random_qp(rng, tight):
    """A strictly convex QP with room for its equalities, whose inequalities are tight."""
    qp = allocate(QpLayout(nv=14, cone_rows=8))
    n, m = qp.g.shape[0], qp.A.shape[0]
    root = rng.normal(size=(n, n))
    qp.H[:], qp.g[:], qp.A[:] = root @ root.T + n * np.eye(n), 10.0 * rng.normal(size=n), rng.normal(size=(m, n))
    feasible = rng.normal(size=n)
    rows, bounds = qp.A @ feasible, rng.uniform(0.0, tight, (2, n + m))
    values = np.concatenate((feasible, rows))
    qp.bounds_lower[:], qp.bounds_upper[:] = values - bounds[0], values + bounds[1]
    qp.bounds_lower[n : n + 18] = qp.bounds_upper[n : n + 18] = rows[:18]
    return qp


def test_random_problems_with_many_active_inequalities():
    rng, daqp = np.random.default_rng(11), Daqp()
    most, given_up = 0, 0
    for _ in range(200):
        qp = random_qp(rng, 2.0)
        equalities = EqualityQp(qp)
        if equalities.solve() <= 1e-9:
            continue
        rounds, right = InequalityQp(equalities, 1e-9).solve(), daqp.solve(qp)
        given_up += rounds < 0
        if rounds >= 0:
            atol = 1e-9 * max(1.0, np.abs(right.x).max())
            np.testing.assert_allclose(equalities.x, right.x, rtol=0.0, atol=atol)
            most = max(most, rounds)
    assert most > 5
    assert given_up < 20


def test_what_contradicts_itself_is_given_up():
    qp = random_qp(np.random.default_rng(2), 2.0)
    qp.A[-1] = qp.A[-2]
    qp.bounds_lower[-2:], qp.bounds_upper[-2:] = (-UNBOUNDED, 5.0), (-5.0, UNBOUNDED)
    equalities = EqualityQp(qp)
    assert np.isfinite(equalities.solve())
    assert InequalityQp(equalities, 1e-9).solve() == -1
    assert EqualityFirst().solve(qp) is None


@pytest.mark.parametrize("apart", [False, True])
def test_the_equalities_alone_are_the_linear_system_of_lagrange(apart):
    """And where accelerations and wrenches do not meet in H, which goes another way."""
    rng = np.random.default_rng(8)
    for _ in range(20):
        qp = random_qp(rng, 2.0)
        n = len(qp.g)
        if apart:
            qp.H[:-12, -12:] = qp.H[-12:, :-12] = 0.0
        E, e = qp.A[:18], qp.bounds_lower[n : n + 18]
        system = np.block([[qp.H, E.T], [E, np.zeros((18, 18))]])
        wanted = np.linalg.solve(system, np.concatenate((-qp.g, e)))[:n]
        equalities = EqualityQp(qp)
        assert equalities.solve() == pytest.approx(qp.violation(equalities.x))
        np.testing.assert_allclose(equalities.x, wanted, atol=1e-8 * np.abs(wanted).max())


def test_what_has_no_minimiser_is_infinitely_wrong_and_what_is_no_number_none():
    qp = random_qp(np.random.default_rng(9), 2.0)
    right = EqualityQp(qp)
    assert np.isfinite(right.solve())
    flat, twice, none = qp.copy(), qp.copy(), qp.copy()
    flat.H[:] *= -1.0
    twice.A[1] = 0.0
    none.g[3] = np.nan
    assert EqualityQp(flat).solve() == EqualityQp(twice).solve() == np.inf
    assert np.isnan(EqualityQp(none).solve())
