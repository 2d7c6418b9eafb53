"""Active inequalities from the factors of the equalities, against DAQP."""

import numpy as np
import pytest

import surefoot
from surefoot.wbc.qp import UNBOUNDED, QpLayout, allocate
from surefoot.wbc.solvers import CompiledEqualities, Daqp, EqualityFirst

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(("name", "robot"), [("walk-fast", "humanoid100"), ("walk", "g1")])
def test_the_minimisers_of_a_walk_are_those_of_daqp(kernels, name, robot):
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


def test_random_problems_with_many_active_inequalities(kernels):
    rng, daqp = np.random.default_rng(11), Daqp()
    most, given_up = 0, 0
    for _ in range(200):
        qp = random_qp(rng, 2.0)
        solver = CompiledEqualities(kernels, 1e-9, qp)
        if solver.run() <= 1e-9:
            continue
        mine, right = solver.activate(), daqp.solve(qp)
        given_up += mine is None
        if mine is not None:
            np.testing.assert_allclose(mine.x, right.x, rtol=0.0, atol=1e-9 * max(1.0, np.abs(right.x).max()))
            most = max(most, mine.iterations)
    assert most > 5
    assert given_up < 20


def test_what_contradicts_itself_is_given_up(kernels):
    qp = random_qp(np.random.default_rng(2), 2.0)
    qp.A[-1] = qp.A[-2]
    qp.bounds_lower[-2:], qp.bounds_upper[-2:] = (-UNBOUNDED, 5.0), (-5.0, UNBOUNDED)
    solver = CompiledEqualities(kernels, 1e-9, qp)
    assert np.isfinite(solver.run())
    assert solver.activate() is None
    assert EqualityFirst().solve(qp) is None
