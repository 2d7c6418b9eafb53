"""A small robot that walks is pushed hard; single supports of the steps that catch it end as their feet land."""

from dataclasses import replace

import pytest
from enough import at_least
from one_walk import pushed, stands

from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.rules import ends
from surefoot.planner.types import PhaseKind
from surefoot.scenarios.run.controller import Controller
from surefoot.wbc.types import NONE_TOUCHES

pytestmark = pytest.mark.physics

PUSHES = [(0.53, 0.74, 0.17), (0.31, 0.73, -0.13), (0.65, 0.68, 0.07)]
"""Share of the third single support, impulse and direction [-, N·s/kg, rad]."""

LASTS = 2.0
"""Time after a push within which those fall that do not catch themselves [s]."""


class Unfelt(Controller):
    """No foot stands before it is felt."""

    def _touching(self):
        return NONE_TOUCHES


def walks(fraction, impulses, direction, planner=None):
    """Simulations of a walk that is pushed so, as the push begins; arguments as in `PUSHES`."""
    push = {"step": 3, "phase": "single", "fraction": fraction, "duration": 0.1}
    keys = {"robot": "g1", "sensing.source": "truth"}
    return pushed(keys, push, [(impulse, direction) for impulse in impulses], planner)


def standing(planner=None):
    """Tell whether it stands after each of the pushes and their neighbours, six in all."""
    return (
        stands(simulation, LASTS)
        for fraction, middle, direction in PUSHES
        for simulation in walks(fraction, (middle - 0.02, middle + 0.02), direction, planner)
    )


def test_a_step_that_catches_ends_with_its_touchdown():
    assert at_least(5, standing())


def test_steps_that_always_wait_for_their_time_let_it_fall():
    """Negative control."""
    usual = PROFILES["default"]
    waiting = replace(usual, rules=tuple(rule for rule in usual.rules if rule is not ends))
    assert at_least(5, (not stood for stood in standing(waiting)))


def ended_early():
    """Feet that are held from the first tick on of double supports that begin before their time."""
    before, held = None, []
    for simulation in walks(0.53, (0.7,), 0.17):
        end = simulation.time + LASTS
        while not simulation.fell and simulation.time < end:
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
