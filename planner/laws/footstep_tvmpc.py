"""Soft TVMPC with the footsteps as variables of the QP (Herdt et al., 2010): profiles `default` and `lti`.

Its QPs are those of `planner.laws.footstep_qps`.
"""

import math
from dataclasses import replace

import numpy as np

from surefoot.planner.laws.footstep_qps import FootstepQps
from surefoot.planner.laws.law import BuiltQps, Motion, MotionProblem
from surefoot.planner.laws.qp import AxesSolver, QpSolution
from surefoot.planner.model.jerk import block_moves, predict
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.leg_offset import softening
from surefoot.planner.types import GRAVITY, SolverStatus

_STATUSES = tuple(SolverStatus)
"""Statuses by the number of solvers that have failed."""


class FootstepTvmpc:
    """Blocked jerk and two footstep shifts per axis; ZMP box and terminal DCM bound are soft, so it has no bad tick.

    The moves are what differs from the nominal motion (see `planner.model.nominal`); with a limit on the jerk's rate,
    which the nominal motion does not keep, they are the whole jerk.

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground, which it does not need [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        prediction = predict(parameters.sample_time, block_moves(parameters.moves, parameters.horizon))
        self._blocks = prediction.basis.argmax(axis=1)
        self._moves = len(parameters.moves)
        self._qps, self._solver = FootstepQps(parameters, prediction), AxesSolver(parameters.solvers)

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`."""
        built = self.build(problem)
        return self.interpret(problem, built, self.solve(built))

    def build(self, problem: MotionProblem) -> BuiltQps:
        """See `QpLaw`; the QPs count from the nominal motion."""
        return self._qps.build(problem)

    def solve(self, built: BuiltQps) -> tuple[QpSolution, QpSolution]:
        """See `QpLaw`."""
        return self._solver.solve(*built.axes)

    def interpret(self, problem: MotionProblem, built: BuiltQps, solutions: tuple[QpSolution, QpSolution]) -> Motion:
        """See `QpLaw`; an axis that no solver solved takes the fallback jerk and does not shift its footsteps."""
        m, (x, y) = self._moves, solutions
        if x.z is not None and y.z is not None:
            z = np.array((x.z, y.z)).T
            jerk, shifts, slack = z.take(self._blocks, axis=0), z[m : m + 2].copy(), z[m + 2 :]
        else:
            jerk, shifts, slack = problem.fallback - built.jerk, built.shifts.copy(), np.full((2, 2), np.nan)
            for axis, solution in enumerate(solutions):
                if solution.z is not None:
                    jerk[:, axis] = solution.z[self._blocks]
                    shifts[:, axis], slack[:, axis] = solution.z[m : m + 2], solution.z[m + 2 :]
        worst = _STATUSES[max(x.attempt, y.attempt)]
        return Motion(jerk + built.jerk, shifts, slack[0], slack[1], worst, qps=built.axes)


class ConstantHeightTvmpc(FootstepTvmpc):
    """The same without previewing the dynamics: λ = g / z_c and ω = sqrt(λ) over the whole window (LIPM).

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground at rest, z_c [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        super().__init__(parameters, com_height)
        self._stiffness = softening(parameters.leg) * GRAVITY / com_height

    def build(self, problem: MotionProblem) -> BuiltQps:
        """See `QpLaw`; the QPs count with a pendulum of constant height."""
        stiffness = np.full_like(problem.stiffness, self._stiffness)
        omega = np.full_like(problem.omega, math.sqrt(self._stiffness))
        return super().build(replace(problem, stiffness=stiffness, omega=omega))
