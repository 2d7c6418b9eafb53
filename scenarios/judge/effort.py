"""Metrics of effort, and of the way that it takes."""

import numpy as np

from surefoot.planner.geometry.plane import points_seen_from
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.judge.digest import GAIT, Array, RunView
from surefoot.scenarios.judge.metric import DEG, MM, OF_THE_TIME, metric, reduction

AT_LIMIT = 0.999
"""Share of its limit from which a torque counts as being at it; solvers end a hair below [-]."""

SHORTEST_WAY = 0.05
"""Way below which a cost of transport means nothing [m]."""


@reduction("/torque")
def torque_ratio(run: RunView) -> Array:
    """Largest commanded joint torque over its limit at each tick, and the number of that joint, shape (n, 2)."""
    return _largest(np.abs(run.field("/torque", "command")) / np.array(run.constants.torque_limit))


def _largest(by_joint: Array) -> Array:
    """The largest value of each row, and the joint that has it, shape (n, 2)."""
    return np.column_stack((by_joint.max(axis=1), by_joint.argmax(axis=1)))


@reduction("/torque")
def knee_torque_squared(run: RunView) -> Array:
    """Mean square of the commanded knee torques at each tick, shape (n,) [N² m²]; NaN without knees."""
    if not run.knees:
        return np.full(len(run.log["/torque"]), np.nan)
    return np.asarray(np.mean(run.log["/torque"].field("command")[:, run.knees] ** 2, axis=1))


@reduction("/measurement")
def joint_overrun(run: RunView) -> Array:
    """Greatest overrun of a joint's limits at each tick, negative inside [rad], and the joint; shape (n, 2)."""
    position = run.field("/measurement", "joint_position")
    below = np.array(run.constants.position_lower) - position
    return _largest(np.maximum(below, position - np.array(run.constants.position_upper)))


@reduction("/measurement")
def joint_speed_ratio(run: RunView) -> Array:
    """Largest joint speed over the joint's no-load speed at each tick, NaN in a log without these, and the joint."""
    speed = np.abs(run.field("/measurement", "joint_velocity"))
    return _largest(speed / np.array(run.constants.velocity_limit or (np.nan,)))


@reduction("/measurement")
def knee_flexion(run: RunView) -> Array:
    """Mean flexion of the knees at each tick, shape (n,) [rad]."""
    straight = run.constants.knee_straight or 0.0
    bend = np.abs(run.field("/measurement", "joint_position")[:, run.knees] - straight)
    return np.asarray((bend * (run.constants.knee_turn or 1.0)).mean(axis=1))


@reduction("/measurement")
def joint_power(run: RunView) -> Array:
    """Sum of the joints' absolute powers at each tick, shape (n,) [W]."""
    power = run.field("/measurement", "joint_torque") * run.field("/measurement", "joint_velocity")
    return np.asarray(np.abs(power).sum(axis=1))


@metric(shown=(1e2, "% of the limit"), reduces=(torque_ratio,), body=True, least=0.0)
def torque_ratio_max(run: RunView) -> float:
    """Largest commanded joint torque over its limit [-]."""
    return float(run.reduced(torque_ratio)[:, 0].max())


@metric(unit="N m", reads={GAIT: ()}, reduces=(knee_torque_squared,), body=True, least=0.0, tolerance=(0.5, 0.01))
def knee_torque_rms(run: RunView) -> float | None:
    """Commanded knee torque, RMS over both knees from the first lift-off to the last touchdown, or the run [N m]."""
    squared = run.reduced(knee_torque_squared)[: run.ticks]
    value = float(np.sqrt(np.mean(squared[run.walking if run.walking.stop else slice(None)])))
    return value if np.isfinite(value) else None


@metric(shown=OF_THE_TIME, reduces=(torque_ratio,), body=True, least=0.0, most=1.0)
def torque_at_limit_fraction(run: RunView) -> float:
    """Share of ticks at which some joint's commanded torque is at its limit [-]."""
    return float(np.mean(run.reduced(torque_ratio)[:, 0] >= AT_LIMIT))


@metric(unit="rad", shown=DEG, reduces=(joint_overrun,), body=True, tolerance=(0.005, 0.0))
def joint_limit_margin_min(run: RunView) -> float:
    """Least distance of a joint from its limits, negative beyond them [rad]."""
    return 0.0 - float(run.reduced(joint_overrun)[:, 0].max())


@metric(unit="rad", shown=(1e3, "mrad"), reads={"/coupling": ("apart",)}, body=True, least=0.0)
def coupling_error(run: RunView) -> float | None:
    """Largest distance of a joint that follows another one from where it belongs [rad]."""
    apart = run.log["/coupling"].field("apart")
    return float(np.abs(apart).max()) if apart.size else None


@metric(shown=(1e2, "% of no-load speed"), reduces=(joint_speed_ratio,), body=True)
def joint_speed_ratio_max(run: RunView) -> float:
    """Largest joint speed over the joint's no-load speed, above 1 where no motor could follow [-]."""
    return float(run.reduced(joint_speed_ratio)[:, 0].max())


@metric(unit="rad", shown=DEG, reads={GAIT: ()}, reduces=(knee_flexion,), body=True, tolerance=(0.005, 0.0))
def knee_angle_mean(run: RunView) -> float | None:
    """Mean flexion of both knees while walking, or over the whole run when no foot was lifted [rad]."""
    if not run.knees:
        return None
    return float(np.mean(run.reduced(knee_flexion)[run.walking if run.walking.stop else slice(None)]))


@metric(reads={"/truth": ("com",)}, reduces=(joint_power,), body=True, least=0.0, tolerance=(0.002, 0.01))
def cost_of_transport(run: RunView) -> float | None:
    """Joint work, absolute, over weight times the CoM's horizontal way from begin to end [-]."""
    com = run.field("/truth", "com")[:, :2]
    way = float(np.linalg.norm(com[-1] - com[0]))
    if not way > SHORTEST_WAY * run.constants.similarity.length:
        return None
    work = float(run.reduced(joint_power).sum()) / run.constants.control_rate
    return work / (run.constants.mass * GRAVITY * way)


@metric(unit="m/s", reads={"/truth": ("com",), GAIT: ("phase",)}, least=0.0, tolerance=(0.002, 0.005))
def speed_mean(run: RunView) -> float | None:
    """Horizontal way of the CoM from the first lift-off to the last touchdown over the time it took [m/s]."""
    if not run.walking.stop:
        return None
    com = run.field("/truth", "com")[run.walking, :2]
    time = run.time[run.walking]
    return float(np.linalg.norm(com[-1] - com[0]) / (time[-1] - time[0])) if time[-1] > time[0] else None


@metric(unit="m", needs=("/truth",), reads={"/footstep": ()}, least=0.0, tolerance=(0.003, 0.001))
def path_length(run: RunView) -> float:
    """Length of the way from one middle of the feet to the next, over all touchdowns [m]."""
    if not run.has("/footstep"):
        return 0.0
    touchdowns, _ = run.rows_at("/truth", run.log["/footstep"].time_ns)
    middles = _middles(run)[np.minimum(np.concatenate(([0], touchdowns)), run.ticks - 1)]
    return float(np.linalg.norm(np.diff(middles, axis=0), axis=1).sum())


@metric(unit="m", size=2, reads={"/truth": ()}, tolerance=(0.003, 0.001))
def displacement(run: RunView) -> list[float]:
    """Way of the feet's middle from start to end, ahead and to the left in the start heading [m]."""
    middles, yaw = _middles(run), float(_heading(run)[0])
    start = np.array([*middles[0], 0.0, yaw])
    return list(map(float, points_seen_from(start, middles[-1:])[0]))


@metric(unit="rad", shown=DEG, reads={"/truth": ()}, tolerance=(0.005, 0.0))
def heading_change(run: RunView) -> float:
    """Change of the feet's mean heading from start to end, whole turns counted, left positive [rad]."""
    heading = _heading(run)
    return float(heading[-1] - heading[0])


@metric(unit="m", shown=MM, reads={"/truth": ("com",)}, least=0.0, tolerance=(0.001, 0.0))
def com_height_range(run: RunView) -> float:
    """Highest minus lowest CoM [m]."""
    return float(np.ptp(run.field("/truth", "com")[:, 2]))


def _middles(run: RunView) -> Array:
    """Middle of both soles at each tick, shape (n, 2) [m]."""
    left, right = (run.sole(foot)[:, :2].copy() for foot in (0, 1))
    return np.asarray(0.5 * (left + right))


def _heading(run: RunView) -> Array:
    """Mean heading of both soles at each tick, without jumps, shape (n,) [rad]."""
    left, right = np.unwrap(run.sole_yaw, axis=0).T
    apart = (left[0] - right[0] + np.pi) // (2.0 * np.pi) * 2.0 * np.pi
    return np.asarray(0.5 * (left - apart + right))
