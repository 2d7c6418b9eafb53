"""What a run is recognised by: its stages, and a handful of physical quantities in each.

A stage goes from one lift-off to the next. The first tick is one of its own: all runs of a scenario begin it in the
same state, so that what one does differently there is its controller's doing alone.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from surefoot.planner.types import GRAVITY
from surefoot.scenarios.judge.body import headings, leg
from surefoot.scenarios.judge.digest import Array, RunView
from surefoot.scenarios.judge.walking import runs_of

FEET = ("left", "right")

LOADED = 0.05
"""Share of the weight from which a foot's forces are looked at [-]."""

LONGEST_LAG = 10
"""Lags that are tried [ticks]."""

ALIKE = 0.5
"""Share of the planned changes, squared, that may be left of them when the measured ones are taken off [-]."""

LEAST_CHANGE = 0.01
"""Change of the planned forces from tick to tick, RMS, below which no lag can be told [N]."""


@dataclass(frozen=True, slots=True)
class Stage:
    """A stretch of a run.

    Attributes:
        label: its name: first tick, stand, step 1 and so on.
        begin: its first tick.
        end: the tick after its last.
        foot: that swings: 0 left, 1 right, -1 none.
        landed: tick at which its swing is over.
    """

    label: str
    begin: int
    end: int
    foot: int = -1
    landed: int = 0

    @property
    def ticks(self) -> slice:
        """All of it."""
        return slice(self.begin, self.end)


def stages(run: RunView) -> list[Stage]:
    """The stages of a run in order, none of them empty."""
    if not run.ticks:
        return []
    stance = run.field("/reference", "stance")
    swings = sorted((*swing, foot) for foot in (0, 1) for swing in runs_of(run.single_support & (stance == 1 - foot)))
    ends = [*(begin for begin, _, _ in swings), run.ticks]
    steps = [
        Stage(f"step {number}", begin, ends[number], foot, min(landed, run.ticks - 1))
        for number, (begin, landed, foot) in enumerate(swings, 1)
    ]
    return [one for one in (Stage("first tick", 0, 1), Stage("stand", 1, ends[0]), *steps) if one.end > one.begin]


@dataclass(frozen=True, slots=True)
class Sign:
    """Something that runs are told apart by, a number for each stage, or a place.

    Attributes:
        columns: names; three are the x, y and z of a place in the world.
        digits: behind the point.
        tolerance: how far two runs may be apart that count as the same, and share of the value beside it.
        shown: factor and unit in which a person is shown it.
        figure: of `surefoot plot` that shows it.
        words: what it is, of which foot and in which stage.
        measure: from a run and its stages to the values, shape (stages, columns); NaN where it means nothing.
        body: whether it is of joints and real feet, which a pendulum has not got.
        peak: whether it parts only above the greatest value of all stages.
    """

    columns: tuple[str, ...]
    digits: int
    tolerance: tuple[float, float]
    shown: tuple[float, str]
    figure: str
    words: str
    measure: Callable[[RunView, Sequence[Stage]], Array]
    body: bool = False
    peak: bool = False


def _times(run: RunView, parts: Sequence[Stage]) -> Array:
    return run.time[[one.begin for one in parts], None]


def _landings(run: RunView, parts: Sequence[Stage]) -> Array:
    """Where the soles truly were when their swings were over; none where none has swung."""
    rows = [np.full(3, np.nan) if one.foot < 0 else run.sole(one.foot)[one.landed, :3] for one in parts]
    return np.array(rows).reshape(-1, 3)


def _landing_yaw(run: RunView, parts: Sequence[Stage]) -> Array:
    poses = [run.sole(max(one.foot, 0))[one.landed if one.foot >= 0 else one.begin] for one in parts]
    return headings(np.array(poses).reshape(-1, 7)[:, 3:])[:, None]


def _swing_error(run: RunView, parts: Sequence[Stage]) -> Array:
    """Greatest distance of the swing sole in each stage from its reference."""
    planned, found = run.field("/reference", "swing_position"), np.full((len(parts), 1), np.nan)
    for row, one in enumerate(parts):
        swing = slice(one.begin, one.landed)
        if one.foot >= 0 and one.landed > one.begin:
            found[row] = np.linalg.norm(run.sole(one.foot)[swing, :3] - planned[swing], axis=1).max()
    return found


def _leg_torque(foot: int) -> Callable[[RunView, Sequence[Stage]], Array]:
    """Commanded torque of a leg's joints, RMS."""

    def measure(run: RunView, parts: Sequence[Stage]) -> Array:
        joints = leg(run.constants.joint_names, run.constants.roles, FEET[foot])
        squared = np.mean(run.field("/torque", "command")[:, joints] ** 2, axis=1)
        return np.array([[math.sqrt(np.mean(squared[one.ticks]))] for one in parts])

    return measure


def _friction(foot: int) -> Callable[[RunView, Sequence[Stage]], Array]:
    """Greatest force along the ground over the normal force that the controller plans, where the foot is loaded."""

    def measure(run: RunView, parts: Sequence[Stage]) -> Array:
        wrench = run.field("/wbc", f"wrench_{FEET[foot]}")
        loaded = wrench[:, 2] > LOADED * run.constants.mass * GRAVITY
        used = np.where(loaded, np.hypot(wrench[:, 0], wrench[:, 1]) / np.where(loaded, wrench[:, 2], 1.0), 0.0)
        return np.array([[used[one.ticks].max()] for one in parts])

    return measure


def _lag(run: RunView, parts: Sequence[Stage]) -> Array:
    """Time by which the measured normal forces follow the planned ones: where their changes differ least.

    Told while the robot shifts its weight before the first step; touchdowns shake the forces more than a lag does.
    """
    planned, felt = (
        np.diff(np.column_stack([run.field(topic, f"wrench_{side}")[:, 2] for side in FEET]), axis=0)
        for topic in ("/wbc", "/measurement")
    )
    found = np.full((len(parts), 1), np.nan)
    for row, one in enumerate(parts):
        asked, given = planned[one.ticks][:-LONGEST_LAG], felt[one.ticks]
        size = float(np.mean(asked**2)) if len(asked) > LONGEST_LAG else 0.0
        if one.foot < 0 and size > LEAST_CHANGE**2:
            apart = [np.mean((asked - given[lag : lag + len(asked)]) ** 2) for lag in range(LONGEST_LAG)]
            if min(apart) < ALIKE * size:
                found[row] = int(np.argmin(apart)) / run.constants.control_rate
    return found


def _zmp_error(run: RunView, parts: Sequence[Stage]) -> Array:
    """Greatest distance of the measured ZMP from the one that the footsteps define."""
    error = np.linalg.norm(run.field("/contact", "zmp")[:, :2] - run.field("/reference", "zmp_reference"), axis=1)
    return np.array([[np.max(error[one.ticks], initial=0.0, where=np.isfinite(error[one.ticks]))] for one in parts])


def _sway(run: RunView, parts: Sequence[Stage]) -> Array:
    """Greatest distance of the CoM along the ground from the one that the controller was asked for."""
    off = np.linalg.norm((run.field("/truth", "com") - run.field("/reference", "com"))[:, :2], axis=1)
    return np.array([[off[one.ticks].max()] for one in parts])


def _tilt(run: RunView, parts: Sequence[Stage]) -> Array:
    """Greatest angle of the torso from the vertical."""
    tilt = run.field("/truth", "torso_tilt")
    return np.array([[tilt[one.ticks].max()] for one in parts])


def _com(run: RunView, parts: Sequence[Stage]) -> Array:
    return run.field("/truth", "com")[[one.end - 1 for one in parts]]


_MM = (1e3, "mm")
_DEGREES = (180.0 / math.pi, "deg")
_GRIP = "largest force along the ground over normal force that the controller plans for the {side} foot {stage}"

SIGNS: tuple[Sign, ...] = (
    Sign(("time",), 3, (0.011, 0.0), (1.0, "s"), "feet", "begin of {label}", _times),
    Sign(
        ("lag",), 4, (1e-3, 0.0), (1e3, "ms"), "feet",
        "lag of the measured ground forces behind those that the controller plans {stage}", _lag, body=True,
    ),
    *(
        Sign((f"friction_{side}",), 3, (0.1, 0.0), (1.0, ""), "grip", _GRIP.replace("{side}", side),
             _friction(foot), body=True, peak=True)
        for foot, side in enumerate(FEET)
    ),
    Sign(
        ("sole_x", "sole_y", "sole_z"), 4, (1e-3, 0.0), _MM, "soles", "{foot} sole at touchdown of {label}", _landings
    ),
    Sign(
        ("sole_yaw",), 4, (5e-3, 0.0), _DEGREES, "top-view",
        "heading of the {foot} sole at touchdown of {label}", _landing_yaw,
    ),
    Sign(
        ("swing",), 5, (5e-5, 0.05), _MM, "feet",
        "swing task: largest distance of the {foot} sole from its reference {stage}", _swing_error,
    ),
    *(
        Sign((f"torque_{side}",), 2, (0.5, 0.02), (1.0, "N m"), "torques", f"torque of the {side} leg (RMS) {{stage}}",
             _leg_torque(foot), body=True)
        for foot, side in enumerate(FEET)
    ),
    Sign(
        ("zmp",), 4, (5e-3, 0.05), _MM, "balance", "largest distance of the ZMP from its reference {stage}", _zmp_error
    ),
    Sign(
        ("sway",), 5, (2e-4, 0.05), _MM, "balance",
        "balance: largest distance of the CoM along the ground from where the controller was to hold it {stage}", _sway,
    ),
    Sign(
        ("tilt",), 4, (2e-3, 0.05), _DEGREES, "balance", "largest tilt of the torso {stage}", _tilt, body=True,
    ),
    Sign(("com_x", "com_y", "com_z"), 4, (2e-3, 0.0), _MM, "balance", "CoM at the end of {label}", _com),
)  # fmt: skip
"""What is kept of a run; of those that part in the same stage, the first is nearest to the cause. Torques come late:
after the first tick they follow from how the robot moves."""

COLUMNS = tuple(column for sign in SIGNS for column in sign.columns)
