"""Health checks of what computes: estimator, planner, controller, and the numbers themselves."""

import numpy as np

from surefoot.scenarios.judge import effort, sensed
from surefoot.scenarios.judge.digest import SENSED, RunView
from surefoot.scenarios.judge.finding import Finding, first, judged, shared

DRIFT = 0.01
"""Error of the estimated CoM that deserves a look [m]."""
SURE = 4.0
"""Mean square of errors over deviations that deserves a look [-]."""
OVERRUNS = 0.01
"""Share of ticks that may take longer than their period [-]."""
PARTS = ("state", "wbc_build", "wbc_solve", "planner", "physics", "log")
"""Of a tick, whose times are told."""


def estimator_drift(run: RunView) -> Finding:
    """Largest distance of the estimated from the true CoM [m]."""
    if run.has(SENSED):
        # Where the robot is in the world no sensor tells.
        error = np.linalg.norm(run.field(SENSED, "com_error"), axis=1)
    else:
        error = np.linalg.norm(run.field("/estimate", "com") - run.field("/truth", "com"), axis=1)
    worst = float(np.nanmax(error))
    quarter = max(len(error) // 4, 1)
    grows = np.nanmean(error[-quarter:]) > 2 * np.nanmean(error[:quarter])
    why = (
        "it grows: the base drifts, as by foot slip"
        if grows
        else "it does not grow: noise, delay or a wrong mass model"
    )
    cause = f"the estimated CoM is off by up to {1000 * worst:.0f} mm, {why}"
    return judged("estimator", first(run, error > DRIFT * run.constants.similarity.length), worst, cause)


def estimator_confidence(run: RunView) -> Finding:
    """Mean square of the errors of an estimator that senses over the deviations that it tells [-]."""
    found = sensed.estimation_nees(run)
    if found is None:
        return shared("estimator_confidence", False, None, "")
    part = max(found, key=lambda name: found[name])
    cause = (
        f"errors of the estimated {part.replace('_', ' ')} are {found[part] ** 0.5:.1f} times what the estimator takes "
        "them for: the sensors are worse than it is told, a foot slips, or the ground is not where it is believed"
    )
    return shared("estimator_confidence", found[part] > SURE, found[part], cause)


def controller_fallbacks(run: RunView) -> Finding:
    """Ticks in which the whole-body QP had no solution."""
    fallback = run.field("/wbc", "fallback") != 0
    count = int(np.count_nonzero(fallback))
    cause = (
        f"the whole-body QP had no solution in {count} ticks and the fallback acted: its contacts, torque or joint "
        "limits contradict each other, as at a lost contact or a joint at its stop"
    )
    return judged("controller_solver", first(run, fallback), float(count), cause)


def planner_fallbacks(run: RunView) -> Finding:
    """Plans that were held because no new one could be solved."""
    plan = run.log["/plan"]
    held = plan.field("held") != 0
    count = int(np.count_nonzero(held))
    cause = (
        f"{count} plans were held because the planner's QP had no solution: the state is out of reach of its bounds, "
        "as after a push or with jerk limits that are too tight"
    )
    return judged("planner_solver", float(plan.time[np.argmax(held)]) if count else None, float(count), cause)


def overrun_ticks(run: RunView) -> Finding:
    """Share of ticks whose wall time is longer than their period; no walk in simulation hangs on it."""
    spent = run.field("/timing", "tick") * 1e-6
    over = spent > 1 / run.constants.control_rate
    share, worst = float(over.mean()), int(np.argmax(spent))
    parts = {part: float(run.field("/timing", part)[over].sum()) for part in PARTS} if over.any() else {}
    blame = max(parts, key=lambda part: parts[part]) if sum(parts.values()) else "none"
    cause = (
        f"{100 * share:.1f} % of the ticks take longer than their period, the worst {1000 * spent[worst]:.1f} ms at "
        f"{run.time[worst]:.3f} s, most of it in the part '{blame}': in real time they would be late; a busy machine "
        "does this too, and the simulated walk is the same"
    )
    return shared("overruns", share > OVERRUNS, share, cause)


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
    topic = min(bad, key=lambda name: int(np.argmax(bad[name])) if bad[name].any() else run.ticks)
    cause = (
        f"{count} values are not numbers, first in {topic}: what is upstream of it divided by zero or diverged; look "
        "at the ticks before"
    )
    return judged("finite_values", first(run, bad[topic]), float(count), cause)
