"""Counts of outcomes, each of which takes a walk: no more are looked at than decide."""

from collections.abc import Iterable
from itertools import islice


def at_least(count: int, outcomes: Iterable[object]) -> bool:
    """Return true if so many outcomes are true; those that come after them are not looked at."""
    return sum(1 for _ in islice(filter(None, outcomes), count)) == count
