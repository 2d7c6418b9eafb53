"""Two runs in the same axes: ZMP and CoM in x and y, and the CoM's height."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from surefoot.scenarios.palette import BLACK, BLUE, VERMILION, Color
from surefoot.scenarios.show.figures.style import canvas, curve, in_style, legend, or_say, time_axes
from surefoot.scenarios.show.logview import LogView, MissingError

_CURVES = (
    ("ZMP x [m]", "/contact", "zmp", 0),
    ("ZMP y [m]", "/contact", "zmp", 1),
    ("CoM x [m]", "/truth", "com", 0),
    ("CoM y [m]", "/truth", "com", 1),
    ("CoM z [m]", "/truth", "com", 2),
)
_WIDTH, _HEIGHTS = 11.7, (0.5, 9.5)


def overlay(a: LogView, b: LogView, header: str, divergence: float | None) -> Figure:
    """Draw both runs on one page.

    Args:
        a: first run.
        b: second run.
        header: says which they are.
        divergence: time at which they part [s], None when they do not.
    """
    with in_style():
        figure, (top, area) = canvas(_WIDTH, _HEIGHTS)
        top.text(0.01, 0.9, header, ha="left", va="top", fontsize=9, linespacing=1.4)
        axes = time_axes(area, a, "Measured ZMP and true CoM of both runs", (1.0,) * len(_CURVES))
        axes[-1].set_xlim(min(a.start, b.start), max(a.end, b.end, a.start + 1e-3))
        for one, (label, topic, name, axis) in zip(axes, _CURVES, strict=True):
            one.set_ylabel(label)
            with or_say(one):
                _both(one, (a, b), topic, name, axis)
            if divergence is not None:
                one.axvline(divergence, color=BLACK, linewidth=0.8, linestyle=":", label="first divergence")
        legend(axes[0])
    return figure


def _both(axes: Axes, views: tuple[LogView, LogView], topic: str, name: str, axis: int) -> None:
    """Draw a channel of both runs; one that has not got it is left out, and named when neither has."""
    styles: tuple[tuple[str, Color, dict[str, Any]], ...] = (
        ("A", BLUE, {"linewidth": 1.8}),
        ("B", VERMILION, {"linewidth": 1.0, "linestyle": (0, (4, 2))}),
    )
    missing = []
    for view, (label, color, style) in zip(views, styles, strict=True):
        try:
            curve(axes, view.time(topic), view.field(topic, name, 3)[:, axis], label, color, **style)
        except MissingError as absent:
            missing.append(absent)
    if len(missing) == len(views):
        raise missing[0]
