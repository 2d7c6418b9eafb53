"""The swing foot follows its curve."""

import numpy as np
import pinocchio as pin

from surefoot.maths import algebra, linear
from surefoot.wbc.body.leaning import FREE
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.parameters import TaskGains, TaskWeights
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks import law
from surefoot.wbc.tasks.law import TaskLaw
from surefoot.wbc.types import Array

YIELDING = 0.1
"""Way to the end of its range within which an ankle ceases to turn its swinging foot towards that end [rad]."""

_TURNED_BACK = 0.05
"""Angle beyond the target of such a foot at which it turns back at full strength [rad]."""

_RESTING = 0.3
"""Share by which the joint of such a foot is to rest while a step catches the body [-].

At 1 a marching G1 falls after a push of 0.45 N·s/kg that it survives at 0.3. In a fast walk, whose ankles come to their
ends in each step, it would slip by 14 mm.
"""

_LIFTED = 0.004
"""Most that such a foot is lifted, for what its toe or heel hangs lower, on the reference robot [m]."""


class AnkleStops:
    """Ankles of small range: a swinging foot turns with its shank rather than against the end of an ankle's range.

    A level sole may ask for more than the ankle can give, as on a slope, above high stairs or with a leg far to the
    side. The other joints would turn the whole body to give the rest, and the CoM with it.

    Args:
        model: the robot.
        frames: its soles.
        limits: of its joints.

    Attributes:
        ankles: from the centres of the soles, in their frames: forward and up, shape (2, 3) [m].
        columns: of the generalised velocity, those of the joints of each ankle.
        joints: how many those of one ankle are.
        rolling: of these, that of the joint of each ankle which rolls its foot; -1 for none.
        lower, upper: ends of the ranges of all joints, shape (nj,) [rad].
        ahead: time by which a joint is looked at before it comes to its end [s].
    """

    def __init__(self, model: pin.Model, frames: BodyFrames, limits: JointLimits) -> None:
        self.ankles, self.columns, self.rolling = _ankles(model, frames)
        self.lower, self.upper, self.ahead = limits.lower, limits.upper, 2.0 * limits.position_horizon
        self.joints = len(self.columns[0])
        self._columns = np.array(self.columns, dtype=np.int64)
        self._ankles, self._skew = self.ankles, np.array([pin.skew(ankle) for ankle in self.ankles])
        self._lower, self._upper = (np.array(ends, dtype=np.float64) for ends in (self.lower, self.upper))
        self._yielding, self._turned_back = YIELDING, _TURNED_BACK

    def yielding(self, terms: RobotTerms, k: int, n: int, desired: Array) -> float:
        """Share of a joint of ankle k that is not to turn the sole any further [-].

        Args:
            terms: of the state.
            k: the foot.
            n: the joint, as ``columns[k]`` has it.
            desired: orientation of the sole, shape (3, 3).
        """
        column = self._columns[k, n]
        position = terms._q[column + 1]
        coming = position + self.ahead * terms._v[column]
        up = self._upper[column - 6] - max(position, coming)
        down = min(position, coming) - self._lower[column - 6]
        near = min(up, down)
        if near >= self._yielding:
            return 0.0
        onward = algebra.inner(self.axis(terms, k, n), algebra.turn_between(terms._R_contact[k], desired))
        if not up < down:
            onward = -onward
        # A foot that keeps to its target may ask for more of the ankle all the same, since its shank turns.
        share: float = 1.0 - max(0.0, near) / self._yielding
        return share * algebra.clamp(1.0 + onward / self._turned_back, 0.0, 1.0)

    def axis(self, terms: RobotTerms, k: int, n: int) -> algebra.Vector:
        """Axis of that joint in the frame of the sole [-]."""
        row, column = 6 * k + 3, self._columns[k, n]
        return terms._J[row, column], terms._J[row + 1, column], terms._J[row + 2, column]


def _ankles(model: pin.Model, frames: BodyFrames) -> tuple[Array, tuple[tuple[int, ...], ...], tuple[int, ...]]:
    """Attributes of `AnkleStops`."""
    soles = [model.frames[model.getFrameId(name)] for name in frames.soles]
    ankles = np.array([sole.placement.inverse().translation for sole in soles]) * (1.0, 0.0, 1.0)
    joints, data = 2 if frames.leaning is None else 1, model.createData()
    supports = (model.supports[sole.parentJoint] for sole in soles)
    columns = tuple(tuple(model.joints[j].idx_v for j in list(chain) if model.nvs[j])[-joints:] for chain in supports)
    rolling = tuple(_rolling(model, data, name, of) for name, of in zip(frames.soles, columns, strict=True))
    return ankles, columns, rolling


def _rolling(model: pin.Model, data: pin.Data, sole: str, columns: tuple[int, ...]) -> int:
    """Column of the ankle joint whose axis is nearest to the length of its sole; -1 for none."""
    frame, local = model.getFrameId(sole), pin.ReferenceFrame.LOCAL
    axes = np.abs(pin.computeFrameJacobian(model, data, pin.neutral(model), frame, local)[3:, columns])
    along = [column for column, (x, y, z) in zip(columns, axes.T.tolist(), strict=True) if x > max(y, z)]
    return max(along, key=lambda column: axes[0, columns.index(column)], default=-1)


class SwingFoot(TaskLaw):
    """Acceleration of the swing foot's sole, linear then angular, in the sole's frame; absent when both feet stand.

    A foot that rolls is seen from its edge (see ``RobotTerms.shift_foot``). A foot that cannot be as level as it should
    (see `AnkleStops`) is from then on seen from its ankle. If it turns about the ankle, the shank stays where it was
    planned. So does the momentum of the leg, which the planner counts on. While a step catches the body, the joint that
    has come to its end is to rest as well. Otherwise the QP would turn the foot as a flywheel for the trunk. It is then
    lifted by what its side edge hangs lower, or that edge would meet the ground at full speed. Any foot is lifted by a
    few millimetres of what its toe or heel hangs lower. All of that would take the shank off its way again.
    """

    name, size = "swing foot", 6

    def __init__(
        self,
        weights: TaskWeights,
        gains: TaskGains,
        edges: tuple[float, float],
        length: float,
        stops: AnkleStops | None = None,
        leaning: bool = False,
    ) -> None:
        """Set up the task.

        Args:
            weights: of the tasks.
            gains: of the tasks.
            edges: toe edge and side edge from the sole's centre [m].
            length: size of the robot, by which rotations count [-].
            stops: where the ankles end; None for nowhere.
            leaning: whether the foot rolls as its leg does (see `surefoot.wbc.body.leaning`).
        """
        self._stops, self._turned = stops, -1
        self.weight = weights.swing * np.repeat([1.0, length**2], 3)
        if leaning:
            self.weight[FREE] = 0.0
        self._k, self._d = gains.swing
        (self._toe, self._side), self._lifted, self._resting = edges, _LIFTED * length, _RESTING
        self._shares, self._R_d = np.zeros(stops.joints if stops else 0), np.zeros((3, 3))

    def put(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array, target: Array) -> None:
        """See ``TaskLaw.put``."""
        k = reference.swing_foot
        if self._turned != k:
            self._turned = -1
        if k < 0:
            rows[:, :] = 0.0
            target[:] = 0.0
            return
        algebra.put_row(self._R_d, 0, reference._R[0])
        algebra.put_row(self._R_d, 1, reference._R[1])
        algebra.put_row(self._R_d, 2, reference._R[2])
        linear.scale_rows(rows, 0, 1.0, scale, terms._J, 6 * k)
        if self._stops is None:
            self._aim(terms, reference, k, 0.0, target)
        else:
            self._put_with(self._stops, terms, reference, k, scale, rows, target)

    def _put_with(
        self,
        stops: AnkleStops,
        terms: RobotTerms,
        reference: WbcReference,
        k: int,
        scale: Array,
        rows: Array,
        target: Array,
    ) -> None:
        """Write the target, and change the rows where the ankle comes to its end."""
        most = 0.0
        for n in range(stops.joints):
            self._shares[n] = stops.yielding(terms, k, n, self._R_d)
            most = max(most, self._shares[n])
        if most > 0.0:
            self._turned = k
        self._aim(terms, reference, k, most, target)
        if self._turned == k and self._edge(reference, k) == 0:
            self._see_from_ankle(stops, terms, reference, scale, rows, target)
        for n in range(stops.joints):
            if self._shares[n] > 0.0:
                self._yield(stops, terms, reference, n, scale, rows, target)

    def _aim(self, terms: RobotTerms, reference: WbcReference, k: int, most: float, target: Array) -> None:
        """Target of the sole's centre: K e - D (ẏ - ẏ_d) + ÿ_d - J' v, in the frame of the sole."""
        R, v, bias = terms._R_contact[k], terms._v_sole[k], terms._bias_sole[k]
        edge = self._edge(reference, k)
        lift = self._k * most * self._hangs(R, reference) if most > 0.0 else 0.0
        along = self._along(reference, algebra.row(terms._p_contact, k), edge)
        a = algebra.rotate_back(R, (along[0], along[1], along[2] + lift))
        ahead = algebra.rotate_back(R, algebra.add(reference._w_dot, algebra.scale(self._d, reference._w)))
        alpha = law.angular_feedback(self._k, self._d, R, (v[3], v[4], v[5]), self._R_d, ahead)
        roll = reference.roll[1] if k else reference.roll[0]
        pitching = self._d * roll[1] + roll[2] if edge else 0.0
        target[0] = a[0] + (-self._d * v[0] - bias[0])
        target[1] = a[1] + (-self._d * v[1] - bias[1])
        target[2] = a[2] + (-self._d * v[2] - bias[2])
        target[3] = alpha[0] - bias[3]
        target[4] = alpha[1] + pitching - bias[4]
        target[5] = alpha[2] - bias[5]

    def _edge(self, reference: WbcReference, k: int) -> int:
        """The edge on which a foot rolls, 0 for one that does not."""
        edge: int = reference.edge[1] if k else reference.edge[0]
        return edge

    def _along(self, reference: WbcReference, position: algebra.Vector, edge: int) -> algebra.Vector:
        """K e + D ẏ_d + ÿ_d of a sole at a position, in the world [m/s^2].

        The position of a rolling foot is that of its edge.
        """
        e = algebra.subtract(reference._s, position)
        if edge:
            e = algebra.add(e, algebra.scale(edge * self._toe, algebra.column(self._R_d, 0)))
        back = algebra.add(algebra.scale(self._k, e), algebra.scale(self._d, reference._s_dot))
        return algebra.add(back, reference._s_ddot)

    def _hangs(self, R: Array, reference: WbcReference) -> float:
        """Height by which an edge of the sole hangs too low, as far as it is to be lifted for that [m]."""
        R_d = self._R_d
        beside = self._side * abs(R[2, 1] - R_d[2, 1]) if reference.catching else 0.0
        hangs: float = min(self._toe * abs(R[2, 0] - R_d[2, 0]), self._lifted) + beside
        return hangs

    def _see_from_ankle(
        self,
        stops: AnkleStops,
        terms: RobotTerms,
        reference: WbcReference,
        scale: Array,
        rows: Array,
        target: Array,
    ) -> None:
        """Make the target of the sole's centre that of the ankle, and its rows.

        With the ankle at r in the frame of the sole: J_r = J_p - [r]x J_w, and the target gets the same of what the
        sole is to do, less what the sole does.
        """
        k = self._turned
        r, R, R_d = algebra.row(stops._ankles, k), terms._R_contact[k], self._R_d
        w, bias = algebra.vector(terms._v_sole[k, 3:]), algebra.vector(terms._bias_sole[k, 3:])
        w_d = reference._w
        here, there = algebra.rotate(R, r), algebra.rotate(R_d, r)
        along = algebra.cross(w_d, there)
        wanted = algebra.add(algebra.scale(self._k, algebra.subtract(there, here)), algebra.scale(self._d, along))
        wanted = algebra.add(wanted, algebra.cross(reference._w_dot, there))
        wanted = algebra.rotate_back(R, algebra.add(wanted, algebra.cross(w_d, along)))
        moved = algebra.cross(algebra.add(algebra.scale(self._d, w), bias), r)
        outward = algebra.cross(w, algebra.cross(w, r))
        more = algebra.subtract(algebra.subtract(wanted, moved), outward)
        for i in range(3):
            for j in range(3):
                linear.add_row(rows, i, -(scale[i] * stops._skew[k, i, j]), terms._J, 6 * k + 3 + j)
        target[0] += more[0]
        target[1] += more[1]
        target[2] += more[2]

    def _yield(
        self,
        stops: AnkleStops,
        terms: RobotTerms,
        reference: WbcReference,
        n: int,
        scale: Array,
        rows: Array,
        target: Array,
    ) -> None:
        """Take a share of what turns about a joint's axis a out of the angular rows and their target: 1 - s a aᵀ.

        The joint is the n-th one of the ankle that turns. While a step catches the body the joint is to rest instead.
        """
        k = self._turned
        a, column = stops.axis(terms, k, n), stops._columns[k, n]
        sa = algebra.scale(self._shares[n], a)
        for j in range(terms.nv):
            part = algebra.inner(a, algebra.column(rows, j, 3))
            rows[3, j] -= sa[0] * part
            rows[4, j] -= sa[1] * part
            rows[5, j] -= sa[2] * part
        counted = self._resting if reference.catching else 0.0
        resting = counted * -2.0 * terms._v[column] / stops.ahead
        turn = resting - algebra.inner(a, (target[3], target[4], target[5]))
        rows[3, column] += scale[3] * counted * self._shares[n] * a[0]
        rows[4, column] += scale[4] * counted * self._shares[n] * a[1]
        rows[5, column] += scale[5] * counted * self._shares[n] * a[2]
        target[3] += sa[0] * turn
        target[4] += sa[1] * turn
        target[5] += sa[2] * turn
