"""The events since the last tick: the clock went on, feet landed or slid, the walk was given a command."""

import math
from dataclasses import replace

from surefoot.planner.measured import Measured
from surefoot.planner.model.time_scaling import CLOCK_ROUNDING, TimeScaling
from surefoot.planner.state import Orders, SwingStage, WalkState
from surefoot.planner.steps import adaptation
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import PhaseKind

_LEAST_LEFT = 3.0
"""A phase of which less is left, or would be, until its foot is to touch down keeps its time [samples]."""


def track(state: WalkState, measured: Measured) -> WalkState:
    """The state one tick later.

    Raises:
        ParameterError: of the steps that come into sight, see `Schedule.extended`.
    """
    return decided(obeyed(advanced(state, measured), measured.time), measured)


def advanced(state: WalkState, measured: Measured) -> WalkState:
    """The state when the clock has gone on by a sample, with the feet as measured.

    A touchdown that is late holds the clock at the end of single support. An early one decides its footstep where it
    was felt. It does not move the clock: that was measured to cost 17 to 28 mm of DCM error. Single support of a step
    that catches the body may end with its touchdown (see `planner.rules.ends`). A foot that lands short of the DCM on
    its own side goes on, where it may get there: its single support begins anew.
    """
    clock, phase, feet = state.clock.advanced(), state.phase, measured.feet
    over = clock.now >= phase.end - CLOCK_ROUNDING
    if phase.swing_foot is not None and state.clock.now >= 0.0:
        return _swung(state, measured, clock, over)
    if over:
        return state.on(state.schedule.forgotten(clock.now), clock)
    if phase.kind is not PhaseKind.STAND:
        return replace(state, clock=clock)
    schedule = adaptation.with_feet_slid(state.schedule, state.landed, feet, state.model.parameters.size.length)
    state = replace(state, schedule=schedule, clock=clock)
    return state.on(schedule) if phase.samples == math.inf else state


def _swung(state: WalkState, measured: Measured, clock: TimeScaling, over: bool) -> WalkState:
    """The state in single support when the clock would show this, at which the phase is over or not."""
    phase, swing, feet = state.phase, state.swing, measured.feet
    assert phase.swing_foot is not None
    contact, position = feet.contact[phase.swing_foot], feet.position[phase.swing_foot]
    past_half = 2.0 * (clock.now - phase.start) > phase.samples
    felt = contact and swing.stage is not SwingStage.LANDED and past_half
    if contact and (over or felt) and lands_short(state, measured):
        return state.swinging_anew(clock)
    patience = round(state.model.parameters.late_touchdown / clock.sample_time)
    if over and not contact and swing.waited < patience:
        return replace(state, swing=replace(swing, stage=SwingStage.SEARCHING, waited=swing.waited + 1))
    if over:
        return state.landing(position, clock)
    state = replace(state, clock=clock)
    return state.deciding(position, SwingStage.LANDED) if felt else state


def lands_short(state: WalkState, measured: Measured) -> bool:
    """The foot that lands now is short of the DCM on its own side, and may still get there."""
    if not state.model.times or state.plan is None:
        return False
    dcm = measured.dcm(state.plan.omega.item(0))
    return adaptation.lands_short(state.schedule, state.landed, measured.feet, dcm, state.model.legs)


def obeyed(state: WalkState, time: float) -> WalkState:
    """The state that obeys the commands since the last tick, at a time [s].

    A step that is being swung, or to which the weight is being shifted, is taken as it was planned.
    """
    orders = state.orders
    if orders.new is None:
        return state
    gait, source = orders.new
    state = replace(state, orders=Orders(source or orders.source))
    before = state.schedule.gait
    gait = replace(gait, first_foot=before.first_foot)
    if (gait.single_support, gait.double_support) != (before.single_support, before.double_support):
        state = _retimed(state, gait, time)
    state = replace(state, schedule=replace(state.schedule, gait=gait))
    if source is None and gait.swing_height == before.swing_height:
        return state
    return state.on(state.schedule.reordered(state.clock.now, source))


def _retimed(state: WalkState, gait: GaitParameters, time: float) -> WalkState:
    """The state with durations of another gait; what is left of the present phase changes in proportion to its own."""
    left, phase, clock = state.time_left, state.phase, state.clock
    lead = state.model.parameters.touchdown_lead / clock.sample_time
    schedule, way = state.schedule.retimed(gait, clock.now), phase.end - clock.now
    lasting = schedule.usual_samples(phase) * way / phase.samples
    if phase.kind is not PhaseKind.STAND and min(way, lasting) >= _LEAST_LEFT + lead:
        clock = clock.scaled(way, lasting)
    return state.on(schedule, clock).swing_put_off(time, left)


def decided(state: WalkState, measured: Measured) -> WalkState:
    """The state in which the next footstep is decided shortly before it lands.

    With no margin left its foot searches for the ground in haste.
    """
    swing, p, time = state.swing.trajectory, state.model.parameters, measured.time
    frozen = (p.freeze_catching if state.catching else p.freeze_time) + CLOCK_ROUNDING
    if swing is None or swing.touchdown_time - time > frozen:
        return state
    lost = state.plan is not None and state.plan.balance.planned < 0.0
    late = max(time - swing.touchdown_time, 0.0)
    if lost and late < swing.search.hurry_after:
        # While the foot searches for the ground a DCM that no CoP holds goes on away from it.
        swing = replace(swing, search=replace(swing.search, hurry_after=late))
        state = replace(state, swing=replace(state.swing, trajectory=swing))
    return state if state.decided else state.deciding(swing.footstep)


def ended(state: WalkState, measured: Measured) -> WalkState:
    """The state in which the foot that swings has landed where it is, and single support is over."""
    foot = state.phase.swing_foot
    assert foot is not None
    return state.landing(measured.feet.position[foot], state.clock.showing(state.phase.end))


def going_again(state: WalkState) -> WalkState:
    """The state in which the foot that landed last makes the next step as well, and the weight goes back."""
    phase, clock = state.phase, state.clock
    schedule = adaptation.with_foot_again(state.schedule, state.landed)
    gone = 1.0 if phase.kind is PhaseKind.SINGLE else (clock.now - phase.start) / phase.samples
    step = schedule.step(state.landed)
    return state.on(schedule, clock.showing(step.touchdown + (1.0 - gone) * step.double_support))
