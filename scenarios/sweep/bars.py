"""Thresholds among named settings as bars, beside their limit and what others have published."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from surefoot.scenarios.palette import BLACK, BLUE, VERMILION, Color, paler
from surefoot.scenarios.show.figures.style import in_style
from surefoot.scenarios.sweep.figures import WIDTH, Axis, Found, text, title, with_unit
from surefoot.scenarios.sweep.spec import Published

Limit = Callable[[Mapping[str, Any]], float | None]
"""Gives the limit of a search by its labels."""

MOST_COLUMNS, ROW = 4, 2.3
"""Panels beside each other, and the height of one [in]."""
SHARE = 0.84
"""Of the way from group to group that bars fill."""
MARKS = "D^svPX"
LIMIT_NAME = "one-step capturability limit"


def are_named(axes: Sequence[Axis]) -> bool:
    """Whether thresholds are drawn as bars: no axis is of numbers."""
    return len(axes) > 1 and not any(axis.numeric for axis in axes)


def bars(
    found: Sequence[Found], axes: Sequence[Axis], key: str, limit: Limit, records: Sequence[Published] = ()
) -> Figure:
    """Thresholds as bars: groups by the last axis, shades by the one before it, a panel for each of those before.

    Args:
        found: every search that came to its end.
        axes: all of them, two or more.
        key: that was searched.
        limit: drawn across its bar where there is one.
        records: published values, drawn at the group that they are of, or across all groups.
    """
    *others, shades, groups = axes
    panels: list[dict[str, Any]] = [{}]
    for axis in others:
        panels = [{**panel, axis.name: value} for panel in panels for value in axis.values]
    panels = [panel for panel in panels if any(_is_of(one.labels, panel) for one in found)]
    columns = max(1, min(len(others[-1].values) if others else 1, MOST_COLUMNS))
    rows = -(-len(panels) // columns)
    marks = dict(zip(dict.fromkeys(record.name for record in records), MARKS * len(records), strict=False))
    with in_style():
        layout = ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.06)
        figure = Figure(figsize=(max(WIDTH * columns / MOST_COLUMNS, 4.2), ROW * rows + 0.4), layout=layout)
        every = list(figure.subplots(rows, columns, squeeze=False).ravel())
        for one, panel in zip(every, panels, strict=False):
            searches = [search for search in found if _is_of(search.labels, panel)]
            shown = [record for record in records if _is_of(panel, record.at, partly=True)]
            top = 1.06 * max([search.shown for search in searches] + [record.value for record in shown]) or 1.0
            _limits(one, top, [(_place(search, shades, groups), limit(search.labels)) for search in searches], shades)
            _searches(one, searches, shades, groups)
            _published(one, shown, groups, marks)
            one.set_title(title(panel), fontsize=8.5)
        for one in every[len(panels) :]:
            one.set_visible(False)
        for one in every[::columns]:
            one.set_ylabel(with_unit(key))
        figure.legend(
            handles=_handles(every[: len(panels)], shades, marks), loc="outside lower center", ncols=2 * columns
        )
    return figure


def _is_of(labels: Mapping[str, Any], panel: Mapping[str, Any], partly: bool = False) -> bool:
    """Whether labels are those of a panel; partly where what they do not name does not matter."""
    return all(str(labels.get(name, value if partly else None)) == str(value) for name, value in panel.items())


def _shade(axis: Axis, value: Any) -> Color:
    """The later a value, the darker."""
    return paler(BLUE, 0.8 * (1.0 - (axis.values.index(value) + 1) / len(axis.values)))


def _width(shades: Axis) -> float:
    return SHARE / len(shades.values)


def _place(one: Found, shades: Axis, groups: Axis) -> float:
    """Of the middle of a bar."""
    shade = shades.values.index(one.labels[shades.name])
    group = groups.values.index(one.labels[groups.name])
    return float(group + _width(shades) * (shade - 0.5 * (len(shades.values) - 1)))


def _searches(axes: Axes, found: Sequence[Found], shades: Axis, groups: Axis) -> None:
    for one in found:
        color = _shade(shades, one.labels[shades.name])
        face: Any = color if one.threshold.side == "inside" else "white"
        width = 0.92 * _width(shades)
        axes.bar([_place(one, shades, groups)], [one.shown], width, facecolor=face, edgecolor=color, linewidth=0.8)
    axes.set_xticks(range(len(groups.values)), [text(value) for value in groups.values])
    axes.set_xlim(-0.5, len(groups.values) - 0.5)
    axes.grid(visible=False, axis="x")


def _limits(axes: Axes, top: float, limits: Sequence[tuple[float, float | None]], shades: Axis) -> None:
    """Draw limits across their bars, and let the axes end where all else does, or at limits that are not far above.

    One that is far beyond is told at the upper edge.
    """
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


def _published(axes: Axes, records: Sequence[Published], groups: Axis, marks: Mapping[str, str]) -> None:
    for record in records:
        style: dict[str, Any] = {"color": VERMILION, "label": record.name, "zorder": 5}
        group = record.at.get(groups.name)
        if group is None:
            axes.axhline(record.value, linestyle=(0, (4, 2)), linewidth=0.9, **style)
        elif group in groups.values:
            aside = 0.12 * (list(marks).index(record.name) - 0.5 * (len(marks) - 1))
            at = [groups.values.index(group) + aside]
            axes.plot(at, [record.value], marks[record.name], markersize=5.5, mec="white", mew=0.6, **style)


def _handles(every: Sequence[Axes], shades: Axis, marks: Mapping[str, str]) -> list[Any]:
    """What the legend shows, of what is drawn."""
    drawn = {str(line.get_label()): line for one in every for line in one.lines}
    handles: list[Any] = [Patch(color=_shade(shades, value), label=text(value)) for value in shades.values]
    if LIMIT_NAME in drawn:
        handles.append(Line2D([], [], color=BLACK, linewidth=1.1, label=LIMIT_NAME))
    return handles + [drawn[name] for name in marks if name in drawn]
