"""docs/glossary.md is in order, and names code that exists."""

import re
from pathlib import Path

import pytest
from dotted import named

pytestmark = pytest.mark.unit

TEXT = (Path(__file__).parents[2] / "docs" / "glossary.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line.strip("|").split("|")] for line in re.findall(r"(?m)^\| (?!term).*\|$", TEXT)]


def test_terms_are_in_order_with_a_meaning_and_a_place():
    assert len(ROWS) > 40
    terms = [row[0].lower() for row in ROWS]
    assert terms == sorted(set(terms))
    assert all(len(row) == 4 and row[1] and row[3] for row in ROWS)


@pytest.mark.parametrize("name", sorted({name for row in ROWS for name in re.findall(r"`([\w.]+)`", row[3])}))
def test_code_is_there(name):
    assert named(name) is not None
