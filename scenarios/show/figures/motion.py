"""Figures of the motion: ZMP, CoM and DCM with their references, the CoM's height, and the feet."""

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from numpy.typing import NDArray

from surefoot.planner.types import GRAVITY
from surefoot.scenarios.palette import (
    BLACK,
    COM,
    COM_PLANNED,
    DCM,
    DCM_PLANNED,
    FEET,
    GREY,
    PURPLE,
    SUPPORT,
    ZMP,
    ZMP_PLANNED,
)
from surefoot.scenarios.record.channels import SUPPORT_VERTICES
from surefoot.scenarios.show.kit.figures import (
    Area,
    curve,
    legend,
    or_say,
    reference_curve,
    steps,
    time_axes,
)
from surefoot.scenarios.show.kit.shading import Background
from surefoot.scenarios.show.logview import FOOT_NAMES, LogView, MissingError

Array = NDArray[np.float64]

BALANCE_TITLE = "Balance seen from the stance foot: ZMP, CoM and DCM with their references"

STRIP, MOST_STRIPS = 12.0, 6
"""Seconds that one strip of the balance shows legibly, and strips after which they become longer."""


def strips(view: LogView) -> tuple[tuple[float, float], ...]:
    """Begin and end of equally long stretches of time that are drawn below each other [s]."""
    count = int(np.clip(np.ceil((view.end - view.start) / STRIP - 1e-9), 1, MOST_STRIPS))
    bounds = np.linspace(view.start, view.end, count + 1).tolist()
    return tuple(pairwise(bounds))


def draw_balance(area: Area, view: LogView, background: Background) -> None:
    """Draw positions, in strips of a few seconds each, then errors over all the time."""
    stretches = strips(view)
    parts = area.subfigures(len(stretches) + 1, 1, squeeze=False, height_ratios=[*[2.6] * len(stretches), 2.9])[:, 0]
    for number, (part, stretch) in enumerate(zip(parts[:-1], stretches, strict=True)):
        axes = time_axes(part, view, BALANCE_TITLE if number == 0 else "", (1.0, 1.0), stretch)
        background.shade(axes)
        for axis, one in enumerate(axes):
            one.set_ylabel(f"{_directions(view)[axis]} [m]")
            with or_say(one):
                draw_support(one, view, axis)
                _positions(one, view, axis)
        if number == 0:
            legend(axes[0], 7, [support_handle()])
    _draw_errors(parts[-1], view, background)


def _draw_errors(area: Area, view: LogView, background: Background) -> None:
    *axes, margin = time_axes(area, view, "", (1.0, 1.0, 1.0))
    background.shade([*axes, margin])
    for axis, one in enumerate(axes):
        one.set_ylabel(f"{_directions(view)[axis]}\nerror [mm]")
        with or_say(one):
            _errors(one, view, axis)
    margin.set_ylabel("capture\nmargin [m]")
    with or_say(margin):
        planned, movable = view.field("/plan", "capture_margin", 2).T
        margin.axhline(0.0, color=GREY, linewidth=0.6)
        reference_curve(
            margin, view.time("/plan"), planned, "DCM inside what is captured, steps as planned", DCM_PLANNED
        )
        curve(margin, view.time("/plan"), movable, "the same, steps moved", DCM, linewidth=1.2)
    legend(axes[0], 3)
    legend(margin, 2)


def _directions(view: LogView) -> tuple[str, str]:
    """Names of the two directions: those of the stance foot, or the world's where a log does not tell of feet."""
    try:
        view.from_stance(np.zeros(1), np.zeros((1, 2)))
    except MissingError:
        return "x", "y"
    return "forward", "left"


def seen(view: LogView, times: Array, points: Array) -> Array:
    """Points from the stance foot, in the world where the log does not tell of feet, shape (n, 2) [m]."""
    try:
        return view.from_stance(times, points)
    except MissingError:
        return points


def support_bounds(view: LogView, axis: int) -> tuple[Array, Array, Array]:
    """Bounds of the planned support in a direction where they change: time [s], least, greatest [m], shape (k,)."""
    clock, vertices = view.time("/reference"), view.field("/reference", "support", SUPPORT_VERTICES, 2)
    corners = np.stack([seen(view, clock, vertices[:, k])[:, axis] for k in range(SUPPORT_VERTICES)], axis=1)
    first = np.flatnonzero(np.isnan(corners[:-1]).any(axis=1))  # of a new stance foot, where curves break; steps do not
    corners[first] = corners[first + 1]
    low, high = corners.min(axis=1), corners.max(axis=1)
    rows = steps(low, high)
    return clock[rows], low[rows], high[rows]


def true_dcm(view: LogView) -> Array:
    """DCM of the true state on the ticks of /truth, with the reference's natural frequency, shape (n, 2) [m]."""
    omega = view.at("/reference", "omega", view.time("/truth"))[:, None]
    return view.field("/truth", "com", 3)[:, :2] + view.field("/truth", "com_velocity", 3)[:, :2] / omega


def draw_support(axes: Axes, view: LogView, axis: int) -> None:
    """Draw the planned support in a direction, with its bounds."""
    time, low, high = support_bounds(view, axis)
    axes.fill_between(time, low, high, step="post", color=SUPPORT, alpha=0.18, linewidth=0, zorder=1)
    for bound in (low, high):
        axes.plot(time, bound, drawstyle="steps-post", color=GREY, linewidth=0.6, zorder=1.5)


def support_handle() -> Patch:
    """Entry of a legend for the support."""
    return Patch(facecolor=SUPPORT, edgecolor=GREY, alpha=0.3, linewidth=0.5, label="planned support, bounds")


def _positions(axes: Axes, view: LogView, axis: int) -> None:
    felt, body, clock = (view.time(topic) for topic in ("/contact", "/truth", "/reference"))
    measured = (
        ("ZMP measured", ZMP, felt, view.field("/contact", "zmp", 3), 1.1),
        ("CoM true", COM, body, view.field("/truth", "com", 3), 1.5),
        ("DCM true", DCM, body, true_dcm(view), 1.5),
    )
    for label, color, time, values, width in measured:
        curve(axes, time, seen(view, time, values[:, :2])[:, axis], label, color, linewidth=width)
    for name, size, label, color in _REFERENCES:
        values = seen(view, clock, view.field("/reference", name, size)[:, :2])[:, axis]
        reference_curve(axes, clock, values, label, color)


def _errors(axes: Axes, view: LogView, axis: int) -> None:
    clock, body, felt = (view.time(topic) for topic in ("/reference", "/truth", "/contact"))
    zmp, com, dcm = (view.field("/reference", name, size)[:, :2] for name, size, *_ in _REFERENCES)
    curves = (
        ("ZMP", ZMP, felt, view.field("/contact", "zmp", 3)[:, :2], zmp),
        ("DCM", DCM, body, true_dcm(view), dcm),
        ("CoM", COM, body, view.field("/truth", "com", 3)[:, :2], com),
    )
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    for name, color, time, values, reference in curves:
        wanted = np.column_stack([np.interp(time, clock, along) for along in reference.T])
        error = 1e3 * (seen(view, time, values) - seen(view, time, wanted))[:, axis]
        curve(axes, time, error, f"{name} minus its reference", color, linewidth=0.9)


_REFERENCES = (
    ("zmp_reference", 2, "ZMP reference (footsteps)", ZMP_PLANNED),
    ("com", 3, "CoM reference", COM_PLANNED),
    ("dcm", 2, "DCM reference", DCM_PLANNED),
)


HEIGHT_TITLE = "CoM height and planned jerk"


def draw_height(area: Area, view: LogView, background: Background) -> None:
    """Draw the height over the ground frame, and the first jerk of each plan."""
    height, jerk = axes = time_axes(area, view, HEIGHT_TITLE, (1.0, 1.0))
    background.shade(axes)
    height.set_ylabel("CoM z [m]")
    jerk.set_ylabel("CoM jerk [m/s³]")
    with or_say(height):
        curve(height, view.time("/truth"), view.field("/truth", "com", 3)[:, 2], "true", COM, linewidth=1.5)
        planned = view.field("/reference", "com", 3)[:, 2]
        reference_curve(height, view.time("/reference"), planned, "reference", COM_PLANNED)
    with or_say(jerk):
        first = view.field("/plan", "jerk", -1, 2)[:, 0]
        for axis, (name, color) in enumerate((("x", PURPLE), ("y", BLACK))):
            values = np.ascontiguousarray(first[:, axis])
            curve(jerk, view.time("/plan"), values, f"jerk {name}", color, drawstyle="steps-post", linewidth=0.9)
    legend(height, 3)
    legend(jerk, 2)


FEET_TITLE = "Feet: sole heights and contact normal forces"


def draw_feet(area: Area, view: LogView, background: Background) -> None:
    """Draw the heights with the swing reference, and the forces with the weight."""
    height, force = axes = time_axes(area, view, FEET_TITLE, (1.0, 1.0))
    background.shade(axes)
    height.set_ylabel("sole z [m]")
    force.set_ylabel("normal force [N]")
    with or_say(height):
        for name, color in zip(FOOT_NAMES, FEET, strict=True):
            pose = view.field("/truth", f"{name}_sole", 7)
            curve(height, view.time("/truth"), pose[:, 2], f"{name} sole", color, linewidth=1.4)
        _swing_reference(height, view)
    with or_say(force):
        forces = view.field("/contact", "normal_force", 2)
        for foot, name in enumerate(FOOT_NAMES):
            curve(force, view.time("/contact"), forces[:, foot], f"{name} foot", FEET[foot])
        _weight(force, view)
    legend(height, 3)
    legend(force, 3)


def _swing_reference(axes: Axes, view: LogView) -> None:
    """The height that the swing foot should have, where one swings."""
    values = view.field("/reference", "swing_position", 3)[:, 2]
    swings = view.field("/reference", "stance") >= 0
    reference_curve(axes, view.time("/reference"), np.where(swings, values, np.nan), "swing reference", BLACK)


def _weight(axes: Axes, view: LogView) -> None:
    try:
        weight = view.number("mass") * GRAVITY
    except MissingError:
        return
    axes.axhline(weight, color=GREY, linewidth=0.8, linestyle="--", label=f"weight {weight:.0f} N")
