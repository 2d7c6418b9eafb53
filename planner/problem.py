"""The problem of a tick for the law of motion, out of what is seen and what is made of the next steps."""

import numpy as np

from surefoot.planner.laws.law import MotionProblem, StepContext
from surefoot.planner.look import View
from surefoot.planner.steps.step import room_left
from surefoot.planner.swing.step_region import Shifts, reachable_shifts, shifts_within, unshifted
from surefoot.planner.types import Array, PhaseKind


def problem_of(view: View) -> MotionProblem:
    """The problem of a tick, in the plan frame."""
    state, window = view.state, view.window
    before = np.zeros((state.model.parameters.horizon, 2)) if state.plan is None else state.plan.jerk
    ahead = window.stiffness, window.omega, window.driving
    return MotionProblem.after(before, view.local, ahead, _steps(view), view.support.rotation, state.law_memory)


def _steps(view: View) -> StepContext:
    """The next two footsteps as the law may shift them."""
    state, here, left, transfer = view.state, None, 0.0, 0.0
    if view.step is not None and state.phase.kind is PhaseKind.SINGLE:
        double = state.schedule.step(state.phase.step).double_support
        here, left, transfer = view.step.swing[0], state.time_left, double * state.clock.sample_time
    increment, free, side = view.support.increment, state.free, -state.schedule.step(state.landed).place.foot.side
    bounds = _bounds(view, increment, here, left)
    return StepContext(increment, (side, -side), free, here, left, transfer, *bounds)


def _bounds(view: View, increment: Array, here: Array | None, left: float) -> Shifts:
    """Boxes in which the next two footsteps may land.

    Args:
        view: of the tick.
        increment: their nominal displacements from the foothold before, in the plan frame, shape (2, 2) [m].
        here: position of the swing foot from the stance foot, shape (2,) [m], or None when no foot swings.
        left: time until the first of them lands [s].
    """
    state, model, schedule = view.state, view.state.model, view.state.schedule
    stance, legs, free = schedule.step(state.landed).place, model.legs, state.free
    if legs is None:
        return reachable_shifts(model.parameters, increment, stance.foot.other.side, free, here, left)
    if not state.adapted:
        return unshifted(free)
    boxes = np.stack((increment, increment), axis=1)
    for n, step in enumerate(schedule.after(state.landed)[:2]):
        room = increment[n] + room_left(step, stance, model.parameters.recovery.parallel)
        low, high = legs.turned(schedule.turn(step.number)).beside(increment[n], step.place.foot.side)
        boxes[n] = np.maximum(low, room[0]), np.minimum(high, room[1])
    if view.bounds is not None:
        boxes[0] = view.bounds.box
    return shifts_within(boxes, increment, free)
