"""A law of motion: one problem in, one motion out, with a QP per axis between them or without.

A law of another package needs nothing but this module: a class with `plan`, and a `planner.laws.profiles.Profile` that
makes it. Laws that solve QPs do so in three public steps, `build`, `solve` and `interpret`. Each step can be looked at
and tested without the others.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from surefoot.maths import linear
from surefoot.planner.laws.qp import Qp, QpSolution
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.types import Array, SolverStatus


@dataclass(frozen=True)
class StepContext:
    """The next two footsteps, in the plan frame.

    Attributes:
        increment: their nominal displacements from the foothold before, shape (2, 2) [m].
        side: +1 where the step is a left one, -1 where it is a right one, shape (2,).
        free: whether each of them may be shifted.
        swing: position of the swing foot from the stance foot, shape (2,) [m], or None when no foot swings.
        time_left: time until the first of them lands [s].
        transfer_time: duration of the double support that follows, zero when no foot swings (T_ds) [s].
        lower: lower bounds of their shifts from these, shape (step, axis) = (2, 2) [m].
        upper: upper bounds of their shifts, shape (step, axis) = (2, 2) [m].
    """

    increment: Array
    side: tuple[float, float]
    free: tuple[bool, bool]
    swing: Array | None
    time_left: float
    transfer_time: float
    lower: Array
    upper: Array


@dataclass(frozen=True)
class MotionProblem:
    """The data of one tick, in the plan frame (origin and heading of the stance foot, or of the last landed one).

    The window is the horizon of N samples and a preview of M more. The pendulum is c'' = λ (c - p) for the ZMP p of the
    reference. The ZMP that the swing leg adds is already taken out of it.

    Attributes:
        state: CoM position, velocity, acceleration per axis, shape (2, 3) [m, m/s, m/s^2].
        stiffness: λ over the window, shape (N + M + 1,) [1/s^2].
        omega: ω of the DCM over the window, ω' = ω² - λ, shape (N + M + 1,) [1/s].
        reference: ZMP reference and its box over the window.
        steps: the next two footsteps.
        last_jerk: jerk applied until now, u(-1), shape (2,) [m/s^3].
        fallback: the previous jerk sequence shifted by one sample, to go on with when no solver answers, shape (N, 2)
            [m/s^3].
        rotation: plan frame to world, shape (2, 2) [-].
        memory: what the law's last motion left, one vector or several, shape (..., 2); None where it left
            nothing.
    """

    state: Array
    stiffness: Array
    omega: Array
    reference: ZmpReference
    steps: StepContext
    last_jerk: Array
    fallback: Array
    rotation: Array
    memory: Array | None = None

    @classmethod
    def after(
        cls,
        before: Array,
        state: Array,
        window: tuple[Array, Array, ZmpReference],
        steps: StepContext,
        rotation: Array,
        memory: Array | None = None,
    ) -> "MotionProblem":
        """Problem after a jerk sequence, of which the jerk and the fallback follow.

        Args:
            before: the previous jerk sequence in the world frame, shape (N, 2) [m/s^3].
            state: CoM, its velocity and acceleration per axis, shape (2, 3) [m, m/s, m/s^2].
            window: stiffness and omega, shape (N + M + 1,) each [1/s^2, 1/s], and reference.
            steps: the next two footsteps.
            rotation: plan frame to world, shape (2, 2) [-].
            memory: vectors that the law's last motion left, turned to the world frame.
        """
        turned, (stiffness, omega, reference) = np.zeros((len(before) + 1, 2)), window
        seen = None if memory is None else memory @ rotation
        linear.product(before, rotation, turned[: len(before)])
        return cls(state, stiffness, omega, reference, steps, turned[0], turned[1:], rotation, seen)


@dataclass(frozen=True)
class Motion:
    """The answer to a `MotionProblem`, in the plan frame.

    Attributes:
        jerk: CoM jerk of each sample, shape (N, 2) [m/s^3].
        shifts: shifts of the next two footsteps, shape (step, axis) = (2, 2) [m].
        zmp_slack: violation of the ZMP box that was accepted, per axis; NaN for an axis that was not solved, shape (2,)
            [m].
        terminal_slack: violation of the terminal DCM bound that was accepted, per axis, shape (2,) [m].
        solver: the worse status of the two axes.
        infeasible: a hard problem had no solution and was softened.
        qps: the problems that were solved, x and y axis, to be looked at or stored; none where a law needs no QP.
        memory: what the law gets back in the next tick, one vector or several, shape (..., 2); a law itself
            remembers nothing.
    """

    jerk: Array
    shifts: Array
    zmp_slack: Array
    terminal_slack: Array
    solver: SolverStatus = SolverStatus.SOLVED
    infeasible: bool = False
    qps: Sequence[Qp] = ()
    memory: Array | None = None


class MotionPlanner(Protocol):
    """A law of motion: the one thing in which the planner profiles differ. The same problem has the same motion."""

    def plan(self, problem: MotionProblem) -> Motion:
        """The jerk over the horizon, and where the next footsteps go."""


@dataclass(frozen=True)
class BuiltQps:
    """The QPs of one tick, and what their solutions are to be added to.

    Attributes:
        axes: those of the plan frame's x and y axis.
        jerk: to which the moves are added, shape (N, 2) [m/s^3].
        shifts: of the next two footsteps as far as they are decided already, shape (step, axis) = (2, 2) [m].
    """

    axes: tuple[Qp, Qp]
    jerk: Array
    shifts: Array


class QpLaw(MotionPlanner, Protocol):
    """A law that solves a QP per axis; `plan` is its three steps in turn."""

    def build(self, problem: MotionProblem) -> BuiltQps:
        """The QPs of a tick."""

    def solve(self, built: BuiltQps) -> tuple[QpSolution, QpSolution]:
        """Solve the problems."""

    def interpret(self, problem: MotionProblem, built: BuiltQps, solutions: tuple[QpSolution, QpSolution]) -> Motion:
        """The motion that the solutions mean."""
