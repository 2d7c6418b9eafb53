"""Walks of a pendulum that is pushed: it survives the more the more it may adapt, and goes on as before."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pendulum_walk import LEGS, Attended, walk_pendulum

from surefoot.forces import Push
from surefoot.planner.ground.stairs import Direction, Stairs
from surefoot.planner.ground.terrain import Site
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.com_height import Rise, SmoothHeight
from surefoot.planner.rules import goes_again
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.quintics import PEAK
from surefoot.planner.types import PhaseKind

pytestmark = pytest.mark.unit

P = PlannerParameters()
T, LIFTING = P.sample_time, P.recovery.lifting

LEVELS = (StepAdaptation.NONE, StepAdaptation.LOCATION, StepAdaptation.TIMING, StepAdaptation.CROSSING)


def greatest(stand, adaptation, direction):
    """Largest of some impulses in mid-swing that the pendulum survives with all smaller ones [N·s/kg]."""
    gait = GaitParameters(steps=5, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95)
    parameters, begin = replace(P, step_adaptation=adaptation), gait.lift_off(3) + 0.25
    survived = 0.0
    for impulse in 0.1 * 1.5 ** np.arange(9):
        planner = WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=parameters, legs=LEGS)
        push = Push(begin, 0.1, 1000.0 * impulse * np.array([*direction, 0.0]))
        com = np.array([0.0, 0.0, gait.com_height])
        if walk_pendulum(planner, stand(), gait.duration + 1.0, com=com, pushes=(push,)).fall_time is not None:
            break
        survived = float(impulse)
    return survived


@pytest.mark.parametrize(
    ("direction", "least"),
    [
        pytest.param((1.0, 0.0), 3.0, marks=pytest.mark.long),
        pytest.param((0.0, 1.0), 1.5, marks=pytest.mark.long),
        ((0.0, -1.0), 1.5),
    ],
)
def test_a_pushed_pendulum_survives_more_the_more_it_may_adapt(stand, direction, least):
    survived = [greatest(stand, level, direction) for level in LEVELS]
    assert min(survived[1:]) > survived[0] > 0.0
    assert survived[-1] == max(survived) > least * survived[0]


def test_a_body_whose_step_is_hurried_is_not_let_fall(stand):
    """Its height goes on smoothly, and its feet press; hurried through its law it would fall with 10 m/s^2."""
    gait = GaitParameters(
        steps=5, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95, apex_ss=0.03
    )
    push = Push(gait.lift_off(3) + 0.1, 0.1, np.array([900.0, 0.0, 0.0]))
    planner, com = WalkingPlanner(gait, stand(), 0.22, 0.11, legs=LEGS), np.array([0.0, 0.0, gait.com_height])
    plans = walk_pendulum(planner, stand(), gait.lift_off(5), com=com, pushes=(push,)).plans
    assert min(plan.balance.delay for plan in plans) < -0.05
    z = np.array([(plan.com[:2, 2], plan.com_velocity[:2, 2], plan.com_acceleration[:2, 2]) for plan in plans])
    assert np.abs(z[..., 2, :]).max() < LIFTING + 1e-6
    np.testing.assert_allclose(z[1:, :2, 0], z[:-1, :2, 1], atol=1e-9)


@pytest.mark.parametrize("impulse", [800.0, 900.0])
def test_the_body_goes_down_for_a_step_that_legs_do_not_span_at_its_height(stand, impulse):
    """Smoothly, until the next foot has left the ground; legs of which nobody knows how long they are stay as high."""
    gait = GaitParameters(
        steps=8, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95, apex_ss=0.0, apex_ds=0.0
    )
    push = Push(gait.lift_off(3) + 0.2, 0.1, np.array([impulse, 0.0, 0.0]))
    legs, com = replace(LEGS, height=0.85, length=0.94), np.array([0.0, 0.0, gait.com_height])
    heights = []
    for known in (LEGS, legs):
        planner = WalkingPlanner(gait, stand(), 0.22, 0.11, legs=known)
        trace = walk_pendulum(planner, stand(), gait.duration, com=com, pushes=(push,))
        assert trace.fall_time is None
        heights.append(np.array([(plan.com[:2, 2], plan.com_velocity[:2, 2], plan.com_acceleration[:2, 2])
                                 for plan in trace.plans]))  # fmt: skip
    level, z = heights
    np.testing.assert_allclose(level[:, 0], 0.95, atol=1e-9)
    assert 0.015 < 0.95 - z[:, 0].min() <= legs.lowering(2.0 * legs.radius) + 1e-9
    assert np.abs(z[..., 2, :]).max() < LIFTING + 1e-6
    np.testing.assert_allclose(z[1:, :2, 0], z[:-1, :2, 1], atol=1e-9)
    np.testing.assert_allclose(z[-1, 0], 0.95, atol=1e-6)
    apart = [(plan.com[0, 2], math.dist(*(foothold.position for foothold in plan.footholds)))
             for plan in trace.plans if plan.phase.kind is PhaseKind.DOUBLE]  # fmt: skip
    missing = [legs.lowering(stride) - (0.95 - height) for height, stride in apart if legs.lowering(stride) > 0.0]
    assert missing
    assert max(missing) < 0.005


def test_a_body_that_has_gone_down_comes_up_again_all_the_way(stand):
    """However little is left of it: a difference that would change nothing else does."""
    gait = GaitParameters(
        steps=6, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95, apex_ss=0.0, apex_ds=0.0
    )
    lowering = {2: 0.009, 3: 0.0035}

    def lowered(planner, state, feet):
        """Legs want the CoM lower after some steps."""
        planner.state = replace(planner.state, lowering=lowering.get(planner.state.landed, 0.0))
        return planner.update(state, feet)

    planner, com = WalkingPlanner(gait, stand(), 0.22, 0.11, legs=LEGS), np.array([0.0, 0.0, gait.com_height])
    plans = walk_pendulum(Attended(planner, lowered), stand(), gait.duration, com=com).plans
    lowest = {n: min(plan.com[0, 2] for plan in plans if plan.phase.step == n) for n in (3, 6)}
    assert lowest[3] == pytest.approx(0.941, abs=1e-9)
    assert lowest[6] == plans[-1].com[0, 2] == pytest.approx(0.95, abs=1e-9)


@pytest.mark.parametrize("since", [0.1, 0.34], ids=["a step that is adapted", "a step that is decided"])
def test_a_foot_that_is_to_catch_the_body_searches_for_the_ground_in_haste(stand, since):
    """And no other: a gentle search, for 4 mm, takes 0.06 s, in which the DCM goes a fifth farther away."""
    gait = GaitParameters(steps=4, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95)
    push = Push(gait.lift_off(2) + since, 0.1, np.array([400.0, 0.0, 0.0]))
    planner, com = WalkingPlanner(gait, stand(), 0.22, 0.11, legs=LEGS), np.array([0.0, 0.0, gait.com_height])
    plans = walk_pendulum(planner, stand(), gait.lift_off(4), com=com, pushes=(push,)).plans
    first, pushed = ([plan.swing for plan in plans if plan.swing is not None and plan.phase.step == n] for n in (1, 2))
    assert {swing.search for swing in first} == {P.search}
    assert pushed[0].search == P.search
    hasty = pushed[-1].search
    assert hasty == replace(P.search, hurry_after=0.0)
    assert hasty.motion(0.03)[0] > 0.004 > P.search.motion(0.06)[0]


@pytest.mark.parametrize(
    ("direction", "feet"), [(0.5 * math.pi, "LRLLRLR"), (-0.5 * math.pi, "LRLRLR"), (0.0, "LRLRLR")]
)
def test_a_foot_that_has_just_landed_steps_again_where_the_other_one_would_cross_it(stand, direction, feet):
    """Pushed to the left as the left foot has landed; not to the right, nor ahead. The step is one that was added.

    On legs whose steps take a while; quicker ones cross.
    """
    slow = replace(P, recovery=replace(P.recovery, least_single=0.16, least_double=0.06))
    gait = GaitParameters(steps=6, step_length=0.0, single_support=0.4, double_support=0.12, com_height=0.95)
    planner = WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=slow, legs=LEGS)
    com = np.array([0.0, 0.0, gait.com_height])
    push = Push(gait.lift_off(4) - 0.14, 0.1, 660.0 * np.array([math.cos(direction), math.sin(direction), 0.0]))
    trace = walk_pendulum(planner, stand(), gait.duration + 2.0, com=com, pushes=(push,))
    assert trace.fall_time is None
    swung = {plan.phase.step: plan.phase.stance.other for plan in trace.plans if plan.phase.kind is PhaseKind.SINGLE}
    assert "".join(swung[step].name[0] for step in sorted(swung)) == feet
    # Both feet stand between two steps, so that each is seen to land.
    single = [
        (a.phase, b.phase)
        for a, b in pairwise(trace.plans)
        if a.phase.stance is not None and b.phase.stance is not None
    ]
    assert all(a.step == b.step for a, b in single)
    assert trace.plans[-1].phase.kind is PhaseKind.STAND


@pytest.mark.parametrize(("share", "again"), [(0.5, True), (2.0, False)])
def test_a_foot_does_not_step_again_from_where_the_other_one_no_longer_is(stand, share, again):
    """One that landed short, or whose landing was put off, would be taken to stand where it was lifted."""
    asked, off = [], np.array([share * P.recovery.tolerance, 0.0, 0.0])

    def astray(view):
        feet = view.measured.feet
        moved = replace(view, measured=replace(view.measured, feet=replace(feet, position=feet.position + off)))
        found = goes_again(moved)
        asked.append(found is not moved)
        return replace(found, measured=view.measured)

    usual = PROFILES["default"]
    profile = replace(usual, rules=tuple(astray if rule is goes_again else rule for rule in usual.rules))
    slow = replace(P, recovery=replace(P.recovery, least_single=0.16, least_double=0.06))
    gait = GaitParameters(steps=6, step_length=0.0, single_support=0.4, double_support=0.12, com_height=0.95)
    push = Push(gait.lift_off(4) - 0.14, 0.1, 660.0 * np.array([0.0, 1.0, 0.0]))
    planner = WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=slow, legs=LEGS, profile=profile)
    walk_pendulum(planner, stand(), gait.lift_off(4) + 0.1, com=np.array([0.0, 0.0, 0.95]), pushes=(push,))
    assert any(asked) == again


def test_what_a_push_leaves_to_the_cop_moves_no_step(stand):
    """Not by what the TVMPC would save in jerk either."""
    gait = GaitParameters(steps=4, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95)
    push = Push(gait.lift_off(2) + 0.1, 0.1, 30.0 * np.array([1.0, 0.5, 0.0]))
    planner, com = WalkingPlanner(gait, stand(), 0.22, 0.11, legs=LEGS), np.array([0.0, 0.0, gait.com_height])
    trace = walk_pendulum(planner, stand(), gait.duration, com=com, pushes=(push,))
    moved = [plan.swing.target[:2] - (0.3 * min(plan.phase.step, 3), 0.1 * (-1) ** (plan.phase.step + 1))
             for plan in trace.plans if plan.swing is not None]  # fmt: skip
    assert np.abs(moved).max() < 1e-6


STANDING = GaitParameters(steps=0, single_support=0.5, double_support=0.12, com_height=0.95, initial_stand=0.2)


def stood(stand, impulse, direction, gait=STANDING, duration=6.0, adaptation=StepAdaptation.CROSSING):
    """A pendulum on two human-size feet, pushed at 0.5 s for 0.1 s [N·s/kg, rad]."""
    parameters = replace(P, step_adaptation=adaptation)
    planner = WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=parameters, legs=LEGS)
    push = Push(0.5, 0.1, 1000.0 * impulse * np.array([np.cos(direction), np.sin(direction), 0.0]))
    return walk_pendulum(planner, stand(), duration, com=np.array([0.0, 0.0, gait.com_height]), pushes=(push,))


@pytest.mark.parametrize(
    ("impulse", "direction"), [(0.5, 0.0), (0.6, 0.5 * np.pi), (0.6, 0.8 * np.pi), (0.6, -0.4 * np.pi)]
)
def test_who_stands_steps_when_ankles_do_not_hold_it_and_then_stands_again(stand, impulse, direction):
    trace = stood(stand, impulse, direction, duration=4.5)
    assert trace.fall_time is None
    last = trace.plans[-1]
    assert last.phase.kind is PhaseKind.STAND
    assert last.phase.step >= 1
    way = (last.footholds[0].position - last.footholds[1].position)[:2]
    np.testing.assert_allclose(way, (0.0, 0.2), atol=2e-3)
    np.testing.assert_allclose(last.com_velocity[0], 0.0, atol=5e-3)
    assert stood(stand, impulse, direction, duration=3.0, adaptation=StepAdaptation.NONE).fall_time is not None


@pytest.mark.parametrize("direction", [0.0, 0.4 * np.pi, np.pi])
def test_who_is_held_by_its_ankles_stays(stand, direction):
    """0.85 of the box reaches 0.09 m ahead, and sideways 0.13 m: both feet are beside one another."""
    most = (
        0.85
        * P.foot_margin
        * np.array([0.11, 0.155])
        / np.maximum(np.abs([np.cos(direction), np.sin(direction)]), 1e-9)
    )
    omega = np.sqrt(9.81 / 0.95)
    trace = stood(stand, 0.9 * omega * most.min(), direction, duration=2.0)
    assert trace.fall_time is None
    assert {plan.phase.kind for plan in trace.plans} == {PhaseKind.STAND}


def test_the_walk_goes_on_as_if_it_had_not_been_pushed_while_it_stood(stand):
    gait = replace(STANDING, steps=4, step_length=0.3, initial_stand=3.0)
    trace = stood(stand, 0.4, 0.0, gait, gait.duration + 5.0)
    assert trace.fall_time is None
    taken = trace.plans[-1].phase.step
    assert taken > 4
    ahead = {plan.phase.step: plan.swing.target[0] for plan in trace.plans if plan.swing is not None}
    strides = np.diff([ahead[step] for step in range(taken - 4, taken + 1)])
    np.testing.assert_allclose(strides, (0.3, 0.3, 0.3, 0.0), atol=2e-3)


def test_who_ends_its_walk_goes_on_when_it_is_pushed(stand):
    """In its last swing, in the double support after it, and right when it stands."""
    gait = replace(STANDING, steps=3, step_length=0.3)
    com = np.array([0.0, 0.0, gait.com_height])
    for begin in (gait.lift_off(3) + 0.2, gait.lift_off(3) + 0.52, gait.duration):
        planner = WalkingPlanner(gait, stand(), 0.22, 0.11, legs=LEGS)
        push = Push(begin, 0.1, np.array([450.0, 0.0, 0.0]))
        trace = walk_pendulum(planner, stand(), gait.duration + 4.5, com=com, pushes=(push,))
        assert trace.fall_time is None
        last = trace.plans[-1]
        assert last.phase.kind is PhaseKind.STAND
        assert last.phase.step > 3
        way = (last.footholds[0].position - last.footholds[1].position)[:2]
        np.testing.assert_allclose(way, (0.0, 0.2), atol=0.012)


@pytest.mark.parametrize("level", LEVELS)
def test_an_undisturbed_walk_is_not_adapted(stand, level):
    gait = GaitParameters(steps=5, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95)
    parameters = replace(P, step_adaptation=level)
    com = np.array([0.0, 0.0, gait.com_height])
    trace = walk_pendulum(
        WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=parameters, legs=LEGS), stand(), gait.duration, com=com
    )
    swung = {plan.phase.step: plan for plan in trace.plans if plan.swing is not None}
    assert sorted(swung) == [1, 2, 3, 4, 5]
    for step, plan in swung.items():
        np.testing.assert_allclose(plan.swing.target[0], 0.3 * min(step, 4), atol=1e-3)
        assert abs(plan.time - gait.lift_off(step) - gait.single_support) < 1.5 * T


DESCENT = GaitParameters(steps=7, step_length=0.28, single_support=0.9, double_support=0.3, initial_stand=0.4)


def down_stairs(stand, impulse, **keys):
    """A pendulum that is pushed over its right stance foot early in step 3 of seven down a flight [N·s/kg]."""
    terrain = Stairs(0.185, 0.28, 6, Direction.DOWN, start=0.14, landing=1.0, beyond=2.0).build(
        Site(np.zeros(2), 0.0, 0.8)
    )
    feet = stand()
    feet.position[:, 2] = terrain.height(0.0, 0.0)
    planner = WalkingPlanner(
        DESCENT, feet, 0.22, 0.11, terrain=terrain, height_profile=SmoothHeight(Rise.SINGLE), legs=LEGS, **keys
    )
    push = Push(DESCENT.lift_off(3) + 0.18, 0.1, np.array([0.0, -1000.0 * impulse, 0.0]))
    com = np.array([0.0, 0.0, feet.position[0, 2] + DESCENT.com_height])
    return terrain, walk_pendulum(planner, feet, DESCENT.duration + 5.0, com=com, pushes=(push,))


@pytest.mark.parametrize(
    ("impulse", "treads"), [(0.0, range(1, 7)), (0.18, range(1, 7)), (0.22, (1, 2, 3, 2, 3, 4, 5, 6))]
)
def test_on_stairs_both_feet_step_where_they_are_before_the_walk_goes_on(stand, impulse, treads):
    """To the side of the push, where a foot must not cross: the one on which it stood lands again, farther out."""
    terrain, trace = down_stairs(stand, impulse)
    assert trace.fall_time is None
    last = trace.plans[-1]
    assert last.phase.kind is PhaseKind.STAND
    landed = {plan.phase.step: plan.swing.target for plan in trace.plans if plan.swing is not None}
    assert [round(landed[step][0] / 0.28) for step in sorted(landed)] == [*treads, 6]
    for target in landed.values():
        assert target[2] == pytest.approx(terrain.height(*target[:2]), abs=1e-6)
        assert abs(target[0] / 0.28 - round(target[0] / 0.28)) < 0.1
    beside = last.footholds[0].position[1] - last.footholds[1].position[1]
    assert beside == pytest.approx(0.2, abs=0.02)
    # However it is hurried after its first fifth, the body goes down a riser by no more than LIFTING.
    lasted = T * sum(plan.phase.step == 3 and plan.swing is not None for plan in trace.plans)
    assert lasted > 0.18 + 0.8 * math.sqrt(PEAK * 0.185 / LIFTING) - T
