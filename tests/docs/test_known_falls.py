"""The first line of `surefoot inspect` names the cause of falls whose cause is known."""

import importlib.util
from pathlib import Path

import pytest

from surefoot.studies.campaigns.campaign import read_campaign

FOLDER = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def known():
    spec = importlib.util.spec_from_file_location("known_falls", FOLDER / "known_falls.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def falls(known):
    """Keys of the falls of each campaign, by case."""
    paths = (str(FOLDER / "campaigns" / f"{campaign}.yaml") for campaign in known.CAMPAIGNS)
    return [read_campaign(path).spec.grid["fall"] for path in paths]


@pytest.mark.physics
@pytest.mark.long
@pytest.mark.parametrize(
    ("campaign", "least"), [("known-falls", 18), ("known-falls-held-out", 18), ("known-falls-mixed", 11)]
)
def test_the_first_line_is_right(known, campaign, least, tmp_path):
    found = list(known.falls(campaign, tmp_path))
    wrong = [fall for fall in found if not fall.right]
    assert len(found) - len(wrong) >= least, wrong


@pytest.mark.unit
def test_falls_are_of_six_causes_and_three_robots(falls):
    kinds = {"push", "friction", "sensors", "gains", "mass", "late_commands"}
    for cases, count in zip(falls, (20, 20, 12), strict=True):
        assert len(cases) == count
        assert {case.partition(",")[0].replace(" ", "_") for case in cases} >= kinds - {"gains"}
        assert {keys.get("robot", "humanoid100") for keys in cases.values()} == {"humanoid100", "g1", "talos"}


@pytest.mark.unit
def test_the_kept_result_is_of_these_falls(known, falls):
    lines = known.KEPT.read_text(encoding="utf-8").splitlines()[2:]
    cases = [case for grid in falls for case in grid]
    kept = known.rows()
    assert len(lines) == 1 + len(kept)
    assert [row["case"] for row in kept] == cases
