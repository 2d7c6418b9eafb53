"""The step that lands next, seen from its stance foot: the same whichever way the walk goes."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.planner.ground.terrain import Box, Terrain, flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.recovery.step_problem import landing_place
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground

pytestmark = pytest.mark.unit

GAIT = GaitParameters(steps=5, step_length=0.2, turn=0.3, step_width=0.25)


def places(stand, origin=(0.0, 0.0), yaw=0.0, terrain=None, gait=GAIT):
    ground = Ground(terrain or flat(), np.array([0.11, 0.055]), PlannerParameters(reach_length=0.8))
    schedule = Schedule.start(gait, stand(gait.step_width, origin, yaw), ground).extended(np.inf)
    return [landing_place(schedule.step(n), schedule.step(n - 1), ground, 60.0) for n in range(1, GAIT.steps + 1)]


@pytest.mark.parametrize(("origin", "yaw"), [((1.0, -2.0), 0.0), ((0.0, 0.0), 0.7), ((0.3, 0.1), -3.0)])
def test_a_landing_is_seen_the_same_wherever_a_walk_goes_and_whichever_way(stand, origin, yaw):
    for (here, face, *rest), (there, turned, *more) in zip(places(stand), places(stand, origin, yaw), strict=True):
        np.testing.assert_allclose(there.position, here.position, atol=1e-9)
        assert there.yaw == pytest.approx(here.yaw, abs=1e-9)
        np.testing.assert_allclose(turned, face, atol=1e-9)
        assert (there.foot, more) == (here.foot, rest)


def test_it_lands_to_its_own_side_turned_by_as_much_as_the_walk_turns_in_a_step(stand):
    for landing, *_ in places(stand)[1:-1]:
        assert landing.foot.side * landing.position[1] > 0.1
        assert landing.yaw == pytest.approx(GAIT.turn)


def test_it_may_be_moved_on_its_face_to_either_side_of_where_it_lands(stand):
    """Blocks are half a metre wide, and as long as steps are."""
    half = np.array([0.2, 0.25, 0.05])
    blocks = tuple(Box(np.array([0.4 * n, 0.0, 0.05]), half, np.eye(3)) for n in range(-2, 7))
    gait = replace(GAIT, turn=0.0, com_height=0.9, step_length=0.4)
    rooms = []
    for landing, face, *_ in places(stand, terrain=Terrain(blocks, path_start=(0.0, 0.0, 0.05)), gait=gait):
        (low, high), place = face, landing.position[:2]
        assert (low <= place).all() and (place <= high).all()
        rooms.append(high - low)
    assert np.max(rooms, axis=0) == pytest.approx([0.15, 0.35], abs=0.05)
