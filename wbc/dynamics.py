"""Hard rows of the whole-body QP: floating-base dynamics, rigid contacts, wrench cones, torque and joint limits."""

from collections.abc import Sequence

import numpy as np

from surefoot.wbc.compiled import CompiledTick
from surefoot.wbc.contacts import ContactState
from surefoot.wbc.leaning import FREE
from surefoot.wbc.limits import AccelerationBounds, JointLimits
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.parameters import ContactGains
from surefoot.wbc.qp import FOOT_ROWS, UNBOUNDED, QpData, QpLayout
from surefoot.wbc.types import Array


class HardConstraints:
    """Writes all rows and bounds of the QP.

    Active contact: J q̈ + J' v = -d J v + levelling; inactive contact: w = 0. Six rows each, so that the QP keeps its
    shape. A foot that lands before it is felt goes on down along its normal. A leaning foot (see
    `surefoot.wbc.leaning`) is free to turn about its line, where its moment is zero.
    Floating base: M_b q̈ + h_b = Σ J_bᵀ w (first six rows of the equations of motion).
    Torque: τ = M_a q̈ + h_a - Σ J_aᵀ w within the limits, with the torque itself eliminated.
    Joints: within their limits, where a foot that is held counts as at rest. What it turns is a ripple of its contact,
    micrometres high, which the ground ends; to stop it at an ankle near its end would take the whole body. So would the
    end of the range of an ankle that rolls a held foot: on the narrow side of its sole the joint's stop tips it over
    its edge, where the CoP is by then, and the shank goes on as before. No row knows of that end while a foot is held.
    """

    def __init__(
        self,
        qp: QpData,
        layout: QpLayout,
        cones: tuple[Array, Array],
        limits: JointLimits,
        gains: ContactGains,
        ankles: Sequence[Sequence[int]] = ((), ()),
        tipping: tuple[int, ...] = (-1, -1),
        compiled: CompiledTick | None = None,
        leaning: bool = False,
    ) -> None:
        """Write the rows that change with the contacts only.

        Args:
            qp: to write into.
            layout: of it.
            cones: of the sole and of its toe edge, shape (rows, 6) each.
            limits: of the joints.
            gains: of the contacts.
            ankles: columns of the generalised velocity that belong to the left and to the right ankle.
            tipping: of these, that of the joint that rolls each foot; -1 for none.
            compiled: on which the kernel works; None for plain Python.
            leaning: whether the kernel's feet lean.
        """
        self._gains = gains
        self._joints, self._ankles = AccelerationBounds(limits), [list(columns) for columns in ankles]
        self._at_ankles = [_place(columns) for columns in self._ankles]
        self._tipping = tipping
        self._rates = np.zeros(layout.nv)
        self._torque_span = np.concatenate([np.zeros(6), limits.torque])
        self._target, self._active = np.zeros((2, 6)), (False, False)
        n, first = layout.variables, layout.torque_rows.stop
        for k in (0, 1):
            rows = slice(first + k * layout.cone_rows, first + (k + 1) * layout.cone_rows)
            qp.A[rows, layout.wrench(k)] = cones[0]
            qp.bounds_upper[n + rows.start : n + rows.stop] = 0.0
        self._cones, self._rolling = cones, -1
        self._bind(qp, layout)
        self._release(0)
        self._release(1)
        if compiled is not None:
            self._compile(compiled, qp, leaning)

    def _compile(self, tick: CompiledTick, qp: QpData, leaning: bool) -> None:
        bounds = self._joints
        self.bound = tick.kernels.fill(
            "HardRows",
            terms=tick.terms,
            reference=tick.reference,
            variables=len(qp.g),
            damping=self._gains.damping,
            softening=self._gains.softening,
            sinking=self._gains.sinking,
            levelling=self._gains.levelling,
            leaning=int(leaning),
            free_row=FREE,
            ankle_joints=len(self._ankles[0]),
            ankle_columns=np.array(self._ankles, dtype=np.int64),
            tipping_columns=np.array(self._tipping, dtype=np.int64),
            unbounded=UNBOUNDED,
            torque_span=self._torque_span,
            reach_time=bounds.reach_time,
            position_rate=bounds.position_rate,
            velocity_rate=bounds.velocity_rate,
            positions=bounds.positions,
            velocities=bounds.velocities,
            rates=self._rates,
            A=qp.A,
            lower=qp.bounds_lower,
            upper=qp.bounds_upper,
        )

    def follow(self, contacts: ContactState) -> None:
        """What of ``write`` the kernel leaves to Python where these contacts are not those of the tick before."""
        if contacts.rolling != self._rolling:
            self._roll(contacts.rolling)
        self._active = contacts.active

    def _bind(self, qp: QpData, layout: QpLayout) -> None:
        # A view costs as much to make as to use, so the parts of rows and bounds get their names once.
        n, nv, lower, upper = layout.variables, layout.nv, qp.bounds_lower, qp.bounds_upper
        motion, contact = layout.motion_rows, slice(n, n + 2 * FOOT_ROWS)
        self._mass, self._forces = qp.A[motion, :nv], qp.A[motion, nv:]
        self._motion_lower, self._motion_upper = (b[n + motion.start : n + motion.stop] for b in (lower, upper))
        self._contact_lower, self._contact_upper = (b[contact].reshape(2, FOOT_ROWS) for b in (lower, upper))
        self._contact_rows = [qp.A[layout.contact_rows(k), :nv] for k in (0, 1)]
        first, rows = layout.torque_rows.stop, layout.cone_rows
        self._cone_rows = [qp.A[first + k * rows : first + (k + 1) * rows, layout.wrench(k)] for k in (0, 1)]
        self._no_wrench_rows = [qp.A[layout.contact_rows(k), layout.wrench(k)] for k in (0, 1)]
        self._joint_lower, self._joint_upper = lower[6:nv], upper[6:nv]
        self._force_caps = upper[nv + 2 : n : 6]

    def write(
        self,
        terms: RobotTerms,
        q: Array,
        v: Array,
        contacts: ContactState,
        ground_normal: Array,
        roll: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Write the rows and bounds of this state; q (nq,), v (nv,), ground_normal (2, 3) in the world frame.

        A rolling foot is seen from its toe edge (see ``RobotTerms.shift_foot``), which neither slides nor lifts; its
        pitch follows the planned ``roll``, rate and acceleration [rad/s, rad/s^2], and its CoP lies on the edge.
        """
        self._motion(terms)
        self._contacts(terms, contacts, ground_normal, roll)
        np.copyto(self._rates, v)
        held = [contacts.active[k] and k != contacts.rolling for k in (0, 1)]
        for k, columns in enumerate(self._at_ankles):
            if held[k]:
                self._rates[columns] -= terms.sole_jacobian[k, 3:][:, columns].T.dot(terms.sole_velocity[k, 3:])
        self._joints.write(q[7:], self._rates[6:], self._joint_lower, self._joint_upper)
        for k, column in enumerate(self._tipping):
            if held[k] and column >= 0:
                self._joint_lower[column - 6], self._joint_upper[column - 6] = -UNBOUNDED, UNBOUNDED

    def _motion(self, terms: RobotTerms) -> None:
        self._mass[:] = terms.mass_matrix
        np.multiply(terms.contact_jacobian.T, -terms.wrench_unit, out=self._forces)
        np.negative(terms.bias, out=self._motion_lower)
        np.add(self._motion_lower, self._torque_span, out=self._motion_upper)
        self._motion_lower -= self._torque_span

    def _contacts(
        self, terms: RobotTerms, contacts: ContactState, ground_normal: Array, roll: tuple[float, float]
    ) -> None:
        target, levelling = self._target, self._gains.levelling
        np.multiply(terms.sole_velocity, -self._gains.damping, out=target)
        for k in (0, 1):
            if contacts.landing[k]:
                target[k, 2] = -self._gains.softening * (terms.sole_velocity[k, 2] + self._gains.sinking)
        target -= terms.sole_bias
        # Rotation vector, in the sole frame, that turns the sole's normal to the ground's.
        normal = np.matmul(ground_normal[:, None, :], terms.contact_rotation)[:, 0]
        for k, (x, y, _) in enumerate(normal.tolist()):
            target[k, 3] -= levelling * y
            target[k, 4] += levelling * x
        if contacts.rolling != self._rolling:
            self._roll(contacts.rolling)
        if contacts.rolling >= 0:
            target[contacts.rolling, 4] += self._gains.damping * roll[0] + roll[1]
        if terms.leaning is not None:
            target[:, FREE] = 0.0
        self._follow(0, terms, contacts.active[0])
        self._follow(1, terms, contacts.active[1])
        self._active = contacts.active
        self._contact_lower[:] = target
        self._contact_upper[:] = target
        left, right = contacts.force_cap
        self._force_caps[:] = (left / terms.wrench_unit, right / terms.wrench_unit)

    def _follow(self, k: int, terms: RobotTerms, active: bool) -> None:
        if active:
            if not self._active[k]:
                self._no_wrench_rows[k][:] = 0.0
            self._contact_rows[k][:] = terms.sole_jacobian[k]
            if terms.leaning is not None:
                self._contact_rows[k][FREE] = 0.0
                self._no_wrench_rows[k][FREE, FREE] = 1.0
            return
        if self._active[k]:
            self._release(k)
        self._target[k] = 0.0

    def _roll(self, foot: int) -> None:
        for k in (0, 1):
            self._cone_rows[k][:] = self._cones[1 if k == foot else 0]
        self._rolling = foot

    def _release(self, k: int) -> None:
        self._contact_rows[k][:] = 0.0
        self._no_wrench_rows[k][:] = np.eye(6)


def _place(columns: list[int]) -> list[int] | slice:
    """Columns as a slice where they are neighbours, of which numpy makes a view in a fifth of a copy's time."""
    first, count = columns[0] if columns else 0, len(columns)
    return slice(first, first + count) if columns == list(range(first, first + count)) else columns
