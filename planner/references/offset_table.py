"""The ZMP that the legs add, made once for some ticks."""

from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.plane import greatest
from surefoot.planner.model.time_scaling import Course, TimeScaling
from surefoot.planner.references.zmp_reference import SupportKey
from surefoot.planner.types import Array


@dataclass(frozen=True)
class OffsetTable:
    """The ZMP that the swing leg adds over a window and some samples more: planner state that outlives a tick.

    It was made for the CoM of its first tick; the offset hardly depends on it (see `planner.references.leg_offset`). So
    a plan depends on the ticks before it not only by the jerk and the swing that go on, but by at most `ticks` - 1 of
    them in this as well.

    Attributes:
        start: tick of the clock that it was made at.
        key: of the support then, whose plan frame is that of the values.
        course: of the clock's last time scaling.
        aim: where a swing goes that deviated from its step then, shape (3,) [m].
        values: shape (m, 2) [m].
        ticks: for which it serves.
    """

    start: int
    key: SupportKey
    course: Course
    aim: Array | None
    values: Array
    ticks: int

    def holds(self, clock: TimeScaling, key: SupportKey, aim: Array | None, apart: float) -> bool:
        """Return true if it still serves: same support, footholds and clock, aims hardly apart, and few ticks later."""
        ticks = clock.ticks
        if self.key != key or self.course != clock.course or not self.start < ticks < self.start + self.ticks:
            return False
        if aim is None or self.aim is None:
            return aim is self.aim
        return bool(greatest(np.abs(aim - self.aim)) <= apart)

    def guess(self, ticks: int, key: SupportKey, count: int) -> Array | None:
        """About what the next one will be, shape (count, 2) [m]; None where the last one tells nothing of it."""
        passed = ticks - self.start
        if self.key != key or passed >= len(self.values):
            return None
        values = self.values[passed : passed + count]
        return np.concatenate((values, np.repeat(values[-1:], count - len(values), axis=0)))

    def since(self, ticks: int, count: int) -> Array:
        """So many offsets from a tick at which it holds, shape (count, 2) [m]."""
        return self.values[ticks - self.start : ticks - self.start + count]
