"""The swing foot follows its curve."""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pinocchio as pin

from surefoot.native.library import Bound
from surefoot.wbc.compiled import CompiledTick
from surefoot.wbc.leaning import FREE
from surefoot.wbc.limits import JointLimits
from surefoot.wbc.model import BodyFrames, RobotTerms, cross
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tasks.task import angular_acceleration
from surefoot.wbc.types import Array, WbcReference

YIELDING = 0.1
"""Way to the end of its range within which an ankle ceases to turn its swinging foot towards that end [rad]."""

_TURNED_BACK = 0.05
"""How far beyond its target such a foot has to be turned that it turns back at full strength [rad]."""

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
        rolling: of these, that of the joint of each ankle which rolls its foot; -1 for none.
        lower, upper: ends of the ranges of all joints, shape (nj,) [rad].
        ahead: time by which a joint is looked at before it comes to its end [s].
    """

    def __init__(self, model: pin.Model, frames: BodyFrames, limits: JointLimits) -> None:
        self.ankles, self.columns, self.rolling = _ankles(model, frames)
        self.lower, self.upper, self.ahead = limits.lower, limits.upper, 2.0 * limits.position_horizon
        self._lower, self._upper = np.asarray(self.lower).tolist(), np.asarray(self.upper).tolist()

    def yielding(self, terms: RobotTerms, k: int, desired: Array) -> list[tuple[int, Array, float]]:
        """Joints that are not to turn sole k any further: column, axis in the frame of the sole, and share of it [-].

        Args:
            terms: of the state.
            k: the foot.
            desired: its orientation, shape (3, 3).
        """
        found: list[tuple[int, Array, float]] = []
        for column in self.columns[k]:
            position, velocity = terms.q.item(column + 1), terms.v.item(column)
            coming = position + self.ahead * velocity
            up, down = self._upper[column - 6] - max(position, coming), min(position, coming) - self._lower[column - 6]
            near = min(up, down)
            if near >= YIELDING:
                continue
            axis = terms.sole_jacobian[k, 3:, column]
            onward = float(axis @ pin.log3(terms.contact_rotation[k].T @ desired)) * (1.0 if up < down else -1.0)
            # A foot that keeps to its target may ask for more of the ankle all the same, since its shank turns.
            share = (1.0 - max(0.0, near) / YIELDING) * min(max(1.0 + onward / _TURNED_BACK, 0.0), 1.0)
            if share > 0.0:
                found.append((column, axis, share))
        return found


@lru_cache(maxsize=8)
def _ankles(model: pin.Model, frames: BodyFrames) -> tuple[Array, tuple[tuple[int, ...], ...], tuple[int, ...]]:
    """Attributes of `AnkleStops`, which a robot that walks again has still."""
    soles = [model.frames[model.getFrameId(name)] for name in frames.soles]
    ankles = np.array([sole.placement.inverse().translation for sole in soles]) * (1.0, 0.0, 1.0)
    joints, data = 2 if frames.leaning is None else 1, model.createData()
    supports = (model.supports[sole.parentJoint] for sole in soles)
    columns = tuple(tuple(model.joints[j].idx_v for j in list(chain) if model.nvs[j])[-joints:] for chain in supports)
    rolling = tuple(_rolling(model, data, name, of) for name, of in zip(frames.soles, columns, strict=True))
    return ankles, columns, rolling


def _rolling(model: pin.Model, data: pin.Data, sole: str, columns: tuple[int, ...]) -> int:
    """Of the columns of an ankle, that of the joint whose axis is nearest to the length of its sole; -1 for none."""
    frame, local = model.getFrameId(sole), pin.ReferenceFrame.LOCAL
    axes = np.abs(pin.computeFrameJacobian(model, data, pin.neutral(model), frame, local)[3:, columns])
    along = [column for column, (x, y, z) in zip(columns, axes.T.tolist(), strict=True) if x > max(y, z)]
    return max(along, key=lambda column: axes[0, columns.index(column)], default=-1)


class SwingFoot:
    """Acceleration of the swing foot's sole, linear then angular, in the sole's frame; absent when both feet stand.

    A foot that leaves the ground rolling is seen from its toe edge (see ``RobotTerms.shift_foot``). One that cannot be
    as level as it should (see `AnkleStops`) is from then on seen from its ankle: a foot that turns about it leaves the
    shank where it was planned to be, and with it the momentum of the leg that the planner counts on. While a step
    catches the body, the joint that has come to its end is to rest as well. Otherwise the QP would turn the foot as a
    flywheel for the trunk. It is then lifted by what its side edge hangs lower, or that edge would meet the ground at
    full speed. Any foot is lifted by a few millimetres of what its toe or heel hangs lower. All of that would take the
    shank off its way again.
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
            leaning: whether the foot rolls as its leg does (see `surefoot.wbc.leaning`).
        """
        self._stops, self._turned = stops, -1
        self.weight = weights.swing * np.repeat([1.0, length**2], 3)
        if leaning:
            self.weight[FREE] = 0.0
        self._gains, (self._toe, self._side), self._lifted = gains.swing, edges, _LIFTED * length

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> tuple[float, ...]:
        """See ``Task.write``."""
        k = reference.swing_foot
        self._turned = self._turned if self._turned == k else -1
        if k < 0:
            rows[:] = 0.0
            return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        np.multiply(terms.sole_jacobian[k], scale, out=rows[:, :-12])
        yielding = self._stops.yielding(terms, k, reference.swing_rotation) if self._stops else []
        damping, R, velocity = self._gains[1], terms.contact_rotation[k], terms.sole_velocity[k]
        wanted = self._linear(terms, reference, k)
        if yielding:
            forward, aside, _ = np.abs(R[2] - reference.swing_rotation[2]).tolist()
            hangs = min(self._toe * forward, self._lifted) + (self._side * aside if reference.catching else 0.0)
            wanted[2] += self._gains[0] * max(share for *_, share in yielding) * hangs
        x, y, z = wanted.dot(R).tolist()
        turning = damping * reference.swing_angular_velocity
        turning += reference.swing_angular_acceleration
        ahead = tuple(turning.dot(R).tolist())
        ax, ay, az = angular_acceleration(self._gains, R, velocity[3:], reference.swing_rotation, ahead)
        pitching = damping * reference.roll[1] + reference.roll[2] if k == reference.rolling_foot else 0.0
        vx, vy, vz = velocity[:3].tolist()
        bx, by, bz, px, py, pz = terms.sole_bias[k].tolist()
        linear: tuple[float, ...] = (x - damping * vx - bx, y - damping * vy - by, z - damping * vz - bz)
        turn = (ax - px, ay + pitching - py, az - pz)
        self._turned = k if yielding else self._turned
        if self._turned == k and k != reference.rolling_foot and self._stops:
            linear = self._of_ankle(terms, reference, k, linear, self._stops.ankles[k])
            rows[:3, :-12] -= scale[:3] * (pin.skew(self._stops.ankles[k]) @ terms.sole_jacobian[k, 3:])
        for column, axis, share in yielding:
            kept = np.eye(3) - share * np.outer(axis, axis)
            rows[3:] = kept @ rows[3:]
            turned = kept @ turn
            if reference.catching and self._stops:
                resting = _RESTING * share * axis
                rows[3:, column] += scale[3:, 0] * resting
                turned -= 2.0 * terms.v[column] / self._stops.ahead * resting
            turn = tuple(turned.tolist())
        return (*linear, *turn)

    def compiled(self, tick: CompiledTick, bench: Bound) -> Callable[[], None]:
        """See ``CompiledTask.compiled``."""
        stops, none = self._stops, np.zeros(1)
        return tick.kernels.bind(
            "task_swing_foot",
            bench=bench,
            stiffness=self._gains[0],
            damping=self._gains[1],
            toe=self._toe,
            side=self._side,
            lifted=self._lifted,
            ankle_joints=len(stops.columns[0]) if stops else 0,
            ankle_columns=np.array(stops.columns if stops else [0], dtype=np.int64),
            ankles=stops.ankles if stops else none,
            lower=np.ascontiguousarray(stops.lower, dtype=np.float64) if stops else none,
            upper=np.ascontiguousarray(stops.upper, dtype=np.float64) if stops else none,
            ahead=stops.ahead if stops else 0.0,
            yielding=YIELDING,
            turned_back=_TURNED_BACK,
            resting=_RESTING,
            turned=np.array([-1], dtype=np.int64),
        )

    def _of_ankle(
        self, terms: RobotTerms, reference: WbcReference, k: int, linear: tuple[float, ...], ankle: Array
    ) -> tuple[float, ...]:
        """The linear target of the sole's centre made that of the ankle, in the sole's frame [m/s^2]."""
        stiffness, damping = self._gains
        R, spin, bias = terms.contact_rotation[k], terms.sole_velocity[k, 3:], terms.sole_bias[k, 3:]
        there, turning = reference.swing_rotation @ ankle, reference.swing_angular_velocity
        wanted = stiffness * (there - R @ ankle) + damping * cross(turning, there)
        wanted += cross(reference.swing_angular_acceleration, there) + cross(turning, cross(turning, there))
        moved = cross(damping * spin + bias, ankle) + cross(spin, cross(spin, ankle))
        return tuple((np.array(linear) + wanted @ R - moved).tolist())

    def _linear(self, terms: RobotTerms, reference: WbcReference, k: int) -> Array:
        """Linear acceleration in the world, but for the damping of the sole's own velocity, shape (3,) [m/s^2]."""
        stiffness, damping = self._gains
        wanted: Array = reference.swing_position - terms.contact_position[k]
        if k == reference.rolling_foot:
            wanted += self._toe * reference.swing_rotation[:, 0]
        wanted *= stiffness
        wanted += damping * reference.swing_velocity
        wanted += reference.swing_acceleration
        return wanted
