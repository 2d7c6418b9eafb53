"""Pushes: forces on bodies over time windows, their impulse exact on the physics clock."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NEVER = 2**62
"""A tick after every run."""


@dataclass(frozen=True, slots=True)
class Push:
    """A constant force on a body's CoM.

    Attributes:
        time: start [s].
        duration: length of the window [s].
        force: world frame, shape (3,) [N].
        body: body name.
    """

    time: float
    duration: float
    force: Array
    body: str


class PushSchedule:
    """The external force of every body as a piecewise constant function of the physics tick.

    A window that begins or ends inside a physics step acts in that step with the share of the step it covers, so that
    the impulse of a push is force times duration whatever the rates.
    """

    def __init__(self, pushes: Sequence[Push], body_ids: Sequence[int], physics_rate: int) -> None:
        windows = [_window(push, physics_rate) for push in pushes]
        cuts = {corner for start, end in windows for corner in _corners(start, end)}
        self._ticks = [*sorted({0, *cuts}), NEVER]
        self._forces = [
            [
                (body, share * np.asarray(push.force, dtype=np.float64))
                for push, body, window in zip(pushes, body_ids, windows, strict=True)
                if (share := _share(tick, window)) > 0.0
            ]
            for tick in self._ticks[:-1]
        ]
        self._index = 0
        self.total = np.zeros(3)
        self.active: list[tuple[int, Array]] = []

    @property
    def next_change(self) -> int:
        """The first tick at which the forces differ from the applied ones."""
        return self._ticks[self._index + 1]

    def rewind(self, xfrc_applied: Array) -> None:
        """Apply the forces of tick 0; `xfrc_applied` is MuJoCo's (nbody, 6) array."""
        self._index = 0
        self._apply(xfrc_applied)

    def step_over(self, xfrc_applied: Array) -> None:
        """Apply the forces that hold from `next_change` on."""
        self._index += 1
        self._apply(xfrc_applied)

    def _apply(self, xfrc_applied: Array) -> None:
        xfrc_applied[:] = 0.0
        self.total[:] = 0.0
        self.active = self._forces[self._index]
        for body, force in self.active:
            xfrc_applied[body, :3] += force
            self.total += force


def _window(push: Push, rate: int) -> tuple[float, float]:
    """Start and end in physics ticks, free of rounding noise."""
    return round(push.time * rate, 6), round((push.time + push.duration) * rate, 6)


def _corners(start: float, end: float) -> tuple[int, ...]:
    """Ticks between which every step is covered by the same share."""
    return math.floor(start), math.ceil(start), math.floor(end), math.ceil(end)


def _share(tick: int, window: tuple[float, float]) -> float:
    """Share of the step from this tick to the next that the window covers."""
    start, end = window
    return min(end, tick + 1.0) - max(start, float(tick))
