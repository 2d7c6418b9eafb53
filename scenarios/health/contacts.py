"""Health of contacts and balance: forces, slip, touchdowns, ZMP."""

import numpy as np

from scenarios.health.finding import Finding, judged
from scenarios.metrics import balance, walking
from scenarios.metrics.effort import GRAVITY
from scenarios.metrics.view import Array, RunView

FORCE_WINDOW = 0.5
"""Time over which contact forces are averaged against weight and momentum [s]."""
FORCE_TOLERANCE = 0.05
"""Share of the weight by which their mean may be off [-]."""
SLIP = 0.005
"""Slip of a stance foot that deserves a look [m]."""
LATE = 0.03
"""How much longer than planned a single support may last, a planner tick and a half [s]."""
OUTSIDE = 0.01
"""Share of ticks that the ZMP may be outside the shrunk support polygon [-]."""


def forces_match_weight(run: RunView) -> Finding:
    """Whether the normal forces of the feet make the CoM's vertical momentum, over every half second before a fall."""
    ticks, rate, mass = _standing(run), run.constants.control_rate, run.constants.mass
    width = round(FORCE_WINDOW * rate)
    if ticks <= width:
        return judged("contact_forces", False, None, None, "")
    force = run.field("/contact", "normal_force")[:ticks].sum(axis=1) + _push(run)[:ticks, 2]
    impulse = np.concatenate(([0.0], np.cumsum(force))) / rate
    velocity = run.field("/truth", "com_velocity")[:ticks, 2]
    mean = (impulse[width:ticks] - impulse[: ticks - width]) * rate / width
    needed = mass * (GRAVITY + (velocity[width:] - velocity[:-width]) * rate / width)
    error = (mean - needed) / (mass * GRAVITY)
    worst = int(np.argmax(np.abs(error)))
    value = float(error[worst])
    cause = (
        f"over half a second the feet carry {100 * abs(value):.0f} % of the weight too "
        f"{'much' if value > 0 else 'little'}: the robot is not as heavy as the log says, something but the feet "
        "carries it, or contacts chatter between ticks"
    )
    return judged("contact_forces", abs(value) > FORCE_TOLERANCE, float(run.time[worst]), value, cause)


def foot_slip(run: RunView) -> Finding:
    """How far a sole moves on the ground [m]."""
    end = _standing(run)
    slips = [slip for slip in walking.stance_slips(run) if slip.start < end]
    if not slips:
        return judged("foot_slip", False, None, None, "")
    worst = max(slips, key=lambda slip: slip.distance)
    foot = ("left", "right")[worst.foot]
    cause = (
        f"the {foot} foot slips {1000 * worst.distance:.0f} mm in a stance: the ground has less friction than the "
        "controller counts on, or the foot is planned in contact while it is hardly loaded"
    )
    return judged("foot_slip", worst.distance > SLIP, float(run.time[worst.tick]), worst.distance, cause)


def late_touchdowns(run: RunView) -> Finding:
    """How much longer than planned a single support lasts [s]."""
    single, rate = run.single_support.copy(), run.constants.control_rate
    single[_standing(run) :] = False
    planned = run.field("/reference", "phase_duration")
    stance = run.field("/reference", "stance")
    phases = [phase for foot in (0, 1) for phase in walking.runs_of(single & (stance == foot))]
    late = [(end - start) / rate - float(planned[start]) for start, end in phases if end < len(single)]
    if not late:
        return judged("touchdowns", False, None, None, "")
    worst = int(np.argmax(late))
    count = sum(value > LATE for value in late)
    cause = (
        f"{count} of {len(late)} touchdowns are late, the worst by {1000 * late[worst]:.0f} ms: the ground is lower "
        "than planned, the swing foot lags behind its reference, or its contact is felt too late"
    )
    return judged("touchdowns", late[worst] > LATE, float(run.time[phases[worst][1]]), late[worst], cause)


def zmp_at_edge(run: RunView) -> Finding:
    """Share of ticks with the ZMP outside the support polygon of feet shrunk to 90 %."""
    outside = ~balance.zmp_inside(run)[: _standing(run)]
    share = float(outside.mean()) if len(outside) else 0.0
    if not share:
        return judged("zmp_margin", False, None, share, "")
    first = int(np.argmax(outside))
    pushed = bool(np.any(_push(run)[max(0, first - run.constants.control_rate) : first + 1]))
    reason = (
        "a push moves it" if pushed else "the plan asks for it, the CoM does not follow the plan, or a foot is tilted"
    )
    cause = f"the ZMP is at the edge of the support in {100 * share:.1f} % of the ticks: {reason}"
    return judged("zmp_margin", share > OUTSIDE, float(run.time[first]), share, cause)


def _standing(run: RunView) -> int:
    """Ticks before a fall: what comes after it is no gait."""
    fall = walking.fall_time(run)
    return run.ticks if fall is None else int(np.searchsorted(run.time, fall))


def _push(run: RunView) -> Array:
    """Sum of the pushes, shape (n, 3) [N]."""
    topic = "/measurement" if run.has("/measurement") else "/truth"
    return run.field(topic, "external_force")
