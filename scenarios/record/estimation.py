"""Writes what an estimator makes of the sensors into the log: its estimate, how sure it is, and by what it is wrong."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from surefoot.native.library import Library
from surefoot.planner.geometry import yaw_rotations
from surefoot.readings import Readings
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.rows import RowLayout, Rows
from surefoot.scenarios.log.spec import ChannelSpec, FieldSpec
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.scenarios.record.readings import ReadingsRecorder
from surefoot.wbc.estimation.estimate import Deviation, Estimate
from surefoot.wbc.model import RobotTerms
from surefoot.wbc.types import Array

_THREE, _TWO = np.full(3, math.nan), np.full(2, math.nan)
_UNKNOWN = Deviation(_THREE, _THREE, _TWO, _TWO, math.nan, math.nan, math.nan)
"""Of an estimator that does not say how sure it is."""

_TOLD = ("base_pose", "wrench_left", "wrench_right")
_DEVIATIONS = ("com_deviation", "com_velocity_deviation", "tilt_deviation", "sole_height_deviation")
_SOLES = ("left_sole", "right_sole")
_LOAD = ("force_deviation", "moment_deviation")
_ERRORS = ("com_error", "com_velocity_error", "tilt_error", "sole_height_error", "yaw_error", "place_error")
_STATES = ("com", "com_velocity", "base_rotation", "true_com", "true_com_velocity", "true_base_rotation", "true_soles")
_MORE = dict(zip(_STATES, (3, 3, 9, 3, 3, 9, 14), strict=True))
"""What is not logged here, but needed for what is."""


class EstimationRecorder:
    """The channels of an estimator that senses, a row each per control tick: readings, estimate, what else it tells."""

    def __init__(self, writer: LogWriter, sizes: Sizes) -> None:
        """Open its channels."""
        self._readings = ReadingsRecorder(writer, sizes)
        channel = writer.channel(channels.estimation())
        vectors = ((channel, (*_TOLD, *_DEVIATIONS, *_SOLES)),)
        numbers = ((channel, ("contact", *_LOAD)),)
        derived = ((channel, _ERRORS),)
        self._row = writer.rows(
            RowLayout(vectors, numbers, derived, _errors, _MORE, ("stance",), _compiled, standing=True)
        )
        # Wrenches and deviations come in other arrays at each tick, and are copied into these.
        self._given = np.zeros((2, 6)), np.zeros(10)
        self._seen: tuple[RobotTerms | None, RobotTerms | None] = (None, None)
        self._writer = writer
        self._told: tuple[str, ...] | None = None

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
        sure, told = estimate.deviation or _UNKNOWN, estimate.contact or (False, False)
        felt, deviations = self._given
        felt[:] = wrench
        np.concatenate((sure.com, sure.com_velocity, sure.tilt, sure.sole_height), out=deviations)
        numbers = (*told, sure.force, sure.moment, forces.item(1) > forces.item(0))
        if self._seen == (terms, truth):
            self._row.again(time_ns, numbers)
        else:
            self._seen = terms, truth
            # Rotations lie in memory by columns.
            self._row.append(
                time_ns, numbers, terms.q[:7], felt, deviations, terms.sole_pose,
                terms.com, terms.com_velocity, terms.base_rotation.T,
                truth.com, truth.com_velocity, truth.base_rotation.T, truth.sole_pose,
            )  # fmt: skip
        if estimate.channels:
            self._tell(time_ns, estimate.channels)

    def _tell(self, time_ns: int, told: Mapping[str, Array]) -> None:
        """Log what else an estimator tells; what it tells at the first tick is what it tells."""
        if self._told is None:
            self._told = tuple(told)
            fields = tuple(FieldSpec(name, np.shape(value), "", "", "") for name, value in told.items())
            self._more = self._writer.channel(ChannelSpec("/estimator", "Estimator", fields, _OWN))
        self._more.append(time_ns, *[told[name] for name in self._told])


_OWN = "What else the estimator tells, by names of its own, every control tick."


def _errors(rows: Rows) -> dict[tuple[str, str], Array]:
    """By what the estimate is wrong where it counts: from the stance foot, with its heading turned to the true one.

    Where the robot is in the world and where it looks no sensor tells; that is in place_error and yaw_error.
    """
    topic = "/estimation"
    n, stance = len(rows["stance"]), rows["stance"][:, 0].astype(int)
    R, true = (np.swapaxes(rows[name].reshape(n, 3, 3), 1, 2) for name in ("base_rotation", "true_base_rotation"))
    soles = rows.span((topic, "left_sole"), (topic, "right_sole")).reshape(n, 2, 7)[:, :, :3]
    true_soles = rows["true_soles"].reshape(n, 2, 7)[:, :, :3]
    yaw = np.arctan2(R[:, 1, 0], R[:, 0, 0]) - np.arctan2(true[:, 1, 0], true[:, 0, 0])
    yaw = (yaw + math.pi) % (2.0 * math.pi) - math.pi
    back, each = yaw_rotations(-yaw), np.arange(n)
    com, true_com = rows["com"] - soles[each, stance], rows["true_com"] - true_soles[each, stance]
    velocity = (back @ rows["com_velocity"][..., None])[..., 0] - rows["true_com_velocity"]
    tilt = back @ R @ np.swapaxes(true, 1, 2)
    place = soles[each, stance] - true_soles[each, stance]
    return {
        (topic, "com_error"): (back @ com[..., None])[..., 0] - true_com,
        (topic, "com_velocity_error"): velocity,
        (topic, "tilt_error"): 0.5 * np.stack((tilt[:, 2, 1] - tilt[:, 1, 2], tilt[:, 0, 2] - tilt[:, 2, 0]), axis=1),
        (topic, "sole_height_error"): soles[..., 2] - true_soles[..., 2],
        (topic, "yaw_error"): yaw,
        (topic, "place_error"): place,
    }


def _compiled(kernels: Library, part: Callable[..., Array]) -> Callable[[], None]:
    """The kernel that does what `_errors` does."""
    topic = "/estimation"
    row = kernels.fill(
        "EstimationRow",
        **{name: part(name, name) for name in ("stance", *_STATES)},
        soles=part((topic, "left_sole"), (topic, "right_sole")),
        **{name: part((topic, name), (topic, name)) for name in _ERRORS},
    )
    return kernels.bind("estimation_row_derive", row)
