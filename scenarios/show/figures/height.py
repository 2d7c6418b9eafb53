"""Height of the CoM and its jerk as planned."""

import numpy as np

from surefoot.scenarios.palette import BLACK, COM, COM_PLANNED, PURPLE
from surefoot.scenarios.show.figures.shading import Background
from surefoot.scenarios.show.figures.style import Area, curve, legend, or_say, reference_curve, time_axes
from surefoot.scenarios.show.logview import LogView

TITLE = "CoM height and planned jerk"


def draw(area: Area, view: LogView, background: Background) -> None:
    """Draw the height over the ground frame, and the first jerk of each plan."""
    height, jerk = axes = time_axes(area, view, TITLE, (1.0, 1.0))
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
