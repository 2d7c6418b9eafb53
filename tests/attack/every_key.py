"""Scenarios that give every key of the schema a value which is not its default."""

from collections.abc import Iterator
from inspect import isclass
from typing import Any, get_args, get_origin

import yaml
from pydantic import BaseModel

from surefoot.planner.laws.names import PROFILES
from surefoot.planner.parameters import RecoveryParameters
from surefoot.scenarios.file.group import Group, controller_parameters
from surefoot.scenarios.file.schema import InstrumentSettings, PlannerSettings, Scenario, own_keys, own_models
from surefoot.scenarios.file.sensing import SENSOR_KEYS

NOT_YET = {
    "sensing.options",
    "plant.options",
    *(f"controller.{of}" for of in ("policy", "name", "options", "digest", "left_out")),
    "control.gains",
    *(f"control.driven_{of}" for of in ("joints", "motion", "told")),
}
"""Keys whose values are what a part takes, or are by names of joints; or that name a file of a policy."""

_SENSORS = {"preset": "cheap", "wrench": "feet", "encoder_velocity": True, "encoder_bits": 16, "latency": 0.002}
SENSORS = {name: _SENSORS.get(name, 10.0 if name.endswith("_range") else 1e-3) for name in SENSOR_KEYS}
"""Every key of the sensors."""

TEXTS = {
    "options": """
        robot: humanoid100
        sized_for: humanoid100
        requirements: [REQ-7]
        seed: 3
        duration: 0.06
        robot_options: {foot_length: 0.16, foot_width: 0.08, payload_mass: 2, payload_body: torso}
        start: {x: 0.1, y: -0.1, yaw: 0.2, position_noise: 0.001, angle_noise: 0.001}
        rates: {physics: 2000, control: 1000, planner: 100}
        planner: {sample_time: 0.01}
        criteria: {fell: false, steps_taken: {max: 5}}
        """,
    "steps": """
        duration: 0.06
        gait: {steps: 4, step_length: 0.15, step_width: 0.21, lateral_step: 0.01, turn: 0.02, single_support: 0.8,
               double_support: 0.2, swing_height: 0.04, com_height: 0.98, initial_stand: 0.5, apex_single: 0.01,
               apex_double: 0.001, heel_off: 0.1,
               heel_strike: 0.1, pelvis_yaw: 0.05, pelvis_list: 0.02, ramp: 1}
        planner: {profile: repaired, horizon: 60, control_horizon: 3, jerk_limit: 20, jerk_rate_limit: 10,
                  jerk_weight: 1.0e-5, step_adaptation: none, knee: bent, rise: double, filter: kalman}
        sensing: {source: truth, zmp_noise: 0.001, com_noise: 0.001, force_estimate: false}
        """,
    "speed": """
        duration: 0.06
        robot_options: {foot_length: 0.22, foot_width: 0.11}
        gait: {steps: 4, speed: 0.4, pelvis_yaw: 0.06, pelvis_list: 0.03}
        """,
    "velocity": """
        duration: 0.06
        gait: {velocity: [{time: 0, v_x: 0.1, v_y: 0.02, yaw_rate: 0.05}, {time: 6}]}
        planner: {terminal_weight: 30, step_weight: 20}
        """,
    "footsteps": """
        duration: 0.06
        gait: {footsteps: [{foot: right, x: 0.1, y: -0.1, yaw: 0.05}, {foot: left, x: 0.1, y: 0.1, yaw: 0.05}]}
        """,
    "waypoints": """
        duration: 0.06
        gait: {waypoints: [{x: 0.4, y: 0.1, yaw: 0.3}]}
        """,
    "stairs": """
        duration: 0.06
        terrain: {kind: stairs, riser: 0.05, tread: 0.32, count: 3, direction: up_down, start: 0.18, landing: 1,
                  height_noise: 0.002, friction: 0.9}
        gait: {steps: 12, step_length: 0.32}
        """,
    "slope": """
        duration: 0.06
        terrain: {kind: slope, angle: 0.05}
        """,
    "errors": """
        duration: 0.06
        errors: {com_height: 0.01, mass_scale: 1.02, link_mass_noise: 0.02, torso_com: [0.01, 0, 0],
                 payload: {mass: 1, body: torso}, friction: 0.1, ground_noise: 0.005, torso_mass: 1.02,
                 ground: [{x: 0.6, y: 0.05, length: 0.2, width: 1, height: 0.01, friction: 0.5}]}
        motors: {damping: 0.5, friction_loss: 0.2, delay: 0.002, noise: 0.1, torque_speed: 0.6}
        plant: {name: mujoco}
        instruments: [{name: altimeter, label: high, period: 0.004,
                       faults: [{kind: jump, time: 0.02, duration: 0.02, size: 0.1}]}]
        control: {output: position, output_rate: 100, stiffness: 1.2, damping: 0.012, feed_forward: false,
                  give_way: false}
        pushes: [{time: 0.02, duration: 0.02, force: [10, 0, 0], body: pelvis, live: true}]
        faults: [{kind: qp_failure, time: 0.04, duration: 0.01}]
        """,
    "tilted": """
        duration: 0.06
        errors: {ground_pitch: 0.01, ground_roll: 0.01}
        pushes: [{time: 0.02, duration: 0.02, impulse: 0.01, elevation: 0.2}]
        seeds: 2
        margins: {push: {key: pushes.0.impulse, low: 0.01, high: 0.5, tolerance: 0.3}}
        """,
    "commands": """
        duration: 0.3
        commands:
          - {time: 0.1, v_x: 0.1, v_y: 0.02, yaw_rate: 0.1, march: true,
             single_support: 1, double_support: 0.4, swing_height: 0.04}
          - {time: 0.2, place: {x: 0.4, y: 0.1, yaw: 0.2}, live: true}
        gait: {initial_stand: 0.2}
        fidelity: pendulum
        """,
    "pendulum": """
        fidelity: pendulum
        gait: {steps: 2, single_support: 0.6, double_support: 0.2, initial_stand: 0.2}
        pendulum: {plant: cart_table, feedback: 2}
        pushes: [{step: 1, phase: single, fraction: 0.5, duration: 0.1, impulse: 0.01, direction: 0.5}]
        rates: {physics: 500, control: 100}
        """,
}


def _of_controller(parameters: Any, model: type[BaseModel]) -> dict[str, Any]:
    """Every key of a group of ``wbc``, a little more than what the controller has."""
    values = {}
    for name, field in model.model_fields.items():
        inner = next(_groups(field.annotation), None)
        value = getattr(parameters, name, None)
        if inner is not None:
            values[name] = _of_controller(value, inner)
        elif isinstance(value, tuple):
            values[name] = [1.001 * one for one in value]
        elif isinstance(value, float):
            values[name] = 0.999 * value
        else:
            values[name] = {"friction": 0.7, "tasks": []}.get(name, value)
    return values


def _groups(annotation: Any) -> Iterator[type[Group]]:
    if isclass(annotation) and issubclass(annotation, Group):
        yield annotation
    for argument in get_args(annotation):
        yield from _groups(argument)


def keys(model: type[BaseModel], place: str = "") -> Iterator[str]:
    """Dotted keys of a group that lead to values; those of the groups of a list like any, groups by name are one."""
    for name, field in (*model.model_fields.items(), *own_keys(model)):
        inner = next(_groups(field.annotation), None)
        if inner is None or any(get_origin(one) is dict for one in (field.annotation, *get_args(field.annotation))):
            yield f"{place}{name}"
        else:
            yield from keys(inner, f"{place}{name}.")


def given(value: Any, place: str = "") -> Iterator[str]:
    """Dotted keys that plain values give; groups by name are one."""
    if isinstance(value, dict) and place not in ("criteria.", "margins."):
        for name, inside in value.items():
            yield from given(inside, f"{place}{name}.")
    elif isinstance(value, list) and any(isinstance(inside, dict) for inside in value):
        for inside in value:
            yield from given(inside, place)
    else:
        yield place.rstrip(".")


def _of_laws() -> Iterator[tuple[str, dict[str, Any]]]:
    """Profiles whose law has numbers of its own, each with all of these, a little more than what they are."""
    for kind, model in own_models(PlannerSettings):
        names = model.model_fields.keys() - PlannerSettings.model_fields.keys()
        yield kind, {"profile": kind, **{name: 1.001 * getattr(PROFILES[kind].parameters, name) for name in names}}


def _of_instruments() -> Iterator[tuple[str, dict[str, Any]]]:
    """Instruments that have keys of their own, each with all of these; a number is a little more than what it is."""
    for kind, model in own_models(InstrumentSettings):
        own = {name: field.default for name, field in model.model_fields.items()}
        given = {name: value for name, value in own.items() if name not in InstrumentSettings.model_fields}
        yield (
            kind,
            {"name": kind}
            | {name: value + 0.001 if isinstance(value, float) else value for name, value in given.items()},
        )


WBC = _of_controller(controller_parameters(None), next(_groups(Scenario.model_fields["wbc"].annotation)))
RECOVERY = _of_controller(RecoveryParameters(), next(_groups(PlannerSettings.model_fields["recovery"].annotation)))

SCENARIOS: dict[str, dict[str, Any]] = {
    **{name: yaml.safe_load(text) for name, text in TEXTS.items()},
    "sensors": {"duration": 0.06, "sensing": {"source": "ekf", **SENSORS}},
    "wbc": {"duration": 0.06, "wbc": WBC},
    "recorder": {"duration": 1.2, "gait": {"steps": 0}, "log": {"keep": 1.0, "rate": 50}, "criteria": {"fell": False}},
    "recovery": {
        "duration": 0.06,
        "fidelity": "pendulum",
        "planner": {"recovery": RECOVERY, "without": ["goes_again"]},
    },
    **{f"wbc-{name}": {"duration": 0.06, "wbc": {name: value}} for name, value in WBC.items()},
    **{f"law-{name}": {"duration": 0.06, "planner": keys} for name, keys in _of_laws()},
    **{f"instrument-{name}": {"duration": 0.06, "instruments": [keys]} for name, keys in _of_instruments()},
}
"""Keys by name, as plain values."""
