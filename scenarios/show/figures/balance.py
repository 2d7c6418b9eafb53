"""ZMP, CoM and DCM with their references and the support's bounds, along x and along y, and what is left between."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from numpy.typing import NDArray

from surefoot.scenarios.palette import COM, COM_PLANNED, DCM, DCM_PLANNED, GREY, SUPPORT, ZMP, ZMP_PLANNED
from surefoot.scenarios.record.channels import SUPPORT_VERTICES
from surefoot.scenarios.show.figures.shading import Background
from surefoot.scenarios.show.figures.style import Area, curve, legend, or_say, reference_curve, steps, time_axes
from surefoot.scenarios.show.logview import LogView

Array = NDArray[np.float64]

TITLE = "Balance: ZMP, CoM and DCM with their references"


def draw(area: Area, view: LogView, background: Background) -> None:
    """Draw position and error along x, then along y."""
    axes = time_axes(area, view, TITLE, (3.0, 1.1, 3.0, 1.1))
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
