"""A swing to ground whose height is not known well: aimed below it, and faster down."""

from dataclasses import replace
from itertools import accumulate
from types import SimpleNamespace

import numpy as np
import pytest
from pendulum_walk import walk_pendulum

from surefoot.planner.parameters import GroundSearch, PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.types import Foot

pytestmark = pytest.mark.unit

POSE, PLACE = np.array([1.0, 0.1, 0.0, 0.0, 0.0, 0.0]), np.array([1.4, 0.15, 0.0, 0.2, 0.0, 0.0])
COURSE = SwingCourse(0.5, 0.0, 1.0, 0.05)


def swing(deviation, height=0.0, over=0.0):
    place = PLACE + np.array([0.0, 0.0, height, 0.0, 0.0, 0.0])
    return start_swing(Foot.LEFT, (POSE, place), (2.0, 40), COURSE, PlannerParameters(), (deviation, over)), place


def test_where_the_height_is_known_nothing_changes():
    usual = GroundSearch()
    assert usual.for_deviation(0.0) == (usual, 0.0)
    trajectory, place = swing(0.0)
    np.testing.assert_array_equal(trajectory.target, place)
    assert trajectory.search == usual and trajectory.aim == 0.0


def test_the_search_is_the_faster_the_less_sure_the_height_is_up_to_a_bound():
    usual = GroundSearch()
    found = [usual.for_deviation(deviation) for deviation in (2e-4, 1e-3, 1.0)]
    speeds, aims = [search.touchdown_speed for search, _ in found], [aim for _, aim in found]
    assert usual.touchdown_speed < speeds[0] < speeds[1] < speeds[2] < 0.3
    assert 0.0 < aims[0] < aims[1] < aims[2] == pytest.approx(usual.unsure_aim * usual.most_unsure)
    assert usual.for_deviation(3e-4)[0].touchdown_speed == pytest.approx(0.021, abs=0.001)
    assert usual.for_deviation(3e-4)[0].acceleration == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("height", [0.0, 0.1, -0.1])
def test_a_footstep_is_aimed_below_the_ground_and_stays_where_it_is_planned(height):
    sure, place = swing(0.0, height)
    trajectory, _ = swing(1e-3, height)
    np.testing.assert_allclose(trajectory.footstep, place[:3], atol=1e-12)
    assert trajectory.target[2] == pytest.approx(place[2] - trajectory.aim) and trajectory.aim > 0.0
    # It comes no less high.
    top = max(trajectory.evaluate(t)[0, 2] for t in np.linspace(2.0, 2.75, 401))
    assert top == pytest.approx(max(sure.evaluate(t)[0, 2] for t in np.linspace(2.0, 2.75, 401)), abs=1e-7)
    moved = trajectory.retargeted(2.2, trajectory.target + np.array([0.05, 0.0, 0.02, 0.0, 0.0, 0.0]))
    np.testing.assert_allclose(moved.footstep, place[:3] + np.array([0.05, 0.0, 0.02]), atol=1e-12)


def test_the_ground_is_aimed_at_where_feet_are_believed_over_the_map():
    """The height of the ground is that of feet that stand on it; the truth needs no such look."""
    level, place = swing(1e-3)
    for over in (6e-4, -6e-4, -0.02):
        found, _ = swing(1e-3, over=over)
        assert found.target[2] - level.target[2] == pytest.approx(over, abs=1e-12)
        np.testing.assert_allclose(found.footstep, place[:3], atol=1e-12)
    assert swing(0.0, over=1e-3)[0].aim == 0.0


def test_a_height_that_goes_astray_is_followed_however_far_and_a_step_of_the_ground_is_not():
    """A plate that nobody told of is no ground of another height; tiles tell where it is on the whole."""
    search = GroundSearch()
    most = search.most_astray
    assert search.astray(0.0, 0.6 * most) == 0.6 * most
    assert search.astray(1e-3, 0.02) - 1e-3 == 1e-3 - search.astray(1e-3, -0.02) == pytest.approx(most)
    drift = -0.5 * most * np.arange(1, 40)
    assert list(accumulate(drift, search.astray, initial=0.0))[1:] == pytest.approx(drift.tolist())
    tiles = drift + np.random.default_rng(0).uniform(-0.01, 0.01, len(drift))
    believed = np.array(list(accumulate(tiles, search.astray, initial=0.0))[1:])
    assert np.abs(believed - drift)[10:].max() < 0.01


@pytest.mark.parametrize("sinks", [8e-4, 15e-3])
def test_a_walk_whose_feet_are_all_believed_too_low_aims_as_much_lower_at_every_step(stand, sinks):
    """Drift is in the foot that stands and in where the next one lands; the map alone does not drift."""
    gait, deviation, search = GaitParameters(steps=4), 3e-4, GroundSearch()
    planner, feet = WalkingPlanner(gait, stand(gait.step_width), 0.22, 0.11), stand(gait.step_width)

    def update(state, feet):
        position = np.column_stack((feet.position[:, :2], np.full(2, -sinks)))
        return planner.update(state, replace(feet, position=position, height_deviation=deviation))

    told = SimpleNamespace(parameters=planner.parameters, update=update)
    com = np.array([0.0, 0.0, gait.com_height])
    plans = walk_pendulum(told, feet, gait.duration, com=com, substeps=2).plans
    swings = [plan.swing for plan in plans if plan.swing is not None]
    aims = {round(swing.touchdown_time, 6): swing.aim for swing in swings}
    assert len(aims) == gait.steps
    followed = np.minimum(search.most_astray * np.arange(1, gait.steps + 1), sinks)
    np.testing.assert_allclose(list(aims.values()), search.unsure_aim * deviation + followed, atol=1e-9)
