"""The walk from above: footprints, support polygons, paths of ZMP and CoM, with equal axes."""

from itertools import pairwise
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
    """Draw everything on the ground plane; a long strip of it in rows below each other."""
    del background  # there is no time in this figure
    rows = _rows(view)
    axes: list[Axes] = list(area.subplots(max(len(rows), 1), 1, squeeze=False)[:, 0])
    heading(area, TITLE)
    stretches: list[tuple[float, float] | None] = [*rows] or [None]
    for one, stretch in zip(axes, stretches, strict=True):
        one.set_ylabel("y [m]")
        drawn = [_supports(one, view), _footprints(one, view), _paths(one, view)]
        handles = [handle for part in drawn for handle in part]
        if not handles:
            with or_say(one):
                raise MissingError("/truth, /contact, /reference")
        one.margins(0.04)
        one.set_aspect("equal", adjustable="box" if stretch else "datalim")
        if stretch:
            one.set_xlim(stretch)
        if one is axes[0]:
            legend(one, 7 if stretch else 4, handles)
    axes[-1].set_xlabel("x [m]")


ROW, MOST_ROWS = 5.0, 6
"""Metres that a row of a strip shows legibly, and rows after which they become longer."""


def _rows(view: LogView) -> list[tuple[float, float]]:
    """Stretches of x that are drawn below each other [m]; none of a walk that is no strip."""
    if not is_wide(view):
        return []
    x = view.field("/truth", "com", 3)[:, 0]
    first, last = float(np.nanmin(x)) - 0.3, float(np.nanmax(x)) + 0.3
    count = int(np.clip(np.ceil((last - first) / ROW), 1, MOST_ROWS))
    bounds = np.linspace(first, last, count + 1).tolist()
    return list(pairwise(bounds))


def height(view: LogView, width: float) -> float:
    """Of the rows of a strip, drawn in a width, all [in]."""
    rows = _rows(view)
    if not rows:
        return 0.0
    y = view.field("/truth", "com", 3)[:, 1]
    inches_per_metre = 0.93 * width / (rows[0][1] - rows[0][0])
    return len(rows) * (inches_per_metre * (float(np.nanmax(y) - np.nanmin(y)) + 0.35) + 0.2)


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
        axes.annotate(label, corners[2], (-2, -2), fontsize=6.5, zorder=5, annotation_clip=True, **below)
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
