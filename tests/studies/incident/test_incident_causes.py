"""Each key that acts in a scenario is listed once and can be taken out; the setting that is named takes it out, too."""

import itertools

import pytest
import yaml

import surefoot
from surefoot.scenarios import catalogue
from surefoot.scenarios.setup.load import read_scenario
from surefoot.studies.incident.causes import causes_of, settings, suspected, values_of, without
from surefoot.studies.incident.regression import checked

pytestmark = pytest.mark.unit

FULL = {
    "gait.steps": 6,
    "pushes": [{"time": 2.0, "impulse": 0.2}, {"step": 2, "phase": "single", "fraction": 0.5, "force": [10.0, 0, 0]}],
    "faults": [{"kind": "planner_freeze", "time": 2.5, "duration": 0.1}],
    "errors.mass_scale": 1.05,
    "errors.payload.mass": 3.0,
    "errors.ground": [{"x": 1.0, "length": 0.5, "height": 0.01}, {"x": 1.8, "length": 0.5, "height": 0.01}],
    "terrain.friction": 0.7,
    "motors": {"delay": 0.002, "noise": 0.1},
    "sensing.encoder_noise": 1e-4,
    "sensing.com_noise": 0.001,
    "start.position_noise": 0.001,
    "start.x": 0.3,
    "planner.recovery.cop_share": 0.7,
    "planner.without": ["adds_steps"],
    "wbc.gains.posture": [25.0, 10.0],
    "wbc.friction": 0.75,
    "control": {"output": "position", "stiffness": 2.0},
    "log.keep": 2.0,
}

EXPECTED = [
    *("pushes.0", "pushes.1", "faults.0", "terrain.friction", "errors.mass_scale", "errors.payload"),
    *("errors.ground.0", "errors.ground.1", "motors.delay", "motors.noise", "sensing.source", "sensing.preset"),
    *("sensing.com_noise", "sensing.encoder_noise", "start.position_noise", "control.output", "control.stiffness"),
    *("planner.recovery.cop_share", "planner.without", "wbc.gains.posture", "wbc.friction"),
]


@pytest.fixture(scope="module")
def values():
    return values_of(surefoot.load("walk-level", FULL))


def test_every_key_that_acts_is_a_cause_and_the_walk_is_none(values):
    found = [cause.text.partition(" ")[0] for cause in causes_of(values)]
    assert sorted(found) == sorted(EXPECTED)


def test_without_all_of_them_only_the_walk_is_left(values):
    left = without(values, causes_of(values))
    assert causes_of(left) == ()
    assert set(left) == {"gait", "robot_options", "criteria", "start"}
    assert left["start"] == {"x": 0.3}
    assert left["gait"] == values["gait"]
    assert set(values) > set(left)  # and the values are not changed


@pytest.mark.parametrize("number", range(len(EXPECTED)))
def test_the_setting_that_is_told_does_the_same(values, number):
    cause = causes_of(values)[number]
    left = without(values, [cause])
    assert left != values
    assert without(left, []) == left
    one = checked(left, "left")
    text = {**values, "name": "left"}

    other = read_scenario(yaml.safe_dump(text), "left", "left", settings(values, cause))
    assert plain(one.model_dump()) == plain(other.model_dump())


def plain(value):
    """Values without groups in which nothing is set, which mean the same as none."""
    if not isinstance(value, dict):
        return value
    found = {name: plain(one) for name, one in value.items()}
    return {name: one for name, one in found.items() if one is not None} or None


def test_entries_that_are_left_have_their_content_whatever_is_taken_out(values):
    causes = causes_of(values)
    pushes = [cause for cause in causes if cause.group == "pushes"]
    for taken in itertools.chain(itertools.combinations(pushes, 1), [pushes, pushes[::-1]]):
        left = without(values, taken).get("pushes", [])
        assert left == [one for index, one in enumerate(values["pushes"]) if pushes[index] not in taken]


def test_stairs_are_one_cause_and_leave_their_friction():
    values = values_of(surefoot.load("stairs-up", {"terrain.height_noise": 0.01, "terrain.friction": 0.9}))
    shape = next(cause for cause in causes_of(values) if cause.text == "terrain.kind stairs")
    assert without(values, [shape])["terrain"] == {"friction": 0.9}
    noise = next(cause for cause in causes_of(values) if cause.text.startswith("terrain.height_noise"))
    assert without(values, [noise])["terrain"]["kind"] == "stairs"


def test_causes_that_a_log_names_are_suspected(values):
    causes = causes_of(values)
    assert {one.group for one in suspected(causes, ["push", "sensors"])} == {"pushes", "sensing"}
    assert suspected(causes, ["no such check"]) == ()
    assert {one.group for one in causes if one.is_setting} == {"control", "planner", "wbc"}


def without_log(scenario):
    """All of a scenario that its values hold; sensors that nobody reads do nothing."""
    found = scenario.model_dump(exclude={"name", "log"})
    if found["sensing"]["source"] == "truth":
        found["sensing"]["preset"] = None
    return plain(found)


@pytest.mark.parametrize("name", [*catalogue.OURS, "truth", "full"])
def test_values_make_the_same_scenario(name):
    changes = {"truth": ("walk-level", {"sensing.source": "truth"}), "full": ("walk-level", FULL)}
    scenario = surefoot.load(*changes.get(name, (name, {})))
    assert without_log(checked(values_of(scenario), "again")) == without_log(scenario)
