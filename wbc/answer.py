"""The meaning of a solution of the whole-body QP: torques, accelerations, wrenches and task errors."""

from collections.abc import Sequence

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.similarity import Similarity
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.qp.data import QpData, QpLayout
from surefoot.wbc.tasks.stack import TaskStack
from surefoot.wbc.types import Array, WbcAnswer

FADE, FADE_DAMPING = 0.05, 0.02
"""Time in which the last torque fades out [s], and torque of a joint's damper at 1 rad/s meanwhile over its largest one
[s/rad].

Constants here are the reference robot's; see `surefoot.similarity`."""


class AnswerReader:
    """Fills an answer from solutions.

    Args:
        qp: which is solved.
        layout: of it.
        tasks: of its cost.
        limit: largest torques, shape (nj,) [N·m].
        period: time between two answers [s].
        size: of the robot.

    Attributes:
        answer: as last filled.
    """

    def __init__(
        self, qp: QpData, layout: QpLayout, tasks: TaskStack, limit: Array, period: float, size: Similarity
    ) -> None:
        self._limit = np.ascontiguousarray(limit, dtype=np.float64)
        self._fading, self._damping = period / (FADE * size.time), FADE_DAMPING * size.time
        self._torque_rows, self._joints, self._nv = qp.A[layout.torque_rows], layout.joints, layout.nv
        self._rows, self._target, self._unscale = tasks.rows, tasks.target, tasks.unscale
        wrench = np.zeros((2, 6))
        self.answer = answer = WbcAnswer(
            np.zeros(layout.joints), np.zeros(layout.nv), wrench, np.zeros(len(tasks.target))
        )
        self._torque, self._acceleration, self._task_error = answer.torque, answer.acceleration, answer.task_error
        self._wrench = wrench.reshape(12)

    def read(self, terms: RobotTerms, x: Array) -> None:
        """Fill the answer, with wrenches in the frames of the QP.

        Args:
            terms: of the state.
            x: a solution, shape (n,).
        """
        unit = terms.wrench_unit
        self._torque[:] = terms._h[6:]
        linear.add_product(1.0, self._torque_rows, x, self._torque)
        self._clip()
        self._acceleration[:] = x[: self._nv]
        for i in range(12):
            self._wrench[i] = x[self._nv + i] * unit
        self._task_error[:] = 0.0
        linear.add_scaled(self._task_error, -1.0, self._target)
        linear.add_product(1.0, self._rows, x, self._task_error)
        for i in range(len(self._unscale)):
            self._task_error[i] *= self._unscale[i]

    def see_soles(self, shifted: Sequence[tuple[int, Array]]) -> None:
        """Turn wrenches in the frames of the QP into those of the soles.

        Args:
            shifted: feet with the matrix of a wrench from their frame to the sole's, by `RobotTerms.shift_foot`.
        """
        for foot, to_sole in shifted:
            self.answer.wrench[foot] = to_sole @ self.answer.wrench[foot]

    def fade(self, v: Array) -> None:
        """Fade the last torque out while damping the joints whose velocity is known; v of shape (nv,)."""
        torque = self.answer.torque
        rate = np.where(np.isfinite(v[6:]), v[6:], 0.0)
        torque += self._fading * (-self._damping * np.asarray(self._limit) * rate - torque)
        self._clip()

    def _clip(self) -> None:
        for j in range(self._joints):
            self._torque[j] = algebra.clamp(self._torque[j], -self._limit[j], self._limit[j])
