"""A task as the whole-body QP sees it, and the common part of several tasks."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

import pinocchio as pin

from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks import law
from surefoot.wbc.tasks.registry import TaskLayout
from surefoot.wbc.types import Array

Vector = tuple[float, float, float]


class Task(Protocol):
    """An aim of the whole-body QP: J x = a in the sense of weighted least squares.

    The variables are x = [q̈ (nv), w_left (6), w_right (6)] with the sole wrenches in the sole frames, in units of
    ``RobotTerms.wrench_unit``. A task on a motion y(q) with the error e and the velocity ẏ = J_y v asks for
    ÿ = J_y q̈ + J̇_y v to be K e - D ẏ: its J is [J_y, 0] and its a is K e - D ẏ - J̇_y v. Its cost is
    Σ weight (J x - a)² over its rows, with accelerations of about 1 and weights of about 1 to 10 on the default tasks.

    A task is asked once per tick, after the terms were computed. It may keep buffers of its own; it must not keep
    state that outlives a tick, lest equal states give unequal torques. Where it has a ``catching_weight``, which is
    shaped as its weight, it counts by that while a step is adapted to catch the body.
    """

    @property
    def name(self) -> str:
        """Name of the task in the log and in messages; its own among the tasks of a controller."""

    @property
    def size(self) -> int:
        """Number of its rows."""

    @property
    def weight(self) -> float | Array:
        """Cost of a squared residual, of all rows or of each, shape (size,); the unit is one over the residual's²."""

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Iterable[float]:
        """Write the rows of this state and reference.

        Args:
            terms: of the state; ``terms.data`` holds what ``pin.computeAllTerms`` leaves, so that frame placements,
                velocities, Jacobians and (with q̈ = 0) accelerations can be taken from it.
            reference: what the robot shall do; a task may as well have a target of its own.
            scale: square root of the weight, shape (size, 1) [1 / unit of a].
            rows: gets scale * J, shape (size, nv + 12); as this task left it a tick before, zero at first.

        Returns:
            a, not scaled, ``size`` numbers [m/s^2, rad/s^2, as J makes it].
        """


TaskFactory = Callable[[pin.Model, BodyFrames], Task]
"""Makes a task for a robot; what is registered under a name in ``surefoot.wbc.tasks.TASKS``."""


@dataclass(frozen=True, slots=True)
class Weighted:
    """A task with another weight than its own, also while a step catches the body.

    Attributes:
        task: the task.
        weight: cost of a squared residual, of all rows or of each, shape (size,).
    """

    task: Task
    weight: float | Array

    @property
    def name(self) -> str:
        """See ``Task.name``."""
        return self.task.name

    @property
    def size(self) -> int:
        """See ``Task.size``."""
        return self.task.size

    @property
    def write(self) -> Callable[[RobotTerms, WbcReference, Array, Array], Iterable[float]]:
        """See ``Task.write``."""
        return self.task.write


def layout_of(tasks: Iterable[Task]) -> TaskLayout:
    """Names and sizes of tasks."""
    return tuple((task.name, task.size) for task in tasks)


def angular_acceleration(
    gains: tuple[float, float], R: Array, velocity: Array, desired: Array, ahead: Vector
) -> Vector:
    """K log(Rᵀ R_d) - D ω + u, shape (3,) [rad/s^2], all in the frame of R.

    Args:
        gains: stiffness K [1/s^2] and damping D [1/s].
        R: orientation in the world, shape (3, 3).
        velocity: ω, shape (3,) [rad/s].
        desired: R_d, shape (3, 3).
        ahead: u, the acceleration to be fed forward [rad/s^2].
    """
    wx, wy, wz = velocity
    return law.angular_feedback(*gains, R, (wx, wy, wz), desired, ahead)
