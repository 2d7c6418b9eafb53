"""Reach of the legs and times of the gait."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.models.facts import longest_step
from surefoot.planner.references.com_height import BENT_KNEES
from surefoot.scenarios.file.gait import Gait
from surefoot.scenarios.file.schema import PushSettings, Scenario
from surefoot.scenarios.setup.groups.formulation import CATCHING_HIPS
from surefoot.scenarios.setup.groups.gait import (
    FINAL_STAND,
    phase_of,
    push_time,
)
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import Walk, resolve

pytestmark = pytest.mark.unit


@given(leg=st.floats(0.3, 1.5), bend=st.floats(0.5, 1.0), hips=st.floats(0.05, 0.4), feet=st.floats(0.05, 0.4))
def test_at_the_longest_step_the_leg_is_straight(leg, bend, hips, feet):
    height = leg * bend
    step = longest_step(leg, height, hips, feet)
    if math.isnan(step):
        assert math.hypot(height, (feet - hips) / 2) > leg * (1.0 - 1e-12)
    else:
        assert math.hypot(step / 2, (feet - hips) / 2, height) == pytest.approx(leg)


def test_lower_hips_reach_farther():
    assert longest_step(0.9, 0.8, 0.2, 0.25) > longest_step(0.9, 0.85, 0.2, 0.25)


def test_who_walks_with_bent_knees_goes_down_less_for_a_long_step():
    stretched, bent = (resolve(load("walk-level", {"planner.knee": knee})).legs for knee in ("stretched", "bent"))
    assert bent.height == pytest.approx(stretched.height - BENT_KNEES)
    assert bent.lowering(0.7) == pytest.approx(max(stretched.lowering(0.7) - BENT_KNEES, 0.0))
    assert stretched.lowering(0.7) > 0.03


@pytest.mark.parametrize("speed", [0.5, 0.8, 1.06])
def test_straight_legs_that_catch_a_body_reach_as_far_as_it_comes_down(speed):
    """Between two feet they span no more than the walk's own steps; from lower hips a foot lands well beyond them."""
    gait = {"speed": speed, "steps": 6}
    straight, bent = (resolve(load("walk", {"gait": gait, "planner.knee": knee})) for knee in ("straight", "bent"))
    hips = CATCHING_HIPS * straight.facts.leg_length
    assert straight.legs.radius == pytest.approx(0.9 * math.sqrt(straight.facts.leg_length**2 - hips**2))
    assert straight.legs.stride > straight.gait.step_length + 0.35
    assert bent.legs.radius == pytest.approx(0.45 * bent.facts.leg_span(bent.gait.com_height))


def test_legs_that_carry_the_body_lower_than_that_reach_from_where_they_are():
    low = resolve(load("walk", {"gait": {"speed": 0.8, "steps": 6, "com_height": 0.93}}))
    assert low.legs.radius == pytest.approx(0.45 * low.facts.leg_span(0.93))


def test_phases_follow_each_other():
    gait = Walk(Scenario()).asked_gait
    assert phase_of(gait, 1, "double")[0] == gait.initial_stand
    assert phase_of(gait, 1, "single")[0] == gait.initial_stand + 2 * gait.double_support
    for step in range(1, 5):
        for phase, following in (("double", (step, "single")), ("single", (step + 1, "double"))):
            end = sum(phase_of(gait, step, phase))
            assert phase_of(gait, *following)[0] == pytest.approx(end)


def test_pushes_by_point_of_the_gait():
    gait = Walk(Scenario()).asked_gait
    push = PushSettings(step=2, phase="single", fraction=0.5)
    assert push_time(gait, push) == pytest.approx(1.0 + 1.0 + 2.0 + 0.75)
    assert push_time(gait, PushSettings(time=2.2)) == 2.2
    with pytest.raises(ValueError, match="without a begin"):
        push_time(gait, PushSettings(step=2))


def test_a_run_lasts_until_the_robot_has_stood():
    assert Walk(Scenario()).duration == pytest.approx(1.0 + 1.0 + 5 * 2.0 + FINAL_STAND)
    assert Walk(Scenario(duration=3.0)).duration == 3.0
    assert Walk(Scenario(gait=Gait(steps=0))).duration == 1.0 + FINAL_STAND


def test_a_foot_that_lands_on_its_heel_reaches_farther_by_what_its_ankle_is_higher():
    """The leg that lands spans from there; the other one as far as it did."""
    flat, heels = (longest_step(0.9, 0.85, 0.2, 0.2, raised) for raised in (0.0, 0.02))
    assert heels - 0.5 * flat == pytest.approx(math.sqrt(0.9**2 - 0.83**2))
