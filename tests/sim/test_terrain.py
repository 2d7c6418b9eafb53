from dataclasses import replace

import mujoco
import numpy as np
import pytest

from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import Box, Terrain, flat
from surefoot.sim.world import World

pytestmark = pytest.mark.unit


def _yaw(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _pitch(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


TERRAIN = Terrain(
    boxes=(
        Box(np.array([0.5, 0.2, 0.05]), np.array([0.3, 0.2, 0.05]), np.eye(3)),
        Box(np.array([0.9, 0.2, 0.10]), np.array([0.3, 0.2, 0.10]), _yaw(0.7)),
        Box(np.array([-0.8, -0.3, 0.02]), np.array([0.4, 0.5, 0.08]), _yaw(0.3) @ _pitch(-0.2)),
    ),
    friction=0.6,
)


def _height_by_ray(world: World, x: float, y: float) -> tuple[float, bool]:
    """Height under a point, and whether it lies on an upper face (a tilted box also shows a side to the sky)."""
    geom = np.zeros(1, dtype=np.int32)
    groups = np.array([1, 0, 0, 0, 0, 0], dtype=np.uint8)  # the terrain's group
    down = np.array([0.0, 0.0, -1.0])
    normal = np.zeros(3)
    distance = mujoco.mj_ray(world.model, world.data, np.array([x, y, 5.0]), down, groups, 1, -1, geom, normal)
    return 5.0 - float(distance), normal[2] > 0.7


@pytest.mark.parametrize("terrain", [TERRAIN, replace(TERRAIN, plane=-0.03)])
def test_geoms_have_the_heights_that_the_planner_is_told(terrain: Terrain) -> None:
    world = World(describe("humanoid100", RobotOptions()), terrain, 1000)
    mujoco.mj_forward(world.model, world.data)
    points = np.random.default_rng(1).uniform((-1.5, -1.0), (1.5, 1.0), size=(300, 2))
    expected = [terrain.height(x, y) for x, y in points]
    assert min(expected) == terrain.plane
    assert len({round(height, 3) for height in expected}) > 20
    measured, upper = np.array([_height_by_ray(world, x, y) for x, y in points]).T
    assert upper.mean() > 0.98
    np.testing.assert_allclose(measured[upper > 0], np.array(expected)[upper > 0], atol=1e-9)


@pytest.mark.parametrize("friction", [0.02, 0.8, 1.5])
def test_contacts_have_the_friction_of_the_terrain(friction: float) -> None:
    world = World(describe("humanoid100", RobotOptions()), flat(friction), 1000)
    world.reset(np.concatenate(([0.0, 0.0, 0.93, 0.0, 0.0, 0.0, 1.0], np.zeros(25))))
    assert world.data.ncon > 0
    np.testing.assert_array_equal(world.data.contact.friction[:, :2], friction)
