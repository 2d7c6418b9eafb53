"""From the QPs of a tick to the jerk and the footstep shifts that are used."""

from dataclasses import dataclass

import numpy as np

from planner.prediction import Prediction
from planner.qp import solve
from planner.tvmpc import TvmpcProblem
from planner.types import Array, SolverStatus


@dataclass(frozen=True, slots=True)
class TvmpcSolution:
    """Both axes' optimum in the plan frame.

    Attributes:
        jerk: shape (N, 2) [m/s^3].
        shifts: shifts of the next two footsteps, shape (step, axis) = (2, 2) [m].
        zmp_slack: shape (2,) [m]; NaN for an axis that was not solved.
        terminal_slack: shape (2,) [m]; NaN for an axis that was not solved.
        solver: the worse status of the two axes.
    """

    jerk: Array
    shifts: Array
    zmp_slack: Array
    terminal_slack: Array
    solver: SolverStatus


def solve_problem(
    problem: TvmpcProblem, prediction: Prediction, solvers: tuple[str, str], fallback: Array
) -> TvmpcSolution:
    """Solve both axes; an axis that no solver solves takes the fallback jerk and does not shift its footsteps.

    Args:
        problem: the QPs.
        prediction: holds the basis of the moves.
        solvers: qpsolvers names, in the order to try.
        fallback: previous jerk sequence shifted by one sample, shape (N, 2) [m/s^3].
    """
    m = prediction.basis.shape[1]
    jerk, shifts, slack = fallback.copy(), np.zeros((2, 2)), np.full((2, 2), np.nan)
    worst = SolverStatus.SOLVED
    for axis, qp in enumerate(problem.axes):
        solution = solve(qp, solvers)
        worst = max(worst, SolverStatus(solution.attempt))
        if solution.z is not None:
            jerk[:, axis] = prediction.basis @ solution.z[:m]
            shifts[:, axis], slack[:, axis] = solution.z[m : m + 2], solution.z[m + 2 :]
    return TvmpcSolution(jerk, shifts, slack[0], slack[1], worst)
