"""A small robot that walks is pushed hard; single supports of the steps that catch it end as their feet land."""

from dataclasses import replace

import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.rules import ends
from surefoot.planner.types import PhaseKind
from surefoot.scenarios.run.controller import Controller
from surefoot.wbc.types import NONE_TOUCHES

pytestmark = pytest.mark.physics

PUSHES = [
    (fraction, impulse, direction)
    for fraction, middle, direction in ((0.53, 0.74, 0.17), (0.31, 0.73, -0.13), (0.65, 0.68, 0.07))
    for impulse in (middle - 0.02, middle + 0.02)
]
"""Share of the third single support, impulse and direction [-, N·s/kg, rad]."""


class Unfelt(Controller):
    """No foot stands before it is felt."""

    def _touching(self):
        return NONE_TOUCHES


def pushed(fraction, impulse, direction, planner=None):
    """A walk that is pushed so; arguments as in `PUSHES`."""
    push = {"step": 3, "phase": "single", "fraction": fraction, "duration": 0.1}
    push |= {"impulse": impulse, "direction": direction}
    keys = {"robot": "g1", "sensing.source": "truth", "criteria": {"fell": False}, "duration": 6.5}
    return surefoot.Simulation(surefoot.load("walk-level", {**keys, "pushes": [push]}), planner=planner)


def falls(planner=None):
    """Number of the pushes that felled it."""
    fallen = 0
    for fraction, impulse, direction in PUSHES:
        with pushed(fraction, impulse, direction, planner) as simulation:
            while not (simulation.done or simulation.fell):
                simulation.step()
            fallen += simulation.fell
    return fallen


def test_a_step_that_catches_ends_with_its_touchdown():
    assert falls() <= 1


def test_steps_that_always_wait_for_their_time_let_it_fall():
    """Negative control."""
    usual = PROFILES["default"]
    assert falls(replace(usual, rules=tuple(rule for rule in usual.rules if rule is not ends))) >= 5


def ended_early():
    """Feet that are held from the first tick on of double supports that begin before their time."""
    before, held = None, []
    with pushed(0.53, 0.7, 0.17) as simulation:
        while not (simulation.done or simulation.fell):
            tick = simulation.step()
            swung = before is not None and before.kind is PhaseKind.SINGLE and before.left > 0.03
            if swung and tick.plan.phase.kind is PhaseKind.DOUBLE:
                held.append(tick.report.active)
            before = tick.plan.phase
    return held


def test_a_foot_that_the_planner_takes_as_landed_is_held_at_once():
    held = ended_early()
    assert held and all(all(feet) for feet in held)


def test_of_what_nobody_tells_the_foot_is_held_once_it_is_felt(monkeypatch):
    """Negative control."""
    monkeypatch.setattr("surefoot.scenarios.run.full.Controller", Unfelt)
    assert not all(all(feet) for feet in ended_early())
