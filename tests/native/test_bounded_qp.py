"""The dual kernel against DAQP: same optimum with few and many active constraints, and none where there is none."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.native.library import VARIABLE
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
def test_the_optimum_is_that_of_daqp(kernels, n, rows, tight):
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


def test_what_the_kernel_does_not_solve_the_solvers_are_asked(kernels, monkeypatch):
    rng = np.random.default_rng(3)
    fine = some(rng, 9, 40, 0.5)
    row = np.zeros((2, 9))
    row[:, 0] = 1.0, -1.0
    empty = replace(fine, G=np.concatenate((fine.G, row)), h=np.concatenate((fine.h, [-9.0, -9.0])))
    flat, no_number = replace(fine, P=-fine.P), replace(fine, q=np.full(9, np.nan))
    for wrong in (empty, flat, no_number):
        first, second = AxesSolver(("daqp",)).solve(wrong, fine)
        assert first.z is None and first.attempt == 1
        np.testing.assert_allclose(second.z, solve(fine).z, atol=1e-8)
    one = AxesSolver(("piqp", "daqp")).solve(fine, fine)[0]
    monkeypatch.setenv(VARIABLE, "0")
    for solvers in (("piqp", "daqp"), ("daqp", "piqp")):
        plain = AxesSolver(solvers).solve(fine, fine)[0]
        assert np.array_equal(plain.z, solve(fine, solvers).z)
    assert one.attempt == 0
