"""Health checks of what computes: estimator, planner, controller, and the numbers themselves."""

import numpy as np

from surefoot.scenarios.judge import effort, sensed
from surefoot.scenarios.judge.digest import SENSED, RunView
from surefoot.scenarios.judge.finding import Finding, first, judged, shared

DRIFT = 0.01
"""Error of the estimated CoM that deserves a look [m]."""
SURE = 4.0
"""Mean square of errors over deviations that deserves a look [-]."""
LEAST_MEAN = 0.5
"""Time over which a mean square is taken at least [s]."""
OVERRUNS = 0.01
"""Share of ticks that may take longer than their period [-]."""
PARTS = ("state", "wbc_build", "wbc_solve", "planner", "physics", "log")
"""Parts of a tick whose times are logged."""


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
    found = f"the estimated CoM is off by up to {1000 * worst:.0f} mm, {'and grows' if grows else 'it does not grow'}"
    likely = "the base drifts, as by foot slip" if grows else _not_as_believed(run) or "noise or delay"
    return judged("estimator", first(run, error > DRIFT * run.constants.similarity.length), worst, found, likely)


def _not_as_believed(run: RunView) -> str:
    """Departures that may mislead an estimate: masses, or sensors that are poorer than their preset; or empty."""
    from surefoot.scenarios.judge.beliefs import beliefs

    known = beliefs(run)
    masses = (one.what for one in known.departures if one.kind == "mass")
    return next(masses, next(iter(known.sensors), ""))


def estimator_confidence(run: RunView) -> Finding:
    """Mean square of the errors of an estimator that senses over the deviations that it tells [-]."""
    found = sensed.estimation_nees(run)
    if found is None:
        return shared("estimator_confidence", False, None)
    part = max(found, key=lambda name: found[name])
    if not found[part] > SURE:
        return shared("estimator_confidence", False, found[part])
    said = f"errors of the estimated {part.replace('_', ' ')} are {found[part] ** 0.5:.1f} times what it takes them for"
    wrong = _not_as_believed(run) or "the sensors are as specified"
    likely = f"{wrong}; else a foot slips, the ground is not where it is believed, or the body moves as no walk does"
    return judged("estimator_confidence", _unsure_from(run, part), found[part], said, likely)


def _unsure_from(run: RunView, part: str) -> float:
    """From when on the mean square so far of a part is more than `SURE`, half a second after it is judged [s]."""
    squares = np.nan_to_num(sensed.squares(run, part))
    times = run.time[len(run.time) - len(squares) :]
    ticks = round(LEAST_MEAN * run.constants.control_rate)
    mean = np.cumsum(squares) / (1.0 + np.arange(len(squares)))
    over = np.flatnonzero(mean > SURE)
    over = over[over >= ticks]
    return float(times[over[0]] if len(over) else times[-1])


def controller_fallbacks(run: RunView) -> Finding:
    """Ticks in which the whole-body QP had no solution."""
    fallback = run.field("/wbc", "fallback") != 0
    count = int(np.count_nonzero(fallback))
    found = f"the whole-body QP had no solution in {count} ticks and the fallback acted"
    likely = "its contacts, torque or joint limits contradict each other, as at a lost contact or a joint at its stop"
    return judged("controller_solver", first(run, fallback), float(count), found, likely)


def planner_fallbacks(run: RunView) -> Finding:
    """Plans that were held because no new one could be solved."""
    plan = run.log["/plan"]
    held = plan.field("held") != 0
    count = int(np.count_nonzero(held))
    found = f"{count} plans were held because the planner's QP had no solution"
    likely = "the state is out of reach of its bounds, as after a push or with jerk limits that are too tight"
    time = float(plan.time[np.argmax(held)]) if count else None
    return judged("planner_solver", time, float(count), found, likely)


def overrun_ticks(run: RunView) -> Finding:
    """Share of ticks whose wall time is longer than their period; no walk in simulation hangs on it."""
    spent = run.field("/timing", "tick") * 1e-6
    over = spent > 1 / run.constants.control_rate
    share, worst = float(over.mean()), int(np.argmax(spent))
    parts = {part: float(run.field("/timing", part)[over].sum()) for part in PARTS} if over.any() else {}
    blame = max(parts, key=lambda part: parts[part]) if sum(parts.values()) else "none"
    found = (
        f"{100 * share:.1f} % of the ticks take longer than their period, the worst {1000 * spent[worst]:.1f} ms at "
        f"{run.time[worst]:.3f} s, most of it in the part '{blame}'"
    )
    likely = "in real time they would be late; a busy machine does this too, and the simulated walk is the same"
    return shared("overruns", share > OVERRUNS, share, found, likely)


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
    found = f"{count} values are not numbers, first in {topic}"
    likely = "what is upstream of it divided by zero or diverged; look at the ticks before"
    return judged("finite_values", first(run, bad[topic]), float(count), found, likely)
