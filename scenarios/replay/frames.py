"""The frames of a replay: evenly spaced times and, for each, the last control tick that is not later."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from scenarios.errors import LogError
from scenarios.metrics.view import RunView
from scenarios.replay.content import Array


@dataclass(frozen=True, slots=True)
class Window:
    """What is asked for of a run.

    Attributes:
        start: first time, the log's if None [s].
        end: last time, the log's if None [s].
        frame_rate: frames per simulated second [Hz].
    """

    start: float | None = None
    end: float | None = None
    frame_rate: float = 30.0


@dataclass(frozen=True, slots=True)
class Frames:
    """Which ticks are shown.

    Attributes:
        time: of each frame, shape (n,) [s].
        rows: of the control-rate channels, shape (n,).
        rate: of the control-rate channels [Hz].
    """

    time: Array
    rows: NDArray[np.intp]
    rate: int

    def before(self, seconds: float) -> NDArray[np.intp]:
        """Rows of the ticks up to some seconds before each frame, the frame's own first, shape (n, ticks)."""
        back = np.arange(max(round(seconds * self.rate), 1))
        return np.asarray(np.maximum(self.rows[:, None] - back, 0))


def choose_frames(run: RunView, window: Window) -> Frames:
    """Frames of a window, without those in which the robot's state is not finite.

    Raises:
        LogError: the window holds no tick of the log.
    """
    if run.ticks == 0:
        raise LogError(f"{run.log.path}: ends before the first control tick; there is nothing to replay")
    ticks = run.time
    first, last = float(ticks[0]), float(ticks[-1])
    start = first if window.start is None else max(window.start, first)
    end = last if window.end is None else min(window.end, last)
    if not start <= end:
        asked = " ".join(f"{word} {t:g} s" for word, t in (("from", window.start), ("to", window.end)) if t is not None)
        raise LogError(f"{run.log.path}: nothing {asked}; the log goes from {first:g} s to {last:g} s")
    time = start + np.arange(int((end - start) * window.frame_rate + 1e-6) + 1) / window.frame_rate
    rows = np.maximum(np.searchsorted(ticks, time + 1e-9, side="right") - 1, 0)
    sound = np.isfinite(run.field("/truth", "q")[rows]).all(axis=1)
    if not sound.any():
        raise LogError(f"{run.log.path}: the robot's state is never finite; there is nothing to replay")
    return Frames(time[sound], rows[sound], run.constants.control_rate)
