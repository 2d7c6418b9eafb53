"""A small robot that marches is pushed harder than steps alone catch, and its trunk takes part."""

import pytest
from enough import at_least
from one_walk import pushed, stands

from surefoot.studies.campaigns.campaign import read_campaign

pytestmark = pytest.mark.physics

PUSHES = [
    (impulse, direction)
    for direction, impulses in ((0.0, (1.06, 1.09, 1.12, 1.15)), (2.36, (1.05, 1.08, 1.11, 1.14)))
    for impulse in impulses
]
"""Impulse and direction in mid-swing [N·s/kg, rad]."""


LASTS = 2.0
"""Time after a push within which those fall that do not catch themselves [s]."""


def standing(keys):
    """Tell whether it stands after each of the pushes, eight in all."""
    march = read_campaign("march-ladder").spec.set
    return (stands(simulation, LASTS) for simulation in pushed({**march, **keys}, march["pushes"][0], PUSHES))


def test_hips_turn_the_trunk_where_steps_do_not_reach():
    assert at_least(7, standing({}))


@pytest.mark.parametrize("key", [{"wbc.balance.beyond_catching": 0.0, "wbc.weights.upright_catching": 1.0}])
def test_an_upright_trunk_over_a_zmp_in_the_soles_falls(key):
    """Negative control."""
    assert at_least(6, (not stood for stood in standing(key)))
