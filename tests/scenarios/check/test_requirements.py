"""Requirements against their state: none passes of which a scenario was not run, or was not measured."""

import itertools
from dataclasses import replace
from typing import get_args
from xml.etree import ElementTree as Xml

import pytest

from surefoot.scenarios.check import report
from surefoot.scenarios.check.check import PASSING, CheckStatus, cases, run_case
from surefoot.scenarios.check.pictures import Gallery
from surefoot.scenarios.check.requirements import Requirements, RequirementState, Shown, table

pytestmark = pytest.mark.unit

STATES = get_args(RequirementState)

STROLL = """
name: stroll
fidelity: pendulum
gait: {steps: 0}
duration: 0.5
criteria: {fell: false}
requirements: [REQ-7, REQ-8]
"""


@pytest.fixture
def stroll(tmp_path):
    """The check of a scenario that names two requirements."""
    (tmp_path / "stroll.yaml").write_text(STROLL)
    return run_case(*cases([str(tmp_path / "stroll.yaml")]), tmp_path / "runs")


def test_a_state_is_the_worst_of_all_scenarios_that_name_it():
    for states in itertools.product(STATES, repeat=3):
        shown = [Shown(str(number), ("REQ-7",), state, state) for number, state in enumerate(states)]
        (found,) = table(shown)
        assert found.state == min(states, key=STATES.index)
        assert (found.state == "pass") == (set(states) == {"pass"})


def test_only_a_run_that_passed_is_a_pass(stroll):
    for status in get_args(CheckStatus):
        one, other = Requirements.of([replace(stroll, status=status)]).table
        assert (one.state == "pass") == (status in PASSING and status != "not decided"), status
        assert other.state == one.state
    assert Requirements.of([replace(stroll, status="moved")]).table[0].state == "fail"
    assert Requirements.of([replace(stroll, status="could not run")]).table[0].state == "not measured"


def test_a_scenario_beside_it_that_was_not_run_is_told_and_so_is_one_that_cannot_be_read(stroll, tmp_path):
    passed = replace(stroll, status="same")
    assert [one.state for one in Requirements.of([passed]).table] == ["pass", "pass"]
    (tmp_path / "amble.yaml").write_text(STROLL.replace("stroll", "amble").replace("REQ-8", "REQ-9"))
    found = Requirements.of([passed])
    assert [(one.name, one.state, one.by) for one in found.table] == [
        ("REQ-7", "not run", "amble (not run), stroll (same)"),
        ("REQ-8", "pass", "stroll (same)"),
        ("REQ-9", "not run", "amble (not run)"),
    ]
    (tmp_path / "bad.yaml").write_text(STROLL.replace("steps", "stepps"))
    (note,) = Requirements.of([passed]).notes
    assert "bad.yaml" in note and note.endswith("unknown key 'stepps', so nobody knows its requirements")


def test_reports_have_them_and_those_of_a_scenario_without_are_as_they_were(stroll, tmp_path):
    (case,) = Xml.fromstring(report.junit([stroll]))
    assert [one.attrib for one in case.iter("property")] == [
        {"name": "requirement", "value": "REQ-7"},
        {"name": "requirement", "value": "REQ-8"},
    ]
    shown = Requirements.of([replace(stroll, status="failed")])
    assert "| REQ-7 | ❌ fail | stroll (failed) |" in report.markdown([stroll], shown, Gallery())
    (tmp_path / "stroll.yaml").write_text(STROLL.replace("requirements: [REQ-7, REQ-8]", ""))
    plain = run_case(*cases([str(tmp_path / "stroll.yaml")]), tmp_path / "runs")
    assert b"propert" not in report.junit([plain])
    assert "equirement" not in report.markdown([plain], Requirements.of([plain]), Gallery())


def test_they_do_not_shape_the_run_so_a_baseline_holds_with_others(stroll):
    assert "REQ" not in stroll.case.settings
