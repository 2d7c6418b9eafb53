"""Sole wrenches of a robot without sensors in its feet, from the torques of its joints."""

import numpy as np
import pinocchio as pin

from surefoot.wbc.types import Array, RobotState

BANDWIDTH = 30.0
"""Of the observer: what it says follows the truth by 5 ms [Hz]."""

DAMPING = 1e-3
"""Of the least squares, against legs that are nearly stretched, where a force along them takes no torque [-]."""

LEVER = 0.1
"""At which moments count as forces [m]."""


class TorqueWrench:
    """Generalised-momentum observer of both soles' wrenches.

    With p = M q' the momentum obeys p' = S τ + Cᵀ q' - g + Σ J_kᵀ w_k, of which no acceleration has to be known. The
    residual r = K (p - p(0) - ∫ S τ + Cᵀ q' - g + r) follows Σ J_kᵀ w_k as a low pass of bandwidth K does (De Luca and
    Mattone, "Actuator failure detection and isolation using generalized momenta", ICRA 2003; for the contacts of
    humanoids Flacco et al., Humanoids 2016). The wrenches are those that explain the residual best, in the legs' rows
    and the base's.

    Args:
        model: the robot, with a free-flyer base.
        soles: names of the sole frames, left first.
        period: control period [s].
    """

    def __init__(self, model: pin.Model, soles: tuple[str, str], period: float) -> None:
        self._model, self._data, self._period = model, model.createData(), period
        self._soles = tuple(model.getFrameId(name) for name in soles)
        self._residual: Array | None = None
        self._momentum, self._driven = np.zeros(model.nv), np.zeros(model.nv)

    def update(self, state: RobotState, torque: Array, passed: float | None = None) -> Array:
        """Wrenches in the sole frames, shape (2, 6) [N, N·m].

        Args:
            state: of the robot now.
            torque: of the joints over the tick that ended, shape (nj,) [N·m].
            passed: how long that was [s]; None for the control period.
        """
        period = passed or self._period
        gain = 1.0 - np.exp(-2.0 * np.pi * BANDWIDTH * period)
        model, data, q, v = self._model, self._data, state.q, state.v
        pin.computeCoriolisMatrix(model, data, q, v)
        pin.crba(model, data, q)
        M = np.triu(data.M) + np.triu(data.M, 1).T
        gravity = pin.computeGeneralizedGravity(model, data, q)
        driven = data.C.T @ v - gravity
        driven[6:] += torque
        momentum = M @ v
        if self._residual is None:
            self._residual = -driven
        else:
            # The exact discrete low pass of what drives the momentum beside all that is known.
            lacking = (momentum - self._momentum) / period - 0.5 * (driven + self._driven)
            self._residual = self._residual + gain * (lacking - self._residual)
        self._momentum, self._driven = momentum, driven
        return self._wrenches(q)

    def _wrenches(self, q: Array) -> Array:
        model, data = self._model, self._data
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        jacobians = [pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL) for frame in self._soles]
        scale = np.tile([1.0, 1.0, 1.0, LEVER, LEVER, LEVER], 2)
        A = np.vstack(jacobians).T * scale
        touched = np.abs(A).sum(axis=1) > 0.0
        A, r = A[touched], self._residual[touched]  # type: ignore[index]
        normal = A.T @ A
        normal[np.diag_indices(12)] += DAMPING * np.trace(normal) / 12.0 * DAMPING
        solution = np.linalg.solve(normal, A.T @ r)
        return (scale * solution).reshape(2, 6)
