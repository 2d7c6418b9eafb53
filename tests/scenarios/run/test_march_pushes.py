"""A small robot that marches with quick steps is pushed hard at its torso, and goes on.

The campaign `march-ladder` finds the largest pushes in all directions and phases. Here are some of which it would fall
without a part of its recovery, with some to spare.
"""

import numpy as np
import pytest

import surefoot
from surefoot.studies.campaigns.campaign import read_campaign

pytestmark = pytest.mark.physics


def falls(direction, phase, fraction, impulse, **changed):
    """Return true if it falls, with keys of recovery that are changed."""
    own = {f"planner.recovery.{name}": value for name, value in changed.items()}
    keys = {**read_campaign("march-ladder").spec.set, "duration": 3.0, **own}
    push = {**keys["pushes"][0], "phase": phase, "fraction": fraction, "impulse": impulse, "direction": direction}
    with surefoot.Simulation(surefoot.load("walk-level", {**keys, "pushes": [push]})) as simulation:
        while not simulation.done:
            tick = simulation.step()
            if tick.fell:
                return True
    return False


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
    assert sum(falls(direction, phase, fraction, float(push)) for push in neighbours) <= 1


def test_a_hard_swing_does_not_lift_it_off_its_stance_foot():
    """To the left and backward; with the height held no harder than in the walk it falls after 0.43."""
    assert not falls(2.356, "single", 0.5, 0.5)


@pytest.mark.parametrize("fraction", [0.5, 0.8], ids=["SS 0.5", "SS 0.8"])
def test_a_foot_that_lands_short_of_a_push_to_its_side_goes_on(fraction):
    """To the left, at which the left foot swings; it lands before it can be far enough out."""
    assert not falls(1.571, "single", fraction, 0.4)


def test_a_foot_that_has_just_landed_steps_again():
    """To the right, as the right foot has landed; the left one would have to cross it, and it fell after 0.35."""
    assert not falls(-1.571, "double", 0.5, 0.45)


def test_a_second_step_comes_at_once():
    """Backward and to the right, late in a swing: the foot behind is lifted as the other one lands.

    It bears next to nothing. Double supports of twice the least time take that from the second swing.
    """
    pushes = (0.92, 0.95, 0.98, 1.01, 1.04)
    assert sum(falls(-2.356, "single", 0.8, push) for push in pushes) <= 1
    assert sum(falls(-2.356, "single", 0.8, push, least_double=0.034) for push in pushes) >= 3
