"""The source of a walk's steps: it makes one after another, when the schedule asks for the next."""

import math
from typing import Protocol

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation, wrap_angle
from surefoot.planner.steps.commands import MOST_STEPS, STANDING, fastest
from surefoot.planner.steps.footsteps import Path
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import Array, Twist
from surefoot.similarity import REFERENCE_SIZE, Similarity


class StepSource(Protocol):
    """Gives the steps of a walk one by one."""

    def order(self, step: int, before: Twist | None, here: Twist, period: float) -> tuple[Twist, float] | None:
        """The next step.

        Args:
            step: its number, from 1; steps that were inserted between those of the source do not count.
            before: stride of the step before it; None when the robot stands.
            here: where the path is that the footsteps in sight go along, landed ones as measured.
            period: time from one lift-off to the next [s].

        Returns:
            Its stride, and the standing before the weight shift to it, which of a step that follows
            another without a stop says nothing [s]; None to stand, in a walk until the next bout, in standing as far as
            is known for ever.
        """


class GaitSource:
    """The steps of a gait."""

    def __init__(self, gait: GaitParameters) -> None:
        self._strides, self._begins = gait.strides, gait.begins

    def order(self, step: int, before: Twist | None, here: Twist, period: float) -> tuple[Twist, float] | None:
        """See `StepSource`."""
        if step > len(self._strides) or (before is not None and step in self._begins):
            return None
        return self._strides[step - 1], self._begins.get(step, 0.0)


_SOFTLY = 0.4
"""Most by which a stride is longer than the one before it, as a share of the reach [-]."""

_SHARE = 0.6
"""Most by which it turns more, as a share of the greatest; and what of both a walk to a place makes use of [-]."""

_THERE = 0.002
"""Distance from a place at which a walk to it is over, of the reference robot [m], or in heading [rad]."""

AWAY = 0.008
"""Distance from it at which a robot that stands there goes on, of the reference robot [m], or in heading [rad]."""

_ASTRAY = 1.0
"""Bearing of a place from which on the robot first turns towards it on the spot [rad]."""

_FAR = 3.0
"""Strides to a place from which on the robot walks ahead towards it, and not as it will stand there [-]."""


class CommandSource:
    """Steps that follow a velocity, or go to places one after another; either may be commanded anew at any time.

    A command out of reach is bent to the nearest one in reach. A velocity becomes the fastest in its direction whose
    steps are within reach. A stride is only a little longer than the one before it, and leads no other way.

    Args:
        gait: gives the step width, the stride of a walk to a place, and the rest before the first step.
        region: where feet may land.
        twist: the velocity to follow where there are no places to go to; an attribute.
        places: where to go, in order; an attribute.
        size: of the robot.
        march: whether it steps in place where the velocity is zero; an attribute.
    """

    def __init__(
        self,
        gait: GaitParameters,
        region: StepRegion,
        twist: Twist = STANDING,
        places: tuple[Twist, ...] = (),
        size: Similarity = REFERENCE_SIZE,
        march: bool = False,
    ) -> None:
        self.march = march and not places
        self._width, self._rest, self._region = gait.step_width, gait.initial_stand, region
        side = 0.5 * (region.width[1] - region.nearest(0.0))
        self._change = np.array([_SOFTLY * region.length, side, _SHARE * region.turn])
        self._most = np.array([min(abs(gait.step_length), region.length), _SHARE * side, _SHARE * region.turn])
        self.twist, self.places, self._length = twist, places, size.length
        self._reached: dict[int, int] = {}

    def followed(self, period: float) -> Twist:
        """The velocity that is followed for the one asked for, with so much time from one lift-off to the next [s]."""
        return fastest(self.twist, period, self._width, self._region)

    def order(self, step: int, before: Twist | None, here: Twist, period: float) -> tuple[Twist, float] | None:
        """See `StepSource`."""
        near = AWAY if before is None else _THERE
        last = np.array((before or STANDING)[:3])
        if self.places:
            wanted = self._onward(step, here, near)
        else:
            wanted = np.array(self.followed(period).stride(period, self._width)[:3])
        # It may stop at once, but neither turn round nor speed up by much in a step.
        backward = np.where(last > 0.0, 0.0, last - self._change)
        forward = np.where(last < 0.0, 0.0, last + self._change)
        way = np.clip(wanted, backward, forward)
        if not way.any() and not last.any() and not self.march:
            return None
        return self._admitted(way), self._rest if step == 1 else 0.0

    def _onward(self, step: int, here: Twist, near: float) -> Array:
        """Way of the stride to the next place, zero at the last one, shape (3,) [m, m, rad]."""
        # How many places were reached before which step: a step may be asked for anew.
        self._reached = {earlier: count for earlier, count in self._reached.items() if earlier < step}
        reached = max(self._reached.values(), default=0)
        while (way := self._towards(self.places[reached], here, near)) is None:
            if reached == len(self.places) - 1:
                return np.zeros(3)
            reached += 1
            self._reached[step] = reached
        return way

    def _towards(self, place: Twist, here: Twist, near: float) -> Array | None:
        """The stride to a place; None for one that is reached.

        Far from it the robot walks ahead, turning to it. Near to it it takes the fewest equal strides on the arc on
        which it arrives with the heading asked for.
        """
        way = np.array([place.x - here.x, place.y - here.y])
        turn, distance = wrap_angle(place.yaw - here.yaw), float(np.hypot(*way))
        if max(distance / self._length, abs(turn)) <= near:
            return None
        ahead, _, most_turn = self._most
        if distance > _FAR * ahead:
            bearing = wrap_angle(math.atan2(way[1], way[0]) - here.yaw)
            turn = float(np.clip(bearing, -most_turn, most_turn))
            return np.array([ahead * math.cos(bearing - 0.5 * turn) if abs(bearing) < _ASTRAY else 0.0, 0.0, turn])
        way = way @ frame_rotation(here.yaw + 0.5 * turn)
        for count in range(1, _MOST_EQUAL + 1):
            # Equal strides on an arc: their chords add up to the way.
            share = math.sin(0.5 * turn / count) / math.sin(0.5 * turn) if abs(turn) > _STRAIGHT else 1.0 / count
            stride = np.array([*(share * way), turn / count])
            if (np.abs(stride) <= self._most).all():
                break
        return stride

    def _admitted(self, way: Array) -> Twist:
        """The longest stride this way that both feet may make."""
        factor, stride = 1.0, self._stride(way)
        while not self._region.admits(stride) and factor > 0.0:
            factor = max(factor - _LESS, 0.0)
            stride = self._stride(factor * way)
        return stride

    def _stride(self, way: Array) -> Twist:
        return self._region.fitted(Twist(float(way[0]), float(way[1]), float(way[2]), self._width))


def steps_ordered(source: StepSource, gait: GaitParameters, start: Twist, most: int = MOST_STEPS) -> int:
    """Steps that a source orders until the robot stands where every one of them lands where it is nominally.

    Args:
        source: of the steps, which may have been used up then.
        gait: gives the durations and the first foot.
        start: where the walk begins.
        most: count no further.
    """
    path, before = Path(np.array(start[:2]), start.yaw, 0.0, gait.step_width), None
    for step in range(1, most + 1):
        here = Twist(float(path.middle[0]), float(path.middle[1]), path.yaw)
        order = source.order(step, before, here, gait.period)
        if order is None:
            return step - 1
        before, _ = order
        path, _ = path.advanced(before, gait.step_foot(step))
    return most


_MOST_EQUAL = 1000
"""Equal strides of which no more make sense: feet that wide cannot step sideways at all [-]."""

_STRAIGHT = 1e-6
"""Turn below which an arc is a line [rad]."""

_LESS = 0.05
"""Steps in which a stride is shortened until feet may make it [-]."""
