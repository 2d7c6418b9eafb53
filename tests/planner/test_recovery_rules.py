"""Each rule of recovery is a pure function of a view: it acts where it says, by its law, and leaves all else alone."""

import math
from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import LEGS, Attended, walk_pendulum

from surefoot.forces import Push
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.rules import RULES, adds_steps, adjusts, ends, goes_again, retimes, steps_out
from surefoot.planner.state import SwingStage
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import Foot, PhaseKind

pytestmark = pytest.mark.unit

P = PlannerParameters()
SLOW = replace(P, recovery=replace(P.recovery, least_single=0.16, least_double=0.06))
MARCH = GaitParameters(steps=6, step_length=0.0, single_support=0.4, double_support=0.12, com_height=0.95)
WALK = GaitParameters(steps=4, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95)
STAND = GaitParameters(steps=0, com_height=0.95)


def force(size, direction=0.0):
    return size * np.array([math.cos(direction), math.sin(direction), 0.0])


CASES = {
    "beside the foot that landed": (MARCH, SLOW, Push(MARCH.lift_off(4) - 0.14, 0.1, force(660.0, 0.5 * math.pi)), 5.0),
    "as it stands": (STAND, P, Push(1.0, 0.1, force(450.0, 0.3)), 3.0),
    "in a swing": (WALK, P, Push(WALK.lift_off(2) + 0.1, 0.1, force(400.0)), 5.0),
    "in the last swing": (WALK, P, Push(WALK.lift_off(4) + 0.1, 0.1, force(450.0)), 5.0),
}


@pytest.fixture(scope="module")
def acted(request):
    """Views that each rule was given and made, in walks that are pushed, where it changed something."""
    stand = request.getfixturevalue("stand")
    found = {rule: [] for rule in RULES}

    def watched(rule):
        def watch(view):
            made = rule(view)
            if made is not view:
                found[rule].append((view, made))
            return made

        return watch

    profile = replace(PROFILES["default"], rules=tuple(map(watched, RULES)))
    for gait, parameters, push, end in CASES.values():
        planner = WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=parameters, legs=LEGS, profile=profile)
        walk_pendulum(planner, stand(), end, com=np.array([0.0, 0.0, gait.com_height]), pushes=(push,))
    return found


@pytest.mark.parametrize("case", list(CASES))
def test_a_plan_has_the_names_of_the_rules_that_acted(stand, case):
    """They are rules that changed the view, and no others."""
    gait, parameters, push, end = CASES[case]
    changed, named = [], []

    class Watched:
        def __init__(self, rule):
            self.rule, self.__name__ = rule, rule.__name__

        def __call__(self, view):
            made = self.rule(view)
            if made is not view:
                changed.append((view.measured.time, self.__name__))
            return made

    profile = replace(PROFILES["default"], rules=tuple(map(Watched, RULES)))
    planner = WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=parameters, legs=LEGS, profile=profile)

    def update(planner, state, feet):
        plan = planner.update(state, feet)
        named.extend((plan.time, name) for name in plan.status.acted)
        return plan

    watched = Attended(planner, update)
    walk_pendulum(watched, stand(), end, com=np.array([0.0, 0.0, gait.com_height]), pushes=(push,))
    assert named == changed
    assert "adjusts" in {name for _, name in named}


def inserted(view):
    """Steps to come that were inserted."""
    return sum(step.inserted for step in view.state.schedule.after(view.state.landed))


@pytest.mark.parametrize("rule", [rule for rule in RULES if rule is not ends], ids=lambda rule: rule.__name__)
def test_a_rule_makes_the_same_of_the_same_view_and_leaves_it_as_it_was(acted, rule):
    assert acted[rule], "no push asks for it"
    for view, made in acted[rule][:5]:
        clock, local = view.state.clock, view.local.copy()
        again = rule(view)
        assert again is not view
        np.testing.assert_array_equal(again.state.schedule.positions, made.state.schedule.positions)
        assert again.state.clock == made.state.clock
        np.testing.assert_array_equal(again.window.offset, made.window.offset)
        assert view.state.clock is clock
        np.testing.assert_array_equal(view.local, local)


def test_a_robot_that_stands_and_is_pushed_makes_a_step(acted):
    for view, made in acted[steps_out]:
        assert view.state.stops
        assert inserted(made) > inserted(view)
        assert made.state.info.leads_to


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_foot_that_carries_stays_and_the_other_one_steps(stand, side):
    """A push to the left puts the weight on the left foot, so that the right one steps."""
    made = []

    def watched(view):
        after = steps_out(view)
        if after is not view:
            made.append((view, after))
        return after

    profile = replace(PROFILES["default"], rules=(watched, adjusts, retimes))
    planner = WalkingPlanner(STAND, stand(), 0.22, 0.11, legs=LEGS, profile=profile)
    push = Push(1.0, 0.1, force(450.0, 0.5 * math.pi * side))
    walk_pendulum(planner, stand(), 1.3, com=np.array([0.0, 0.0, STAND.com_height]), pushes=(push,))
    view, after = made[0]
    assert side * view.off[1] > P.recovery.tolerance
    step = after.state.schedule.step(after.state.landed + 1)
    assert step.place.foot is (Foot.RIGHT if side > 0.0 else Foot.LEFT)


def test_the_same_foot_goes_again_only_where_that_captures_more(acted):
    for view, made in acted[goes_again]:
        foot = view.state.schedule.step(view.state.landed).place.foot
        assert made.state.schedule.step(made.state.landed + 1).place.foot is foot
        assert made.balance.movable >= view.balance.movable + SLOW.recovery.tolerance
        assert view.balance.planned < -SLOW.recovery.tolerance


def test_a_step_that_is_adjusted_is_bounded_and_stays_where_it_is(acted):
    for view, made in acted[adjusts]:
        assert made.bounds is not None
        assert made.state.adapted
        assert made.state.schedule is view.state.schedule
        assert made.window is view.window


def test_steps_are_added_for_what_the_next_one_leaves(acted):
    for view, made in acted[adds_steps]:
        assert view.bounds.more
        assert inserted(made) > inserted(view)
        assert made.balance is view.balance


def test_the_phase_ends_when_the_step_is_to(acted):
    exact = 0
    for view, made in acted[retimes]:
        assert made.state.time_left != view.state.time_left
        assert abs(made.state.time_left - view.bounds.left) < abs(view.state.time_left - view.bounds.left) + 1e-9
        exact += made.state.time_left == pytest.approx(view.bounds.left, abs=1e-9)
        assert made.balance.delay - view.balance.delay == pytest.approx(made.state.time_left - view.state.time_left)
    assert exact > 0.5 * len(acted[retimes])


def test_single_support_of_a_step_that_catches_ends_where_the_cop_then_captures_more(acted):
    """The pendulum's feet land on time; so one that flies is said to arrive."""
    told = []
    for view, _ in acted[adjusts]:
        state = view.state
        if state.phase.kind is PhaseKind.SINGLE:
            swing = replace(state.swing, stage=SwingStage.DECIDED)
            feet = replace(view.measured.feet, arriving=(True, True))
            told.append(replace(view, state=replace(state, swing=swing), measured=replace(view.measured, feet=feet)))
    made = [(view, ends(view)) for view in told]
    over = [(view, other) for view, other in made if other is not view]
    assert 0 < len(over) < len(made)
    for view, other in over:
        assert other.planned > view.planned
        assert other.state.landed == view.state.landed + 1
        assert other.state.phase.kind is not PhaseKind.SINGLE
        assert not other.state.adapted
    for view, _ in made:  # negative control: none arrives
        away = replace(view, measured=replace(view.measured, feet=replace(view.measured.feet, arriving=(False, False))))
        assert ends(away) is away


def test_a_walk_that_nobody_pushes_asks_for_no_rule(stand):
    asked = []

    def watched(rule):
        def watch(view):
            made = rule(view)
            asked.append(made is not view)
            return made

        return watch

    profile = replace(PROFILES["default"], rules=tuple(map(watched, RULES)))
    planner = WalkingPlanner(WALK, stand(), 0.22, 0.11, legs=LEGS, profile=profile)
    walk_pendulum(planner, stand(), 2.0, com=np.array([0.0, 0.0, 0.95]))
    assert asked
    assert not any(asked)


def test_a_rule_of_ones_own_is_gone_through_with_the_others_and_one_that_is_left_out_is_not(stand):
    """Here one that lets the next foot land no sooner than planned; without `adjusts` no step is moved."""
    push = Push(WALK.lift_off(2) + 0.1, 0.1, force(400.0))

    def fall(rules):
        profile = replace(PROFILES["default"], rules=rules)
        planner = WalkingPlanner(WALK, stand(), 0.22, 0.11, legs=LEGS, profile=profile)
        trace = walk_pendulum(planner, stand(), 5.0, com=np.array([0.0, 0.0, 0.95]), pushes=(push,))
        return trace.fall_time

    def never_sooner(view):
        if view.bounds is None or view.bounds.left >= view.state.time_left:
            return view
        return replace(view, bounds=replace(view.bounds, left=view.state.time_left))

    assert fall(RULES) is None
    assert fall((ends, steps_out, goes_again, adds_steps, retimes)) is not None
    patient = fall((*RULES[:-1], never_sooner, retimes))
    assert patient is None or patient > WALK.lift_off(2) + 0.2
