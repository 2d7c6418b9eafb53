"""Several channels of one rate, appended as one row of numbers: one copy per tick, spread over the fields per chunk."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from scenarios.log.channel_writer import ChannelWriter, Clock

Array = NDArray[np.float64]
Columns = Sequence[tuple[ChannelWriter, Sequence[str]]]
"""Fields of channels, in order."""

Derive = Callable[[Array, Array], Array]


class RowWriter:
    """Rows that wait for their chunk: vectors, numbers, and what is derived from both when the chunk is due."""

    __slots__ = ("_capacity", "_clock", "_columns", "_derive", "_flush", "_numbers", "_times", "_vectors", "_writers")

    def __init__(
        self,
        vectors: Columns,
        numbers: Columns,
        capacity: int,
        clock: Clock,
        flush: Callable[[int], None],
        derived: Columns = (),
        derive: Derive | None = None,
        inputs: int = 0,
    ) -> None:
        """Rows made of fields of channels, in this order.

        Args:
            vectors: fields that come as vectors.
            numbers: fields that come as plain numbers.
            capacity: rows that may wait.
            clock: says when a chunk is due.
            flush: completes it.
            derived: fields that come out of `derive`.
            derive: from vectors, shape (n, width), and numbers, shape (n, count), to the derived fields' columns.
            inputs: width of further vectors that only `derive` needs.

        Raises:
            ValueError: a field is missing or there twice.
        """
        groups = (vectors, numbers, derived)
        self._columns = [_columns(group) for group in groups]
        writers = {writer.channel_id: writer for group in groups for writer, _ in group}
        widths = [columns[-1][2] if columns else 0 for columns in self._columns]
        if sum(widths) != sum(field.size for writer in writers.values() for field in writer.spec.fields):
            raise ValueError("a row must hold every field of its channels exactly once")
        self._writers = list(writers.values())
        self._derive = derive
        self._vectors = np.zeros((capacity, widths[0] + inputs))
        self._numbers: list[tuple[float, ...]] = []
        self._times: list[int] = []
        self._capacity, self._clock, self._flush = capacity, clock, flush

    def append(self, time_ns: int, numbers: tuple[float, ...], *vectors: Array) -> None:
        """Add a message to each channel; the values are copied.

        Args:
            time_ns: simulated time [ns].
            numbers: the row's numbers.
            vectors: float64 vectors that make up the rest of the row.

        Raises:
            ValueError: the vectors do not fill the row.
            LogError: the chunk that this row completes cannot be written.
        """
        if vectors:
            np.concatenate(vectors, out=self._vectors[len(self._times)])
        self._numbers.append(numbers)
        self._times.append(time_ns)
        if time_ns >= self._clock.due or len(self._times) == self._capacity:
            self._flush(time_ns)

    def spread(self) -> None:
        """Hand the rows that wait over to the channels."""
        n = len(self._times)
        if not n:
            return
        vectors, numbers = self._vectors[:n], np.array(self._numbers)
        groups = [vectors, numbers] if self._derive is None else [vectors, numbers, self._derive(vectors, numbers)]
        for rows, columns in zip(groups, self._columns, strict=False):
            for view, start, end in columns:
                view[:n] = rows[:, start:end].reshape(n, *view.shape[1:])
        for writer in self._writers:
            writer.fill(self._times)
        self._times.clear()
        self._numbers.clear()


def places(group: Columns) -> dict[tuple[str, str], slice]:
    """Columns that the fields of a group take, by topic and name."""
    found, start = {}, 0
    for writer, names in group:
        sizes = {field.name: field.size for field in writer.spec.fields}
        for name in names:
            found[writer.spec.topic, name] = slice(start, start + sizes[name])
            start += sizes[name]
    return found


def _columns(group: Columns) -> list[tuple[NDArray[np.generic], int, int]]:
    """Where the fields of a group wait, and the columns that they take."""
    at = places(group)
    fields = [(writer, name, at[writer.spec.topic, name]) for writer, names in group for name in names]
    return [(writer.view(name), place.start, place.stop) for writer, name, place in fields]
