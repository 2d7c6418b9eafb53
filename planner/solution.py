"""From the QPs of a tick to the motion that is used."""

import numpy as np

from planner.motion import Motion
from planner.prediction import Prediction
from planner.qp import Qp, solve
from planner.types import Array, SolverStatus


def solve_problem(qps: tuple[Qp, Qp], prediction: Prediction, solvers: tuple[str, str], fallback: Array) -> Motion:
    """Solve both axes; an axis that no solver solves takes the fallback jerk and does not shift its footsteps.

    Args:
        qps: the QPs of `planner.tvmpc`.
        prediction: holds the basis of the moves.
        solvers: qpsolvers names, in the order to try.
        fallback: previous jerk sequence shifted by one sample, shape (N, 2) [m/s^3].
    """
    m = prediction.basis.shape[1]
    jerk, shifts, slack = fallback.copy(), np.zeros((2, 2)), np.full((2, 2), np.nan)
    worst = SolverStatus.SOLVED
    for axis, qp in enumerate(qps):
        solution = solve(qp, solvers)
        worst = max(worst, SolverStatus(solution.attempt))
        if solution.z is not None:
            jerk[:, axis] = prediction.basis @ solution.z[:m]
            shifts[:, axis], slack[:, axis] = solution.z[m : m + 2], solution.z[m + 2 :]
    return Motion(jerk, shifts, slack[0], slack[1], worst, qps=qps)
