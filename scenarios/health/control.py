"""Health of the control loop: torques, solvers, estimator, computing time, values."""

import numpy as np

from scenarios.health.finding import Finding, judged
from scenarios.metrics import effort
from scenarios.metrics.view import RunView

SATURATED = 0.999
"""Torque over its limit from which a joint is saturated [-]."""
DRIFT = 0.01
"""Error of the estimated CoM that deserves a look [m]."""
OVERRUNS = 0.01
"""Share of ticks that may take longer than their period [-]."""
_PARTS = ("state", "wbc_build", "wbc_solve", "planner", "physics", "log")


def torque_saturation(run: RunView) -> Finding:
    """Largest commanded torque over its limit [-]."""
    ratio = run.reduced(effort.torque_ratio)
    saturated = ratio >= SATURATED
    worst = int(np.argmax(saturated) if saturated.any() else np.nanargmax(ratio))
    joint = run.constants.joint_names[int(run.reduced(effort.strained_joint)[worst])]
    cause = (
        f"{joint} is at its torque limit, joints are saturated in {np.count_nonzero(saturated)} ticks: the motion asks "
        "for more than the motor gives, by an impact, a push, a straight knee or a gain that is too high"
    )
    return judged("torque_limits", bool(saturated.any()), float(run.time[worst]), float(ratio[worst]), cause)


def estimator_drift(run: RunView) -> Finding:
    """Largest distance of the estimated from the true CoM [m]."""
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
    return judged("estimator", bool(error[worst] > DRIFT), float(run.time[worst]), float(error[worst]), cause)


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
        "/truth": run.field("/truth", "com").sum(axis=1) + run.soles.sum(axis=(1, 2)),
        "/measurement": run.reduced(effort.joint_power) + run.reduced(effort.joint_limit_margin),
        "/estimate": run.field("/estimate", "com").sum(axis=1),
        "/torque": run.reduced(effort.torque_ratio),
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
