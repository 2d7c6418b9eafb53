"""Metrics of how closely a walk follows the velocities that it is commanded, whatever walks."""

from collections.abc import Iterator

import numpy as np

from surefoot.planner.geometry.plane import headings
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.judge.metric import metric, reduction
from surefoot.scenarios.judge.walking import FALL_READS, fall_time

SETTLED = 1.5
"""Time that a robot has to come to a velocity, of the reference robot [s]."""

SHORTEST = 1.0
"""Time, once settled, below which a mean velocity is that of a step rather than of a walk, of that robot [s]."""

_READS: Reads = {**FALL_READS, "/command": ("velocity", "yaw_rate")}


@reduction("/truth")
def base_pose(run: RunView) -> Array:
    """Place and heading of the base at each tick, shape (n, 3) [m, m, rad]."""
    q = run.field("/truth", "q")
    return np.column_stack((q[:, :2], headings(q[:, 3:7])))


@metric(unit="m/s", needs=("/truth", "/command"), reads=_READS, reduces=(base_pose,), body=True, least=0.0)
def velocity_error(run: RunView) -> float | None:
    """Largest error of the base's mean velocity, over all commands that last until it is settled [m/s]."""
    errors = run.once(_errors)
    return float(np.hypot(errors[:, 0], errors[:, 1]).max()) if len(errors) else None


@metric(
    unit="rad/s", needs=("/truth", "/command"), reads=_READS, reduces=(base_pose,), body=True, least=0.0,
    tolerance=(0.005, 0.05),
)  # fmt: skip
def yaw_rate_error(run: RunView) -> float | None:
    """Largest error of the mean rate of the base's heading, over the same commands [rad/s]."""
    errors = run.once(_errors)
    return float(np.abs(errors[:, 2]).max()) if len(errors) else None


def _errors(run: RunView) -> Array:
    """Mean velocity less the commanded one, of each command that is judged, shape (k, 3) [m/s, m/s, rad/s]."""
    time, poses = run.constants.similarity.time, run.reduced(base_pose)[: run.ticks]
    found = []
    for begin, end, asked in _commanded(run):
        rows = slice(*np.searchsorted(run.time, (begin + SETTLED * time, end)).tolist())
        if (rows.stop - rows.start) / run.constants.control_rate >= SHORTEST * time:
            found.append(mean_velocity(poses[rows], run.constants.control_rate) - asked)
    return np.array(found).reshape(-1, 3)


def _commanded(run: RunView) -> Iterator[tuple[float, float, Array]]:
    """Begin, end and value of each velocity that is commanded [s, s, (m/s, m/s, rad/s)]; those alike are one."""
    log, fall = run.log["/command"], fall_time(run)
    asked = np.column_stack((log.field("velocity"), log.field("yaw_rate")))
    end = float(run.time[-1]) if fall is None else fall
    changed = np.flatnonzero(np.concatenate(([True], (asked[1:] != asked[:-1]).any(axis=1))))
    times = [*log.time[changed].tolist(), end]
    for row, begin, until in zip(changed, times[:-1], times[1:], strict=True):
        if np.isfinite(asked[row]).all():  # else it is led to a place
            yield begin, min(until, end), asked[row]


def mean_velocity(poses: Array, rate: float) -> Array:
    """Mean velocity along and across the heading, and of the heading.

    The mean is weighted by a Hann window, so that the sway of a gait, whose phase at both ends is any, does not count.

    Args:
        poses: place and heading at each tick, shape (n, 3) [m, m, rad].
        rate: of the ticks [Hz].

    Returns:
        shape (3,) [m/s, m/s, rad/s].
    """
    heading = np.unwrap(poses[:, 2])
    velocity = rate * np.diff(np.column_stack((poses[:, :2], heading)), axis=0)
    c, s = np.cos(heading[:-1]), np.sin(heading[:-1])
    ahead, aside = c * velocity[:, 0] + s * velocity[:, 1], c * velocity[:, 1] - s * velocity[:, 0]
    weights = np.hanning(len(velocity) + 2)[1:-1]
    return np.asarray(weights @ np.column_stack((ahead, aside, velocity[:, 2])) / weights.sum())
