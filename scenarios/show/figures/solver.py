"""What the solvers did, and the wall-clock time of each part of a tick."""

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from surefoot.scenarios.palette import BLACK, BLUE, GREY, VERMILION
from surefoot.scenarios.show.figures.shading import Background
from surefoot.scenarios.show.figures.style import CYCLE, Area, curve, legend, or_say, time_axes
from surefoot.scenarios.show.logview import LogView, MissingError

Array = NDArray[np.float64]

TITLE = "Solvers and wall-clock times"
_EVENTS = (
    ("/plan", "status", "planner QP unsolved"),
    ("/plan", "held", "plan held"),
    ("/wbc", "solver", "WBC second solver"),
    ("/wbc", "fallback", "WBC fallback"),
)
_PARTS = ("tick", "planner", "physics", "wbc_build", "wbc_solve", "state", "log")
_STRETCHES = 150
"""Stretches of time of which the median and the greatest are drawn."""


def draw(area: Area, view: LogView, background: Background) -> None:
    """Draw iterations, what went wrong and when, and the time of each part."""
    iterations, events, timing = axes = time_axes(area, view, TITLE, (0.7, 0.9, 1.6))
    background.shade(axes)
    iterations.set_ylabel("iterations [-]")
    timing.set_ylabel("time per tick [µs]")
    with or_say(iterations):
        curve(iterations, view.time("/wbc"), view.field("/wbc", "iterations"), "WBC QP", BLUE, linewidth=0.7)
        iterations.set_ylim(bottom=0)
    _events(events, view)
    with or_say(timing):
        _timing(timing, view)
    legend(iterations, 1)
    legend(timing, 4)


def stretch_extremes(time: Array, values: Array, count: int = _STRETCHES) -> tuple[Array, Array, Array]:
    """Middle time, median and greatest value of stretches of equally many positive samples, shape (k,) each."""
    positive = np.flatnonzero(values > 0)
    parts = [part for part in np.array_split(positive, min(count, max(len(positive), 1))) if len(part)]
    middle = np.array([time[part].mean() for part in parts])
    return middle, np.array([np.median(values[part]) for part in parts]), np.array([values[p].max() for p in parts])


def _events(axes: Axes, view: LogView) -> None:
    """A row of marks for each thing that can go wrong; its count stands beside it."""
    axes.set_ylim(len(_EVENTS) - 0.5, -0.5)
    axes.grid(visible=False, axis="y")
    names = []
    for row, (topic, field, label) in enumerate(_EVENTS):
        try:
            times = view.time(topic)[view.field(topic, field) != 0]
            names.append(f"{label}: {len(times)}")
            axes.plot(times, np.full(len(times), row), "|", color=VERMILION, markersize=7)
        except MissingError:
            names.append(f"{label}: not logged")
    axes.set_yticks(range(len(_EVENTS)), names, fontsize=6.5)
    axes.axhspan(-0.5, len(_EVENTS) - 0.5, facecolor="none", edgecolor=GREY, linewidth=0.4)


def _planned(view: LogView, time: Array) -> NDArray[np.bool_]:
    """Ticks with a new plan, as far as the log tells; the others only sample the last one."""
    try:
        return np.isin(time, view.time("/plan"))
    except MissingError:
        return np.ones(len(time), dtype=np.bool_)


def _timing(axes: Axes, view: LogView) -> None:
    axes.set_yscale("log")
    time = view.time("/timing")
    for number, part in enumerate(_PARTS):
        values = view.field("/timing", part)
        if part == "planner":
            values = np.where(_planned(view, time), values, 0.0)
        middle, median, greatest = stretch_extremes(time, values)
        if not len(middle):
            continue
        color = CYCLE[(number + 5) % len(CYCLE)]
        name = part.replace("_", " ").replace("wbc", "WBC")
        name = "new plan" if part == "planner" else name
        label = f"{name}: median {np.median(values[values > 0]):.0f} µs"
        axes.plot(middle, median, color=color, label=label, linewidth=1.3 if part == "tick" else 1.0)
        if part == "tick":
            axes.plot(middle, greatest, ".", color=GREY, markersize=2.5, label="tick: greatest of each stretch")
    try:
        period = 1e6 / view.number("control_rate")
    except MissingError:
        return
    axes.axhline(period, color=BLACK, linestyle="--", linewidth=0.9, label=f"control period {period:.0f} µs")
