"""Sole wrenches of a robot without sensors in its feet, from the torques of its joints."""

import math
from collections.abc import Callable

import numpy as np
import pinocchio as pin

from surefoot.mimic import Dynamics, JointColumns
from surefoot.native.library import Library, library
from surefoot.wbc.estimation.kinematics import sole_of, supporting
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

BASE_NOISE = 1e-4
"""Variance of what drives the base beside its velocities, so that theirs has an inverse [N^2, (N·m)^2]."""

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
        self._columns, self._dynamics = JointColumns(model, self._data), Dynamics(model, self._data)
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
        self._begun, self._residual = False, np.zeros(model.nv)
        self._momentum, self._driven, self._torque = np.zeros(model.nv), np.zeros(model.nv), np.zeros(model.nv - 6)
        self._scale = np.tile([1.0, 1.0, 1.0, LEVER, LEVER, LEVER], 2)
        # The base moves both soles.
        carriers = tuple(model.frames[sole].parentJoint for sole in self._soles)
        self._supporting = np.hstack((np.ones((2, 6)), supporting(model, carriers)))
        self._rows = np.flatnonzero(self._supporting.any(axis=0))
        self.wrench, self.deviation = np.zeros((2, 6)), (0.0, 0.0)
        kernels = library()
        self._find = self._compiled(kernels) if kernels else None

    def _compiled(self, kernels: Library) -> Callable[[float, float], None]:
        model, data, m = self._model, self._data, len(self._rows)
        self._v, self._given = np.zeros(model.nv), np.zeros(model.nv - 6)
        self._found, self._spread = np.zeros((2, 6)), np.zeros(12)
        left, right = (sole_of(kernels, model, data, frame) for frame in self._soles)
        find: Callable[[float, float], None] = kernels.bind(
            "torque_wrench_update",
            nv=model.nv,
            count=m,
            held=self._held,
            base_noise=BASE_NOISE,
            torque_noise=self._torque_noise,
            least=1.0 / LARGEST**2,
            M=data.M.T,
            C_columns=self._dynamics.C.T,
            gravity=data.g,
            joint_jacobian_columns=self._columns.values.T,
            left=left,
            right=right,
            rows=self._rows,
            supporting=self._supporting,
            velocity_noise=self._velocity_noise,
            scale=self._scale,
            v=self._v,
            torque=self._given,
            momentum=self._momentum,
            driven=self._driven,
            last_torque=self._torque,
            residual=self._residual,
            noise=np.zeros((m, m)),
            A=np.zeros((m, 12)),
            some=np.zeros(model.nv),
            seen=np.zeros(m),
            wrench=self._found,
            deviation=self._spread,
        )
        return find

    def update(self, state: RobotState, torque: Array, passed: float | None = None) -> Array:
        """Wrenches in the sole frames, shape (2, 6) [N, N·m].

        Args:
            state: of the robot at the instant of the torque.
            torque: of the joints over the tick that ended, shape (nj,) [N·m].
            passed: since the call before; None for a control period [s].
        """
        model, data, q, v = self._model, self._data, state.q, state.v
        self._dynamics.coriolis(q, v)
        self._dynamics.mass_matrix(q)
        pin.computeGeneralizedGravity(model, data, q)
        pin.computeJointJacobians(model, data, q)
        self._columns.update()
        # At first there is no span.
        span, self._begun = (passed or self._period) if self._begun else 0.0, True
        share = 1.0 - (1.0 - self._gain) ** (span / self._period)
        if self._find is not None:
            self._v[:], self._given[:] = v, torque
            self._find(span, share)
            self.wrench, spread = self._found.copy(), self._spread
        else:
            M = np.triu(data.M) + np.triu(data.M, 1).T
            self._observe(M, v, torque, span, share)
            self.wrench, spread = self._wrenches(M)
        largest = spread.reshape(2, 2, 3).max(axis=(0, 2)).tolist()
        self.deviation = largest[0], largest[1]
        return self.wrench

    def _observe(self, M: Array, v: Array, torque: Array, span: float, share: float) -> None:
        """Take what drives the momentum beside all that is known, a share of it in a span."""
        driven, momentum = self._dynamics.C.T @ v - self._data.g, M @ v
        if span > 0.0:
            # The exact discrete low pass. Half a tick in the torque is a force where a command jumps.
            lacking = (momentum - self._momentum) / span - 0.5 * (driven + self._driven)
            lacking[6:] -= torque if self._held else 0.5 * (torque + self._torque)
            self._residual += share * (lacking - self._residual)
        else:
            self._residual[:] = -driven
            self._residual[6:] -= torque
        # Who gives the torque may write the next one into the same array.
        self._momentum[:], self._driven[:], self._torque[:] = momentum, driven, torque

    def _wrenches(self, M: Array) -> tuple[Array, Array]:
        """Wrenches of the soles, and their deviations one after the other, shape (12,)."""
        model, data, rows = self._model, self._data, self._rows
        pin.updateFramePlacements(model, data)
        jacobians = [pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL) for frame in self._soles]
        A, some = (np.vstack(jacobians).T * self._scale)[rows], M[rows]
        noise = (some * self._velocity_noise) @ some.T
        noise[np.diag_indices_from(noise)] += np.where(rows < 6, BASE_NOISE, self._torque_noise)
        weighted = np.linalg.solve(noise, A)
        normal = A.T @ weighted
        normal[np.diag_indices(12)] += 1.0 / LARGEST**2
        covariance = np.linalg.inv(normal)
        found: Array = (self._scale * (covariance @ (weighted.T @ self._residual[rows]))).reshape(2, 6)
        return found, self._scale * np.sqrt(covariance.diagonal())
