import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from pendulum_walk import LEGS

from surefoot.planner.geometry import frame_rotation
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import HURRIED, STRAIGHTEST, in_time
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.swing.trajectory import SwingCourse, start_swing
from surefoot.planner.types import Foot, Footstep

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
    at_rest = Schedule.start(
        GaitParameters(steps=1), stand(), Ground(ground, np.array([0.11, 0.055]), PlannerParameters())
    )
    execution = Execution(at_rest, 151, legs)
    while execution.phase.swing_foot is None:
        execution.advance(stand())
    stance = execution.schedule.step(0).place
    landing = Footstep(stance.foot.other, stance.position + np.array([0.7, 0.0, 0.0]), 0.0)
    for adapted, lowers in ((False, False), (True, free)):
        execution.adapted = adapted
        execution.swing_to(landing, 0.02 * execution.clock.now, stand(), False)
        assert execution.lowering == (pytest.approx(legs.lowering(0.7)) if lowers else 0.0)


def swung(legs, com, ahead=0.6, samples=72.0):
    """The swing, in 1.4 s, of a left foot so far ahead of its place beside the stance foot, and its course's own."""
    stance = Footstep(Foot.RIGHT, np.zeros(3), 0.4)
    beside = TURNED @ np.array([[ahead, 0.0], [0.25, 0.25]])
    pose, target = (np.array([*place, 0.0, 0.4, 0.0, 0.0]) for place in beside.T)
    course, parameters = SwingCourse(0.5, 0.0, 1.0, 0.05), PlannerParameters()
    begin = partial(start_swing, Foot.LEFT, pose, target, 3.0, samples)
    return stance, begin(course=course, parameters=parameters), in_time(begin, course, parameters, stance, legs, com)


TURNED = frame_rotation(0.4)
SPANNING = replace(LEGS, height=0.85, length=0.94, below=0.1, acceleration=(60.0, 60.0))
GOING_ON = np.column_stack((0.3 * np.exp(-2.5 * 0.02 * np.arange(60.0)), np.full(60, 0.05))) @ TURNED.T
GOING_ON = np.column_stack((GOING_ON, np.full(60, 0.95)))
"""The CoM, from between the feet to over the stance foot."""


@pytest.mark.parametrize("hardest", [60.0, 6.0])
def test_a_foot_left_far_behind_glides_before_its_leg_is_stretched(hardest):
    """As the body goes on to over the other foot; hips that can swing it half as hard at most do what they can."""
    legs, times = replace(SPANNING, acceleration=(hardest, hardest)), 3.0 + 0.02 * np.arange(60)
    stance, slow, swing = swung(legs, GOING_ON)
    hip = GOING_ON + np.append(TURNED @ [0.0, 0.5 * legs.hip_width], -0.1)
    far = np.linalg.norm(hip - swing.positions(times)[:, :3], axis=1) / 0.94
    np.testing.assert_allclose(legs.stretched(swing, stance, GOING_ON, times), far)
    assert legs.stretched(slow, stance, GOING_ON, times).max() > 1.0
    assert swing.glide_end < slow.glide_end
    assert swing.touchdown_time == slow.touchdown_time
    assert np.abs(swing.bends(times) @ TURNED).max() <= HURRIED * hardest
    assert bool(far.max() <= STRAIGHTEST) is (hardest > 6.0)


def test_a_foot_in_reach_keeps_to_its_course():
    """And one of legs that nobody knows, or in a walk that goes on as planned."""
    unknown = replace(SPANNING, length=math.inf)
    cases = ((0.2, SPANNING, GOING_ON), (0.6, unknown, GOING_ON), (0.6, SPANNING, None), (0.6, None, GOING_ON))
    for ahead, legs, com in cases:
        _, slow, swing = swung(legs, com, ahead)
        assert swing.glide_end == slow.glide_end
