"""Metrics of the way: speed, length, heading and height."""

import math

import numpy as np

from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.judge.metric import metric


@metric(unit="m/s", reads={"/truth": ("com",), "/reference": ("phase",)})
def speed_mean(run: RunView) -> float | None:
    """Horizontal way of the CoM from the first lift-off to the last touchdown over the time it took [m/s]."""
    if not run.walking.stop:
        return None
    com = run.field("/truth", "com")[run.walking, :2]
    time = run.time[run.walking]
    return float(np.linalg.norm(com[-1] - com[0]) / (time[-1] - time[0])) if len(time) > 1 else None


@metric(unit="m", needs=("/truth",), reads={"/footstep": ()})
def path_length(run: RunView) -> float:
    """Length of the way from one middle of the feet to the next, over all touchdowns [m]."""
    if not run.has("/footstep"):
        return 0.0
    touchdowns, _ = run.rows_at("/truth", run.log["/footstep"].time_ns)
    middles = _middles(run)[np.minimum(np.concatenate(([0], touchdowns)), run.ticks - 1)]
    return float(np.linalg.norm(np.diff(middles, axis=0), axis=1).sum())


@metric(unit="m", size=2, reads={"/truth": ()})
def displacement(run: RunView) -> list[float]:
    """Way of the feet's middle from start to end, ahead and to the left in the start heading [m]."""
    middles, yaw = _middles(run), float(_heading(run)[0])
    x, y = middles[-1] - middles[0]
    c, s = np.cos(yaw), np.sin(yaw)
    return [float(c * x + s * y), float(c * y - s * x)]


@metric(unit="rad", shown=(180.0 / math.pi, "deg"), reads={"/truth": ()})
def heading_change(run: RunView) -> float:
    """Change of the feet's mean heading from start to end, whole turns counted, left positive [rad]."""
    heading = _heading(run)
    return float(heading[-1] - heading[0])


@metric(unit="m", shown=(1e3, "mm"), reads={"/truth": ("com",)})
def com_height_range(run: RunView) -> float:
    """Highest minus lowest CoM [m]."""
    return float(np.ptp(run.field("/truth", "com")[:, 2]))


def _middles(run: RunView) -> Array:
    """Middle of both soles at each tick, shape (n, 2) [m]."""
    return np.asarray(run.soles[:, :, :2].mean(axis=1))


def _heading(run: RunView) -> Array:
    """Mean heading of both soles at each tick, without jumps, shape (n,) [rad]."""
    left, right = np.unwrap(run.sole_yaw, axis=0).T
    apart = (left[0] - right[0] + np.pi) // (2.0 * np.pi) * 2.0 * np.pi
    return np.asarray(0.5 * (left - apart + right))
