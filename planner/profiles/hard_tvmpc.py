"""Profiles `paper` and `repaired`: TVMPC in the Δu form with hard constraints.

`paper` is the paper's: two moves over fifty samples and no terminal constraint. With the paper's own limits its hard
problem has no solution at a third of the ticks, and on a true pendulum the walk falls. Its step law makes it fall
even earlier, without any push (see `planner.step_laws.paper_shift`); `step_adaptation` none leaves the law out.
`repaired` changes what the paper needed: ten blocks of moves over the same horizon, the terminal DCM constraint and the
corrected step law; horizon, limits, cost and hard constraints are the paper's.
"""

from collections.abc import Callable

import numpy as np

from planner.delta_u import build_hard_problem, softened
from planner.motion import Motion, MotionProblem
from planner.moves import block_moves
from planner.parameters import PlannerParameters
from planner.qp import Qp, solve
from planner.step_laws import corrected_shift, paper_shift
from planner.step_response import cached_response
from planner.types import Array, SolverStatus

StepLaw = Callable[[MotionProblem, PlannerParameters], Array]


class HardTvmpc:
    """The step law decides the next footstep, then a hard QP per axis the jerk; a QP without solution is softened.

    Args:
        parameters: planner parameters; `zmp_slack` is the cost of the softening slack.
        step_law: gives the shift of the next footstep.
        terminal: whether the terminal DCM is constrained.
    """

    def __init__(self, parameters: PlannerParameters, step_law: StepLaw, terminal: bool) -> None:
        p = self._parameters = parameters
        self._step_law, self._terminal = step_law, terminal
        self._response = cached_response(p.sample_time, p.moves, p.horizon)
        self._basis = np.asarray(np.cumsum(block_moves(p.moves, p.horizon)[:, ::-1], axis=1)[:, ::-1])
        self._jerk_rows = slice(2 * p.horizon, 2 * p.horizon + 2 * len(p.moves))

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`."""
        p, reference, moves = self._parameters, problem.reference, len(self._parameters.moves)
        shifts = np.zeros((2, 2))
        shifts[0] = self._step_law(problem, p)
        point = reference.point + reference.gain @ shifts
        hard = build_hard_problem(p, self._response, problem, point, self._terminal)
        jerk, slack = problem.fallback.copy(), np.zeros(2)
        worst, infeasible = SolverStatus.SOLVED, False
        qps = []
        for axis, qp in enumerate(hard):
            used, z, attempt = self._solve(qp)
            qps.append(used)
            worst, infeasible = max(worst, SolverStatus(attempt)), infeasible or used is not qp
            slack[axis] = np.nan if z is None else z[moves] if used is not qp else 0.0
            if z is not None:
                jerk[:, axis] = np.clip(problem.last_jerk[axis], -p.jerk_limit, p.jerk_limit) + self._basis @ z[:moves]
        terminal_slack = slack if self._terminal else np.zeros(2)
        return Motion(jerk, shifts, slack, terminal_slack, worst, infeasible, tuple(qps))

    def _solve(self, qp: Qp) -> tuple[Qp, Array | None, int]:
        """The problem that was solved in the end, its solution and the solver's number."""
        p = self._parameters
        solution = solve(qp, p.solvers)
        if solution.z is not None:
            return qp, solution.z, solution.attempt
        soft = softened(qp, self._jerk_rows, p.zmp_slack)
        solution = solve(soft, p.solvers)
        return soft, solution.z, solution.attempt


def paper_law(parameters: PlannerParameters, com_height: float) -> HardTvmpc:
    """The law of profile `paper`."""
    return HardTvmpc(parameters, paper_shift, terminal=False)


def repaired_law(parameters: PlannerParameters, com_height: float) -> HardTvmpc:
    """The law of profile `repaired`."""
    return HardTvmpc(parameters, corrected_shift, terminal=True)
