"""Maps of the runs of a campaign that met their criteria, and their rates along an axis."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from surefoot.scenarios.many.points import Point, Record, Runs
from surefoot.scenarios.palette import FAIL, GREY, PASS, paler
from surefoot.scenarios.show.kit.figures import in_style, panels
from surefoot.scenarios.show.kit.html import section
from surefoot.scenarios.show.kit.svg import figure_html
from surefoot.studies.campaigns.spec import MOST_PANELS, Axis, combinations, name_axis, text, title
from surefoot.studies.campaigns.success import judged_of, passed_of, rate_of

if TYPE_CHECKING:
    from surefoot.studies.campaigns.sweep import Swept


class Square(NamedTuple):
    """A square of a map: what is written in it, and from 0 to 1 how it is coloured, NaN for grey."""

    text: str
    share: float


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
    passed = passed_of(judged)
    accepted = sorted({text(point.labels[first]) for point, _ in judged}) if first else []
    return Square("\n".join((f"{passed}/{len(judged)}", *accepted)), passed / len(judged))


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
