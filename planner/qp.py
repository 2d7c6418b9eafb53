"""Solving one axis: two solvers, then nothing; what failed is said, never hidden."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import qpsolvers

from planner.types import Array

_EXACT: dict[str, dict[str, Any]] = {"daqp": {"primal_tol": 1e-9, "dual_tol": 1e-12}}


@dataclass(frozen=True, slots=True)
class Qp:
    """min ½ zᵀ P z + qᵀ z subject to G z <= h and lower <= z <= upper.

    Attributes:
        P: cost matrix, symmetric positive definite, shape (n, n).
        q: cost vector, shape (n,).
        G: inequality matrix, shape (m, n).
        h: inequality vector, shape (m,).
        lower: lower bounds, shape (n,).
        upper: upper bounds, shape (n,).
    """

    P: Array
    q: Array
    G: Array
    h: Array
    lower: Array
    upper: Array

    def problem(self) -> qpsolvers.Problem:
        """The same problem as qpsolvers takes it."""
        return qpsolvers.Problem(self.P, self.q, self.G, self.h, None, None, self.lower, self.upper)


@dataclass(frozen=True, slots=True)
class QpSolution:
    """Result of the first solver that succeeded.

    Attributes:
        z: optimum, shape (n,), or None when every solver failed.
        attempt: index of the solver that succeeded, or the number of solvers.
    """

    z: Array | None
    attempt: int


def solve(qp: Qp, solvers: tuple[str, ...]) -> QpSolution:
    """Solve with the first of the solvers that succeeds; a solver's exception counts as its failure.

    Args:
        qp: the problem.
        solvers: names known to qpsolvers, in the order to try.
    """
    problem = qp.problem()
    for attempt, name in enumerate(solvers):
        try:
            solution = qpsolvers.solve_problem(problem, name, **_EXACT.get(name, {}))
        except (ValueError, ArithmeticError, qpsolvers.QPError):
            continue
        if solution.found and solution.x is not None and np.isfinite(solution.x).all():
            return QpSolution(solution.x, attempt)
    return QpSolution(None, len(solvers))
