"""QP solvers behind one verb. Each checks its own status; the caller checks the residual as well."""

import math
from collections.abc import Callable
from functools import cache
from typing import Any, Protocol

import daqp
import numpy as np
from numpy.typing import NDArray
from proxsuite import proxqp

from surefoot.native.library import Bound, Library, library
from surefoot.values import dataclass
from surefoot.wbc.parameters import SOLVER_NAMES
from surefoot.wbc.qp import EQUALITY_ROWS, FOOT_ROWS, QpData
from surefoot.wbc.types import Array

MOST_ACTIVE = 16
"""Active inequalities that the kernel takes; with more of them DAQP is as fast [-]."""


@dataclass(frozen=True, slots=True)
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
        """What counts as an equality, and what may be broken.

        Args:
            accuracy: largest violation of a normalised row that counts as none [-].
            fixed: numbers of bounds that are equalities where both of them are the same; None for none.
            soft: numbers of bounds and rows that are broken, at a cost of the squared violations beside which all
                others are small, where there is no solution that holds them; None for none.
            lets_go: whether the rows that hold soles on the ground are soft, too.
        """
        self._accuracy, self._fixed, self._soft, self._lets_go = accuracy, fixed, soft, lets_go
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
    """The minimiser under the equalities alone where it breaks no inequality, which makes it the minimiser; else DAQP.

    A robot that walks within its limits rarely touches an inequality, and the equalities cost half of the full problem.
    """

    name = "equality-first"

    def __init__(self, accuracy: float = 1e-9) -> None:
        """``accuracy``: largest violation that counts as none."""
        self._accuracy = accuracy
        self._full = Daqp(accuracy)
        self._kernels = library()
        self._compiled: CompiledEqualities | None = None

    def prepare(self, qp: QpData) -> "CompiledEqualities | None":
        """The kernels bound to a QP that is to be solved, which else its first ``solve`` does; None without kernels."""
        if self._kernels is not None:
            self._compiled = CompiledEqualities(self._kernels, self._accuracy, qp)
        return self._compiled

    def solve(self, qp: QpData) -> QpSolution | None:
        """See ``QpSolver.solve``."""
        compiled = self._compiled
        if compiled is None or compiled.qp is not qp:
            compiled = self.prepare(qp)
        if compiled is not None:
            return self.go_on(compiled, compiled.run())
        solution = equalities_only(qp)
        if solution is not None and solution.violation <= self._accuracy:
            return solution
        return self._full.solve(qp)

    def go_on(self, compiled: "CompiledEqualities", violation: float) -> QpSolution | None:
        """The minimiser of a QP whose solution under the equalities alone, just found, has that violation."""
        if violation <= self._accuracy:
            return compiled.solution(violation)
        active = compiled.activate() if math.isfinite(violation) else None
        return active or self._full.solve(compiled.qp)


def equalities_only(qp: QpData) -> QpSolution | None:
    """Minimiser under the equalities alone; None if H is not positive definite or the equalities contradict each other.

    By the Schur complement (Boyd and Vandenberghe, Convex Optimization, 2004, section 10.4.2): with H = L Lᵀ,
    Y = L⁻¹ Eᵀ and w = L⁻¹ g, the multipliers solve YᵀY λ = e + Yᵀ w, and x = L⁻ᵀ (Y λ - w).
    """
    n, eq, (dpotrf, dtrtrs, dposv) = qp.g.shape[0], EQUALITY_ROWS, _lapack()
    L, failed = dpotrf(qp.H.T, lower=1, clean=0)
    if failed:
        return None
    Y, _ = dtrtrs(L, np.concatenate((qp.A[:eq], qp.g[None])).T, lower=1, overwrite_b=1)
    S = Y.T @ Y
    _, multipliers, failed = dposv(S[:eq, :eq], qp.bounds_lower[n : n + eq] + S[:eq, eq])
    if failed:
        return None
    y = Y[:, :eq] @ multipliers
    y -= Y[:, eq]
    x, _ = dtrtrs(L, y, lower=1, trans=1, overwrite_b=1)
    violation = qp.violation(x)
    return QpSolution(x, violation, 0) if math.isfinite(violation) else None


@cache
def _lapack() -> tuple[Any, Any, Any]:
    """LAPACK's routines, which plain Python alone imports."""
    from scipy.linalg import lapack

    return lapack.dpotrf, lapack.dtrtrs, lapack.dposv


class CompiledEqualities:
    """Does for one QP what ``equalities_only`` does, by a kernel; another goes on from there.

    Args:
        kernels: the library.
        accuracy: largest violation that counts as none.
        qp: which is solved as it is at each call.

    Attributes:
        accuracy: likewise.
        qp: likewise.
        x: the solution found last, shape (n,).
    """

    def __init__(self, kernels: Library, accuracy: float, qp: QpData) -> None:
        self._kernels, self.accuracy, self.qp = kernels, accuracy, qp
        self._bind(qp)

    def run(self) -> float:
        """Solve; returns the violation at x, which is not finite where there is no solution."""
        return float(self._run(self._split))

    def solution(self, violation: float, iterations: int = 0) -> QpSolution:
        """What was found last as a value."""
        return QpSolution(self.x.copy(), violation, iterations)

    def answering(self, answer: Bound) -> Callable[[], float]:
        """``run`` by a kernel that also fills an answer, of the same x, where the violation counts as none."""
        return self._kernels.bind("qp_answer", qp=self._bound, answer=answer, split=self._split, accuracy=self.accuracy)

    def activate(self) -> QpSolution | None:
        """The minimiser of the QP last solved under all of its constraints; None where few active ones do not do."""
        rounds = self._activate()
        if rounds < 0:
            return None
        violation = self._violation()
        # Beside what counts as none there is rounding, as of DAQP, which scales its rows.
        return self.solution(violation, rounds) if violation <= 100.0 * self.accuracy else None

    def _bind(self, qp: QpData) -> None:
        n, rows, eq = qp.g.shape[0], qp.A.shape[0], EQUALITY_ROWS
        # A right side for each equality and for the gradient, and room to make their number a multiple of four.
        width = eq + 4
        self.x, self._split = np.zeros(n), n - 2 * FOOT_ROWS
        self._bound = bound = self._kernels.fill(
            "EqualityQp",
            variables=n,
            equalities=eq,
            rows=rows,
            H=qp.H,
            g=qp.g,
            A=qp.A,
            lower=qp.bounds_lower,
            upper=qp.bounds_upper,
            factor=np.zeros((n, n)),
            right_sides=np.zeros((n, width)),
            schur=np.zeros((eq, width)),
            multipliers=np.zeros(eq),
            x=self.x,
        )
        self._run = self._kernels.bind("equality_qp_solve", bound)
        self._violation = self._kernels.bind("qp_violation", bound)
        self._activate = self._kernels.bind(
            "active_qp_solve",
            qp=bound,
            most=MOST_ACTIVE,
            tolerance=self.accuracy,
            normals=np.zeros((MOST_ACTIVE, n)),
            columns=np.zeros((MOST_ACTIVE + 1, eq + MOST_ACTIVE)),
            multipliers=np.zeros(MOST_ACTIVE),
            active=np.zeros(MOST_ACTIVE, dtype=np.int64),
            work=np.zeros(2 * n + eq + MOST_ACTIVE),
        )


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
        soft: what those between them may break, as of ``Daqp``; the latter of them lets go of soles as well.
        fixed: bounds that may be equalities, as of ``Daqp``, which then is the first one; None for none.

    Raises:
        ValueError: for an unknown name.
    """
    return (
        make_solver(first) if fixed is None else Daqp(fixed=fixed),
        Daqp(fixed=fixed, soft=soft),
        Daqp(_LETTING_GO, fixed, soft, lets_go=True),
        make_solver(second),
    )
