"""The dual method against DAQP: same optimum with few and many active constraints, and none where there is none."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.laws.bounded_qp import BoundedQp
from surefoot.planner.laws.qp import AxesSolver, Qp, solve

pytestmark = pytest.mark.unit

SIZES = [(4, 3), (14, 102), (9, 40)]


def some(rng: np.random.Generator, n: int, rows: int, tight: float) -> Qp:
    """A QP with a point that keeps all of its constraints, the nearer the tighter; some variables cannot move."""
    root, inside = rng.normal(size=(n + 2, n)), rng.normal(size=n)
    G, room = rng.normal(size=(rows, n)), tight * rng.uniform(size=rows)
    lower, upper = inside - tight * rng.uniform(size=n), inside + tight * rng.uniform(size=n)
    lower[0] = upper[0] = inside[0]
    upper[1], lower[2] = np.inf, -np.inf
    return Qp(root.T @ root + 0.1 * np.eye(n), 5.0 * rng.normal(size=n), G, G @ inside + room, lower, upper)


@pytest.mark.parametrize(("n", "rows"), SIZES)
@pytest.mark.parametrize("tight", [0.0, 0.02, 0.5, 20.0])
def test_the_optimum_is_that_of_daqp(n, rows, tight):
    solver, rng = AxesSolver(("daqp", "none")), np.random.default_rng(7)
    for _ in range(30):
        one = some(rng, n, rows, tight)
        other = replace(one, q=rng.normal(size=n))
        for qp, found in zip((one, other), solver.solve(one, other), strict=True):
            assert found.attempt == 0 and found.z is not None
            wanted = solve(qp).z
            np.testing.assert_allclose(found.z, wanted, rtol=0.0, atol=1e-7 if tight == 0.0 else 1e-8)
            assert (qp.G @ found.z - qp.h).max() < 1e-9
            assert ((qp.lower - found.z).max(), (found.z - qp.upper).max()) < (1e-9, 1e-9)


def test_rows_that_stand_twice_do_no_harm():
    rng = np.random.default_rng(5)
    for _ in range(20):
        one = some(rng, 9, 40, 0.5)
        twice = replace(one, G=np.concatenate((one.G, one.G)), h=np.concatenate((one.h, one.h)))
        found = AxesSolver(("daqp", "none")).solve(twice, twice)[0].z
        np.testing.assert_allclose(found, solve(one).z, atol=1e-8)


def impossible(fine: Qp) -> Qp:
    """The same with a variable that is to be below -9 and above 9."""
    row = np.zeros((2, len(fine.q)))
    row[:, 0] = 1.0, -1.0
    return replace(fine, G=np.concatenate((fine.G, row)), h=np.concatenate((fine.h, [-9.0, -9.0])))


def test_it_says_where_there_is_no_optimum():
    fine = some(np.random.default_rng(3), 9, 40, 0.5)
    empty, solver = impossible(fine), BoundedQp(42, 9)
    for P, definite in ((-fine.P, False), (np.full((9, 9), np.nan), False), (empty.P, True)):
        solver.factorise(P, empty.G)
        assert solver.is_definite is definite
        assert definite or solver.minimised(empty.q, empty.h, empty.lower, empty.upper) is None
    assert solver.minimised(empty.q, empty.h, empty.lower, empty.upper) is None
    room = np.append(fine.h, [9.0, 9.0])
    assert solver.minimised(np.full(9, np.nan), room, fine.lower, fine.upper) is None
    room[3] = np.nan
    assert solver.minimised(fine.q, room, fine.lower, fine.upper) is None
    room[3] = fine.h[3]
    found = solver.minimised(fine.q, room, fine.lower, fine.upper)
    np.testing.assert_allclose(found, solve(fine).z, atol=1e-8)
    np.testing.assert_array_equal(solver.minimised(fine.q, room, fine.lower, fine.upper), found)


def test_what_it_does_not_solve_the_solvers_are_asked():
    fine = some(np.random.default_rng(3), 9, 40, 0.5)
    flat, no_number = replace(fine, P=-fine.P), replace(fine, q=np.full(9, np.nan))
    for wrong in (impossible(fine), flat, no_number):
        first, second = AxesSolver(("daqp",)).solve(wrong, fine)
        assert first.z is None and first.attempt == 1
        np.testing.assert_allclose(second.z, solve(fine).z, atol=1e-8)
    for solvers in (("piqp", "daqp"), ("piqp",)):
        other = AxesSolver(solvers).solve(fine, fine)[0]
        assert np.array_equal(other.z, solve(fine, solvers).z)


def test_arrays_may_lie_in_memory_as_they_like():
    fine = some(np.random.default_rng(4), 9, 40, 0.5)
    spread = np.repeat(fine.q, 2)[::2]
    turned = replace(fine, P=np.asfortranarray(fine.P), G=np.asfortranarray(fine.G), q=spread)
    (one, _), (other, _) = (AxesSolver(("daqp",)).solve(qp, qp) for qp in (fine, turned))
    np.testing.assert_array_equal(one.z, other.z)


@pytest.mark.parametrize("n", [1, 5])
def test_inequalities_that_the_minimiser_meets_exactly_are_not_active(n):
    """Nor is one to within the tolerance: no step is made for it."""
    solver, at, free = BoundedQp(n, n), np.linspace(1.0, 2.0, n), np.full(n, np.inf)
    solver.factorise(np.eye(n), np.eye(n))
    for h, lower, upper in ((at, -free, free), (free, at, free), (free, -free, at)):
        np.testing.assert_allclose(solver.minimised(-at, h, lower, upper), at, atol=1e-15)
        assert solver.iterate() == 0
