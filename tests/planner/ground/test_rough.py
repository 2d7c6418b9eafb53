"""Slopes and block fields, and footsteps and swings on them."""

import numpy as np
import pytest

from surefoot.errors import ParameterError
from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.planner.geometry.plane import frame_rotation, sole_corners, sole_pose
from surefoot.planner.ground.blocks import LEVEL_STEPS, Blocks
from surefoot.planner.ground.slope import Slope
from surefoot.planner.ground.terrain import Site, flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground, swing_course
from surefoot.planner.swing.trajectory import start_swing
from surefoot.planner.types import Foot

pytestmark = pytest.mark.unit

ORIGIN, YAW = np.array([1.0, -2.0]), 0.4
HALF_SOLE = np.array([0.11, 0.055])
BLOCKS = Blocks(0.05, 0.14, 0.3, 0.18)
GAIT = GaitParameters(steps=12, step_length=0.3, turn=0.03)


def field(stand, seed=0):
    feet = stand(origin=tuple(ORIGIN), yaw=YAW)
    laid = plan_footsteps(GAIT, feet, flat())
    terrain = BLOCKS.build(Site(ORIGIN, YAW, 0.7, lambda: laid, np.random.default_rng(seed)))
    feet.position[:, 2] = terrain.heights(feet.position[:, :2])
    return plan_footsteps(GAIT, feet, terrain), terrain


def places(plan):
    return np.array([step.position for step in plan])


def ahead(distance, left=0.0):
    return ORIGIN + frame_rotation(YAW) @ (distance, left)


@pytest.mark.parametrize("angle", [0.17, -0.17])
def test_a_slope_has_its_inclination_from_its_edge_on(angle):
    terrain = Slope(angle, 0.5, 4.0, 1.0).build(Site(ORIGIN, YAW, 0.7))
    height = [terrain.height(*ahead(x, y)) for x, y in ((0.0, 0.3), (0.499, 0.0), (0.501, 0.0), (1.5, -0.4), (2.5, 0))]
    base = height[0]
    assert base == pytest.approx(max(0.0, 4.0 * np.sin(-angle)))
    assert height[1:] == pytest.approx([base, base, base + np.tan(angle), base + 2.0 * np.tan(angle)], abs=2e-4)
    assert min(terrain.heights(np.array([ahead(x) for x in np.linspace(0.0, 4.0, 100)]))) >= 0.0
    np.testing.assert_array_equal(terrain.normal(*ahead(0.3)), [0.0, 0.0, 1.0])


def test_normals_are_those_of_the_heights(stand):
    """Against finite differences of the heights, away from edges."""
    plan, terrain = field(stand)
    rng = np.random.default_rng(1)
    step, checked = 1e-5, 0
    for laid in plan[2:]:
        for point in laid.position[:2] + rng.uniform(-0.06, 0.06, (5, 2)):
            around = point + step * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
            h = terrain.heights(around)
            gradient = np.array([h[0] - h[1], h[2] - h[3]]) / (2.0 * step)
            normal = np.append(-gradient, 1.0) / np.hypot(1.0, np.linalg.norm(gradient))
            np.testing.assert_allclose(terrain.normal(*point), normal, atol=1e-8)
            checked += normal[2] < 1.0
    assert checked > 40


def test_blocks_carry_the_whole_sole_of_every_footstep(stand):
    plan, terrain = field(stand)
    corners = np.array([sole_corners(sole, HALF_SOLE) for sole in plan])
    assert terrain.edge_margins(places(plan)[:, :2], corners).min() > 0.03
    for sole, place in zip(plan, corners, strict=True):
        np.testing.assert_array_equal(terrain.normal(*sole.position[:2]), sole.normal)
        plane = sole.position[2] - (place - sole.position[:2]) @ sole.normal[:2] / sole.normal[2]
        np.testing.assert_allclose(terrain.heights(place), plane, atol=1e-12)


def test_blocks_scatter_within_their_bounds_by_the_seed_and_are_level_at_both_ends(stand):
    plan, terrain = field(stand)
    heights = places(plan)[:, 2] - BLOCKS.middle
    assert np.abs(heights).max() <= BLOCKS.height
    assert np.ptp(heights) > BLOCKS.height
    tilt = np.arccos([step.normal[2] for step in plan])
    assert 0.8 * BLOCKS.angle < tilt.max() <= np.sqrt(2.0) * BLOCKS.angle
    level = [0, 1, *range(-LEVEL_STEPS, 0)]
    np.testing.assert_allclose(heights[level], 0.0, atol=1e-12)
    np.testing.assert_allclose(tilt[level], 0.0, atol=1e-7)
    np.testing.assert_array_equal(places(field(stand)[0]), places(plan))
    assert not np.array_equal(places(field(stand, seed=1)[0]), places(plan))
    signs = np.array([[x, y, 1.0] for x in (-1, 1) for y in (-1, 1)])
    for box in terrain.boxes:
        corners = box.center + (signs * box.half_size) @ box.rotation.T
        assert corners[:, 2].min() > 0.0


@pytest.mark.parametrize("seed", [0, 1])
def test_the_turning_sole_clears_all_blocks_and_lands_flat(stand, seed):
    """The whole sole is above the ground all the time, and away from home by the clearance of edges."""
    plan, terrain = field(stand, seed)
    samples, parameters = 35, PlannerParameters()
    outline = np.array([(x, y, 0.0) for x in np.linspace(-0.11, 0.11, 9) for y in (-0.055, 0.055)])
    for number, ends in enumerate(zip(plan, plan[2:], strict=False), 1):
        course = swing_course(number, *ends, samples, 0.05, Ground(terrain, HALF_SOLE, parameters))
        start, end = (sole_pose(place.position, place.yaw, place.normal) for place in ends)
        swing = start_swing(Foot.LEFT, (start, end), (0.0, samples), course, parameters)
        for time in np.arange(0.0, swing.touchdown_time, 0.01):
            pose = swing.evaluate(time)[0]
            points = pose[:3] + outline @ sole_rotation(*pose[3:]).T
            gap = np.min(points[:, 2] - terrain.heights(points[:, :2]))
            far = min(np.linalg.norm(pose[:2] - place[:2]) for place in (start, end)) > 0.06
            assert gap > (0.018 if far else -2e-3)
        np.testing.assert_allclose(sole_rotation(*swing.evaluate(swing.touchdown_time)[0, 3:])[:, 2], ends[1].normal)


def test_ground_that_lies_under_footsteps_asks_for_them():
    with pytest.raises(ParameterError, match="laid under footsteps") as refused:
        BLOCKS.build(Site(ORIGIN, YAW, 0.7))
    assert refused.value.key == ("terrain", "footsteps")


def test_footholds_are_free_on_wide_faces_and_where_there_are_none(stand):
    """A foot that lands elsewhere takes its successors with it, to the height and the normal of the ground there."""
    ground = Slope(0.17, 0.15, 6.0, 1.0).build(Site(ORIGIN, YAW, 0.7))
    assert (flat().footholds.follow, ground.footholds.follow, field(stand)[1].footholds.follow) == (True, True, False)
    assert (flat().has_edges, ground.has_edges) == (False, True)
    feet, on = stand(origin=tuple(ORIGIN), yaw=YAW), Ground(ground, HALF_SOLE, PlannerParameters(reach_length=0.8))
    plan = Schedule.start(GAIT, feet, on).extended(np.inf)
    place = plan.positions[4] + np.array([0.1, 0.05, 0.0])
    place[2] = ground.height(*place[:2])
    moved = plan.moved(3, place)
    np.testing.assert_allclose(
        moved.positions[5:, :2] - plan.positions[5:, :2], np.tile([0.1, 0.05], (9, 1)), atol=1e-12
    )
    np.testing.assert_allclose(moved.positions[5:, 2], ground.heights(moved.positions[5:, :2]))
    normals = [step.place.normal for step in moved.steps[4:]]
    np.testing.assert_array_equal(normals, ground.normals(moved.positions[4:, :2]))
    back = plan.moved(1, np.append(ahead(0.05), 0.0))
    np.testing.assert_array_equal(back.step(1).place.normal, [0.0, 0.0, 1.0])
    assert plan.step(1).place.normal[2] < 1.0
