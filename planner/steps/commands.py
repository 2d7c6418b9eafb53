"""The commands of an operator, turned into strides: a velocity over time, or explicit footsteps."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.steps.gait import WEIGHT_SHIFT, Bout, GaitParameters
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import Array, Foot, Footstep, Twist

MOST_STEPS = 100_000
"""Steps of a walk, which are laid out in memory before it starts [-]."""

_SAME_TIME = 1e-6
"""Times are sums of durations and carry rounding [s]."""

_HALVINGS = 40
"""Halvings of a range in which the fastest velocity is sought, after which rounding is greater [-]."""

STANDING = Twist()


@dataclass(frozen=True, slots=True)
class Command:
    """A command to a walk, or the part of it that the walk follows; what is None stays as it is, or is not.

    Attributes:
        twist: the velocity to follow from now on; zero stands.
        places: where to go now, one after another in the world frame, to stand at the last one.
        single_support: duration from now on [s].
        double_support: duration from now on [s].
        swing_height: clearance of the steps to come [m].
        time: when the walk hears of it [s].
        followed: of what a walk does, the velocity that is followed in place of `twist`, whose steps are in reach.
        march: whether the walk steps in place where `twist` is zero, in place of standing.

    Raises:
        ParameterError: a value is not finite, a duration or the height is not positive, or the time is negative.
    """

    twist: Twist | None = None
    places: tuple[Twist, ...] | None = None
    single_support: float | None = None
    double_support: float | None = None
    swing_height: float | None = None
    time: float = 0.0
    followed: Twist | None = None
    march: bool = False

    def __post_init__(self) -> None:
        numbers = [("time", self.time), *(self.twist or STANDING).velocity.items()]
        numbers += [(name, getattr(place, name)) for place in self.places or () for name in ("x", "y", "yaw")]
        positive = [(name, getattr(self, name)) for name in ("single_support", "double_support", "swing_height")]
        for name, value in numbers:
            if not math.isfinite(value):
                raise ParameterError(("command", name), f"a command's {name} is {value:g}", "it must be finite")
        if self.time < 0.0:
            raise ParameterError(("command", "time"), f"a command's time is {self.time:g}", "it must not be negative")
        for name, value in positive:
            if value is not None and not 0.0 < value < math.inf:
                what = f"a command's {name} is {value:g}"
                raise ParameterError(("command", name), what, "it must be finite and greater than 0")

    @classmethod
    def of(
        cls, v_x: float | None = None, v_y: float | None = None, yaw_rate: float | None = None, **more: Any
    ) -> "Command":
        """A command in the words of a scenario's `commands`; of a velocity that is given in part, the rest is zero.

        Args:
            v_x: forward velocity [m/s].
            v_y: to the left [m/s].
            yaw_rate: of the heading, positive to the left [rad/s].
            more: other attributes by name.
        """
        velocity, march = (v_x, v_y, yaw_rate), bool(more.pop("march", None))
        moves = march or velocity != (None, None, None)
        return cls(Twist(*(value or 0.0 for value in velocity)) if moves else None, march=march, **more)


def velocity_bouts(commands: Sequence[Command], gait: GaitParameters) -> tuple[Bout, ...]:
    """The bouts of a walk that follows velocities over time, each from its command to the next one.

    The velocity in force when a foot lifts off gives the stride of that step. If it is zero then, the step closes the
    stance and the robot stands until it is to move. Its weight shift begins then (not before `gait.initial_stand`), and
    the first foot lifts off `WEIGHT_SHIFT` double supports later. A velocity that has gone by then moves nothing.
    Before the first command the robot stands.

    Args:
        commands: the velocities with their times.
        gait: gives durations and step width.

    Raises:
        ParameterError: there is no command, the times do not increase, the last command does not stop, or the walk has
            too many steps.
    """
    times, twists = [command.time for command in commands], [command.twist or STANDING for command in commands]
    for index, (before, after) in enumerate(pairwise(times), start=1):
        if after <= before:
            what = f"the velocity command at {after:g} s comes after the one at {before:g} s"
            raise ParameterError(("velocity", index, "time"), what, "their times must increase")
    if not commands or not twists[-1].is_zero:
        what = "the velocity commands end in motion" if commands else "there are no velocity commands"
        key = ("velocity", len(commands) - 1) if commands else ("velocity",)
        raise ParameterError(key, what, "the last one must be zero, which stops the walk")
    period = gait.period
    if times[-1] / period > MOST_STEPS:
        what = f"the velocity command lasts {times[-1]:g} s"
        raise ParameterError(("velocity",), what, f"{MOST_STEPS * period:g} s is the most")

    def in_force(time: float) -> Twist:
        index = bisect_right(times, time + _SAME_TIME) - 1
        return twists[index] if index >= 0 else STANDING

    def next_motion(time: float) -> float | None:
        """The first instant from `time` on at which the walk is to move, None if there is none [s]."""
        if not in_force(time).is_zero:
            return time
        following = zip(times, twists, strict=True)
        return next((begin for begin, twist in following if begin > time and not twist.is_zero), None)

    bouts: list[Bout] = []
    standing_since, ready = 0.0, gait.initial_stand
    while (start := next_motion(ready)) is not None:
        lift_off = start + WEIGHT_SHIFT * gait.double_support
        strides: list[Twist] = []
        while not (twist := in_force(lift_off)).is_zero:
            strides.append(twist.stride(period, gait.step_width))
            lift_off += period
        ready = lift_off
        if strides:
            strides.append(Twist(width=gait.step_width))
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
    strides: list[Twist] = []
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
    stride = bouts[0].strides[0] if bouts else STANDING
    return Foot.RIGHT if (stride.y, stride.yaw) < (0.0, 0.0) else Foot.LEFT


def fitted(gait: GaitParameters, region: StepRegion) -> GaitParameters:
    """The gait with the widths of its bouts' strides fitted to a region."""
    bouts = tuple(replace(bout, strides=tuple(map(region.fitted, bout.strides))) for bout in gait.bouts)
    return replace(gait, bouts=bouts)


def fastest(twist: Twist, duration: float, width: float, region: StepRegion) -> Twist:
    """The velocity of the same direction, at most as fast, whose steps of a duration [s] are just within a region.

    They are as near to the nominal width as the region lets them be [m].
    """

    def inside(factor: float) -> bool:
        return region.admits(region.fitted(twist.scaled(factor).stride(duration, width)))

    if inside(1.0):
        return twist
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if inside(middle) else (low, middle)
    return twist.scaled(low)


def _half_width(gait: GaitParameters, foot: Foot) -> Array:
    return np.array([0.0, 0.5 * gait.step_width * foot.side])


def _stride_to(footstep: Footstep, stance: Array, yaw: float, gait: GaitParameters) -> Twist:
    """The stride of the gait's width that lands at a footstep from a stance foot, shape (2,) [m], of a heading."""
    side = _half_width(gait, footstep.foot)
    before = stance + frame_rotation(yaw) @ side
    after = footstep.position[:2] - frame_rotation(footstep.yaw) @ side
    length, lateral = (after - before) @ frame_rotation(0.5 * (yaw + footstep.yaw))
    return Twist(float(length), float(lateral), footstep.yaw - yaw, gait.step_width)
