"""Searches for the value of a key from which on runs fail: a ladder that is climbed, a range that is halved."""

from collections.abc import Callable, Generator

from surefoot.scenarios.file.search import Bisect
from surefoot.scenarios.many.points import Point, Record, Search, Threshold

Passes = Callable[[float], Generator[Point, Record, bool]]
"""Makes the runs of a value, and says whether it passes."""


def search(passes: Passes, bisect: Bisect) -> Search:
    """Search a threshold as a specification asks for it."""
    return _climb(passes, bisect) if bisect.ratio is not None else _halve(passes, bisect)


def _climb(passes: Passes, bisect: Bisect) -> Search:
    """The highest rung up to which all pass."""
    reached = None
    for rung in bisect.rungs:
        if not (yield from passes(rung)):
            return Threshold(reached, "below" if reached is None else "inside")
        reached = rung
    return Threshold(reached, "above")


def _halve(passes: Passes, bisect: Bisect) -> Search:
    """Search where passing turns into failing, or failing into passing."""
    assert bisect.tolerance is not None
    low, high = bisect.low, bisect.high
    at_low = yield from passes(low)
    at_high = yield from passes(high)
    while at_low and at_high and bisect.most is not None and high < bisect.most:
        low, high = high, min(2.0 * high, bisect.most)
        at_high = yield from passes(high)
    if at_low == at_high:
        return Threshold(None, "above" if at_low else "below")
    while high - low > bisect.tolerance:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        if (yield from passes(middle)) == at_low:
            low = middle
        else:
            high = middle
    return Threshold(low if at_low else high, "inside")
