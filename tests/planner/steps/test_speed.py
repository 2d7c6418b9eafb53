import math
from dataclasses import astuple, replace

import pytest

from surefoot.errors import ParameterError
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.speed import speed_gait
from surefoot.planner.types import GRAVITY

pytestmark = pytest.mark.unit

LEG, ABOVE = 0.94, 0.1


@pytest.mark.parametrize("speed", [0.05, 0.3, 0.8, 1.4, 2.5])
def test_steps_have_the_speed(speed):
    gait = speed_gait(speed, LEG, ABOVE)
    assert gait.step_length / (gait.single_support + gait.double_support) == pytest.approx(speed)
    assert 0.0 < gait.double_support < gait.single_support
    assert 0.0 < gait.rise < LEG


def test_people_keep_the_ratio_of_step_length_and_rate():
    gaits = [speed_gait(speed, LEG, ABOVE) for speed in (0.4, 0.8, 1.6)]
    ratios = [gait.step_length * (gait.single_support + gait.double_support) for gait in gaits]
    assert ratios == pytest.approx([ratios[0]] * 3)
    # 0.0042 m per step and minute, of legs of 0.94 m (Sekiya and Nagasaki 1998).
    assert ratios[0] == pytest.approx(0.0042 * 60.0, rel=0.06)


def test_knees_are_straight_between_two_flat_feet():
    gait = speed_gait(0.8, LEG, ABOVE)
    assert math.hypot(gait.com_height - ABOVE, 0.5 * gait.step_length) == pytest.approx(LEG)
    fast = speed_gait(1.5, LEG, ABOVE)
    assert math.hypot(fast.com_height - ABOVE, 0.5 * fast.step_length) < LEG - 0.005


def test_the_arc_of_a_straight_leg_is_flattened_where_it_would_shake_the_body():
    slow, fast = speed_gait(0.4, LEG, ABOVE), speed_gait(1.2, LEG, ABOVE)
    assert slow.com_height + slow.rise == pytest.approx(LEG + ABOVE)
    assert fast.com_height + fast.rise < LEG + ABOVE - 0.01
    step = fast.single_support + fast.double_support
    assert 0.5 * fast.rise * (2.0 * math.pi / step) ** 2 == pytest.approx(1.7)


def test_the_pelvis_sways_more_with_longer_steps_and_no_more_with_the_longest():
    slow, usual, brisk, fast = (speed_gait(speed, LEG, ABOVE) for speed in (0.4, 1.0, 1.25, 1.5))
    assert 0.0 < slow.pelvis_yaw < usual.pelvis_yaw > brisk.pelvis_yaw > fast.pelvis_yaw == 0.0
    assert 0.0 < slow.pelvis_list < usual.pelvis_list > brisk.pelvis_list > fast.pelvis_list == 0.0
    assert usual.pelvis_yaw * LEG / usual.step_length == pytest.approx(0.13)


@pytest.mark.parametrize("scale", [0.5, 0.72, 1.3])
def test_robots_of_another_size_walk_alike(scale):
    """Lengths go as the legs, times as their root; angles stay (Froude's number)."""
    one, other = speed_gait(0.8, LEG, ABOVE), speed_gait(0.8 * math.sqrt(scale), scale * LEG, scale * ABOVE)
    factors = (scale, math.sqrt(scale), math.sqrt(scale), scale, scale, 1.0, 1.0, 1.0, 1.0, 1.0)
    expected = [value * factor for value, factor in zip(astuple(one), factors, strict=True)]
    assert astuple(other) == pytest.approx(expected)


@pytest.mark.parametrize(
    "given",
    [
        {"step_length": 0.5},
        {"single_support": 0.5},
        {"double_support": 0.1},
        {"step_length": 0.5, "double_support": 0.1},
        {"single_support": 0.5, "double_support": 0.1},
        {"step_length": 0.4, "single_support": 0.35, "double_support": 0.15},
    ],
    ids=str,
)
def test_numbers_that_are_given_stay_and_the_others_make_the_speed(given):
    gait = speed_gait(0.8, LEG, ABOVE, **given)
    assert all(getattr(gait, name) == value for name, value in given.items())
    assert gait.step_length / (gait.single_support + gait.double_support) == pytest.approx(0.8)


def test_numbers_of_another_speed_are_refused():
    with pytest.raises(ParameterError, match=r"which is 1 m/s; leave out the speed, or one of the others") as refused:
        speed_gait(0.8, LEG, ABOVE, step_length=0.5, single_support=0.4, double_support=0.1)
    assert refused.value.key == ("gait", "speed")
    with pytest.raises(ParameterError, match=r"of which single_support takes all; use less than 0\.5 s"):
        speed_gait(0.8, LEG, ABOVE, step_length=0.4, single_support=0.6)


def test_ramps_grow_evenly_to_the_step_length_and_back():
    gait = GaitParameters(steps=8, step_length=0.6, ramp=2)
    assert [stride.x for stride in gait.strides] == pytest.approx([0.2, 0.4, 0.6, 0.6, 0.6, 0.4, 0.2, 0.0])
    assert [stride.x for stride in replace(gait, steps=4).strides] == pytest.approx([0.2, 0.4, 0.2, 0.0])
    assert [stride.x for stride in replace(gait, ramp=0).strides] == [0.6] * 7 + [0.0]
    assert replace(gait, steps=1).strides[0].x == 0.0


def test_fast_walks_have_a_ramp_and_slow_ones_none():
    assert speed_gait(1.0, LEG, ABOVE).ramp == 0
    assert speed_gait(0.5 * math.sqrt(GRAVITY * LEG), LEG, ABOVE).ramp >= 1


def test_feet_roll_off_as_far_as_the_time_of_double_support_allows():
    slow, usual, fast = (speed_gait(speed, LEG, ABOVE) for speed in (0.2, 0.7, 1.5))
    assert slow.heel_off < usual.heel_off == 0.7 > fast.heel_off
    assert fast.heel_off / fast.double_support == pytest.approx(1.8 * math.sqrt(GRAVITY / LEG))
    longer = speed_gait(1.5, LEG, ABOVE, double_support=1.3 * fast.double_support)
    assert longer.heel_off > fast.heel_off
