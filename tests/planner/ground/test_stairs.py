import numpy as np
import pytest

from surefoot.planner.geometry.plane import sole_corners
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import FeetState

pytestmark = pytest.mark.unit

HALF_SIZE = np.array([0.11, 0.055])


def stairs(direction, **changes):
    values = {"riser": 0.15, "tread": 0.3, "count": 3, "start": 0.15, "landing": 0.9, "beyond": 2.0} | changes
    return Stairs(direction=direction, **values)


def heights_of_walk(direction, steps, origin=(0.0, 0.0), yaw=0.0):
    """Heights of the footsteps of a straight walk over stairs, one per tread, and their edge margins."""
    terrain = stairs(direction).build(Site(np.array(origin), yaw, 0.8))
    side = 0.1 * np.array([-np.sin(yaw), np.cos(yaw)])
    ground = terrain.height(*origin)
    position = np.array([[*(origin + side), ground], [*(origin - side), ground]])
    gait = GaitParameters(steps=steps, step_length=0.3)
    plan = plan_footsteps(gait, FeetState(position, np.full(2, yaw), (True, True)), terrain)
    corners = np.array([sole_corners(step, HALF_SIZE) for step in plan])
    places = np.array([step.position for step in plan])
    return places[2:, 2], terrain.edge_margins(places[:, :2], corners)


@pytest.mark.parametrize(
    ("direction", "expected"),
    [
        (Direction.UP, [1, 2, 3, 3, 3]),
        (Direction.DOWN, [2, 1, 0, 0, 0]),
        (Direction.UP_DOWN, [1, 2, 3, 3, 3, 2, 1, 0, 0]),
    ],
)
@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_footsteps_land_in_the_middle_of_one_tread_after_the_other(direction, expected, yaw):
    heights, margins = heights_of_walk(direction, len(expected), (3.0, -2.0), yaw)
    np.testing.assert_allclose(heights, 0.15 * np.array(expected), atol=1e-12)
    np.testing.assert_allclose(margins[:-2].min(), 0.15 - HALF_SIZE[0])


def test_feet_that_start_elsewhere_step_on_the_same_treads():
    terrain = stairs(Direction.UP).build(Site(np.array([1.0, 2.0]), 0.3, 0.8))
    gait = GaitParameters(steps=4, step_length=0.3)
    plans = []
    for shift, turn in ((0.0, 0.0), (0.03, 0.05)):
        position = np.array([[1.0 + shift, 2.1, 0.0], [1.0, 1.9 + shift, 0.0]])
        plans.append(plan_footsteps(gait, FeetState(position, np.array([0.3 + turn, 0.3]), (True, True)), terrain))
    for one, other in zip(*plans, strict=True):
        assert one.yaw == pytest.approx(other.yaw, abs=1e-12)
    for one, other in list(zip(*plans, strict=True))[2:]:
        np.testing.assert_allclose(one.position, other.position, atol=1e-12)
    assert plans[1][0].position[0] == pytest.approx(1.03)


def test_margin_is_negative_for_a_sole_over_an_edge_and_infinite_on_bare_ground():
    terrain = stairs(Direction.UP).build(Site(np.zeros(2), 0.0, 0.8))
    centers = np.array([[0.5, 0.0], [0.4, 0.0], [0.0, 0.0], [0.1, 0.0], [0.3, 0.98]])
    corners = centers[:, None] + np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * HALF_SIZE
    np.testing.assert_allclose(terrain.edge_margins(centers, corners), [-0.06, -0.06, 0.04, -0.06, -0.035], atol=1e-12)
    assert terrain.__class__().edge_margins(centers, corners).tolist() == [np.inf] * 5


def test_treads_do_not_overlap_and_leave_no_gap():
    boxes = stairs(Direction.UP_DOWN).build(Site(np.zeros(2), 0.0, 0.8)).boxes
    begins = [box.center[0] - box.half_size[0] for box in boxes]
    ends = [box.center[0] + box.half_size[0] for box in boxes]
    np.testing.assert_allclose(begins[1:], ends[:-1], atol=1e-12)
    assert all(box.center[2] - box.half_size[2] == 0.0 for box in boxes)
