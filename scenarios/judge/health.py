"""Health checks: pure functions of a log that name the likely cause of what they find."""

from collections.abc import Callable
from dataclasses import asdict
from typing import Any, Literal

import numpy as np

from surefoot.planner.types import GRAVITY
from surefoot.scenarios.judge import balance, effort, feet, sensed, walking
from surefoot.scenarios.judge.digest import SENSED, Array, Digest, Reads, RunView
from surefoot.scenarios.judge.metric import Reduction
from surefoot.values import dataclass


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes:
        check: its name.
        status: ok or warning.
        time: where the evidence is strongest or first [s]; None where it has no time.
        value: the evidence, in the check's unit.
        cause: what was found and its likely cause; empty when all is well.
    """

    check: str
    status: Literal["ok", "warning"]
    time: float | None
    value: float | None
    cause: str = ""

    def to_json(self) -> dict[str, Any]:
        """Write as one JSON object."""
        return asdict(self)


def judged(check: str, warn: bool, time: float | None, value: float | None, cause: str) -> Finding:
    """A finding whose cause is told only when it is a warning."""
    return Finding(check, "warning" if warn else "ok", time, value, cause if warn else "")


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
    width = round(FORCE_WINDOW * run.constants.similarity.time * rate)
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
    slips = feet.stance_slips(run, _standing(run))
    if not slips:
        return judged("foot_slip", False, None, None, "")
    worst = max(slips, key=lambda slip: slip.distance)
    foot = ("left", "right")[worst.foot]
    cause = (
        f"the {foot} foot slips {1000 * worst.distance:.0f} mm in a stance: the ground has less friction than the "
        "controller counts on, or the foot is planned in contact while it is hardly loaded"
    )
    return judged(
        "foot_slip",
        worst.distance > SLIP * run.constants.similarity.length,
        float(run.time[worst.tick]),
        worst.distance,
        cause,
    )


def late_touchdowns(run: RunView) -> Finding:
    """How much longer than planned a single support lasts [s]."""
    planned, swings = run.field("/reference", "phase_duration"), walking.swings_ended(run)
    late = [(end - start) / run.constants.control_rate - float(planned[start]) for start, end in swings]
    if not late:
        return judged("touchdowns", False, None, None, "")
    worst, missed = int(np.argmax(late)), walking.touchdowns_missed(run)
    most = LATE * run.constants.similarity.time
    count = sum(value > most for value in late)
    never = f"{missed} of {len(late)} swings end without their foot ever touching the ground; " if missed else ""
    cause = (
        f"{never}{count} of {len(late)} touchdowns are late, the worst by {1000 * late[worst]:.0f} ms: the ground is "
        "lower than planned, the swing foot lags behind its reference, or its contact is felt too late"
    )
    warn = missed > 0 or late[worst] > most
    return judged("touchdowns", warn, float(run.time[swings[worst][1]]), late[worst], cause)


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


PAST_STOP = 0.001
"""How far a soft simulated stop may give way before it is told [rad]."""
DRIFT = 0.01
"""Error of the estimated CoM that deserves a look [m]."""
SURE = 4.0
"""Mean square of errors over deviations that deserves a look [-]."""
OVERRUNS = 0.01
"""Share of ticks that may take longer than their period [-]."""
_PARTS = ("state", "wbc_build", "wbc_solve", "planner", "physics", "log")


def torque_saturation(run: RunView) -> Finding:
    """Largest commanded torque over its limit [-]."""
    ratio, numbers = run.reduced(effort.torque_ratio).T
    saturated = ratio >= effort.AT_LIMIT
    worst = int(np.argmax(saturated) if saturated.any() else np.nanargmax(ratio))
    joint = run.constants.joint_names[int(numbers[worst])]
    cause = (
        f"{joint} is at its torque limit, joints are saturated in {np.count_nonzero(saturated)} ticks: the motion asks "
        "for more than the motor gives, by an impact, a push, a straight knee or a gain that is too high"
    )
    return judged("torque_limits", bool(saturated.any()), float(run.time[worst]), float(ratio[worst]), cause)


def joint_stops(run: RunView) -> Finding:
    """Least distance of a joint from its stops before a fall, negative past them [rad]."""
    worst, joint, over = _joint(run, effort.joint_overrun)
    margin = 0.0 - over
    cause = (
        f"{joint} is {np.degrees(-margin):.1f} deg past its stop, as only a simulated one allows: the motion asks for "
        "more than the joint has, or a push or an impact overcame the controller"
    )
    return judged("joint_stops", margin < -PAST_STOP, float(run.time[worst]), margin, cause)


def joint_speeds(run: RunView) -> Finding:
    """Largest joint speed over the joint's no-load speed before a fall [-]."""
    if not run.constants.velocity_limit:
        return judged("joint_speeds", False, None, None, "")
    worst, joint, ratio = _joint(run, effort.joint_speed_ratio)
    cause = (
        f"{joint} turns at {100 * ratio:.0f} % of its no-load speed, where a real motor has no torque left and the "
        "simulated one has all of it: what comes after is not to be trusted"
    )
    return judged("joint_speeds", ratio > 1.0, float(run.time[worst]), ratio, cause)


def _joint(run: RunView, largest: Reduction) -> tuple[int, str, float]:
    """The tick before a fall at which a value is greatest, which joint has it, and the value."""
    values, numbers = run.reduced(largest).T
    worst = int(np.argmax(np.nan_to_num(values[: max(_standing(run), 1)], nan=-np.inf)))
    return worst, run.constants.joint_names[int(numbers[worst])], float(values[worst])


def estimator_drift(run: RunView) -> Finding:
    """Largest distance of the estimated from the true CoM [m]."""
    if run.has(SENSED):
        # Where the robot is in the world no sensor tells.
        error = np.linalg.norm(run.field(SENSED, "com_error"), axis=1)
    else:
        error = np.linalg.norm(run.field("/estimate", "com") - run.field("/truth", "com"), axis=1)
    worst = int(np.nanargmax(error))
    quarter = max(len(error) // 4, 1)
    grows = np.nanmean(error[-quarter:]) > 2 * np.nanmean(error[:quarter])
    why = (
        "it grows: the base drifts, as by foot slip"
        if grows
        else "it does not grow: noise, delay or a wrong mass model"
    )
    cause = f"the estimated CoM is off by {1000 * error[worst]:.0f} mm, {why}"
    return judged(
        "estimator",
        bool(error[worst] > DRIFT * run.constants.similarity.length),
        float(run.time[worst]),
        float(error[worst]),
        cause,
    )


def estimator_confidence(run: RunView) -> Finding:
    """Mean square of the errors of an estimator that senses over the deviations that it tells [-]."""
    found = sensed.estimation_nees(run)
    if found is None:
        return judged("estimator_confidence", False, None, None, "")
    part = max(found, key=lambda name: found[name])
    cause = (
        f"errors of the estimated {part.replace('_', ' ')} are {found[part] ** 0.5:.1f} times what the estimator takes "
        "them for: the sensors are worse than it is told, a foot slips, or the ground is not where it is believed"
    )
    return judged("estimator_confidence", found[part] > SURE, None, found[part], cause)


def controller_fallbacks(run: RunView) -> Finding:
    """Ticks in which the whole-body QP had no solution."""
    fallback = run.field("/wbc", "fallback") != 0
    count = int(np.count_nonzero(fallback))
    first = float(run.time[np.argmax(fallback)]) if count else None
    cause = (
        f"the whole-body QP had no solution in {count} ticks and the fallback acted: its contacts, torque or joint "
        "limits contradict each other, as at a lost contact or a joint at its stop"
    )
    return judged("controller_solver", count > 0, first, float(count), cause)


def planner_fallbacks(run: RunView) -> Finding:
    """Plans that were held because no new one could be solved."""
    plan = run.log["/plan"]
    held = plan.field("held") != 0
    count = int(np.count_nonzero(held))
    first = float(plan.time[np.argmax(held)]) if count else None
    cause = (
        f"{count} plans were held because the planner's QP had no solution: the state is out of reach of its bounds, "
        "as after a push or with jerk limits that are too tight"
    )
    return judged("planner_solver", count > 0, first, float(count), cause)


def overrun_ticks(run: RunView) -> Finding:
    """Share of ticks whose wall time is longer than their period."""
    spent = run.field("/timing", "tick") * 1e-6
    over = spent > 1 / run.constants.control_rate
    share, worst = float(over.mean()), int(np.argmax(spent))
    parts = {part: float(run.field("/timing", part)[over].sum()) for part in _PARTS} if over.any() else {}
    blame = max(parts, key=lambda part: parts[part]) if sum(parts.values()) else "none"
    cause = (
        f"{100 * share:.1f} % of the ticks take longer than their period, the worst {1000 * spent[worst]:.1f} ms, most "
        f"of it in the part '{blame}': in real time they would be late; a busy machine does this too"
    )
    return judged("overruns", share > OVERRUNS, float(run.time[worst]), share, cause)


def not_finite(run: RunView) -> Finding:
    """Ticks with a state, sensor value or torque that is not a number."""
    values = {
        "/truth": run.field("/truth", "com").sum(axis=1) + run.sole(0).sum(axis=1) + run.sole(1).sum(axis=1),
        "/measurement": run.reduced(effort.joint_power) + run.reduced(effort.joint_overrun)[:, 0],
        "/estimate": run.field("/estimate", "com").sum(axis=1),
        "/torque": run.reduced(effort.torque_ratio)[:, 0],
    }
    bad = {topic: ~np.isfinite(value) for topic, value in values.items()}
    count = int(sum(np.count_nonzero(where) for where in bad.values()))
    if not count:
        return judged("finite_values", False, None, 0.0, "")
    topic = min(bad, key=lambda name: int(np.argmax(bad[name])) if bad[name].any() else run.ticks)
    cause = (
        f"{count} values are not numbers, first in {topic}: what is upstream of it divided by zero or diverged; look "
        "at the ticks before"
    )
    return judged("finite_values", True, float(run.time[np.argmax(bad[topic])]), float(count), cause)


_BODY = ("/truth", "/measurement", "/estimate", "/torque")
_CHECKS: tuple[tuple[tuple[str, ...], Callable[[RunView], Finding]], ...] = (
    (_BODY, not_finite),
    (("/truth", "/contact", "/reference"), forces_match_weight),
    (("/truth", "/contact", "/reference"), foot_slip),
    (("/truth", "/reference"), late_touchdowns),
    (("/truth", "/contact", "/reference"), zmp_at_edge),
    (("/torque",), torque_saturation),
    (("/measurement", "/contact", "/reference"), joint_stops),
    (("/measurement", "/contact", "/reference"), joint_speeds),
    (("/truth", "/estimate"), estimator_drift),
    ((SENSED,), estimator_confidence),
    (("/wbc",), controller_fallbacks),
    (("/plan",), planner_fallbacks),
    (("/timing",), overrun_ticks),
)
"""Every check and the topics that it needs."""

READS: Reads = {
    "/measurement": ("external_force",),
    "/truth": ("com", "com_velocity", "external_force"),  # the force is of the pendulum
    "/estimate": ("com",),
    SENSED: ("com_error",),
    "/contact": ("normal_force", "planned", "active", "felt"),
    "/reference": ("stance", "phase_duration"),
    "/wbc": ("fallback",),
    "/timing": (*_PARTS, "tick"),
    "/plan": ("held",),
}
"""Fields that the checks read, beside those that tell a fall."""

REDUCTIONS = (
    *(effort.torque_ratio, effort.joint_overrun, effort.joint_speed_ratio, effort.joint_power),
    balance.zmp_depth,
)
"""Reductions that the checks use."""


def findings(digest: Digest) -> tuple[Finding, ...]:
    """Apply every check whose channels are there.

    Raises:
        LogError: the log does not describe a run.
    """
    run = RunView(digest)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        return tuple(_found(check, run) for topics, check in _CHECKS if run.has("/truth", *topics))


def _found(check: Callable[[RunView], Finding], run: RunView) -> Finding:
    """What a check finds, also in values that no run has."""
    try:
        return check(run)
    except (ValueError, IndexError, TypeError) as error:
        return judged(check.__name__, True, None, None, f"cannot be looked at: {error}")
