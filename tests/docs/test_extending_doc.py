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
