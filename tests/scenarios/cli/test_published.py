"""The printed schema and what is said of keys: the same, kept or made anew, whatever other packages are installed."""

import json

import pytest

from surefoot.scenarios.cli import published as printed
from surefoot.scenarios.cli.starter import starter
from surefoot.scenarios.file.registries import TERRAIN_KINDS
from surefoot.scenarios.judge.metrics import METRICS, OWN
from surefoot.scenarios.setup.checks.criteria import published
from surefoot.scenarios.setup.terrain import KINDS

pytestmark = pytest.mark.unit


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    """A cache folder of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def test_the_schema_is_the_published_one_made_or_kept():
    assert [json.loads(printed.schema_text()) for _ in range(2)] == [published()] * 2, "run python docs/texts.py"


def test_what_another_package_brings_is_in_it_though_one_was_kept(monkeypatch):
    kept = printed.schema_text()
    KINDS.add("dunes", KINDS["flat"])
    try:
        assert "dunes" in TERRAIN_KINDS
        assert '"dunes"' in printed.schema_text()
        assert '"dunes"' not in kept
    finally:
        KINDS.discard("dunes")
    assert printed.schema_text() == kept


def test_a_metric_of_another_package_is_in_it():
    METRICS.add("softness", OWN["fell"])
    try:
        assert json.loads(printed.schema_text()) == published()
    finally:
        METRICS.discard("softness")


def test_a_scenario_to_start_from_is_the_same_kept():
    assert starter("walk") == starter("walk")
    assert "# footsteps to take" in starter("walk")
