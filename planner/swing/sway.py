"""Angles that sway: each goes from where it is to its next extreme and comes to rest there, by one quintic."""

import math
from dataclasses import dataclass

from surefoot.maths.algebra import Vector
from surefoot.planner.geometry import quintic

_SAME_ANGLE, _SAME_TIME = 1e-6, 1e-3
"""Differences of an extreme, and of its time on the reference robot, that are not worth another motion [rad, s]."""

SOONEST = 0.1
"""Least time of a motion that is to come to another extreme, on the reference robot [s]."""


@dataclass(frozen=True)
class Sway:
    """An angle on its way to its next extreme, where it comes to rest: one quintic, twice continuously differentiable.

    Attributes:
        start: when it set out [s].
        end: when it is there [s].
        target: the extreme [rad].
        course: coefficients of the angle by the time since it set out, of 1, t, ..., t^5 [rad, rad/s, ...].
    """

    start: float
    end: float
    target: float
    course: quintic.Quintic

    def evaluate(self, time: float) -> Vector:
        """The angle, its rate and its acceleration at a time [rad, rad/s, rad/s^2]."""
        if time >= self.end:
            return self.target, 0.0, 0.0
        t = time - self.start
        return quintic.value(self.course, t), quintic.slope(self.course, t), quintic.bend(self.course, t)

    def towards(self, target: float, time: float, end: float, soonest: float) -> "Sway":
        """The angle that goes from where it is at a time [s] to an extreme [rad], without any jump.

        Args:
            target: the extreme [rad].
            time: now [s].
            end: when it is to be there, infinite for whenever it can [s].
            soonest: least time that it takes to another one [s].

        Returns:
            Itself, where it goes there already.
        """
        same = abs(target - self.target) <= _SAME_ANGLE
        if math.isinf(end):
            end = self.end if same else time
        later = abs(end - self.end) > _SAME_TIME * soonest / SOONEST and time < self.end
        if same and not later:
            return self
        state = self.evaluate(time)
        lasting = max(end - time, min(soonest, self.end - time) if same else soonest)
        return Sway(time, time + lasting, target, quintic.between(state, (target, 0.0, 0.0), lasting))


STILL = Sway(0.0, 0.0, 0.0, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
"""An angle that is zero."""


@dataclass(frozen=True)
class Pelvis:
    """The orientation of the pelvis against the heading of the feet.

    Attributes:
        yaw: how far it turns to the left.
        roll: how far its left side is up.
    """

    yaw: Sway = STILL
    roll: Sway = STILL
