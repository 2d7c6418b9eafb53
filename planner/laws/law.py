"""What the laws of motion share: one problem in, one motion out, and the QP per axis that most of them solve."""

from dataclasses import dataclass
from typing import Any, Protocol

import daqp
import numpy as np
import qpsolvers

from surefoot.planner.laws.constraints import StepContext
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.types import Array, SolverStatus

DAQP_OPTIONS: dict[str, Any] = {"primal_tol": 1e-9, "dual_tol": 1e-12}
"""Tolerances that make DAQP exact to the last digits that matter."""

_UNBOUNDED = 1e30


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
        solvers: names known to qpsolvers, in the order to try. DAQP is called without the wrapper, which would take as
            long as the solver.
    """
    for attempt, name in enumerate(solvers):
        try:
            z = _daqp(qp) if name == "daqp" else _wrapped(qp, name)
        except (ValueError, ArithmeticError, qpsolvers.QPError):
            continue
        if z is not None and np.isfinite(z).all():
            return QpSolution(z, attempt)
    return QpSolution(None, len(solvers))


def _wrapped(qp: Qp, name: str) -> Array | None:
    solution = qpsolvers.solve_problem(qp.problem(), name)
    return solution.x if solution.found else None


def _daqp(qp: Qp) -> Array | None:
    """DAQP takes bounds as its first rows, and rows from below too."""
    n, rows = len(qp.q), len(qp.h)
    upper, lower = np.concatenate((qp.upper, qp.h)), np.full(n + rows, -_UNBOUNDED)
    lower[:n] = qp.lower
    z, _, flag, _ = daqp.solve(qp.P, qp.q, qp.G, upper, lower, np.zeros(n + rows, dtype=np.intc), **DAQP_OPTIONS)
    return np.asarray(z) if flag > 0 else None


@dataclass(frozen=True, slots=True)
class MotionProblem:
    """What is known of one tick, in the plan frame (origin and heading of the stance foot, or of the last landed one).

    The window is the horizon of N samples and a preview of M more. The pendulum is c'' = λ (c - p) for the ZMP p of
    the reference; what the swing leg adds to the ZMP is already taken out of the reference.

    Attributes:
        state: CoM position, velocity, acceleration per axis, shape (2, 3) [m, m/s, m/s^2].
        stiffness: λ over the window, shape (N + M + 1,) [1/s^2].
        omega: ω of the DCM over the window, ω' = ω² - λ, shape (N + M + 1,) [1/s].
        reference: ZMP reference and its box over the window.
        steps: the next two footsteps.
        last_jerk: jerk applied until now, u(-1), shape (2,) [m/s^3].
        fallback: the previous jerk sequence shifted by one sample, to go on with when no solver answers, shape (N, 2).
        rotation: plan frame to world, for a law that remembers something from tick to tick, shape (2, 2).
    """

    state: Array
    stiffness: Array
    omega: Array
    reference: ZmpReference
    steps: StepContext
    last_jerk: Array
    fallback: Array
    rotation: Array


@dataclass(frozen=True, slots=True)
class Motion:
    """The answer to a `MotionProblem`, in the plan frame.

    Attributes:
        jerk: CoM jerk of each sample, shape (N, 2) [m/s^3].
        shifts: shifts of the next two footsteps, shape (step, axis) = (2, 2) [m].
        zmp_slack: violation of the ZMP box that was accepted, per axis; NaN for an axis that was not solved, shape (2,)
            [m].
        terminal_slack: violation of the terminal DCM bound, likewise, shape (2,) [m].
        solver: the worse status of the two axes.
        infeasible: a hard problem had no solution and was softened.
        qps: the problems that were solved, x and y axis, to be looked at or stored; none where a law needs no QP.
    """

    jerk: Array
    shifts: Array
    zmp_slack: Array
    terminal_slack: Array
    solver: SolverStatus = SolverStatus.SOLVED
    infeasible: bool = False
    qps: tuple[Qp, ...] = ()


class MotionPlanner(Protocol):
    """A law of motion: the one thing in which the planner profiles differ."""

    def plan(self, problem: MotionProblem) -> Motion:
        """The jerk over the horizon, and where the next footsteps go."""
