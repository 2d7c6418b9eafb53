"""Level ground that is not quite level."""

import numpy as np
import pytest

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.ground.terrain import Box, Site, Terrain
from surefoot.planner.ground.tiles import AROUND, TILE, Tiles
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import FeetState

pytestmark = pytest.mark.unit

NOISE = 0.01
ORIGIN, YAW = np.array([1.5, -0.7]), 0.6


def site(steps=6, **gait):
    left = frame_rotation(YAW) @ (0.0, 0.1)
    feet = FeetState(
        np.array([np.append(ORIGIN + left, 0.0), np.append(ORIGIN - left, 0.0)]), np.full(2, YAW), (True, True)
    )
    asked = GaitParameters(steps, **{"step_length": 0.25, **gait})
    return Site(ORIGIN, YAW, 0.7, lambda: plan_footsteps(asked, feet, Terrain()))


def around(where, radius, count=200):
    """Points in discs around the footsteps."""
    rng = np.random.default_rng(0)
    way, turn = radius * np.sqrt(rng.uniform(size=count)), rng.uniform(0.0, 2.0 * np.pi, count)
    disc = np.column_stack((way * np.cos(turn), way * np.sin(turn)))
    places = np.array([step.position[:2] for step in where.footsteps()])
    return (places[:, None] + disc).reshape(-1, 2)


@pytest.mark.parametrize("gait", [{}, {"step_length": 0.0, "lateral_step": 0.1}, {"step_length": 0.1, "turn": 0.3}])
def test_ground_is_within_the_noise_everywhere_and_tiled_wherever_feet_may_go(gait):
    where = site(**gait)
    ground = Tiles(NOISE, 1).build(where)
    heights = ground.heights(around(where, AROUND * TILE - 1e-6))
    assert np.abs(heights).max() <= NOISE
    assert heights.min() < -0.5 * NOISE < 0.5 * NOISE < heights.max()
    assert heights.min() > -NOISE == ground.plane  # no tile is as low as the plane, so that it is nowhere seen
    assert ground.friction == 0.7


def test_feet_start_at_the_height_that_is_believed_and_on_no_edge():
    ground, feet = Tiles(NOISE, 1).build(site()), np.array([step.position[:2] for step in site().footsteps()[:2]])
    corners = feet[:, None] + np.array([[x, y] for x in (-0.11, 0.11) for y in (-0.055, 0.055)]) @ frame_rotation(YAW).T
    assert ground.edge_margins(feet, corners).min() > 0.03
    np.testing.assert_array_equal(ground.heights(corners.reshape(-1, 2)), 0.0)


@pytest.mark.parametrize("seed", range(5))
def test_nothing_rises_into_the_feet_at_the_start(seed):
    box = np.random.default_rng(0).uniform((-0.3, -0.4), (0.3, 0.4), (500, 2))
    heights = Tiles(NOISE, seed, level=0.3).build(site()).heights(ORIGIN + box @ frame_rotation(YAW).T)
    np.testing.assert_array_equal(heights, 0.0)


def test_seed_and_place_alone_say_how_high_a_tile_is():
    points = around(site(steps=4), 0.8)
    short, long = Tiles(NOISE, 7).build(site(steps=4)), Tiles(NOISE, 7).build(site(steps=12))
    assert len(long.boxes) > len(short.boxes)
    np.testing.assert_array_equal(short.heights(points), long.heights(points))
    np.testing.assert_allclose(Tiles(2 * NOISE, 7).build(site(steps=4)).heights(points), 2 * short.heights(points))
    assert not np.allclose(Tiles(NOISE, 8).build(site(steps=4)).heights(points), short.heights(points))


def test_a_plane_that_lies_lower_carries_what_no_box_does():
    box = Box(np.array([1.0, 0.0, -0.02]), np.array([0.5, 0.5, 0.01]), np.eye(3))
    ground = Terrain((box,), plane=-0.03)
    assert (ground.height(0.0, 0.0), ground.height(1.0, 0.0)) == (-0.03, pytest.approx(-0.01))
    beside, on = np.array([[0.3, 0.0]]), np.array([[1.0, 0.0]])
    soles = np.array([[-0.1, -0.1], [0.1, 0.1]])
    assert ground.edge_margins(beside, (beside + soles)[None])[0] == pytest.approx(0.1)  # to the edge of the box at 0.5
    assert ground.edge_margins(on, (on + soles)[None])[0] == pytest.approx(0.4)
