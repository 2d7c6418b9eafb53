"""The paper's figures, drawn anew from the logs: runs side by side, quantities below each other."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from surefoot.scenarios import palette
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.show.figures.motion import draw_support, support_handle
from surefoot.scenarios.show.kit import figures as kit
from surefoot.scenarios.show.kit.shading import background
from surefoot.scenarios.show.logview import LogView, MissingError
from surefoot.studies.paper import studies
from surefoot.studies.paper.results import WORLD_NAMES, Results, Sample
from surefoot.studies.paper.studies import STAIRS, WALK, PaperWorld, Study

Views = Sequence[tuple[str, LogView]]

_HEAD = 0.55


@dataclass(frozen=True, slots=True)
class PanelColumn:
    """Runs drawn in the same axes, most often one: a title, and label and sample of each, whose first seed is drawn."""

    title: str
    samples: tuple[tuple[str, Sample], ...]


@dataclass(frozen=True, slots=True)
class PanelRow:
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


def grid(columns: Sequence[PanelColumn], rows: Sequence[PanelRow]) -> Figure:
    """Draw a figure; a run that is missing leaves a note in its column."""
    with kit.in_style():
        figure, (top, area) = kit.canvas(kit.PAGE_WIDTH, (_HEAD, sum(row.height for row in rows) + 0.5))
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


def _draw_column(axes: Sequence[Axes], column: PanelColumn, rows: Sequence[PanelRow]) -> dict[str, object]:
    """Draw the panels of a column; returns the entries of its legend by label."""
    try:
        views = [(label, _view(sample)) for label, sample in column.samples]
    except MissingError as missing:
        for one in axes:
            kit.note(one, str(missing))
        return {}
    behind = background(max((view for _, view in views), key=lambda view: view.end))
    behind.shade(axes)
    entries: dict[str, object] = {"planned support, bounds": support_handle()}
    for one, row in zip(axes, rows, strict=True):
        for push in behind.pushes:  # 10 ms of 14 s are less than a pixel
            one.axvline(push.start, color=palette.PUSH, linewidth=1.0, zorder=1.2)
        with kit.or_say(one):
            row.draw(one, views)
        found, labels = one.get_legend_handles_labels()
        entries |= dict(zip(labels, found, strict=True))
    axes[-1].set_xlim(0.0, max(view.end for _, view in views))
    return entries | {str(handle.get_label()): handle for handle in behind.handles()}


def _view(sample: Sample) -> LogView:
    """The first run of a sample; MissingError where there is none."""
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


POINTS = 250
"""Stretches into which a curve is thinned: about one per pixel of a panel, of each its extremes."""

_PAPER_JERK = 1.5
"""Bound on the jerk in the paper [m/s³]."""

SEVERAL = (palette.BLUE, palette.SKY, palette.ORANGE, palette.VERMILION)
"""Colours of runs in the same axes, from the least to the greatest value of what differs."""


def position(axes: Axes, views: Views, axis: int) -> None:
    """Reference ZMP, measured ZMP, CoM and the bounds of the support along an axis."""
    ((_, view),) = views
    draw_support(axes, view, axis)
    _along(axes, view, ("/contact", "zmp"), axis, "ZMP measured", palette.ZMP, linewidth=1.3)
    _along(axes, view, ("/truth", "com"), axis, "CoM", palette.COM, linewidth=1.4)
    _around_reference(axes, view, axis, 0.12, 0.1)


def zmp_of_several(axes: Axes, views: Views, axis: int) -> None:
    """True ZMP of several runs in the same axes, with the support and the reference of the longest of them."""
    longest = max((view for _, view in views), key=lambda view: view.end)
    draw_support(axes, longest, axis)
    for (label, view), color in zip(views, SEVERAL, strict=False):
        _along(axes, view, ("/contact", "zmp"), axis, f"ZMP, {label}", color, linewidth=0.8)
    _around_reference(axes, longest, axis, 0.06, 0.08)


def _along(
    axes: Axes, view: LogView, field: tuple[str, str], axis: int, label: str, color: palette.Color, **style: Any
) -> None:
    """Draw an axis of a field of three, given by its topic and its name."""
    kit.curve(axes, view.time(field[0]), view.field(*field, 3)[:, axis], label, color, POINTS, **style)


def _around_reference(axes: Axes, view: LogView, axis: int, room: float, share: float) -> None:
    """Draw the reference of the ZMP, and leave some room around it, and a share of its range [m]."""
    reference = view.field("/reference", "zmp_reference", 2)[:, axis]
    kit.reference_curve(axes, view.time("/reference"), reference, "ZMP reference", palette.ZMP_PLANNED, POINTS)
    reference = reference[np.isfinite(reference)]
    margin = room + share * np.ptp(reference)
    axes.set_ylim(reference.min() - margin, reference.max() + margin)


def jerk(axes: Axes, views: Views, axis: int) -> None:
    """First jerk of each plan, with the paper's bound."""
    ((_, view),) = views
    first = np.ascontiguousarray(view.field("/plan", "jerk", -1, 2)[:, 0, axis])
    kit.curve(
        axes,
        view.time("/plan"),
        first,
        "CoM jerk commanded",
        palette.PURPLE,
        POINTS,
        drawstyle="steps-post",
        linewidth=0.8,
    )
    for sign in (-1.0, 1.0):
        axes.axhline(sign * _PAPER_JERK, color=palette.BLACK, linewidth=0.6, linestyle=(0, (1, 2)))
    largest = max(1.2 * _PAPER_JERK, float(np.nanmax(np.abs(first))) * 1.1)
    axes.set_ylim(-largest, largest)


def height(axes: Axes, views: Views) -> None:
    """Height of the CoM."""
    ((_, view),) = views
    _along(axes, view, ("/truth", "com"), 2, "CoM height", palette.COM, linewidth=1.4)
    _along(
        axes, view, ("/reference", "com"), 2, "its reference", palette.COM_PLANNED, linestyle=kit.DASHED, linewidth=0.6
    )
    planned = view.field("/reference", "com", 3)[:, 2]
    axes.set_ylim(planned.min() - 0.05, planned.max() + 0.05)


RISERS = (0.0, 0.10, 0.15, 0.18)
_SHOWN = {"lti": palette.VERMILION, "preview": palette.PURPLE, "repaired": palette.GREEN, "default": palette.BLUE}


def preview_chart(results: Results) -> Figure:
    """Draw it; a profile without results has no line."""
    with kit.in_style():
        figure, (area,) = kit.canvas(7.0, (2.8,))
        axes = area.subplots()
        for profile, color in _SHOWN.items():
            samples = zip(RISERS, (results.sample(study, profile) for study in (WALK, *STAIRS)), strict=True)
            drawn = [
                (riser, [1e3 * norm for norm in sorted(norms)]) for riser, one in samples if (norms := one.error_norms)
            ]
            x, middle = [riser for riser, _ in drawn], [values[len(values) // 2] for _, values in drawn]
            low = [m - values[0] for m, (_, values) in zip(middle, drawn, strict=True)]
            high = [values[-1] - m for m, (_, values) in zip(middle, drawn, strict=True)]
            axes.errorbar(x, middle, (low, high), color=color, label=profile, marker="o", markersize=3.5, capsize=2)
        axes.set_xlabel("riser height [m]; 0: flat ground")
        axes.set_ylabel("ZMP error RMS, norm of x and y [mm]")
        axes.set_xlim(-0.01, 0.19)
        axes.set_ylim(bottom=0.0)
        axes.legend(loc="upper left")
    return figure


POSITIONS = tuple(PanelRow(f"{name} [m]", partial(position, axis=axis), 1.7) for axis, name in enumerate("xy"))
JERKS = tuple(
    PanelRow(f"jerk {name} [m/s³]", partial(jerk, axis=axis), 1.1, shared=False) for axis, name in enumerate("xy")
)
HEIGHT = PanelRow("CoM z [m]", height, 1.4)
ZMPS = tuple(PanelRow(f"ZMP {name} [m]", partial(zmp_of_several, axis=axis), 2.0) for axis, name in enumerate("xy"))

Run = tuple[str, PaperWorld]
SIDE_BY_SIDE: tuple[Run, ...] = (("paper", "cart-table"), ("repaired", "pendulum"), ("default", "full"))
ON_STAIRS: tuple[Run, ...] = (("paper", "cart-table"), ("repaired", "pendulum"), ("default", "pendulum"))


def _runs(results: Results, study: Study, runs: tuple[Run, ...], rows: tuple[PanelRow, ...]) -> Figure:
    """A study, a column for each run."""
    return grid([PanelColumn(_called(run), (("", results.sample(study, *run)),)) for run in runs], rows)


def _heights(results: Results) -> Figure:
    errors = [f"error {studies.with_sign(error)} m" for error in studies.HEIGHT_ERRORS]
    columns = [
        PanelColumn(
            _called(run), tuple(zip(errors, (results.sample(study, *run) for study in studies.HEIGHTS), strict=True))
        )
        for run in SIDE_BY_SIDE
    ]
    return grid(columns, ZMPS)


def _called(run: Run) -> str:
    return f"{run[0]}, {WORLD_NAMES[run[1]]}"


def _pushes(results: Results, run: Run) -> Figure:
    columns = [
        PanelColumn(f"{studies.with_sign(force)} N in x and y", (("", results.sample(study, *run)),))
        for force, study in zip(studies.PUSH_FORCES, studies.PUSHES, strict=True)
    ]
    return grid(columns, POSITIONS)


PLATES: Mapping[str, Callable[[Results], Figure]] = {
    "figure-walk": partial(_runs, study=WALK, runs=SIDE_BY_SIDE, rows=(*POSITIONS, *JERKS)),
    "figure-stairs": partial(_runs, study=STAIRS[0], runs=ON_STAIRS, rows=(HEIGHT, *POSITIONS)),
    "figure-preview": preview_chart,
    "figure-noise-walk": partial(_runs, study=studies.NOISE_WALK, runs=SIDE_BY_SIDE, rows=POSITIONS),
    "figure-noise-stairs": partial(_runs, study=studies.NOISE_STAIRS, runs=ON_STAIRS, rows=POSITIONS),
    "figure-height": _heights,
    **{f"figure-push-{run[0]}": partial(_pushes, run=run) for run in SIDE_BY_SIDE},
}
"""Functions that draw each figure, by its anchor; `sections.yaml` has its place and its text."""
