"""Walks on tiles that soles tilt on, with loads and masses that nobody tells: they are survived, and they end."""

from dataclasses import replace

import pytest
from enough import at_least

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


SETTLED = 2.0
"""Time for which a walk that has ended has to stand [s]."""


def simulation_of(seed, settings, planner=None):
    """A run of the campaign `robustness`."""
    campaign = read_campaign("robustness", settings, seed + 1)
    *_, cell = cells(campaign)
    point = cell.point(seed, {})
    return surefoot.Simulation(surefoot.load(point.base.reference, dict(point.settings)), planner=planner)


def ticks(seed, settings, planner=None):
    """Ticks of a run of the campaign `robustness`, one for each plan, and the last one."""
    with simulation_of(seed, settings, planner) as simulation:
        rates = simulation.walk.rates
        while not simulation.done:
            for _ in range(rates.control // rates.planner):
                if not simulation.done:
                    simulation.advance()
            yield simulation.look()


def until_settled(ticks):
    """Ticks until the walk has ended and stood for a while, or the last one."""
    for tick in ticks:
        yield tick
        phase = tick.plan.phase
        if phase.kind is PhaseKind.STAND and phase.step > 0 and phase.elapsed > SETTLED:
            return


@pytest.fixture(scope="module")
def usual():
    """Tell of walks, by seed, whether they stand in the end, and the plans in which a step catches the body."""
    found = {}
    for seed in (38, 55, 68, 76):
        catching = 0
        for tick in until_settled(ticks(seed, GOOD)):
            catching += tick.plan.balance.catching
        found[seed] = not tick.fell and tick.plan.phase.kind is PhaseKind.STAND, catching
    return found


@pytest.mark.parametrize("seed", [38, 55, 68, 76])
def test_walks_on_tiles_with_loads_and_masses_that_it_is_not_told(seed, usual):
    stands, _ = usual[seed]
    assert stands


def test_it_stands_on_an_edge_where_both_soles_slip_in_the_estimate():
    """After its walk."""
    *_, last = ticks(43, GOOD)
    assert not last.fell


def test_with_heights_that_are_followed_no_farther_than_2_mm_it_has_to_catch_itself(usual, monkeypatch):
    """Negative control: its feet hang over the ground at their touchdown, and the DCM does not wait."""

    def near(search, before, over):
        return over if abs(over) <= search.most_unsure else 0.0

    seeds = 55, 68
    monkeypatch.setattr(GroundSearch, "astray", near)
    more = 1 + 3 * sum(usual[seed][1] for seed in seeds)
    assert at_least(more, (tick.plan.balance.catching for seed in seeds for tick in ticks(seed, GOOD)))


def test_it_stands_over_its_feet_and_not_over_where_they_once_landed(monkeypatch):
    """They creep by a third of a metre in the estimate while it stands on an edge."""

    def stays(simulation):
        while not simulation.done:
            simulation.advance()
        return simulation.look().plan.phase.kind is PhaseKind.STAND

    with simulation_of(42, GOOD) as simulation:
        phase = simulation.step().plan.phase
        while phase.step == 0 or phase.kind is not PhaseKind.STAND:
            phase = simulation.step().plan.phase
        ended = simulation.save()
        assert stays(simulation)
        # Negative control: the body is held to that place, and goes over its feet.
        simulation.restore(ended)
        monkeypatch.setattr(adaptation, "with_feet_slid", lambda schedule, *_: schedule)
        assert not stays(simulation)


def test_small_feet_that_land_early_do_not_step_on_the_spot():
    """On tiles a foot lands early, with the DCM short of it; the single support of a step that catches goes on then."""

    def at_once(view):
        return view.of(ended(view.state, view.measured)) if may_end(view) else view

    # Negative control: it ends with its touchdown, and a step on the spot asks for the next one. Where double supports
    # were put off in every plan, too, that went on for ever.
    usual = PROFILES["default"]
    eager = replace(usual, rules=tuple(at_once if rule is ends else rule for rule in usual.rules))

    def on_the_spot(seed, steps):
        return any(tick.plan.phase.step >= steps + 2 for tick in ticks(seed, SMALL, eager))

    steps = {}
    for seed in (91, 95, 131):
        *_, last = until_settled(ticks(seed, SMALL))
        assert not last.fell and last.plan.phase.kind is PhaseKind.STAND
        steps[seed] = last.plan.phase.step
    assert at_least(2, (on_the_spot(*walk) for walk in steps.items()))
