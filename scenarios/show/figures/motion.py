"""Figures of the motion: ZMP, CoM and DCM with their references, the CoM's height, and the feet."""

from functools import partial
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from numpy.typing import NDArray

from surefoot.planner.model.dcm import dcm
from surefoot.planner.types import GRAVITY
from surefoot.scenarios import palette
from surefoot.scenarios.record.channels import SUPPORT_VERTICES
from surefoot.scenarios.show.kit.figures import Area, curve, reference_curve, steps
from surefoot.scenarios.show.kit.shading import Background, Panel, draw_panels
from surefoot.scenarios.show.logview import FOOT_NAMES, LogView, MissingError

Array = NDArray[np.float64]

BALANCE_TITLE = "Balance seen from the stance foot: ZMP, CoM and DCM with their references"

STRIP, MOST_STRIPS = 12.0, 6
"""Seconds that one strip of the balance shows legibly, and strips after which they become longer."""

_REFERENCES = (
    ("zmp_reference", 2, "ZMP reference (footsteps)", palette.ZMP_PLANNED),
    ("com", 3, "CoM reference", palette.COM_PLANNED),
    ("dcm", 2, "DCM reference", palette.DCM_PLANNED),
)
"""References of ZMP, CoM and DCM: field of ``/reference``, its size, label and colour."""


def strips(view: LogView) -> tuple[tuple[float, float], ...]:
    """Begin and end of equally long stretches of time that are drawn below each other [s]."""
    count = int(np.clip(np.ceil((view.end - view.start) / STRIP - 1e-9), 1, MOST_STRIPS))
    return tuple(pairwise(np.linspace(view.start, view.end, count + 1).tolist()))


def draw_balance(area: Area, view: LogView, behind: Background) -> None:
    """Draw positions, in strips of a few seconds each, then errors over all the time."""
    stretches = strips(view)
    heights = [*[2.6] * len(stretches), 2.9]
    *parts, last = area.subfigures(len(heights), 1, squeeze=False, height_ratios=heights)[:, 0]
    first, other = _directions(view)
    title, columns, drawn = BALANCE_TITLE, 7, []
    for part, stretch in zip(parts, stretches, strict=True):
        panels = (
            Panel(f"{first} [m]", partial(_positions, axis=0), columns, handles=(support_handle(),)),
            Panel(f"{other} [m]", partial(_positions, axis=1)),
        )
        drawn.append(draw_panels(part, view, behind, title, panels, stretch))
        title, columns = "", 0
    for row in zip(*drawn, strict=True):  # one direction in all strips, on one scale
        low, high = zip(*(one.get_ylim() for one in row), strict=True)
        for one in row:
            one.set_ylim(min(low), max(high))
    errors = (
        Panel(f"{first}\nerror [mm]", partial(_errors, axis=0), columns=3),
        Panel(f"{other}\nerror [mm]", partial(_errors, axis=1)),
        Panel("capture\nmargin [m]", _margin, columns=2),
    )
    draw_panels(last, view, behind, "", errors)


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


def draw_support(axes: Axes, view: LogView, axis: int) -> None:
    """Draw the planned support in a direction, with its bounds."""
    time, low, high = support_bounds(view, axis)
    axes.fill_between(time, low, high, step="post", color=palette.SUPPORT, alpha=0.18, linewidth=0, zorder=1)
    for bound in (low, high):
        axes.plot(time, bound, drawstyle="steps-post", color=palette.GREY, linewidth=0.6, zorder=1.5)


def support_handle() -> Patch:
    """Entry of a legend for the support."""
    return Patch(
        facecolor=palette.SUPPORT, edgecolor=palette.GREY, alpha=0.3, linewidth=0.5, label="planned support, bounds"
    )


def true_dcm(view: LogView) -> Array:
    """DCM of the true state on the ticks of /truth, with the reference's natural frequency, shape (n, 2) [m]."""
    omega = view.at("/reference", "omega", view.time("/truth"))[:, None]
    return dcm(view.field("/truth", "com", 3)[:, :2], view.field("/truth", "com_velocity", 3)[:, :2], omega)


def _positions(axes: Axes, view: LogView, axis: int) -> None:
    draw_support(axes, view, axis)
    measured = (
        ("ZMP measured", palette.ZMP, "/contact", view.field("/contact", "zmp", 3), 1.1),
        ("CoM true", palette.COM, "/truth", view.field("/truth", "com", 3), 1.5),
        ("DCM true", palette.DCM, "/truth", true_dcm(view), 1.5),
    )
    for label, color, topic, values, width in measured:
        time = view.time(topic)
        curve(axes, time, seen(view, time, values[:, :2])[:, axis], label, color, linewidth=width)
    clock = view.time("/reference")
    for name, size, label, color in _REFERENCES:
        values = seen(view, clock, view.field("/reference", name, size)[:, :2])[:, axis]
        reference_curve(axes, clock, values, label, color)


def _errors(axes: Axes, view: LogView, axis: int) -> None:
    clock = view.time("/reference")
    zmp, com, planned = (view.field("/reference", name, size)[:, :2] for name, size, *_ in _REFERENCES)
    curves = (
        ("ZMP", palette.ZMP, "/contact", view.field("/contact", "zmp", 3)[:, :2], zmp),
        ("DCM", palette.DCM, "/truth", true_dcm(view), planned),
        ("CoM", palette.COM, "/truth", view.field("/truth", "com", 3)[:, :2], com),
    )
    axes.axhline(0.0, color=palette.GREY, linewidth=0.6)
    for name, color, topic, values, reference in curves:
        time = view.time(topic)
        wanted = np.column_stack([np.interp(time, clock, along) for along in reference.T])
        error = 1e3 * (seen(view, time, values) - seen(view, time, wanted))[:, axis]
        curve(axes, time, error, f"{name} minus its reference", color, linewidth=0.9)


def _margin(axes: Axes, view: LogView) -> None:
    clock, (planned, movable) = view.time("/plan"), view.field("/plan", "capture_margin", 2).T
    axes.axhline(0.0, color=palette.GREY, linewidth=0.6)
    reference_curve(axes, clock, planned, "DCM inside what is captured, steps as planned", palette.DCM_PLANNED)
    curve(axes, clock, movable, "the same, steps moved", palette.DCM, linewidth=1.2)


def draw_height(area: Area, view: LogView, behind: Background) -> None:
    """Draw the height over the ground frame, and the first jerk of each plan."""
    panels = (Panel("CoM z [m]", _height, columns=3), Panel("CoM jerk [m/s³]", _jerk, columns=2))
    draw_panels(area, view, behind, "CoM height and planned jerk", panels)


def _height(axes: Axes, view: LogView) -> None:
    curve(axes, view.time("/truth"), view.field("/truth", "com", 3)[:, 2], "true", palette.COM, linewidth=1.5)
    planned = view.field("/reference", "com", 3)[:, 2]
    reference_curve(axes, view.time("/reference"), planned, "reference", palette.COM_PLANNED)


def _jerk(axes: Axes, view: LogView) -> None:
    first = view.field("/plan", "jerk", -1, 2)[:, 0]
    for values, name, color in zip(first.T, "xy", (palette.PURPLE, palette.BLACK), strict=True):
        curve(axes, view.time("/plan"), values, f"jerk {name}", color, drawstyle="steps-post", linewidth=0.9)


def draw_feet(area: Area, view: LogView, behind: Background) -> None:
    """Draw the heights with the swing reference, and the forces with the weight."""
    panels = (Panel("sole z [m]", _sole_heights, columns=3), Panel("normal force [N]", _forces, columns=3))
    draw_panels(area, view, behind, "Feet: sole heights and contact normal forces", panels)


def _sole_heights(axes: Axes, view: LogView) -> None:
    for name, color in zip(FOOT_NAMES, palette.FEET, strict=True):
        pose = view.field("/truth", f"{name}_sole", 7)
        curve(axes, view.time("/truth"), pose[:, 2], f"{name} sole", color, linewidth=1.4)
    height, swings = view.field("/reference", "swing_position", 3)[:, 2], view.field("/reference", "stance") >= 0
    reference_curve(axes, view.time("/reference"), np.where(swings, height, np.nan), "swing reference", palette.BLACK)


def _forces(axes: Axes, view: LogView) -> None:
    forces = view.field("/contact", "normal_force", 2)
    for foot, name in enumerate(FOOT_NAMES):
        curve(axes, view.time("/contact"), forces[:, foot], f"{name} foot", palette.FEET[foot])
    try:
        weight = view.number("mass") * GRAVITY
    except MissingError:
        return
    axes.axhline(weight, color=palette.GREY, linewidth=0.8, linestyle="--", label=f"weight {weight:.0f} N")
