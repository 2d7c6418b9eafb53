"""The last values of observation terms, side by side in an input of a network."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Stack:
    """The last values of some terms.

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
        self._kept: list[list[Array]] | None = None

    def add(self, values: Sequence[Array]) -> Array:
        """Take the newest values of each term; gives all that are kept, side by side."""
        if self._kept is None:
            first = [np.zeros_like(one) if self._zero else one for one in values]
            self._kept = [[one] * length for one, length in zip(first, self._lengths, strict=True)]
        for kept, newest in zip(self._kept, values, strict=True):
            kept.append(newest)
            del kept[0]
        ordered = [kept[::-1] if self._newest_first else kept for kept in self._kept]
        if self._interleaved:
            return np.concatenate([one for frame in zip(*ordered, strict=True) for one in frame])
        return np.concatenate([one for kept in ordered for one in kept])
