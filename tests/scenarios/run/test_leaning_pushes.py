"""A small robot that walks is pushed harder than steps alone catch, and its trunk takes part."""

import pytest

import surefoot

pytestmark = pytest.mark.physics

PUSHES = [
    (3, "single", 0.43, 0.7, 1.11),
    (4, "single", 0.56, 0.74, 0.79),
    (4, "single", 0.67, 0.73, 1.04),
    (3, "single", 0.18, 0.73, 0.66),
    (3, "single", 0.19, 0.69, 0.82),
]
"""Step, phase, share of it, impulse and direction [-, N·s/kg, rad]."""


def falls(keys):
    """How many of the pushes fell it."""
    fallen = 0
    for step, phase, fraction, impulse, direction in PUSHES:
        push = {"step": step, "phase": phase, "fraction": fraction, "impulse": impulse, "direction": direction}
        given = {"robot": "g1", "sensing.source": "truth", "criteria": {"fell": False}, "duration": 6.5, **keys}
        with surefoot.Simulation(surefoot.load("walk", {**given, "pushes": [push | {"duration": 0.1}]})) as simulation:
            while not (simulation.done or simulation.fell):
                simulation.step()
            fallen += simulation.fell
    return fallen


def test_hips_turn_the_trunk_where_steps_do_not_reach():
    assert falls({}) <= 1


@pytest.mark.parametrize("key", [{"wbc.balance.beyond_catching": 0.0, "wbc.weights.upright_catching": 1.0}])
def test_an_upright_trunk_over_a_zmp_in_the_soles_falls(key):
    """Negative control."""
    assert falls(key) >= 4
