"""The walk from above: footprints, support polygons, paths of ZMP and CoM, with equal axes."""

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from surefoot.scenarios.judge.body import headings, level_corners
from surefoot.scenarios.palette import COM, FEET, FOOTSTEP, GREY, SUPPORT, ZMP
from surefoot.scenarios.record.channels import SUPPORT_VERTICES
from surefoot.scenarios.show.figures.shading import Background
from surefoot.scenarios.show.figures.style import FOOT_NAMES, Area, heading, kept_of_path, legend, or_say
from surefoot.scenarios.show.logview import LogView, MissingError

Array = NDArray[np.float64]

TITLE = "Top view"
WIDE = 2.2
"""Length over width of a walk beyond which the page gives it a row of its own."""

_MOST_POLYGONS = 200


def draw(area: Area, view: LogView, background: Background) -> None:
    """Draw everything on the ground plane."""
    del background  # there is no time in this figure
    axes = area.subplots()
    heading(area, TITLE)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_aspect("equal", adjustable="datalim")
    drawn = [_supports(axes, view), _footprints(axes, view), _paths(axes, view)]
    handles = [handle for part in drawn for handle in part]
    if not handles:
        with or_say(axes):
            raise MissingError("/truth, /contact, /reference")
    axes.margins(0.04)
    legend(axes, 4, handles)


def is_wide(view: LogView) -> bool:
    """Whether the walk is much longer in x than in y, so that its top view is a strip."""
    try:
        extent = np.ptp(view.field("/truth", "com", 3)[:, :2], axis=0)
    except MissingError:
        return False
    return bool(extent[0] > WIDE * (extent[1] + 0.3))


def _supports(axes: Axes, view: LogView) -> list[Artist]:
    try:
        vertices = view.field("/reference", "support", SUPPORT_VERTICES, 2)
    except MissingError:
        return []
    flat = vertices.reshape(len(vertices), -1)
    changed = np.concatenate(([True], np.any(flat[1:] != flat[:-1], axis=1)))
    polygons = vertices[changed & np.isfinite(flat).all(axis=1)]
    polygons = polygons[:: -(-len(polygons) // _MOST_POLYGONS) or 1]
    style: dict[str, Any] = {"facecolor": SUPPORT, "edgecolor": GREY, "linewidth": 0.5}
    axes.add_collection(PolyCollection(list(polygons), alpha=0.12, **style))
    return [Patch(alpha=0.2, label="planned support", **style)]


def _footprints(axes: Axes, view: LogView) -> list[Artist]:
    """Where the soles stood at the window's begin and landed since, and where they were last planned to land."""
    try:
        length, width = view.number("foot_length"), view.number("foot_width")
    except MissingError:
        return []
    entries: list[Artist] = []
    for foot, pose, label in [*_first_feet(view), *_touchdowns(view, "actual")]:
        (corners,) = level_corners(pose[None], length, width)
        axes.fill(*corners.T, facecolor=FEET[foot], edgecolor=FEET[foot], alpha=0.55, linewidth=0.8, zorder=2)
        below: dict[str, Any] = {"textcoords": "offset points", "ha": "right", "va": "top"}
        axes.annotate(label, corners[2], (-2, -2), fontsize=6.5, zorder=5, **below)
    for _, pose, _ in [*_touchdowns(view, "planned"), *_ahead(view)]:
        (corners,) = level_corners(pose[None], length, width)
        axes.fill(*corners.T, facecolor="none", edgecolor=FOOTSTEP, linestyle="--", linewidth=0.9, zorder=3)
        entries = [Patch(facecolor="none", edgecolor=FOOTSTEP, linestyle="--", label="footstep planned")]
    soles = [Patch(color=FEET[foot], alpha=0.55, label=f"{FOOT_NAMES[foot]} footprint") for foot in (0, 1)]
    return [*soles, *entries]


def _first_feet(view: LogView) -> list[tuple[int, Array, str]]:
    """Soles on the ground when the window begins; a foot in the air leaves no print."""
    feet = []
    for foot, name in enumerate(FOOT_NAMES):
        try:
            if not view.field("/contact", "felt", 2)[0, foot]:
                continue
            pose = view.field("/truth", f"{name}_sole", 7)[0]
        except MissingError:
            continue
        feet.append((foot, np.array([*pose[:2], headings(pose[3:])]), ""))
    return feet


def _touchdowns(view: LogView, name: str) -> list[tuple[int, Array, str]]:
    try:
        poses, feet = view.field("/footstep", name, 4), view.field("/footstep", "foot")
        numbers = view.field("/footstep", "index")
    except MissingError:
        return []
    sound = np.isfinite(poses).all(axis=1) & np.isin(feet, (0, 1))
    rows = zip(feet[sound], poses[sound], numbers[sound], strict=True)
    return [(int(foot), pose, f"{number:.0f}") for foot, pose, number in rows]


def _ahead(view: LogView) -> list[tuple[int, Array, str]]:
    """Footsteps that were still to come when the window ends."""
    try:
        poses, feet = view.field("/footsteps", "next", 3, 4)[-1], view.field("/footsteps", "next_foot", 3)[-1]
    except MissingError:
        return []
    return [(int(foot), pose, "") for foot, pose in zip(feet, poses, strict=True) if np.isfinite(pose).all()]


def _paths(axes: Axes, view: LogView) -> list[Artist]:
    entries: list[Artist] = []
    for topic, name, label, color in (("/contact", "zmp", "ZMP measured", ZMP), ("/truth", "com", "CoM true", COM)):
        try:
            path = view.field(topic, name, 3)[:, :2]
        except MissingError:
            continue
        rows = kept_of_path(path)
        axes.plot(*path[rows].T, color=color, linewidth=1.0, zorder=4)
        entries.append(Line2D([], [], color=color, label=label))
    return entries
