"""Rows of the log: one message for each of several channels at once, with what is derived from the rest."""

import numpy as np

from surefoot.maths import linear
from surefoot.scenarios.log.channel import Clock, Slab
from surefoot.scenarios.log.layout import Array, RowLayout, Table, sizes


class RowWriter:
    """Rows that wait for their chunk: vectors, numbers, and what is derived from both when the chunk is due.

    Args:
        layout: of the rows.
        capacity: rows that may wait.
        clock: says when a chunk is due.

    Raises:
        ValueError: a field is missing or there twice.
    """

    def __init__(self, layout: RowLayout, capacity: int, clock: Clock) -> None:
        groups = (layout.vectors, layout.numbers, layout.derived)
        writers = {writer.channel_id: writer for group in groups for writer, _ in group}
        size = sum([size for group in groups for _, size in sizes(group)])
        if size != sum([field.size for writer in writers.values() for field in writer.spec.fields]):
            raise ValueError("a row must hold every field of its channels exactly once")
        self._writers = list(writers.values())
        slab, column = Slab(capacity, sum([writer.size for writer in self._writers])), 0
        for writer in self._writers:
            writer.settle(slab, column)
            column += writer.size
        at, self._width, self._announced = layout.columns()
        table = Table(capacity, at)
        self._table = table.values
        self._fields = []
        for group in groups:
            for writer, names in group:
                for name in names:
                    view = writer.view(name)
                    self._fields.append((view, table[writer.spec.topic, name].reshape(view.shape)))
        self._derived = None if layout.derive is None else layout.derive(table)
        self._sources: list[Source] = []
        self._times: list[int] = []
        self._capacity, self._clock = capacity, clock

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics of its channels."""
        return tuple([writer.spec.topic for writer in self._writers])

    def append(self, time_ns: int, numbers: tuple[float, ...], *vectors: Array) -> None:
        """Add a message to each channel; the values are copied.

        Args:
            time_ns: simulated time [ns].
            numbers: the row's numbers.
            vectors: contiguous float64 arrays whose values, row by row, make up the rest of the row.

        Raises:
            ValueError: the vectors do not fill the row, or the numbers are not as many as were announced.
            LogError: the chunk that is complete without this row cannot be written.
        """
        if len(numbers) != self._announced:
            raise ValueError(f"a row of {len(numbers)} numbers, where there are places for {self._announced}")
        self._look(vectors)
        count = len(self._times)
        if time_ns >= self._clock.due or count == self._capacity:
            self._clock.look(time_ns, count == self._capacity)
            count = len(self._times)
        self._fill(self._table[count], numbers)
        self._times.append(time_ns)

    def _look(self, vectors: tuple[Array, ...]) -> None:
        """Look at arrays, most of which are the very ones of the row before.

        Views of these are kept: to make the views of a row takes ten times as long as to copy its numbers.
        """
        if len(vectors) != len(self._sources):
            self._sources = [Source() for _ in vectors]
        filled = 0
        for k in range(len(vectors)):
            source = self._sources[k]
            if vectors[k] is not source.array:
                source.look(vectors[k], k)
            filled += len(source.values)
        if filled != self._width:
            raise ValueError(f"vectors of a row of {filled} numbers, where there are places for {self._width}")

    def _fill(self, row: Array, numbers: tuple[float, ...]) -> None:
        """Write vectors and numbers into a row."""
        column = 0
        for source in self._sources:
            linear.fill(row, column, source.values)
            column += len(source.values)
        for k in range(len(numbers)):
            row[column + k] = numbers[k]

    def drop(self) -> None:
        """Forget the rows that wait."""
        self._times = []

    def spread(self) -> None:
        """Hand the rows that wait over to the channels."""
        count = len(self._times)
        if not count:
            return
        if self._derived is not None:
            self._derived.derive(count)
        for view, values in self._fields:
            view[:count] = values[:count]
        stamps = np.array(self._times, np.uint64)
        for writer in self._writers:
            writer.fill(self._times, stamps)
        self.drop()


class Source:
    """An array that rows are copied from.

    Attributes:
        array: it itself.
        values: its numbers, row by row.
    """

    def __init__(self) -> None:
        self.array: Array | None = None
        self.values = np.zeros(0)

    def look(self, array: Array, number: int) -> None:
        """Look at another one, which is so many-th of its row.

        Raises:
            ValueError: its numbers do not lie side by side as float64.
        """
        if array.dtype != np.float64 or not array.flags.c_contiguous:
            raise ValueError(f"vector {number} of a row is no contiguous array of float64")
        self.array, self.values = array, array.reshape(-1)
