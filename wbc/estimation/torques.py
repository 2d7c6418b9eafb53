"""Sole wrenches of a robot without sensors in its feet, from the torques of its joints."""

import math

import numpy as np
import pinocchio as pin

from surefoot.engines.mimic import Dynamics, JointColumns
from surefoot.maths import algebra, linear
from surefoot.wbc.estimation.kinematics import Sole, supporting
from surefoot.wbc.estimation.parameters import SensorNoise
from surefoot.wbc.types import Array, RobotState

BANDWIDTH = 60.0
"""Bandwidth of the observer for encoders of `FINE` [Hz]."""

FINE = 1.1e-5
"""Encoder noise for which the bandwidth is given [rad]."""

BASE = (1e-3, 2e-3)
"""Changes of the base's velocities in a tick: what an IMU misses of links that bend, and corrections [m/s, rad/s]."""

LEVER = 0.1
"""Lever at which moments count as forces [m]."""

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
        base: changes of the base's velocities in a tick that nobody knows, linear and angular [m/s, rad/s]. By a linear
            one of 0.3 m/s the base's velocity says nothing of the wrenches, as where it is to be found by them.

    Attributes:
        wrench: as of the last call, shape (2, 6) [N, N·m]; not finite where the state was not.
        residual: Σ J_kᵀ w_k as the observer has it, shape (nv,) [N, N·m].
        deviation: of its forces and of its moments, the largest [N, N·m].
        late: by how much the low pass makes it later [s].
    """

    def __init__(
        self,
        model: pin.Model,
        soles: tuple[str, str],
        period: float,
        sensors: SensorNoise,
        held: bool = True,
        base: tuple[float, float] = BASE,
    ) -> None:
        self._model = model
        self._data = model.createData()
        self._period = period
        self._held = held
        self._columns, self._dynamics = JointColumns(model, self._data), Dynamics(model, self._data)
        frames = [model.getFrameId(name) for name in soles]
        self._left, self._right = (Sole(model, self._data, frame) for frame in frames)
        # As in an α-β filter the noise grows with the bandwidth faster than the lag falls.
        quiet = min((FINE / sensors.encoder) ** 0.4, 1.0) if sensors.encoder > 0.0 else 1.0
        self._gain = gain = 1.0 - math.exp(-math.tau * BANDWIDTH * quiet * period)
        self.late = period * (1.0 - gain) / gain
        # White noise of a velocity, differenced and low-passed, and that of a torque.
        differenced, passed = 2.0 * gain**2 / (2.0 - gain) / period**2, gain / (2.0 - gain)
        rate = max(sensors.encoder, 1e-7) * math.sqrt(2.0) / period
        moved = np.repeat(np.square(base), 3) * differenced
        self._velocity_noise = np.concatenate((moved, np.full(model.nv - 6, rate**2 * differenced)))
        self._torque_noise = (sensors.joint_torque**2 + 0.05**2) * passed
        self._begun, self.residual = False, np.zeros(model.nv)
        self._residual = self.residual
        self._momentum, self._driven, self._torque = np.zeros(model.nv), np.zeros(model.nv), np.zeros(model.nv - 6)
        # The base moves both soles.
        carriers = tuple(model.frames[frame].parentJoint for frame in frames)
        carry = np.hstack((np.ones((2, 6)), supporting(model, carriers)))
        self._supporting, self._rows = carry, np.flatnonzero(carry.any(axis=0))
        self.wrench, self.deviation = np.zeros((2, 6)), (0.0, 0.0)
        self._share_memory(model.nv, len(self._rows))

    def _share_memory(self, nv: int, m: int) -> None:
        """See Pinocchio's data, of which a row here is a column there, and have room for what lies between."""
        data = self._data
        self._upper, self._M, self._gravity = data.M, data.M.T, data.g
        self._C, self._J = self._dynamics.C.T, self._columns.values.T
        self._M_v, self._C_v = np.zeros(nv), np.zeros(nv)
        self._some, self._noisy, self._noise = np.zeros((m, nv)), np.zeros((m, nv)), np.zeros((m, m))
        # Beside the Jacobian stands the residual, beside the normal equations their right side.
        self._A = np.zeros((m, 13))
        self._both, self._root = np.zeros((12, 13)), np.zeros((12, 13))
        self._normal, self._spreads = self._both[:, :12], np.zeros(12)
        self._spread = self._spreads

    def update(self, state: RobotState, torque: Array, passed: float | None = None) -> Array:
        """Wrenches in the sole frames, shape (2, 6) [N, N·m].

        Args:
            state: of the robot at the instant of the torque.
            torque: of the joints over the tick that ended, shape (nj,) [N·m].
            passed: since the call before; None for a control period [s].

        Raises:
            ValueError: velocities or torques are of another robot.
        """
        model, data, q = self._model, self._data, state.q
        v, torque = np.asarray(state.v, dtype=np.float64), np.asarray(torque, dtype=np.float64)
        if v.shape != (model.nv,) or torque.shape != (model.nv - 6,):
            raise ValueError(
                f"velocities of shape {v.shape} and torques of shape {torque.shape} of {model.nv - 6} joints"
            )
        self._dynamics.coriolis(q, v)
        self._dynamics.mass_matrix(q)
        pin.computeGeneralizedGravity(model, data, q)
        pin.computeJointJacobians(model, data, q)
        self._columns.update()
        # At first there is no span.
        span, self._begun = (passed or self._period) if self._begun else 0.0, True
        linear.mirror(self._upper)
        self._observe(v, torque, span)
        self.wrench = np.full((2, 6), math.nan)
        self._spread[:] = math.nan
        if not self._weigh():
            self._explain(self.wrench.ravel())
        largest = self._spreads.reshape(2, 2, 3).max(axis=(0, 2)).tolist()
        self.deviation = largest[0], largest[1]
        return self.wrench

    def _observe(self, v: Array, torque: Array, span: float) -> None:
        """Take what drives the momentum beside all that is known, a share of it in a span."""
        linear.multiply(self._M, v, self._M_v)
        linear.multiply(self._C, v, self._C_v)
        share = 1.0 - math.pow(1.0 - self._gain, span / self._period)
        for i in range(len(self._residual)):
            momentum, driven = self._M_v[i], self._C_v[i] - self._gravity[i]
            now = torque[i - 6] if i >= 6 else 0.0
            if span > 0.0:
                # The exact discrete low pass. Half a tick in the torque is a force where a command jumps.
                acted = now if i < 6 or self._held else 0.5 * (now + self._torque[i - 6])
                lacking = (momentum - self._momentum[i]) / span - 0.5 * (driven + self._driven[i])
                self._residual[i] += share * (lacking - acted - self._residual[i])
            else:
                self._residual[i] = -driven - now
            self._momentum[i], self._driven[i] = momentum, driven
        # Who gives the torque may write the next one into the same array.
        self._torque[:] = torque

    def _weigh(self) -> bool:
        """Set up the normal equations A' N⁻¹ A w = A' N⁻¹ r of the wrenches, with the covariance N of the residual r.

        Returns:
            Whether there are none, as of a state that is not finite.
        """
        self._see(0, self._left)
        self._see(1, self._right)
        for r in range(len(self._rows)):
            row = self._rows[r]
            self._A[r, 12] = self._residual[row]
            for j in range(len(self._residual)):
                self._some[r, j] = self._M[row, j]
                self._noisy[r, j] = self._velocity_noise[j] * self._M[row, j]
        linear.upper_product(self._noisy, self._some, self._noise)
        for r in range(len(self._rows)):
            self._noise[r, r] += BASE_NOISE if self._rows[r] < 6 else self._torque_noise
        if linear.factor(self._noise):
            return True
        linear.forward_solve(self._noise, self._A)
        self._both[:] = 0.0
        linear.add_gram(self._both, self._A)
        for a in range(12):
            self._normal[a, a] += 1.0 / LARGEST**2
        return linear.factor(self._normal)

    def _see(self, k: int, sole: Sole) -> None:
        """Transposed Jacobian of a sole in its frame, of the rows that move one, with moments counted as forces."""
        sole.place()
        for r in range(len(self._rows)):
            row = self._rows[r]
            along = self._J[row, 0], self._J[row, 1], self._J[row, 2]
            angular = self._J[row, 3], self._J[row, 4], self._J[row, 5]
            at_sole = algebra.subtract(along, algebra.cross(sole.position, angular))
            carries = self._supporting[k, row]
            force, moment = algebra.rotate_back(sole.rotation, at_sole), algebra.rotate_back(sole.rotation, angular)
            algebra.put_row(self._A, r, algebra.scale(carries, force), 6 * k)
            algebra.put_row(self._A, r, algebra.scale(carries * LEVER, moment), 6 * k + 3)

    def _explain(self, wrench: Array) -> None:
        """Solve the normal equations U'U w = y: the wrenches, shape (12,), and how far off they may be."""
        self._root[:] = 0.0
        for a in range(12):
            self._root[a, a], self._root[a, 12] = 1.0, self._both[a, 12]
        linear.forward_solve(self._normal, self._root)
        for a in range(12):
            variance, found = 0.0, 0.0
            for r in range(a, 12):
                variance += self._root[r, a] * self._root[r, a]
                found += self._root[r, a] * self._root[r, 12]
            scale = 1.0 if a % 6 < 3 else LEVER
            wrench[a] = scale * found
            self._spread[a] = scale * math.sqrt(variance)
