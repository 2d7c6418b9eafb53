"""Notes: a key that a scenario sets and that nothing of its walk reads is told."""

from types import SimpleNamespace
from typing import get_args

import numpy as np
import pytest

from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.file.schema import PendulumSettings
from surefoot.scenarios.run.pendulum import plant
from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.groups.speed import FOLLOWING
from surefoot.scenarios.setup.load import load, read_scenario
from surefoot.scenarios.setup.walk import Walk, resolve

pytestmark = pytest.mark.unit

POINT = "fidelity: pendulum\n"
CART = POINT + "pendulum: {plant: cart_table, feedback: 2}\n"
BODY = "pushes: [{time: 1, impulse: 0.01, body: pelvis}]\nerrors: {payload: {mass: 2, body: pelvis}}\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (CART, ["pendulum.feedback has no effect on pendulum.plant cart_table"]),
        (POINT + "pendulum: {feedback: 2}", []),
        (
            POINT + BODY,
            ["pushes.0.body has no effect on a pendulum", "errors.payload.body has no effect on a pendulum"],
        ),
        (BODY, []),
    ],
)
def test_what_the_plant_does_not_read_is_told(robots, text, words):
    assert list(notes(Walk(read_scenario(text, "f.yaml", "f", (), robots)))) == words


EQUAL = "steps: 0, step_length: 0.22, lateral_step: 0.01, turn: 0.1"
UNREAD = [f"gait.{name} has no effect beside commands and gait.steps 0" for name in ("lateral_step", "turn")]
LENGTH = "gait.step_length has no effect beside commands and gait.steps 0"


@pytest.mark.parametrize(
    ("gait", "commands", "words"),
    [
        (EQUAL, "{time: 1, v_x: 0.1}", [LENGTH, *UNREAD]),
        (EQUAL, "{time: 1, place: {x: 1, y: 0}}", UNREAD),
        (EQUAL, "{time: 1, v_x: 0.1, live: true}", []),
        (EQUAL.replace("steps: 0", "steps: 4"), "{time: 1, v_x: 0.1}", []),
        ("step_length: 0.22, waypoints: [{x: 1, y: 0}]", "{time: 1, v_x: 0.1}", []),
        (
            "step_length: 0.22, velocity: [{time: 0, v_x: 0.1}, {time: 3}]",
            "{time: 1, v_x: 0.1}",
            ["gait.step_length has no effect beside gait.velocity"],
        ),
        ("step_length: 0.22, velocity: [{time: 0, v_x: 0.1}, {time: 3}]", "{time: 1, place: {x: 1, y: 0}}", []),
    ],
)
def test_keys_of_equal_steps_are_told_where_steps_come_from_commands(robots, gait, commands, words):
    text = f"gait: {{{gait}}}\ncommands: [{commands}]\nduration: 90\n"
    assert list(notes(Walk(read_scenario(text, "f.yaml", "f", (), robots)))) == words


@pytest.mark.parametrize("kind", get_args(PendulumSettings.model_fields["plant"].annotation))
@pytest.mark.parametrize("key", sorted(set(PendulumSettings.model_fields) - {"plant"}))
def test_a_plant_reads_a_key_or_it_is_told(robots, kind, key):
    usual = PendulumSettings(plant=kind)
    changed = usual.model_copy(update={key: getattr(usual, key) + 1})
    unread = str(vars(plant(usual, 80.0, np.zeros(2), 0.0))) == str(vars(plant(changed, 80.0, np.zeros(2), 0.0)))
    text = f"{POINT}pendulum: {{plant: {kind}, {key}: {getattr(changed, key)}}}"
    told = any(f"pendulum.{key}" in note for note in notes(Walk(read_scenario(text, "f.yaml", "f", (), robots))))
    assert told == unread


@pytest.mark.parametrize(("text", "told"), [("name: f\n", True), (POINT, False)])
def test_parts_of_a_model_that_the_robot_lacks_are_told_of_whole_bodies(robots, robot, text, told):
    lacking = SimpleNamespace(**{**vars(robot), "left_out": ("left out: damping of 12 joints",)})
    scenario = read_scenario(text, "f.yaml", "f", (), robots)
    said = f"robot {robot.name}, left out: damping of 12 joints"
    assert (said in notes(resolve(scenario, lacking))) == told
    assert said not in notes(resolve(scenario, robot))


SPEED = {"gait": {"speed": 0.6, "steps": 6}, "criteria": {"fell": False}}
POINT_MASS, SEAT = {"fidelity": "pendulum"}, {"controller": {"policy": "any.yaml"}}
STILL, COMMANDED = {"gait.steps": 0, "duration": 3}, {"gait.velocity": [{"time": 0, "v_x": 0.1}, {"time": 3}]}


def of_keys(base, *settings):
    """Notes of a scenario that name a key, which are those of its log, too."""
    overrides = {key: value for one in settings for key, value in one.items()}
    scenario = load(base, overrides)
    again = read_scenario(scenario_yaml(scenario), "log", "log")
    said, told = (notes(Walk(one)) for one in (scenario, again))
    assert said == told
    return [note.partition(" has no effect ")[0] for note in said if not note.startswith("robot ")]


@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
@pytest.mark.parametrize(
    ("base", "settings", "key"),
    [
        ("walk-level", (SPEED, POINT_MASS), ("gait.pelvis_yaw", 0.05)),
        ("walk-level", (SPEED, POINT_MASS), ("gait.pelvis_list", 0.03)),
        ("walk-level", (SPEED, SEAT), ("gait.pelvis_list", 0.03)),
        ("walk-level", (SPEED, SEAT), ("gait.heel_off", 0.2)),
        ("walk-level", (SPEED, SEAT), ("planner.knee", "stretched")),
        ("walk-level", (SPEED, STILL), ("gait.swing_height", 0.06)),
        ("walk-level", (SPEED, STILL), ("gait.initial_stand", 0.5)),
        ("walk-level", (SPEED, STILL), ("gait.heel_strike", 0.1)),
        ("walk-level", (SPEED, COMMANDED), ("gait.ramp", 2)),
        ("walk-level", ({"planner.knee": "stretched"}, STILL), ("planner.knee", "straight")),
        ("stair-climbing", (POINT_MASS,), ("terrain.height_noise", 0.004)),
    ],
)
def test_a_key_that_is_given_is_told_and_one_that_follows_from_others_is_not(base, robot, settings, key):
    settings = ({"robot": robot}, *settings)
    usual = set(of_keys(base, *settings))
    told = {note.removesuffix(" straight") for note in of_keys(base, *settings, dict([key]))}
    assert told - usual == {key[0]}


@pytest.mark.parametrize("robot", ["humanoid100", "g1", "talos"])
@pytest.mark.parametrize("settings", [POINT_MASS, SEAT, STILL, COMMANDED], ids=["point", "seat", "still", "commanded"])
def test_nothing_that_follows_from_a_speed_is_told(robot, settings):
    names = {".".join(key) for key in FOLLOWING}
    assert not names & set(of_keys("walk-level", SPEED, settings, {"robot": robot}))


def test_steps_that_follow_from_treads_are_not_told():
    stairs = {"terrain": {"kind": "stairs", "tread": 0.28, "count": 1}, "gait": {"footsteps": [], "com_height": 0.95}}
    onto = {"gait.footsteps": [{"foot": foot, "x": 0.28, "y": y} for foot, y in (("left", 0.1), ("right", -0.1))]}
    assert "gait.step_length" not in of_keys("walk-level", stairs, onto)
    assert "gait.step_length" in of_keys("walk-level", {"gait": stairs["gait"]}, onto, {"gait.step_length": 0.28})


def test_a_number_beside_a_speed_that_others_follow_from_acts_by_these():
    usual, short = (load("walk-level", {**SPEED, **COMMANDED, **more}) for more in ({}, {"gait.step_length": 0.3}))
    assert short.gait.single_support < usual.gait.single_support
    assert of_keys("walk-level", SPEED, COMMANDED, {"gait.step_length": 0.3}) == ["gait.steps"]


def test_rates_that_follow_from_others_are_not_told():
    point = {**POINT_MASS, "robot": "g1", "rates.planner": 50, "planner.sample_time": 0.02}
    assert "rates.physics" not in of_keys("walk-level", point)
    assert "rates.physics" in of_keys("walk-level", point, {"rates.physics": 2000})


def test_an_estimator_that_follows_from_its_sensors_is_not_told():
    sensed = {**POINT_MASS, "sensing": {"preset": "good"}}
    assert of_keys("walk-level", sensed) == ["sensing.preset"]
    assert of_keys("walk-level", sensed, {"sensing.source": "truth"}) == ["sensing.source", "sensing.preset"]


def test_a_key_that_is_given_the_value_that_it_has_anyway_is_not_told():
    """The walk is what it asks for. A log, which has every key, could not tell it from one that follows."""
    usual = load("walk-level", SPEED).gait.pelvis_yaw
    assert usual > 0.0
    assert of_keys("walk-level", SPEED, POINT_MASS, {"gait.pelvis_yaw": usual}) == of_keys(
        "walk-level", SPEED, POINT_MASS
    )
    assert "gait.pelvis_yaw" in of_keys("walk-level", SPEED, POINT_MASS, {"gait.pelvis_yaw": 0.0})


TREADS = {"terrain.kind": "stairs", "terrain.riser": 0.05, "terrain.tread": 0.3}


@pytest.mark.parametrize(
    ("settings", "flat"),
    [
        ({}, []),
        ({"gait.step_length": 0.1}, ["heel_off", "heel_strike"]),
        ({"gait.step_length": 0.1, "gait.heel_strike": 0.0}, ["heel_off"]),
        ({"gait.step_length": -0.3}, ["heel_off", "heel_strike"]),
        ({"terrain.kind": "slope", "terrain.angle": 0.05}, []),
        ({**TREADS, "terrain.count": 4}, []),
        ({**TREADS, "terrain.count": 20}, ["heel_strike"]),
    ],
)
@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_feet_that_stay_flat_are_told_of_keys_that_would_roll_them(robot, settings, flat):
    """Short steps, steps backward, and steps that all end on treads keep feet flat; one level step does not."""
    rolls = {"gait.heel_off": 0.2, "gait.heel_strike": 0.2, "gait.step_length": 0.3}
    said = of_keys("walk-level", {"robot": robot, **rolls, **settings})
    told = [note.split()[0].removeprefix("gait.") for note in said if "ahead of the other foot" in note]
    assert told == flat
