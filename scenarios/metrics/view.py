"""A log as the metrics see it."""

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from scenarios.constants import RunConstants
from scenarios.metrics.digest import Digest, Source

SINGLE_SUPPORT = 2
"""Value of ``/reference.phase`` in single support."""

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class RunView:
    """Fields of a log on the common control ticks, with the run's constants.

    A killed process may leave a tick half written, so control-rate channels are cut to the shortest one.

    Attributes:
        log: the log, a part of it or its digest.
        constants: of its run.
    """

    def __init__(self, log: Source, constants: RunConstants | None = None) -> None:
        self.log = log
        self.constants = constants or RunConstants.from_metadata(log.metadata, str(log.path))

    def has(self, *topics: str) -> bool:
        """Whether all of these topics have messages."""
        return all(topic in self.log and len(self.log[topic]) > 0 for topic in topics)

    def field(self, topic: str, name: str) -> Array:
        """A field of a control-rate channel on the common ticks, shape (n, *field shape)."""
        return self.log[topic].field(name)[: self.ticks]

    def reduced(self, reduce: "Callable[[RunView], Array]") -> Array:
        """What a function makes of each tick or message: out of the digest if it holds that."""
        kept = self.log.reduced.get(reduce) if isinstance(self.log, Digest) else None
        return reduce(self) if kept is None else kept

    @cached_property
    def ticks(self) -> int:
        """Number of common control ticks."""
        every = ("/measurement", "/truth", "/estimate", "/contact", "/reference", "/wbc", "/torque", "/timing")
        return min((len(self.log[topic]) for topic in every if self.has(topic)), default=0)

    @cached_property
    def time(self) -> Array:
        """Time of the control ticks, shape (n,) [s]."""
        return self.log["/truth"].time[: self.ticks]

    @cached_property
    def single_support(self) -> Mask:
        """Ticks in planned single support, shape (n,)."""
        return np.asarray(self.field("/reference", "phase") == SINGLE_SUPPORT)

    @cached_property
    def walking(self) -> slice:
        """Ticks from the first lift-off to the last touchdown; empty when no foot was lifted."""
        swings = np.flatnonzero(self.single_support)
        return slice(int(swings[0]), int(swings[-1]) + 1) if len(swings) else slice(0, 0)

    @cached_property
    def soles(self) -> Array:
        """True poses of the soles, shape (n, 2, 7), x y z qx qy qz qw."""
        return np.stack([self.field("/truth", "left_sole"), self.field("/truth", "right_sole")], axis=1)

    @cached_property
    def sole_yaw(self) -> Array:
        """True headings of the soles, shape (n, 2) [rad]."""
        x, y, z, w = np.moveaxis(self.soles[..., 3:], -1, 0)
        return np.asarray(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))

    def rows_at(self, topic: str, times_ns: NDArray[np.int64]) -> tuple[NDArray[np.intp], Mask]:
        """Rows of a channel nearest to given times, and whether they are within half a control tick of them."""
        stamps = self.log[topic].time_ns
        after = np.clip(np.searchsorted(stamps, times_ns), 1, max(len(stamps) - 1, 1))
        before_is_nearer = times_ns - stamps[after - 1] <= np.abs(stamps[np.minimum(after, len(stamps) - 1)] - times_ns)
        rows = np.where(before_is_nearer, after - 1, np.minimum(after, len(stamps) - 1))
        return rows, np.abs(stamps[rows] - times_ns) <= 0.5e9 / self.constants.control_rate
