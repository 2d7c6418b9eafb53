"""The page of recovery tells of each rule what its first sentence says, in their order."""

import inspect
import re
from pathlib import Path

import pytest
import yaml

from surefoot.planner.rules import RULES

pytestmark = pytest.mark.unit

PAGE = Path(__file__).parents[2] / "docs" / "recovery.md"


def test_the_rules_are_told_in_their_order():
    section = PAGE.read_text().split("## The rules in their order")[1].split("\n## ")[0]
    told = re.findall(r"^\| `(\w+)` \| (.+) \|$", section, re.M)
    assert told == [(rule.__name__, inspect.getdoc(rule).splitlines()[0]) for rule in RULES]


def test_the_campaign_of_the_rules_leaves_out_each():
    campaign = yaml.safe_load((PAGE.parent / "campaigns" / "rules.yaml").read_text())
    left_out = [keys.get("planner.without") for keys in campaign["grid"]["mechanism"].values()]
    assert [names[0] for names in left_out if names] == [rule.__name__ for rule in RULES]
