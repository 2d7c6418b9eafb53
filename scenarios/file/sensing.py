"""The keys of sensors and motors: what is measured of the robot, and what its joints make of commanded torques.

Null is what ``sensing.preset`` has, or an ideal motor; what each term means is written once, in
`surefoot.sim.sensor_errors` and `surefoot.sim.drives`.
"""

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from surefoot.scenarios.file.group import WHOLE, Group, key
from surefoot.scenarios.file.names import OneOf
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.file.units import METRE, RADIAN, SECOND, Unit

_Size = Annotated[float, Field(ge=0, le=1e9)]
_Positive = Annotated[float, Field(gt=0, le=1e9)]
_Share = Annotated[float, Field(ge=0, lt=1)]
_Angle = Annotated[float, Field(ge=0, le=1), RADIAN]
_Rate = Annotated[_Size, Unit("rad/s")]
_Acceleration = Annotated[_Size, Unit("m/s^2")]
_Force = Annotated[_Size, Unit("N")]
_Moment = Annotated[_Size, Unit("N·m")]
_Late = Annotated[float, Field(ge=0, le=1), SECOND]
_Noise = Annotated[float, Field(ge=0, le=1e3), METRE]


OF_SENSORS = "ekf"
"""The estimator that reads the sensors of a preset where no other is named."""


class Sensing(Group):
    """The knowledge of the robot for planner and controller; noises, offsets, biases are standard deviations."""

    source: Annotated[str, OneOf("sensing", "source")] = key(
        DEFAULTS["sensing"],
        f"estimator of the state that controller and planner are given, {OF_SENSORS} where only preset is named",
    )
    options: dict[str, Any] | None = key(None, "given to that estimator by name, null: none")
    preset: Literal["perfect", "good", "cheap"] | None = key(
        None, "sensors that the estimator reads, each of whose terms another key may replace, null: perfect"
    )
    zmp_noise: _Noise = key(0.0, "of the ZMP that the planner measures")
    com_noise: _Noise = key(0.0, "of the CoM that the planner measures; of its velocity 5 / s times as much")
    encoder_noise: Annotated[_Size, RADIAN] | None = key(None, "of the joint encoders, null: the preset's")
    encoder_bits: Annotated[int, Field(ge=0, le=32), WHOLE] | None = key(
        None, "bits by which an encoder tells places of a turn apart, 0: any angle, null: the preset's [-]"
    )
    encoder_offset: _Angle | None = key(None, "of each encoder's zero, constant in a run, null: the preset's")
    encoder_velocity: bool | None = key(None, "encoders say joint velocities, null: only perfect ones do")
    encoder_velocity_noise: _Rate | None = key(None, "of these velocities, null: the preset's")
    joint_torque_noise: _Moment | None = key(None, "of the measured torques of the motors, null: the preset's")
    gyro_noise: Annotated[_Size, Unit("rad/s")] | None = key(None, "of the gyroscope, null: the preset's")
    gyro_density: Annotated[_Size, Unit("rad/s/√Hz")] | None = key(None, "noise density of it, null: the preset's")
    gyro_bias: _Rate | None = key(None, "of its bias at the start, null: the preset's")
    gyro_walk: _Rate | None = key(
        None, "that its bias gains in a second, with the root of the time, null: the preset's"
    )
    gyro_range: Annotated[_Positive, Unit("rad/s")] | None = key(None, "its largest reading, null: the preset's")
    accelerometer_noise: _Acceleration | None = key(None, "of the accelerometer, null: the preset's")
    accelerometer_density: Annotated[_Size, Unit("m/s^2/√Hz")] | None = key(
        None, "noise density of it, null: the preset's"
    )
    accelerometer_bias: _Acceleration | None = key(None, "of its bias at the start, null: the preset's")
    accelerometer_walk: _Acceleration | None = key(
        None, "that its bias gains in a second, with the root of the time, null: the preset's"
    )
    accelerometer_range: Annotated[_Positive, Unit("m/s^2")] | None = key(
        None, "its largest reading, null: the preset's"
    )
    imu_misalignment: _Angle | None = key(
        None, "by which the IMU is turned about each axis from where it should be, null: the preset's"
    )
    imu_displacement: Annotated[float, Field(ge=0, le=1), METRE] | None = key(
        None, "by which it is away from there along each axis, null: the preset's"
    )
    wrench: Literal["feet", "none"] | None = key(None, "where force sensors are, null: in the feet")
    wrench_noise: _Force | None = key(None, "of the forces that the feet measure, null: the preset's")
    wrench_bias: _Force | None = key(None, "of their bias at the start, null: the preset's")
    wrench_drift: _Force | None = key(
        None, "that their bias gains in a second, with the root of the time, null: the preset's"
    )
    moment_noise: _Moment | None = key(None, "of the moments that the feet measure, null: the preset's")
    moment_bias: _Moment | None = key(None, "of their bias at the start, null: the preset's")
    moment_drift: _Moment | None = key(
        None, "that their bias gains in a second, with the root of the time, null: the preset's"
    )
    latency: Annotated[float, Field(ge=0, le=86_400.0), SECOND] | None = key(
        None, "time until a sample arrives, null: the preset's"
    )
    jitter: _Late | None = key(None, "longest time by which it comes later still, null: the preset's")
    dropout: _Share | None = key(None, "share of the samples that never come, null: the preset's [-]")
    encoder_latency: _Late | None = key(None, "latency of encoders and joint torques, null: latency")
    encoder_jitter: _Late | None = key(None, "their jitter, null: jitter")
    encoder_dropout: _Share | None = key(None, "their dropout, null: dropout [-]")
    imu_latency: _Late | None = key(None, "latency of gyroscope and accelerometer, null: latency")
    imu_jitter: _Late | None = key(None, "their jitter, null: jitter")
    imu_dropout: _Share | None = key(None, "their dropout, null: dropout [-]")
    wrench_latency: _Late | None = key(None, "latency of the wrenches, null: latency")
    wrench_jitter: _Late | None = key(None, "their jitter, null: jitter")
    wrench_dropout: _Share | None = key(None, "their dropout, null: dropout [-]")
    force_estimate: bool = key(
        True, "a lasting external force and the true weight are estimated from what the feet feel, and counted with"
    )

    @model_validator(mode="before")
    @classmethod
    def _sensors_are_read(cls, keys: Any) -> Any:
        """Take the estimate of the sensors as the source if sensors are named, unless the source is given."""
        if isinstance(keys, dict) and keys.get("preset") is not None and "source" not in keys:
            return {**keys, "source": OF_SENSORS}
        return keys


OF_THE_PLANNER = ("source", "options", "zmp_noise", "com_noise", "force_estimate")
"""Keys of `sensing` that are of no sensor."""

SENSOR_KEYS = tuple(name for name in Sensing.model_fields if name not in OF_THE_PLANNER)
"""Keys of what the sensors of an estimator add to the truth."""


SENSOR_SIZES = tuple(
    name for name in SENSOR_KEYS if name not in ("preset", "wrench", "encoder_velocity", "encoder_bits")
)
"""Keys that are a size."""

MOTOR_SIZES = ("damping", "friction_loss", "delay", "noise")
"""Keys of `motors` that are one."""


class MotorSettings(Group):
    """The errors of the motors that planner and controller do not know of."""

    damping: Annotated[_Positive, Unit("N·m·s/rad")] | None = key(None, "viscous friction of every joint, null: none")
    friction_loss: Annotated[_Positive, Unit("N·m")] | None = key(None, "dry friction of every joint, null: none")
    delay: Annotated[float, Field(gt=0, le=1), SECOND] | None = key(
        None, "time from the command of a torque until the motor gives it, null: none"
    )
    noise: Annotated[_Positive, Unit("N·m")] | None = key(
        None, "standard deviation of each torque, drawn anew each tick, null: none"
    )
    torque_speed: Annotated[float, Field(ge=0, lt=1)] | None = key(
        None,
        "share of its no-load speed up to which a motor gives its peak torque, falling to none at that speed, null: it "
        "gives it at every speed [-]",
    )
