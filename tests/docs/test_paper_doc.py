"""docs/paper.md names code and tests that exist."""

import importlib
import re
from pathlib import Path

import pytest

from surefoot.scenarios import catalogue

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")


def exists(name):
    """Whether a dotted name is a module, or leads to something in one."""
    module, parts = "planner", name.split(".")[1:]
    while parts:
        try:
            importlib.import_module(f"{module}.{parts[0]}")
        except ModuleNotFoundError:
            break
        module = f"{module}.{parts.pop(0)}"
    found = importlib.import_module(module)
    for part in parts:
        found = getattr(found, part, None)
    return found is not None


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`(planner\.[a-zA-Z_.]+)`", TEXT)) - {"planner.profile"}))
def test_code_is_there(name):
    assert exists(name)


def test_a_name_that_is_not_there_is_found_out():
    assert not exists("planner.model.dcm.no_such_function")
    assert not exists("planner.no_such_module")


@pytest.mark.parametrize("reference", sorted(set(re.findall(r"`(tests/[^`]+::[^`]+)`", TEXT))))
def test_evidence_is_there(reference):
    file, _, name = reference.partition("::")
    assert re.search(rf"^def {name}\(", (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)


def test_every_erratum_has_evidence():
    rows = re.findall(r"^\| (\d+) \|.*\| (.*) \|$", TEXT, re.MULTILINE)
    assert [int(number) for number, _ in rows] == list(range(1, 21))
    assert all("tests/" in evidence or "page, " in evidence for _, evidence in rows)


def test_scenarios_are_in_the_catalogue():
    named = re.findall(r"`(paper-[a-z-]+|stair-climbing|diagonal-walk)", TEXT)
    assert named
    assert set(named) <= set(catalogue.names())
