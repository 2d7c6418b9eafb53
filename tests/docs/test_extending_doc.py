"""docs/extending.md names what is there: protocols, functions, arguments, keys. Its code is run in tests/packaging."""

import inspect
import re
from pathlib import Path

import pytest
from dotted import named

import surefoot
from surefoot.scenarios.file.registries import REGISTRIES
from surefoot.scenarios.file.schema import Scenario

pytestmark = pytest.mark.unit

TEXT = (Path(__file__).parents[2] / "docs" / "extending.md").read_text(encoding="utf-8")
ROOT = Path(__file__).parents[2]
_TABLE = TEXT.split("<!-- inside -->")[1].split("<!-- end -->")[0]
INSIDE = [line.strip("| ").split(" | ") for line in _TABLE.splitlines()[3:]]
ROWS = [line.strip("| ").split(" | ") for line in TEXT.splitlines() if line.startswith("| ") and line.count("|") == 6][
    1:
]


def test_there_is_a_row_for_every_key_that_names_a_part():
    keys = {key for row in ROWS for key in re.findall(r"`([a-z.]+)`", row[-1])}
    assert keys == {".".join(map(str, key)) for key in REGISTRIES}
    for key in keys:
        assert key.partition(".")[0] in Scenario.model_fields


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_what_a_row_names_is_there(row):
    protocol, python = row[1], row[2]
    for name in re.findall(r"`([a-z_.]+\.[A-Za-z]+)`", protocol):
        assert named(name) is not None
    for call, argument in re.findall(r"`(\w+)\((\w+)=\)`", python):
        assert argument in inspect.signature(getattr(surefoot, call)).parameters
    for call in re.findall(r"`((?:\w+\.)+(?:register|KINDS))", python):
        assert named(call) is not None
    title = re.search(r"\]\(#([a-z-]+)\)", row[0])
    titles = {head.lower().replace("'", "").replace(" ", "-") for head in re.findall(r"(?m)^## (.*)$", TEXT)}
    assert title is None or title[1] in titles


@pytest.mark.parametrize("row", INSIDE, ids=lambda row: row[0])
def test_what_is_to_be_touched_inside_the_package_is_there(row):
    _, change, then = row
    places = re.findall(r"`([\w/.]+)`", change)
    assert [place for place in places if "/" in place and not (ROOT / place).exists()] == []
    assert "`make texts`" in then and re.search(r"(?m)^texts:", (ROOT / "Makefile").read_text(encoding="utf-8"))


def test_the_registries_with_parts_of_this_package_have_a_row_for_these():
    """A list of parts stands in a file that a row names."""
    named = {place for _, change, _ in INSIDE for place in re.findall(r"`([\w/]+\.py)`", change)}
    for registry in (*REGISTRIES.values(),):
        sources = [path for path in named if f'"{registry.group}"' in (ROOT / path).read_text(encoding="utf-8")]
        assert len(sources) == 1 or registry.group == "surefoot.robots", registry.group
