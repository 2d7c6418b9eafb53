"""Numbers with units: exact, of the right kind only, and told when a bare number looks like another unit."""

import math

import pytest
import yaml

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.dumped import scenario_yaml
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.checks.notes import notes
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.setup.walk import Walk

pytestmark = pytest.mark.unit


def load(robots, text, *overrides):
    return read_scenario(text, "f.yaml", "f", overrides, robots)


@pytest.mark.parametrize(
    ("key", "written", "value"),
    [
        ("gait.step_length", "25 cm", 0.25),
        ("gait.step_length", "250mm", 0.25),
        ("gait.step_length", "0.3 m", 0.3),
        ("gait.step_length", "-1e1 cm", -0.1),
        ("gait.single_support", "700 ms", 0.7),
        ("gait.turn", "15 deg", math.radians(15)),
        ("gait.turn", "0.1 rad", 0.1),
        ("terrain.angle", "-10 deg", math.radians(-10)),
        ("duration", "0.5 min", 30.0),
        ("rates.physics", "1 kHz", 1000),
        ("rates.control", "500 Hz", 500),
        ("robot_options.payload_mass", "500 g", 0.5),
        ("gait.velocity", [{"time": "0 s", "v_x": "0.36 km/h"}, {"time": "9 s"}], 0.1),
        ("pushes", [{"time": 1, "force": ["40 N", "0.1 kN", 0]}], (40.0, 100.0, 0.0)),
        ("wbc.arm_swing", 0.5, 0.5),
    ],
)
def test_a_unit_gives_the_number_that_one_would_write(robots, key, written, value):
    for scenario in (
        load(robots, "name: a", f"{key}={written}"),
        load(robots, "name: a", f"{key}={yaml.safe_dump(written)}"),
    ):
        found = scenario
        for part in key.split("."):
            found = getattr(found, part)
        found = found[0].v_x if key == "gait.velocity" else found[0].force if key == "pushes" else found
        assert found == value
        assert type(found) is type(value)


def test_the_scenario_as_run_is_in_si(robots):
    text = scenario_yaml(load(robots, "gait: {step_length: 25 cm, single_support: 700 ms, turn: 3 deg}"))
    gait = yaml.safe_load(text)["gait"]
    assert (gait["step_length"], gait["single_support"], gait["turn"]) == (0.25, 0.7, math.radians(3))
    assert load(robots, text) == load(robots, "gait: {step_length: 0.25, single_support: 0.7, turn: 3 deg}")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "gait: {step_length: 15 deg}",
            "1:21: gait.step_length is '15 deg', an angle; give a length: a number [m], or one",
        ),
        (
            "gait: {single_support: 3 m}",
            "gait.single_support is '3 m', a length; give a time: a number [s], or one with",
        ),
        (
            "gait: {turn: 2 s}",
            "gait.turn is '2 s', a time; give an angle: a number [rad], or one with its unit, rad or",
        ),
        (
            "gait: {step_length: 3 ells}",
            "gait.step_length is '3 ells'; give a length: a number [m], or one with its unit",
        ),
        ("gait: {step_length: '0.2'}", "gait.step_length is '0.2'; give a length: a number [m], or one with its unit"),
        ("gait: {step_length: 1e999 cm}", "gait.step_length is inf; give a finite number"),
        ("gait: {steps: 5 m}", "gait.steps is '5 m'; give a whole number"),
        ("pushes: [{time: 1, force: [40 m, 0, 0]}]", "pushes.0.force.0 is '40 m', a length; give a force"),
        ("rates: {control: 0.1 Hz}", "rates.control is 0.1; give a whole number"),
        ("sensing: {latency: 1 m}", "sensing.latency is '1 m', a length; give a time"),
        ("terrain: {angle: 15}", "terrain.angle is 15; it must be at most 6.3 rad; for 15 deg write '15 deg'"),
        (
            "terrain: {kind: slope, angle: 5}",
            "terrain.angle 5.0 rad is too steep; use at most 0.35 rad; for 5 deg write '5",
        ),
        ("gait: {turn: -15}", "gait.turn is -15; it must be at least -6.3 rad; for -15 deg write '-15 deg'"),
        ("gait: {step_length: 25}", "use at most 0.495 m, or lower gait.com_height; for 25 cm write '25 cm'"),
        (
            "gait: {step_width: 25}",
            "gait.step_width 25.0 m is out of reach of the legs; use for example 0.200 m; for 25 cm",
        ),
        (
            "gait: {com_height: 95}",
            "gait.com_height 95.0 m is out of reach with feet 0.2 m apart; use less than 1.034 m; fo",
        ),
        (
            "gait: {single_support: 700}",
            "gait.single_support is 700; it must be at most 60.0 s; for 700 ms write '700 ms'",
        ),
        ("gait: {swing_height: 5}", "gait.swing_height is 5; it must be at most 0.5 m; for 5 cm write '5 cm'"),
    ],
)
def test_a_wrong_unit_is_said_in_a_sentence(robots, text, said):
    with pytest.raises(ScenarioError) as caught:
        load(robots, text)
    (found,) = caught.value.problems
    assert said in found
    assert found.startswith("f.yaml:1:")


def test_bare_numbers_are_what_they_were(robots):
    assert load(robots, "gait: {step_length: 0.25, steps: 5.0}").gait == Scenario(gait={"step_length": 0.25}).gait


def test_a_time_that_is_possible_and_unlikely_is_a_note(robots):
    pushes = "[{time: 1, duration: 100, force: [1, 0, 0]}, {time: 2, duration: 1, force: [1, 0, 0]}]"
    text = f"gait: {{initial_stand: 500}}\npushes: {pushes}"
    assert notes(Walk(load(robots, text))) == (
        "gait.initial_stand is 500 s; for 500 ms write '500 ms'",
        "pushes.0.duration is 100 s; for 100 ms write '100 ms'",
    )
