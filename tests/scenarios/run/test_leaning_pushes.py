"""A small robot that marches is pushed harder than steps alone catch, and its trunk takes part."""

import pytest

import surefoot
from surefoot.studies.campaigns.campaign import read_campaign

pytestmark = pytest.mark.physics

PUSHES = [
    (impulse, direction)
    for direction, impulses in ((0.0, (1.06, 1.09, 1.12, 1.15)), (2.36, (1.05, 1.08, 1.11, 1.14)))
    for impulse in impulses
]
"""Impulse and direction in mid-swing [N·s/kg, rad]."""


def falls(keys):
    """Number of the pushes that felled it."""
    fallen, march = 0, read_campaign("march-ladder").spec.set
    for impulse, direction in PUSHES:
        push = {**march["pushes"][0], "impulse": impulse, "direction": direction}
        with surefoot.Simulation(surefoot.load("walk-level", {**march, **keys, "pushes": [push]})) as simulation:
            while not (simulation.done or simulation.fell):
                simulation.step()
            fallen += simulation.fell
    return fallen


def test_hips_turn_the_trunk_where_steps_do_not_reach():
    assert falls({}) <= 1


@pytest.mark.parametrize("key", [{"wbc.balance.beyond_catching": 0.0, "wbc.weights.upright_catching": 1.0}])
def test_an_upright_trunk_over_a_zmp_in_the_soles_falls(key):
    """Negative control."""
    assert falls(key) >= 6
