"""The estimator of a scenario's sensors, and what it counts on of them; a run with the truth imports none of it."""

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pinocchio as pin

from surefoot.errors import ParameterError
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.types import RobotDescription
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.sensor_errors import SensorErrors
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.footing import Footing, ImuMount
from surefoot.wbc.estimation.parameters import ContactDetection, EstimatorParameters, GroundNoise, SensorNoise
from surefoot.wbc.types import Array

_OPTIONS = ("sensing", "options")


def sensed_state(walk: Walk, **options: Any) -> SensedState:
    """An invariant Kalman filter of IMU, encoders and feet.

    It knows of a walk's sensors no more than their data sheets say.

    Args:
        walk: what is run.
        options: fields of `EstimatorParameters`, groups as mappings.

    Raises:
        ParameterError: there is no such option, or its value is out of range.
    """
    robot, ground, size = walk.robot, walk.ground, walk.size
    period, stance = 1.0 / walk.rates.control, ground.stance
    usual = EstimatorParameters(
        sensor_noise(walk.hardware.sensors, period), size.scaled(GroundNoise()), size.scaled(ContactDetection())
    )

    def height(x: float, y: float) -> float:
        return float(ground.terrain.height(x, y))

    def normal(x: float, y: float) -> Array:
        return np.asarray(ground.terrain.normal(x, y))

    # On a line the CoP is where the line is.
    leaning = 0.5 * robot.sole_width if robot.roles.feet_lean else None
    half_size = 0.5 * robot.sole_length, math.inf if leaning is not None else 0.5 * robot.sole_width
    footing = Footing(stance.position.copy(), np.array(stance.yaw), half_size, height, normal, leaning)
    parameters = _with(usual, options, _OPTIONS)
    return SensedState(pinocchio_model(robot), robot.sole_sites, imu_mount(robot), footing, period, parameters)


def imu_mount(robot: RobotDescription) -> ImuMount:
    """The place of a robot's IMU, in the estimator's terms."""
    place = robot.imu
    turned = pin.Quaternion(*place.quaternion).matrix()
    return ImuMount(place.body, place.position, tuple(map(tuple, turned.tolist())))


def sensor_noise(errors: SensorErrors, period: float) -> SensorNoise:
    """The noise that an estimator counts on for sensors with these errors.

    Args:
        errors: of the sensors.
        period: control period [s].
    """
    rounding = math.tau / 2**errors.encoder_bits / math.sqrt(12.0) if errors.encoder_bits else 0.0
    root = math.sqrt(period)
    return SensorNoise(
        gyro_density=math.hypot(errors.gyro_density, errors.gyro_noise * root),
        gyro_bias=errors.gyro_bias,
        gyro_walk=errors.gyro_walk,
        accelerometer_density=math.hypot(errors.accelerometer_density, errors.accelerometer_noise * root),
        accelerometer_bias=errors.accelerometer_bias,
        accelerometer_walk=errors.accelerometer_walk,
        mounting=errors.imu_misalignment,
        encoder=math.hypot(errors.encoder_noise, rounding),
        encoder_offset=errors.encoder_offset,
        joint_torque=errors.joint_torque_noise,
        wrench_force=errors.wrench_noise,
        wrench_moment=errors.moment_noise,
        wrench_bias=errors.wrench_bias,
    )


def _with(parameters: Any, options: Mapping[str, Any], key: tuple[str, ...]) -> Any:
    """A dataclass with some of its fields replaced, those that are groups by mappings of theirs."""
    named = {entry.name: getattr(parameters, entry.name) for entry in fields(parameters)}
    changed = {}
    for name, value in options.items():
        at = (*key, name)
        if name not in named:
            raise ParameterError(at, f"unknown option '{name}'", f"choose from {', '.join(named)}")
        group = named[name]
        if is_dataclass(group) and not isinstance(value, Mapping):
            raise ParameterError(at, f"{name} is {value!r}", "give its numbers by name")
        changed[name] = _with(group, value, at) if is_dataclass(group) else value
    try:
        return replace(parameters, **changed)
    except ParameterError as error:
        raise ParameterError((*key, error.key[-1]), error.what, error.right) from None
