"""Rows of the log: one message for each of several channels at once, with what is derived from the rest."""

import struct
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from itertools import zip_longest
from operator import is_

import numpy as np
from numpy.typing import NDArray

from surefoot.native.library import Bound, Library, place_of
from surefoot.scenarios.log.channel import ChannelWriter, Clock, Slab
from surefoot.values import dataclass

Array = NDArray[np.float64]
Columns = Sequence[tuple[ChannelWriter, Sequence[str]]]
"""Fields of channels, in order."""

Place = tuple[str, str] | str
"""Topic and name of a field, or the name of an input that is in no channel."""


class Rows:
    """Rows that are handed over, by the names of what they hold."""

    __slots__ = ("_at", "_tables")

    def __init__(self, tables: tuple[Array, ...], at: Sequence[Mapping[Place, slice]]) -> None:
        """Tables of shape (n, width), and where in each its fields and inputs are."""
        self._tables = tables
        self._at = at

    def __getitem__(self, place: Place) -> Array:
        """Values of a field or an input, shape (n, size)."""
        return self.span(place, place)

    def span(self, first: Place, last: Place) -> Array:
        """Values of neighbours from one to another, shape (n, sizes together).

        Raises:
            KeyError: these are not in the same table.
        """
        for table, at in zip(self._tables, self._at, strict=True):
            if first in at:
                return table[:, at[first].start : at[last].stop]
        raise KeyError(first)


Derive = Callable[[Rows], Mapping[tuple[str, str], Array]]
CompiledDerive = Callable[[Library, Callable[..., Array]], Callable[[], None]]
"""From the kernels, and from what gives the part of the row from one place to another, to the kernel that derives."""


@dataclass(frozen=True, slots=True)
class RowLayout:
    """What rows are made of: fields of channels, in this order.

    Attributes:
        vectors: fields that come as vectors.
        numbers: fields that come as plain numbers.
        derived: fields that come out of `derive`.
        derive: from rows to the derived fields, by topic and name.
        more_vectors: name and size of vectors that only `derive` needs; they come after the others.
        more_numbers: names of numbers that only `derive` needs; they come after the others.
        compiled: gives a kernel that does what `derive` does, to one row.
        fresh: whether nobody writes into a row's vectors any more, which have one axis: they are copied when the chunk
            is due.
        at: columns of the fields of `vectors` in what vectors make up; side by side in their order if None.
        standing: whether most vectors of a row are the very arrays of the row before, whose memory kernels then read.
    """

    vectors: Columns
    numbers: Columns
    derived: Columns = ()
    derive: Derive | None = None
    more_vectors: Mapping[str, int] = field(default_factory=dict)
    more_numbers: Sequence[str] = ()
    compiled: CompiledDerive | None = None
    standing: bool = False
    fresh: bool = False
    at: Mapping[Place, slice] | None = None


class RowWriter:
    """Rows that wait for their chunk: vectors, numbers, and what is derived from both when the chunk is due."""

    def __init__(self, layout: RowLayout, capacity: int, clock: Clock) -> None:
        """Rows of a layout, of which so many may wait until the clock says that a chunk is due.

        Raises:
            ValueError: a field is missing or there twice.
        """
        groups = (layout.vectors, layout.numbers, layout.derived)
        writers = {writer.channel_id: writer for group in groups for writer, _ in group}
        sizes = [size for group in groups for _, size in _sizes(group)]
        if sum(sizes) != sum(field.size for writer in writers.values() for field in writer.spec.fields):
            raise ValueError("a row must hold every field of its channels exactly once")
        self._writers, self._derive = list(writers.values()), layout.derive
        slab, column = Slab(capacity, sum(writer.size for writer in self._writers)), 0
        for writer in self._writers:
            writer.settle(slab, column)
            column += writer.size
        self._at = (
            layout.at or _places((*_sizes(layout.vectors), *layout.more_vectors.items())),
            _places((*_sizes(layout.numbers), *((name, 1) for name in layout.more_numbers))),
        )
        self._views, self._derived = (_views(layout.vectors), _views(layout.numbers)), _views(layout.derived)
        self._vectors, self._announced = np.zeros((capacity, _width(self._at[0]))), _width(self._at[1])
        # From plain numbers straight into memory: an array of them takes longer, and while they wait they grow cold.
        self._pack = struct.Struct(f"{self._announced}d").pack_into
        self._memory = bytearray(8 * capacity * self._announced)
        self._numbers: Array = np.ndarray((capacity, self._announced), buffer=self._memory)
        self._standing: Sequence[Array] = ()
        self._fresh: list[Array] | None = [] if layout.fresh else None
        self._gather: Callable[[int], None] | None = None
        self._times: list[int] = []
        self._capacity, self._clock = capacity, clock

    @property
    def topics(self) -> tuple[str, ...]:
        """Of its channels."""
        return tuple(writer.spec.topic for writer in self._writers)

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
        if self._fresh is None:
            self._look(vectors)
        else:
            if time_ns >= self._clock.due or len(self._times) == self._capacity:
                self._make_room(time_ns)
            self._fresh += vectors
        self.again(time_ns, numbers)

    def again(self, time_ns: int, numbers: tuple[float, ...]) -> None:
        """The same with the very arrays of the row before, with values of now; of standing rows, and without arrays."""
        if len(numbers) != self._announced:
            raise ValueError(f"a row of {len(numbers)} numbers, where there are places for {self._announced}")
        count = len(self._times)
        if time_ns >= self._clock.due or count == self._capacity:
            self._make_room(time_ns)
            count = len(self._times)
        self._pack(self._memory, 8 * self._announced * count, *numbers)
        if self._gather is not None:
            self._gather(count)
        elif self._standing:
            np.concatenate(self._standing, out=self._vectors[count])
        self._times.append(time_ns)

    def _make_room(self, time_ns: int) -> None:
        """Have the chunk written that is complete without a row of this time [ns]."""
        self._clock.look(time_ns, len(self._times) == self._capacity)

    def _look(self, vectors: tuple[Array, ...]) -> None:
        """Take arrays that are copied now, and by `again`, as views with one axis."""
        if not all(vector.flags.c_contiguous for vector in vectors):
            raise ValueError("a vector of a row is no contiguous array")
        self._standing = tuple(map(np.ndarray.ravel, vectors))

    def drop(self) -> None:
        """Forget the rows that wait."""
        self._times = []
        if self._fresh:
            self._fresh.clear()

    def spread(self) -> None:
        """Hand the rows that wait over to the channels."""
        n = len(self._times)
        if not n:
            return
        self._copy_fresh(n)
        tables = (self._vectors[:n], self._numbers[:n])
        for table, views, at in zip(tables, self._views, self._at, strict=True):
            for place, view in views:
                view[:n] = table[:, at[place]].reshape(n, *view.shape[1:])
        if self._derive is not None:
            values = self._derive(Rows(tables, self._at))
            for place, view in self._derived:
                view[:n] = values[place].reshape(n, *view.shape[1:])
        for writer in self._writers:
            writer.fill(self._times)
        self.drop()

    def _copy_fresh(self, n: int) -> None:
        """Copy the arrays that wait."""
        if self._fresh:
            np.concatenate(self._fresh, out=self._vectors[:n].reshape(-1))


def _sizes(group: Columns) -> list[tuple[tuple[str, str], int]]:
    """The fields of a group, in order, with their sizes."""
    found = ((writer.spec, name) for writer, names in group for name in names)
    return [((spec.topic, name), one.size) for spec, name in found for one in spec.fields if one.name == name]


def _places(sizes: Iterable[tuple[Place, int]]) -> dict[Place, slice]:
    """Columns of what stands beside each other."""
    found, start = {}, 0
    for place, size in sizes:
        found[place] = slice(start, start + size)
        start += size
    return found


def _width(at: Mapping[Place, slice]) -> int:
    return max((place.stop for place in at.values()), default=0)


def _views(group: Columns) -> list[tuple[tuple[str, str], NDArray[np.generic]]]:
    """Where the fields of a group wait."""
    return [((writer.spec.topic, name), writer.view(name)) for writer, names in group for name in names]


_HEADER = ("_sequence", "_log_time", "_publish_time", "_stamp")
"""What a kernel writes before the fields of a message, in its order."""


class CompiledRows(RowWriter):
    """The same by kernels, one of which puts all rows that wait into the messages of their channels.

    Args:
        layout: of the rows; what is derived has a kernel.
        capacity: rows that may wait.
        clock: says when a chunk is due.
        kernels: the library.
    """

    def __init__(self, layout: RowLayout, capacity: int, clock: Clock, kernels: Library) -> None:
        super().__init__(layout, capacity, clock)
        vectors, numbers = (_width(at) for at in self._at)
        parts = (*self._at, _places(_sizes(layout.derived)))
        places = {
            place: slice(at.start + start, at.stop + start)
            for part, start in zip(parts, (0, vectors, vectors + numbers), strict=True)
            for place, at in part.items()
        }
        if layout.standing:
            self._sources, self._sizes = np.zeros((2, vectors), dtype=np.int64)
            self._source = kernels.fill(
                "RowSources",
                count=0,
                sources=self._sources,
                sizes=self._sizes,
                width=vectors,
                values=self._vectors,
            )
            self._gather = kernels.bind("log_row_gather", self._source)
        row = np.zeros(_width(places))
        steps: list[Callable[[], None]] = []
        if layout.compiled is not None:
            steps.append(layout.compiled(kernels, lambda first, last: row[places[first].start : places[last].stop]))
        before = kernels.calls(steps)
        if before is None:
            raise TypeError("what a row derives is no kernel")
        self._stamps = np.zeros(capacity, dtype=np.int64)
        self._put = self._bind(kernels, row, places, before)

    def _bind(
        self, kernels: Library, row: Array, places: Mapping[Place, slice], before: Bound
    ) -> Callable[[int, int], None]:
        records, slab = [writer.records for writer in self._writers], self._writers[0].slab
        specs, begins = [writer.spec for writer in self._writers], [place_of(record) for record in records]
        fields = [(spec, begin, field) for spec, begin in zip(specs, begins, strict=True) for field in spec.fields]
        at = [places[spec.topic, field.name] for spec, _, field in fields]

        def integers(values: Iterable[int]) -> NDArray[np.int64]:
            return np.array(list(values), dtype=np.int64)

        return kernels.bind(
            "log_rows_put",
            vectors=self._vectors,
            vectors_width=self._vectors.shape[1],
            numbers=self._numbers,
            numbers_width=self._announced,
            times=self._stamps,
            before=before,
            values=row,
            fields=len(fields),
            first=integers(place.start for place in at),
            sizes=integers(place.stop - place.start for place in at),
            whole=integers(field.kind == "int" for *_, field in fields),
            places=integers(begin + spec.places[field.name] for spec, begin, field in fields),
            strides=np.full(len(fields), slab.width),
            channels=len(records),
            records=integers(begins),
            lengths=np.full(len(records), slab.width),
            header=integers(specs[0].places[name] for name in _HEADER),
        )

    def _look(self, vectors: tuple[Array, ...]) -> None:
        """Look where arrays are, which are kept as long as the kernel may read them."""
        before = self._standing
        if self._gather is None:
            self._standing = vectors
            return
        if len(vectors) == len(before) and all(map(is_, vectors, before)):
            return
        if sum(vector.size for vector in vectors) != self._vectors.shape[1]:
            raise ValueError(f"vectors of a row that do not fill its {self._vectors.shape[1]} places")
        for k, (vector, last) in enumerate(zip_longest(vectors, before[: len(vectors)])):
            if vector is not last:
                if vector.dtype != np.float64 or not vector.flags.c_contiguous:
                    raise ValueError(f"vector {k} of a row is no contiguous array of float64")
                self._sources[k], self._sizes[k] = vector.ctypes.data, vector.size
        self._source.struct.count, self._standing = len(vectors), vectors

    def spread(self) -> None:
        """See `RowWriter`."""
        n = len(self._times)
        if not n:
            return
        self._copy_fresh(n)
        self._stamps[:n] = self._times
        self._put(n, self._writers[0].total)
        for writer in self._writers:
            writer.fill(self._times, stamped=True)
        self.drop()
