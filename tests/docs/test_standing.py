"""docs/standing.md: quotations have a source, and the pushes are the goals that the tests run."""

import ast
import importlib.util
import re
from pathlib import Path

import pytest
import yaml

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def goals():
    """Of the natural gait by phase: forward, left, backward, right [N·s/kg]."""
    tree = ast.parse((ROOT / "tests/scenarios/run/test_push_tables.py").read_text(encoding="utf-8"))
    (found,) = [n.value for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "NATURAL_GOALS"]
    return ast.literal_eval(found)


def test_the_pushes_are_the_goals_that_the_tests_run():
    spec = importlib.util.spec_from_file_location("reference", ROOT / "docs" / "reference.py")
    reference = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(reference)
    wanted = goals()
    forward, left, backward, right = wanted["SS 0.5"]
    rows = {phase: tuple(map(float, cells)) for phase, cells in reference.standing.push_rows().items()}
    assert rows["in mid-swing"] == (forward, backward, left, right)
    worst = tuple(min(column) for column in zip(*wanted.values(), strict=True))
    assert rows["at any time"] == (worst[0], worst[2], worst[1], worst[3])
    page = (ROOT / "docs" / "recovery-results.md").read_text(encoding="utf-8")
    for phase, told in re.findall(r"(?m)^\| (DS 0.5|SS 0.[258]) \| ([\d.]+ \| [\d.]+ \| [\d.]+ \| [\d.]+) \|$", page):
        assert tuple(map(float, told.split(" | "))) == wanted[phase]


def test_every_quotation_has_a_source_and_says_what_it_is_of():
    quoted = yaml.safe_load((ROOT / "docs" / "field.yaml").read_text(encoding="utf-8"))
    assert len(quoted) >= 8
    for row in quoted:
        assert set(row) == {"what", "who", "value", "evidence", "source"}
        assert re.match(r"[\d.]+ \S", row["value"])
        assert re.search("simulation|hardware", row["evidence"])
