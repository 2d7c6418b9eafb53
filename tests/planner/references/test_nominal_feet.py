import numpy as np
import pytest

from surefoot.planner.references.nominal_feet import NominalFeet
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import PhaseKind

pytestmark = pytest.mark.unit


def moved_soles(samples, schedule):
    """Centres of both soles over a window, shape (2, n, 3)."""
    feet = NominalFeet(len(samples.clock))
    feet.move(len(samples.clock), samples, schedule, (np.eye(2), np.zeros(2)))
    return feet.soles


def test_feet_that_search_for_the_ground_are_expected_to_find_it(schedule):
    """A swing goes on down after its touchdown; planned through the ground, its legs would seem to accelerate."""
    made = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2))
    soles = moved_soles(made.samples, made.schedule)
    assert (made.samples.kind == PhaseKind.SINGLE).any()
    assert soles[..., 2].max() > 0.04
    assert soles[..., 2].min() > -1e-9


@pytest.mark.parametrize(("over", "follows"), [(0.02, True), (-0.01, True), (4e-4, True), (2e-4, False), (0.0, True)])
def test_a_foot_that_lands_higher_or_lower_than_its_swing_was_laid_comes_to_rest_there(schedule, over, follows):
    """A foot that was a sample later where it stands would seem to accelerate; what soles sink is no matter."""
    made = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2))
    place = made.schedule.step(1).place
    moved = made.schedule.moved(1, place.position + np.array([-0.03, 0.0, over]))
    soles = moved_soles(made.samples, moved)
    height = soles[place.foot, :, 2]
    swings = np.flatnonzero([made.samples.phases[k].step == 1 for k in made.samples.which])
    swings = swings[made.samples.kind[swings] == PhaseKind.SINGLE]
    assert height[swings[-1] + 1] == pytest.approx(over, abs=1e-9)
    assert height[swings[-1]] == pytest.approx(over if follows else 0.0, abs=1e-9)
    # Where the foot went off the ground, nothing has changed.
    assert height[swings[0]] == pytest.approx(0.0, abs=1e-9)


def test_in_a_frame_that_is_turned_and_moved_feet_are_turned_and_moved(schedule):
    turn, origin = 0.4, np.array([0.3, -0.2])
    R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    made = schedule(GaitParameters(steps=4, single_support=0.5, double_support=0.2))
    world, framed = NominalFeet(len(made.samples.clock)), NominalFeet(len(made.samples.clock))
    world.move(len(made.samples.clock), made.samples, made.schedule, (np.eye(2), np.zeros(2)))
    framed.move(len(made.samples.clock), made.samples, made.schedule, (R, origin))
    np.testing.assert_allclose(framed.heading, world.heading - turn, atol=1e-12)
    np.testing.assert_allclose(framed.soles[..., :2], (world.soles[..., :2] - origin) @ R, atol=1e-12)
    np.testing.assert_array_equal(framed.soles[..., 2], world.soles[..., 2])
