"""Figures of effort: joint torques against their limits, solvers and computing time."""

import re
from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from surefoot.scenarios.judge.body import Roles, leg, side_of
from surefoot.scenarios.palette import BLACK, BLUE, GREY, VERMILION
from surefoot.scenarios.show.kit.figures import CYCLE, Area, curve, legend, or_say, time_axes
from surefoot.scenarios.show.kit.shading import Background
from surefoot.scenarios.show.logview import FOOT_NAMES, LogView, MissingError

TORQUES_TITLE = "Joint torques in percent of their limits"
ANGLES_TITLE = "Joint angles in percent of half their range"
SPEEDS_TITLE = "Joint speeds in percent of their limits"
_MOST = 6
"""Joints of a group drawn one by one; a larger group is drawn by its largest ratio."""


_PLATE = {"facecolor": "white", "alpha": 0.75, "linewidth": 0, "pad": 1.0}


Percent = Callable[[LogView], tuple[tuple[str, ...], NDArray[np.float64]]]


def draw_torques(area: Area, view: LogView, background: Background) -> None:
    """Draw torque over limit, signed, in three groups of joints on one scale."""
    _draw_groups(area, view, background, TORQUES_TITLE, "/torque", _torques)


def draw_joints(area: Area, view: LogView, background: Background) -> None:
    """Draw angles within their range, beside them speeds over their limits."""
    angles, speeds = area.subfigures(1, 2, squeeze=False)[0]
    _draw_groups(angles, view, background, ANGLES_TITLE, "/measurement", _angles)
    _draw_groups(speeds, view, background, SPEEDS_TITLE, "/measurement", _speeds)


def _draw_groups(
    area: Area, view: LogView, background: Background, title: str, topic: str, percent_of: Percent
) -> None:
    """Draw percent of a limit, signed, in three groups of joints on one scale."""
    axes = time_axes(area, view, title, (1.0, 1.0, 1.0))
    background.shade(axes)
    for one, name in zip(axes, ("left leg", "right leg", "upper body"), strict=True):
        one.set_ylabel(f"{name} [%]")
        with or_say(one):
            names, percent = percent_of(view)
            _group(one, view.time(topic), percent, groups(names, _roles(view))[name])
            one.set_ylim(*_limits(percent))
            for limit in (-100.0, 100.0):
                one.axhline(limit, color=BLACK, linewidth=0.9, linestyle="--")
    same = axes[0].get_legend_handles_labels()[1] == axes[1].get_legend_handles_labels()[1]
    for one in (axes[0], *([] if same else [axes[1]]), axes[2]):
        legend(one, 6 if same else 4)


def groups(names: tuple[str, ...], roles: Roles) -> dict[str, dict[str, list[int]]]:
    """Joints by figure and label: both legs joint by joint, waist joints likewise, arms and head together."""
    legs = {side: leg(names, roles, side) for side in FOOT_NAMES}
    drawn = {f"{side} leg": {_short(names[i], side): [i] for i in joints} for side, joints in legs.items()}
    upper: dict[str, list[int]] = {}
    for index, name in enumerate(names):
        if not any(index in joints for joints in legs.values()):
            alone = not side_of(name) and len(upper) < _MOST - 1 and not re.search("neck|head", name)
            upper.setdefault(_short(name, "") if alone else "arms and head, largest", []).append(index)
    return {**drawn, "upper body": upper}


def _roles(view: LogView) -> Roles:
    """The roles that the log tells, if any."""
    try:
        roles = view.constant("roles")
    except MissingError:
        return {}
    return roles if isinstance(roles, dict) else {}


def _torques(view: LogView) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    torque = view.field("/torque", "command", -1)
    names, limit = _by_joint(view, "torque_limit", "a torque limit for each joint")
    return names, _over(torque, limit)


def _angles(view: LogView) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    """0 in the middle of the range, ±100 at its ends."""
    angle = view.field("/measurement", "joint_position", -1)
    names, lower = _by_joint(view, "position_lower", "a range for each joint")
    _, upper = _by_joint(view, "position_upper", "a range for each joint")
    return names, _over(angle, (upper - lower) / 2, (upper + lower) / 2)


def _speeds(view: LogView) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    speed = view.field("/measurement", "joint_velocity", -1)
    names, limit = _by_joint(view, "velocity_limit", "a speed limit for each joint")
    return names, _over(speed, limit)


def _by_joint(view: LogView, constant: str, what: str) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    """Names of the joints and a constant of each, shape (nj,)."""
    names, values = view.constant("joint_names"), view.constant(constant)
    sound = isinstance(names, list) and isinstance(values, list) and len(names) == len(values)
    if not sound or not all(isinstance(value, int | float) for value in values):
        raise MissingError(what)
    return tuple(map(str, names)), np.array(values, float)


def _over(
    values: NDArray[np.float64], half: NDArray[np.float64], middle: NDArray[np.float64] | float = 0.0
) -> NDArray[np.float64]:
    """Distance from the middle in percent of what is allowed, shape (n, nj)."""
    if values.shape[1:] != half.shape:
        raise MissingError("a limit for each joint")
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(100.0 * (values - middle) / half)


def _group(
    axes: Axes,
    time: NDArray[np.float64],
    percent: NDArray[np.float64],
    members: dict[str, list[int]],
) -> None:
    """Draw each label's joint, of several the largest size, and say which is the largest of all."""
    if not members:
        raise MissingError("such joints")
    peaks = {}
    for number, (label, joints) in enumerate(members.items()):
        chosen = np.nan_to_num(percent[:, joints])
        color = GREY if len(joints) > 1 else CYCLE[number % len(CYCLE)]
        values = np.abs(chosen).max(axis=1) if len(joints) > 1 else chosen[:, 0]
        peaks[label] = float(np.abs(values).max())
        curve(axes, time, values, label, color, linewidth=0.9)
    worst = max(peaks, key=lambda label: peaks[label])
    text = f"largest: {worst.removesuffix(', largest')} {peaks[worst]:.0f} %"
    axes.text(0.995, 0.03, text, transform=axes.transAxes, ha="right", va="bottom", fontsize=7, bbox=_PLATE)


def _limits(percent: NDArray[np.float64]) -> tuple[float, float]:
    """The same range for all groups; the limits come into sight when a torque comes near them."""
    largest = max(20.0, float(np.max(np.abs(percent), initial=0.0, where=np.isfinite(percent))))
    return -1.2 * largest, 1.2 * largest


def _short(name: str, side: str) -> str:
    words = [word for word in name.split("_") if word not in (side, "joint", "leg")]
    return " ".join(words) or name


Array = NDArray[np.float64]

SOLVER_TITLE = "Solvers and wall-clock times"
_EVENTS = (
    ("/plan", "status", "planner QP unsolved"),
    ("/plan", "held", "plan held"),
    ("/wbc", "solver", "WBC second solver"),
    ("/wbc", "fallback", "WBC fallback"),
)
_PARTS = ("tick", "planner", "physics", "wbc_build", "wbc_solve", "state", "log")
_STRETCHES = 150
"""Stretches of time of which the median and the greatest are drawn."""


def draw_solver(area: Area, view: LogView, background: Background) -> None:
    """Draw iterations, what went wrong and when, and the time of each part."""
    iterations, events, timing = axes = time_axes(area, view, SOLVER_TITLE, (0.7, 0.9, 1.6))
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
