"""Figures of the ground: the walk from above, where the soles are pressed, how far from slipping and from the plan."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from itertools import pairwise, zip_longest
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray

from surefoot.planner.geometry.plane import headings, level_corners, points_seen_from, rotations, yaw_rotations
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.scenarios.palette import BLACK, COM, FEET, FOOTSTEP, GREY, SUPPORT, ZMP
from surefoot.scenarios.record.channels import SUPPORT_VERTICES
from surefoot.scenarios.show.kit.figures import Area, curve, heading, kept_of_path, legend, note, or_say
from surefoot.scenarios.show.kit.shading import Background, Panel, draw_panels
from surefoot.scenarios.show.logview import FOOT_NAMES, LOADED, LogView, MissingError

Array = NDArray[np.float64]

SoleSize = tuple[float, float]
"""Length and width of a sole [m]."""

_MOST_POINTS = 4000
"""Centres of pressure that are drawn for each foot."""


def draw_soles(area: Area, view: LogView, _: Background) -> None:
    """Draw the centres of pressure in the outline of each sole, and where the feet landed beside the plan."""
    left, right, landings = area.subplots(1, 3)
    heading(area, "Centres of pressure in the soles, and landings off the plan")
    for foot, one in enumerate((left, right)):
        one.set_xlabel(f"to the left [m], {FOOT_NAMES[foot]} sole")
        with or_say(one):
            _pressures(one, view, foot)
    left.set_ylabel("forward [m]")
    landings.set_xlabel("left of the plan [mm]")
    landings.set_ylabel("beyond the plan [mm]")
    with or_say(landings):
        _landings(landings, view)


def _pressures(axes: Axes, view: LogView, foot: int) -> None:
    """Seen from above, forward up and left to the left; a dashed line holds 90 percent of the half sizes."""
    length, width = view.number("foot_length"), view.number("foot_width")
    cop = view.field("/contact", f"cop_{FOOT_NAMES[foot]}", 2)
    alone = bears_alone(view, foot, view.time("/contact"))
    for rows, color, label in ((~alone, GREY, "double support"), (alone, FEET[foot], "single support")):
        points = cop[rows & np.isfinite(cop).all(axis=1)]
        points = points[:: -(-len(points) // _MOST_POINTS) or 1]
        axes.plot(points[:, 1], points[:, 0], ".", color=color, markersize=2.5, alpha=0.6)
        axes.plot([], [], "o", color=color, markersize=4, label=label)
    for share, style in ((1.0, "-"), (0.9, "--")):
        corner = (-share * width / 2, -share * length / 2)
        axes.add_patch(Rectangle(corner, share * width, share * length, fill=False, edgecolor=BLACK, linestyle=style))
    axes.set_xlim(0.8 * width, -0.8 * width)
    axes.set_ylim(-0.6 * length, 0.6 * length)
    axes.set_aspect("equal", adjustable="box")
    legend(axes, 1)


def bears_alone(view: LogView, foot: int, times: Array) -> NDArray[np.bool_]:
    """Mark the times at which a foot is the stance foot, shape (n,)."""
    return np.asarray(view.at("/reference", "stance", times) == foot)


def landing_errors(view: LogView) -> tuple[Array, NDArray[np.intp], Array]:
    """Landings off the plan, along and across the planned foot, shape (k, 2) [m]; foot and number of each step."""
    planned, actual = (view.field("/footstep", name, 4) for name in ("planned", "actual"))
    feet, numbers = view.field("/footstep", "foot"), view.field("/footstep", "index")
    errors = points_seen_from(planned, actual[:, :2])
    sound = np.isfinite(errors).all(axis=1) & np.isin(feet, (0, 1))
    return errors[sound], feet[sound].astype(int), numbers[sound]


def _landings(axes: Axes, view: LogView) -> None:
    errors, feet, numbers = landing_errors(view)
    if not len(errors):
        raise MissingError("/footstep in this window")
    errors = 1e3 * errors
    for foot, name in enumerate(FOOT_NAMES):
        mine = feet == foot
        axes.plot(errors[mine, 1], errors[mine, 0], "o", color=FEET[foot], markersize=4, label=f"{name} foot")
    worst = int(np.argmax(np.linalg.norm(errors, axis=1)))
    far: dict[str, Any] = {"textcoords": "offset points", "fontsize": 6.5}
    place = (float(errors[worst, 1]), float(errors[worst, 0]))
    axes.annotate(f"step {numbers[worst]:.0f}", place, (3, 3), **far)
    for line in (axes.axhline, axes.axvline):
        line(0.0, color=GREY, linewidth=0.6)
    reach = 1.3 * max(float(np.abs(errors).max()), 1.0)
    axes.set_xlim(reach, -reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal", adjustable="box")
    legend(axes, 1)


_MOST_PERCENT = 200.0
"""Beyond it a foot slips anyway; shown as this much."""


def draw_grip(area: Area, view: LogView, behind: Background) -> None:
    """Draw how much of the friction each foot uses along the ground, and about the vertical."""
    panels = (
        Panel("friction [%]", partial(_grip, used=friction_used), columns=3),
        # A sole on its edge is no patch of ground.
        Panel("yaw moment,\nsingle support [%]", partial(_grip, used=yaw_moment_used, alone=True)),
    )
    draw_panels(area, view, behind, "Grip: friction and yaw moment in percent of what the ground holds", panels)


def _grip(axes: Axes, view: LogView, used: Callable[[Array, float, SoleSize], Array], alone: bool = False) -> None:
    """Draw a share of what the ground holds, of each foot; only where it bears alone, if so."""
    coefficient, sole = _coefficient(view), (view.number("foot_length"), view.number("foot_width"))
    clock = view.time("/measurement")
    for foot, name in enumerate(FOOT_NAMES):
        percent = np.minimum(100.0 * used(loaded_wrench(view, foot), coefficient, sole), _MOST_PERCENT)
        if alone:
            percent[~bears_alone(view, foot, clock)] = np.nan
        curve(axes, clock, percent, f"{name} foot", FEET[foot])
    axes.axhline(100.0, color=BLACK, linewidth=0.9, linestyle="--", label="slips")
    axes.set_ylim(bottom=0.0)


def _coefficient(view: LogView) -> float:
    """Friction of the ground that the run had."""
    try:
        return float(scenario_of(view.log).terrain.friction)
    except LogError:
        raise MissingError("the scenario's terrain.friction") from None


def loaded_wrench(view: LogView, foot: int) -> Array:
    """Wrench at the sole's centre along the ground, force first, NaN where the foot bears too little, shape (n, 6).

    On level ground a sole that rolls about its toes is turned back; elsewhere the sole tells how the ground lies.
    """
    wrench = view.field("/measurement", f"wrench_{FOOT_NAMES[foot]}", 6)
    if view.constant("terrain") == "flat":
        pose = view.field("/truth", f"{FOOT_NAMES[foot]}_sole", 7)
        if len(pose) != len(wrench):
            raise MissingError("/truth and /measurement of the same ticks")
        turned = yaw_rotations(-headings(pose[:, 3:])) @ rotations(pose[:, 3:])
        wrench = np.einsum("nij,nkj->nki", turned, wrench.reshape(-1, 2, 3)).reshape(-1, 6)
    wrench[wrench[:, 2] < LOADED * view.number("mass") * GRAVITY] = np.nan
    return wrench


def friction_used(wrench: Array, coefficient: float, sole: SoleSize) -> Array:
    """Tangential over normal force over the coefficient, shape (n,) [-].

    Args:
        wrench: at the sole's centre in its frame, force first, shape (n, 6).
        coefficient: of friction [-].
        sole: its size, on which this does not depend.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.hypot(wrench[:, 0], wrench[:, 1]) / (coefficient * wrench[:, 2]))


def yaw_moment_used(wrench: Array, coefficient: float, sole: SoleSize) -> Array:
    """Yaw moment over the one at which the sole turns with these other forces and moments, shape (n,) [-].

    Caron, Pham and Nakamura, "Stability of surface contacts for humanoid robots", ICRA 2015, eqs. (10) to (12).
    It is infinite where the sole slips whatever its yaw moment.

    Args:
        wrench: at the sole's centre in its frame, force first, shape (n, 6).
        coefficient: of friction [-].
        sole: its size.
    """
    x, y, mu = sole[0] / 2, sole[1] / 2, coefficient
    fx, fy, fz, tx, ty, tz = wrench.T
    most = mu * (x + y) * fz - np.abs(y * fx + mu * tx) - np.abs(x * fy + mu * ty)
    least = -mu * (x + y) * fz + np.abs(y * fx - mu * tx) + np.abs(x * fy - mu * ty)
    limit = np.where(tz >= 0.0, most, -least)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(limit <= 0.0, np.inf, np.abs(tz) / limit))


WIDE = 2.2
"""Length over width of a walk beyond which the page gives it a row of its own."""

_MOST_POLYGONS = 200


def draw_top_view(area: Area, view: LogView, _: Background) -> None:
    """Draw everything on the ground plane; a long strip of it in rows below each other."""
    rows = _rows(view)
    axes: list[Axes] = list(area.subplots(max(len(rows), 1), 1, squeeze=False)[:, 0])
    heading(area, "Top view")
    for one, stretch in zip_longest(axes, rows):
        one.set_ylabel("y [m]")
        handles = [*_supports(one, view), *_footprints(one, view, stretch), *_paths(one, view)]
        if not handles:
            note(one, "not in this log: /truth, /contact, /reference")
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
    return list(pairwise(np.linspace(first, last, count + 1).tolist()))


def strip_height(view: LogView, width: float) -> float:
    """Height of the rows of a strip, drawn in a width, all [in]."""
    rows = _rows(view)
    if not rows:
        return 0.0
    y = view.field("/truth", "com", 3)[:, 1]
    inches_per_metre = 0.93 * width / (rows[0][1] - rows[0][0])
    return len(rows) * (inches_per_metre * (float(np.nanmax(y) - np.nanmin(y)) + 0.35) + 0.2)


def is_wide(view: LogView) -> bool:
    """Return true if the walk is much longer in x than in y, so that its top view is a strip."""
    try:
        extent = np.ptp(view.field("/truth", "com", 3)[:, :2], axis=0)
    except MissingError:
        return False
    return bool(extent[0] > WIDE * (extent[1] + 0.3))


def _supports(axes: Axes, view: LogView) -> list[Artist]:
    polygons: list[Array] = []
    for part in view.parts():
        with suppress(MissingError):
            vertices = part.field("/reference", "support", SUPPORT_VERTICES, 2)
            flat = vertices.reshape(len(vertices), -1)
            changed = np.concatenate(([True], np.any(flat[1:] != flat[:-1], axis=1)))
            polygons += list(vertices[changed & np.isfinite(flat).all(axis=1)])
    if not polygons:
        return []
    polygons = polygons[:: -(-len(polygons) // _MOST_POLYGONS) or 1]
    style: dict[str, Any] = {"facecolor": SUPPORT, "edgecolor": GREY, "linewidth": 0.5}
    axes.add_collection(PolyCollection(polygons, alpha=0.12, **style))
    return [Patch(alpha=0.2, label="planned support", **style)]


_Print = tuple[int, Array, str]
"""Foot, x y and a heading last [m, rad], and what stands beside it."""


_MOST_NAMED = 150
"""More footprints than these leave no room for their numbers."""


def _footprints(axes: Axes, view: LogView, stretch: tuple[float, float] | None) -> list[Artist]:
    """Draw where the soles stood at the window's begin and landed since, and where they were last planned to land.

    Of a row of a strip only those in its stretch of x [m].
    """
    try:
        length, width = view.number("foot_length"), view.number("foot_width")
    except MissingError:
        return []
    taken = list(_in_sight((*_first_feet(view), *_touchdowns(view, "actual")), stretch, length))
    planned = list(_in_sight((*_touchdowns(view, "planned"), *_ahead(view)), stretch, length))
    for side, color in enumerate(FEET):
        poses = [pose for foot, pose, _ in taken if foot == side]
        _soles(axes, poses, length, width, facecolor=color, edgecolor=color, alpha=0.55, linewidth=0.8, zorder=2)
    for _, pose, label in taken if len(taken) <= _MOST_NAMED else ():
        corner = level_corners(pose[None], length, width)[0, 2]
        below: dict[str, Any] = {"textcoords": "offset points", "ha": "right", "va": "top"}
        axes.annotate(label, corner, (-2, -2), fontsize=6.5, zorder=5, annotation_clip=True, **below)
    dashed: dict[str, Any] = {"facecolor": "none", "edgecolor": FOOTSTEP, "linestyle": "--"}
    _soles(axes, [pose for _, pose, _ in planned], length, width, linewidth=0.9, zorder=3, **dashed)
    soles = [Patch(color=FEET[foot], alpha=0.55, label=f"{FOOT_NAMES[foot]} footprint") for foot in (0, 1)]
    return [*soles, *([Patch(label="footstep planned", **dashed)] if planned else [])]


def _in_sight(prints: Iterable[_Print], stretch: tuple[float, float] | None, length: float) -> Iterator[_Print]:
    """Footprints of soles of a length [m] that reach into a stretch of x [m]."""
    least, most = (-np.inf, np.inf) if stretch is None else stretch
    return (one for one in prints if least - length <= one[1][0] <= most + length)


def _soles(axes: Axes, poses: Sequence[Array], length: float, width: float, **style: Any) -> None:
    """Draw the outlines of soles at x y and a heading last, together: there may be thousands."""
    if poses:
        axes.add_collection(PolyCollection([level_corners(pose[None], length, width)[0] for pose in poses], **style))
        axes.autoscale_view()


def _first_feet(view: LogView) -> Iterator[_Print]:
    """Soles on the ground when the window begins; a foot in the air leaves no print."""
    begin = next(view.parts())
    for foot, name in enumerate(FOOT_NAMES):
        with suppress(MissingError):
            if begin.field("/contact", "felt", 2)[0, foot]:
                pose = begin.field("/truth", f"{name}_sole", 7)[0]
                yield foot, np.array([*pose[:2], headings(pose[3:])]), ""


def _touchdowns(view: LogView, name: str) -> Iterator[_Print]:
    with suppress(MissingError):
        poses, feet = view.field("/footstep", name, 4), view.field("/footstep", "foot")
        numbers = view.field("/footstep", "index")
        sound = np.isfinite(poses).all(axis=1) & np.isin(feet, (0, 1))
        for foot, pose, number in zip(feet[sound], poses[sound], numbers[sound], strict=True):
            yield int(foot), pose, f"{number:.0f}"


def _ahead(view: LogView) -> Iterator[_Print]:
    """Footsteps that were still to come when the window ends."""
    with suppress(MissingError):
        poses, feet = view.field("/footsteps", "next", 3, 4)[-1], view.field("/footsteps", "next_foot", 3)[-1]
        for foot, pose in zip(feet, poses, strict=True):
            if np.isfinite(pose).all():
                yield int(foot), pose, ""


def _paths(axes: Axes, view: LogView) -> Iterator[Artist]:
    for topic, name, label, color in (("/contact", "zmp", "ZMP measured", ZMP), ("/truth", "com", "CoM true", COM)):
        with suppress(MissingError):
            path = view.field(topic, name, 3)[:, :2]
            axes.plot(*path[kept_of_path(path)].T, color=color, linewidth=1.0, zorder=4)
            yield Line2D([], [], color=color, label=label)
