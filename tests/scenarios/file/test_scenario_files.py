"""Scenario files: every fault of a file at once, each with its place and what would be right."""

import json

import pytest
import yaml

from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.load import read_scenario

pytestmark = pytest.mark.unit


def problems(robots, text, *overrides):
    with pytest.raises(ScenarioError) as caught:
        read_scenario(text, "f.yaml", "f", overrides, robots)
    return list(caught.value.problems)


@pytest.mark.parametrize("name", catalogue.names())
def test_catalogue_loads_and_is_named_as_its_file(name):
    assert load_scenario(name).name == name
    assert catalogue.summary(name)


def test_defaults_are_the_papers_table():
    gait = Scenario().gait
    assert (gait.steps, gait.step_length, gait.single_support, gait.double_support) == (5, 0.2, 1.5, 0.5)
    assert (gait.com_height, gait.apex_single, gait.apex_double) == (1.0, 0.0135, 0.00135)


def test_a_file_without_criteria_asks_to_walk_and_stand(robots):
    criteria = read_scenario("name: a", "f.yaml", "f", (), robots).criteria
    assert criteria["fell"].equals is False
    assert criteria["steps_taken"].equals == "steps_planned"
    assert criteria["standing_time_final"].min == 1.0


def test_criteria_forbid_a_fall_unless_they_speak_of_it(robots):
    assert read_scenario("criteria: {duration: {min: 1}}", "f", "f", (), robots).criteria["fell"].equals is False
    assert read_scenario("criteria: {fell: true}", "f", "f", (), robots).criteria["fell"].equals is True


def test_every_fault_of_the_controllers_keys_is_told_at_once(robots):
    found = problems(robots, "wbc: {weights: {swing: -1, force: 2}, solver: nope, arm_swing: -2}")
    assert [problem.split(" is ")[0] for problem in found] == [
        "f.yaml:1:24: wbc.weights.swing",
        "f.yaml:1:47: wbc.solver",
        "f.yaml:1:64: wbc.arm_swing",
    ]


CASES = {
    "gait: {step: 3}": "f.yaml:1:8: unknown key 'step'; did you mean 'steps'?",
    "gait: {steps: 2.5}": "f.yaml:1:15: gait.steps is 2.5; give a whole number",
    "gait: {steps: many}": "f.yaml:1:15: gait.steps is 'many'; give a whole number",
    "gait:\n  single_support: -1": "f.yaml:2:19: gait.single_support is -1; it must be more than 0.0",
    "gait: {step_length: .nan}": "f.yaml:1:21: gait.step_length is nan; give a finite number",
    "gait: {step_length: .inf}": "f.yaml:1:21: gait.step_length is inf; give a finite number",
    "duration: -.inf": "f.yaml:1:11: duration is -inf; give a finite number",
    "rates: {control: 300}": "does not divide rates.physics 1000 Hz; use a divisor of 1000 Hz",
    "rates: {control: 40}": "rates.planner 50 Hz does not divide rates.control 40 Hz",
    "planner: {sample_time: 0.01}": "f.yaml:1:24: planner.sample_time 0.01 s is not the period of rates.planner 50 Hz",
    "robot: humanoid10": "f.yaml:1:8: unknown robot 'humanoid10'; did you mean 'humanoid100'?",
    "gait: {step_length: 0.9}": "f.yaml:1:21: gait.step_length 0.9 m is out of reach at com_height 1.0 m; use at",
    "gait: {com_height: 1.2}": "f.yaml:1:20: gait.com_height 1.2 m is out of reach",
    "gait: {step_width: 3.0}": "f.yaml:1:20: gait.step_width 3.0 m is out of reach",
    "gait: {step_width: 0.25, lateral_step: 0.3}": "f.yaml:1:40: footstep 1 would land 0.550 m beside its stance",
    "gait: {step_length: 0.85, com_height: 0.8}": "f.yaml:1:21: footstep 1 would land 0.850 m ahead of its stance foot",
    "gait: {step_width: 0.25, turn: 2.0}": "f.yaml:1:32: footstep 2 would land -0.095 m beside its stance foot",
    "gait: {step_width: 0.07}": "f.yaml:1:20: gait.step_width 0.07 m lets feet 0.075 m wide touch; use more than",
    "gait: {lateral_step: 0.12}\nrobot_options: {foot_width: 0.14}": "m beside its stance foot and touch it; keep the",
    "gait: {single_support: 0.06, apex_single: 0}": "f.yaml:1:24: gait.single_support 0.06 s is too short for a",
    "gait: {apex_single: 0.7}": "f.yaml:1:21: gait.apex_single 0.7 m within 1.5 s asks the CoM to fall faster than",
    "gait: {steps: 100000}": "f.yaml:1:15: a gait of 200002 s; it may last 20000 s; use fewer or faster steps",
    "planner: {horizon: 10}": "f.yaml:1:20: planner.horizon 10 is shorter than the planner's blocks of moves; use at",
    "planner: {profile: paper, control_horizon: 60}": "control_horizon 60 exceeds the horizon of 50 samples; use at",
    "planner: {profile: dcm, control_horizon: 2}": "with profile 'dcm', which optimises no moves of the jerk; leave it",
    "planner: {without: [goes_agin]}": "'goes_agin', which is no rule of profile 'default'; did you mean 'goes_again'?",
    "planner: {without: goes_again}": "f.yaml:1:20: planner.without is 'goes_again'; give a list",
    "duration: 1.0e-6": "f.yaml:1:11: duration 1e-06 s is shorter than one control tick; use at least 0.002 s",
    "pushes: [{time: 1, force: [1, 0, 0], body: torzo}]": (
        "f.yaml:1:44: unknown body 'torzo' of humanoid100; did you mean 'torso'?"
    ),
    "robot_options: {payload_body: x}": "unknown body 'x' of humanoid100; valid are pelvis, torso",
    "pushes: [{duration: 1}]": "f.yaml:1:10: a push without a begin; give time, or step, phase and fraction",
    "pushes: [{time: 1, step: 1}]": "a push with both a time and a point of the gait; give one of them",
    "pushes: [{step: 9, phase: single}]": "a push in step 9 of a gait of 5 steps; give a step of at most 5",
    "pushes: [{time: 1, force: [1, 2, 0], impulse: 0.1}]": (
        "f.yaml:1:47: a push with both a force and an impulse; give one of them"
    ),
    "pushes: [{time: 1, force: [1, 2, 0], direction: 1}]": (
        "f.yaml:1:49: direction of a push without an impulse; give impulse, or force alone"
    ),
    "pushes: [{time: 1, force: [1, 2, 0], elevation: 1}]": (
        "f.yaml:1:49: elevation of a push without an impulse; give impulse, or force alone"
    ),
    "pushes: [{time: 1, impulse: -1}]": "pushes.0.impulse",
    "pushes: [{time: 1, force: [1, 2]}]": "f.yaml:1:27: pushes.0.force lacks element 2; give '2'",
    "errors: {ground: [{x: 1, height: 0.1, length: 1, tall: 2}]}": "f.yaml:1:50: unknown key 'tall'; valid are",
    "errors: {ground: [{x: 1, height: 5, length: 1}]}": "errors.ground.0.height is 5; it must be at most 1.0 m",
    "criteria: {cop_ratio_p9: {max: 1}}": "unknown metric 'cop_ratio_p9'; did you mean 'cop_ratio_p99'?",
    "criteria: {fell: {}}": "criteria.fell: a criterion without a bound; give min, max or equals",
    "criteria: {duration: {min: 2, max: 1}}": "min 2.0 exceeds max 1.0; swap them",
    "criteria: {zmp_error_rms: {max: [1, 2, 3]}}": "has 3 elements; give one number, or 2 of them",
    "faults: [{kind: gremlin}]": "faults.0.kind is 'gremlin'; it must be 'torque_loss', 'planner_freeze'",
    "gait: 3": "f.yaml:1:7: gait is 3; give a group of keys",
    "sensing: {gyro_noise: 1e-3}": "f.yaml:1:23: sensing.gyro_noise 0.001 beside sensing.source truth, which reads",
    "name: a\nname: b": "f.yaml:2:1: 'name' is given twice, first at line 1; keep one of them",
    "name: ../a": "f.yaml:1:7: name is '../a'; use letters, digits",
    "": "f.yaml:1:1: the file is empty; give at least 'name: f'",
    "# nothing": "f.yaml:1:1: the file is empty",
    "- 1": "f.yaml:1:1: a scenario is a group of keys",
    "gait: [": "f.yaml:1:8: not valid YAML",
    "gait:\n\t- 1": "f.yaml:2:1: not valid YAML, found character '\\t' that cannot start any token",
    "a: \x01": "f.yaml:1:4: a character that YAML does not allow; use plain text",
    "[" * 3000: "nested deeper than 20 levels",
    "a: &a [*a]": "not valid YAML, more than",
    "? [a]\n: 1": "f.yaml:1:3: not valid YAML, a key must be a word",
}


@pytest.mark.parametrize("text", CASES, ids=[text[:30] for text in CASES])
def test_one_fault_gives_one_message(robots, text):
    found = problems(robots, text)
    assert len(found) == 1, found
    assert CASES[text] in found[0]


def test_all_faults_of_a_file_at_once_in_its_order(robots):
    text = "seed: x\ngait:\n  steps: -1\n  single_support: 0.013\nrates: {control: 300}\nrobot: nobody\nfoo: 1\n"
    found = problems(robots, text)
    assert [line.split(":")[1] for line in found] == ["1", "3", "4", "5", "6", "7"]


def test_an_alias_bomb_is_refused(robots):
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 12)]
    assert "once aliases are expanded" in problems(robots, "\n".join(lines))[0]


def test_overrides_are_yaml_with_dotted_keys(robots):
    pushes = "pushes=[{time: 2.2, duration: 0.01, force: [75, 75, 0]}]"
    overrides = ("gait.steps=3", pushes, "pushes.0.body=torso", "terrain.friction=5e-1")
    scenario = read_scenario("gait:\n", "f.yaml", "f", overrides, robots)
    assert scenario.gait.steps == 3
    assert scenario.pushes[0].force == (75, 75, 0)
    assert scenario.pushes[0].body == "torso"
    assert scenario.terrain.friction == 0.5


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("gait.steps", "--set gait.steps: not a setting; write --set key=value"),
        ("gait.stepz=3", "--set gait.stepz: unknown key 'stepz'; did you mean 'steps'?"),
        ("gate.steps=3", "--set gate.steps: unknown key 'gate'; did you mean 'gait'?"),
        ("gait.steps=a", "--set gait.steps: gait.steps is 'a'; give a whole number"),
        ("pushes.0.time=1", "--set pushes.0.time: no element 0 of a list of 0; use an index within it"),
        ("seed.x=1", "--set seed.x: 'x' is not a key of a group; set the group itself"),
        ("seed=[", "--set seed:1:2: not valid YAML"),
    ],
)
def test_a_wrong_override_is_named(robots, override, message):
    assert message in problems(robots, "seed: 1\npushes: []", override)[0]


def test_a_refusal_of_what_does_not_fit_together_names_what_was_set_over_the_file(robots):
    text, wide = "gait: {step_width: 0.2}", "robot_options.foot_width=0.3"
    (found,) = problems(robots, text, "seed=3", wide)
    assert found.startswith("f.yaml:1:20: gait.step_width 0.2 m lets feet 0.3 m wide touch")
    assert found.endswith("[set over the file: --set seed, --set robot_options.foot_width]")
    (own,) = problems(robots, "gait: {step_width: 0.2}\nrobot_options: {foot_width: 0.3}")
    assert "--set" not in own
    (alone,) = problems(robots, "gait: {steps: many}", "seed=3")
    assert "--set" not in alone


def test_what_is_no_file(robots, tmp_path):
    (tmp_path / "latin.yaml").write_bytes(b"name: a\nrobot: \xe9")
    (tmp_path / "big.yaml").write_bytes(b"#" * 2_000_000)
    cases = {
        "diagonal-wlk": "no such scenario file or catalogue name; did you mean 'diagonal-walk'?",
        str(tmp_path): "a directory; give a scenario file or a catalogue name",
        str(tmp_path / "latin.yaml"): "latin.yaml:2:8: not UTF-8 text; save the file as UTF-8",
        str(tmp_path / "big.yaml"): "larger than",
        "a\0b": "cannot be read",
    }
    for reference, message in cases.items():
        with pytest.raises(ScenarioError) as caught:
            load_scenario(reference, (), robots)
        assert message in str(caught.value)


def test_the_scenario_as_run_reads_back_as_itself(robots):
    text = (
        "pushes: [{step: 2, phase: single, fraction: .5, force: [1, 2, 3]}]\nfaults: [{kind: torque_loss, time: 1e-7}]"
    )
    scenario = read_scenario(text, "f.yaml", "f", (), robots)
    assert read_scenario(scenario_yaml(scenario), "g.yaml", "g", (), robots) == scenario
    assert yaml.safe_load(scenario_yaml(scenario))["gait"]["steps"] == 5


def test_every_key_is_described():
    definitions = Scenario.model_json_schema()
    groups = [definitions, *definitions["$defs"].values()]
    for group in groups:
        for name, key in group.get("properties", {}).items():
            assert "description" in key, name
    json.dumps(definitions)
