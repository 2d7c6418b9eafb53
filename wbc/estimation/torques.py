"""Sole wrenches of a robot without sensors in its feet, from the torques of its joints."""

import math

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.types import Array, RobotState

BANDWIDTH = 60.0
"""Of the observer for encoders of `FINE` [Hz]."""

FINE = 1.1e-5
"""Encoder noise for which the bandwidth is told [rad]."""

BASE = (1e-3, 2e-3)
"""Of the base's velocities from tick to tick: what the IMU lacks of links that bend, and corrections [m/s, rad/s]."""

LEVER = 0.1
"""At which moments count as forces [m]."""

LARGEST = 1e4
"""Deviation of a wrench before anything is measured: far more than any is, against legs that are stretched [N]."""


class TorqueWrench:
    """Generalised-momentum observer of both soles' wrenches.

    With p = M q' the momentum obeys p' = S τ + Cᵀ q' - g + Σ J_kᵀ w_k, of which no acceleration has to be known. The
    residual r = K (p - p(0) - ∫ S τ + Cᵀ q' - g + r) follows Σ J_kᵀ w_k as a low pass of bandwidth K does (De Luca and
    Mattone, "Actuator failure detection and isolation using generalized momenta", ICRA 2003; for the contacts of
    humanoids Flacco et al., Humanoids 2016).

    The wrenches are those that explain the residual best by its covariance. What is noisy of it is the momentum, by
    the velocities and with the whole mass matrix, and the torques. So a leg tells its own foot's wrench, and the body,
    a heavy mass of a noisy velocity, tells little. Equal weights have five times the noise.

    Args:
        model: the robot, with a free-flyer base.
        soles: names of the sole frames, left first.
        period: control period [s].
        sensors: noise of encoders and torques.
        held: whether a torque acted all the while since the call before, and the states are those at both ends, as
            under commanded torques. Else the mean of it and the torque of the call before counts. It suits velocities
            in the middle between two calls, and a torque that changes evenly.

    Attributes:
        wrench: as of the last call, shape (2, 6) [N, N·m].
        deviation: of its forces and of its moments, the largest [N, N·m].
        late: by how much the low pass makes it later [s].
    """

    def __init__(
        self, model: pin.Model, soles: tuple[str, str], period: float, sensors: SensorNoise, held: bool = True
    ) -> None:
        self._model, self._data, self._period, self._held = model, model.createData(), period, held
        self._soles = tuple(model.getFrameId(name) for name in soles)
        # As in an α-β filter the noise grows with the bandwidth faster than the lag falls.
        quiet = min((FINE / sensors.encoder) ** 0.4, 1.0) if sensors.encoder > 0.0 else 1.0
        self._gain = gain = 1.0 - math.exp(-math.tau * BANDWIDTH * quiet * period)
        self.late = period * (1.0 - gain) / gain
        # White noise of a velocity, differenced and low-passed, and that of a torque.
        differenced, passed = 2.0 * gain**2 / (2.0 - gain) / period**2, gain / (2.0 - gain)
        rate = max(sensors.encoder, 1e-7) * math.sqrt(2.0) / period
        self._velocity_noise = np.full(model.nv, rate**2 * differenced)
        self._velocity_noise[:6] = np.repeat(np.square(BASE), 3) * differenced
        self._torque_noise = (sensors.joint_torque**2 + 0.05**2) * passed
        self._residual: Array | None = None
        self._momentum, self._driven, self._torque = np.zeros(model.nv), np.zeros(model.nv), np.zeros(model.nv - 6)
        self._scale = np.tile([1.0, 1.0, 1.0, LEVER, LEVER, LEVER], 2)
        self._rows: NDArray[np.intp] | None = None
        self.wrench, self.deviation = np.zeros((2, 6)), (0.0, 0.0)

    def update(self, state: RobotState, torque: Array, passed: float | None = None) -> Array:
        """Wrenches in the sole frames, shape (2, 6) [N, N·m].

        Args:
            state: of the robot at the instant of the torque.
            torque: of the joints over the tick that ended, shape (nj,) [N·m].
            passed: since the call before; None for a control period [s].
        """
        model, data, q, v = self._model, self._data, state.q, state.v
        pin.computeCoriolisMatrix(model, data, q, v)
        pin.crba(model, data, q)
        M = np.triu(data.M) + np.triu(data.M, 1).T
        gravity = pin.computeGeneralizedGravity(model, data, q)
        driven = data.C.T @ v - gravity
        momentum = M @ v
        if self._residual is None:
            self._residual = -driven
            self._residual[6:] -= torque
        else:
            # The exact discrete low pass of what drives the momentum beside all that is known. Half a tick in the
            # torque is a force where a command jumps.
            span = passed or self._period
            lacking = (momentum - self._momentum) / span - 0.5 * (driven + self._driven)
            lacking[6:] -= torque if self._held else 0.5 * (torque + self._torque)
            gain = 1.0 - (1.0 - self._gain) ** (span / self._period)
            self._residual = self._residual + gain * (lacking - self._residual)
        # Who gives the torque may write the next one into the same array.
        self._momentum, self._driven, self._torque[:] = momentum, driven, torque
        self.wrench = self._wrenches(q, M)
        return self.wrench

    def _wrenches(self, q: Array, M: Array) -> Array:
        model, data = self._model, self._data
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        jacobians = [pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL) for frame in self._soles]
        A = np.vstack(jacobians).T * self._scale
        if self._rows is None:
            self._rows = np.flatnonzero(np.abs(A).sum(axis=1) > 0.0)
        rows, residual = self._rows, self._residual
        assert residual is not None
        some = M[rows]
        noise = (some * self._velocity_noise) @ some.T
        noise[np.diag_indices_from(noise)] += np.where(rows < 6, 1e-4, self._torque_noise)
        A = A[rows]
        weighted = np.linalg.solve(noise, A)
        normal = A.T @ weighted
        normal[np.diag_indices(12)] += 1.0 / LARGEST**2
        covariance = np.linalg.inv(normal)
        spread = self._scale * np.sqrt(covariance.diagonal())
        self.deviation = float(spread[[0, 1, 2, 6, 7, 8]].max()), float(spread[[3, 4, 5, 9, 10, 11]].max())
        found: Array = (self._scale * (covariance @ (weighted.T @ residual[rows]))).reshape(2, 6)
        return found
