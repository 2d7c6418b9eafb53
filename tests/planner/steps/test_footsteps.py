import numpy as np
import pytest

from surefoot.planner.geometry.plane import seen_from
from surefoot.planner.ground.terrain import Box, Terrain, flat
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.types import Foot, Twist

pytestmark = pytest.mark.unit


def places(steps):
    return np.array([step.position for step in steps])


def test_diagonal_walk_advances_by_length_and_lateral_step_and_ends_square(stand):
    steps = plan_footsteps(GaitParameters(steps=5, step_length=0.2, lateral_step=0.1), stand(), flat())
    path = places(steps)[2:, :2] - [[0.0, 0.1 if step.foot is Foot.LEFT else -0.1] for step in steps[2:]]
    np.testing.assert_allclose(path, np.minimum(np.arange(1, 6), 4)[:, None] * [0.2, 0.1], atol=1e-12)
    np.testing.assert_allclose(np.abs(steps[-1].position - steps[-2].position), [0.0, 0.2, 0.0], atol=1e-12)


def test_turning_in_place_keeps_the_centre_and_the_width(stand):
    steps = plan_footsteps(GaitParameters(steps=9, step_length=0.0, turn=0.3), stand(), flat())
    np.testing.assert_allclose(np.hypot(*places(steps)[:, :2].T), 0.1, atol=1e-12)
    np.testing.assert_allclose(np.diff([step.yaw for step in steps[1:-1]]), 0.3)


def test_footsteps_stand_on_the_terrain(stand):
    step = Box(np.array([1.2, 0.0, 0.05]), np.array([1.0, 1.0, 0.05]), np.eye(3))
    steps = plan_footsteps(GaitParameters(steps=5), stand(), Terrain(boxes=(step,)))
    position = places(steps)
    np.testing.assert_allclose(position[:, 2], np.where(position[:, 0] >= 0.2 - 1e-12, 0.1, 0.0))


def test_plan_is_equivariant_under_start_pose(stand):
    gait = GaitParameters(lateral_step=0.1, turn=0.1)
    here = places(plan_footsteps(gait, stand(), flat()))[:, :2]
    there = places(plan_footsteps(gait, stand(origin=(100.0, -3.0), yaw=np.pi / 2), flat()))[:, :2]
    np.testing.assert_allclose(there, here @ np.array([[0.0, 1.0], [-1.0, 0.0]]) + [100.0, -3.0], atol=1e-12)


def test_a_change_of_width_leaves_the_stance_foot_alone(stand):
    """The landing of a foot from its stance foot is a matter of its own stride alone."""
    strides = tuple(Twist(0.1, 0.02, 0.2, width) for width in (0.2, 0.3, 0.3, 0.25, 0.2))
    steps = plan_footsteps(GaitParameters(steps=5, bouts=(Bout(1.0, strides),)), stand(), flat())
    for row, stride in enumerate(strides, 2):
        alone = plan_footsteps(
            GaitParameters(steps=1, bouts=(Bout(1.0, (stride,)),), step_width=stride.width, first_foot=steps[row].foot),
            stand(stride.width),
            flat(),
        )
        ways = [seen_from(plan[last - 1], plan[last]).position for plan, last in ((steps, row), (alone, 2))]
        np.testing.assert_allclose(ways[0], ways[1], atol=1e-12)


@pytest.mark.parametrize("width", [0.15, 0.2, 0.26])
def test_the_first_step_lands_its_own_width_from_its_stance_foot_however_wide_the_robot_stood(stand, width):
    gait = GaitParameters(steps=1, step_width=0.2, bouts=(Bout(1.0, (Twist(0.1, 0.05, 0.0, 0.2),)),))
    steps = plan_footsteps(gait, stand(width), flat())
    place = seen_from(steps[1], steps[2])
    assert place.beside == pytest.approx(0.2 + 0.05 * steps[2].foot.side)


def test_support_points_of_a_stop_lie_between_the_feet(schedule):
    bout = Bout(1.0, (Twist(0.2, width=0.2), Twist(width=0.2)))
    whole = schedule(GaitParameters(steps=4, bouts=(bout, bout))).schedule
    np.testing.assert_allclose(
        whole.support_points[:, :2],
        [[0, 0], [0, -0.1], [0.2, 0.1], [0.2, 0], [0.2, -0.1], [0.4, 0.1], [0.4, 0]],
        atol=1e-12,
    )
