"""Hard rows of the whole-body QP: floating-base dynamics, rigid contacts, wrench cones, torque and joint limits."""

from dataclasses import dataclass

import numpy as np

from wbc.contacts import ContactState
from wbc.limits import JointLimits
from wbc.model import RobotTerms
from wbc.qp import EQUALITY_ROWS, QpData, QpLayout
from wbc.types import Array


@dataclass(frozen=True, slots=True)
class ContactGains:
    """Stabilisation of the rigid contacts.

    Attributes:
        damping: decay of a sole's remaining velocity [1/s].
        levelling: stiffness that turns an active sole flat on the ground [1/s^2].
    """

    damping: float = 20.0
    levelling: float = 100.0


class HardConstraints:
    """Writes all rows and bounds of the QP.

    Floating base: M_b q̈ + h_b = Σ J_kᵀ w_k (first six rows of the equations of motion).
    Active contact: J q̈ + J' v = -d J v + levelling; inactive contact: w = 0. Six rows each, so that the QP keeps its shape.
    Torque: τ = M_a q̈ + h_a - Σ J_aᵀ w within the limits, with the torque itself eliminated.
    """

    def __init__(self, qp: QpData, layout: QpLayout, cone: Array, limits: JointLimits, gains: ContactGains) -> None:
        """Write the rows that never change: the cones, shape (rows, 6), in the sole frames."""
        self._layout, self._limits, self._gains = layout, limits, gains
        self._identity = np.eye(6)
        n = layout.variables
        first = EQUALITY_ROWS + layout.joints
        for k in (0, 1):
            rows = slice(first + k * layout.cone_rows, first + (k + 1) * layout.cone_rows)
            qp.A[rows, layout.wrench(k)] = cone
            qp.bounds_upper[n + rows.start : n + rows.stop] = 0.0

    def write(self, qp: QpData, terms: RobotTerms, q: Array, v: Array, contacts: ContactState) -> None:
        """Write the rows and bounds of this state; q (nq,), v (nv,)."""
        self._dynamics(qp, terms)
        for k in (0, 1):
            self._contact(qp, terms, contacts, k)
        self._limit_bounds(qp, terms, q, v)

    def _dynamics(self, qp: QpData, terms: RobotTerms) -> None:
        nv, n = self._layout.nv, self._layout.variables
        torque = self._layout.torque_rows
        transposed = terms.sole_jacobian.reshape(12, nv).T
        qp.A[:6, :nv] = terms.mass_matrix[:6]
        np.negative(transposed[:6], out=qp.A[:6, nv:])
        np.negative(terms.bias[:6], out=qp.bounds_lower[n : n + 6])
        qp.bounds_upper[n : n + 6] = qp.bounds_lower[n : n + 6]
        qp.A[torque, :nv] = terms.mass_matrix[6:]
        np.negative(transposed[6:], out=qp.A[torque, nv:])

    def _contact(self, qp: QpData, terms: RobotTerms, contacts: ContactState, k: int) -> None:
        layout, n = self._layout, self._layout.variables
        rows, wrench = layout.contact_rows(k), layout.wrench(k)
        bounds = slice(n + rows.start, n + rows.stop)
        if contacts.active[k]:
            qp.A[rows, : layout.nv] = terms.sole_jacobian[k]
            qp.A[rows, wrench] = 0.0
            target = -terms.sole_bias[k] - self._gains.damping * terms.sole_velocity[k]
            # Rotation vector, in the sole frame, that turns the sole's normal to the vertical.
            target[3] -= self._gains.levelling * terms.sole_rotation[k, 2, 1]
            target[4] += self._gains.levelling * terms.sole_rotation[k, 2, 0]
        else:
            qp.A[rows, : layout.nv] = 0.0
            qp.A[rows, wrench] = self._identity
            target = np.zeros(6)
        qp.bounds_lower[bounds] = target
        qp.bounds_upper[bounds] = target
        qp.bounds_upper[wrench.start + 2] = contacts.force_cap[k]

    def _limit_bounds(self, qp: QpData, terms: RobotTerms, q: Array, v: Array) -> None:
        nv, n = self._layout.nv, self._layout.variables
        lower, upper = self._limits.acceleration_bounds(q[7:], v[6:])
        qp.bounds_lower[6:nv] = lower
        qp.bounds_upper[6:nv] = upper
        torque = slice(n + self._layout.torque_rows.start, n + self._layout.torque_rows.stop)
        np.subtract(-self._limits.torque, terms.bias[6:], out=qp.bounds_lower[torque])
        np.subtract(self._limits.torque, terms.bias[6:], out=qp.bounds_upper[torque])
