"""The layout of rows of the log, and the table in which they wait."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.log.channel import ChannelWriter

Array = NDArray[np.float64]
Columns = Sequence[tuple[ChannelWriter, Sequence[str]]]
"""Fields of channels, in order."""

Place = tuple[str, str] | str
"""Topic and name of a field, or the name of an input that is in no channel."""


class Derived(Protocol):
    """A function that derives fields of rows from the rest of them, in a table that it knows."""

    def derive(self, rows: int) -> None:
        """Derive those of the first rows."""


class Table:
    """Rows that wait, side by side what was given and what is derived.

    Args:
        capacity: rows.
        at: columns of each field and input.

    Attributes:
        values: shape (capacity, width).
    """

    def __init__(self, capacity: int, at: Mapping[Place, slice]) -> None:
        self._at = at
        self.values: Array = np.zeros((capacity, width(at)))

    def __getitem__(self, place: Place) -> Array:
        """View of a field or an input that waits, shape (capacity, size)."""
        return self.span(place, place)

    def span(self, first: Place, last: Place) -> Array:
        """View of neighbours that wait, from one to another, shape (capacity, sizes together)."""
        return self.values[:, self._at[first].start : self._at[last].stop]


@dataclass(frozen=True, slots=True)
class RowLayout:
    """The layout of rows: fields of channels, in this order.

    Attributes:
        vectors: fields that come as vectors.
        numbers: fields that come as plain numbers.
        derived: fields that are derived from the rest.
        derive: from the table of the rows to what derives them there.
        more_vectors: name and size of vectors that are only derived from; they come after the others.
        more_numbers: names of numbers that are only derived from; they come after the others.
        at: columns of the fields of `vectors` in what vectors make up; side by side in their order if None.
    """

    vectors: Columns
    numbers: Columns
    derived: Columns = ()
    derive: Callable[[Table], Derived] | None = None
    more_vectors: Mapping[str, int] = field(default_factory=dict)
    more_numbers: Sequence[str] = ()
    at: Mapping[Place, slice] | None = None

    def columns(self) -> tuple[Mapping[Place, slice], int, int]:
        """Columns of each field and input in a table, how many vectors fill, and how many numbers there are."""
        vectors = self.at or _side_by_side((*sizes(self.vectors), *self.more_vectors.items()), 0)
        begin = width(vectors)
        names = ((name, 1) for name in self.more_numbers)
        numbers = _side_by_side((*sizes(self.numbers), *names), begin)
        end = max(begin, width(numbers))
        return {**vectors, **numbers, **_side_by_side(sizes(self.derived), end)}, begin, end - begin


def sizes(group: Columns) -> list[tuple[Place, int]]:
    """The fields of a group, in order, with their sizes."""
    found = ((writer.spec, name) for writer, names in group for name in names)
    return [((spec.topic, name), one.size) for spec, name in found for one in spec.fields if one.name == name]


def width(at: Mapping[Place, slice]) -> int:
    """Columns up to the last one that something is in."""
    return max((place.stop for place in at.values()), default=0)


def _side_by_side(parts: Iterable[tuple[Place, int]], start: int) -> dict[Place, slice]:
    """Columns of what stands beside each other, from a column on."""
    found = {}
    for place, size in parts:
        found[place] = slice(start, start + size)
        start += size
    return found
