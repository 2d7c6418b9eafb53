"""Metrics of effort: torques, limits, energy, solver and computing time."""

import numpy as np

from surefoot.scenarios.judge.digest import Array, RunView

GRAVITY = 9.81
"""Gravitational acceleration [m/s^2]."""

AT_LIMIT = 0.999
"""Share of its limit from which a torque counts as being at it; solvers end a hair below [-]."""

SHORTEST_WAY = 0.05
"""Way below which a cost of transport means nothing [m]."""


def torque_ratio(run: RunView) -> Array:
    """Largest commanded joint torque over its limit at each tick, shape (n,)."""
    return np.asarray(np.max(np.abs(run.field("/torque", "command")) / np.array(run.constants.torque_limit), axis=1))


def strained_joint(run: RunView) -> Array:
    """Which joint is nearest to its torque limit at each tick, index, shape (n,)."""
    ratio = np.abs(run.field("/torque", "command")) / np.array(run.constants.torque_limit)
    return np.asarray(np.argmax(ratio, axis=1).astype(np.uint8))


def knee_torque_squared(run: RunView) -> Array:
    """Mean square of the commanded knee torques at each tick, shape (n,) [N² m²]; NaN without knees."""
    knees = [i for i, name in enumerate(run.constants.joint_names) if "knee" in name]
    if not knees:
        return np.full(len(run.log["/torque"]), np.nan)
    return np.asarray(np.mean(run.log["/torque"].field("command")[:, knees] ** 2, axis=1))


def joint_limit_margin(run: RunView) -> Array:
    """Least distance of a joint from its limits at each tick, shape (n,) [rad]."""
    position = run.field("/measurement", "joint_position")
    below = position - np.array(run.constants.position_lower)
    above = np.array(run.constants.position_upper) - position
    return np.asarray(np.minimum(below, above).min(axis=1))


def joint_power(run: RunView) -> Array:
    """Sum of the joints' absolute powers at each tick, shape (n,) [W]."""
    power = run.field("/measurement", "joint_torque") * run.field("/measurement", "joint_velocity")
    return np.asarray(np.abs(power).sum(axis=1))


def torque_ratio_max(run: RunView) -> float:
    """Largest commanded joint torque over its limit [-]."""
    return float(run.reduced(torque_ratio).max())


def torque_at_limit_fraction(run: RunView) -> float:
    """Share of ticks at which some joint's commanded torque is at its limit [-]."""
    return float(np.mean(run.reduced(torque_ratio) >= AT_LIMIT))


def knee_torque_rms(run: RunView) -> float | None:
    """Commanded knee torque, RMS over both knees from the first lift-off to the last touchdown, or the run [N m]."""
    squared = run.reduced(knee_torque_squared)[: run.ticks]
    value = float(np.sqrt(np.mean(squared[run.walking if run.walking.stop else slice(None)])))
    return value if np.isfinite(value) else None


def joint_limit_margin_min(run: RunView) -> float:
    """Least distance of a joint from its limits, negative beyond them [rad]."""
    return float(run.reduced(joint_limit_margin).min())


def cost_of_transport(run: RunView) -> float | None:
    """Joint work, absolute, over weight times the CoM's horizontal way from begin to end [-]."""
    com = run.field("/truth", "com")[:, :2]
    way = float(np.linalg.norm(com[-1] - com[0]))
    if not way > SHORTEST_WAY:
        return None
    work = float(run.reduced(joint_power).sum()) / run.constants.control_rate
    return work / (run.constants.mass * GRAVITY * way)


def qp_failures(run: RunView) -> int:
    """Ticks at which the whole-body QP's default solver failed."""
    return int(np.count_nonzero((run.field("/wbc", "status") != 0) | (run.field("/wbc", "solver") != 0)))


def wbc_fallbacks(run: RunView) -> int:
    """Ticks at which no solver succeeded and the fallback torque was used."""
    return int(np.count_nonzero(run.field("/wbc", "fallback")))


def planner_infeasible_fraction(run: RunView) -> float:
    """Share of plans whose hard constraints had no solution and were softened [-]."""
    return float(np.mean(run.log["/plan"].field("infeasible") != 0))


def planner_time(run: RunView) -> dict[str, float] | None:
    """Wall-clock time of a plan: median and 99th percentile [s]."""
    spent = run.field("/timing", "planner")
    return _spread(spent[spent > 0])


def wbc_time(run: RunView) -> dict[str, float] | None:
    """Wall-clock time to build and solve the whole-body QP: median and 99th percentile [s]."""
    return _spread(run.field("/timing", "wbc_build") + run.field("/timing", "wbc_solve"))


def real_time_factor(run: RunView) -> float | None:
    """Simulated over wall-clock time of the loop [-]."""
    wall = float(run.field("/timing", "tick").sum()) * 1e-6
    return run.ticks / run.constants.control_rate / wall if wall > 0 else None


def log_bytes(run: RunView) -> int:
    """Size of the log [bytes]."""
    return run.log.size


def _spread(microseconds: Array) -> dict[str, float] | None:
    if not len(microseconds):
        return None
    median, p99 = np.percentile(microseconds, (50, 99)) * 1e-6
    return {"median": float(median), "p99": float(p99)}
