"""Bounds and weights of a law of motion are keys of `planner`, and a law that does not read one refuses it."""

from dataclasses import replace

import pytest

import surefoot
from surefoot.planner import PROFILES
from surefoot.planner.parameters import PlannerParameters
from surefoot.scenarios.file.group import LAW_NUMBERS
from surefoot.scenarios.file.schema import PlannerSettings
from surefoot.scenarios.run.simulation import Simulation
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

PUSHED = {"duration": 4.0, "fidelity": "pendulum", "pushes": [{"time": 2.0, "duration": 0.1, "force": [0, 150, 0]}]}


def parameters(**keys):
    return resolve(surefoot.load("walk-level", {f"planner.{name}": value for name, value in keys.items()})).parameters


@pytest.mark.parametrize("name", LAW_NUMBERS)
def test_each_is_a_key_and_changes_that_number_alone(name):
    usual, changed = parameters(), parameters(**{name: 0.5})
    assert changed == replace(usual, **{name: 0.5}) != usual


@pytest.mark.parametrize("name", LAW_NUMBERS)
def test_null_is_the_profiles_own(name):
    for profile in PROFILES:
        assert getattr(parameters(profile=profile), name) == getattr(PROFILES[profile].parameters, name)


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("name", LAW_NUMBERS)
def test_a_law_takes_what_it_reads_and_refuses_the_rest(profile, name):
    given = {"planner.profile": profile, f"planner.{name}": 20.0}
    if name in PROFILES[profile].numbers:
        assert getattr(resolve(surefoot.load("walk-level", given)).parameters, name) == 20.0
        return
    with pytest.raises(surefoot.ScenarioError, match=rf"planner.{name} with profile '{profile}'.*does not read it"):
        resolve(surefoot.load("walk-level", given))


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("name", LAW_NUMBERS)
def test_a_law_reads_the_numbers_that_its_profile_names_and_no_others(profile, name):
    """A number far from its own moves a pushed pendulum if the profile names it, and else moves nothing."""
    own = getattr(PROFILES[profile].parameters, name)
    far = {"jerk_limit": 0.1, "jerk_rate_limit": 0.02}.get(name, 1e-3 if own == 0.0 else 100.0 * own)
    law = PROFILES[profile].law
    moved = replace(PROFILES[profile], law=lambda given, height: law(replace(given, **{name: far}), height))
    scenario = surefoot.load("walk-level", {**PUSHED, "planner.profile": profile})
    assert (com(scenario, PROFILES[profile]) != com(scenario, moved)) == (name in PROFILES[profile].numbers)


def com(scenario, profile):
    """The CoM of each tick with a profile as its planner, until the push is over."""
    with Simulation(scenario, planner=profile) as simulation:
        return [simulation.step().com.tolist() for _ in range(150)]


@pytest.mark.parametrize(("name", "value"), [("jerk_limit", 0.0), ("step_weight", 0.0), ("jerk_weight", -1.0)])
def test_a_number_out_of_its_range_is_refused(name, value):
    with pytest.raises(surefoot.ScenarioError, match=f"planner.{name}"):
        parameters(**{name: value})


def test_a_weight_of_zero_is_one():
    assert parameters(terminal_weight=0.0, jerk_weight=0.0).terminal_weight == 0.0


def test_numbers_of_a_file_for_another_robot_are_translated(tmp_path):
    usual = resolve(surefoot.load("walk-level", {"robot": "g1"})).parameters
    file = tmp_path / "sized.yaml"
    file.write_text(f"robot: g1\nsized_for: humanoid100\nplanner: {{jerk_weight: {PlannerParameters().jerk_weight}}}\n")
    found = resolve(surefoot.load(file)).parameters
    assert found.jerk_weight == pytest.approx(usual.jerk_weight) != PlannerParameters().jerk_weight


def test_each_is_described_with_its_unit():
    for name in LAW_NUMBERS:
        assert "null: the profile's own" in PlannerSettings.model_fields[name].description
