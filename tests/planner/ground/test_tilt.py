"""Ground that is truly tilted, but for a strip across the start."""

import numpy as np
import pytest

from surefoot.planner.ground.terrain import Site
from surefoot.planner.ground.tilt import Tilt

pytestmark = pytest.mark.unit

PITCH, ROLL, LEVEL = 0.035, -0.02, 0.15


def ground(yaw=0.0, origin=(0.0, 0.0), pitch=PITCH, roll=ROLL):
    return Tilt(pitch, roll, LEVEL, 20.0).build(Site(np.array(origin), yaw, 0.8))


@pytest.mark.parametrize(("yaw", "origin"), [(0.0, (0.0, 0.0)), (0.7, (2.0, -1.0)), (-2.5, (0.3, 4.0))])
def test_it_rises_by_its_angles_from_the_edges_of_the_strip_on(yaw, origin):
    terrain, c, s = ground(yaw, origin), np.cos(yaw), np.sin(yaw)
    for x in (-8.0, -2.0, -0.3, -0.1, 0.0, 0.14, 0.2, 3.0, 9.0):
        for y in (-3.0, 0.0, 0.1, 5.0):
            there = (origin[0] + c * x - s * y, origin[1] + s * x + c * y)
            beyond = np.sign(x) * max(abs(x) - LEVEL, 0.0)
            wanted = beyond * np.tan(PITCH) + y * np.tan(ROLL) if beyond else 0.0
            assert terrain.height(*there) == pytest.approx(wanted, abs=1e-9)


def test_faces_have_the_angles_of_their_names():
    for pitch, roll in ((PITCH, 0.0), (0.0, ROLL)):
        normal = ground(pitch=pitch, roll=roll).normal(3.0, 0.0)
        np.testing.assert_allclose(np.arctan2(-normal[:2], normal[2]), (pitch, roll), atol=1e-12)


def test_the_plane_is_below_all_of_it():
    terrain = ground()
    corners = np.array([[x, y] for x in (-19.0, 19.0) for y in (-19.0, 19.0)])
    assert terrain.heights(corners).min() > terrain.plane
