"""Values that cross the whole-body controller's boundary.

Robot states follow Pinocchio: ``q = [base position, base quaternion xyzw, joints]`` and
``v = [base linear, base angular, joints]`` with the base velocity in the base frame. Foot arrays hold the left
foot first. Wrenches are ``[fx, fy, fz, tx, ty, tz]`` at the sole centre in the sole frame. Units are SI.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import NO_LOAD, ExternalLoad
from surefoot.similarity import GRAVITY as GRAVITY

Array = NDArray[np.float64]


class SolveStatus(IntEnum):
    """The origin of the torque of one tick."""

    SOLVED = 0
    """The default solver solved the QP."""
    SECOND_SOLVER = 1
    """The default solver failed and another one solved it."""
    EQUALITIES_ONLY = 2
    """All failed: dynamics and contacts hold, inequalities are dropped and the torque is clipped."""
    HELD = 3
    """Nothing could be solved: the last torque is held and faded into damping."""
    SOFTENED = 4
    """Nothing holds all limits: some are broken, of those of the joints' motion and of the distances between limbs.

    Where that does not do, soles that are to rest move as well."""


@dataclass(frozen=True)
class RobotState:
    """State of the floating-base robot.

    Attributes:
        q: configuration, shape (nq,) [m, -, rad].
        v: velocity, shape (nv,) [m/s, rad/s].
    """

    q: Array
    v: Array


NONE_TOUCHES = (False, False)


@dataclass(frozen=True)
class FootSensing:
    """The forces that the feet feel.

    Attributes:
        normal_force: force along each sole's normal, (left, right) [N].
        wrench: sole wrenches in the sole frames, shape (2, 6) [N, N·m]; without them no load is estimated.
        contact: which soles the ground carries, (left, right); None where the normal forces shall tell.
        load_deviation: standard deviations of the force and of the moment that momentum and wrenches give for a load,
            zero for the truth, infinite where they give none [N, N·m].
        wrench_age: time since the wrenches acted, by latency and filters; zero for the truth [s].
        touching: soles that nothing is felt of yet, and that are about to come to the ground, (left, right).
    """

    normal_force: tuple[float, float]
    wrench: Array | None = None
    contact: tuple[bool, bool] | None = None
    load_deviation: tuple[float, float] = (0.0, 0.0)
    wrench_age: float = 0.0
    touching: tuple[bool, bool] = NONE_TOUCHES


@dataclass(frozen=True)
class WbcReport:
    """The report of the controller on one tick. Arrays are overwritten by the next tick.

    Attributes:
        torque: joint torques, shape (nj,) [N·m].
        status: where the torque came from.
        iterations: iterations of the solver that answered.
        primal_residual: largest violation of the QP's constraints [-].
        dual_residual: largest violation of stationarity, NaN where the solver does not tell [-].
        acceleration: planned generalised acceleration, shape (nv,) [m/s^2, rad/s^2].
        wrench: planned contact wrenches, shape (2, 6) [N, N·m].
        active: contacts held by the QP, (left, right).
        felt: contacts felt by the feet, (left, right).
        edge: of each foot that of which alone it stands: 1 the toe edge, -1 the heel edge, 0 none, all of its sole [-].
        task_error: residuals of all tasks before weighting, shape (rows,) [m/s^2, rad/s^2, N, N m]; names and sizes of
            the tasks are ``WholeBodyController.task_layout``.
        build_time: wall-clock time of load, contacts and assembly [s].
        solve_time: wall-clock time of the solve and of what it means [s].
        load: with which it counted.
    """

    torque: Array
    status: SolveStatus
    iterations: int
    primal_residual: float
    dual_residual: float
    acceleration: Array
    wrench: Array
    active: tuple[bool, bool]
    felt: tuple[bool, bool]
    edge: tuple[int, int]
    task_error: Array
    build_time: float
    solve_time: float
    load: ExternalLoad = NO_LOAD


@dataclass(frozen=True)
class WbcAnswer:
    """The meaning of a solution for the robot. Arrays are overwritten by the next one.

    Attributes:
        torque: joint torques within their limits, shape (nj,) [N·m].
        acceleration: planned generalised acceleration, shape (nv,) [m/s^2, rad/s^2].
        wrench: planned contact wrenches, in the sole frames, shape (2, 6) [N, N·m].
        task_error: residuals of all tasks before weighting, shape (rows,) [m/s^2, rad/s^2, N, N m].
    """

    torque: Array
    acceleration: Array
    wrench: Array
    task_error: Array
