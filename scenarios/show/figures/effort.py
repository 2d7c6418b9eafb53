"""Figures of effort: joints against their limits, solvers and computing time."""

import re
from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from surefoot.scenarios.judge.body import Roles, leg, side_of
from surefoot.scenarios.palette import BLACK, BLUE, GREY, VERMILION
from surefoot.scenarios.show.kit.figures import CYCLE, Area, curve, legend
from surefoot.scenarios.show.kit.shading import Background, Panel, draw_panels
from surefoot.scenarios.show.logview import FOOT_NAMES, LogView, MissingError

Array = NDArray[np.float64]

Percent = tuple[tuple[str, ...], Array]
"""Names of joints, and of each how much of what is allowed it uses, signed, shape (n, nj) [%]."""

_MOST = 6
"""Joints of a group drawn one by one; a larger group is drawn by its largest ratio."""

_PLATE = {"facecolor": "white", "alpha": 0.75, "linewidth": 0, "pad": 1.0}


def draw_torques(area: Area, view: LogView, behind: Background) -> None:
    """Draw torque over limit, signed, in three groups of joints on one scale."""
    _draw_groups(area, view, behind, "Joint torques in percent of their limits", "/torque", torques)


def draw_joints(area: Area, view: LogView, behind: Background) -> None:
    """Draw angles within their range, beside them speeds over their limits."""
    left, right = area.subfigures(1, 2, squeeze=False)[0]
    _draw_groups(left, view, behind, "Joint angles in percent of half their range", "/measurement", angles)
    _draw_groups(right, view, behind, "Joint speeds in percent of their limits", "/measurement", speeds)


def torques(view: LogView) -> Percent:
    """Commanded torques over their limits."""
    torque = view.field("/torque", "command", -1)
    names, (limit,) = _by_joint(view, "a torque limit for each joint", "torque_limit")
    return names, _over(torque, limit)


def angles(view: LogView) -> Percent:
    """Measured angles: 0 in the middle of the range, ±100 at its ends."""
    angle = view.field("/measurement", "joint_position", -1)
    names, (lower, upper) = _by_joint(view, "a range for each joint", "position_lower", "position_upper")
    return names, _over(angle, (upper - lower) / 2, (upper + lower) / 2)


def speeds(view: LogView) -> Percent:
    """Measured speeds over their limits."""
    speed = view.field("/measurement", "joint_velocity", -1)
    names, (limit,) = _by_joint(view, "a speed limit for each joint", "velocity_limit")
    return names, _over(speed, limit)


def _by_joint(view: LogView, what: str, *constants: str) -> tuple[tuple[str, ...], list[Array]]:
    """Names of the joints and some constants of each, shape (nj,); what they are, to be said where they are not."""
    names, found = view.constant("joint_names"), [view.constant(constant) for constant in constants]
    for values in found:
        sound = isinstance(names, list) and isinstance(values, list) and len(names) == len(values)
        if not sound or not all(isinstance(value, int | float) for value in values):
            raise MissingError(what)
    return tuple(map(str, names)), [np.array(values, float) for values in found]


def _over(values: Array, half: Array, middle: Array | float = 0.0) -> Array:
    """Distance from the middle in percent of what is allowed, shape (n, nj)."""
    if values.shape[1:] != half.shape:
        raise MissingError("a limit for each joint")
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(100.0 * (values - middle) / half)


def _draw_groups(
    area: Area, view: LogView, behind: Background, title: str, topic: str, percent_of: Callable[[LogView], Percent]
) -> None:
    """Draw percent of a limit, signed, in three groups of joints on one scale."""
    panels = [
        Panel(f"{name} [%]", partial(_group, name=name, topic=topic, percent_of=percent_of))
        for name in ("left leg", "right leg", "upper body")
    ]
    axes = draw_panels(area, view, behind, title, panels)
    left, right, upper = axes
    same = left.get_legend_handles_labels()[1] == right.get_legend_handles_labels()[1]
    for one in (left, upper) if same else (left, right, upper):
        legend(one, 6 if same else 4)
    peaks = [_peaks(one) for one in axes]
    # The same range for all groups; the limits come into sight when a torque comes near them.
    largest = max([20.0, *(peak for group in peaks for peak in group.values())])
    for one, group in zip(axes, peaks, strict=True):
        if group:
            worst = max(group, key=lambda label: group[label])
            text = f"largest: {worst.removesuffix(', largest')} {group[worst]:.0f} %"
            one.text(0.995, 0.03, text, transform=one.transAxes, ha="right", va="bottom", fontsize=7, bbox=_PLATE)
            one.set_ylim(-1.2 * largest, 1.2 * largest)
            for limit in (-100.0, 100.0):
                one.axhline(limit, color=BLACK, linewidth=0.9, linestyle="--")


def _group(axes: Axes, view: LogView, name: str, topic: str, percent_of: Callable[[LogView], Percent]) -> None:
    """Draw each label's joint, of several the largest size."""
    names, percent = percent_of(view)
    members = groups(names, _roles(view))[name]
    if not members:
        raise MissingError("such joints")
    for number, (label, joints) in enumerate(members.items()):
        chosen = np.nan_to_num(percent[:, joints], posinf=np.nan, neginf=np.nan)
        color = GREY if len(joints) > 1 else CYCLE[number % len(CYCLE)]
        values = np.abs(chosen).max(axis=1) if len(joints) > 1 else chosen[:, 0]
        curve(axes, view.time(topic), values, label, color, linewidth=0.9)


def _peaks(axes: Axes) -> dict[str, float]:
    """Largest size of the curves in axes by their labels, those drawn in parts together; thinning keeps extremes."""
    found: dict[str, float] = {}
    for line in axes.lines:
        label = str(line.get_label()).removeprefix("_")
        if label.startswith("child"):  # no curve, but what stands behind them
            continue
        values = np.abs(np.asarray(line.get_ydata(), float))
        found[label] = max(found.get(label, 0.0), float(np.nanmax(values, initial=0.0)))
    return found


def groups(names: tuple[str, ...], roles: Roles) -> dict[str, dict[str, list[int]]]:
    """Joints by figure and label: legs and waist joint by joint, arms and head together."""
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


def _short(name: str, side: str) -> str:
    words = [word for word in name.split("_") if word not in (side, "joint", "leg")]
    return " ".join(words) or name


_EVENTS = (
    ("/plan", "status", "planner QP unsolved"),
    ("/plan", "held", "plan held"),
    ("/wbc", "solver", "WBC second solver"),
    ("/wbc", "fallback", "WBC fallback"),
)

_PARTS = ("tick", "planner", "physics", "wbc_build", "wbc_solve", "state", "log")
"""Fields of ``/timing`` that are drawn."""

_STRETCHES = 150
"""Stretches of time of which the median and the greatest are drawn."""


def draw_solver(area: Area, view: LogView, behind: Background) -> None:
    """Draw iterations, what went wrong and when, and the time of each part."""
    panels = (
        Panel("iterations [-]", _iterations, columns=1, height=0.7),
        Panel("", _events, height=0.9, in_parts=False),
        Panel("time per tick [µs]", _timing, columns=4, height=1.6, in_parts=False),
    )
    draw_panels(area, view, behind, "Solvers and wall-clock times", panels)


def _iterations(axes: Axes, view: LogView) -> None:
    curve(axes, view.time("/wbc"), view.field("/wbc", "iterations"), "WBC QP", BLUE, linewidth=0.7)
    axes.set_ylim(bottom=0)


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
        name = "new plan" if part == "planner" else part.replace("_", " ").replace("wbc", "WBC")
        label = f"{name}: median {np.median(values[values > 0]):.0f} µs"
        axes.plot(middle, median, color=color, label=label, linewidth=1.3 if part == "tick" else 1.0)
        if part == "tick":
            axes.plot(middle, greatest, ".", color=GREY, markersize=2.5, label="tick: greatest of each stretch")
    try:
        period = 1e6 / view.number("control_rate")
    except MissingError:
        return
    axes.axhline(period, color=BLACK, linestyle="--", linewidth=0.9, label=f"control period {period:.0f} µs")


def _planned(view: LogView, time: Array) -> NDArray[np.bool_]:
    """Ticks with a new plan, as far as the log tells; the others only sample the last one."""
    try:
        return np.isin(time, view.time("/plan"))
    except MissingError:
        return np.ones(len(time), dtype=np.bool_)


def stretch_extremes(time: Array, values: Array, count: int = _STRETCHES) -> tuple[Array, Array, Array]:
    """Middle time, median and greatest value of stretches of equally many positive samples, shape (k,) each."""
    positive = np.flatnonzero(values > 0)
    parts = [part for part in np.array_split(positive, min(count, max(len(positive), 1))) if len(part)]
    middle = np.array([time[part].mean() for part in parts])
    return middle, np.array([np.median(values[part]) for part in parts]), np.array([values[p].max() for p in parts])
