"""A small robot that walks is pushed hard at its torso, catches itself with a long step, and goes on."""

import math

import pytest

import surefoot
from surefoot.planner.steps import adaptation
from surefoot.wbc.qp import solvers
from surefoot.wbc.types import SolveStatus

pytestmark = pytest.mark.physics


def pushed(impulse, direction):
    """True if it falls of a push late in its third step, and the number of ticks at which its QP dropped all limits."""
    push = {"step": 3, "phase": "single", "fraction": 0.65, "duration": 0.1}
    push |= {"impulse": impulse, "direction": direction}
    keys = {"robot": "g1", "sensing.source": "truth", "criteria": {"fell": False}, "duration": 6.0, "pushes": [push]}
    dropped = 0
    with surefoot.Simulation(surefoot.load("walk-level", keys)) as simulation:
        while not simulation.done:
            tick = simulation.step()
            dropped += tick.report.status is SolveStatus.EQUALITIES_ONLY
            if tick.fell:
                return True, dropped
    return False, dropped


@pytest.mark.parametrize("direction", [0.25, -0.3])
def test_a_long_step_does_not_throw_it_as_it_lands(direction):
    """At least four of five neighbours stand, and none of them meets a QP whose limits are all dropped."""
    runs = [pushed(impulse, direction) for impulse in (0.55, 0.58, 0.61, 0.64, 0.67)]
    assert sum(fell for fell, _ in runs) <= 1
    assert not any(dropped for fell, dropped in runs if not fell)


def falls_around(adaptation, directions):
    """Number of walks that fall of a push of 0.4 N·s/kg from good sensors, each in another phase of its step."""
    fallen = 0
    for n in directions:
        phase, fraction = (("double", 0.5), ("single", 0.2), ("single", 0.5), ("single", 0.8))[n % 4]
        push = {"step": 5, "phase": phase, "fraction": fraction, "duration": 0.1}
        push |= {"impulse": 0.4, "direction": n * math.pi / 4.0}
        keys = {"robot": "g1", "gait.steps": 10, "pushes": [push], "criteria": {"fell": False}, "seed": n % 3}
        keys |= {"sensing.source": "ekf", "sensing.preset": "good", "planner.step_adaptation": adaptation}
        fallen += surefoot.run(surefoot.load("walk-level", keys)).verdict.metrics["fell"] > 0
    return fallen


def test_half_the_pushes_of_the_walking_ladder_do_not_fell_it_anywhere_around_the_compass():
    """The campaign `walk-ladder` has all directions in all phases; of one in hundreds a walk falls all the same."""
    assert falls_around("crossing", range(8)) <= 1
    # Negative control.
    assert falls_around("none", range(0, 8, 2)) >= 3


NEVER, SLOW = 1e-6, 0.034
"""Value of `again_cost` with which no foot that has landed steps again [-]; twice the least double support [s]."""


def falls_in_double_support(**recovery):
    """Number of three pushes that fell it, to the right as the right foot has landed."""
    fallen = 0
    for impulse in (0.5, 0.55, 0.6):
        push = {"step": 5, "phase": "double", "fraction": 0.05, "duration": 0.1}
        push |= {"impulse": impulse, "direction": -1.33}
        keys = {"robot": "g1", "gait.steps": 8, "pushes": [push], "criteria": {"fell": False}}
        keys |= {"sensing.source": "truth", **{f"planner.recovery.{name}": value for name, value in recovery.items()}}
        fallen += surefoot.run(surefoot.load("walk-level", keys)).verdict.metrics["fell"] > 0
    return fallen


def test_a_foot_that_landed_steps_again_after_a_push_aside():
    """Double supports are slow: after quicker ones the other foot crosses in time."""
    assert falls_in_double_support() == falls_in_double_support(least_double=SLOW) == 0
    # Negative control.
    assert falls_in_double_support(least_double=SLOW, again_cost=NEVER) >= 2


def test_with_a_heel_rolled_in_no_time_and_soles_held_at_any_price_the_qp_drops_all_limits(monkeypatch):
    """Negative control."""
    monkeypatch.setattr(adaptation, "with_roll", lambda schedule, *_: schedule)
    held = property(lambda solver: False, lambda solver, value: None)
    monkeypatch.setattr(solvers.Daqp, "_lets_go", held, raising=False)
    assert all(pushed(impulse, 0.25)[1] for impulse in (0.67, 0.7, 0.73))
