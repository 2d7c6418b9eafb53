"""The fate of a scenario key that is set: refused, failed, told in a note, felt by the run, or nothing at all."""

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

from every_key import SENSORS
from pydantic import BaseModel

import surefoot
from surefoot.planner.laws.names import PROFILES
from surefoot.scenarios.errors import ScenarioError, SetupError
from surefoot.scenarios.file.registries import DEFAULTS, INSTRUMENTS
from surefoot.scenarios.file.schema import Scenario, own_models
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.show.differences import WALL_CLOCK

FEET = "robot_options: {foot_length: 0.22, foot_width: 0.11}\n"
PACE = "single_support: 0.4, double_support: 0.1, com_height: 0.99, initial_stand: 0.1"
STEPS = f"gait: {{steps: 4, step_length: 0.2, {PACE}}}\n"
STAND = f"gait: {{steps: 0, {PACE}}}\n"
POINT = "fidelity: pendulum\ncriteria: {fell: false}\n" + FEET
BODY = "criteria: {fell: false}\n" + FEET
LOW = PACE.replace("0.99", "0.93").replace("0.4", "0.7")
CLIMB = LOW.replace("double_support: 0.1", "double_support: 0.3")
EARLY = STEPS.replace("initial_stand: 0.1", "initial_stand: 0.5")
LOADED = "errors: {payload: {mass: 4.0}}\n"

BASES = {
    "walk-level": POINT + STEPS,
    "stand": POINT + STAND + "duration: 1.0\n",
    "speed": POINT + "gait: {speed: 0.4, steps: 4, initial_stand: 0.1}\n",
    "cart": POINT + STEPS + "pendulum: {plant: cart_table}\n",
    "velocity": POINT + f"gait: {{velocity: [{{time: 0, v_x: 0.2}}, {{time: 1}}], {PACE}}}\n",
    "footsteps": POINT
    + "gait: {footsteps: [{foot: left, x: 0.2, y: 0.1}, {foot: right, x: 0.2, y: -0.1}], "
    + PACE
    + "}\n",
    "waypoints": POINT + f"gait: {{waypoints: [{{x: 0.41, y: 0, yaw: 0.1}}], step_length: 0.2, {PACE}}}\n",
    "commands": POINT
    + STAND
    + "duration: 3\n"
    + "commands: [{time: 0.06, v_x: 0.1, single_support: 0.5}, {time: 1.5, v_x: 0}]\n",
    "place": POINT + STAND + "duration: 5\ncommands: [{time: 0.06, place: {x: 0.41, y: 0, yaw: 0.1}}]\n",
    "pushed": POINT + STEPS + "pushes: [{time: 1.0, force: [20, 5, 0]}]\n",
    "pushed-in-step": POINT + STEPS + "pushes: [{step: 2, phase: single, fraction: 0.5, impulse: 0.05}]\n",
    "frozen": POINT + STEPS + "faults: [{kind: planner_freeze, time: 0.5, duration: 0.1}]\n",
    "stairs": POINT + f"terrain: {{kind: stairs, count: 2, riser: 0.05}}\ngait: {{steps: 4, {CLIMB}}}\n",
    "blocks": POINT + f"terrain: {{kind: blocks, riser: 0.02}}\ngait: {{steps: 4, step_length: 0.3, {LOW}}}\n",
    "slope": POINT + f"terrain: {{kind: slope, angle: 0.05}}\ngait: {{steps: 4, step_length: 0.25, {LOW}}}\n",
    "loaded": POINT.replace("0.11}", "0.11, payload_mass: 2.0}") + STEPS + LOADED,
    **{
        profile: POINT + (EARLY if profile == "preview" else STEPS) + f"planner: {{profile: {profile}}}\n"
        for profile in PROFILES
        if profile != DEFAULTS["planner"]
    },
}
"""Scenarios of a few seconds on the pendulum, so that every part of the schema acts in one of them.

Places are a little farther than two strides, so that a longer stride makes fewer of them; a preview of the ZMP alone
has to see the first step for longer than the others.
"""

BODIES = {
    "body-stand": BODY + STAND + "duration: 0.5\n",
    "body-walk": BODY + f"gait: {{steps: 2, step_length: 0.2, {PACE}}}\nduration: 2.0\n",
    "body-pushed": BODY + STAND + "duration: 0.7\npushes: [{time: 0.2, impulse: 0.05}]\n",
    "body-caught": BODY + STAND + "duration: 1.0\npushes: [{time: 0.1, duration: 0.05, impulse: 0.4}]\n",
    "body-stairs": BODY
    + f"terrain: {{kind: stairs, count: 1, riser: 0.05}}\ngait: {{steps: 2, {LOW}}}\nduration: 2.5\n",
    "body-loaded": BODY.replace("0.11}", "0.11, payload_mass: 2.0}")
    + STAND
    + "duration: 0.5\nerrors: {payload: {mass: 3.0}}\n",
    "body-ground": BODY
    + f"gait: {{steps: 2, step_length: 0.2, {PACE}}}\nduration: 2.0\n"
    + "errors: {ground: [{x: 0.35, length: 0.3, height: 0.005}]}\n",
    **{
        f"body-{name}": BODY
        + STAND
        + "duration: 0.5\n"
        + f"instruments: [{{name: {name}, period: 0.02, faults: [{{kind: jump, time: 0.3, size: 0.1}}]}}]\n"
        for name in INSTRUMENTS
    },
    "body-sensed": BODY + STAND + "duration: 0.5\nsensing: {source: ekf}\n",
    "body-fault": BODY + STAND + "duration: 0.5\nfaults: [{kind: qp_failure, time: 0.2, duration: 0.01}]\n",
}
"""Bases in full physics."""

VALUES: dict[str, tuple[Any, ...]] = {
    "gait.speed": (0.4,),
    "robot": ("g1",),
    "sized_for": ("g1",),
    "requirements": (["REQ-7"],),
    "fidelity": ("pendulum", "full"),
    "seed": (7,),
    "duration": (0.9,),
    "robot_options.payload_mass": (3.0, 1e-300),
    "robot_options.payload_body": ("pelvis",),
    "terrain.kind": ("blocks",),
    "terrain.direction": ("up_down",),
    "terrain.start": (0.35, 50.0),
    "terrain.landing": (0.9,),
    "terrain.height_noise": (0.005, 1e-300),
    "gait.velocity": ([{"time": 0, "v_x": 0.1}, {"time": 1}],),
    "gait.lateral_step": (0.03, 1e-300),
    "gait.turn": (0.1, 1e-300),
    "gait.heel_off": (0.2, 1e-300),
    "gait.heel_strike": (0.2, 1e-300),
    "gait.pelvis_yaw": (0.05, 1e-300),
    "gait.pelvis_list": (0.03, 1e-300),
    "gait.footsteps": ([{"foot": "left", "x": 0.1, "y": 0.1}],),
    "gait.footsteps.0.foot": ("right",),
    "gait.waypoints": ([{"x": 0.3, "y": 0}], [{"x": 0.0, "y": 0}]),
    "planner.profile": ("lti",),
    "planner.horizon": (40,),
    "planner.control_horizon": (12,),
    "planner.jerk_limit": (20.0, 1e9),
    "planner.jerk_rate_limit": (5.0, 1e9),
    "planner.jerk_weight": (1e-3,),
    "planner.terminal_weight": (0.0, 300.0),
    "planner.step_weight": (0.1, 1e9),
    "planner.step_adaptation": ("none", "location", "timing"),
    "planner.knee": ("bent",),
    "planner.rise": ("single", "double"),
    "planner.filter": ("none", "kalman", "zmp_only"),
    "sensing.zmp_noise": (0.005, 1e-300),
    "sensing.com_noise": (0.001, 1e-300),
    "sensing.force_estimate": (False,),
    "sensing.source": ("ekf",),
    "sensing.options": ({"covariance_rate": 20.0}, {"force": 1.0}),
    **{f"sensing.{name}": (value,) for name, value in SENSORS.items()},
    "sensing.wrench": ("none",),
    "sensing.encoder_velocity": (False,),
    **dict.fromkeys((f"sensing.{name}" for name in SENSORS if name.endswith("dropout")), (0.2,)),
    "start.position_noise": (0.002, 1e-300),
    "start.angle_noise": (0.002, 1e-300),
    "start.x": (0.5, 1e-300),
    "start.y": (0.5, 1e-300),
    "start.yaw": (0.5, 1e-300),
    "errors.com_height": (0.02, 1e-300),
    "errors.mass_scale": (1.1,),
    "errors.link_mass_noise": (0.05, 1e-300, 0.0),
    "errors.torso_com": ([0.01, 0, 0], [1e-300, 0, 0], [0, 0, 0]),
    "errors.friction": (0.2, 1e-300),
    "errors.ground": ([{"x": 0.3, "length": 0.2, "height": 0.004}], [{"x": 50, "length": 0.2, "height": 0.004}]),
    "errors.ground.0.y": (0.05, 20.0),
    "errors.ground_noise": (0.003, 1e-300, 0.0),
    "errors.torso_mass": (1.2, 1.0),
    "errors.ground_pitch": (0.02, 1e-300, 0.0),
    "errors.ground_roll": (0.02, 1e-300, 0.0),
    "errors.ground.0.friction": (0.5,),
    "motors.damping": (2.0,),
    "motors.friction_loss": (1.0,),
    "motors.delay": (0.002,),
    "motors.noise": (1.0,),
    "motors.torque_speed": (0.05,),
    "errors.payload": ({"mass": 2.0}, {"mass": 0.0}, {"mass": 1e-300}),
    "errors.payload.mass": (2.0,),
    "errors.payload.body": ("pelvis",),
    "instruments": ([{"name": "altimeter"}], [{"name": "altimeter", "period": 0.001}]),
    "instruments.0.name": tuple(INSTRUMENTS),
    "instruments.0.label": ("other",),
    "instruments.0.period": (0.05, 1e-9),
    "instruments.0.noise": (0.01, 1e-300),
    "instruments.0.bias": (0.01, 1e-300),
    "instruments.0.faults": ([{"kind": "freeze", "time": 0.2}], [{"kind": "drop", "time": 50.0}]),
    "instruments.0.faults.0.kind": ("freeze", "drop"),
    "instruments.0.faults.0.duration": (0.1, 1e-9, 50.0),
    "instruments.0.faults.0.size": (0.2, 1e-300, 0.0),
    "plant.name": ("mujoco",),
    "plant.options": ({"refined": 2},),
    "control.output": ("position",),
    "control.output_rate": (250,),
    "control.stiffness": (1.5,),
    "control.damping": (0.02,),
    "control.gains": ({".*": [100.0, 1.0]},),
    "control.feed_forward": (False,),
    "control.driven_joints": ({".*elbow.*": [10.0, 1.0]},),
    "control.driven_motion": (0.1,),
    "control.driven_told": (False,),
    "control.give_way": (False,),
    "controller.name": ("policy",),
    "controller.options": ({"stiffness": 2},),
    "controller.policy": ("nowhere.yaml",),
    "controller.digest": ("0" * 64,),
    "controller.left_out": (["fell"],),
    "log.keep": (1.0,),
    "log.rate": (50,),
    "planner.without": (["goes_again"],),
    "wbc.tasks": ([],),
    "wbc.friction": (0.5, 0.8),
    "wbc.solver": ("proxqp",),
    "wbc.second_solver": ("equality-first",),
    "pendulum.plant": ("cart_table",),
    "pushes": (
        [{"time": 0.5, "force": [10, 0, 0]}],
        [{"time": 0.5, "force": [1e-300, 0, 0]}],
        [{"time": 0.5, "impulse": 1e-300}],
        [{"time": 0.5, "force": [10, 0, 0], "body": "pelvis"}],
    ),
    "pushes.0.phase": ("double",),
    "pushes.0.force": ([1e-300, 0, 0],),
    "pushes.0.body": ("pelvis",),
    "pushes.0.direction": (0.5,),
    "pushes.0.elevation": (0.4,),
    "commands": ([{"time": 0.5, "swing_height": 0.07}], [{"time": 0.5, "v_x": 1e-300}]),
    "commands.0.v_y": (0.05,),
    "commands.0.march": (True,),
    "commands.0.yaw_rate": (0.05,),
    "commands.0.double_support": (0.2,),
    "commands.0.swing_height": (0.07,),
    "faults": ([{"kind": "planner_freeze", "time": 0.5}], [{"kind": "qp_failure", "time": 0.4, "duration": 0.02}]),
    "faults.0.duration": (0.2,),
    "faults.0.kind": ("state_nan",),
    "rates.physics": (2000,),
    "rates.control": (250,),
    "rates.planner": (100,),
}
"""Values to set, where more is to be tried than a number that differs by a tenth from the one there is."""


def keys(group: type[BaseModel] = Scenario, *path: str) -> Iterator[str]:
    """The dotted path of every key, those of groups and lists themselves included; lists go on with their first."""
    for name, field in group.model_fields.items():
        inner, listed = _group_in(field.annotation), "tuple" in str(field.annotation)
        key = ".".join((*path, name))
        if inner is None or listed or name == "payload":
            yield key
        if inner is not None:
            place = f"{name}.0" if listed else name
            models = [inner, *(own for _, own in own_models(inner))]
            yield from dict.fromkeys(found for model in models for found in keys(model, *path, place))


def _group_in(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((found for found in map(_group_in, get_args(annotation)) if found is not None), None)


def value_of(scenario: Scenario, key: str) -> Any:
    """The value of a dotted key; None in a group that is null, whose keys may be set all the same.

    Raises:
        LookupError: the scenario has no such place.
    """
    value: Any = scenario
    for part in key.split("."):
        if value is None and not part.isdigit():
            return None
        if value is None:
            raise LookupError(key)
        value = value[int(part)] if part.isdigit() else getattr(value, part)
    return value


def values_of(key: str, present: Any) -> tuple[Any, ...]:
    """Values to set in the place of the present one; none where none is known."""
    if key in VALUES:
        return tuple(value for value in VALUES[key] if value != present)
    if isinstance(present, tuple) and present and all(isinstance(one, float) for one in present):
        return ([1.1 * one for one in present],)
    if isinstance(present, bool) or not isinstance(present, int | float):
        return ()
    return (present + 1,) if isinstance(present, int) else (1.1 * present if present else 0.01,)


def usual_values() -> dict[str, Any]:
    """The values of the keys wbc.* and planner.* that null stands for; a number of laws has that of the first."""
    from surefoot.planner.parameters import RecoveryParameters
    from surefoot.wbc.parameters import WbcParameters

    found: dict[str, Any] = {}

    def walk(part: Any, *path: str) -> None:
        for name in part.__dataclass_fields__:
            value = getattr(part, name)
            if hasattr(value, "__dataclass_fields__"):
                walk(value, *path, name)
            else:
                found[".".join((*path, name))] = value

    walk(WbcParameters(), "wbc")
    walk(RecoveryParameters(), "planner", "recovery")
    for profile in PROFILES.values():
        for name in profile.numbers:
            found.setdefault(f"planner.{name}", getattr(profile.parameters, name))
    return found


def content(log: Log) -> str:
    """Digest of every numeric channel but those of wall-clock times."""
    digest = hashlib.sha256()
    for topic in sorted(log.numeric):
        digest.update(topic.encode() + (b"" if topic in WALL_CLOCK else log[topic].content()))
    return digest.hexdigest()


def trials(scenario: Scenario) -> Iterator[tuple[str, Any]]:
    """Every key of the schema that has a place in a scenario, with each value to set there."""
    usual = usual_values()
    for key in keys():
        try:
            present = value_of(scenario, key)
        except (LookupError, AttributeError, TypeError):
            continue
        for value in values_of(key, usual.get(key) if present is None else present):
            yield key, value


class Experiment:
    """Runs of one base with one key set each, held against the run without.

    Args:
        text: of the base.
        folder: for its runs.
    """

    def __init__(self, text: str, folder: Path) -> None:
        self._text, self._folder = text, folder
        self.scenario = read_scenario(text, "f.yaml", "f")
        plain = surefoot.run(self.scenario, out=folder)
        assert plain.verdict.passed, plain.verdict.reasons
        self._content, self._notes = content(read(plain.log)), set(plain.verdict.notes)

    def outcome(self, key: str, value: Any) -> str:
        """refused, failed, noted, felt, or silent: nothing has changed and nothing is said."""
        try:
            run = surefoot.run(read_scenario(self._text, "f.yaml", "f", {key: value}), out=self._folder)
        except (ScenarioError, SetupError):
            return "refused"
        if not run.verdict.passed:
            return "failed"
        if content(read(run.log)) != self._content:
            return "felt"
        notes = set(run.verdict.notes)
        return "noted" if notes - self._notes or any(key in note for note in notes) else "silent"

    def trials(self) -> Iterator[tuple[str, Any]]:
        """Every key of the schema that has a place in the base, with each of its values."""
        return trials(self.scenario)
