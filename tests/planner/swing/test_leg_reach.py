from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import LEGS

from surefoot.planner.flight import swinging_to
from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.planner.measured import Measured
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.com_height import SmoothHeight
from surefoot.planner.state import WalkState
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import around_stance_leg
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.track import advanced
from surefoot.planner.types import CentroidalState, Foot, Footstep
from surefoot.planner.walk_model import WalkModel

pytestmark = pytest.mark.unit

TREAD = Box(np.array([1.0, 0.0, 0.05]), np.array([0.3, 1.0, 0.05]), np.eye(3))


def way(start, end):
    return np.linspace(start, end, 50)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(
    ("start", "end", "corner"),
    [
        ((-0.28, 0.2), (0.28, -0.1), (0.24, 0.115)),
        ((-0.28, -0.1), (0.28, 0.3), (-0.24, 0.115)),
        ((0.28, 0.2), (-0.28, -0.1), (-0.24, 0.115)),
        ((-0.28, 0.2), (0.28, 0.2), None),
        ((-0.28, 0.2), (0.28, 0.05), None),
        ((0.25, 0.2), (0.3, -0.1), None),
    ],
)
def test_a_foot_that_crosses_goes_ahead_first_and_comes_back_before_it_passes(side, start, end, corner):
    mirror = np.array([1.0, side])
    found = LEGS.corner(way(start, end) * mirror, side)
    if corner is None:
        assert found is None
    else:
        np.testing.assert_allclose(found, corner * mirror)


@pytest.mark.parametrize("turn", [-0.3, 0.1, 0.3])
def test_a_foot_that_lands_turned_keeps_as_clear_of_its_stance_foot_as_one_that_does_not(turn):
    """Wherever ahead of or behind it lands, and ahead of it wherever beside."""
    sole = np.array([0.22, 0.11])
    legs = replace(LEGS, sole=tuple(sole.tolist()))
    turned, level = legs.turned(turn), legs.turned(0.0)
    assert level is legs
    assert LEGS.turned(turn).near == LEGS.near
    corners = 0.5 * sole * np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]) @ frame_rotation(turn).T
    assert turned.near + corners[:, 1].min() == pytest.approx(legs.near - 0.5 * sole[1])
    assert turned.clear + corners[:, 0].min() == pytest.approx(legs.clear - 0.5 * sole[0])
    # As a step that is commanded.
    region = StepRegion(0.5, (0.0, 0.5), tuple(sole.tolist()), gap=legs.near - sole[1])
    assert turned.near == pytest.approx(region.nearest(turn))


@pytest.mark.parametrize("stride", [0.0, 0.36, 0.55, 0.65, 0.75])
def test_the_body_goes_as_low_as_legs_need_that_span_a_stride(stride):
    """With a quarter of what straight legs span to spare, as the body is not midway between them."""
    legs = replace(LEGS, height=0.85, length=0.94)
    hips = 0.85 - legs.lowering(stride)
    assert hips == 0.85 if stride < 0.6 else hips < 0.85
    assert 2.0 * np.sqrt(0.94**2 - hips**2) >= stride / 0.75 - 1e-9
    assert LEGS.lowering(stride) == 0.0  # of legs whose length nobody knows


@pytest.mark.parametrize(("ground", "free"), [(Terrain(), True), (Terrain((TREAD,)), False)])
def test_the_body_goes_down_where_steps_may_land_anywhere(stand, ground, free):
    """On stairs its height follows the faces, and knees need what is above them."""
    legs = replace(LEGS, height=0.85, length=0.94)
    gait, soles = GaitParameters(steps=1), Ground(ground, np.array([0.11, 0.055]), PlannerParameters())
    state = WalkState.start(WalkModel.of(gait, soles, SmoothHeight(), legs), stand())
    measured = Measured(CentroidalState(0.0, np.array([0.0, 0.0, gait.com_height]), np.zeros(3)), stand())
    while state.phase.swing_foot is None:
        state = advanced(state, measured)
    stance = state.schedule.step(0).place
    landing = Footstep(stance.foot.other, stance.position + np.array([0.7, 0.0, 0.0]), 0.0)
    for adapted, lowers in ((False, False), (True, free)):
        swung = swinging_to(replace(state, adapted=adapted), landing, measured, False)
        assert swung.lowering == (pytest.approx(legs.lowering(0.7)) if lowers else 0.0)


@pytest.mark.parametrize("hip", [(0.0, 0.2), (0.3, -0.1)])
def test_sides_around_a_place_are_in_reach_from_a_hip(hip):
    """The end of each side that is nearer than the box, level with the place, is as far from the hip as the reach."""
    place, reach = np.array([0.1, 0.15]), 0.5
    wide = np.array([[-9.0, -9.0], [9.0, 9.0]])
    found = LEGS.around(place, np.array(hip), wide, reach)
    for axis in (0, 1):
        for end in found[:, axis]:
            at = place.copy()
            at[axis] = end
            assert np.linalg.norm(at - hip) == pytest.approx(reach)
    assert (found[0] < place).all() and (place < found[1]).all()
    near = np.array([[0.05, 0.1], [0.2, 0.16]])
    np.testing.assert_array_equal(LEGS.around(place, np.array(hip), near, reach), near)


@pytest.mark.parametrize("yaw", [0.0, 0.8, 1.4, -1.4])
@pytest.mark.parametrize("foot", list(Foot))
@pytest.mark.parametrize(("start", "end", "bends"), [(-0.15, 0.1, True), (0.1, -0.15, True), (0.2, 0.2, False)])
def test_a_swing_goes_around_its_stance_leg_whichever_way_it_walks(foot, yaw, start, end, bends):
    """It passes a corner beside the stance foot where it begins or ends beyond it, whichever way that foot points."""
    R, side, legs = frame_rotation(yaw), foot.side, replace(LEGS, acceleration=(1e3, 1e3))
    stance = Footstep(foot.other, np.array([1.0, -2.0, 0.0]), yaw)
    beside = [R @ [x, side * y] + stance.position[:2] for x, y in ((-0.35, start), (0.35, end))]
    poses = [np.array([*place, 0.0, yaw, 0.0, 0.0]) for place in beside]
    swing = start_swing(foot, tuple(poses), (0.0, 25), SwingCourse(0.5, 0.0, 1.0, 0.05), PlannerParameters())
    around = around_stance_leg(swing, stance, legs, 0.0, 0.02)
    assert around.bent is bends
    times = np.arange(0.0, 0.5, 0.002)
    if bends:
        assert around_stance_leg(around, stance, legs, 0.0, 0.02) is around
        way = (around.positions(times)[:, :2] - stance.position[:2]) @ R * (1.0, side)
        corner = (np.copysign(legs.clear, -0.35 if start < 0.0 else 0.35), legs.near)
        assert np.linalg.norm(way - corner, axis=1).min() < 0.01
        slow = replace(LEGS, acceleration=(0.1, 0.1))
        assert around_stance_leg(swing, stance, slow, 0.0, 0.02) is swing
