"""Several channels of one rate, appended as one row of numbers: one copy per tick, spread over the fields per chunk."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from scenarios.log.channel_writer import ChannelWriter, Clock

Array = NDArray[np.float64]
Columns = Sequence[tuple[ChannelWriter, Sequence[str]]]


class RowWriter:
    """Rows that wait for their chunk."""

    __slots__ = ("_capacity", "_clock", "_columns", "_count", "_derive", "_flush", "_rows", "_times", "_writers")

    def __init__(
        self,
        columns: Columns,
        capacity: int,
        clock: Clock,
        flush: Callable[[int], None],
        width: int = 0,
        derive: Callable[[Array], Array] | None = None,
    ) -> None:
        """Rows made of fields of channels, in this order.

        Args:
            columns: every field of every channel that takes part.
            capacity: rows that may wait.
            clock: says when a chunk is due.
            flush: completes it.
            width: numbers that are appended, where `derive` makes the row of them.
            derive: from appended numbers, shape (n, width), to rows, for all that wait at once.

        Raises:
            ValueError: a field is missing or there twice.
        """
        self._columns: list[tuple[NDArray[np.generic], int, int]] = []
        start = 0
        for writer, names in columns:
            sizes = {field.name: field.size for field in writer.spec.fields}
            for name in names:
                self._columns.append((writer.view(name), start, start + sizes[name]))
                start += sizes[name]
        self._writers = list({writer.channel_id: writer for writer, _ in columns}.values())
        if start != sum(field.size for writer in self._writers for field in writer.spec.fields):
            raise ValueError("a row must hold every field of its channels exactly once")
        self._derive = derive
        self._rows = np.zeros((capacity, width if derive else start))
        self._times: list[int] = []
        self._count = 0
        self._capacity, self._clock, self._flush = capacity, clock, flush

    def append(self, time_ns: int, *parts: Array) -> None:
        """Add a message to each channel; the values are copied.

        Args:
            time_ns: simulated time [ns].
            parts: float64 vectors that make up the row.

        Raises:
            ValueError: the parts do not fill the row.
            LogError: the chunk that this row completes cannot be written.
        """
        n = self._count
        np.concatenate(parts, out=self._rows[n])
        self._times.append(time_ns)
        self._count = n = n + 1
        if time_ns >= self._clock.due or n == self._capacity:
            self._flush(time_ns)

    def spread(self) -> None:
        """Hand the rows that wait over to the channels."""
        n = self._count
        if not n:
            return
        rows = self._rows[:n] if self._derive is None else self._derive(self._rows[:n])
        for view, start, end in self._columns:
            view[:n] = rows[:, start:end].reshape(n, *view.shape[1:])
        for writer in self._writers:
            writer.fill(self._times)
        self._times.clear()
        self._count = 0
