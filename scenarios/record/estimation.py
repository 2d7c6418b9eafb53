"""Writes what an estimator makes of the sensors into the log: its estimate, how sure it is, and by what it is wrong."""

import math
from collections.abc import Mapping

import numpy as np

from surefoot.maths import algebra
from surefoot.readings import Readings
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.layout import RowLayout, Table
from surefoot.scenarios.log.spec import ChannelSpec, FieldSpec
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.readings import ReadingsRecorder
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.estimation.estimate import Deviation, Estimate
from surefoot.wbc.types import Array

_THREE, _TWO = np.full(3, np.nan), np.full(2, np.nan)
_UNKNOWN = Deviation(_THREE, _THREE, _TWO, _TWO, np.nan, np.nan, np.nan)
"""Deviation of an estimator that gives none."""

PI = math.pi

_TOPIC = "/estimation"
_VECTORS = (
    "wrench_left", "wrench_right", "com_deviation", "com_velocity_deviation", "tilt_deviation",
    "sole_height_deviation", "left_sole", "right_sole",
)  # fmt: skip
_DERIVED = (
    "base_pose", "com_error", "com_velocity_error", "tilt_error", "sole_height_error", "yaw_error", "place_error",
)  # fmt: skip


class EstimationRecorder:
    """The channels of an estimator that senses, a row each per control tick: readings, estimate, what else it tells.

    Args:
        writer: of the log.
        sizes: of the channels.
    """

    def __init__(self, writer: LogWriter, sizes: Sizes) -> None:
        self._readings = ReadingsRecorder(writer, sizes)
        channel = writer.channel(channels.estimation())
        vectors, derived = ((channel, _VECTORS),), ((channel, _DERIVED),)
        numbers = ((channel, ("contact", "force_deviation", "moment_deviation")),)
        # What is not logged here, but needed for what is.
        more = {
            "q": sizes.nq, "com": 3, "com_velocity": 3, "true_com": 3, "true_com_velocity": 3, "true_soles": 14,
            "base_rotation": 9, "true_base_rotation": 9,
        }  # fmt: skip
        self._row = writer.rows(RowLayout(vectors, numbers, derived, EstimationRows, more, ("stance",)))
        # Wrenches and deviations come in other arrays at each tick, and rotations by columns: they are copied here.
        self._wrench, self._deviations, self._rotations = np.zeros((2, 6)), np.zeros(10), np.zeros((2, 3, 3))
        self._writer = writer
        self._extra: tuple[str, ...] | None = None

    def tick(
        self, time_ns: int, readings: Readings, estimate: Estimate, wrench: Array, terms: RobotTerms,
        truth: RobotTerms, forces: Array,
    ) -> None:  # fmt: skip
        """A control tick.

        Args:
            time_ns: simulated time [ns].
            readings: that the estimator was given.
            estimate: of the estimator.
            wrench: of the soles, that controller and planner were given, shape (2, 6) [N, N·m].
            terms: of the robot model in the estimated state.
            truth: of the true robot in its true state.
            forces: true normal forces on the soles, shape (2,) [N].
        """
        self._readings.tick(time_ns, readings)
        sure, contact = estimate.deviation or _UNKNOWN, estimate.contact or (False, False)
        self._wrench[...] = wrench
        own = self._deviations
        own[0:3] = sure.com
        own[3:6] = sure.com_velocity
        own[6:8] = sure.tilt
        own[8:10] = sure.sole_height
        self._rotations[0], self._rotations[1] = terms.base_rotation, truth.base_rotation
        numbers = (*contact, sure.force, sure.moment, forces.item(1) > forces.item(0))
        self._row.append(
            time_ns, numbers, self._wrench, self._deviations, terms.sole_pose, terms.q, terms.com, terms.com_velocity,
            truth.com, truth.com_velocity, truth.sole_pose, self._rotations,
        )  # fmt: skip
        if estimate.channels:
            self._tell(time_ns, estimate.channels)

    def _tell(self, time_ns: int, extra: Mapping[str, Array]) -> None:
        """Log what else an estimator tells; what it tells at the first tick is what it tells."""
        if self._extra is None:
            self._extra = tuple(extra)
            fields = tuple([FieldSpec(name, np.shape(value), "", "", "") for name, value in extra.items()])
            self._more = self._writer.channel(ChannelSpec("/estimator", "Estimator", fields, _OWN))
        self._more.append(time_ns, *[extra[name] for name in self._extra])


_OWN = "What else the estimator tells, by names of its own, every control tick."


class EstimationRows:
    """The error of the estimate where it counts: from the stance foot, with its heading turned to the true one.

    Where the robot is in the world and where it looks no sensor tells; that is in place_error and yaw_error.

    Args:
        table: of the rows.
    """

    def __init__(self, table: Table) -> None:
        count = len(table.values)
        self._stance, self._q, self._base_pose = table["stance"], table["q"], table[_TOPIC, "base_pose"]
        self._com, self._com_velocity = table["com"], table["com_velocity"]
        self._true_com, self._true_com_velocity = table["true_com"], table["true_com_velocity"]
        self._soles = table.span((_TOPIC, "left_sole"), (_TOPIC, "right_sole"))
        self._true_soles = table["true_soles"]
        self._base = table["base_rotation"].reshape(count, 3, 3)
        self._true_base = table["true_base_rotation"].reshape(count, 3, 3)
        self._com_error, self._com_velocity_error = table[_TOPIC, "com_error"], table[_TOPIC, "com_velocity_error"]
        self._tilt_error, self._yaw_error = table[_TOPIC, "tilt_error"], table[_TOPIC, "yaw_error"]
        self._sole_height_error = table[_TOPIC, "sole_height_error"]
        self._place_error = table[_TOPIC, "place_error"]
        self._back, self._turned = np.zeros((3, 3)), np.zeros((3, 3))

    def derive(self, rows: int) -> None:
        """See `Derived`."""
        for n in range(rows):
            for k in range(7):
                self._base_pose[n, k] = self._q[n, k]
            self._turn_back(n)
            self._err(n, 1 if self._stance[n, 0] > 0.0 else 0)
            for foot in range(2):
                self._sole_height_error[n, foot] = self._soles[n, 7 * foot + 2] - self._true_soles[n, 7 * foot + 2]

    def _turn_back(self, n: int) -> None:
        """Errors of heading and tilt; `_back` is then the rotation about the vertical to the true heading."""
        R, true = self._base[n], self._true_base[n]
        yaw = _within_half_turn(math.atan2(R[1, 0], R[0, 0]) - math.atan2(true[1, 0], true[0, 0]))
        c, s = math.cos(yaw), -math.sin(yaw)
        algebra.put_row(self._back, 0, (c, -s, 0.0))
        algebra.put_row(self._back, 1, (s, c, 0.0))
        algebra.put_row(self._back, 2, (0.0, 0.0, 1.0))
        algebra.compose(self._back, R, self._turned)
        self._yaw_error[n, 0] = yaw
        T = self._turned
        self._tilt_error[n, 0] = 0.5 * (_rows_product(T, 2, true, 1) - _rows_product(T, 1, true, 2))
        self._tilt_error[n, 1] = 0.5 * (_rows_product(T, 0, true, 2) - _rows_product(T, 2, true, 0))

    def _err(self, n: int, stance: int) -> None:
        """Errors of the CoM's place and velocity from a foot, and of that foot's place."""
        sole, true_sole = algebra.row(self._soles, n, 7 * stance), algebra.row(self._true_soles, n, 7 * stance)
        com = algebra.rotate(self._back, algebra.subtract(algebra.row(self._com, n), sole))
        true_com = algebra.subtract(algebra.row(self._true_com, n), true_sole)
        velocity = algebra.rotate(self._back, algebra.row(self._com_velocity, n))
        true_velocity = algebra.row(self._true_com_velocity, n)
        algebra.put_row(self._com_error, n, algebra.subtract(com, true_com))
        algebra.put_row(self._com_velocity_error, n, algebra.subtract(velocity, true_velocity))
        algebra.put_row(self._place_error, n, algebra.subtract(sole, true_sole))


def _rows_product(A: Array, i: int, B: Array, j: int) -> float:
    """Entry of A B'."""
    return algebra.inner(algebra.row(A, i), algebra.row(B, j))


def _within_half_turn(angle: float) -> float:
    """The same angle from -pi to pi [rad]."""
    off = math.fmod(angle + PI, 2.0 * PI)
    return (off + 2.0 * PI if off < 0.0 else off) - PI
