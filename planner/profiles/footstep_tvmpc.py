"""Profiles `default` and `lti`: soft TVMPC with the footsteps as variables of the QP (Herdt et al., 2010)."""

import math
from dataclasses import replace

import numpy as np

from planner.constraints import generate_constraints
from planner.leg_inertia import softening
from planner.motion import Motion, MotionProblem
from planner.moves import block_moves
from planner.nominal import NominalMotion, jerk_range, no_motion, nominal_motion
from planner.parameters import PlannerParameters
from planner.prediction import predict
from planner.solution import solve_problem
from planner.tvmpc import build_problem
from planner.types import GRAVITY


class FootstepTvmpc:
    """Blocked jerk and two footstep shifts per axis; ZMP box and terminal DCM bound are soft, so it has no bad tick.

    The moves are what differs from the nominal motion (see `planner.nominal`); with a limit on the jerk's rate, which
    the nominal motion does not keep, they are the whole jerk.

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground, which it does not need [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self._parameters = parameters
        self._prediction = predict(parameters.sample_time, block_moves(parameters.moves, parameters.horizon))

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`."""
        p = self._parameters
        nominal = self._nominal(problem)
        rest = replace(problem.reference, point=problem.reference.point - nominal.zmp)
        constraints = generate_constraints(p, rest, problem.stiffness, problem.omega, problem.steps)
        qps = build_problem(
            p,
            self._prediction,
            problem.state - nominal.com[:, 0].T,
            problem.stiffness[: p.horizon + 1],
            rest,
            constraints,
            problem.last_jerk,
            jerk_range(nominal.jerk[: p.horizon], p.moves, p.jerk_limit),
        )
        applied = nominal.jerk[: p.horizon]
        motion = solve_problem(qps, self._prediction, p.solvers, problem.fallback - applied)
        return replace(motion, jerk=motion.jerk + applied)

    def _nominal(self, problem: MotionProblem) -> NominalMotion:
        t, zmp = self._parameters.sample_time, problem.reference.point
        if math.isfinite(self._parameters.jerk_rate_limit):
            return no_motion(len(zmp), t)
        return nominal_motion(problem.state[:, 0], zmp, problem.stiffness, t)


class ConstantHeightTvmpc:
    """The same without previewing the dynamics: λ = g / z_c and ω = sqrt(λ) over the whole window (LIPM).

    Args:
        parameters: planner parameters.
        com_height: CoM height over the ground at rest, z_c [m].
    """

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self._law = FootstepTvmpc(parameters, com_height)
        self._stiffness = softening(parameters.leg) * GRAVITY / com_height

    def plan(self, problem: MotionProblem) -> Motion:
        """See `MotionPlanner`."""
        stiffness = np.full_like(problem.stiffness, self._stiffness)
        omega = np.full_like(problem.omega, math.sqrt(self._stiffness))
        return self._law.plan(replace(problem, stiffness=stiffness, omega=omega))
