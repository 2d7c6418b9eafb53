"""The common part of the tasks of this package: a law that writes its rows and its target in place."""

from typing import TYPE_CHECKING, cast

import numpy as np

from surefoot.maths import algebra
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.types import Array

if TYPE_CHECKING:
    from surefoot.wbc.tasks.task import Task


class TaskLaw:
    """A task (see `wbc.tasks.task.Task`) whose ``put`` is compiled.

    A subclass elsewhere overrides ``write``, as a task of any other class has it.
    """

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> Array:
        """See ``Task.write``; rows, shape (size, nv + 12), lie side by side in memory."""
        target = np.zeros(len(rows))
        self.put(terms, reference, scale.reshape(-1), rows, target)
        return target

    def put(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array, target: Array) -> None:
        """Write rows and target of this state and reference.

        Args:
            terms: of the state.
            reference: what the robot shall do.
            scale: square root of the weight, shape (size,) [1 / unit of a].
            rows: gets scale * J, shape (size, nv + 12); as this task left it a tick before, zero at first.
            target: gets a, not scaled, shape (size,) [m/s^2, rad/s^2].
        """


class Place:
    """The place of a task in a stack: its rows and what belongs to them.

    Args:
        task: it; one whose class overrides ``TaskLaw.write``, or has nothing of it, is asked by ``write``.
        scale: square root of the weight, shape (size,).
        rows: shape (size, nv + 12).
        target: shape (size,).
    """

    def __init__(self, task: "Task", scale: Array, rows: Array, target: Array) -> None:
        self._task, self._arrays = task, (scale[:, None], rows, target)
        own = isinstance(task, TaskLaw) and type(task).write is TaskLaw.write
        self._law = cast(TaskLaw, task) if own else None
        self._scale, self._rows, self._target = scale, rows, target

    def put(self, terms: RobotTerms, reference: WbcReference) -> None:
        """Let the task write.

        Raises:
            ValueError: a task gives more or less numbers than it has rows.
        """
        if self._law is not None:
            self._law.put(terms, reference, self._scale, self._rows, self._target)
        else:
            scale, rows, target = self._arrays
            wanted = self._task.write(terms, reference, scale, rows)
            target[:] = np.reshape(tuple(wanted), target.shape)


def angular_feedback(
    stiffness: float, damping: float, R: Array, velocity: algebra.Vector, desired: Array, ahead: algebra.Vector
) -> algebra.Vector:
    """K log(Rᵀ R_d) - D ω + u, as `angular_acceleration` has it [rad/s^2]."""
    error = algebra.turn_between(R, desired)
    return (
        stiffness * error[0] - damping * velocity[0] + ahead[0],
        stiffness * error[1] - damping * velocity[1] + ahead[1],
        stiffness * error[2] - damping * velocity[2] + ahead[2],
    )
