"""Notes: a key that a scenario sets and that nothing of its walk reads is told."""

from types import SimpleNamespace
from typing import get_args

import numpy as np
import pytest

from surefoot.scenarios.file.schema import PendulumSettings
from surefoot.scenarios.run.pendulum import plant
from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.load import read_scenario
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
