"""What a solution of the whole-body QP means for the robot: torques, accelerations, wrenches and task errors."""

from collections.abc import Sequence

import numpy as np

from surefoot.native.library import Bound
from surefoot.similarity import Similarity
from surefoot.values import dataclass
from surefoot.wbc.compiled import CompiledTerms
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.qp import QpData, QpLayout
from surefoot.wbc.tasks.stack import TaskStack
from surefoot.wbc.types import Array

FADE, FADE_DAMPING = 0.05, 0.02
"""Time in which the last torque fades out [s], and torque of a joint's damper at 1 rad/s meanwhile over its largest one
[s/rad].

Constants here are the reference robot's; see `surefoot.similarity`."""


@dataclass(frozen=True, slots=True)
class WbcAnswer:
    """What a solution means for the robot. Arrays are overwritten by the next one.

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


class AnswerReader:
    """Fills an answer from solutions.

    Args:
        qp: which is solved.
        layout: of it.
        tasks: of its cost.
        limit: largest torques, shape (nj,) [N·m].
        period: time between two answers [s].
        size: of the robot.
        compiled: terms on which the kernel works; None for plain Python.

    Attributes:
        answer: as last filled.
        bound: the answer as kernels take it; None in plain Python.
    """

    def __init__(
        self,
        qp: QpData,
        layout: QpLayout,
        tasks: TaskStack,
        limit: Array,
        period: float,
        size: Similarity,
        compiled: CompiledTerms | None,
    ) -> None:
        self._tasks, self._limit = tasks, np.ascontiguousarray(limit, dtype=np.float64)
        self._fading = period / (FADE * size.time), FADE_DAMPING * size.time
        self._torque_rows, self._wrench = qp.A[layout.torque_rows], np.zeros(12)
        wrench, error = self._wrench.reshape(2, 6), np.zeros_like(tasks.target)
        self.answer = WbcAnswer(np.zeros(layout.joints), np.zeros(layout.nv), wrench, error)
        self._x = np.zeros(layout.variables)
        self.bound = None if compiled is None else self._bind(compiled)
        self._read = None if compiled is None else compiled.kernels.bind("answer_read", self.bound)

    def _bind(self, compiled: CompiledTerms) -> Bound:
        answer = self.answer
        return compiled.kernels.fill(
            "Answer",
            terms=compiled.bound,
            stack=compiled.stack(self._tasks),
            joints=len(answer.torque),
            torque_rows=self._torque_rows,
            torque_limit=self._limit,
            x=self._x,
            torque=answer.torque,
            acceleration=answer.acceleration,
            wrench=self._wrench,
            task_error=answer.task_error,
        )

    def read_from(self, x: Array) -> None:
        """Let the kernel find its solutions there, shape (n,), from now on."""
        if self.bound is not None:
            self._x = x
            self.bound.point(x=x)

    def read(self, terms: RobotTerms, x: Array, compiled: bool) -> None:
        """Fill the answer, with wrenches in the frames of the QP, by the kernel if it is the one of these terms."""
        if compiled and self._read is not None:
            self._x[...] = x
            self._read()
            return
        answer, nv = self.answer, len(self.answer.acceleration)
        np.matmul(self._torque_rows, x, out=answer.torque)
        np.add(answer.torque, terms.bias[6:], out=answer.torque)
        self._clip(answer.torque)
        answer.acceleration[:] = x[:nv]
        np.multiply(x[nv:], terms.wrench_unit, out=self._wrench)
        answer.task_error[:] = self._tasks.residual(x)

    def see_soles(self, shifted: Sequence[tuple[int, Array]]) -> None:
        """Turn wrenches in the frames of the QP into those of the soles.

        Args:
            shifted: feet with what takes a wrench from their frame to the sole's, as of `RobotTerms.shift_foot`.
        """
        for foot, to_sole in shifted:
            self.answer.wrench[foot] = to_sole @ self.answer.wrench[foot]

    def fade(self, v: Array) -> None:
        """Fade the last torque out while damping the joints whose velocity is known; v of shape (nv,)."""
        torque = self.answer.torque
        rate = np.where(np.isfinite(v[6:]), v[6:], 0.0)
        share, damping = self._fading
        torque += share * (-damping * self._limit * rate - torque)
        self._clip(torque)

    def _clip(self, torque: Array) -> None:
        np.minimum(torque, self._limit, out=torque)
        np.maximum(torque, -self._limit, out=torque)
