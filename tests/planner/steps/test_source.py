"""Commanded steps land as asked within reach, at the nearest place beyond it, and at places to the millimetre."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.errors import ParameterError
from surefoot.planner.steps.commands import Command
from surefoot.planner.steps.footsteps import Path
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.source import CommandSource, steps_ordered
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import Foot, Twist

pytestmark = pytest.mark.unit

GAIT = GaitParameters(steps=0, step_length=0.35, single_support=0.5, double_support=0.16, initial_stand=0.4)
REGION = StepRegion(0.5, (0.13, 0.4), (0.22, 0.11), leg_span=0.49, hip_width=0.2)
PERIOD = GAIT.period
ORIGIN = Twist()

speeds = st.floats(-1.5, 1.5)
twists = st.builds(Twist, speeds, speeds, speeds)
places = st.builds(Twist, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


def walked(source, most=200, pose=ORIGIN):
    """Strides that a source orders until the robot stands, and where the path is before and after each."""
    path, before, strides, poses = Path(np.array(pose[:2]), pose.yaw, 0.0, GAIT.step_width), None, [], [pose]
    for step in range(1, most + 1):
        order = source.order(step, before, poses[-1], PERIOD)
        if order is None:
            break
        before, _ = order
        strides.append(before)
        path, _ = path.advanced(before, Foot.LEFT if step % 2 else Foot.RIGHT)
        poses.append(Twist(float(path.middle[0]), float(path.middle[1]), path.yaw))
    return strides, poses


def away(pose, place):
    """Distance of a pose from a place, in metres or radians, whichever is more."""
    return max(np.hypot(pose.x - place.x, pose.y - place.y), abs(np.angle(np.exp(1j * (pose.yaw - place.yaw)))))


def told(twist=None, places=()):
    source = CommandSource(GAIT, REGION)
    source.twist, source.places = twist or Twist(), tuple(places)
    return source


def test_nothing_asked_for_is_standing():
    assert walked(told())[0] == []


def test_a_velocity_in_reach_is_walked_as_it_is_and_a_stop_closes_the_stance():
    source = told(Twist(0.4, 0.05, 0.1))
    strides, _ = walked(source, most=6)
    np.testing.assert_allclose([strides[-1].x, strides[-1].yaw], [0.4 * PERIOD, 0.1 * PERIOD], rtol=1e-3)
    source.twist = Twist()
    last = []
    before = strides[-1]
    while (order := source.order(9, before, ORIGIN, PERIOD)) is not None:
        before, _ = order
        last.append(before)
    assert len(last) == 1
    assert last[-1].is_zero


@given(twists, twists)
def test_every_stride_is_in_reach_and_none_is_much_longer_than_the_one_before_or_turns_round(first, second):
    source = told(first)
    strides, _ = walked(source, most=5)
    source.twist = second
    before = strides[-1] if strides else None
    for _ in range(5):
        order = source.order(9, before, ORIGIN, PERIOD)
        if order is None:
            break
        strides.append(order[0])
        before, _ = order
    assert all(map(REGION.admits, strides))
    ways = np.array([[0.0, 0.0, 0.0], *(stride[:3] for stride in strides)])
    assert (np.abs(ways[1:]) - np.abs(ways[:-1]) <= np.array([0.4 * 0.5, 0.14, 0.3]) + 1e-9).all()
    assert (ways[1:] * ways[:-1] >= 0.0).all()


def test_what_is_followed_has_the_direction_asked_for():
    followed = told(Twist(3.0, 0.3, 0.0)).followed(PERIOD)
    assert 0.3 < followed.x < 1.0
    assert followed.y / followed.x == pytest.approx(0.1)
    within = Twist(0.3, 0.1, 0.2)
    assert told(within).followed(PERIOD) == within


@given(st.lists(places, min_size=1, max_size=4))
def test_places_are_reached_and_the_robot_stands_at_the_last(goals):
    strides, poses = walked(told(places=goals), most=500)
    assert len(strides) < 400
    assert all(map(REGION.admits, strides))
    assert away(poses[-1], goals[-1]) < 0.009
    assert not strides or strides[-1].is_zero
    for place in goals:
        assert min(away(pose, place) for pose in poses) < 0.009


def test_a_far_place_is_walked_to_ahead():
    strides, _ = walked(told(places=[Twist(5.0, 0.0, 0.0)]))
    assert len(strides) == pytest.approx(5.0 / 0.35 + 2.0, abs=1.5)
    strides, _ = walked(told(places=[Twist(-5.0, 0.0, np.pi)]))
    assert max(stride.x for stride in strides) == pytest.approx(0.35)
    assert min(stride.x for stride in strides) > -0.05


def test_a_robot_that_was_moved_from_its_place_goes_back_and_one_that_was_hardly_does_not():
    source = told(places=[ORIGIN])
    assert walked(source, pose=Twist(0.005, 0.0, 0.0))[0] == []
    strides, poses = walked(source, pose=Twist(0.05, -0.03, 0.1))
    assert strides
    assert np.hypot(*poses[-1][:2]) < 0.003


def test_steps_are_counted_in_advance():
    source = told(places=[Twist(1.0, 0.5, 1.0)])
    assert steps_ordered(source, GAIT, ORIGIN) == len(walked(told(places=[Twist(1.0, 0.5, 1.0)]))[0])


@pytest.mark.parametrize(
    ("wrong", "name"),
    [
        ({"twist": Twist(np.inf, 0.0, 0.0)}, "v_x"),
        ({"places": (Twist(0.0, np.nan, 0.0),)}, "y"),
        ({"single_support": 0.0}, "single_support"),
        ({"swing_height": -0.1}, "swing_height"),
    ],
)
def test_commands_that_mean_nothing_are_refused(wrong, name):
    with pytest.raises(ParameterError) as refused:
        Command(**wrong)
    assert refused.value.key == ("command", name)
