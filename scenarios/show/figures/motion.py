"""Figures of the motion: ZMP, CoM and DCM with their references, the CoM's height, and the feet."""

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
from surefoot.scenarios.show.figures.shading import Background
from surefoot.scenarios.show.figures.style import (
    FOOT_NAMES,
    Area,
    curve,
    legend,
    or_say,
    reference_curve,
    steps,
    time_axes,
)
from surefoot.scenarios.show.logview import LogView, MissingError

Array = NDArray[np.float64]

BALANCE_TITLE = "Balance: ZMP, CoM and DCM with their references"


def draw_balance(area: Area, view: LogView, background: Background) -> None:
    """Draw position and error along x, then along y."""
    axes = time_axes(area, view, BALANCE_TITLE, (3.0, 1.1, 3.0, 1.1))
    background.shade(axes)
    for axis, name in enumerate("xy"):
        position, error = axes[2 * axis : 2 * axis + 2]
        position.set_ylabel(f"{name} [m]")
        error.set_ylabel(f"{name} error [mm]")
        with or_say(position):
            _support(position, view, axis)
            _positions(position, view, axis)
        with or_say(error):
            _errors(error, view, axis)
    support = Patch(facecolor=SUPPORT, edgecolor=GREY, alpha=0.3, label="planned support, bounds")
    legend(axes[0], 7, [support])
    legend(axes[1], 3)


def support_bounds(view: LogView, axis: int) -> tuple[Array, Array, Array]:
    """Bounds of the planned support along an axis where they change: time [s], least, greatest [m], shape (k,)."""
    vertices = view.field("/reference", "support", SUPPORT_VERTICES, 2)[..., axis]
    low, high = vertices.min(axis=1), vertices.max(axis=1)
    rows = steps(low, high)
    return view.time("/reference")[rows], low[rows], high[rows]


def true_dcm(view: LogView) -> Array:
    """DCM of the true state on the ticks of /truth, with the reference's natural frequency, shape (n, 2) [m]."""
    omega = view.at("/reference", "omega", view.time("/truth"))[:, None]
    return view.field("/truth", "com", 3)[:, :2] + view.field("/truth", "com_velocity", 3)[:, :2] / omega


def _support(axes: Axes, view: LogView, axis: int) -> None:
    time, low, high = support_bounds(view, axis)
    axes.fill_between(time, low, high, step="post", color=SUPPORT, alpha=0.18, linewidth=0, zorder=1)
    for bound in (low, high):
        axes.plot(time, bound, drawstyle="steps-post", color=GREY, linewidth=0.6, zorder=1.5)


def _positions(axes: Axes, view: LogView, axis: int) -> None:
    clock = view.time("/reference")
    curve(axes, view.time("/contact"), view.field("/contact", "zmp", 3)[:, axis], "ZMP measured", ZMP)
    curve(axes, view.time("/truth"), view.field("/truth", "com", 3)[:, axis], "CoM true", COM, linewidth=1.5)
    curve(axes, view.time("/truth"), true_dcm(view)[:, axis], "DCM true", DCM, linewidth=1.5)
    zmp = view.field("/reference", "zmp_reference", 2)[:, axis]
    reference_curve(axes, clock, zmp, "ZMP reference (footsteps)", ZMP_PLANNED)
    for name, size, color in (("com", 3, COM_PLANNED), ("dcm", 2, DCM_PLANNED)):
        values = view.field("/reference", name, size)[:, axis]
        reference_curve(axes, clock, values, f"{name.upper().replace('COM', 'CoM')} reference", color)


def _errors(axes: Axes, view: LogView, axis: int) -> None:
    references = {name: view.field("/reference", name, size)[:, axis] for name, size in _REFERENCES}
    clock, body, felt = (view.time(topic) for topic in ("/reference", "/truth", "/contact"))
    curves = (
        ("ZMP", ZMP, felt, view.field("/contact", "zmp", 3)[:, axis], references["zmp_reference"]),
        ("DCM", DCM, body, true_dcm(view)[:, axis], references["dcm"]),
        ("CoM", COM, body, view.field("/truth", "com", 3)[:, axis], references["com"]),
    )
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    for name, color, time, values, reference in curves:
        error = 1e3 * (values - np.interp(time, clock, reference))
        curve(axes, time, error, f"{name} minus its reference", color, linewidth=0.9)


_REFERENCES = (("zmp_reference", 2), ("dcm", 2), ("com", 3))


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
