"""The rules of recovery, for a walk whose CoP alone does not hold the body; they are gone through in order.

A rule is a pure function from a view to a view: the same one where it does nothing, else that of another state. What
would come of a state is asked by the same look, and nobody keeps it.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from surefoot.planner.look import View
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING
from surefoot.planner.state import SwingStage, WalkState
from surefoot.planner.steps.adaptation import with_step_in_place, with_steps_repeated
from surefoot.planner.track import ended, going_again, lands_short
from surefoot.planner.types import Foot, PhaseKind


class Rule(Protocol):
    """Something that is made of the steps to come where they do not hold the body."""

    def __call__(self, view: View, /) -> View:
        """The same view where nothing is made, else that of what is; of what it is given it changes nothing."""


def rule_name(rule: Rule) -> str:
    """The name of a rule: that of its function, or of its class."""
    return str(getattr(rule, "__name__", type(rule).__name__))


def gone_through(rules: Sequence[Rule], view: View) -> tuple[View, tuple[str, ...]]:
    """The view that rules make of a view, one after the other, and the names of those that made something."""
    acted = []
    for rule in rules:
        before, view = view, rule(view)
        if view is not before:
            acted.append(rule_name(rule))
    return view, tuple(acted)


def ends(view: View) -> View:
    """Single support of a step that catches the body ends with its touchdown.

    It ends where the CoP captures more at once, from both feet, than after the wait for the planned time. A DCM that
    has gone too far goes farther while the foot waits. One that is short of the foot would need a next step to catch
    it, and that step another one.
    """
    if not may_end(view):
        return view
    other = view.of(ended(view.state, view.measured))
    return view if other.planned <= view.planned else other


def may_end(view: View) -> bool:
    """The foot of a step that catches has landed early, or is about to, and not short of the DCM."""
    state, foot = view.state, view.state.phase.swing_foot
    if foot is None or not (state.adapted and state.model.times and state.decided):
        return False
    past_half = 2.0 * (state.clock.now - state.phase.start) > state.phase.samples
    arrives = state.swing.stage is SwingStage.LANDED or view.measured.feet.arriving[foot]
    return past_half and bool(arrives) and not lands_short(state, view.measured)


def steps_out(view: View) -> View:
    """A robot that stands, and would fall or stands astride, makes a step."""
    state, model = view.state, view.state.model
    if not state.stops or model.adjustment is None or not model.adapts or state.info.leads_to:
        return view
    now, numbers, standing = state.clock.now, model.parameters.recovery, state.phase.kind is PhaseKind.STAND
    error, box = view.off.tolist(), view.window.driving.half_size[-1].tolist()
    if all(abs(off) <= numbers.stand_share * half for off, half in zip(error, box, strict=True)):
        # Once it is at rest the robot brings its feet side by side again.
        # Feet without a CoP of their own would end in a wide step, since there is no time to shift the weight.
        calm = model.parameters.cop_authority[1] > 0.0 and max(map(abs, error)) < numbers.calm
        here, usual = state.schedule.apart(state.landed)
        if not (calm and standing and float(np.hypot(*(here - usual))) > numbers.apart):
            return view
        return view.of(state.on(with_step_in_place(state.schedule, now, at_once=False)))
    # The foot that carries stays, and the other one is brought to it.
    foot = None
    if standing and abs(error[1]) > numbers.tolerance:
        foot = Foot.RIGHT if error[1] > 0.0 else Foot.LEFT
    return view.of(state.on(with_step_in_place(state.schedule, now, foot)))


def goes_again(view: View) -> View:
    """The foot that landed last makes the next step as well, where that captures clearly more.

    The DCM is past its inner edge, and the other foot would have to cross it. The weight has to go back meanwhile, in
    which the DCM goes on: ahead, that may be more than the steps after it catch. Steps alternate on from there.
    """
    state, feet, uncertainty = view.state, view.measured.feet, view.uncertainty
    model, numbers = state.model, state.model.parameters.recovery
    if view.balance.planned + uncertainty > -numbers.tolerance or model.adjustment is None or not may_go_again(state):
        return view
    foot = state.schedule.step(state.landed).place.foot
    if not feet.contact[foot] or foot.side * float(view.dcm[1]) <= -float(model.half_size[1]):
        return view
    other = going_again(state)
    stance = other.schedule.step(other.landed).place
    # A foot that landed short, or whose landing was put off, is no longer where the schedule has it.
    if math.dist(feet.position[stance.foot], stance.position) > numbers.tolerance:
        return view
    again = view.of(other)
    if again.step is None or again.balance.movable < view.balance.movable + numbers.tolerance:
        return view
    found = model.adjustment.solve(again.com, again.dcm, again.window, again.step, uncertainty)
    return view if found is not None and found.cost > numbers.again_cost else again


def may_go_again(state: WalkState) -> bool:
    """The foot that landed last may make the next step as well: the other one is still on the ground."""
    phase, now = state.phase, state.clock.now
    if not state.model.times or state.decided or not state.info.leads_to:
        return False
    rolls = any(span.angle > 0.0 and now > span.start for span in phase.rolls)
    # A plan in which it stands lies between its steps, so that it is seen to land.
    stood = phase.kind is PhaseKind.SINGLE or now > phase.start + CLOCK_ROUNDING
    flies = state.swing.trajectory is not None
    return not flies and stood and not rolls and state.schedule.step(state.landed + 1).stop is None


def adjusts(view: View) -> View:
    """Place and time of the next step are bounded anew where the CoP alone does not hold the body."""
    state, adjustment = view.state, view.state.model.adjustment
    if adjustment is None or view.step is None or not state.free[0]:
        return view
    bounds = adjustment.solve(view.com, view.dcm, view.window, view.step, view.uncertainty)
    if bounds is None:
        return view
    return replace(view, bounds=bounds, state=state if state.adapted else replace(state, adapted=True))


def adds_steps(view: View) -> View:
    """Steps are inserted before those to come where the next one leaves something to catch.

    A robot that would stand makes one on the spot. On faces that footsteps were chosen for, one step of each foot where
    it stands is sooner made than one that climbs. What the steps are to catch is the margin of before.
    """
    state, schedule, now = view.state, view.state.schedule, view.state.clock.now
    if view.bounds is None or not view.bounds.more:
        return view
    if schedule.stops(now):
        longer = with_step_in_place(schedule, now)
    elif view.balance.planned < 0.0 and schedule.climbs_next(now):
        longer = with_steps_repeated(schedule, state.phase.step)
    else:
        return view
    return adjusts(replace(view.of(state.on(longer)), balance=view.balance))


def retimes(view: View) -> View:
    """The present phase ends when the next step is to."""
    state, time = view.state, view.measured.time
    other = state if view.bounds is None else state.ending_in(view.bounds.left, time)
    if other is state:
        return view
    delay = view.balance.delay + (other.time_left - state.time_left)
    return replace(view.retimed(other), balance=replace(view.balance, delay=delay))


RULES: tuple[Rule, ...] = (ends, steps_out, goes_again, adjusts, adds_steps, retimes)
"""The rules in their order."""
