"""What one pair of axes shows: positions, jerk, height or the ZMP of several runs over time."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from numpy.typing import NDArray

from scenarios.report.figures.balance import support_bounds
from scenarios.report.figures.decimate import kept
from scenarios.report.figures.style import BLACK, BLUE, COM, GREY, ORANGE, PURPLE, SKY, VERMILLION, ZMP
from scenarios.report.logview import LogView

Array = NDArray[np.float64]

POINTS = 250
"""Stretches into which a curve is thinned: about one per pixel of a panel, of each its extremes."""

SUPPORT = "#F0E442"
_PAPER_JERK = 1.5
"""Bound on the jerk in the paper [m/s³]."""

SEVERAL = (BLUE, SKY, ORANGE, VERMILLION)
"""Colours of runs in the same axes, from the least to the greatest value of what differs."""


def position(axes: Axes, view: LogView, axis: int) -> None:
    """Reference ZMP, measured ZMP, CoM and the bounds of the support along an axis."""
    time, low, high = support_bounds(view, axis)
    axes.fill_between(time, low, high, step="post", color=SUPPORT, alpha=0.35, linewidth=0, zorder=1)
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
    line(axes, view.time("/reference"), planned, BLACK, "its reference", linestyle=(0, (4, 2)), linewidth=0.6)
    axes.set_ylim(planned.min() - 0.05, planned.max() + 0.05)


def zmp_of_several(axes: Axes, views: Sequence[tuple[str, LogView]], axis: int) -> None:
    """True ZMP of several runs in the same axes, with the support and the reference of the longest of them."""
    longest = max((view for _, view in views), key=lambda view: view.end)
    time, low, high = support_bounds(longest, axis)
    axes.fill_between(time, low, high, step="post", color=SUPPORT, alpha=0.3, linewidth=0, zorder=1)
    for (label, view), color in zip(views, SEVERAL, strict=False):
        zmp = view.field("/contact", "zmp", 3)[:, axis]
        line(axes, view.time("/contact"), zmp, color, f"ZMP, {label}", linewidth=0.8)
    reference = _reference(axes, longest, axis)
    margin = 0.06 + 0.08 * np.ptp(reference)
    axes.set_ylim(reference.min() - margin, reference.max() + margin)


def line(axes: Axes, time: Array, values: Array, color: str, label: str, **style: object) -> None:
    """A curve, thinned without losing an extreme; shapes (n,)."""
    rows = kept(values, POINTS)
    axes.plot(time[rows], values[rows], color=color, label=label, **style)  # type: ignore[arg-type]


def support_handle() -> Patch:
    """Entry of a legend for the support."""
    return Patch(facecolor=SUPPORT, edgecolor=GREY, alpha=0.6, linewidth=0.5, label="planned support, bounds")


def _reference(axes: Axes, view: LogView, axis: int) -> Array:
    reference = view.field("/reference", "zmp_reference", 2)[:, axis]
    style = {"linestyle": (0, (4, 2)), "linewidth": 0.7, "zorder": 3}
    line(axes, view.time("/reference"), reference, BLACK, "ZMP reference", **style)
    return reference[np.isfinite(reference)]
