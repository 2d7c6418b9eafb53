"""The landing places of the next footsteps, and the way of the swing foot there."""

import math
from dataclasses import replace

import numpy as np

from surefoot.planner.geometry.plane import greatest, sole_pose, wrap_angle
from surefoot.planner.measured import Measured
from surefoot.planner.state import WalkState
from surefoot.planner.steps.adaptation import with_roll
from surefoot.planner.swing.leg_reach import around_stance_leg
from surefoot.planner.swing.rolling import landing_pitch
from surefoot.planner.swing.trajectory import LEAST_GLIDE, SwingTrajectory, start_swing
from surefoot.planner.types import Array, FeetState, Footstep

_SAME_GROUND = 1e-3
"""Footstep shift up to which the ground height is not looked up again, of the reference robot [m]."""

_SAME_TARGET = 1e-4
"""Difference of touchdown pose that is not worth a new swing trajectory, of the reference robot [m, rad]."""

_SAME_PITCH = 0.01
"""Difference of a landing's pitch that is not worth another roll [rad]."""

_LEAST_LEFT = 4.0
"""Time left of a swing, over that by which it arrives sooner, below which it goes on as it is [-]."""

_IN_PLAN = 3
"""Footsteps to come that a plan tells [-]."""


def upcoming(state: WalkState, time: float, shifts: Array) -> tuple[Footstep, ...]:
    """The next footsteps.

    Args:
        state: now.
        time: now [s].
        shifts: of the first two from their nominal increments, in the world frame, shape (2, 2) [m].
    """
    planned = []
    ahead = 0.0
    left = 0.0
    ways = shifts.tolist()
    free = state.free
    for n, step in enumerate(state.schedule.after(state.landed)[:_IN_PLAN]):
        x, y = ways[n] if n < len(ways) and free[n] else (0.0, 0.0)
        ahead, left = (ahead + x, left + y) if state.model.follows else (x, y)
        place = _shifted(state, step.place, ahead, left)
        touchdown = time + state.clock.until(step.touchdown) * state.clock.sample_time
        planned.append(Footstep(place.foot, place.position, place.yaw, place.normal, step.number, touchdown))
    return tuple(planned)


def _shifted(state: WalkState, place: Footstep, ahead: float, left: float) -> Footstep:
    """A footstep so far off in the world frame [m], on the ground that is there."""
    if ahead == 0.0 and left == 0.0:
        return place
    x, y, z = place.position.tolist()
    x = x + ahead
    y = y + left
    normal = place.normal
    terrain = state.model.terrain
    if abs(ahead) + abs(left) > _SAME_GROUND * state.model.parameters.size.length:
        z = terrain.height(x, y)
        normal = terrain.normal(x, y) if terrain.has_edges else normal
    return replace(place, position=np.array([x, y, z]), normal=normal)


def swinging_to(state: WalkState, landing: Footstep, measured: Measured, held: bool) -> WalkState:
    """The state whose swing foot goes on to where it is to land, in single support.

    Args:
        state: now.
        landing: the footstep.
        measured: with the feet, from one of which a swing begins.
        held: keep to the target of before.
    """
    model, stance, swing = state.model, state.schedule.step(state.landed).place, state.swing.trajectory
    astray, lowering, time = state.astray, state.lowering, measured.time
    if swing is None:
        # Of the place where it landed the height is believed, too: what is off is off in both, and not the map.
        x, y, height = measured.feet.position[stance.foot].tolist()
        astray = model.parameters.search.astray(astray, height - model.terrain.height(x, y))
        swing = _begun(state, landing, time, measured.feet, astray)
    elif not (state.decided or held):
        swing = _aimed(state, swing, landing, time)
    if model.legs is not None:
        lowering = model.legs.lowering(math.dist(landing.position, stance.position)) if state.catching else 0.0
        swing = around_stance_leg(swing, stance, model.legs, time, state.clock.sample_time)
    pitched = _pitched(state, landing, stance)
    if state.adapted and pitched is not state and state.swing.trajectory is not None:
        swing = _arriving_flat(state, swing, time)
    flown = replace(state.swing, trajectory=swing)
    return replace(pitched, swing=flown, astray=astray, lowering=lowering)


def _pitched(state: WalkState, landing: Footstep, stance: Footstep) -> WalkState:
    """The state whose swing foot lands on its heel as its way asks, unless its toes are on their way up.

    One that catches the body lands flat: its double support is cut short, and the sole would slap down.
    """
    step, gait = state.schedule.step(state.phase.step), state.model.gait
    span = step.heel_strike
    if span is None or state.clock.now >= span.start:
        return state
    most = 0.0 if state.adapted else gait.heel_strike
    pitch = landing_pitch(stance, landing, float(state.model.half_size[0]), gait.step_length, most)
    if abs(pitch + span.angle) <= _SAME_PITCH:
        return state
    return state.on(with_roll(state.schedule, span, -pitch))


def _arriving_flat(state: WalkState, swing: SwingTrajectory, time: float) -> SwingTrajectory:
    """The swing of a foot that was to land on its heel, which arrives as one that lands flat from now on."""
    course, parameters = state.schedule.step(state.phase.step).course, state.model.parameters
    sooner, left = (1.0 - course.lead) * parameters.touchdown_lead, swing.touchdown_time - time
    if left <= _LEAST_LEFT * sooner:
        return swing
    speed = swing.search.touchdown_speed - course.sinking * parameters.size.factor("m/s")
    softer = replace(swing, search=replace(swing.search, touchdown_speed=speed))
    return softer.retimed(time, -sooner, state.clock.sample_time)


def _begun(state: WalkState, landing: Footstep, time: float, feet: FeetState, astray: float) -> SwingTrajectory:
    """A swing from where the foot is."""
    target = sole_pose(landing.position, landing.yaw, landing.normal)
    foot, leaving = landing.foot, state.schedule.step(state.landed - 1).place
    yaw = leaving.yaw + wrap_angle(float(feet.yaw[foot]) - leaving.yaw)
    pose = sole_pose(feet.position[foot], yaw, leaving.normal)
    doubt, course = (feet.height_deviation, astray), state.schedule.step(state.phase.step).course
    model = state.model
    if state.adapted:
        course = replace(course, braking=0.0, lead=1.0, sinking=0.0)
    return start_swing(foot, (pose, target), (time, state.left), course, model.parameters, doubt, model.hardest)


def _aimed(state: WalkState, swing: SwingTrajectory, landing: Footstep, time: float) -> SwingTrajectory:
    """The swing that goes to a footstep, where that is another one."""
    size, target = state.model.parameters.size, sole_pose(landing.position, landing.yaw, landing.normal)
    target[2] -= swing.aim
    if greatest(np.abs(target - swing.target) / np.repeat([size.length, 1.0], 3)) <= _SAME_TARGET:
        return swing
    # Over edges the foot keeps to the times in which its course clears them.
    return swing.retargeted(time, target, state.catching, LEAST_GLIDE * size.time)
