"""What an operator commands, turned into strides: a velocity over time, or explicit footsteps."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.geometry import frame_rotation
from surefoot.planner.steps.gait import WEIGHT_SHIFT, Bout, GaitParameters, Stride
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import Array, Foot, Footstep

MOST_STEPS = 100_000
"""Steps of a walk, which are laid out in memory before it starts [-]."""

_SAME_TIME = 1e-6
"""Times are sums of durations and carry rounding [s]."""

_HALVINGS = 40
"""Of a range in which the fastest velocity is sought, after which rounding is greater [-]."""


@dataclass(frozen=True, slots=True)
class Twist:
    """A commanded velocity in the frame of the path's heading.

    Attributes:
        v_x: forward [m/s].
        v_y: to the left [m/s].
        yaw_rate: of the heading, positive to the left [rad/s].
    """

    v_x: float = 0.0
    v_y: float = 0.0
    yaw_rate: float = 0.0

    @property
    def is_zero(self) -> bool:
        """Whether it asks to stand."""
        return self.v_x == 0.0 and self.v_y == 0.0 and self.yaw_rate == 0.0

    def scaled(self, factor: float) -> "Twist":
        """The same direction at another speed."""
        return Twist(factor * self.v_x, factor * self.v_y, factor * self.yaw_rate)

    def stride(self, duration: float, width: float) -> Stride:
        """The stride that follows this velocity exactly for a time, along its arc."""
        turn = self.yaw_rate * duration
        chord = duration * float(np.sinc(0.5 * turn / math.pi))
        return Stride(chord * self.v_x, chord * self.v_y, turn, width)


@dataclass(frozen=True, slots=True)
class VelocityCommand:
    """A velocity that holds from an instant until the next command.

    Attributes:
        time: instant [s].
        twist: the velocity.

    Raises:
        ParameterError: a value is not finite, or the time is negative.
    """

    time: float
    twist: Twist

    def __post_init__(self) -> None:
        values = {"time": self.time} | {field.name: getattr(self.twist, field.name) for field in fields(self.twist)}
        for name, value in values.items():
            key, what = ("velocity", name), f"{name} of a velocity command is {value:g}"
            if not math.isfinite(value):
                raise ParameterError(key, what, "it must be finite")
            if name == "time" and value < 0.0:
                raise ParameterError(key, what, "it must not be negative")


class Pose(NamedTuple):
    """A place on the ground with a heading, in the world frame.

    Attributes:
        x: [m].
        y: [m].
        yaw: [rad].
    """

    x: float
    y: float
    yaw: float


@dataclass(frozen=True, slots=True)
class Command:
    """What a walk is told while it goes on; what is None stays as it is.

    Attributes:
        twist: the velocity to follow from now on.
        places: where to go now, one after another, to stand at the last one.
        single_support: duration from now on [s].
        double_support: likewise [s].
        swing_height: clearance of the steps to come [m].

    Raises:
        ParameterError: a value is not finite, or a duration or the height is not positive.
    """

    twist: Twist | None = None
    places: tuple[Pose, ...] | None = None
    single_support: float | None = None
    double_support: float | None = None
    swing_height: float | None = None

    def __post_init__(self) -> None:
        twist, places = self.twist or Twist(), self.places or ()
        numbers = [(name, getattr(twist, name)) for name in ("v_x", "v_y", "yaw_rate")]
        numbers += [(name, getattr(place, name)) for place in places for name in Pose._fields]
        positive = [(name, getattr(self, name)) for name in ("single_support", "double_support", "swing_height")]
        for name, value in numbers:
            if not math.isfinite(value):
                raise ParameterError(("command", name), f"a command's {name} is {value:g}", "it must be finite")
        for name, value in positive:
            if value is not None and not 0.0 < value < math.inf:
                what = f"a command's {name} is {value:g}"
                raise ParameterError(("command", name), what, "it must be finite and greater than 0")


class TimedCommand(NamedTuple):
    """A command of which a walk hears at a time.

    Attributes:
        time: [s].
        command: what it is told.
    """

    time: float
    command: Command


@dataclass(frozen=True, slots=True)
class Orders:
    """What a walk does of what it has been told.

    Attributes:
        twist: the velocity asked for; None while none is.
        followed: the one that is followed in its place, whose steps are in reach; likewise.
        place: where it goes to stand; None while it goes to none.
        single_support: duration of the steps to come [s].
        double_support: likewise [s].
        swing_height: their clearance [m].
    """

    twist: Twist | None
    followed: Twist | None
    place: Pose | None
    single_support: float
    double_support: float
    swing_height: float


class VelocityTimeline:
    """Velocity commands over time; before the first one the robot stands.

    Raises:
        ParameterError: there is no command, the times do not increase, or the last command does not stop.
    """

    def __init__(self, commands: Sequence[VelocityCommand]) -> None:
        self._times = [command.time for command in commands]
        self._twists = [command.twist for command in commands]
        for index, (before, after) in enumerate(zip(self._times, self._times[1:], strict=False), start=1):
            if after <= before:
                what = f"the velocity command at {after:g} s comes after the one at {before:g} s"
                raise ParameterError(("velocity", index, "time"), what, "their times must increase")
        if not commands or not self._twists[-1].is_zero:
            what = "the velocity commands end in motion" if commands else "there are no velocity commands"
            key = ("velocity", len(commands) - 1) if commands else ("velocity",)
            raise ParameterError(key, what, "the last one must be zero, which stops the walk")

    @property
    def end(self) -> float:
        """Instant from which on the command is to stand [s]."""
        return self._times[-1]

    def at(self, time: float) -> Twist:
        """The command in force."""
        index = bisect_right(self._times, time + _SAME_TIME) - 1
        return self._twists[index] if index >= 0 else Twist()

    def next_motion(self, time: float) -> float | None:
        """The first instant from `time` on at which the command is to move, None if there is none [s]."""
        if not self.at(time).is_zero:
            return time
        following = zip(self._times, self._twists, strict=True)
        return next((begin for begin, twist in following if begin > time and not twist.is_zero), None)


def velocity_bouts(timeline: VelocityTimeline, gait: GaitParameters) -> tuple[Bout, ...]:
    """The bouts of a walk that follows a velocity command.

    The command in force when a foot lifts off gives the stride of that step. If it is zero then, the step closes the
    stance and the robot stands until the command is to move; its weight shift begins then (not before
    `gait.initial_stand`), and the first foot lifts off `WEIGHT_SHIFT` double supports later. A command that has gone
    by then moves nothing.

    Args:
        timeline: the command.
        gait: gives durations and step width.

    Raises:
        ParameterError: the walk has too many steps.
    """
    period = gait.period
    if timeline.end / period > MOST_STEPS:
        what = f"the velocity command lasts {timeline.end:g} s"
        raise ParameterError(("velocity",), what, f"{MOST_STEPS * period:g} s is the most")
    bouts: list[Bout] = []
    standing_since, ready = 0.0, gait.initial_stand
    while (start := timeline.next_motion(ready)) is not None:
        lift_off = start + WEIGHT_SHIFT * gait.double_support
        strides: list[Stride] = []
        while not (twist := timeline.at(lift_off)).is_zero:
            strides.append(twist.stride(period, gait.step_width))
            lift_off += period
        ready = lift_off
        if strides:
            strides.append(Twist().stride(period, gait.step_width))
            bouts.append(Bout(start - standing_since, tuple(strides)))
            standing_since = ready = lift_off + period
    return tuple(bouts)


def footstep_bouts(footsteps: Sequence[Footstep], gait: GaitParameters) -> tuple[Bout, ...]:
    """The one bout that takes given footsteps from a square stance about the origin, heading along x.

    Args:
        footsteps: in order; their heights do not matter.
        gait: gives the rest before and the width of the stance.

    Raises:
        ParameterError: there is no footstep, or the feet do not alternate.
    """
    if not footsteps:
        raise ParameterError(("footsteps",), "there are no footsteps", "a walk has at least one")
    strides: list[Stride] = []
    other = footsteps[0].foot.other
    place, yaw = -_half_width(gait, footsteps[0].foot), 0.0
    for number, footstep in enumerate(footsteps, 1):
        if footstep.foot is other.other:
            strides.append(_stride_to(footstep, place, yaw, gait))
            place, yaw, other = footstep.position[:2], footstep.yaw, footstep.foot
            continue
        what = f"footstep {number} moves the {other.name.lower()} foot again"
        raise ParameterError(("footsteps", number - 1), what, "the feet must alternate")
    return (Bout(gait.initial_stand, tuple(strides)),)


def walk_of(gait: GaitParameters, bouts: tuple[Bout, ...], first_foot: Foot) -> GaitParameters:
    """The gait with these bouts as its walk."""
    steps = sum(len(bout.strides) for bout in bouts)
    return replace(gait, bouts=bouts, steps=steps, first_foot=first_foot)


def leading_foot(bouts: tuple[Bout, ...]) -> Foot:
    """The foot on the side to which a walk first goes or turns, so that its first step does not close the stance."""
    stride = bouts[0].strides[0] if bouts else Stride(0.0, 0.0, 0.0, 1.0)
    return Foot.RIGHT if (stride.lateral, stride.turn) < (0.0, 0.0) else Foot.LEFT


def fitted(gait: GaitParameters, region: StepRegion) -> GaitParameters:
    """The gait with the widths of its bouts' strides fitted to a region."""
    bouts = tuple(replace(bout, strides=tuple(stride.fitted(region) for stride in bout.strides)) for bout in gait.bouts)
    return replace(gait, bouts=bouts)


def fastest(twist: Twist, duration: float, width: float, region: StepRegion) -> Twist:
    """The command of the same direction, at most as fast, whose steps are just within a region.

    Args:
        twist: the command.
        duration: of a step [s].
        width: nominal step width [m].
        region: where feet may land.
    """

    def inside(factor: float) -> bool:
        return twist.scaled(factor).stride(duration, width).fitted(region).within(region)

    if inside(1.0):
        return twist
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if inside(middle) else (low, middle)
    return twist.scaled(low)


def _half_width(gait: GaitParameters, foot: Foot) -> Array:
    return np.array([0.0, 0.5 * gait.step_width if foot is Foot.LEFT else -0.5 * gait.step_width])


def _stride_to(footstep: Footstep, stance: Array, yaw: float, gait: GaitParameters) -> Stride:
    """The stride of the gait's width that lands at a footstep from a stance foot, shape (2,) [m], of a heading."""
    side = _half_width(gait, footstep.foot)
    before = stance + frame_rotation(yaw) @ side
    after = footstep.position[:2] - frame_rotation(footstep.yaw) @ side
    length, lateral = (after - before) @ frame_rotation(0.5 * (yaw + footstep.yaw))
    return Stride(float(length), float(lateral), footstep.yaw - yaw, gait.step_width)
