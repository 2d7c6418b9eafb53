"""The judge's own control: of each criterion that a run met, a bound that it misses by a percent must be missed.

A judge whose bounds are wider than they say lets every sound run pass, so no baseline shows it.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.verdict import Verdict, missed

MARGIN = 0.01
"""Share of the value by which a bound is missed [-]."""

_LEAST = 1e-9
"""The same for a value of zero, in its unit."""


def blunt(verdict: Verdict, judge: Callable[[Mapping[str, Any], Mapping[str, Bound]], list[str]] = missed) -> list[str]:
    """Criteria of a verdict whose bounds a judge does not hold to a percent, a sentence each."""
    return [
        f"the judge lets {name} pass with a bound that it misses by {100 * MARGIN:.0f} %"
        for name, bound in verdict.criteria.items()
        for tight, misses in _tightened(bound, _value(verdict, name))
        if len(judge(verdict.metrics, {name: tight})) < misses
    ]


def _value(verdict: Verdict, name: str) -> Any:
    try:
        return verdict[name]
    except KeyError:
        return None


def _tightened(bound: Bound, value: Any) -> Iterator[tuple[Bound, int]]:
    """Bounds on one side each that a value misses, and by how many of its elements."""
    values = value if isinstance(value, list) else [value]
    if value is None or isinstance(value, Mapping) or any(element is None for element in values):
        return
    if bound.equals is not None:
        yield Bound(equals=_other(value)), 1
    if any(isinstance(element, bool | str) for element in values):
        return
    off = [max(MARGIN * abs(element), _LEAST) for element in values]
    for side, sign in (("min", 1.0), ("max", -1.0)):
        if getattr(bound, side) is not None:
            limits = tuple(element + sign * far for element, far in zip(values, off, strict=True))
            yield Bound.model_validate({side: limits if isinstance(value, list) else limits[0]}), len(values)


def _other(value: Any) -> Any:
    """A value that a criterion of equality must tell from this one."""
    if isinstance(value, bool):
        return not value
    return f"{value}?" if isinstance(value, str) else value + max(MARGIN * abs(value), _LEAST)
