"""Feet: heights of the soles and the normal forces under them."""

import numpy as np
from matplotlib.axes import Axes

from surefoot.planner.types import GRAVITY
from surefoot.scenarios.palette import BLACK, FEET, GREY
from surefoot.scenarios.show.figures.shading import Background
from surefoot.scenarios.show.figures.style import FOOT_NAMES, Area, curve, legend, or_say, reference_curve, time_axes
from surefoot.scenarios.show.logview import LogView, MissingError

TITLE = "Feet: sole heights and contact normal forces"


def draw(area: Area, view: LogView, background: Background) -> None:
    """Draw the heights with the swing reference, and the forces with the weight."""
    height, force = axes = time_axes(area, view, TITLE, (1.0, 1.0))
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
