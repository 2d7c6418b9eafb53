"""Changes of the schedule by pushes and by feet that slide: steps inserted, later ones moved, a heel lifted."""

import math
from dataclasses import replace

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.step import Step, Stop, leaves_early
from surefoot.planner.swing import rolling
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.rolling import RollSpan
from surefoot.planner.types import FeetState, Foot, PhaseKind, Twist

Dcm = tuple[float, float, float]
"""The DCM in the world frame, and its rate ω [m, 1/s]."""

_SLID = 0.005
"""Way from where it landed beyond which a foot that stands has slid, of the reference robot [m]."""


def with_step_in_place(schedule: Schedule, now: float, foot: Foot | None = None, at_once: bool = True) -> Schedule:
    """A step on the spot is inserted where the robot stands or would stand next, before anything else.

    The weight goes from between the feet onto one of them. In its usual time it gets there only from feet that are as
    near to each other as usual. Once the weight has begun to shift, it takes longer the wider the robot stands. A
    longer rest before that would take the CoM farther than the rear leg reaches.

    Args:
        schedule: the steps in sight.
        now: [samples].
        foot: that makes it, of a robot that stands; else it is the one that landed first.
        at_once: with a weight shift no longer than any, wherever the feet are.
    """
    present = schedule.following(now)
    stand = next(phase for phase in present if phase.kind is PhaseKind.STAND)
    kept, stop = schedule.until(stand.step, stands=stand is present[0]), None
    width = schedule.gait.step_width
    if foot is not None and kept.gait.step_foot(stand.step + 1) is not foot:
        # The foot that landed last: as far beside the path as it is, which is laid from the other one.
        kept, width = _with_feet_swapped(kept), kept.last.path.width
    if kept.stands:
        double, stood = schedule.durations[1], max(0.0, now - kept.last.end)
        here, usual = (float(np.hypot(*way)) for way in kept.apart(stand.step))
        farther = 1.0 if at_once else max(1.0, here / usual)
        stop = Stop(stood, double, 0.0) if at_once else Stop.usual(stood, double, farther)
    return kept.followed(Twist(width=width), stop, inserted=True)


def with_steps_repeated(schedule: Schedule, number: int) -> Schedule:
    """After the step of a number, which is being swung, both feet land once more where they are, before all else."""
    stride = schedule.step(number).stride
    again = schedule.until(number, stands=False).followed(stride.scaled(-1.0), None, inserted=True)
    return again.followed(stride, None, inserted=True)


def with_foot_again(schedule: Schedule, number: int) -> Schedule:
    """The foot of a step that has just landed steps once more on the spot before the steps to come.

    It is now the other foot that landed last, and feet alternate from there on.
    """
    kept = _with_feet_swapped(schedule.until(number, stands=False))
    # As far beside the path as it is, which is within reach; the gait's own width may not be.
    kept = kept.followed(Twist(width=kept.last.path.width), None, inserted=True)
    for step in schedule.after(number):
        kept = kept.followed(step.stride, step.stop, inserted=True) if step.inserted else kept
    return kept


def _with_feet_swapped(schedule: Schedule) -> Schedule:
    """The other foot is the one that landed last, so that this one makes the next step."""
    *before, one, other = schedule.steps
    pairs = ((one, other), (other, one))
    swapped = (replace(step, nominal=by.nominal, place=by.place, heel_strike=None) for step, by in pairs)
    gait = replace(schedule.gait, first_foot=Foot(schedule.gait.first_foot).other)
    return replace(schedule.with_steps((*before, *swapped)), gait=gait)


def aligned(schedule: Schedule, number: int) -> Schedule:
    """All steps after one that has landed aside of its place on its face go as far aside, as far as theirs go."""
    step, terrain = schedule.step(number), schedule.ground.terrain
    aside = frame_rotation(step.nominal.yaw)[:, 1]
    shift = aside * float(aside @ (step.place.position - step.nominal.position)[:2])
    later = (replace(one, place=one.beside(shift, terrain)) for one in schedule.after(number))
    return schedule.placed((*schedule.steps[: schedule.index(number) + 1], *later), shift)


def with_feet_slid(schedule: Schedule, number: int, feet: FeetState, length: float) -> Schedule:
    """Feet that have slid since the last step landed stand where they are, and the steps to come go on from there.

    What stands long slides far, be it in the estimate alone. The body then stays over its feet, and not over the place
    in the world where they once landed.

    Args:
        schedule: the steps in sight.
        number: of the step that landed last.
        feet: as they are measured.
        length: the robot's size [-].
    """
    for one in (number - 1, number):
        place = schedule.step(one).place
        position = feet.position[place.foot]
        x, y = (position - place.position)[:2].tolist()
        if math.hypot(x, y) > _SLID * length:
            schedule = schedule.moved(one, position)
    return schedule


def with_heel_lifted(schedule: Schedule, number: int, radius: float) -> Schedule:
    """The foot that a step, just landed, has left too far behind for its leg rolls as it leaves the ground.

    `radius` is how far from under its hip a sole reaches flat [m].
    """
    stance, leaving, at = schedule.step(number), schedule.step(number - 1).place, schedule.index(number) + 1
    if at == len(schedule.steps) or schedule.steps[at].stop is not None:
        return schedule
    step, place = schedule.steps[at], stance.place
    ahead = float(((place.position - leaving.position)[:2] @ frame_rotation(place.yaw))[0])
    angle = rolling.stretched(ahead, radius, schedule.ground.parameters.size.length)
    if angle <= (step.toe_off.angle if step.toe_off else 0.0):
        return schedule
    foot, double = step.place.foot, stance.double_support
    early = leaves_early(stance, None, schedule.ground.parameters)
    roll = rolling.toe_off(foot, double, step.lift_off, step.single_support, angle, early)
    step = replace(step, toe_off=roll)
    return schedule.with_steps((*schedule.steps[:at], step, *schedule.steps[at + 1 :]))


def with_roll(schedule: Schedule, span: RollSpan, angle: float) -> Schedule:
    """A roll of a step in sight has another greatest pitch [rad]; without any it is left out."""
    changed = span._replace(angle=angle) if angle else None
    return schedule.with_steps(tuple(_rolled(step, span, changed) for step in schedule.steps))


def with_clock_put_back(schedule: Schedule, spans: tuple[RollSpan, ...], now: float, to: float) -> Schedule:
    """Rolls that have begun go on, and those that are over do not come again, on a clock that is put back.

    Args:
        schedule: the steps in sight.
        spans: rolls of the present phase.
        now: what the clock shows [samples].
        to: what it is put to [samples].
    """
    for span in spans:
        if span.start < now:
            ends = span.end > now
            later = span._replace(start=span.start - now + to, end=span.end - now + to) if ends else None
            schedule = schedule.with_steps(tuple(_rolled(step, span, later) for step in schedule.steps))
    return schedule


def _rolled(step: Step, span: RollSpan, changed: RollSpan | None) -> Step:
    """The step with another roll in place of one, the same one where it has not got it."""
    if step.toe_off == span:
        return replace(step, toe_off=changed)
    return replace(step, heel_strike=changed) if step.heel_strike == span else step


def lands_short(schedule: Schedule, number: int, feet: FeetState, dcm: Dcm | None, legs: LegReach | None) -> bool:
    """Return true if the DCM is beyond the foot that lands after a step, on its own side, and the foot can get there.

    The other foot would have to cross it, and nothing is on it yet. The DCM is beyond it by half of its width, and no
    farther from the stance foot than legs stride for as long as a swing takes at least.
    """
    if dcm is None or legs is None:
        return False
    place, (u, v, omega), ground = schedule.step(number).place, dcm, schedule.ground
    foot, sine, cosine = place.foot.other, math.sin(place.yaw), math.cos(place.yaw)
    aside = (foot.side * (cosine * (v - y) - sine * (u - x)) for x, y, _ in (feet.position[foot], place.position))
    short, off = map(float, aside)
    soonest = math.exp(omega * ground.parameters.recovery.least_single)
    return short > float(ground.half_size[1]) and off * soonest < legs.stride + legs.hip_width
