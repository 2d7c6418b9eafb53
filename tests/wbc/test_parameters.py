"""Every number of the controller says what it is and refuses what it cannot be."""

import math
from dataclasses import fields, replace

import pytest

from surefoot.errors import ParameterError
from surefoot.wbc.parameters import WbcParameters

pytestmark = pytest.mark.unit

DEFAULT = WbcParameters()
GROUPS = ("weights", "gains", "balance", "contact", "schedule", "knees", "separation")
NONE_AT_ZERO = {("knees", "weight")}
NUMBERS = [(name, entry.name) for name in GROUPS for entry in fields(getattr(DEFAULT, name))]


def numbers(value):
    return value if isinstance(value, tuple) else (value,)


def like(value, part):
    """The value with its last number replaced."""
    return (*value[:-1], part) if isinstance(value, tuple) else part


def test_all_groups_are_looked_at():
    others = {"solver", "second_solver", "arm_swing", "size"}
    assert {entry.name for entry in fields(WbcParameters)} == {*GROUPS, *others}
    assert len(NUMBERS) == 43


@pytest.mark.parametrize(("group", "name"), NUMBERS)
def test_a_number_has_default_unit_and_meaning(group, name):
    entry = next(entry for entry in fields(getattr(DEFAULT, group)) if entry.name == name)
    assert entry.metadata["unit"]
    assert entry.metadata["doc"]
    assert not entry.metadata["doc"].endswith(".")
    assert all(part > 0 and math.isfinite(part) for part in numbers(entry.default)) or (group, name) in NONE_AT_ZERO


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf, True, "1"])
@pytest.mark.parametrize(("group", "name"), NUMBERS)
def test_a_number_that_cannot_be_is_refused_by_its_name(group, name, bad):
    settings = getattr(DEFAULT, group)
    with pytest.raises(ParameterError, match=f"^wbc.{group}.{name} is .*; it must be ") as caught:
        replace(settings, **{name: like(getattr(settings, name), bad)})
    assert caught.value.key == ("wbc", group, name)


@pytest.mark.parametrize(
    ("group", "name", "value", "right"),
    [
        ("weights", "acceleration", 0.0, "greater than 0"),
        ("schedule", "felt_ticks", 0, "greater than 0"),
        ("schedule", "felt_ticks", 1.5, "whole number"),
        ("schedule", "early_progress", 1.5, "at most 1"),
        ("balance", "polygon_share", 1.01, "at most 1"),
        ("separation", "horizon", 0.0, "greater than 0"),
        ("gains", "swing", 400.0, "2 numbers"),
        ("gains", "swing", (400.0,), "2 numbers"),
    ],
)
def test_what_would_be_right_is_said(group, name, value, right):
    with pytest.raises(ParameterError) as caught:
        replace(getattr(DEFAULT, group), **{name: value})
    assert right in caught.value.right


def test_zero_and_whole_numbers_are_fine_where_they_mean_something():
    weights = replace(DEFAULT.weights, swing=0, com_vertical=0.0)
    assert (weights.swing, weights.com_vertical) == (0, 0.0)
    assert replace(DEFAULT.gains, posture=(0, 9)).posture == (0, 9)
    assert replace(DEFAULT.separation, slots=0).slots == 0


def test_solvers_and_arm_swing_are_looked_at():
    with pytest.raises(ParameterError, match="choose one of daqp, equality-first, proxqp") as caught:
        WbcParameters(second_solver="simplex")
    assert caught.value.key == ("wbc", "second_solver")
    with pytest.raises(ParameterError) as caught:
        WbcParameters(arm_swing=-0.1)
    assert caught.value.key == ("wbc", "arm_swing")
