"""The success of a campaign's runs: rates of those that met their criteria, and spreads of what was measured."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.maths.chance import SuccessRate, wilson
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.many.points import Point, Record, Runs
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.show.kit.html import MISSING, PageTable, TableCell, TableRow, escape, section, tag
from surefoot.studies.campaigns.histograms import Histogram, histograms_html
from surefoot.studies.campaigns.spec import Axis, text, with_unit
from surefoot.studies.campaigns.table import as_float

if TYPE_CHECKING:
    from surefoot.studies.campaigns.sweep import Swept


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
    counts = (str(len(judged)), str(passed_of(judged)))
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


def distributions_section(swept: "Swept", runs: Runs) -> str:
    """Histograms of what was drawn, and of what the criteria bound; none where nothing was judged."""
    judged = judged_of(runs)
    if not judged:
        return ""
    sampled = [_drawn(key, draw.choice is not None, judged) for key, draw in swept.campaign.spec.sample.items()]
    parts = [
        histograms_html(spreads, caption, name)
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
    return wilson(passed_of(judged), len(judged))


def passed_of(judged: Runs) -> int:
    """Number of runs that met their criteria."""
    return sum(record.status == "pass" for _, record in judged)


def _drawn(key: str, choice: bool, judged: Runs) -> Histogram:
    """Histogram of what was drawn; of a choice by its words."""
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
