"""Hard rows of the whole-body QP: floating-base dynamics, rigid contacts, wrench cones, torque and joint limits."""

import numpy as np

from surefoot.maths import algebra, linear
from surefoot.wbc.body.leaning import FREE
from surefoot.wbc.body.limits import AccelerationBounds, JointLimits
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.contact.contacts import ContactState
from surefoot.wbc.parameters import ContactGains
from surefoot.wbc.qp.data import UNBOUNDED, QpData, QpLayout
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.swing import AnkleStops
from surefoot.wbc.types import Array


class HardConstraints:
    """Writes all rows and bounds of the QP.

    Active contact: J q̈ + J' v = -d J v + levelling; inactive contact: w = 0. Six rows each, so that the QP keeps its
    shape. A foot that lands before it is felt goes on down along its normal. A leaning foot (see
    `surefoot.wbc.body.leaning`) is free to turn about its line, where its moment is zero.
    Floating base: M_b q̈ + h_b = Σ J_bᵀ w (first six rows of the equations of motion).
    Torque: τ = M_a q̈ + h_a - Σ J_aᵀ w within the limits, with the torque itself eliminated.
    Joints: within their limits, where a foot that is held counts as at rest. What it turns is a ripple of its contact,
    micrometres high, which the ground ends; to stop it at an ankle near its end would take the whole body. The end of
    the range of an ankle that rolls a held foot would do so, too. There the joint's stop tips the sole over its narrow
    edge, where the CoP is by then, and the shank goes on as before. No row knows of that end while a foot is held.
    """

    def __init__(
        self,
        qp: QpData,
        layout: QpLayout,
        cones: tuple[Array, Array],
        limits: JointLimits,
        gains: ContactGains,
        stops: AnkleStops,
        leaning: bool = False,
    ) -> None:
        """Write the rows that change with the contacts only.

        Args:
            qp: to write into.
            layout: of it.
            cones: of the sole and of an edge of it, shape (rows, 6) each.
            limits: of the joints.
            gains: of the contacts.
            stops: where the ankles end; of these, the joints that rest, and those that roll each foot.
            leaning: whether feet roll as their legs do (see `surefoot.wbc.body.leaning`).
        """
        self._damping, self._levelling = gains.damping, gains.levelling
        self._striking, self._striking_damping = gains.striking, gains.striking_damping
        self._softening, self._sinking = gains.softening, gains.sinking
        self._free = FREE if leaning else -1
        self._joints, self._unbounded = AccelerationBounds(limits), UNBOUNDED
        self._ankles = np.array([list(columns) for columns in stops.columns], dtype=np.int64).reshape(2, -1)
        self._tipping = np.array(stops.rolling, dtype=np.int64)
        self._torque_span, self._rates = np.concatenate([np.zeros(6), limits.torque]), np.zeros(layout.nv)
        n, first = layout.variables, layout.torque_rows.stop
        rows = [slice(first + k * layout.cone_rows, first + (k + 1) * layout.cone_rows) for k in (0, 1)]
        self._cones, self._edge = cones, (0, 0)
        self._cone_rows = [qp.A[rows[k], layout.wrench(k)] for k in (0, 1)]
        self._stand((0, 0))
        for k in (0, 1):
            qp.bounds_upper[n + rows[k].start : n + rows[k].stop] = 0.0
        self._A, self._lower, self._upper = qp.A, qp.bounds_lower, qp.bounds_upper
        # Bounds of the rows come after those of the variables.
        self._row_lower, self._row_upper = qp.bounds_lower[n:], qp.bounds_upper[n:]

    def _stand(self, edge: tuple[int, int]) -> None:
        """Hold a foot that rolls to the cone of its edge, another one to that of its sole."""
        for k in (0, 1):
            self._cone_rows[k][:] = self._cones[1 if edge[k] else 0]
        self._edge = edge

    def write(self, terms: RobotTerms, reference: WbcReference, contacts: ContactState) -> None:
        """Write the rows and bounds of this state.

        A rolling foot is seen from its edge (see ``RobotTerms.shift_foot``), which neither slides nor lifts; its pitch
        follows the planned roll, and its CoP lies on the edge.
        """
        edge = contacts.edge
        if edge[0] != self._edge[0] or edge[1] != self._edge[1]:
            self._stand(edge)
        left, right = contacts.active[0], contacts.active[1]
        self._motion(terms)
        self._contact(terms, reference, 0, left, contacts.landing[0])
        self._contact(terms, reference, 1, right, contacts.landing[1])
        self._upper[terms.nv + 2] = contacts.force_cap[0] / terms.wrench_unit
        self._upper[terms.nv + 8] = contacts.force_cap[1] / terms.wrench_unit
        self._bound_joints(terms, left and edge[0] == 0, right and edge[1] == 0)

    def _motion(self, terms: RobotTerms) -> None:
        """M q̈ - Jᵀ w between -h and -h, of joints less and more their largest torque."""
        nv = terms.nv
        for i in range(nv):
            self._row_lower[12 + i] = -terms._h[i] - self._torque_span[i]
            self._row_upper[12 + i] = -terms._h[i] + self._torque_span[i]
        linear.copy_rows(self._A, 12, terms._M, 0, nv)
        linear.put_transposed(self._A, 12, nv, -terms.wrench_unit, terms._J)

    def _contact(self, terms: RobotTerms, reference: WbcReference, k: int, active: bool, lands: bool) -> None:
        """Six equalities of a foot."""
        first, nv = 6 * k, terms.nv
        if active:
            linear.copy_rows(self._A, first, terms._J, first, 6)
        for i in range(6):
            row = first + i
            self._A[row, nv:] = 0.0
            self._row_lower[row] = self._rest(terms, k, i)
            if not active or i == self._free:
                self._A[row, :nv] = 0.0
                self._A[row, nv + row] = 1.0
                self._row_lower[row] = 0.0
        if active:
            if lands:
                sinking = terms._v_sole[k, 2] + self._sinking
                self._row_lower[first + 2] = -self._softening * sinking - terms._bias_sole[k, 2]
            self._turn(terms, reference, k)
        self._row_upper[first : first + 6] = self._row_lower[first : first + 6]

    def _rest(self, terms: RobotTerms, k: int, i: int) -> float:
        """J q̈ that brings a velocity of a sole to rest: -d J v - J' v [m/s^2, rad/s^2]."""
        wanted: float = terms._v_sole[k, i] * -self._damping - terms._bias_sole[k, i]
        return wanted

    def _turn(self, terms: RobotTerms, reference: WbcReference, k: int) -> None:
        """Turn the sole's normal to the ground's, which is a rotation vector in its frame, and let it roll."""
        target, first, edge = self._row_lower, 6 * k, self._edge[1] if k else self._edge[0]
        normal = algebra.rotate_back(terms._R_contact[k], reference._n[1] if k else reference._n[0])
        target[first + 3] -= self._levelling * normal[1]
        roll = reference.roll[1] if k else reference.roll[0]
        if edge < 0:
            behind = roll[1] - terms._v_sole[k, 4]
            bias = terms._bias_sole[k, 4]
            target[first + 4] = self._striking * normal[0] + self._striking_damping * behind + roll[2] - bias
        else:
            target[first + 4] += self._levelling * normal[0]
        if edge > 0:
            target[first + 4] += self._damping * roll[1] + roll[2]
        if self._free >= 0:
            target[first + self._free] = 0.0

    def _bound_joints(self, terms: RobotTerms, left: bool, right: bool) -> None:
        """Bounds of the joints' accelerations, of which a foot that is held counts as at rest."""
        nv = terms.nv
        self._rates[:] = terms._v
        if left:
            self._rest_ankle(terms, 0)
        if right:
            self._rest_ankle(terms, 1)
        self._joints.write(terms._q[7:], self._rates[6:], self._lower[6:nv], self._upper[6:nv])
        if left:
            self._release(self._tipping[0])
        if right:
            self._release(self._tipping[1])

    def _rest_ankle(self, terms: RobotTerms, k: int) -> None:
        """Take from the rates of an ankle what it turns of its foot."""
        for n in range(self._ankles.shape[1]):
            column, turning = self._ankles[k, n], 0.0
            for i in range(3):
                turning += terms._v_sole[k, 3 + i] * terms._J[6 * k + 3 + i, column]
            self._rates[column] -= turning

    def _release(self, column: int) -> None:
        """Let a variable be as it likes; none where the column is negative."""
        if column >= 0:
            self._lower[column], self._upper[column] = -self._unbounded, self._unbounded
