"""docs/paper.md names code and tests that exist."""

import inspect
import re
from pathlib import Path

import pytest
from dotted import named

from surefoot.scenarios import catalogue

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`(planner\.[a-zA-Z_.]+)`", TEXT)) - {"planner.profile"}))
def test_code_is_there(name):
    assert named(name) is not None


def test_a_name_that_is_not_there_is_found_out():
    assert named("planner.model.dcm.no_such_function") is None
    assert named("planner.no_such_module") is None


@pytest.mark.parametrize("reference", sorted(set(re.findall(r"`(tests/[^`]+::[^`]+)`", TEXT))))
def test_evidence_is_there(reference):
    file, _, name = reference.partition("::")
    assert re.search(rf"^def {name}\(", (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)


def test_every_erratum_has_evidence():
    rows = re.findall(r"^\| (\d+) \|.*\| (.*) \|$", TEXT, re.MULTILINE)
    assert [int(number) for number, _ in rows] == list(range(1, 21))
    assert all("tests/" in evidence or "page, " in evidence for _, evidence in rows)


EQUATIONS = range(1, 16)
LABELS = (
    r"lipm|statespace_lipm|statespace_lipm_disc|lipm_disc2|ComplexForm_Predictive|ComplexForm_matrix|costfunction"
    r"|param_constraint|pridection_tv|param_pridection_tv|zmpEquation|dcm_at_end|z_traj"
)


def rows_of(number):
    """The code that the page names for an equation."""
    rows = re.findall(r"^\| (\(\d+\)(?:, \(\d+\))*) \|[^|]*\|([^|]*)\|", TEXT, re.MULTILINE)
    return [re.findall(r"`(planner\.[a-zA-Z_.]+)`", code) for numbers, code in rows if f"({number})" in numbers]


@pytest.mark.parametrize("number", EQUATIONS)
def test_every_equation_is_on_the_page_and_at_its_code(number):
    """Code that a row names says in a docstring which equation it is."""
    rows = rows_of(number)
    assert rows
    for names in rows:
        assert any(f"eq. ({number})" in (inspect.getdoc(named(name)) or "") for name in names), names


def test_no_label_of_the_manuscript_is_left():
    code = (file for folder in ("planner", "scenarios", "studies", "apps") for file in (ROOT / folder).rglob("*.py"))
    texts = [*code, *(ROOT / "docs").glob("*.md")]
    for file in texts:
        text = file.read_text(encoding="utf-8")
        assert not re.findall(rf"\b(?:{LABELS})\b|\b[Ee]qs?\. [a-zA-Z]", text), file


def test_scenarios_are_in_the_catalogue():
    named = re.findall(r"`(paper-[a-z-]+|stair-climbing|diagonal-walk)", TEXT)
    assert named
    assert set(named) <= set(catalogue.names())
