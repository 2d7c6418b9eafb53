"""Walks on tiles that soles tilt on, with loads and masses that nobody tells: they are survived, and they end."""

from dataclasses import replace

import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.parameters import GroundSearch
from surefoot.planner.rules import ends, may_end
from surefoot.planner.steps import adaptation
from surefoot.planner.track import ended
from surefoot.planner.types import PhaseKind
from surefoot.studies.campaigns.campaign import read_campaign
from surefoot.studies.campaigns.points import cells

pytestmark = pytest.mark.physics

GOOD = "sensing.source=ekf", "sensing.preset=good", "gait=natural"
SMALL = "sensing.source=truth", "gait=paper"


def walked(seed, settings, planner=None):
    """A run of the campaign `robustness` to its end: whether it has not fallen, and its last phase."""
    *_, (stands, phase) = ((not tick.fell, tick.plan.phase) for tick in ticks(seed, settings, planner))
    return stands, phase


def ticks(seed, settings, planner=None):
    """The ticks of a run of the campaign `robustness`."""
    campaign = read_campaign("robustness", settings, seed + 1)
    *_, cell = cells(campaign)
    point = cell.point(seed, {})
    with surefoot.Simulation(surefoot.load(point.base.reference, dict(point.settings)), planner=planner) as simulation:
        while not simulation.done:
            yield simulation.step()


# Of the third, a sole stands on an edge after the walk, and both slip in the estimate.
@pytest.mark.parametrize("seed", [38, 68, 43, 76])
def test_walks_on_tiles_with_loads_and_masses_that_it_is_not_told(seed):
    assert walked(seed, GOOD)[0]


def caught():
    """Ticks of two walks in which a step is adapted to catch the body."""
    return sum(tick.plan.balance.catching for seed in (55, 68) for tick in ticks(seed, GOOD))


def test_with_heights_that_are_followed_no_farther_than_2_mm_it_has_to_catch_itself(monkeypatch):
    """Negative control: its feet hang over the ground at their touchdown, and the DCM does not wait."""

    def near(search, before, over):
        return over if abs(over) <= search.most_unsure else 0.0

    usual = caught()
    monkeypatch.setattr(GroundSearch, "astray", near)
    assert caught() > 3 * usual


def test_it_stands_over_its_feet_and_not_over_where_they_once_landed(monkeypatch):
    """They creep by a third of a metre in the estimate while it stands on an edge."""
    assert walked(42, GOOD)[1].kind is PhaseKind.STAND
    # Negative control: the body is held to that place, and goes over its feet.
    monkeypatch.setattr(adaptation, "with_feet_slid", lambda schedule, *_: schedule)
    assert walked(42, GOOD)[1].kind is not PhaseKind.STAND


def test_small_feet_that_land_early_do_not_step_on_the_spot():
    """On tiles a foot lands early, with the DCM short of it; the single support of a step that catches goes on then."""
    seeds = 91, 95, 131
    runs = [walked(seed, SMALL) for seed in seeds]
    assert all(stood and phase.kind is PhaseKind.STAND for stood, phase in runs)

    def at_once(view):
        return view.of(ended(view.state, view.measured)) if may_end(view) else view

    # Negative control: it ends with its touchdown, and a step on the spot asks for the next one. Where double supports
    # were put off in every plan, too, that went on for ever.
    usual = PROFILES["default"]
    eager = replace(usual, rules=tuple(at_once if rule is ends else rule for rule in usual.rules))
    on_the_spot = [walked(seed, SMALL, eager)[1] for seed in seeds]
    more = (one.step - phase.step for one, (_, phase) in zip(on_the_spot, runs, strict=True))
    assert sum(steps >= 2 for steps in more) >= 2
