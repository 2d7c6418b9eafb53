"""QP solvers behind one verb. Each checks its own status; the caller checks the residual as well."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import daqp
import numpy as np
from numpy.typing import NDArray
from proxsuite import proxqp

from surefoot.wbc.parameters import SOLVER_NAMES
from surefoot.wbc.qp.data import EQUALITY_ROWS, FOOT_ROWS, QpData
from surefoot.wbc.qp.range_space import EqualityQp, InequalityQp
from surefoot.wbc.types import Array


@dataclass(frozen=True)
class QpSolution:
    """Answer of a solver.

    Attributes:
        x: the minimiser, shape (n,).
        violation: largest violation of the QP's bounds and rows at x.
        iterations: of the solver.
        dual_residual: of stationarity, NaN where the solver does not tell.
    """

    x: Array
    violation: float
    iterations: int
    dual_residual: float = float("nan")


class QpSolver(Protocol):
    """A solver of whole-body QPs of one size."""

    name: str

    def solve(self, qp: QpData) -> QpSolution | None:
        """The minimiser, or None where the solver does not vouch for it."""


class ProxQp:
    """proxsuite's dense ProxQP, started from the equality-constrained minimiser or from the previous solution.

    As a second solver it meets single problems whose predecessors it has not seen: no warm start then. A failed solve
    poisons the next warm start (the iterates diverge), so after a failure it starts anew in any case.
    """

    name = "proxqp"

    def __init__(self, accuracy: float = 1e-7, max_iterations: int = 200, warm_start: bool = False) -> None:
        """Absolute accuracy of primal and dual residuals [-]; bound on outer iterations; where to start."""
        self._accuracy, self._max_iterations, self._warm_start = accuracy, max_iterations, warm_start
        self._solver: proxqp.dense.QP | None = None
        self._warm = False

    def solve(self, qp: QpData) -> QpSolution | None:
        """See ``QpSolver.solve``."""
        if not qp.is_finite():
            return None
        n, eq = qp.g.shape[0], EQUALITY_ROWS
        split = n + eq
        data = (
            qp.H, qp.g, qp.A[:eq], qp.bounds_lower[n:split],
            qp.A[eq:], qp.bounds_lower[split:], qp.bounds_upper[split:],
            qp.bounds_lower[:n], qp.bounds_upper[:n],
        )  # fmt: skip
        if self._solver is None:
            self._solver = self._create(n, qp.A.shape[0] - eq)
            self._solver.init(*data)
        else:
            self._solver.update(*data, update_preconditioner=True)
        guess = proxqp.InitialGuess
        self._solver.settings.initial_guess = (
            guess.WARM_START_WITH_PREVIOUS_RESULT if self._warm else guess.EQUALITY_CONSTRAINED_INITIAL_GUESS
        )
        self._solver.solve()
        info = self._solver.results.info
        solved = info.status == proxqp.QPSolverOutput.PROXQP_SOLVED
        self._warm = self._warm_start and solved
        if not solved:
            return None
        x = np.array(self._solver.results.x)
        return QpSolution(x, qp.violation(x), int(info.iter), float(info.dua_res))

    def _create(self, n: int, inequalities: int) -> proxqp.dense.QP:
        solver = proxqp.dense.QP(n, EQUALITY_ROWS, inequalities, True, proxqp.dense.HessianType.Dense,
                                 proxqp.dense.DenseBackend.PrimalDualLDLT)  # fmt: skip
        solver.settings.eps_abs = self._accuracy
        solver.settings.eps_rel = 0.0
        solver.settings.max_iter = self._max_iterations
        return solver


_EQUALITY, _SOFT = 5, 8
"""DAQP's kinds of rows: those that hold with equality, and those that may be broken."""

_OPTIMAL = (1, 2)
"""Its answers that are optimal, the second one with soft rows that are broken."""


class Daqp:
    """DAQP, a dense dual active-set solver (Arnström, Bemporad and Axehill, IEEE TAC 2022), started from cold."""

    name = "daqp"

    def __init__(
        self,
        accuracy: float = 1e-9,
        fixed: NDArray[np.intp] | None = None,
        soft: NDArray[np.intp] | None = None,
        lets_go: bool = False,
    ) -> None:
        """Set what counts as an equality, and what may be broken.

        Args:
            accuracy: largest violation of a normalised row that counts as none [-].
            fixed: numbers of bounds that are equalities where both of them are the same; None for none.
            soft: numbers of bounds and rows that are broken, at a cost of the squared violations beside which all
                others are small, where there is no solution that holds them; None for none.
            lets_go: whether the rows that hold soles on the ground are soft, too.
        """
        self._accuracy = accuracy
        self._fixed = fixed
        self._soft = soft
        self._lets_go = lets_go
        self._sense = np.zeros(0, dtype=np.intc)

    def solve(self, qp: QpData) -> QpSolution | None:
        """See ``QpSolver.solve``."""
        if not qp.is_finite():
            return None
        n, total = qp.g.shape[0], qp.bounds_lower.shape[0]
        if self._sense.shape[0] != total:
            self._sense = np.zeros(total, dtype=np.intc)
            self._sense[n : n + EQUALITY_ROWS] = _EQUALITY
            if self._soft is not None:
                self._sense[self._soft] = _SOFT
            self._usual = self._sense.copy()
        if self._fixed is not None:
            same = qp.bounds_lower[self._fixed] == qp.bounds_upper[self._fixed]
            self._sense[self._fixed] = np.where(same, _EQUALITY, self._usual[self._fixed])
        soft = self._soft
        if self._lets_go:
            # The rows of a sole in the air are those of its wrench, which is zero.
            held = qp.A[: 2 * FOOT_ROWS, : n - 2 * FOOT_ROWS].any(axis=1)
            self._sense[n : n + 2 * FOOT_ROWS] = np.where(held, _SOFT, _EQUALITY)
            rows = n + np.flatnonzero(held)
            soft = rows if soft is None else np.concatenate((soft, rows))
        x, _, flag, info = daqp.solve(
            qp.H, qp.g, qp.A, qp.bounds_upper, qp.bounds_lower, self._sense, primal_tol=self._accuracy
        )
        if flag not in _OPTIMAL:
            return None
        return QpSolution(x, qp.violation(x, soft), int(info["iterations"]))


class EqualityFirst:
    """The minimiser under the equalities alone where it breaks no inequality, which makes it the minimiser.

    Else it goes on from there while few inequalities are active, and DAQP answers for the rest.
    A robot that walks within its limits rarely touches an inequality, and the equalities cost half of the full problem.
    """

    name = "equality-first"

    def __init__(self, accuracy: float = 1e-9) -> None:
        """``accuracy``: largest violation that counts as none."""
        self._accuracy = accuracy
        self._full = Daqp(accuracy)
        self._equalities: EqualityQp | None = None

    def solve(self, qp: QpData) -> QpSolution | None:
        """See ``QpSolver.solve``."""
        if self._equalities is None or self._equalities.qp is not qp:
            self._equalities = EqualityQp(qp)
            self._inequalities = InequalityQp(self._equalities, self._accuracy)
        equalities = self._equalities
        violation = equalities.solve()
        if violation <= self._accuracy:
            return QpSolution(equalities.x.copy(), violation, 0)
        if math.isfinite(violation):
            rounds = self._inequalities.solve()
            violation = equalities.violation()
            # Beside what counts as none there is rounding, as of DAQP, which scales its rows.
            if rounds >= 0 and violation <= 100.0 * self._accuracy:
                return QpSolution(equalities.x.copy(), violation, rounds)
        return self._full.solve(qp)


def equalities_only(qp: QpData) -> QpSolution | None:
    """Minimiser under the equalities alone.

    Returns:
        It; None if H is not positive definite or the equalities contradict each other.
    """
    equalities = EqualityQp(qp)
    violation = equalities.solve()
    return QpSolution(equalities.x, violation, 0) if math.isfinite(violation) else None


SOLVERS: dict[str, Callable[[], QpSolver]] = dict(zip(SOLVER_NAMES, (EqualityFirst, Daqp, ProxQp), strict=True))
"""Makers of the solvers by name."""


def make_solver(name: str) -> QpSolver:
    """The solver of that name.

    Raises:
        ValueError: for an unknown name.
    """
    if name not in SOLVERS:
        raise ValueError(f"unknown QP solver '{name}'; choose one of {', '.join(sorted(SOLVERS))}")
    return SOLVERS[name]()


_LETTING_GO = 1e-6
"""Accuracy of the solver that lets go of soles: with 1e-9 it fails at half of what has violations of thousands [-]."""


def in_turn(
    first: str, second: str, soft: NDArray[np.intp], fixed: NDArray[np.intp] | None = None
) -> tuple[QpSolver, ...]:
    """Solvers in the order in which a controller asks them, four in all.

    Args:
        first: name of the first one.
        second: of the one that is asked when all others fail.
        soft: numbers of bounds and rows that those between them may break; the latter of them lets go of soles, too.
        fixed: numbers of bounds that may be equalities, for ``Daqp``, which then is the first one; None for none.

    Raises:
        ValueError: for an unknown name.
    """
    return (
        make_solver(first) if fixed is None else Daqp(fixed=fixed),
        Daqp(fixed=fixed, soft=soft),
        Daqp(_LETTING_GO, fixed, soft, lets_go=True),
        make_solver(second),
    )
