"""The errors that a robot's sensors add to the truth: terms of their noise models, and presets with their sources.

Noise is white, biases are drawn once and walk from there, as in the models that data sheets and other simulators use
(Kalibr's "IMU noise model"; the IMU plug-ins of Gazebo and RotorS). Each number is the standard deviation of what is
drawn, unless it says otherwise.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from surefoot.similarity import quantity


def _term(default: float, scales: str = "-") -> Any:
    """A number of a sensor; only what measures forces goes with the robot's size, since an IMU is one of any."""
    return quantity(default, scales)


SOON = 1e-9
"""Delay after a tick within which a reading is there at the tick, so that no shorter time is late [s]."""


@dataclass(frozen=True, slots=True)
class Delivery:
    """The delivery of the readings of one group of sensors to the controller.

    Attributes:
        latency: time from the instant of a sample until it arrives [s].
        jitter: longest time by which it comes later than that, drawn evenly [s].
        dropout: share of the samples that never come [-].
    """

    latency: float = 0.0
    jitter: float = 0.0
    dropout: float = 0.0


@dataclass(frozen=True, slots=True)
class SensorErrors:
    """All that sensors add; the default is perfect sensors.

    Forces and moments are those of a robot of the reference's size (see `surefoot.similarity`).

    Attributes:
        encoder_noise: of a joint angle [rad].
        encoder_bits: of a turn; 0 for angles that are not rounded.
        encoder_offset: of the zero of each encoder, constant in a run [rad].
        encoder_velocity: whether encoders say a velocity.
        encoder_velocity_noise: of that [rad/s].
        joint_torque_noise: of the measured torque of a motor [N·m].
        gyro_noise: of a reading [rad/s].
        gyro_density: of the mean over a time T times its root, in a data sheet the noise density [rad/s/√Hz].
        gyro_bias: at the start [rad/s].
        gyro_walk: that the bias gains in a second; it grows with the root of time [rad/s].
        gyro_range: largest reading of each axis [rad/s].
        accelerometer_noise: of a reading [m/s^2].
        accelerometer_density: as that of the gyro [m/s^2/√Hz].
        accelerometer_bias: at the start [m/s^2].
        accelerometer_walk: that the bias gains in a second; it grows with the root of time [m/s^2].
        accelerometer_range: largest reading of each axis [m/s^2].
        imu_misalignment: angle by which the IMU is turned about each of its axes from where it should be [rad].
        imu_displacement: by which it is away from there along each axis [m].
        wrench_sensors: whether the feet have force sensors.
        wrench_noise: of each force [N].
        wrench_bias: of each force at the start [N].
        wrench_drift: that this bias gains in a second; it grows with the root of time [N].
        moment_noise: of each moment [N·m].
        moment_bias: of each moment at the start [N·m].
        moment_drift: that this bias gains in a second; it grows with the root of time [N·m].
        joints: how encoders and joint torques come.
        imu: how gyro and accelerometer come.
        feet: how wrenches come.
    """

    encoder_noise: float = _term(0.0)
    encoder_bits: int = 0
    encoder_offset: float = _term(0.0)
    encoder_velocity: bool = True
    encoder_velocity_noise: float = _term(0.0)
    joint_torque_noise: float = _term(0.0, "N·m")
    gyro_noise: float = _term(0.0)
    gyro_density: float = _term(0.0)
    gyro_bias: float = _term(0.0)
    gyro_walk: float = _term(0.0)
    gyro_range: float = _term(math.inf)
    accelerometer_noise: float = _term(0.0)
    accelerometer_density: float = _term(0.0)
    accelerometer_bias: float = _term(0.0)
    accelerometer_walk: float = _term(0.0)
    accelerometer_range: float = _term(math.inf)
    imu_misalignment: float = _term(0.0)
    imu_displacement: float = _term(0.0)
    wrench_sensors: bool = True
    wrench_noise: float = _term(0.0, "N")
    wrench_bias: float = _term(0.0, "N")
    wrench_drift: float = _term(0.0, "N")
    moment_noise: float = _term(0.0, "N·m")
    moment_bias: float = _term(0.0, "N·m")
    moment_drift: float = _term(0.0, "N·m")
    joints: Delivery = Delivery()
    imu: Delivery = Delivery()
    feet: Delivery = Delivery()


PERFECT = SensorErrors()
"""The truth, of each instant, at once."""

_FULL_SCALE = math.radians(2000.0)
"""Full scale of the gyro of either IMU, as nearly all of their kind have it [rad/s]."""

_QUICK, _SLOW = Delivery(latency=0.002), Delivery(latency=0.005, dropout=0.02)

GOOD = SensorErrors(
    encoder_noise=1.06e-5,
    encoder_offset=5e-4,
    encoder_velocity=False,
    joint_torque_noise=0.5,
    gyro_density=1.7e-4,
    gyro_bias=1e-3,
    gyro_walk=1e-5,
    gyro_range=_FULL_SCALE,
    accelerometer_density=1.4e-3,
    accelerometer_bias=0.02,
    accelerometer_walk=1e-4,
    accelerometer_range=16 * 9.81,
    imu_misalignment=1e-3,
    imu_displacement=1e-3,
    wrench_noise=5.0,
    wrench_bias=5.0,
    wrench_drift=0.05,
    moment_noise=0.2,
    moment_bias=0.2,
    moment_drift=0.002,
    joints=_QUICK,
    imu=_QUICK,
    feet=_QUICK,
)
"""A well built robot of the class of TALOS: absolute encoders of 19 bits at the joints, calibrated to half a
milliradian. Their rounding is white in a noise of its size and so counts as a part of that. It has an industrial MEMS
IMU of 0.01 deg/s/√Hz and 0.14 mg/√Hz (the classes of Xsens' MTi-100 and of VectorNav's VN-100); six-axis force sensors
that say a share of a percent of their range."""

CHEAP = SensorErrors(
    encoder_noise=1e-4,
    encoder_bits=14,
    encoder_offset=2e-3,
    encoder_velocity=False,
    joint_torque_noise=2.0,
    gyro_density=2.6e-4,
    gyro_bias=1e-2,
    gyro_walk=1e-4,
    gyro_range=_FULL_SCALE,
    accelerometer_density=3e-3,
    accelerometer_bias=0.1,
    accelerometer_walk=1e-3,
    accelerometer_range=8 * 9.81,
    imu_misalignment=5e-3,
    imu_displacement=3e-3,
    wrench_noise=20.0,
    wrench_bias=20.0,
    wrench_drift=0.5,
    moment_noise=0.5,
    moment_bias=1.0,
    moment_drift=0.02,
    joints=_SLOW,
    imu=_SLOW,
    feet=_SLOW,
)
"""A robot of hobby parts: magnetic encoders of 14 bits behind the gears, calibrated by eye. It has a consumer MEMS IMU
of 0.015 deg/s/√Hz and 300 ug/√Hz (the classes of TDK's ICM-20948 and MPU-9250), with the accelerometer bias of 0.1
m/s^2 that the Gazebo models of Alexander and TALOS have; load cells; a bus that is late and loses packets.

Those two models have a rate noise of 2e-4 rad/s and an accelerometer noise of 1.7e-2 m/s^2 at 1 kHz. As densities, 6e-6
rad/s/√Hz and 5e-4 m/s^2/√Hz, that is less than either preset has."""

PRESETS: Mapping[str, SensorErrors] = {"perfect": PERFECT, "good": GOOD, "cheap": CHEAP}
"""Errors by the value of ``sensing.preset``."""
