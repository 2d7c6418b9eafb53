"""Figures of thresholds: around the compass, along an axis, or as bars beside published values."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.projections.polar import PolarAxes

from surefoot.scenarios.many.points import Threshold
from surefoot.scenarios.palette import BLACK, BLUE, GREY, VERMILION, Color, paler
from surefoot.scenarios.show.kit.figures import CYCLE, DASHED, PAGE_WIDTH, in_style, panels
from surefoot.studies.campaigns.spec import (
    MOST_PANELS,
    Axis,
    Published,
    angle_of,
    combinations,
    name_axis,
    text,
    title,
    with_unit,
)

ROUND = {0.0: "forward", 0.25: "", 0.5: "left", 0.75: "", 1.0: "backward", 1.25: "", 1.5: "right", 1.75: ""}
"""Names of directions, by their angle from the world's x axis [pi rad]."""
LIMIT_NAME = "one-step capturability limit"
MOST_COLUMNS, ROW = 4, 2.3
"""Panels of bars beside each other, and the height of one [in]."""
SHARE = 0.84
"""Share of the way from group to group that bars fill."""
MARKS = "D^svPX"

LimitOf = Callable[[Mapping[str, Any], float | None], float | None]
"""Gives the limit of a search by its labels, in a direction [rad], or in its own."""


class Found(NamedTuple):
    """The end of a search of some labels, by axis, in its range, low and high."""

    labels: Mapping[str, Any]
    threshold: Threshold
    range: tuple[float, float]

    @property
    def shown(self) -> float:
        """The threshold, or the end of the range beyond which it lies."""
        low, high = self.range
        value = self.threshold.value
        return value if value is not None else low if self.threshold.side == "below" else high

    @property
    def beyond(self) -> bool:
        """True if it lies beyond an end of the range, so that its mark is hollow."""
        return self.threshold.side != "inside"


def compass(found: Sequence[Found], axes: Sequence[Axis], key: str, limit: LimitOf) -> Figure:
    """Thresholds by direction: panels by the first axes, a curve for each value of the last one, limits dashed."""
    angle = angle_of(axes)
    assert angle is not None
    others = [axis for axis in axes if axis is not angle]
    groups = _grouped(found, others[:-1])
    with in_style():
        figure, every = panels(min(len(groups), MOST_PANELS), 2, 5.0, "polar")
        for one, (name, group) in zip(every, groups, strict=False):
            assert isinstance(one, PolarAxes)
            _rose(one, _grouped(group, others[-1:]), angle, limit)
            one.set_title(f"{name}\n{with_unit(key)}", fontsize=9)
        handles, shown = every[0].get_legend_handles_labels()
        figure.legend(handles, shown, loc="outside lower center", ncols=6)
    return figure


def _rose(axes: PolarAxes, curves: Sequence[tuple[str, Sequence[Found]]], angle: Axis, limit: LimitOf) -> None:
    greatest, bounds = 0.0, []
    ways = sorted(angle.values, key=lambda way: way % (2.0 * math.pi))
    around = np.linspace(0.0, 2.0 * math.pi, 49)
    for color, (name, group) in zip(CYCLE * len(curves), curves, strict=False):
        shown = {one.labels[angle.name]: one.shown for one in group}
        radii = [shown.get(way, math.nan) for way in (*ways, ways[0])]  # a gap where a search is not done
        axes.plot([*ways, ways[0]], radii, color=color, marker="o", markersize=3.0, label=name or "threshold")
        beyond = [one for one in group if one.beyond]
        at, values = [one.labels[angle.name] for one in beyond], [one.shown for one in beyond]
        axes.plot(at, values, "o", color=color, mfc="white")
        greatest = max(greatest, *shown.values())
        dashed = [limit(group[0].labels, float(way)) for way in around]
        known = np.array([one for one in dashed if one is not None])
        if len(known) == len(around):
            bounds.append(float(known.max()))
            axes.plot(around, known, color=color, linestyle=DASHED, linewidth=0.8)
    if bounds:
        axes.plot([], [], color=GREY, linestyle=DASHED, linewidth=0.8, label=LIMIT_NAME)
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
    groups = _grouped(found, others[:-1])
    with in_style():
        figure, every = panels(min(len(groups), MOST_PANELS), 3, 3.2)
        for one, (name, group) in zip(every, groups, strict=False):
            curves = _grouped(group, others[-1:])
            for color, (called, curve) in zip(CYCLE * len(curves), curves, strict=False):
                labels = [search.labels[last.name] for search in curve]
                places = labels if last.numeric else [last.values.index(label) for label in labels]
                style: dict[str, Any] = {"color": color, "marker": "o"}
                one.plot(places, [search.shown for search in curve], markersize=3.5, label=called, **style)
                beyond = [(at, search.shown) for at, search in zip(places, curve, strict=True) if search.beyond]
                one.plot(
                    *zip(*beyond, strict=True) if beyond else ((), ()), linewidth=0, mfc="white", zorder=4, **style
                )
            name_axis(one, last, "x", ticks=not last.numeric)
            one.set_title(name, fontsize=8.5)
            one.margins(x=0.05)
            one.set_ylim(bottom=min(0.0, one.get_ylim()[0]))
            if others:
                one.legend(loc="best")
        every[0].set_ylabel(with_unit(key))
    return figure


def _grouped(found: Sequence[Found], axes: Sequence[Axis]) -> list[tuple[str, list[Found]]]:
    """Searches by their labels of some axes, each group with its title."""
    groups: dict[str, tuple[str, list[Found]]] = {}
    for one in found:
        labels = {axis.name: one.labels.get(axis.name) for axis in axes}
        groups.setdefault(str(labels), (title(labels), []))[1].append(one)
    return list(groups.values())


def are_named(axes: Sequence[Axis]) -> bool:
    """Return true if thresholds are drawn as bars: no axis is of numbers."""
    return len(axes) > 1 and not any(axis.numeric for axis in axes)


def bars(
    found: Sequence[Found], axes: Sequence[Axis], key: str, limit: LimitOf, records: Sequence[Published] = ()
) -> Figure:
    """Thresholds as bars: groups by the last axis, shades by the one before it, a panel for each of those before."""
    *others, shades, groups = axes
    every = [labels for labels in combinations(others) if any(_is_of(one.labels, labels) for one in found)]
    columns = max(1, min(len(others[-1].values) if others else 1, MOST_COLUMNS))
    marks = dict(zip(dict.fromkeys(record.name for record in records), MARKS * len(records), strict=False))
    with in_style():
        figure, drawn = panels(len(every), columns, ROW, width=PAGE_WIDTH * columns / MOST_COLUMNS)
        for one, labels in zip(drawn, every, strict=True):
            searches = [search for search in found if _is_of(search.labels, labels)]
            shown = [record for record in records if _is_of(labels, record.at, partly=True)]
            top = 1.06 * max([search.shown for search in searches] + [record.value for record in shown]) or 1.0
            limits = [(_place(search, shades, groups), limit(search.labels, None)) for search in searches]
            _draw_limits(one, top, limits, shades)
            _draw_searches(one, searches, shades, groups)
            _draw_published(one, shown, groups, marks)
            one.set_title(title(labels), fontsize=8.5)
        for one in drawn[::columns]:
            one.set_ylabel(with_unit(key))
        figure.legend(handles=_handles(drawn, shades, marks), loc="outside lower center", ncols=2 * columns)
    return figure


def _is_of(labels: Mapping[str, Any], panel: Mapping[str, Any], partly: bool = False) -> bool:
    """Return true if labels are those of a panel; partly where what they do not name does not matter."""
    return all(str(labels.get(name, value if partly else None)) == str(value) for name, value in panel.items())


def _shade(axis: Axis, value: Any) -> Color:
    """The later a value, the darker."""
    return paler(BLUE, 0.8 * (1.0 - (axis.values.index(value) + 1) / len(axis.values)))


def _width(shades: Axis) -> float:
    return SHARE / len(shades.values)


def _place(one: Found, shades: Axis, groups: Axis) -> float:
    """Middle of a bar."""
    shade = shades.values.index(one.labels[shades.name])
    group = groups.values.index(one.labels[groups.name])
    return float(group + _width(shades) * (shade - 0.5 * (len(shades.values) - 1)))


def _draw_searches(axes: Axes, found: Sequence[Found], shades: Axis, groups: Axis) -> None:
    for one in found:
        color = _shade(shades, one.labels[shades.name])
        face: Any = "white" if one.beyond else color
        width = 0.92 * _width(shades)
        axes.bar([_place(one, shades, groups)], [one.shown], width, facecolor=face, edgecolor=color, linewidth=0.8)
    axes.set_xticks(range(len(groups.values)), [text(value) for value in groups.values])
    axes.set_xlim(-0.5, len(groups.values) - 0.5)
    axes.grid(visible=False, axis="x")


def _draw_limits(axes: Axes, top: float, limits: Sequence[tuple[float, float | None]], shades: Axis) -> None:
    """Draw limits across their bars, in axes that end with all else or not far above; those beyond are written."""
    known = [(at, most) for at, most in limits if most is not None]
    top = max([top, *(1.06 * most for _, most in known if most <= 1.5 * top)])
    beyond = [(at, most) for at, most in known if most > top]
    axes.set_ylim(0.0, top * (1.15 if beyond else 1.0))
    half = 0.46 * _width(shades)
    for at, most in known:
        if most <= top:
            axes.plot([at - half, at + half], [most, most], color=BLACK, linewidth=1.1, label=LIMIT_NAME)
    for at, most in beyond:
        axes.text(at, 1.14 * top, f"{most:.2g} →", rotation=90, fontsize=6, ha="center", va="top")


def _draw_published(axes: Axes, records: Sequence[Published], groups: Axis, marks: Mapping[str, str]) -> None:
    for record in records:
        style: dict[str, Any] = {"color": VERMILION, "label": record.name, "zorder": 5}
        group = record.at.get(groups.name)
        if group is None:
            axes.axhline(record.value, linestyle=DASHED, linewidth=0.9, **style)
        elif group in groups.values:
            aside = 0.12 * (list(marks).index(record.name) - 0.5 * (len(marks) - 1))
            at = [groups.values.index(group) + aside]
            axes.plot(at, [record.value], marks[record.name], markersize=5.5, mec="white", mew=0.6, **style)


def _handles(every: Sequence[Axes], shades: Axis, marks: Mapping[str, str]) -> list[Any]:
    """Handles of the legend, of what is drawn."""
    drawn = {str(line.get_label()): line for one in every for line in one.lines}
    handles: list[Any] = [Patch(color=_shade(shades, value), label=text(value)) for value in shades.values]
    if LIMIT_NAME in drawn:
        handles.append(Line2D([], [], color=BLACK, linewidth=1.1, label=LIMIT_NAME))
    return handles + [drawn[name] for name in marks if name in drawn]
