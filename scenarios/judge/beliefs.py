"""The departures of a run from what planner and controller believe, by the keys of its scenario.

A departure is as large as 1 when walks bear it, and no more than that was tried or survived: README.md tells so of
masses and CoM, docs/serve.md of late commands. Of gains it is a factor, and of sensors what an estimate makes of them.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from surefoot.scenarios.file.group import controller_parameters
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.sim.sensor_errors import PRESETS
from surefoot.similarity import Similarity
from surefoot.wbc.parameters import STRAIGHTENED

SAME_FRICTION = 0.02
"""Difference of friction coefficients that is none [-]."""

MASS = 0.25
"""Share by which a mass may be off [-]."""

COM_HEIGHT, TORSO_COM = 0.1, 0.05
"""Heights by which the CoM may be believed too high, and that of the torso anywhere [m]."""

DELAY, HELD = 0.01, 0.02
"""Longest delay of commands, and longest time for which one may be held [s]."""

FACTOR = 8.0
"""Factor of a gain; the drives of the G1 tour are damped seven times as much as usual [-]."""

MOTOR = 0.1
"""Torque of what motors add, at a joint speed of 1 rad/s, over the largest one of the joint in the middle [-]."""

PLANNER_NOISE = 0.01
"""Noise of the CoM that the planner may measure [m]."""

SERVO = {"stiffness": 1.0, "damping": 0.01}
"""Gains of drives over the largest torque of their joint, where nothing else is said [1/rad, s/rad]."""


@dataclass(frozen=True, slots=True)
class Departure:
    """Something that is not as it is believed, or not as it usually is, all the time.

    Attributes:
        kind: mass, gains, late_commands, motors or sensors.
        what: in words.
        size: over what walks bear [-].
    """

    kind: str
    what: str
    size: float


@dataclass(frozen=True, slots=True)
class Beliefs:
    """The departures from what is believed.

    Attributes:
        friction: coefficient of every surface, and the one that the controller counts on [-].
        slippery: coefficients of boxes that nobody counts with, by the key that has put them there [-].
        departures: that last, the largest first.
        sensors: terms of sensors that are poorer than those of their preset, in words.
    """

    friction: tuple[float, float]
    slippery: dict[str, float]
    departures: tuple[Departure, ...]
    sensors: tuple[str, ...]

    @property
    def less_friction(self) -> bool:
        """True if some ground has less friction than the controller counts on."""
        true, believed = self.friction
        return min((true, *self.slippery.values())) < believed - SAME_FRICTION


def beliefs(run: RunView) -> Beliefs:
    """Find the departures from what is believed in a run.

    Raises:
        LogError: its log holds no scenario that can be read.
    """
    return run.once(_beliefs)


def _beliefs(run: RunView) -> Beliefs:
    scenario = scenario_of(run.log)
    ground, wbc = scenario.errors.ground or (), scenario.wbc
    believed = scenario.terrain.friction + scenario.errors.friction
    if wbc is not None and wbc.friction is not None:
        believed = wbc.friction
    boxes = {f"errors.ground.{index}": box.friction for index, box in enumerate(ground)}
    found = (*_masses(scenario, run), *_gains(scenario, run), *_late(scenario, run), *_motors(scenario, run))
    return Beliefs(
        (scenario.terrain.friction, believed),
        {key: friction for key, friction in boxes.items() if friction is not None},
        tuple(sorted(found, key=lambda one: -one.size)),
        tuple(_poorer(scenario, run.constants.similarity)),
    )


def _masses(scenario: Scenario, run: RunView) -> Iterator[Departure]:
    errors, constants = scenario.errors, run.constants
    length = constants.similarity.length
    if errors.mass_scale != 1.0:
        what = f"{errors.mass_scale:g} times its mass is believed (errors.mass_scale)"
        yield Departure("mass", what, abs(errors.mass_scale - 1.0) / MASS)
    if errors.payload is not None and errors.payload.mass:
        share = errors.payload.mass / max(constants.mass - errors.payload.mass, 1e-9)
        what = f"it carries {errors.payload.mass:g} kg that nobody counts with, {100 * share:.0f} % of its own mass"
        yield Departure("mass", f"{what} (errors.payload)", share / MASS)
    if errors.torso_mass is not None:
        what = f"{errors.torso_mass:g} times the mass of its torso is believed (errors.torso_mass)"
        yield Departure("mass", what, abs(errors.torso_mass - 1.0) / MASS)
    if errors.link_mass_noise:
        what = f"masses of links are off by up to {100 * errors.link_mass_noise:g} % (errors.link_mass_noise)"
        yield Departure("mass", what, errors.link_mass_noise / MASS)
    if errors.com_height:
        what = f"its CoM is believed {errors.com_height:g} m too high (errors.com_height)"
        yield Departure("mass", what, abs(errors.com_height) / (COM_HEIGHT * length))
    if errors.torso_com is not None and any(errors.torso_com):
        off = math.hypot(*errors.torso_com)
        what = f"the CoM of its torso is believed {off:g} m beside its place (errors.torso_com)"
        yield Departure("mass", what, off / (TORSO_COM * length))


def _gains(scenario: Scenario, run: RunView) -> Iterator[Departure]:
    size, control = run.constants.similarity, scenario.control
    if scenario.wbc is not None:
        usual, given = controller_parameters(None, size), controller_parameters(scenario.wbc, size)
        if scenario.straightens:
            usual = replace(usual, knees=size.scaled(STRAIGHTENED))
        yield from _changed(usual, given, "wbc")
    if control is None or control.output != "position":
        return
    for name, default in SERVO.items():
        usual_value = size.times(default, "1/rad" if name == "stiffness" else "s/rad")
        value = getattr(control, name)
        if value is not None:
            yield _gain(f"control.{name}", usual_value, value)
        for pattern, gains in (control.gains or {}).items():
            value = gains[0 if name == "stiffness" else 1]
            limits = [
                limit
                for joint, limit in zip(run.constants.joint_names, run.constants.torque_limit, strict=True)
                if re.fullmatch(pattern, joint)
            ]
            found = [_gain(f"control.gains {pattern}, {name}", usual_value * limit, value) for limit in limits]
            yield from sorted(found, key=lambda one: -one.size)[:1]


def _changed(usual: Any, given: Any, path: str) -> Iterator[Departure]:
    """Gains of a group that are others than usual."""
    for entry in fields(given):
        before, now, name = getattr(usual, entry.name), getattr(given, entry.name), f"{path}.{entry.name}"
        if is_dataclass(now) and entry.name != "size":
            yield from _changed(before, now, name)
        elif now != before and "unit" in entry.metadata:
            pairs = zip(before, now, strict=True) if isinstance(now, tuple) else ((before, now),)
            yield max((_gain(name, *pair) for pair in pairs), key=lambda one: one.size)


def _gain(name: str, usual: float, value: float) -> Departure:
    least = 1e-9 * max(usual, value, 1e-9)
    size = abs(math.log(max(value, least) / max(usual, least))) / math.log(FACTOR)
    return Departure("gains", f"{name} is {value:.4g}, and {usual:.4g} by default", size)


def _late(scenario: Scenario, run: RunView) -> Iterator[Departure]:
    time, motors, control = run.constants.similarity.time, scenario.motors, scenario.control
    if motors is not None and motors.delay:
        what = f"motors follow {1e3 * motors.delay:g} ms after their commands (motors.delay)"
        yield Departure("late_commands", what, motors.delay / (DELAY * time))
    if control is not None and control.output_rate and control.output_rate < run.constants.control_rate:
        held = 1.0 / control.output_rate
        what = f"each command is held for {1e3 * held:.3g} ms (control.output_rate)"
        yield Departure("late_commands", what, held / (HELD * time))
    if run.has("/link"):
        age = run.log["/link"].field("command_age")
        age = age[np.isfinite(age)]
        worst = float(np.percentile(age, 99.0)) if len(age) else 0.0
        what = f"commands answer states that are {1e3 * worst:.3g} ms old (/link.command_age, 99th percentile)"
        yield Departure("late_commands", what, worst / (DELAY * time))


def _motors(scenario: Scenario, run: RunView) -> Iterator[Departure]:
    motors = scenario.motors
    if motors is None or not run.constants.torque_limit:
        return
    middle = float(np.median(run.constants.torque_limit))
    for name in ("damping", "friction_loss", "noise"):
        value = getattr(motors, name)
        if value:
            what = f"motors.{name} is {value:g}, where the joint in the middle gives {middle:.3g} N·m"
            yield Departure("motors", what, value / (MOTOR * middle))
    if motors.torque_speed is not None:
        what = f"motors give their peak torque up to {motors.torque_speed:g} of their no-load speed alone"
        yield Departure("motors", f"{what} (motors.torque_speed)", 0.5 / max(motors.torque_speed, 1e-3))


_LESS_IS_POORER = ("gyro_range", "accelerometer_range", "encoder_bits")
_DELIVERED = {"encoder": "joints", "imu": "imu", "wrench": "feet"}


def _poorer(scenario: Scenario, size: Similarity) -> Iterator[str]:
    """Terms of sensors that are poorer than their preset has them, or than good ones where none is named."""
    sensing = scenario.sensing
    preset = sensing.preset or "good"
    usual = size.scaled(PRESETS[preset])
    for name in (entry.name for entry in fields(usual)):
        value, usually = getattr(sensing, name, None), getattr(usual, name)
        if isinstance(value, bool) or not isinstance(value, int | float):
            continue
        if name == "encoder_bits":  # 0 tells any angle
            value, usually = value or math.inf, usually or math.inf
        if value < usually if name in _LESS_IS_POORER else value > usually:
            yield f"sensing.{name} is {value:g}, where the preset {preset} has {usually:g}"
    for name in ("latency", "jitter", "dropout"):
        for group, place in (("", "imu"), *((f"{group}_", place) for group, place in _DELIVERED.items())):
            value, usually = getattr(sensing, f"{group}{name}"), getattr(getattr(usual, place), name)
            if value is not None and value > usually:
                yield f"sensing.{group}{name} is {value:g}, where the preset {preset} has {usually:g}"
    for name in ("com_noise", "zmp_noise"):
        value = getattr(sensing, name)
        if value > PLANNER_NOISE * 0.5:
            yield f"sensing.{name} is {value:g} m"
