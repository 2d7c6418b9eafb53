"""Health checks of the motion: what feet, soles and joints do."""

import numpy as np

from surefoot.planner.types import GRAVITY
from surefoot.scenarios.judge import balance, effort, feet, walking
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.finding import Finding, first, judged, pushes, standing
from surefoot.scenarios.judge.metric import Reduction

FORCE_WINDOW = 0.5
"""Time over which contact forces are averaged against weight and momentum [s]."""
FORCE_TOLERANCE = 0.05
"""Share of the weight by which their mean may be off [-]."""
SLIP = 0.005
"""Slip of a stance foot that deserves a look [m]."""
LATE = 0.03
"""Time beyond the plan that a single support may last, a planner tick and a half [s]."""
OUTSIDE = 0.01
"""Share of ticks that the ZMP may be outside the shrunk support polygon [-]."""
PAST_STOP = 0.001
"""Give of a soft simulated stop that is not reported [rad]."""


def forces_match_weight(run: RunView) -> Finding:
    """The forces of the feet make the CoM's vertical momentum, over every half second before a fall."""
    ticks, rate, mass = standing(run), run.constants.control_rate, run.constants.mass
    width = round(FORCE_WINDOW * run.constants.similarity.time * rate)
    if ticks <= width:
        return judged("contact_forces", None, None)
    force = run.field("/contact", "normal_force")[:ticks].sum(axis=1) + pushes(run)[:ticks, 2]
    impulse = np.concatenate(([0.0], np.cumsum(force))) / rate
    velocity = run.field("/truth", "com_velocity")[:ticks, 2]
    mean = (impulse[width:ticks] - impulse[: ticks - width]) * rate / width
    needed = mass * (GRAVITY + (velocity[width:] - velocity[:-width]) * rate / width)
    error = (mean - needed) / (mass * GRAVITY)
    value = float(error[np.argmax(np.abs(error))])
    amount = f"{100 * abs(value):.0f} % of the weight too {'much' if value > 0 else 'little'}"
    likely = "the robot is not as heavy as the log says, something but the feet carries it, or contacts chatter"
    # What a window has in it is evidence at its end.
    found = np.concatenate((np.zeros(width, dtype=np.bool_), np.abs(error) > FORCE_TOLERANCE))
    said = f"over half a second the feet carry {amount}"
    return judged("contact_forces", first(run, found), value, said, likely)


def foot_slip(run: RunView) -> Finding:
    """Greatest motion of a sole on the ground [m]."""
    slips = feet.stance_slips(run, standing(run))
    if not slips:
        return judged("foot_slip", None, None)
    worst = max(slips, key=lambda slip: slip.distance)
    most = SLIP * run.constants.similarity.length
    begun = min((slip for slip in slips if slip.distance > most), key=lambda slip: slip.since(most), default=worst)
    also = "" if begun.foot == worst.foot else f", the {_FEET[worst.foot]} one"
    found = f"the {_FEET[begun.foot]} foot slips{also} by up to {1000 * worst.distance:.0f} mm in a stance"
    if not worst.distance > most:
        return judged("foot_slip", None, worst.distance)
    return judged("foot_slip", float(run.time[begun.since(most)]), worst.distance, found, _why_slips(run))


def _why_slips(run: RunView) -> str:
    from surefoot.scenarios.judge.beliefs import beliefs

    known = beliefs(run)
    true, believed = known.friction
    hardly = "the foot is planned in contact while it is hardly loaded"
    if known.less_friction:
        least = min((true, *known.slippery.values()))
        return f"the ground has a friction of {least:g} and the controller counts on {believed:g}, or {hardly}"
    return f"the friction is as the controller counts on, so something pulls the foot along, or {hardly}"


_FEET = ("left", "right")


def late_touchdowns(run: RunView) -> Finding:
    """Greatest time beyond the plan that a single support lasts [s]."""
    planned, swings = run.field("/reference", "phase_duration"), walking.swings_ended(run)
    late = np.array([(end - start) / run.constants.control_rate - float(planned[start]) for start, end in swings])
    if not len(late):
        return judged("touchdowns", None, None)
    missed, most = walking.touchdowns_missed(run), LATE * run.constants.similarity.time
    count = np.count_nonzero(late > most)
    never = f"{missed} of {len(late)} swings end without their foot ever touching the ground; " if missed else ""
    found = f"{never}{count} of {len(late)} touchdowns are late, the worst by {1000 * late.max():.0f} ms"
    likely = (
        "the ground is lower than planned, the swing foot lags behind its reference, or its contact is felt too late"
    )
    # A touchdown is late from when it is overdue, and missed from the end of its swing.
    overdue = [float(run.time[start]) + float(planned[start]) + most for start, _ in np.array(swings)[late > most]]
    if missed > 0:
        ends = run.time[[end for _, end in swings]]
        touched = np.searchsorted(run.log["/footstep"].time if run.has("/footstep") else [], ends, side="right")
        overdue += ends[touched < 1 + np.arange(len(ends))].tolist()[:1]
    return judged("touchdowns", min(overdue, default=None), float(late.max()), found, likely)


def zmp_at_edge(run: RunView) -> Finding:
    """Share of ticks with the ZMP outside the support polygon of feet shrunk to 90 %."""
    outside = ~balance.zmp_inside(run)[: standing(run)]
    share = float(outside.mean()) if len(outside) else 0.0
    if not share > OUTSIDE:
        return judged("zmp_margin", None, share)
    begin = int(np.argmax(outside))
    pushed = bool(np.any(pushes(run)[max(0, begin - run.constants.control_rate) : begin + 1]))
    likely = (
        "a push moves it" if pushed else "the plan asks for it, the CoM does not follow the plan, or a foot is tilted"
    )
    found = f"the ZMP is at the edge of the support in {100 * share:.1f} % of the ticks"
    return judged("zmp_margin", float(run.time[begin]), share, found, likely)


def torque_saturation(run: RunView) -> Finding:
    """Largest commanded torque over its limit [-]."""
    ratio, numbers = run.reduced(effort.torque_ratio).T
    saturated = ratio >= effort.AT_LIMIT
    joint = run.constants.joint_names[int(numbers[np.argmax(saturated)])]
    found = f"{joint} is at its torque limit, joints are saturated in {np.count_nonzero(saturated)} ticks"
    likely = "the motion asks for more than the motor gives, by an impact, a push, a straight knee or too high a gain"
    return judged("torque_limits", first(run, saturated), float(np.nanmax(ratio)), found, likely)


def joint_stops(run: RunView) -> Finding:
    """Least distance of a joint from its stops before a fall, negative past them [rad]."""
    time, joint, over, worst = _joint(run, effort.joint_overrun, PAST_STOP)
    margin = 0.0 - over
    also = "" if joint == worst else f", {worst}"
    found = f"{joint} is past its stop{also} by up to {np.degrees(over):.1f} deg, as only a simulated one allows"
    likely = "the motion asks for more than the joint has, or a push or an impact overcame the controller"
    return judged("joint_stops", time, margin, found, likely)


def joint_speeds(run: RunView) -> Finding:
    """Largest joint speed over the joint's no-load speed before a fall [-]."""
    if not run.constants.velocity_limit:
        return judged("joint_speeds", None, None)
    time, joint, ratio, worst = _joint(run, effort.joint_speed_ratio, 1.0)
    also = "" if joint == worst else f", {worst}"
    found = f"{joint} turns faster than its no-load speed{also} at up to {100 * ratio:.0f} % of it"
    likely = "a real motor has no torque left there, the simulated one has all of it, and what comes after is no motion"
    return judged("joint_speeds", time, ratio, found, likely)


def _joint(run: RunView, largest: Reduction, most: float) -> tuple[float | None, str, float, str]:
    """Time before a fall at which a value is first over its bound, its joint, the greatest value, and its joint."""
    values, numbers = run.reduced(largest)[: max(standing(run), 1)].T
    values, names = np.nan_to_num(values, nan=-np.inf), run.constants.joint_names
    begin, worst = (int(np.argmax(found)) for found in (values > most, values))
    return first(run, values > most), names[int(numbers[begin])], float(values[worst]), names[int(numbers[worst])]
