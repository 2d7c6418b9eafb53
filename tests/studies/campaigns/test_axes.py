"""Axes of a campaign: their combinations, units and labels."""

import math

import pytest

from surefoot.studies.campaigns.spec import Axis, angle_of, combinations, is_around, title, with_unit

pytestmark = pytest.mark.unit

WAYS, STEPS = Axis("start.yaw", (0.0, 1.0, 2.0)), Axis("feet", ("small", "human"))


def test_combinations_have_every_label_once_the_last_axis_fastest():
    every = combinations([STEPS, WAYS])
    assert every[:2] == [{"feet": "small", "start.yaw": 0.0}, {"feet": "small", "start.yaw": 1.0}]
    assert len({tuple(one.values()) for one in every}) == len(every) == 6
    assert combinations([]) == [{}]


def test_units_are_those_of_the_schema():
    assert with_unit("gait.step_length") == "gait.step_length [m]"
    assert with_unit("pushes.0.impulse") == "pushes.0.impulse [N·s/kg]"
    assert with_unit("feet") == "feet"


def test_only_numbers_in_radians_are_directions():
    assert angle_of([STEPS, WAYS]) is WAYS
    assert angle_of([STEPS, Axis("start.yaw", ("a", 1.0))]) is None
    assert angle_of([Axis("start.yaw", (math.inf, 1.0))]) is None
    assert is_around([WAYS])
    assert not is_around([Axis("start.yaw", (0.0, 1.0))])


def test_a_title_names_numbers_and_leaves_words_alone():
    assert title({"feet": "small", "start.yaw": 0.123456}) == "small, yaw 0.1235"
