"""Keys `planner.recovery.*` are the planner's own numbers of recovery, one by one."""

from dataclasses import fields

import pytest

import surefoot
from surefoot.planner.parameters import RecoveryParameters
from surefoot.scenarios.file.schema import PlannerSettings
from surefoot.scenarios.setup.walk import resolve
from surefoot.similarity import REFERENCE

pytestmark = pytest.mark.unit

USUAL = RecoveryParameters()


def recovery(**keys):
    given = {f"planner.recovery.{name}": value for name, value in keys.items()}
    return resolve(surefoot.load("walk-level", given)).parameters.recovery


def test_without_a_key_the_numbers_are_the_planners_own():
    assert recovery() == USUAL


@pytest.mark.parametrize("entry", fields(RecoveryParameters), ids=lambda entry: entry.name)
def test_each_number_is_a_key_and_changes_that_number_alone(entry):
    usual = getattr(USUAL, entry.name)
    given = [1.01 * part for part in usual] if isinstance(usual, tuple) else usual + 1
    changed = recovery(**{entry.name: given})
    expected = tuple(given) if isinstance(usual, tuple) else given
    assert [name for name in RecoveryParameters.__slots__ if getattr(changed, name) != getattr(USUAL, name)] == [
        entry.name
    ]
    assert getattr(changed, entry.name) == expected


@pytest.mark.parametrize(("name", "value"), [("lifting", -5.0), ("spanned", 0.0), ("most_steps", 0), ("aside", 1.0)])
def test_what_no_planner_could_use_is_refused(name, value):
    with pytest.raises(surefoot.ScenarioError, match=f"planner.recovery.{name}"):
        recovery(**{name: value})


def test_every_key_says_its_unit():
    inner = PlannerSettings.model_fields["recovery"].annotation.__args__[0]
    assert set(inner.model_fields) == {entry.name for entry in fields(RecoveryParameters)}
    assert all(field.description and "null: " in field.description for field in inner.model_fields.values())


def test_numbers_of_a_file_for_another_robot_are_translated_and_set_ones_literal(tmp_path):
    usual = resolve(surefoot.load("walk-level", {"robot": "g1", "sized_for": "humanoid100"})).parameters.recovery
    file, changes = tmp_path / "sized.yaml", list(USUAL.time_changes)
    file.write_text(
        f"robot: g1\nsized_for: {REFERENCE}\n"
        f"planner: {{recovery: {{least_single: {USUAL.least_single}, time_changes: {changes}}}}}\n"
    )
    found = resolve(surefoot.load(file)).parameters.recovery
    assert found.least_single == pytest.approx(usual.least_single) != USUAL.least_single
    assert found.time_changes == pytest.approx(usual.time_changes)
    set_ = resolve(surefoot.load(file, {"planner.recovery.least_single": 0.2})).parameters.recovery
    assert set_.least_single == 0.2


def test_what_is_the_same_for_all_sizes_is_not_translated(tmp_path):
    file = tmp_path / "sized.yaml"
    file.write_text(f"robot: g1\nsized_for: {REFERENCE}\nplanner: {{recovery: {{lifting: 4.0}}}}\n")
    assert resolve(surefoot.load(file)).parameters.recovery.lifting == 4.0
