"""Writes what the sensors have said to an estimator into the log."""

import numpy as np

from surefoot.readings import Readings
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.log.layout import RowLayout
from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes

_IMU = ("angular_velocity", "mean_angular_velocity", "specific_force")
_VECTORS = ("joint_position", "joint_velocity", "joint_torque", *_IMU, "wrench_left", "wrench_right")
_NUMBERS = ("joint_age", "imu_age", "wrench_age", "joint_fresh", "imu_fresh", "wrench_fresh")


class ReadingsRecorder:
    """The channel of the readings, one message per control tick; only of a run whose estimator reads any."""

    def __init__(self, writer: LogWriter, sizes: Sizes) -> None:
        """Open the channel."""
        channel = writer.channel(channels.readings(sizes))
        self._row = writer.rows(RowLayout(((channel, _VECTORS),), ((channel, _NUMBERS),)))
        self._no_velocity, self._no_wrench = np.full(sizes.nj, np.nan), np.full(12, np.nan)

    def tick(self, time_ns: int, readings: Readings) -> None:
        """The readings of a control tick [ns]; what no sensor says is NaN."""
        joint, imu = readings.joint_position, readings.specific_force
        feet, speeds = readings.wrench, readings.joint_velocity
        if feet is None:
            age, fresh, wrench = np.nan, False, self._no_wrench
        else:
            age, fresh, wrench = feet.age, feet.fresh, feet.values.ravel()
        self._row.append(
            time_ns, (joint.age, imu.age, age, joint.fresh, imu.fresh, fresh),
            joint.values, self._no_velocity if speeds is None else speeds.values, readings.joint_torque.values,
            readings.angular_velocity.values, readings.mean_angular_velocity.values, imu.values, wrench,
        )  # fmt: skip
