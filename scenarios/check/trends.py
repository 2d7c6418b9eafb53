"""Figures of a history: a trend for each metric, with what a check allows about it, and where the runs changed."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from surefoot.maths.chance import wilson
from surefoot.scenarios.check.findings import RATE
from surefoot.scenarios.check.lines import Line, Seeds
from surefoot.scenarios.check.shifts import shifts
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.judge.metric import Metric
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.palette import BLACK, BLUE, DARK, FAIL, GREY, paler
from surefoot.scenarios.show.kit.figures import DASHED, in_style, note

_SIZE = (2.8, 1.7)
"""Width and height of a picture [in]."""

_MARGINS = {"left": 0.2, "right": 0.97, "bottom": 0.27, "top": 0.9}
"""Places of the axes' edges in a picture, shares of it [-]."""

_ROOM = 2.0
"""Spans of a trend from it within which a bound is drawn [-]."""

_INTERVAL = 1.96
"""Half of an interval over the standard error of a mean [-]."""

TOOK = "took"
"""Name of the trend of how long a check of the scenario took."""


Span = tuple[float, float]
"""Ends of an interval that holds with 95 %."""


@dataclass(frozen=True, slots=True)
class Trend:
    """An element of a metric in the checks of a scenario.

    Attributes:
        name: of the metric, with the element or part after it.
        values: of each check, None where it has none.
        passed: whether each check passed.
        bound: of the scenario on it, None without one.
        spans: interval of each value that is a mean or a share of several seeds, None of one seed.
    """

    name: str
    values: tuple[float | None, ...]
    passed: tuple[bool, ...]
    bound: Bound | None = None
    spans: tuple[Span | None, ...] = ()

    @property
    def metric(self) -> "Metric[Any] | None":
        """The metric; None where it is not known here, or none."""
        return known(self.name.partition("[")[0].partition(".")[0])

    @property
    def repeatable(self) -> bool:
        """True if two runs of one scenario give the same value."""
        return self.name != TOOK and (self.metric is None or self.metric.repeatable)

    @property
    def scale(self) -> float:
        """From its values to what is shown."""
        return 1.0 if self.metric is None else self.metric.scale

    @property
    def unit(self) -> str:
        """Unit in which it is shown."""
        return "s" if self.name == TOOK else "" if self.metric is None else self.metric.shown

    @property
    def spread(self) -> bool:
        """True if a value of it is of several seeds."""
        return any(self.spans)

    @property
    def label(self) -> str:
        """Its name with its unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    def allowed(self, value: float) -> float:
        """Distance from a value at which a check counts another one as the same."""
        return self.metric.allowed(value) if self.metric is not None and self.repeatable else 0.0

    def limits(self) -> Iterator[float]:
        """Bounds on it that are numbers."""
        place = int(self.name.partition("[")[2].rstrip("]") or 0)
        for limit in () if self.bound is None else (self.bound.min, self.bound.max):
            if isinstance(limit, tuple):
                limit = limit[place] if place < len(limit) else None
            if limit is not None:
                yield float(limit)


def trends(lines: Sequence[Line]) -> list[Trend]:
    """The trend of each element of each metric that any of some lines has a number of, and of the time they took."""
    found: dict[str, dict[int, float]] = {}
    spans: dict[str, dict[int, Span]] = {}
    for at, line in enumerate(lines):
        for name, value in (*_elements(line.metrics), (TOOK, line.took)):
            found.setdefault(name, {})[at] = value
        for name, mean, span in () if line.seeds is None else _over_seeds(line.seeds):
            found.setdefault(name, {})[at] = mean
            spans.setdefault(name, {})[at] = span
    every, bounds = range(len(lines)), lines[-1].criteria
    passed = tuple(line.passed for line in lines)
    return [
        Trend(
            name,
            tuple(values.get(at) for at in every),
            passed,
            bounds.get(name.partition("[")[0]),
            tuple(spans.get(name, {}).get(at) for at in every),
        )
        for name, values in found.items()
    ]


def _over_seeds(seeds: Seeds) -> Iterator[tuple[str, float, Span]]:
    """The pass rate, and the mean of each number, with their intervals."""
    rate = wilson(seeds.passed.count(True), len(seeds.passed))
    yield RATE, rate.rate, (rate.low, rate.high)
    for name, column in seeds.values.items():
        numbers = [float(one) for one in column if one is not None and math.isfinite(one)]
        if len(numbers) > 1:
            mean = math.fsum(numbers) / len(numbers)
            half = _INTERVAL * float(np.std(numbers, ddof=1)) / math.sqrt(len(numbers))
            yield name, mean, (mean - half, mean + half)


def _elements(metrics: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Each number of each metric, named; what is true or false is 1 or 0."""
    for name, value in metrics.items():
        parts = {name: value}
        if isinstance(value, list):
            parts = {f"{name}[{number}]": one for number, one in enumerate(value)}
        elif isinstance(value, dict):
            parts = {f"{name}.{part}": one for part, one in value.items()}
        for part, one in parts.items():
            if isinstance(one, bool) or (is_number(one) and math.isfinite(one)):
                yield part, int(one) if isinstance(one, bool) else one


def picture(trend: Trend, changed: Mapping[int, str]) -> Figure:
    """A trend over the checks in order.

    Args:
        trend: to draw.
        changed: names of the changes by the number of the check at which they are.
    """
    with in_style():
        figure = Figure(figsize=_SIZE)  # its margins are fixed: to lay out a figure takes as long as to draw it
        figure.subplots_adjust(**_MARGINS)
        axes = figure.add_subplot()
        values = np.array([math.nan if one is None else trend.scale * one for one in trend.values])
        levels = [0, *sorted(changed), len(values)]
        if trend.repeatable:
            _draw_allowed(axes, trend, values, levels)
        else:
            _draw_levels(axes, trend, values)
        _draw_values(axes, trend, values)
        _draw_bounds(axes, trend, values)
        for at, name in changed.items() if trend.repeatable else ():
            axes.axvline(at - 0.5, color=DARK, linewidth=0.7)
            axes.annotate(
                name, (at - 0.5, 1.0), xycoords=("data", "axes fraction"), ha="center", va="bottom", fontsize=6.5
            )
        axes.set_xlim(-0.5, len(values) - 0.5)
        axes.xaxis.set_major_locator(MaxNLocator(4, integer=True, steps=[1, 2, 5, 10]))
        axes.xaxis.set_major_formatter(lambda at, _: f"{at + 1:g}")
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.set_xlabel(trend.label.replace("$", r"\$"))
    return figure


def _draw_values(axes: Axes, trend: Trend, values: np.ndarray[Any, Any]) -> None:
    if not np.isfinite(values).any():
        note(axes, "no value")
        return
    for at, span in enumerate(trend.spans):
        if span is not None:
            axes.plot([at, at], [trend.scale * end for end in span], color=paler(BLUE), linewidth=1.4, zorder=1)
    places, passed = np.arange(len(values)), np.array(trend.passed)
    axes.plot(places, values, color=paler(BLUE), linewidth=0.8, zorder=2)
    for which, color, marker in ((passed, BLUE, "o"), (~passed, FAIL, "X")):
        axes.plot(places[which], values[which], marker, color=color, markersize=2.4, linestyle="", zorder=3)


def _draw_allowed(axes: Axes, trend: Trend, values: np.ndarray[Any, Any], levels: Sequence[int]) -> None:
    """Draw what a check would allow about the first value since each change."""
    for begin, end in pairwise(levels):
        found = np.flatnonzero(np.isfinite(values[begin:end]))
        if len(found):
            first = begin + int(found[0])
            level, allowed = values[first], trend.scale * trend.allowed(trend.values[first] or 0.0)
            axes.fill_between([begin - 0.5, end - 0.5], level - allowed, level + allowed, color=paler(GREY, 0.7), lw=0)


def _draw_levels(axes: Axes, trend: Trend, values: np.ndarray[Any, Any]) -> None:
    """Draw the median of each level of a noisy series."""
    rows = np.flatnonzero(np.isfinite(values))
    if not len(rows):
        return
    begins = [0, *shifts(values[rows].tolist()), len(rows)]
    for begin, end in pairwise(begins):
        level = float(np.median(values[rows[begin:end]]))
        axes.plot([rows[begin] - 0.5, rows[end - 1] + 0.5], [level, level], color=GREY, linewidth=1.2, zorder=1)


def _draw_bounds(axes: Axes, trend: Trend, values: np.ndarray[Any, Any]) -> None:
    """Draw the bounds of the criterion that are near."""
    if not np.isfinite(values).any():
        return
    low, high = axes.get_ylim()
    for limit in trend.limits():
        shown = trend.scale * limit
        if low - _ROOM * (high - low) <= shown <= high + _ROOM * (high - low):
            axes.axhline(shown, color=BLACK, linestyle=DASHED, linewidth=0.8)
