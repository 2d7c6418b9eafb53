"""The smallest part of a set that still has a property, by delta debugging."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TypeVar

T = TypeVar("T")


def smallest(all_of: Sequence[T], holds: Callable[[tuple[T, ...]], bool], first: Sequence[T] = ()) -> tuple[T, ...]:
    """A part of a set, without any single one of whose members a property is lost.

    Zeller and Hildebrandt, Simplifying and Isolating Failure-Inducing Input, 2002: the algorithm ddmin, of which only
    complements are tried, after the part that is likely to be enough.

    Args:
        all_of: the set, which has the property.
        holds: whether a part has it, which is asked once for each.
        first: a part that is likely to have it.

    Returns:
        the part, in the order of the set.
    """
    known: dict[tuple[T, ...], bool] = {tuple(all_of): True}

    def has(part: tuple[T, ...]) -> bool:
        if part not in known:
            known[part] = holds(part)
        return known[part]

    if not all_of or has(()):
        return ()
    left = tuple(first) if first and has(tuple(first)) else tuple(all_of)
    pieces = 2
    while len(left) > 1:
        pieces = min(pieces, len(left))
        smaller = next((rest for rest in _complements(left, pieces) if has(rest)), None)
        if smaller is not None:
            left, pieces = smaller, max(pieces - 1, 2)
        elif pieces == len(left):
            break
        else:
            pieces *= 2
    return left


def _complements(of: tuple[T, ...], pieces: int) -> list[tuple[T, ...]]:
    """The rest of a set without each of so many pieces of it."""
    bounds = [len(of) * number // pieces for number in range(pieces + 1)]
    return [of[:begin] + of[end:] for begin, end in pairwise(bounds) if end > begin]
