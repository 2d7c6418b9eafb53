"""From sensors on tiles that soles tilt on: heights drift there, and soles are turned by what they stand on."""

import pytest

import surefoot
from surefoot.planner.parameters import GroundSearch
from surefoot.scenarios.study.campaigns.campaign import read_campaign
from surefoot.scenarios.study.campaigns.points import cells

pytestmark = pytest.mark.physics

GOOD = "sensing.source=ekf", "sensing.preset=good", "gait=natural"


def survives(seed):
    """Whether a run of the campaign `robustness` does not fall."""
    campaign = read_campaign("robustness", GOOD, seed + 1)
    *_, cell = cells(campaign)
    point = cell.point(seed, {})
    with surefoot.Simulation(surefoot.load(point.base.reference, dict(point.settings))) as simulation:
        while not simulation.done:
            simulation.advance()
        return not simulation.fell


# Of the last, one sole stands on an edge after the walk, and both slip in the estimate.
@pytest.mark.parametrize("seed", [38, 68, 43])
def test_walks_on_tiles_with_loads_and_masses_that_it_is_not_told(seed):
    assert survives(seed)


def test_with_heights_that_are_followed_no_farther_than_2_mm_it_falls(monkeypatch):
    """Negative control: its feet hang over the ground at their touchdown, and the DCM does not wait."""

    def near(search, before, over):
        return over if abs(over) <= search.most_unsure else 0.0

    monkeypatch.setattr(GroundSearch, "astray", near)
    assert not survives(68)
