import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import frame_rotation, seen_from
from surefoot.planner.ground.terrain import flat
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.steps.commands import (
    Command,
    fastest,
    fitted,
    footstep_bouts,
    leading_foot,
    velocity_bouts,
    walk_of,
)
from surefoot.planner.steps.footsteps import plan_footsteps
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.step_region import StepRegion, check_reach
from surefoot.planner.types import FeetState, Foot, Footstep, PhaseKind, Twist

pytestmark = pytest.mark.unit

GAIT = GaitParameters(single_support=0.5, double_support=0.16, initial_stand=1.0)
PERIOD = 0.66
REGION = StepRegion(length=0.4, width=(0.08, 0.4), sole=(0.22, 0.11))
FEET = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))


def timeline(*rows):
    return [Command(Twist(*row[1:]), time=row[0]) for row in rows]


def walk(*rows, gait=GAIT):
    bouts = velocity_bouts(timeline(*rows), gait)
    return fitted(walk_of(gait, bouts, leading_foot(bouts)), REGION)


def test_the_command_at_lift_off_gives_the_stride_and_zero_closes_the_stance():
    gait = walk((0.0, 0.3), (3.0, 0.6), (5.0,))
    (bout,) = gait.walk
    lengths = [stride.x for stride in bout.strides]
    lift_offs = 1.32 + PERIOD * np.arange(len(lengths))
    assert lengths == pytest.approx([PERIOD * (0.3 if t < 3.0 else 0.6 if t < 5.0 else 0.0) for t in lift_offs])
    assert lengths[-1] == 0.0
    assert bout.stand == 1.0


def test_a_zero_longer_than_a_step_stands_and_goes_on_when_commanded(schedule):
    gait = walk((0.0, 0.3), (3.0,), (6.0, 0.3), (8.0,))
    first, second = gait.walk
    stopped = 1.0 + 0.32 + PERIOD * len(first.strides)
    assert stopped + second.stand == pytest.approx(6.0)
    plan = schedule(gait)
    stands = [phase for phase in plan.phases if phase.kind is PhaseKind.STAND]
    assert [phase.step for phase in stands] == [0, len(first.strides), gait.steps]
    assert stands[1].end * 0.02 == pytest.approx(6.0)
    feet = plan_footsteps(gait, FEET, flat())
    row = len(first.strides) + 1
    np.testing.assert_allclose(np.abs(feet[row].position - feet[row - 1].position), [0.0, 0.2, 0.0], atol=1e-12)


def test_a_command_that_has_gone_before_the_foot_lifts_moves_nothing():
    assert velocity_bouts(timeline((2.0, 0.3), (2.3,)), GAIT) == ()
    assert len(velocity_bouts(timeline((2.0, 0.3), (2.33,)), GAIT)) == 1
    assert walk((0.0,)).walk == ()


def test_walking_waits_for_the_initial_stand_and_for_the_first_command():
    assert walk((0.5, 0.3), (4.0,)).walk[0].stand == 1.0
    assert walk((2.0, 0.3), (4.0,)).walk[0].stand == 2.0


@pytest.mark.parametrize("twist", [(0.3, 0.0, 0.3), (0.0, 0.05, -0.2), (-0.2, 0.05, 0.4), (0.0, 0.0, 0.5)])
def test_the_path_follows_the_arc_of_a_constant_twist_exactly(twist):
    gait = walk((0.0, *twist), (1.32 + 9.5 * PERIOD,))
    feet, strides = plan_footsteps(gait, FEET, flat()), 10
    vx, vy, w = twist
    angle, row = w * PERIOD * strides, strides + 1
    turned = np.array([[math.sin(angle), math.cos(angle) - 1.0], [1.0 - math.cos(angle), math.sin(angle)]]) / w
    middle = 0.5 * (feet[row].position + feet[row + 1].position)
    np.testing.assert_allclose(middle[:2], turned @ [vx, vy], atol=1e-9)
    assert feet[row].yaw == pytest.approx(angle)


def test_sideways_alternates_wide_and_closing_steps_of_both_legs_reach():
    gait = walk((0.0, 0.0, 0.2), (8.0,))
    feet = plan_footsteps(gait, FEET, flat())
    beside = np.abs(np.diff([step.position[1] for step in feet[1:]]))
    assert feet[2].foot is Foot.LEFT
    assert beside[1:-1:2] == pytest.approx(0.12 if beside[1] < 0.2 else 0.384)
    assert np.all((beside >= 0.12 - 1e-9) & (beside <= 0.4))
    assert np.ptp(beside[:-1]) == pytest.approx(2 * 0.2 * PERIOD)


def test_the_leading_foot_is_on_the_side_of_the_motion():
    for twist, foot in (((0, -0.1, 0), 1), ((0, 0.1, -1), 0), ((0.3, 0, -0.1), 1), ((0.3, 0, 0), 0), ((0, 0, 0.1), 0)):
        assert leading_foot(velocity_bouts(timeline((0.0, *twist), (9.0,)), GAIT)) == foot


@pytest.mark.parametrize(
    ("rows", "message", "key"),
    [
        (((0.0, 0.3), (2.0, 0.1)), "the last one must be zero", ("velocity", 1)),
        ((), "the last one must be zero", ("velocity",)),
        (((2.0, 0.3), (1.0,)), "times must increase", ("velocity", 1, "time")),
        (((1.0, 0.3), (1.0,)), "times must increase", ("velocity", 1, "time")),
    ],
)
def test_a_bad_timeline_is_refused(rows, message, key):
    with pytest.raises(ParameterError, match=message) as refused:
        velocity_bouts(timeline(*rows), GAIT)
    assert refused.value.key == key


def test_bad_commands_are_refused():
    with pytest.raises(ParameterError, match="must be finite"):
        Command(Twist(math.nan))
    with pytest.raises(ParameterError, match="must not be negative"):
        Command(Twist(), time=-1.0)
    with pytest.raises(ParameterError, match="lasts 80000 s; 66000 s is the most"):
        velocity_bouts(timeline((0.0, 0.1), (80_000.0,)), GAIT)


@given(
    direction=st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).filter(lambda d: max(map(abs, d)) > 0.1)
)
def test_the_fastest_is_just_within_reach(direction):
    twist = Twist(*direction).scaled(20.0)
    limit = fastest(twist, PERIOD, 0.2, REGION)
    inside, outside = (REGION.fitted(limit.scaled(f).stride(PERIOD, 0.2)) for f in (1.0, 1.001))
    assert REGION.admits(inside)
    assert not REGION.admits(outside)
    assert np.linalg.matrix_rank([limit[:3], direction], tol=1e-9) == 1


def test_the_fastest_straight_ahead_uses_the_whole_step_length():
    assert fastest(Twist(3.0), PERIOD, 0.2, REGION).x == pytest.approx(0.4 / PERIOD)
    assert fastest(Twist(0.0, -3.0), PERIOD, 0.2, REGION).y == pytest.approx(-(0.4 - 0.12) / 2 / PERIOD)
    assert fastest(Twist(0.1), PERIOD, 0.2, REGION) == Twist(0.1)


def test_footsteps_are_taken_where_they_are_given():
    given_steps = [
        Footstep(Foot.RIGHT, np.array([0.2, -0.15, 0.0]), -0.2),
        Footstep(Foot.LEFT, np.array([0.35, 0.05, 0.0]), 0.1),
        Footstep(Foot.RIGHT, np.array([0.3, -0.2, 0.0]), 0.3),
    ]
    gait = walk_of(GAIT, footstep_bouts(given_steps, GAIT), Foot.RIGHT)
    feet = plan_footsteps(gait, FEET, flat())
    for laid, footstep in zip(feet[2:], given_steps, strict=True):
        assert laid.foot is footstep.foot
        np.testing.assert_allclose(laid.position, footstep.position, atol=1e-12)
        assert laid.yaw == pytest.approx(footstep.yaw)


def test_footsteps_must_alternate():
    step = Footstep(Foot.LEFT, np.array([0.2, 0.1, 0.0]), 0.0)
    with pytest.raises(ParameterError, match="footstep 2 moves the left foot again") as refused:
        footstep_bouts([step, step], GAIT)
    assert refused.value.key == ("footsteps", 1)
    with pytest.raises(ParameterError, match="at least one"):
        footstep_bouts([], GAIT)


TWISTS = st.builds(Twist, st.floats(-1, 1), st.floats(-0.5, 0.5), st.floats(-1, 1))


@settings(max_examples=60)
@given(data=st.data())
def test_any_velocity_command_within_limits_gives_a_sound_walk(schedule, data):
    """Whatever follows whatever: every foot lands in reach and apart from the other, and the schedule is consistent."""
    ticks = sorted(data.draw(st.sets(st.integers(0, 400), min_size=1, max_size=6)))
    twists = [data.draw(st.just(Twist()) | TWISTS) for _ in ticks[1:]]
    twists = [fastest(twist, PERIOD, GAIT.step_width, REGION) for twist in twists]
    commands = [Command(twist, time=0.02 * k) for k, twist in zip(ticks, [*twists, Twist()], strict=True)]
    bouts = velocity_bouts(commands, GAIT)
    gait = fitted(walk_of(GAIT, bouts, leading_foot(bouts)), REGION)
    steps = plan_footsteps(gait, FEET, flat())
    for number, (stance, step) in enumerate(pairwise(steps[1:]), 1):
        place = seen_from(stance, step)
        check_reach(number, place, PlannerParameters())
        c, s = np.cos(stance.yaw), np.sin(stance.yaw)
        x, y = (step.position - stance.position)[:2] @ np.array([[c, -s], [s, c]])
        beside = float(y if step.foot is Foot.LEFT else -y)
        assert (place.position[0], place.beside) == pytest.approx((x, beside), abs=1e-12)
        assert place.yaw == pytest.approx(step.yaw - stance.yaw)
        assert REGION.why_not(place) is None
    plan = schedule(gait)
    assert [phase.kind for phase in plan.phases].count(PhaseKind.SINGLE) == gait.steps
    assert all(a.end == b.start for a, b in zip(plan.phases, plan.phases[1:], strict=False))
    assert np.diff(plan.samples.index + plan.samples.fraction).max(initial=0.0) <= 1 / 8 + 1e-12
    assert np.abs(np.diff(plan.load_left)).max(initial=0.0) <= 1 / 8 + 1e-12
    assert plan.samples.index[-1] == len(plan.schedule.support_points) - 1


def test_the_fastest_steps_are_laid_wherever_in_the_world_they_are():
    """They are just within reach, and a place a kilometre away is rounded."""
    rng, parameters = np.random.default_rng(7), PlannerParameters()
    region = StepRegion(parameters.reach_length, parameters.reach_width, (0.22, 0.11))
    for twist in rng.uniform(-2.0, 2.0, (300, 3)).tolist():
        stride = region.fitted(fastest(Twist(*twist), PERIOD, 0.2, region).stride(PERIOD, 0.2))
        yaw = rng.uniform(-np.pi, np.pi)
        for foot in Foot:
            stance, place = Footstep(foot.other, rng.uniform(-1e3, 1e3, 3), yaw), stride.landing(foot)
            position = stance.position + np.append(frame_rotation(yaw) @ place.position[:2], 0.0)
            seen = seen_from(stance, Footstep(foot, position, yaw + place.yaw))
            check_reach(1, seen, parameters)
            with pytest.raises(ParameterError, match="it must be"):
                check_reach(1, Footstep(foot, seen.position * (1.0, 0.0, 1.0), seen.yaw), parameters)
