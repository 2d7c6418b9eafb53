"""Leading a policy to a place: the law of the benchmark's harness, and of what its adapters add to it."""

import math

import pytest

from surefoot.errors import ParameterError
from surefoot.scenarios.policy.contract import contract_of
from surefoot.studies.tour.steering import Steering
from surefoot.studies.tour.walker import Goal

pytestmark = pytest.mark.unit

LEAST = {"network": "n.onnx", "rate": 50, "joints": ["a"], "stiffness": 1, "damping": 1}


def steering(command=None, **places):
    told = {**LEAST, "observations": [{"term": "gravity"}], "command": command or {}, "places": places}
    return Steering(contract_of(told, "here"))


def test_velocities_grow_with_the_way_and_are_cut():
    free = steering().velocity(Goal(0, (0.3, -0.2), 0.4), 0.0)
    assert tuple(free)[:3] == pytest.approx((0.45, -0.3, 0.6))
    cut = steering({"v_x": [-0.1, 0.2], "v_y": [-0.1, 0.1], "yaw_rate": [-0.2, 0.2]})
    assert tuple(cut.velocity(Goal(0, (3.0, -2.0), -0.9), 0.0))[:3] == pytest.approx((0.2, -0.1, -0.2))


def test_own_ranges_count_before_those_that_it_was_trained_for():
    one = steering({"v_x": [-1.0, 1.0]}, v_x=[-0.25, 0.25])
    assert one.velocity(Goal(0, (5.0, 0.0), 0.0), 0.0).x == 0.25


def test_near_a_place_it_stands_until_it_is_pushed_off_and_another_place_is_gone_to_at_once():
    one = steering()
    assert one.velocity(Goal(0, (0.09, 0.0), 0.04), 0.0).is_zero
    assert one.velocity(Goal(0, (0.19, 0.0), 0.11), 1.0).is_zero
    off = one.velocity(Goal(0, (0.21, 0.0), 0.13), 2.0)
    assert off.x > 0.0 and off.yaw > 0.0
    fresh = steering()
    assert fresh.velocity(Goal(0, (0.15, 0.0), 0.0), 0.0).x > 0.0
    assert one.velocity(Goal(1, (0.15, 0.0), 0.1), 2.0).x > 0.0


def test_a_speed_bounds_both_axes_together_and_is_kept_in_spite_of_the_cut():
    bound = steering(speed=0.4).velocity(Goal(0, (3.0, 4.0), 0.0), 0.0)
    assert math.hypot(bound.x, bound.y) == pytest.approx(0.4) and bound.y / bound.x == pytest.approx(4.0 / 3.0)
    ranges = {"v_y": [-0.2, 0.2], "v_x": [-0.6, 0.6]}
    for keeps, speed in ((False, math.hypot(0.24, 0.2)), (True, math.hypot(0.24 / math.hypot(0.24, 0.2) * 0.4, 0.2))):
        one = steering(ranges, speed=0.4, keeps_speed=keeps).velocity(Goal(0, (3.0, 4.0), 0.0), 0.0)
        assert math.hypot(one.x, one.y) == pytest.approx(speed)


def test_far_away_it_looks_where_it_goes_and_near_by_where_it_is_asked_to():
    one = steering(faces=[0.35, 1.0], turn_gain=1.0)
    assert one.velocity(Goal(0, (0.0, 2.0), -1.0), 0.0).yaw == pytest.approx(0.5 * math.pi)
    assert one.velocity(Goal(0, (0.0, 0.3), -1.0), 0.0).yaw == pytest.approx(-1.0)
    assert steering(turn_gain=1.0).velocity(Goal(0, (0.0, 2.0), -1.0), 0.0).yaw == pytest.approx(-1.0)


def test_it_waits_as_long_as_it_is_told():
    one = steering(waits=1.5)
    assert one.velocity(Goal(0, (1.0, 0.0), 0.0), 1.48).is_zero
    assert not one.velocity(Goal(0, (1.0, 0.0), 0.0), 1.5).is_zero


@pytest.mark.parametrize("places", [{"near": [0.2, 0.1]}, {"faces": [1.0, 1.0]}, {"gain": 0.0}, {"waits": -1.0}])
def test_laws_that_make_no_sense_are_refused(places):
    with pytest.raises(ParameterError, match="places"):
        steering(**places)
