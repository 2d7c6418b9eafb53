"""The campaign of the rules leaves out each of them."""

from pathlib import Path

import pytest
import yaml

from surefoot.planner.rules import RULES

pytestmark = pytest.mark.unit

CAMPAIGN = Path(__file__).parents[2] / "docs" / "campaigns" / "rules.yaml"


def test_the_campaign_of_the_rules_leaves_out_each():
    campaign = yaml.safe_load(CAMPAIGN.read_text())
    left_out = [keys.get("planner.without") for keys in campaign["grid"]["mechanism"].values()]
    assert [names[0] for names in left_out if names] == [rule.__name__ for rule in RULES]
