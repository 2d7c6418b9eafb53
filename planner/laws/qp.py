"""The QP of one axis, and its solution by the first solver that succeeds."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import daqp
import numpy as np

from surefoot.planner.laws.bounded_qp import BoundedQp
from surefoot.planner.parameters import SOLVERS
from surefoot.planner.types import Array

if TYPE_CHECKING:
    import qpsolvers

OPTIONS: dict[str, dict[str, Any]] = {
    "daqp": {"primal_tol": 1e-9, "dual_tol": 1e-12},
    "piqp": dict.fromkeys(("eps_abs", "eps_rel", "eps_duality_gap_abs", "eps_duality_gap_rel"), 1e-12),
}
"""Tolerances that make the solvers exact to the last digits that matter, by name."""

_UNBOUNDED = 1e30
"""A bound that DAQP takes for none, as its manual says [-]."""


@dataclass(frozen=True)
class Qp:
    """min ½ zᵀ P z + qᵀ z subject to G z <= h and lower <= z <= upper.

    Attributes:
        P: cost matrix, symmetric positive definite, shape (n, n) [cost / z^2].
        q: cost vector, shape (n,) [cost / z].
        G: inequality matrix, shape (m, n) [h / z].
        h: inequality vector, shape (m,) [of each row].
        lower: lower bounds, shape (n,) [of z].
        upper: upper bounds, shape (n,) [of z].
    """

    P: Array
    q: Array
    G: Array
    h: Array
    lower: Array
    upper: Array

    def problem(self) -> "qpsolvers.Problem":
        """The same problem as qpsolvers takes it."""
        import qpsolvers

        return qpsolvers.Problem(self.P, self.q, self.G, self.h, None, None, self.lower, self.upper)


@dataclass(frozen=True)
class QpSolution:
    """Result of the first solver that succeeded.

    Attributes:
        qp: the problem that it belongs to, which may be a softened one.
        z: optimum, shape (n,) [of the law: jerk, m/s^3, and slack, m], or None when every solver failed.
        attempt: index of the solver that succeeded, or the number of solvers.
    """

    qp: Qp
    z: Array | None
    attempt: int


def solve(qp: Qp, solvers: tuple[str, ...] = SOLVERS) -> QpSolution:
    """Solve with the first of the solvers that succeeds; a solver's exception counts as its failure.

    Args:
        qp: the problem.
        solvers: names known to qpsolvers, in the order to try. DAQP is called without the wrapper, which would take as
            long as the solver.
    """
    for attempt, name in enumerate(solvers):
        try:
            z = _daqp(qp) if name == "daqp" else _wrapped(qp, name)
        except (ValueError, ArithmeticError):
            continue
        if z is not None and np.isfinite(z).all():
            return QpSolution(qp, z, attempt)
    return QpSolution(qp, None, len(solvers))


class AxesSolver:
    """Solves QPs that share P and G, by `BoundedQp` in place of DAQP as far as that can.

    Args:
        solvers: names known to qpsolvers, in the order to try.
    """

    def __init__(self, solvers: tuple[str, ...]) -> None:
        self._solvers = solvers
        self._bounded, self._shape = BoundedQp(0, 0), (0, 0)

    def solve(self, x: Qp, y: Qp) -> tuple[QpSolution, QpSolution]:
        """Solve both; see `solve`."""
        if self._solvers[:1] != ("daqp",):
            return solve(x, self._solvers), solve(y, self._solvers)
        self._factorise(x)
        one = self._solved(x)
        if y.P is not x.P or y.G is not x.G:
            self._factorise(y)
        return one, self._solved(y)

    def _factorise(self, qp: Qp) -> None:
        if self._shape != qp.G.shape:
            self._bounded, self._shape = BoundedQp(*qp.G.shape), qp.G.shape
        self._bounded.factorise(np.ascontiguousarray(qp.P), np.ascontiguousarray(qp.G))

    def _solved(self, qp: Qp) -> QpSolution:
        vectors = (np.ascontiguousarray(vector) for vector in (qp.q, qp.h, qp.lower, qp.upper))
        z = self._bounded.minimised(*vectors)
        return solve(qp, self._solvers) if z is None else QpSolution(qp, z, 0)


def _wrapped(qp: Qp, name: str) -> Array | None:
    import qpsolvers  # half a second with its sparse matrices, and most walks never need a second solver

    try:
        solution = qpsolvers.solve_problem(qp.problem(), name, **OPTIONS.get(name, {}))
    except qpsolvers.QPError:
        return None
    return solution.x if solution.found else None


def _daqp(qp: Qp) -> Array | None:
    """DAQP takes bounds as its first rows, and rows from below too."""
    n, rows = len(qp.q), len(qp.h)
    upper, lower = np.concatenate((qp.upper, qp.h)), np.full(n + rows, -_UNBOUNDED)
    lower[:n] = qp.lower
    z, _, flag, _ = daqp.solve(qp.P, qp.q, qp.G, upper, lower, np.zeros(n + rows, dtype=np.intc), **OPTIONS["daqp"])
    return np.asarray(z) if flag > 0 else None
