"""The QP of one axis, and its solution by the first solver that succeeds."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import daqp
import numpy as np

from surefoot.native.library import Bound, Library, library
from surefoot.planner.parameters import SOLVERS
from surefoot.planner.types import Array
from surefoot.values import dataclass

if TYPE_CHECKING:
    import qpsolvers

OPTIONS: dict[str, dict[str, Any]] = {
    "daqp": {"primal_tol": 1e-9, "dual_tol": 1e-12},
    "piqp": dict.fromkeys(("eps_abs", "eps_rel", "eps_duality_gap_abs", "eps_duality_gap_rel"), 1e-12),
}
"""Tolerances that make the solvers exact to the last digits that matter, by name."""

_TOLERANCE = 1e-12
"""Violation that the kernel allows, over the size of a variable or row, since rounding is as large [-]."""

_UNBOUNDED = 1e30
"""A bound that DAQP takes for none, as its manual says [-]."""


@dataclass(frozen=True, slots=True)
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


@dataclass(frozen=True, slots=True)
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
    """Solves QPs that share P and G, which a kernel does in place of DAQP, as far as it can.

    Args:
        solvers: as of `solve`.
    """

    def __init__(self, solvers: tuple[str, ...]) -> None:
        self._solvers = solvers
        self._kernels = library() if solvers[:1] == ("daqp",) else None
        self._given: tuple[Array, ...] = ()
        self._run: Callable[[int], int]

    @property
    def compiled(self) -> bool:
        """Whether the kernel is asked first."""
        return self._kernels is not None

    def prepare(self, rows: int, variables: int) -> None:
        """Bind the kernel to QPs of a size, which else the first `solve` does."""
        if self._kernels is not None:
            self._bind(rows, variables)

    def solve(self, x: Qp, y: Qp) -> tuple[QpSolution, QpSolution]:
        """Their solutions, as those of `solve`."""
        if self._kernels is None:
            return solve(x, self._solvers), solve(y, self._solvers)
        one = self._solved(x, False)
        return one, self._solved(y, one.attempt == 0 and y.P is x.P and y.G is x.G)

    def _solved(self, qp: Qp, same: bool) -> QpSolution:
        if not self._given or self._given[2].shape != qp.G.shape:
            self._bind(*qp.G.shape)
        P, q, G, h, lower, upper = self._given
        if not same:
            P[:], G[:] = qp.P, qp.G
        q[:], h[:], lower[:], upper[:] = qp.q, qp.h, qp.lower, qp.upper
        return solve(qp, self._solvers) if self._run(same) else QpSolution(qp, self._x.copy(), 0)

    def _bind(self, rows: int, n: int) -> None:
        vectors, self._x = np.zeros((3, n)), np.zeros(n)
        self._given = np.zeros((n, n)), vectors[0], np.zeros((rows, n)), np.zeros(rows), vectors[1], vectors[2]
        assert self._kernels is not None
        (bound,) = bind_qps(self._kernels, [(Qp(*self._given), self._x)])
        self._run = self._kernels.bind("bounded_qp_solve", bound)


def bind_qps(kernels: Library, axes: Sequence[tuple[Qp, Array]]) -> list[Bound]:
    """Structs of QPs of a size with their solutions, which share their scratch and what is made of P and G alone."""
    rows, n = axes[0][0].G.shape
    square = np.zeros((4, n, n))
    scratch = {
        "factor": square[0],
        "inverse": square[1],
        "rotated": square[2],
        "triangle": square[3],
        "share": np.zeros(rows),
        "multipliers": np.zeros(n),
        "work": np.zeros(4 * n),
        "active": np.zeros(n, dtype=np.int64),
        "taken": np.zeros(2 * n + rows, dtype=np.int64),
    }
    return [
        kernels.fill(
            "BoundedQp",
            variables=n,
            rows=rows,
            tolerance=_TOLERANCE,
            **{name: getattr(qp, name) for name in ("P", "q", "G", "h", "lower", "upper")},
            x=x,
            **scratch,
        )
        for qp, x in axes
    ]


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
