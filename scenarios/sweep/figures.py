"""Figures of a campaign: thresholds around the compass or along an axis, maps of success, distributions."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from surefoot.scenarios.palette import FAIL, GREY, PASS, paler
from surefoot.scenarios.show.figures.style import CYCLE, in_style, note
from surefoot.scenarios.sweep.points import Threshold
from surefoot.scenarios.sweep.spec import MOST
from surefoot.scenarios.sweep.table import key_unit, wilson

WIDTH = 11.6
"""Of a figure on a page [in]."""
MOST_PANELS = 12
ROUNDING, TINY = 1e-9, 1e-100
"""Values that differ by less, as a share of the greatest or at all, are drawn as the same."""
ROUND = {0.0: "forward", 0.25: "", 0.5: "left", 0.75: "", 1.0: "backward", 1.25: "", 1.5: "right", 1.75: ""}
"""What directions are called, by their angle from the world's x axis [pi rad]."""

Labels = tuple[Any, ...]
Limit = Callable[[Mapping[str, Any], float], float | None]
"""Gives the limit of a search by its labels, in a direction [rad]."""


class Found(NamedTuple):
    """Where a search ended.

    Attributes:
        labels: by axis.
        threshold: its end.
        range: in which it searched, low and high.
    """

    labels: Mapping[str, Any]
    threshold: Threshold
    range: tuple[float, float]

    @property
    def shown(self) -> float:
        """The threshold, or the end of the range beyond which it lies."""
        low, high = self.range
        value = self.threshold.value
        return value if value is not None else low if self.threshold.side == "below" else high


class Axis(NamedTuple):
    """An axis of a campaign.

    Attributes:
        name: of its key or its own.
        values: labels of its settings.
    """

    name: str
    values: tuple[Any, ...]

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers that an axis can have."""
        return all(is_number(value) and abs(value) <= MOST for value in self.values)

    @property
    def heading(self) -> str:
        """Name and unit."""
        return with_unit(self.name)


def is_number(value: Any) -> bool:
    """Whether a value is a number, be it NaN or infinite, and no truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def with_unit(key: str) -> str:
    """A key with its unit."""
    unit = key_unit(key)
    return f"{key} [{unit}]" if unit else key


def angle_of(axes: Sequence[Axis]) -> Axis | None:
    """The axis that is a direction: of numbers in rad."""
    return next((axis for axis in axes if axis.numeric and key_unit(axis.name) == "rad"), None)


def is_around(axes: Sequence[Axis]) -> bool:
    """Whether thresholds are drawn around the compass."""
    angle = angle_of(axes)
    return angle is not None and len(angle.values) > 2


def text(value: Any) -> str:
    """A label."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def title(labels: Mapping[str, Any]) -> str:
    """Labels of a panel."""
    return ", ".join(
        text(value) if isinstance(value, str) else f"{name.rpartition('.')[2]} {text(value)}"
        for name, value in labels.items()
    )


def compass(found: Sequence[Found], axes: Sequence[Axis], key: str, limit: Limit) -> Figure:
    """Thresholds around the compass: a panel for each value of the first axes, a curve for each of the last one.

    Args:
        found: every search.
        axes: with more than one value.
        key: that was searched.
        limit: drawn dashed where there is one.
    """
    angle = angle_of(axes)
    assert angle is not None
    others = [axis for axis in axes if axis is not angle]
    panels = _grouped(found, [axis.name for axis in others[:-1]])
    with in_style():
        figure, every = _panels(len(panels), "polar", 5.0, most=2)
        for one, (labels, group) in zip(every, panels.items(), strict=False):
            assert isinstance(one, PolarAxes)
            names = [axis.name for axis in others]
            _rose(one, _grouped(group, [axis.name for axis in others[-1:]]), angle, names, limit)
            one.set_title(title(dict(zip(names, labels, strict=False))) + f"\n{with_unit(key)}", fontsize=9)
        handles, shown = every[0].get_legend_handles_labels()
        figure.legend(handles, shown, loc="outside lower center", ncols=6)
    return figure


def _rose(
    axes: PolarAxes, curves: Mapping[Labels, Sequence[Found]], angle: Axis, names: Sequence[str], limit: Limit
) -> None:
    greatest, bounds = 0.0, []
    ways = sorted(angle.values, key=lambda way: way % (2.0 * math.pi))
    around = np.linspace(0.0, 2.0 * math.pi, 49)
    for color, (labels, group) in zip(CYCLE * len(curves), curves.items(), strict=False):
        shown = {one.labels[angle.name]: one.shown for one in group}
        name = title(dict(zip(names[-1:], labels, strict=False))) or "threshold"
        radii = [shown.get(way, math.nan) for way in (*ways, ways[0])]  # a gap where a search is not done
        axes.plot([*ways, ways[0]], radii, color=color, marker="o", markersize=3.0, label=name)
        beyond = [one for one in group if one.threshold.side != "inside"]
        axes.plot(
            [one.labels[angle.name] for one in beyond], [one.shown for one in beyond], "o", color=color, mfc="white"
        )
        greatest = max(greatest, *shown.values())
        dashed = [limit(group[0].labels, float(way)) for way in around]
        values = np.array([one for one in dashed if one is not None])
        if len(values) == len(around):
            bounds.append(float(values.max()))
            axes.plot(around, values, color=color, linestyle=(0, (4, 2)), linewidth=0.8)
    if bounds:
        axes.plot([], [], color=GREY, linestyle=(0, (4, 2)), linewidth=0.8, label="one-step capturability limit")
    # One limit at least is seen whole; those far beyond all thresholds may leave the figure.
    top = min(1.1 * max(greatest, *bounds), max(1.35 * greatest, 1.1 * min(bounds))) if bounds else 1.1 * greatest
    axes.set_rlim(0.0, top if top > 0.0 else 1.0)
    axes.set_theta_zero_location("N")
    axes.set_xticks([share * math.pi for share in ROUND], list(ROUND.values()))
    axes.set_rlabel_position(22.5)
    axes.spines["polar"].set_visible(True)
    axes.tick_params(pad=1.0)


def along(found: Sequence[Found], axes: Sequence[Axis], key: str) -> Figure:
    """Thresholds along one axis, a curve for each value of the one before, a panel for each of those before that."""
    *others, last = sorted(axes, key=lambda axis: axis.numeric)
    panels = _grouped(found, [axis.name for axis in others[:-1]])
    with in_style():
        figure, every = _panels(len(panels), None, 3.2)
        for one, (labels, group) in zip(every, panels.items(), strict=False):
            curves = _grouped(group, [axis.name for axis in others[-1:]])
            for color, (names, curve) in zip(CYCLE * len(curves), curves.items(), strict=False):
                at = [last.values.index(found.labels[last.name]) for found in curve]
                places = [curve[i].labels[last.name] if last.numeric else at[i] for i in range(len(curve))]
                label = title(dict(zip([axis.name for axis in others[-1:]], names, strict=True)))
                one.plot(places, [found.shown for found in curve], color=color, marker="o", markersize=3.5, label=label)
                beyond = [i for i, found in enumerate(curve) if found.threshold.side != "inside"]
                values = [curve[i].shown for i in beyond]
                one.plot([places[i] for i in beyond], values, "o", color=color, mfc="white", zorder=4)
            _named(one, last, "x", ticks=not last.numeric)
            one.set_title(title(dict(zip([axis.name for axis in others[:-1]], labels, strict=True))), fontsize=8.5)
            one.margins(x=0.05)
            one.set_ylim(bottom=min(0.0, one.get_ylim()[0]))
            if others:
                one.legend(loc="best")
        every[0].set_ylabel(with_unit(key))
    return figure


class Square(NamedTuple):
    """A square of a map: what is written in it, and from 0 to 1 how it is coloured, NaN for grey."""

    text: str
    share: float


def success_map(axes: Sequence[Axis], square: Callable[[Mapping[str, Any]], Square], what: str) -> Figure:
    """A map over the last two axes, with a panel for each value of those before.

    Args:
        axes: with more than one value, at least one.
        square: at some labels.
        what: is shown.
    """
    *others, rows, columns = axes if len(axes) > 1 else (Axis("", ("",)), *axes)
    panels: list[Mapping[str, Any]] = [{}]
    for axis in others:
        panels = [{**panel, axis.name: value} for panel in panels for value in axis.values]
    with in_style():
        figure, every = _panels(len(panels), None, 0.9 + min(0.42 * len(rows.values), 5.0))
        for one, panel in zip(every, panels, strict=False):
            table = [
                [square({**panel, columns.name: right, rows.name: up}) for right in columns.values]
                for up in rows.values
            ]
            _fill(one, table, small=len(columns.values) * len(every) > 24)
            _named(one, columns, "x")
            _named(one, rows, "y")
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


def _named(axes: Axes, axis: Axis, which: str, ticks: bool = True) -> None:
    axes.set(**{f"{which}label": axis.heading})
    if ticks:
        places, labels = range(len(axis.values)), [text(value) for value in axis.values]
        every = -(-len(places) // 12) if which == "x" else 1
        {"x": axes.set_xticks, "y": axes.set_yticks}[which](places[::every], labels[::every])


class Spread(NamedTuple):
    """Values of a quantity of passing and of failing runs, and the bounds that it had to keep."""

    name: str
    passed: Sequence[Any]
    failed: Sequence[Any]
    bounds: Sequence[float] = ()


def distributions(spreads: Sequence[Spread]) -> Figure:
    """A stacked histogram of each quantity."""
    with in_style():
        figure, every = _panels(len(spreads), None, 1.9, most=4)
        for one, spread in zip(every, spreads, strict=True):
            _histogram(one, spread)
        known = {label: handle for one in every for handle, label in zip(*one.get_legend_handles_labels(), strict=True)}
        figure.legend(known.values(), known.keys(), loc="outside upper left", ncols=4)
    return figure


def _histogram(axes: Axes, spread: Spread) -> None:
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
            axes.axvline(bound, color="black", linestyle=(0, (4, 2)), linewidth=0.9)
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
        figure, (one,) = _panels(1, None, 2.6, most=2)
        for place, (passed, judged) in enumerate(counts):
            at = axis.values[place] if axis.numeric else place
            if judged:
                rate = wilson(passed, judged)
                one.plot([at, at], [100 * rate.low, 100 * rate.high], color=GREY, linewidth=2.0)
                one.plot([at], [100 * rate.rate], "o", color=PASS)
        _named(one, axis, "x", ticks=not axis.numeric)
        one.margins(x=0.05)
        one.set_ylim(-4.0, 104.0)
        one.set_ylabel("success [%], 95 % interval")
    return figure


def _panels(count: int, projection: str | None, height: float, most: int = 3) -> tuple[Figure, list[Axes]]:
    """An empty figure of panels of this height [in], at most so many beside each other."""
    count = min(count, MOST_PANELS) if most < 4 else count
    columns = min(count, most)
    rows = -(-count // columns)
    width = WIDTH * (columns / most if columns < most else 1.0)
    figure = Figure(
        figsize=(max(width, 4.2), rows * height + 0.3), layout=ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.06)
    )
    every = list(figure.subplots(rows, columns, squeeze=False, subplot_kw={"projection": projection}).ravel())
    for one in every[count:]:
        one.set_visible(False)
    return figure, every[:count]


def _grouped(found: Sequence[Found], names: Sequence[str]) -> dict[Labels, list[Found]]:
    """Searches by the labels of some axes."""
    groups: dict[Labels, list[Found]] = {}
    for one in found:
        groups.setdefault(tuple(one.labels.get(name) for name in names), []).append(one)
    return groups
