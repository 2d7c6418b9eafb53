"""A figure as a grid of panels: runs side by side, quantities below each other, one axis of time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.palette import GREY, PUSH, SUPPORT
from surefoot.scenarios.paper.results import Sample
from surefoot.scenarios.show.figures.shading import background
from surefoot.scenarios.show.figures.style import canvas, in_style, note
from surefoot.scenarios.show.logview import LogView, MissingError

Views = Sequence[tuple[str, LogView]]

WIDTH = 11.6
"""Of a figure [in]."""

_HEAD = 0.55


@dataclass(frozen=True, slots=True)
class Column:
    """Runs drawn in the same axes, most often one.

    Attributes:
        title: above the column.
        samples: label and sample of each run; the run of the first seed is drawn.
    """

    title: str
    samples: tuple[tuple[str, Sample], ...]


@dataclass(frozen=True, slots=True)
class Row:
    """A quantity.

    Attributes:
        label: of the vertical axis, with unit.
        draw: draws it from the views of a column.
        height: of its panels [in].
        shared: whether its vertical axis is the same for all columns.
    """

    label: str
    draw: Callable[[Axes, Views], None]
    height: float = 1.5
    shared: bool = True


def grid(columns: Sequence[Column], rows: Sequence[Row]) -> Figure:
    """Draw a figure; a run that is missing leaves a note in its column."""
    with in_style():
        figure, (top, area) = canvas(WIDTH, (_HEAD, sum(row.height for row in rows) + 0.5))
        heights = [row.height for row in rows]
        axes = area.subplots(len(rows), len(columns), sharex="col", squeeze=False, height_ratios=heights)
        handles: dict[str, object] = {}
        for number, column in enumerate(columns):
            axes[0, number].set_title(column.title, fontsize=8.5, loc="left")
            handles |= _draw_column(list(axes[:, number]), column, rows)
            axes[-1, number].set_xlabel("time [s]")
        for number, row in enumerate(rows):
            axes[number, 0].set_ylabel(row.label)
            if row.shared:
                _share_y(list(axes[number]))
        area.align_ylabels(axes[:, 0])
        top.legend(handles=list(handles.values()), loc="center left", bbox_to_anchor=(0.01, 0.5), ncols=8)
    return figure


def _draw_column(axes: Sequence[Axes], column: Column, rows: Sequence[Row]) -> dict[str, object]:
    """Draw the panels of a column; returns the entries of its legend by label."""
    try:
        views = [(label, _view(sample)) for label, sample in column.samples]
    except MissingError as missing:
        for one in axes:
            note(one, str(missing))
        return {}
    behind = background(max((view for _, view in views), key=lambda view: view.end))
    behind.shade(axes)
    for one in axes:
        for push in behind.pushes:  # 10 ms of 14 s are less than a pixel
            one.axvline(push.start, color=PUSH, linewidth=1.0, zorder=1.2)
    entries: dict[str, object] = {"planned support, bounds": support_handle()}
    for one, row in zip(axes, rows, strict=True):
        try:
            row.draw(one, views)
        except MissingError as missing:
            note(one, f"not in this log: {missing}")
        found, labels = one.get_legend_handles_labels()
        entries |= dict(zip(labels, found, strict=True))
    axes[-1].set_xlim(0.0, max(view.end for _, view in views))
    return entries | {str(handle.get_label()): handle for handle in behind.handles()}


def _view(sample: Sample) -> LogView:
    """The first run of a sample.

    Raises:
        MissingError: there is none.
    """
    if not sample.outcomes:
        raise MissingError("not run")
    first = sample.outcomes[0]
    if first.failure or first.log is None:
        raise MissingError("could not run")
    try:
        return LogView(read(first.log))
    except LogError:
        raise MissingError("its log cannot be read") from None


def _share_y(axes: Sequence[Axes]) -> None:
    """Give the panels of a row the same limits: those of all that were drawn."""
    drawn = [one for one in axes if one.lines]
    if drawn:
        limits = [one.get_ylim() for one in drawn]
        low, high = min(limit[0] for limit in limits), max(limit[1] for limit in limits)
        for one in axes:
            one.set_ylim(low, high)


def support_handle() -> Patch:
    """Entry of a legend for the support."""
    return Patch(facecolor=SUPPORT, edgecolor=GREY, alpha=0.3, linewidth=0.5, label="planned support, bounds")
