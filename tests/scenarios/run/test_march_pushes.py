"""A small robot that marches with quick steps is pushed hard at its torso, and goes on.

The campaign `march-ladder` finds the largest pushes in all directions and phases. Here are some of which it would fall
without a part of its recovery, with some to spare.
"""

import numpy as np
import pytest
from enough import at_least
from one_walk import pushed, stands

from surefoot.studies.campaigns.campaign import read_campaign

pytestmark = pytest.mark.physics


LASTS = 1.2
"""Time after a push within which those fall that do not catch themselves [s]."""


def standing(direction, phase, fraction, impulses, **changed):
    """Tell whether it stands after each of some pushes, with keys of recovery that are changed."""
    march = read_campaign("march-ladder").spec.set
    keys = {**march, **{f"planner.recovery.{name}": value for name, value in changed.items()}}
    push = {**march["pushes"][0], "phase": phase, "fraction": fraction}
    ways = [(float(impulse), direction) for impulse in impulses]
    return (stands(simulation, LASTS) for simulation in pushed(keys, push, ways))


@pytest.mark.parametrize(
    ("direction", "phase", "fraction", "impulse"),
    [(0.785, "single", 0.5, 0.35), (-1.571, "double", 0.5, 0.3)],
    ids=["forward left, SS 0.5", "right, DS 0.5"],
)
def test_it_goes_on_after_pushes_that_take_an_ankle_to_its_end(direction, phase, fraction, impulse):
    """After four of five neighbours at least: to the right, one of them swings a foot to and fro until it falls.

    Which one it is changes with any change of the walk: of pushes 0.02 N·s/kg apart it was that of 0.32, and is now
    that of 0.30.
    """
    neighbours = impulse + 0.02 * np.arange(-2.0, 3.0)
    assert at_least(4, standing(direction, phase, fraction, neighbours))


def test_a_hard_swing_does_not_lift_it_off_its_stance_foot():
    """To the left and backward; with the height held no harder than in the walk it falls after 0.43."""
    assert all(standing(2.356, "single", 0.5, (0.5,)))


@pytest.mark.parametrize("fraction", [0.5, 0.8], ids=["SS 0.5", "SS 0.8"])
def test_a_foot_that_lands_short_of_a_push_to_its_side_goes_on(fraction):
    """To the left, at which the left foot swings; it lands before it can be far enough out."""
    assert all(standing(1.571, "single", fraction, (0.4,)))


def test_a_foot_that_has_just_landed_steps_again():
    """To the right, as the right foot has landed; the left one would have to cross it, and it fell after 0.35."""
    assert all(standing(-1.571, "double", 0.5, (0.45,)))


def test_a_second_step_comes_at_once():
    """Backward and to the right, late in a swing: the foot behind is lifted as the other one lands.

    It bears next to nothing. Double supports of twice the least time take that from the second swing.
    """
    pushes = (0.92, 0.95, 0.98, 1.01, 1.04)
    assert at_least(4, standing(-2.356, "single", 0.8, pushes))
    slow = standing(-2.356, "single", 0.8, pushes, least_double=0.034)
    assert at_least(3, (not stood for stood in slow))
