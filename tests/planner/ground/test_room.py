"""The room of footsteps on the faces that they were chosen for."""

import numpy as np
import pytest

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site, flat
from surefoot.planner.steps.step import turned_room

pytestmark = pytest.mark.unit

HALF = np.array([0.11, 0.055])


def stairs(direction, yaw=0.0):
    shape = Stairs(riser=0.15, tread=0.33, count=4, direction=direction, start=0.3, landing=1.0, beyond=1.0)
    return shape.build(Site(np.zeros(2), yaw, 0.8))


def test_bare_ground_has_room_everywhere():
    assert np.isinf(flat().free_area(np.zeros(3), 0.3, HALF)).all()


@pytest.mark.parametrize("yaw", [0.0, 0.7])
@pytest.mark.parametrize(("direction", "room"), [(Direction.UP, (-0.04, 0.01)), (Direction.DOWN, (-0.01, 0.04))])
def test_a_sole_keeps_off_the_edges_of_its_tread_and_a_shank_off_the_riser(direction, room, yaw):
    """The second tread: 5.5 cm before and behind the sole, of which it keeps 1, and 4 to a riser, in whole cm."""
    level, place = stairs(direction, yaw), frame_rotation(yaw) @ (0.3 + 1.5 * 0.33, 0.1)
    position = np.append(place, level.height(*place))
    low, high = level.free_area(position, yaw, HALF)
    np.testing.assert_allclose((low[0], high[0]), room, atol=1e-9)
    np.testing.assert_allclose((low[1], high[1]), (-0.8, 0.8), atol=1e-9)


@pytest.mark.parametrize("angle", [0.0, 0.1, -0.4, 1.2])
def test_a_room_in_another_frame_lies_in_it(angle):
    room = np.array([[-0.02, -0.4], [0.04, 0.3]])
    low, high = turned_room(room, angle, 0.02)
    assert (low <= 0.0).all()
    assert (high >= 0.0).all()
    corners = np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])]) @ frame_rotation(angle)
    assert (corners >= room[0] - 1e-12).all()
    assert (corners <= room[1] + 1e-12).all()
    assert (high - low > 0.02).all()
