"""The paper's figures, drawn anew from the logs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from surefoot.scenarios.palette import (
    BLACK,
    BLUE,
    COM,
    COM_PLANNED,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    SUPPORT,
    VERMILION,
    ZMP,
    ZMP_PLANNED,
    Color,
)
from surefoot.scenarios.paper import studies
from surefoot.scenarios.paper.grid import Column, Row, Views, grid
from surefoot.scenarios.paper.results import Results
from surefoot.scenarios.paper.studies import STAIRS, WALK, Study, World
from surefoot.scenarios.paper.tables import WORLD_NAMES, error_norms
from surefoot.scenarios.show.figures.motion import support_bounds
from surefoot.scenarios.show.figures.style import canvas, in_style, kept
from surefoot.scenarios.show.logview import LogView

Array = NDArray[np.float64]

POINTS = 250
"""Stretches into which a curve is thinned: about one per pixel of a panel, of each its extremes."""

_PAPER_JERK = 1.5
"""Bound on the jerk in the paper [m/s³]."""

SEVERAL = (BLUE, SKY, ORANGE, VERMILION)
"""Colours of runs in the same axes, from the least to the greatest value of what differs."""


def position(axes: Axes, view: LogView, axis: int) -> None:
    """Reference ZMP, measured ZMP, CoM and the bounds of the support along an axis."""
    time, low, high = support_bounds(view, axis)
    axes.fill_between(time, low, high, step="post", color=SUPPORT, alpha=0.18, linewidth=0, zorder=1)
    for bound in (low, high):
        axes.plot(time, bound, drawstyle="steps-post", color=GREY, linewidth=0.5, zorder=1.5)
    line(axes, view.time("/contact"), view.field("/contact", "zmp", 3)[:, axis], ZMP, "ZMP measured", linewidth=1.3)
    line(axes, view.time("/truth"), view.field("/truth", "com", 3)[:, axis], COM, "CoM", linewidth=1.4)
    reference = _reference(axes, view, axis)
    margin = 0.12 + 0.1 * np.ptp(reference)
    axes.set_ylim(reference.min() - margin, reference.max() + margin)


def jerk(axes: Axes, view: LogView, axis: int) -> None:
    """First jerk of each plan, with the paper's bound."""
    first = np.ascontiguousarray(view.field("/plan", "jerk", -1, 2)[:, 0, axis])
    line(axes, view.time("/plan"), first, PURPLE, "CoM jerk commanded", drawstyle="steps-post", linewidth=0.8)
    for sign in (-1.0, 1.0):
        axes.axhline(sign * _PAPER_JERK, color=BLACK, linewidth=0.6, linestyle=(0, (1, 2)))
    largest = max(1.2 * _PAPER_JERK, float(np.nanmax(np.abs(first))) * 1.1)
    axes.set_ylim(-largest, largest)


def height(axes: Axes, view: LogView) -> None:
    """Height of the CoM."""
    line(axes, view.time("/truth"), view.field("/truth", "com", 3)[:, 2], COM, "CoM height", linewidth=1.4)
    planned = view.field("/reference", "com", 3)[:, 2]
    line(axes, view.time("/reference"), planned, COM_PLANNED, "its reference", linestyle=(0, (4, 2)), linewidth=0.6)
    axes.set_ylim(planned.min() - 0.05, planned.max() + 0.05)


def zmp_of_several(axes: Axes, views: Sequence[tuple[str, LogView]], axis: int) -> None:
    """True ZMP of several runs in the same axes, with the support and the reference of the longest of them."""
    longest = max((view for _, view in views), key=lambda view: view.end)
    time, low, high = support_bounds(longest, axis)
    axes.fill_between(time, low, high, step="post", color=SUPPORT, alpha=0.15, linewidth=0, zorder=1)
    for (label, view), color in zip(views, SEVERAL, strict=False):
        zmp = view.field("/contact", "zmp", 3)[:, axis]
        line(axes, view.time("/contact"), zmp, color, f"ZMP, {label}", linewidth=0.8)
    reference = _reference(axes, longest, axis)
    margin = 0.06 + 0.08 * np.ptp(reference)
    axes.set_ylim(reference.min() - margin, reference.max() + margin)


def line(axes: Axes, time: Array, values: Array, color: Color, label: str, **style: object) -> None:
    """A curve, thinned without losing an extreme; shapes (n,)."""
    rows = kept(values, POINTS)
    axes.plot(time[rows], values[rows], color=color, label=label, **style)  # type: ignore[arg-type]


def _reference(axes: Axes, view: LogView, axis: int) -> Array:
    reference = view.field("/reference", "zmp_reference", 2)[:, axis]
    style = {"linestyle": (0, (4, 2)), "linewidth": 0.7, "zorder": 3}
    line(axes, view.time("/reference"), reference, ZMP_PLANNED, "ZMP reference", **style)
    return reference[np.isfinite(reference)]


RISERS = (0.0, 0.10, 0.15, 0.18)
_SHOWN = {"lti": VERMILION, "preview": PURPLE, "repaired": GREEN, "default": BLUE}


def preview_chart(results: Results) -> Figure:
    """Draw it; a profile without results has no line."""
    with in_style():
        figure, (area,) = canvas(7.0, (2.8,))
        axes = area.subplots()
        for profile, color in _SHOWN.items():
            rows = [(riser, error_norms(results.sample(study, profile, "pendulum")))
                    for riser, study in zip(RISERS, (WALK, *STAIRS), strict=True)]  # fmt: skip
            drawn = [(riser, sorted(values)) for riser, values in rows if values]
            x = [riser for riser, _ in drawn]
            middle = [1e3 * values[len(values) // 2] for _, values in drawn]
            low = [m - 1e3 * values[0] for m, (_, values) in zip(middle, drawn, strict=True)]
            high = [1e3 * values[-1] - m for m, (_, values) in zip(middle, drawn, strict=True)]
            axes.errorbar(x, middle, (low, high), color=color, label=profile, marker="o", markersize=3.5, capsize=2)
        axes.set_xlabel("riser height [m]; 0: flat ground")
        axes.set_ylabel("ZMP error RMS, norm of x and y [mm]")
        axes.set_xlim(-0.01, 0.19)
        axes.set_ylim(bottom=0.0)
        axes.legend(loc="upper left")
    return figure


@dataclass(frozen=True, slots=True)
class Plate:
    """A figure of the page.

    Attributes:
        name: its anchor.
        caption: what it shows.
        draw: draws it.
        half: whether it takes half of the page's width.
    """

    name: str
    caption: str
    draw: Callable[[Results], Figure]
    half: bool = False


def _position(axes: Axes, views: Views, axis: int) -> None:
    position(axes, views[0][1], axis)


def _jerk(axes: Axes, views: Views, axis: int) -> None:
    jerk(axes, views[0][1], axis)


def _height(axes: Axes, views: Views) -> None:
    height(axes, views[0][1])


POSITIONS = tuple(Row(f"{name} [m]", partial(_position, axis=axis), 1.7) for axis, name in enumerate("xy"))
JERKS = tuple(
    Row(f"jerk {name} [m/s³]", partial(_jerk, axis=axis), 1.1, shared=False) for axis, name in enumerate("xy")
)
HEIGHT = Row("CoM z [m]", _height, 1.4)
ZMPS = tuple(Row(f"ZMP {name} [m]", partial(zmp_of_several, axis=axis), 2.0) for axis, name in enumerate("xy"))

Run = tuple[str, World]
SIDE_BY_SIDE: tuple[Run, ...] = (("paper", "cart-table"), ("repaired", "pendulum"), ("default", "full"))
ON_STAIRS: tuple[Run, ...] = (("paper", "cart-table"), ("repaired", "pendulum"), ("default", "pendulum"))


def _study(results: Results, study: Study, runs: tuple[Run, ...], rows: tuple[Row, ...]) -> Figure:
    columns = [
        Column(f"{profile}, {WORLD_NAMES[world]}", (("", results.sample(study, profile, world)),))
        for profile, world in runs
    ]
    return grid(columns, rows)


def _heights(results: Results) -> Figure:
    columns = [
        Column(
            f"{profile}, {WORLD_NAMES[world]}",
            tuple(
                (f"error {studies.with_sign(error)} m", results.sample(study, profile, world))
                for error, study in zip(studies.HEIGHT_ERRORS, studies.HEIGHTS, strict=True)
            ),
        )
        for profile, world in SIDE_BY_SIDE
    ]
    return grid(columns, ZMPS)


def _pushes(results: Results, profile: str, world: World) -> Figure:
    columns = [
        Column(f"{studies.with_sign(force)} N in x and y", (("", results.sample(study, profile, world)),))
        for force, study in zip(studies.PUSH_FORCES, studies.PUSHES, strict=True)
    ]
    return grid(columns, POSITIONS)


PLATES: dict[str, tuple[Plate, ...]] = {
    "diagonal-walk": (
        Plate(
            "figure-walk",
            "Diagonal walk: reference and measured ZMP and CoM in x and y, and the jerk that the planner commands; "
            "dotted, the paper's bound of ±1.5 m/s³. The axes of the paper's figure 2.",
            partial(_study, study=studies.WALK, runs=SIDE_BY_SIDE, rows=(*POSITIONS, *JERKS)),
        ),
    ),
    "stairs": (
        Plate(
            "figure-stairs",
            "Stairs of 0.10 m: CoM height with single and double support shaded, ZMP and CoM in x and y. "
            "The axes of the paper's figure 3.",
            partial(_study, study=studies.STAIRS[0], runs=ON_STAIRS, rows=(HEIGHT, *POSITIONS)),
        ),
        Plate(
            "figure-preview",
            "ZMP error over riser height: norm of the RMS in x and y, median over seeds, with the range over seeds. "
            "lti keeps everything of default but the preview of the changing dynamics.",
            preview_chart,
            half=True,
        ),
    ),
    "noise": (
        Plate(
            "figure-noise-walk",
            "Diagonal walk with noise of ±0.02 m on the measured ZMP and 2 mm on the CoM. "
            "First row of the paper's figure 4.",
            partial(_study, study=studies.NOISE_WALK, runs=SIDE_BY_SIDE, rows=POSITIONS),
        ),
        Plate(
            "figure-noise-stairs",
            "Stairs of 0.10 m with the same noise. Second row of the paper's figure 4.",
            partial(_study, study=studies.NOISE_STAIRS, runs=ON_STAIRS, rows=POSITIONS),
        ),
    ),
    "height-error": (
        Plate(
            "figure-height",
            "True ZMP when the planner's CoM height is wrong by −0.2, −0.1, +0.1 and +0.2 m. The paper's figure 5.",
            _heights,
        ),
    ),
    "pushes": tuple(
        Plate(
            f"figure-push-{profile}",
            f"{profile}, {WORLD_NAMES[world]}: pushes of 10 ms at 2.2 s, with noise. The axes of the paper's figure 6.",
            partial(_pushes, profile=profile, world=world),
        )
        for profile, world in SIDE_BY_SIDE
    ),
}
"""Figures by the section that they stand in."""
