"""The last values of observation terms, side by side in an input of a network."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Stack:
    """The last values of some terms.

    They are rows of frames, the newest one last, each with the values of all terms. An input is a choice of these.

    Args:
        lengths: how many values of each term are kept.
        newest_first: whether the newest one comes first, else the oldest.
        interleaved: whether frames of all terms stand side by side, else all values of one term after another's.
        zero: whether there were zeros before the first values, else these.

    Raises:
        ValueError: frames of terms of which not as many values are kept.
    """

    def __init__(self, lengths: Sequence[int], newest_first: bool, interleaved: bool, zero: bool) -> None:
        if interleaved and len(set(lengths)) > 1:
            raise ValueError(f"frames of terms with histories of {sorted(set(lengths))} values")
        self._lengths = lengths
        self._newest_first = newest_first
        self._interleaved = interleaved
        self._zero = zero
        self.reset()

    def reset(self) -> None:
        """Forget all values."""
        self._frames: Array | None = None

    def add(self, newest: Array, sizes: Sequence[int]) -> Array:
        """Take the newest values of all terms, of so many numbers each; gives all that are kept, side by side."""
        if self._frames is None:
            rows = max(self._lengths, default=1)
            self._frames = np.zeros((rows, len(newest))) if self._zero else np.tile(newest, (rows, 1))
            self._chosen = np.concatenate(list(self._places(sizes)))
        frames = self._frames
        frames[:-1] = frames[1:]
        frames[-1] = newest
        return frames.take(self._chosen)

    def _places(self, sizes: Sequence[int]) -> Iterator[NDArray[np.intp]]:
        """Places, among all frames one after another, of what an input is made of, in order."""
        most, width = max(self._lengths, default=1), sum(sizes)
        begins = np.concatenate(([0], np.cumsum(sizes)))
        found = []
        for length, begin, size in zip(self._lengths, begins[:-1], sizes, strict=True):
            rows = [row * width + np.arange(begin, begin + size) for row in range(most - length, most)]
            found.append(rows[::-1] if self._newest_first else rows)
        if self._interleaved:
            yield from (one for frame in zip(*found, strict=True) for one in frame)
        else:
            yield from (one for rows in found for one in rows)
