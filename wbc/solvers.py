"""QP solvers behind one verb. Each checks its own status; the caller checks the residual as well."""

from dataclasses import dataclass
from typing import Protocol

import daqp
import numpy as np
import quadprog
from proxsuite import proxqp

from wbc.qp import EQUALITY_ROWS, UNBOUNDED, QpData
from wbc.types import Array


@dataclass(frozen=True, slots=True)
class QpSolution:
    """Answer of a solver.

    Attributes:
        x: the minimiser, shape (n,).
        iterations: of the solver.
        dual_residual: of stationarity, NaN where the solver does not tell.
    """

    x: Array
    iterations: int
    dual_residual: float


class QpSolver(Protocol):
    """A solver of whole-body QPs of one size."""

    name: str

    def solve(self, qp: QpData) -> QpSolution | None:
        """The minimiser, or None where the solver does not vouch for it."""


class ProxQp:
    """proxsuite's dense ProxQP, warm-started with the previous solution.

    A failed solve poisons the next warm start (the iterates diverge), so after a failure the next solve starts from the
    equality-constrained minimiser.
    """

    name = "proxqp"

    def __init__(self, accuracy: float = 1e-7, max_iterations: int = 200) -> None:
        """Absolute accuracy of primal and dual residuals [-]; bound on outer iterations."""
        self._accuracy, self._max_iterations = accuracy, max_iterations
        self._solver: proxqp.dense.QP | None = None
        self._warm = False

    def solve(self, qp: QpData) -> QpSolution | None:
        """See ``QpSolver.solve``."""
        n, eq = qp.g.shape[0], EQUALITY_ROWS
        split = n + eq
        data = (
            qp.H, qp.g, qp.A[:eq], qp.bounds_lower[n:split], qp.A[eq:], qp.bounds_lower[split:], qp.bounds_upper[split:],
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
        self._warm = info.status == proxqp.QPSolverOutput.PROXQP_SOLVED
        if not self._warm:
            return None
        return QpSolution(np.array(self._solver.results.x), int(info.iter), float(info.dua_res))

    def _create(self, n: int, inequalities: int) -> proxqp.dense.QP:
        solver = proxqp.dense.QP(n, EQUALITY_ROWS, inequalities, True, proxqp.dense.HessianType.Dense,
                                 proxqp.dense.DenseBackend.PrimalDualLDLT)  # fmt: skip
        solver.settings.eps_abs = self._accuracy
        solver.settings.eps_rel = 0.0
        solver.settings.max_iter = self._max_iterations
        return solver


class Daqp:
    """DAQP, a dense dual active-set solver (Arnström, Bemporad and Axehill, IEEE TAC 2022), started from cold."""

    name = "daqp"

    def __init__(self) -> None:
        """No settings: the method is exact."""
        self._sense = np.zeros(0, dtype=np.intc)

    def solve(self, qp: QpData) -> QpSolution | None:
        """See ``QpSolver.solve``."""
        n, total = qp.g.shape[0], qp.bounds_lower.shape[0]
        if self._sense.shape[0] != total:
            self._sense = np.zeros(total, dtype=np.intc)
            self._sense[n : n + EQUALITY_ROWS] = 5
        x, _, flag, info = daqp.solve(qp.H, qp.g, qp.A, qp.bounds_upper, qp.bounds_lower, self._sense)
        if flag != 1:
            return None
        return QpSolution(x, int(info["iterations"]), float("nan"))


class Quadprog:
    """quadprog: the dual active-set method of Goldfarb and Idnani (Mathematical Programming 1983)."""

    name = "quadprog"

    def solve(self, qp: QpData) -> QpSolution | None:
        """See ``QpSolver.solve``."""
        n, eq = qp.g.shape[0], EQUALITY_ROWS
        rows = np.vstack([np.eye(n), qp.A])
        upper, lower = qp.bounds_upper < UNBOUNDED, qp.bounds_lower > -UNBOUNDED
        equality = slice(n, n + eq)
        upper[equality] = lower[equality] = False
        G = np.vstack([qp.A[:eq], rows[lower], -rows[upper]])
        b = np.concatenate([qp.bounds_lower[equality], qp.bounds_lower[lower], -qp.bounds_upper[upper]])
        try:
            x, _, _, iterations, _, _ = quadprog.solve_qp(qp.H, -qp.g, G.T.copy(), b, meq=eq)
        except ValueError:  # quadprog's word for an infeasible or indefinite problem
            return None
        return QpSolution(x, int(iterations[0]), float("nan"))


def equalities_only(qp: QpData) -> Array | None:
    """Minimiser under the equalities alone, shape (n,), from the KKT system; None if that is singular."""
    n, eq = qp.g.shape[0], EQUALITY_ROWS
    kkt = np.zeros((n + eq, n + eq))
    kkt[:n, :n] = qp.H
    kkt[n:, :n] = qp.A[:eq]
    kkt[:n, n:] = qp.A[:eq].T
    try:
        solution = np.linalg.solve(kkt, np.concatenate([-qp.g, qp.bounds_lower[n : n + eq]]))
    except np.linalg.LinAlgError:
        return None
    return solution[:n] if np.isfinite(solution).all() else None


def make_solver(name: str) -> QpSolver:
    """The solver of that name.

    Raises:
        ValueError: for an unknown name.
    """
    solvers: dict[str, type[ProxQp] | type[Daqp] | type[Quadprog]] = {
        ProxQp.name: ProxQp, Daqp.name: Daqp, Quadprog.name: Quadprog,
    }  # fmt: skip
    if name not in solvers:
        raise ValueError(f"unknown QP solver '{name}'; choose one of {', '.join(sorted(solvers))}")
    return solvers[name]()
