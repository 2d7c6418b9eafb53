"""Sensors and motors of a scenario: what their keys mean, and which of them cannot act."""

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import Any

from surefoot.errors import ParameterError
from surefoot.scenarios.errors import Problem
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.file.sensing import SENSOR_KEYS, MotorSettings, Sensing
from surefoot.sim.drives import IDEAL, DriveErrors
from surefoot.sim.sensor_errors import PRESETS, Delivery, SensorErrors
from surefoot.similarity import Similarity

_GROUPS = {"joints": "encoder", "imu": "imu", "feet": "wrench"}
"""Prefixes of the keys of each group of sensors."""

_ZERO_MEANS_NOTHING = ("encoder_noise", "gyro_noise", "accelerometer_noise", "wrench_noise", "latency")
"""Keys that logs of earlier versions have at zero, since their defaults were written down."""

_FEET = tuple(name for name in SENSOR_KEYS if name.startswith(("wrench_", "moment_")))


@dataclass(frozen=True, slots=True)
class Hardware:
    """The errors of sensors and motors that no part of the controller knows.

    Attributes:
        sensors: what those that an estimator reads add to the truth.
        drives: what the motors do with what is commanded.
    """

    sensors: SensorErrors
    drives: DriveErrors

    @classmethod
    def of(cls, sensing: Sensing, motors: MotorSettings | None, size: Similarity) -> "Hardware":
        """The hardware by a scenario's keys, for a robot of a size."""
        drives = IDEAL
        if motors is not None:
            drives = DriveErrors(motors.delay or 0.0, motors.noise or 0.0, motors.torque_speed)
        return cls(sensor_errors(sensing, size), drives)


def sensor_errors(sensing: Sensing, size: Similarity) -> SensorErrors:
    """The errors that the sensors of an estimator add to the truth.

    Args:
        sensing: keys, which are meant as they are.
        size: of the robot, with which forces and moments of a preset go.
    """
    preset = size.scaled(PRESETS[sensing.preset or "perfect"])
    named = {entry.name for entry in fields(SensorErrors)}
    given = {name: getattr(sensing, name) for name in SENSOR_KEYS if name in named}
    changed: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    if sensing.wrench is not None:
        changed["wrench_sensors"] = sensing.wrench == "feet"
    for group, name in _GROUPS.items():
        changed[group] = _delivery(sensing, name, getattr(preset, group))
    return replace(preset, **changed)


def refuse_unread(sensing: Sensing) -> None:
    """Refuse single terms of sensors beside an estimator that is given the measurement and reads none.

    Raises:
        ParameterError: there is one.
    """
    for name, value in _given(sensing).items():
        what = f"sensing.{name} {value} beside an estimator that reads no sensor"
        raise ParameterError(("sensing", name), what, "let sensing.source name another, or leave it out")


def _given(sensing: Sensing) -> dict[str, Any]:
    """Single terms of sensors that a scenario has, but for zeros of earlier logs.

    Its preset says what sensors the robot has, which may stand there whoever reads them.
    """
    values = ((name, getattr(sensing, name)) for name in SENSOR_KEYS if name != "preset")
    return {
        name: value
        for name, value in values
        if value is not None and not (value == 0.0 and name in _ZERO_MEANS_NOTHING)
    }


def _delivery(sensing: Sensing, group: str, usual: Delivery) -> Delivery:
    """The delivery of a group's readings: by its own keys, else by those of all groups, else by the preset."""
    found = {}
    for name in ("latency", "jitter", "dropout"):
        own, common = getattr(sensing, f"{group}_{name}"), getattr(sensing, name)
        found[name] = own if own is not None else common if common is not None else getattr(usual, name)
    return Delivery(**found)


def hardware_problems(sensing: Sensing, motors: MotorSettings | None, physics_rate: int) -> Iterator[Problem]:
    """List keys of sensors and motors that cannot act.

    Args:
        sensing: its keys.
        motors: keys of its motors; None where none are given.
        physics_rate: steps of the world in a second [Hz].
    """
    given = _given(sensing)
    if sensing.source == DEFAULTS["sensing"]:
        for name, value in given.items():
            what = f"sensing.{name} {value} beside sensing.source {sensing.source}, which reads no sensor"
            yield Problem(("sensing", name), what, "name an estimator as sensing.source, or leave it out")
        given = {}
    if sensing.wrench == "none":
        for name in (name for name in _FEET if name in given):
            what = f"sensing.{name} of feet that have no force sensors"
            yield Problem(("sensing", name), what, "leave it out, or let sensing.wrench be feet")
    if "encoder_velocity_noise" in given and not sensor_errors(sensing, Similarity()).encoder_velocity:
        what = "sensing.encoder_velocity_noise of encoders that say no velocity"
        yield Problem(("sensing", "encoder_velocity_noise"), what, "let sensing.encoder_velocity be true")
    if motors is not None and motors.delay is not None and round(motors.delay * physics_rate) == 0:
        what = f"motors.delay {motors.delay} s is less than half a step of the physics"
        yield Problem(("motors", "delay"), what, f"use at least {1 / physics_rate:g} s, or leave it out")
