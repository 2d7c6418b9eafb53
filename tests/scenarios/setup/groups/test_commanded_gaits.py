"""Velocity commands and explicit footsteps in scenario files: what they become, and what is refused."""

from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from surefoot.planner.ground.terrain import flat
from surefoot.planner.parameters import LegInertia
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.types import Foot
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.setup.walk import Walk, resolve

pytestmark = pytest.mark.unit

FAST = "robot_options: {foot_length: 0.22, foot_width: 0.11}\n"
VELOCITY = "gait: {single_support: 0.5, double_support: 0.1, velocity: [{time: 0, %s}, {time: 5}]}"
FOOTSTEPS = "gait: {footsteps: [%s]}"

REFUSED = {
    "terrain: {kind: stairs}\n"
    + VELOCITY % "v_x: 0.3": "gait.velocity on stairs, whose treads its footsteps would not",
    FAST + VELOCITY % "v_x: 0.9": "steps of 0.54 m ahead in 0.6 s, out of reach; the fastest in this direction is v_x"
    " 0.825, v_y 0, yaw_rate 0; or take faster steps",
    FAST
    + VELOCITY % "v_y: -0.5": "gait.velocity.0 asks for steps of -0.3 m to the left in 0.6 s, out of reach; the fastest"
    " in this direction is v_x 0, v_y -0.233, yaw_rate 0",
    VELOCITY % "v_x: 0.1, yaw_rate: 2": "steps of 0.0565 m ahead and 1.2 rad of turn in 0.6 s, out of reach; the",
    VELOCITY % "v_x: 11": "gait.velocity.0.v_x is 11; it must be at most 10",
    VELOCITY % "v_z: 1": "unknown key 'v_z'; did you mean 'v_y'?",
    "gait: {velocity: [{time: 0, v_x: 0.1}]}": "the last velocity command does not stop; end gait.velocity with",
    "gait: {velocity: [{time: 3}, {time: 2}]}": "f.yaml:1:37: gait.velocity.1.time 2.0 s does not come after the",
    "gait: {velocity: [{time: 0.011}, {time: 0.011}]}": "velocity.1.time 0.011 s does not come after the command befor",
    "gait: {velocity: [{v_x: 0}]}": "gait.velocity.0 lacks element time; give 'time'",
    "gait: {single_support: .3, double_support: .1, velocity: [{time: 0}, {time: 80000}]}": "lasts 80000 s; 40000 s",
    FOOTSTEPS % "{foot: left, x: 0.2, y: 0.1}, {foot: left, x: 0.4, y: 0.1}": "gait.footsteps.1 moves the left foot a",
    FOOTSTEPS % "{foot: left, x: 0.1, y: -0.2}": "footstep 1 crosses its stance foot, -0.100 m beside it; 0.110 m is",
    FOOTSTEPS % "{foot: left, x: 0, y: -0.03}": "footstep 1 would touch its stance foot, 0.070 m beside it; 0.110 m",
    FOOTSTEPS
    % "{foot: left, x: 0.1, y: 0.1}, {foot: right, x: 0.6, y: -0.1}": "footstep 2 lands 0.500 m from where the"
    " legs stand upright; 0.495 m is the most",
    FOOTSTEPS
    % "{foot: right, x: 0.1, y: -0.1, yaw: -0.6}": "footstep 1 turns by -0.6 rad against its stance foot; 0.5",
    FOOTSTEPS % "{foot: middle, x: 0, y: 0}": "gait.footsteps.0.foot is 'middle'; it must be 'left' or 'right'",
    "gait: {footsteps: [{foot: left, x: 0, y: 0.1}], velocity: [{time: 0}]}": "f.yaml:1:8: footsteps beside gait",
}


def read(robots, text):
    return read_scenario(text, "f.yaml", "f", (), robots)


@pytest.mark.parametrize("text", REFUSED, ids=range(len(REFUSED)))
def test_what_cannot_be_walked_is_refused_with_one_message(robots, text):
    with pytest.raises(ScenarioError) as caught:
        read(robots, text)
    assert len(caught.value.problems) == 1, caught.value.problems
    assert REFUSED[text] in caught.value.problems[0]


@pytest.mark.parametrize(
    "twist",
    ["v_x: 0.82", "v_y: 0.23", "yaw_rate: -0.8", "v_x: -0.3, v_y: 0.1, yaw_rate: 0.3", "v_x: 0.7, yaw_rate: 0.8"],
)
def test_what_is_just_within_reach_is_accepted_and_reads_back_as_itself(robots, twist, monkeypatch):
    scenario = read(robots, FAST + VELOCITY % twist)
    assert Walk(scenario).asked_gait.steps == 8
    assert read(robots, scenario_yaml(scenario)) == scenario
    robot = SimpleNamespace(
        sole_length=0.22,
        sole_width=0.11,
        mass=100.0,
        shank_spacing=0.11,
        leg_length=0.94,
        roles=SimpleNamespace(feet_lean=False),
    )
    monkeypatch.setattr("surefoot.scenarios.setup.walk.facts_of", lambda _: robots.facts("", scenario.robot_options))
    walk = resolve(scenario, robot)
    planner = walk.planner(walk.ground.stance, LegInertia())
    assert planner.gait.steps == 8


def test_footsteps_are_relative_to_the_start_stance(robots):
    text = FOOTSTEPS % "{foot: right, x: 0.2, y: -0.1, yaw: -0.2}, {foot: left, x: 0.3, y: 0.1}"
    scenario = read(robots, text + "\nstart: {x: 5, y: 2, yaw: 1.5707963267948966}")
    steps = plan_footsteps(Walk(scenario).asked_gait, Walk(scenario).ground.stance, flat())
    assert [step.foot for step in steps[2:]] == [Foot.RIGHT, Foot.LEFT]
    np.testing.assert_allclose([step.position[:2] for step in steps[2:]], [[5.1, 2.2], [4.9, 2.3]], atol=1e-12)
    np.testing.assert_allclose([step.yaw for step in steps[2:]], [np.pi / 2 - 0.2, np.pi / 2])


def test_keys_of_equal_steps_beside_a_command_are_noted(robots):
    scenario = read(robots, "gait: {steps: 7, velocity: [{time: 0, v_x: 0.1}, {time: 3}]}")
    assert notes(Walk(scenario)) == ("gait.steps has no effect beside gait.velocity",)
    assert notes(Walk(read(robots, "gait: {steps: 7}"))) == ()


def test_a_push_by_step_counts_the_commanded_steps(robots):
    with pytest.raises(ScenarioError, match=r"a push in step 9 of a gait of 8 steps"):
        read(robots, FAST + VELOCITY % "v_x: 0.3" + "\npushes: [{step: 9, phase: single}]")


def test_every_fault_beside_a_bad_command_is_still_named(robots):
    value = {"gait": {"velocity": [{"time": 0, "v_x": 0.1}], "single_support": 0.05}, "rates": {"control": 300}}
    with pytest.raises(ScenarioError) as caught:
        read(robots, yaml.safe_dump(value))
    assert len(caught.value.problems) == 3
