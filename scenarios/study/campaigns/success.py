"""Which runs of a campaign met their criteria: rates, a map of them, and how what was drawn and measured spread."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.palette import FAIL, GREY, PASS, paler
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.show.kit.figures import DASHED, in_style, note, panels
from surefoot.scenarios.show.kit.html import MISSING, PageTable, TableCell, TableRow, escape, figure_html, section, tag
from surefoot.scenarios.study.campaigns.points import Point, Record, Runs
from surefoot.scenarios.study.campaigns.spec import (
    MOST,
    MOST_PANELS,
    Axis,
    combinations,
    name_axis,
    text,
    title,
    with_unit,
)
from surefoot.scenarios.study.campaigns.table import SuccessRate, as_float, wilson

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
    shown: tuple[TableCell | str, str] = (MISSING, MISSING)
    if judged:
        rate = rate_of(judged)
        shown = (TableCell(f"{100 * rate.rate:.1f}", value=rate.rate), rate.between)
    counts = (str(len(judged)), str(_passed(judged)))
    return [escape(name), escape(value), *counts, *shown, str(len(runs) - len(judged))]


def _split(key: str, runs: Runs) -> Iterator[tuple[str, Runs]]:
    """Runs by the quarter of a drawn number, or by a drawn choice."""
    values = [point.labels[key] for point, _ in runs]
    names = [str(value) for value in values]
    order = sorted(set(names))
    if len(order) > 4 and Axis(key, tuple(values)).numeric:
        edges = np.quantile(values, [0.0, 0.25, 0.5, 0.75, 1.0])
        order = [f"{text(float(low))} to {text(float(high))}" for low, high in pairwise(edges)]
        quarters = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, 3)
        for quarter, name in enumerate(order):
            yield name, [run for run, at in zip(runs, quarters, strict=True) if at == quarter]
        return
    for name in order:
        yield name, [run for run, own in zip(runs, names, strict=True) if own == name]


def map_section(swept: "Swept", runs: Runs, axes: Sequence[Axis]) -> str:
    """A map of the runs that passed over the last two axes, or a curve over the only one; none where nothing varies."""
    varied = [axis for axis in axes if len(axis.values) > 1]
    if not varied:
        return ""
    first = next(iter(swept.campaign.spec.first), None)
    groups: dict[str, list[tuple[Point, Record]]] = {}
    for run in runs:
        groups.setdefault(_place(run[0].labels, varied), []).append(run)

    def at(labels: Mapping[str, Any]) -> Runs:
        return groups.get(_place(labels, varied), [])

    if len(varied) == 1 and first is None:
        drawn, name, caption = success_along(varied[0], at), "success-along", f"Success rate by {varied[0].name}."
    else:
        what = f"{first} accepted" if first else ""
        drawn, name = success_map(varied, lambda labels: _square(at(labels), first), what), "success-map"
        caption = "Runs that passed, of those that were judged; grey where none was."
        caption += f" Below, the first value of {first} that was accepted." if first else ""
        left = math.prod(len(axis.values) for axis in varied[:-2]) - MOST_PANELS
        caption += f" {left} more panels are left out; the tables have all." if left > 0 else ""
    return section("Map", figure_html(drawn, caption, name))


def _place(labels: Mapping[str, Any], axes: Sequence[Axis]) -> str:
    return str([str(labels[axis.name]) for axis in axes])


def _square(runs: Runs, first: str | None) -> Square:
    judged = judged_of(runs)
    if not judged:
        return Square("refused" if runs and all(one.status == "refused" for _, one in runs) else "", math.nan)
    passed = _passed(judged)
    accepted = sorted({text(point.labels[first]) for point, _ in judged}) if first else []
    return Square("\n".join((f"{passed}/{len(judged)}", *accepted)), passed / len(judged))


def distributions_section(swept: "Swept", runs: Runs) -> str:
    """Histograms of what was drawn, and of what the criteria bound; none where nothing was judged."""
    judged = judged_of(runs)
    if not judged:
        return ""
    sampled = [_drawn(key, draw.choice is not None, judged) for key, draw in swept.campaign.spec.sample.items()]
    parts = [
        figure_html(distributions(spreads), caption, name)
        for name, spreads, caption in (
            ("sampled", sampled, "What was drawn, of runs that met their criteria and that missed them."),
            ("measured", list(_of_criteria(judged)), "What the criteria bound; dashed their bounds."),
        )
        if spreads
    ]
    return section("Distributions", *parts) if parts else ""


def judged_of(runs: Runs) -> Runs:
    """Runs that met their criteria or missed them."""
    return [run for run in runs if run[1].status in ("pass", "fail")]


def rate_of(judged: Runs) -> SuccessRate:
    """The success rate of runs that were judged, one at least."""
    return wilson(_passed(judged), len(judged))


def _passed(judged: Runs) -> int:
    return sum(record.status == "pass" for _, record in judged)


def success_map(axes: Sequence[Axis], square: Callable[[Mapping[str, Any]], Square], what: str) -> Figure:
    """A map over the last two axes that vary, of what is named, with a panel for each value of those before."""
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


def success_along(axis: Axis, at: Callable[[Mapping[str, Any]], Runs]) -> Figure:
    """Success rate along one axis with its interval, of the runs at each of its labels."""
    with in_style():
        figure, (one,) = panels(1, 2, 2.6)
        for place, value in enumerate(axis.values):
            x = value if axis.numeric else place
            if judged := judged_of(at({axis.name: value})):
                rate = rate_of(judged)
                one.plot([x, x], [100 * rate.low, 100 * rate.high], color=GREY, linewidth=2.0)
                one.plot([x], [100 * rate.rate], "o", color=PASS)
        name_axis(one, axis, "x", ticks=not axis.numeric)
        one.margins(x=0.05)
        one.set_ylim(-4.0, 104.0)
        one.set_ylabel("success [%], 95 % interval")
    return figure


def _drawn(key: str, choice: bool, judged: Runs) -> Histogram:
    """What was drawn; of a choice by its words."""
    return _spread(with_unit(key), judged, lambda run: [text(run[0].labels[key]) if choice else run[0].labels[key]])


def _spread(
    heading: str, judged: Runs, values: Callable[[tuple[Point, Record]], list[Any]], bounds: Sequence[float] = ()
) -> Histogram:
    groups: dict[str, list[Any]] = {"pass": [], "fail": []}
    for run in judged:
        groups[run[1].status] += values(run)
    return Histogram(heading, groups["pass"], groups["fail"], bounds)


def _of_criteria(judged: Runs) -> Iterator[Histogram]:
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


def _numbers(values: Iterable[Any]) -> Iterator[float]:
    """Numbers among values, and those among the elements and parts of these."""
    for value in values:
        inner = value.values() if isinstance(value, dict) else value if isinstance(value, list | tuple) else (value,)
        yield from (as_float(one) for one in inner if is_number(one))
