"""A sample: what the runs of a scenario measured, seed by seed."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from surefoot.scenarios.file.units import is_number

MetricValue = bool | int | float | None
"""Value of a metric that is no list and has no parts, or of one element or part of it."""

MARGIN = "margins."
"""Begins the name of a threshold that was searched; behind it stands the scenario's name of the search."""

_SAME = 1e-5
"""Share by which values may differ that are the same: they are written with six digits [-]."""


@dataclass(frozen=True, slots=True)
class SeedSample:
    """Runs of a scenario that differ in their seed.

    Attributes:
        seeds: of the runs, each once.
        passed: whether each met its criteria.
        values: by metric, element or part, one for each run; None where it means nothing there.
    """

    seeds: tuple[int, ...]
    passed: tuple[bool, ...]
    values: Mapping[str, tuple[MetricValue, ...]]

    @classmethod
    def of(cls, runs: Sequence[tuple[int, bool, Mapping[str, Any]]]) -> "SeedSample":
        """The sample of some runs: seed, whether it passed, and its metrics by name."""
        rows = [dict(flattened(metrics)) for _, _, metrics in runs]
        names = dict.fromkeys(name for row in rows for name in row)
        values = {name: tuple(row.get(name) for row in rows) for name in names}
        return cls(tuple(seed for seed, _, _ in runs), tuple(passed for _, passed, _ in runs), values)

    def at(self, seeds: Iterable[int]) -> "SeedSample":
        """The runs of some seeds, in that order; those that it has not got are left out."""
        places = {seed: place for place, seed in enumerate(self.seeds)}
        kept = [places[seed] for seed in seeds if seed in places]
        values = {name: tuple(column[place] for place in kept) for name, column in self.values.items()}
        return SeedSample(
            tuple(self.seeds[place] for place in kept), tuple(self.passed[place] for place in kept), values
        )

    def filled(self, now: "SeedSample") -> "SeedSample":
        """The sample with the values that it lacks beside another of the same seeds; of other seeds it is that one."""
        return replace(now, values={**now.values, **self.values}) if self.seeds == now.seeds else now

    @property
    def missed(self) -> tuple[int, ...]:
        """Seeds whose runs missed their criteria."""
        return tuple(seed for seed, passed in zip(self.seeds, self.passed, strict=True) if not passed)

    @property
    def is_random(self) -> bool:
        """True if runs of two seeds differ in any value, so that the seed matters."""
        columns = (self.passed, *self.values.values())
        return any(not alike(column[0], one) for column in columns for one in column[1:])

    def is_as(self, other: "SeedSample") -> bool:
        """Return true if it is another sample, run by run, to the digits that are written."""
        if (self.seeds, self.passed, self.values.keys()) != (other.seeds, other.passed, other.values.keys()):
            return False
        return all(all(map(alike, column, other.values[name])) for name, column in self.values.items())

    def text(self) -> Iterator[str]:
        """Lines of YAML."""
        yield f"  seeds: {_row(self.seeds)}"
        yield f"  passed: {_row(self.passed)}"
        yield "  values:"
        yield from (f"    {name}: {_row(column)}" for name, column in self.values.items())


def read_sample(data: Any) -> SeedSample:
    """Read such lines back, as values.

    Raises:
        ValueError: they are none; says why.
    """
    rows = data if isinstance(data, dict) else {}
    seeds, passed, values = (rows.get(name) for name in ("seeds", "passed", "values"))
    if not isinstance(seeds, list) or not isinstance(passed, list) or not isinstance(values, dict):
        raise ValueError("its sample has no seeds, passed or values")
    if not all(type(one) is int and one >= 0 for one in seeds) or len(set(seeds)) != len(seeds) or not seeds:
        raise ValueError("its sample has seeds that are none, or one twice")
    if len(passed) != len(seeds) or not all(isinstance(one, bool) for one in passed):
        raise ValueError("its sample does not say of each seed whether it passed")
    for name, column in values.items():
        if not isinstance(column, list) or len(column) != len(seeds) or not all(map(_is_value, column)):
            raise ValueError(f"its sample has no value of {name} for each seed")
    return SeedSample(tuple(seeds), tuple(passed), {str(name): tuple(column) for name, column in values.items()})


def flattened(metrics: Mapping[str, Any]) -> Iterator[tuple[str, MetricValue]]:
    """Each number of some metrics by its name, with the element or part behind it."""
    for name, value in metrics.items():
        if isinstance(value, list | tuple):
            yield from ((f"{name}[{index}]", one) for index, one in enumerate(value))
        elif isinstance(value, Mapping):
            yield from ((f"{name}.{part}", one) for part, one in value.items())
        else:
            yield name, value


def alike(before: MetricValue, now: MetricValue) -> bool:
    """Return true if two values are the same to the digits that are written."""
    if is_number(before) and is_number(now):
        return math.isclose(float(before or 0), float(now or 0), rel_tol=_SAME, abs_tol=1e-12)
    return before is now


def _is_value(value: Any) -> bool:
    return value is None or isinstance(value, bool) or (is_number(value) and math.isfinite(value))


def _row(values: Sequence[MetricValue]) -> str:
    return f"[{', '.join(map(_written, values))}]"


def _written(value: MetricValue) -> str:
    if value is None:
        return "~"
    if isinstance(value, bool):
        return str(value).lower()
    return repr(float(f"{value:.6g}")) if isinstance(value, float) else str(value)
