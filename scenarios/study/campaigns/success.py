"""Which runs of a campaign met their criteria: rates, a map of them, and how what was drawn and measured spread."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.palette import FAIL, GREY, PASS, paler
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.show.kit.figures import DASHED, in_style, note, panels
from surefoot.scenarios.show.kit.html import MISSING, PageTable, TableCell, TableRow, escape, figure_html, section, tag
from surefoot.scenarios.study.campaigns.axes import (
    MOST_PANELS,
    Axis,
    combinations,
    is_number,
    name_axis,
    text,
    title,
    with_unit,
)
from surefoot.scenarios.study.campaigns.points import Point, Record, Runs
from surefoot.scenarios.study.campaigns.spec import MOST
from surefoot.scenarios.study.campaigns.table import as_float, wilson

if TYPE_CHECKING:
    from surefoot.scenarios.study.campaigns.sweep import Swept

ROUNDING, TINY = 1e-9, 1e-100
"""Values that differ by less, as a share of the greatest or at all, are drawn as the same."""


class Square(NamedTuple):
    """A square of a map: what is written in it, and from 0 to 1 how it is coloured, NaN for grey."""

    text: str
    share: float


def success_section(swept: "Swept", runs: Runs, axes: Sequence[Axis]) -> str:
    """The success rate of all runs, and by each value of what varies."""
    if not judged_of(runs):
        return section("Success", tag("p", "No run was judged, so that there is no success rate."))
    rows = [_rate_row("all runs", "", runs)]
    for axis in axes:
        if len(axis.values) > 1:
            groups = [(text(one), [run for run in runs if run[0].labels[axis.name] == one]) for one in axis.values]
            rows += [_rate_row(axis.heading, name, group) for name, group in groups]
    for key in swept.campaign.spec.sample:
        rows += [_rate_row(with_unit(key), name, group) for name, group in _split(key, runs)]
    head = ["by", "value", "judged", "passed", "rate [%]", "95 % interval [%]", "refused or broken"]
    note = "Rates are of runs that were judged; intervals are Wilson&#39;s."
    return section("Success", PageTable("success", head, rows, note).html)


def _rate_row(name: str, value: str, runs: Runs) -> TableRow:
    judged = judged_of(runs)
    counts = [str(len(judged)), str(passed_of(judged))]
    rest = str(len(runs) - len(judged))
    if not judged:
        return [escape(name), escape(value), *counts, MISSING, MISSING, rest]
    rate = wilson(passed_of(judged), len(judged))
    shown = TableCell(f"{100 * rate.rate:.1f}", value=rate.rate)
    return [escape(name), escape(value), *counts, shown, f"{100 * rate.low:.1f} to {100 * rate.high:.1f}", rest]


def _split(key: str, runs: Runs) -> Iterator[tuple[str, Runs]]:
    """Runs by the quarter of a drawn number, or by a drawn choice."""
    values = [point.labels[key] for point, _ in runs]
    if len(set(map(str, values))) <= 4 or not Axis(key, tuple(values)).numeric:
        for one in sorted(set(map(str, values))):
            yield one, [run for run in runs if str(run[0].labels[key]) == one]
        return
    edges = np.quantile(values, [0.0, 0.25, 0.5, 0.75, 1.0])
    quarter = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, 3)
    for i in range(4):
        name = f"{text(float(edges[i]))} to {text(float(edges[i + 1]))}"
        yield name, [run for run, at in zip(runs, quarter, strict=True) if at == i]


def map_section(swept: "Swept", runs: Runs, axes: Sequence[Axis]) -> str:
    """A map of the runs that passed over the last two axes, or a curve over the only one; none where nothing varies."""
    varied = [axis for axis in axes if len(axis.values) > 1]
    if not varied:
        return ""
    first = next(iter(swept.campaign.spec.first), None)
    groups: dict[tuple[str, ...], list[tuple[Point, Record]]] = {}
    for run in runs:
        groups.setdefault(tuple(str(run[0].labels[axis.name]) for axis in varied), []).append(run)

    def square(labels: Mapping[str, Any]) -> Square:
        return _square(groups.get(tuple(str(labels[axis.name]) for axis in varied), []), first)

    if len(varied) == 1 and first is None:
        (axis,) = varied
        judged = [judged_of(groups.get((str(value),), [])) for value in axis.values]
        drawn = success_along(axis, [(passed_of(group), len(group)) for group in judged])
        shown = figure_html(drawn, f"Success rate by {axis.name}.", "success-along")
    else:
        drawn = success_map(varied, square, f"{first} accepted" if first else "")
        caption = "Runs that passed, of those that were judged; grey where none was." + (
            f" Below, the first value of {first} that was accepted." if first else ""
        )
        panels = int(np.prod([len(axis.values) for axis in varied[:-2]]))
        left = panels - MOST_PANELS
        caption += f" {left} more panels are left out; the tables have all." if left > 0 else ""
        shown = figure_html(drawn, caption, "success-map")
    return section("Map", shown)


def _square(runs: Runs, first: str | None) -> Square:
    judged = judged_of(runs)
    if not judged:
        return Square("refused" if runs and all(one.status == "refused" for _, one in runs) else "", float("nan"))
    passed = passed_of(judged)
    counts = f"{passed}/{len(judged)}"
    accepted = sorted({text(point.labels[first]) for point, _ in judged}) if first else []
    return Square("\n".join((counts, *accepted)), passed / len(judged))


def distributions_section(swept: "Swept", runs: Runs) -> str:
    """Histograms of what was drawn, and of what the criteria bound; none where nothing was judged."""
    judged = judged_of(runs)
    if not judged:
        return ""
    sampled = [drawn(key, draw.choice is not None, judged) for key, draw in swept.campaign.spec.sample.items()]
    measured = list(of_criteria(judged))
    parts = []
    for name, spreads, caption in (
        ("sampled", sampled, "What was drawn, of runs that met their criteria and that missed them."),
        ("measured", measured, "What the criteria bound; dashed their bounds."),
    ):
        if spreads:
            parts.append(figure_html(distributions(spreads), caption, name))
    return section("Distributions", *parts) if parts else ""


def judged_of(runs: Runs) -> Runs:
    """Runs that met their criteria or missed them."""
    return [run for run in runs if run[1].status in ("pass", "fail")]


def passed_of(runs: Runs) -> int:
    """How many met them."""
    return Counter(record.status for _, record in runs)["pass"]


def success_map(axes: Sequence[Axis], square: Callable[[Mapping[str, Any]], Square], what: str) -> Figure:
    """A map over the last two axes, with a panel for each value of those before.

    Args:
        axes: with more than one value, at least one.
        square: at some labels.
        what: is shown.
    """
    *others, rows, columns = axes if len(axes) > 1 else (Axis("", ("",)), *axes)
    every = combinations(others)[:MOST_PANELS]
    with in_style():
        figure, drawn = panels(len(every), 3, 0.9 + min(0.42 * len(rows.values), 5.0))
        for one, panel in zip(drawn, every, strict=True):
            table = [
                [square({**panel, columns.name: right, rows.name: up}) for right in columns.values]
                for up in rows.values
            ]
            _fill(one, table, small=len(columns.values) * len(every) > 24)
            name_axis(one, columns, "x")
            name_axis(one, rows, "y")
            one.set_title(", ".join(filter(None, (title(panel), what))), fontsize=8.5)
    return figure


def _fill(axes: Axes, table: Sequence[Sequence[Square]], small: bool) -> None:
    bad, good, none = (np.array(paler(color, 0.35)) for color in (FAIL, PASS, GREY))
    colors = [
        [none if math.isnan(one.share) else (1 - one.share) * bad + one.share * good for one in row] for row in table
    ]
    axes.pcolormesh(range(len(table[0])), range(len(table)), np.array(colors), shading="nearest")
    axes.grid(visible=False)
    for up, row in enumerate(table):
        for right, one in enumerate(row):
            axes.text(right, up, one.text, ha="center", va="center", fontsize=5.5 if small else 7.5)


class Histogram(NamedTuple):
    """Values of a quantity of passing and of failing runs, and the bounds that it had to keep."""

    name: str
    passed: Sequence[Any]
    failed: Sequence[Any]
    bounds: Sequence[float] = ()


def distributions(spreads: Sequence[Histogram]) -> Figure:
    """A stacked histogram of each quantity."""
    with in_style():
        figure, every = panels(len(spreads), 4, 1.9)
        for one, spread in zip(every, spreads, strict=True):
            _histogram(one, spread)
        known = {label: handle for one in every for handle, label in zip(*one.get_legend_handles_labels(), strict=True)}
        figure.legend(known.values(), known.keys(), loc="outside upper left", ncols=4)
    return figure


def _histogram(axes: Axes, spread: Histogram) -> None:
    axes.set_xlabel(spread.name)
    values, colors = [*spread.passed, *spread.failed], [PASS, FAIL]
    if all(map(is_number, values)):
        groups = [[float(one) for one in group if abs(one) <= MOST] for group in (spread.passed, spread.failed)]
        shown = [one for group in groups for one in group]
        if len(shown) < len(values) or not values:
            note(axes, f"{len(values) - len(shown)} values beyond all bounds" if values else "no value")
        if shown:
            axes.hist(groups, bins=_edges(shown), stacked=True, color=colors, label=["met", "missed"])
        for bound in (bound for bound in spread.bounds if abs(bound) <= MOST):
            axes.axvline(bound, color="black", linestyle=DASHED, linewidth=0.9)
        axes.margins(x=0.03)
    else:
        names = sorted({str(value) for value in values})
        counts = [[sum(str(value) == name for value in group) for name in names] for group in spread[1:3]]
        axes.bar(names, counts[0], 0.6, color=PASS, label="met")
        axes.bar(names, counts[1], 0.6, counts[0], color=FAIL, label="missed")
        axes.set_xlim(-0.6, len(names) - 0.4)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=5, integer=True))


def _edges(values: Sequence[float]) -> list[float]:
    """Edges of the bins of a histogram; values that differ by rounding alone stand in the middle of a wider range."""
    count, low, high = min(max(5, round(len(values) ** 0.5)), 24), min(values), max(values)
    if high - low <= max(ROUNDING * max(abs(low), abs(high)), TINY):
        middle = 0.5 * (low + high)
        aside = 0.05 * abs(middle) if abs(middle) > TINY else 0.5
        low, high = middle - aside, middle + aside
    return [float(edge) for edge in np.linspace(low, high, count + 1)]


def success_along(axis: Axis, counts: Sequence[tuple[int, int]]) -> Figure:
    """Success rate along one axis, with its interval.

    Args:
        axis: of the grid.
        counts: at each value runs that passed, and all that were judged.
    """
    with in_style():
        figure, (one,) = panels(1, 2, 2.6)
        for place, (passed, judged) in enumerate(counts):
            at = axis.values[place] if axis.numeric else place
            if judged:
                rate = wilson(passed, judged)
                one.plot([at, at], [100 * rate.low, 100 * rate.high], color=GREY, linewidth=2.0)
                one.plot([at], [100 * rate.rate], "o", color=PASS)
        name_axis(one, axis, "x", ticks=not axis.numeric)
        one.margins(x=0.05)
        one.set_ylim(-4.0, 104.0)
        one.set_ylabel("success [%], 95 % interval")
    return figure


def drawn(key: str, choice: bool, judged: Runs) -> Histogram:
    """What was drawn; of a choice by its words."""

    def values(run: tuple[Point, Record]) -> list[Any]:
        value = run[0].labels[key]
        return [text(value) if choice else value]

    return _spread(with_unit(key), judged, values)


def _spread(heading: str, judged: Runs, values: Any, bounds: Sequence[float] = ()) -> Histogram:
    groups: dict[str, list[Any]] = {"pass": [], "fail": []}
    for run in judged:
        groups[run[1].status] += values(run)
    return Histogram(heading, groups["pass"], groups["fail"], bounds)


def of_criteria(judged: Runs) -> Iterator[Histogram]:
    """Every metric that a criterion bounds, in the unit that a person is shown."""
    for name, bounds in criteria(judged).items():
        metric = known(name)
        scale = metric.scale if metric else 1.0
        limits = {scale * one for bound in bounds for one in _numbers((bound.min, bound.max, bound.equals))}
        heading = f"{name} [{metric.shown}]" if metric and metric.shown else name

        def values(run: tuple[Point, Record], name: str = name, scale: float = scale) -> list[Any]:
            value = run[1].metrics.get(name)
            return [str(value).lower()] if isinstance(value, bool) else [scale * one for one in _numbers((value,))]

        spread = _spread(heading, judged, values, sorted(limits))
        if spread.passed or spread.failed:
            yield spread


def criteria(runs: Runs) -> dict[str, list[Bound]]:
    """Every bound on a metric in some runs; those of one scenario are asked once, and refused ones have none."""
    asked = {
        (point.base.reference, str([(k, v) for k, v in point.settings.items() if k.startswith("criteria")])): point
        for point, _ in runs
    }
    found: dict[str, list[Bound]] = {}
    for point in asked.values():
        try:
            for name, bound in read_scenario(*point.base.written, point.settings).criteria.items():
                found.setdefault(name, []).append(bound)
        except ScenarioError:
            continue
    return found


def _numbers(values: Iterable[Any]) -> list[float]:
    """Numbers among values and among the elements of lists of them."""
    found: list[float] = []
    for value in values:
        several = (
            value if isinstance(value, list | tuple) else list(value.values()) if isinstance(value, dict) else [value]
        )
        found += [as_float(one) for one in several if is_number(one)]
    return found
