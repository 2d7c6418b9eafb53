"""Pushes: forces on bodies over time windows, their impulse exact on the physics clock."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import Push

Array = NDArray[np.float64]
NEVER = 2**62
"""A tick after every run."""


class PushSchedule:
    """The external force of every body as a piecewise constant function of the physics tick.

    A window that begins or ends inside a physics step acts in that step with the share that it covers. So the impulse
    of a push is force times duration whatever the rates.

    Attributes:
        total: sum of the applied forces, world frame, shape (3,) [N].
        mean: its mean over the last `World.advance`, shape (3,) [N].
        active: bodies and the forces applied to them.
        next_change: the first tick at which the forces differ from the applied ones.
    """

    def __init__(self, pushes: Sequence[Push], body_ids: Sequence[int], physics_rate: int) -> None:
        self._rate = physics_rate
        self._scheduled = [_acting(push, body, physics_rate) for push, body in zip(pushes, body_ids, strict=True)]
        self._ticks, self._forces = _timeline(self._scheduled, 0)
        self._live, self._first = self._scheduled, (self._ticks, self._forces)
        self._index = 0
        self.total, self.mean = np.zeros(3), np.zeros(3)
        self.active: list[tuple[int, Array]] = []
        self.next_change = self._ticks[1]

    def rewind(self, xfrc_applied: Array) -> None:
        """Apply the forces of tick 0 without added pushes; `xfrc_applied` is MuJoCo's (nbody, 6) array."""
        self._live, (self._ticks, self._forces) = self._scheduled, self._first
        self._index = 0
        self._apply(xfrc_applied)
        self.mean[:] = 0.0

    def step_over(self, xfrc_applied: Array) -> None:
        """Apply the forces that hold from `next_change` on."""
        self._index += 1
        self._apply(xfrc_applied)

    def add(self, push: Push, body: int, tick: int) -> None:
        """Add a push from the present tick on; what is applied changes with the next `step_over`, at that tick."""
        self._live = [*(other for other in self._live if other.end > tick), _acting(push, body, self._rate)]
        self._ticks, self._forces = _timeline(self._live, tick)
        self._index, self.next_change = -1, self._ticks[0]

    def _apply(self, xfrc_applied: Array) -> None:
        xfrc_applied[:] = 0.0
        self.total[:] = 0.0
        self.active, self.next_change = self._forces[self._index], self._ticks[self._index + 1]
        for body, force in self.active:
            xfrc_applied[body, :3] += force
            self.total += force


@dataclass(frozen=True, slots=True)
class _Acting:
    """A push on the physics clock: number of the body, force [N], start and end [ticks]."""

    body: int
    force: Array
    start: float
    end: float


def physics_window(time: float, duration: float, rate: int) -> tuple[float, float]:
    """Start and end of a push in physics ticks, free of rounding noise."""
    return round(time * rate, 6), round((time + duration) * rate, 6)


def _acting(push: Push, body: int, rate: int) -> _Acting:
    return _Acting(body, np.array(push.force, dtype=np.float64), *physics_window(push.time, push.duration, rate))


def _timeline(pushes: Sequence[_Acting], begin: int) -> tuple[list[int], list[list[tuple[int, Array]]]]:
    """Ticks from the begin on at which the forces change, ended by `NEVER`, and the forces from each of them on."""
    cuts = {corner for push in pushes for corner in _corners(push) if corner > begin}
    ticks = sorted({begin, *cuts})
    forces = [
        [(push.body, share * push.force) for push in pushes if (share := _share(tick, push)) > 0.0] for tick in ticks
    ]
    return [*ticks, NEVER], forces


def _corners(push: _Acting) -> tuple[int, ...]:
    """Ticks between which every step is covered by the same share."""
    return math.floor(push.start), math.ceil(push.start), math.floor(push.end), math.ceil(push.end)


def _share(tick: int, push: _Acting) -> float:
    """Share of the step from this tick to the next that the push covers."""
    return min(push.end, tick + 1.0) - max(push.start, float(tick))
