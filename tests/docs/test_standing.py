"""docs/standing.md: quotations have a source."""

import re
from pathlib import Path

import pytest
import yaml

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]


def test_every_quotation_has_a_source_and_says_what_it_is_of():
    quoted = yaml.safe_load((ROOT / "docs" / "field.yaml").read_text(encoding="utf-8"))
    assert len(quoted) >= 8
    for row in quoted:
        assert set(row) == {"what", "who", "value", "evidence", "source"}
        assert re.match(r"[\d.]+ \S", row["value"])
        assert re.search("simulation|hardware", row["evidence"])
