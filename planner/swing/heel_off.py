"""Heel-off: at the end of its stance a foot rolls about its toe edge, and comes back level in its swing.

A rear foot that stays flat is what a long step runs out of: with the heel up the ankle comes forward and up, by 7 cm at
0.5 rad. The roll begins in double support, once the ZMP has left the foot behind: from then on the toe edge and the
front foot can carry it.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from surefoot.planner.geometry.orientation import roll_sole
from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.model.time_scaling import TimeScaling
from surefoot.planner.types import Array, Foot, Footstep

_BEGIN = 0.25
"""Share of the weight shift after which the heel leaves the ground [-]."""

_END = 0.7
"""Share of single support after which the foot is level again, before it comes down [-].

It turns back while its shank swings forward, so that the ankle has the less to do."""

LEVEL_AGAIN = 0.9
"""The same at most, of a swing that is shortened when its foot has begun to roll [-]."""

_LOOKED_AT = 9
"""Instants at which the acceleration of a roll is looked at, of a double support [-]."""

_LEAST_STEP = 1.5
"""Feet nearer to each other than so many half soles along the foot do not roll [-]."""


class RollSpan(NamedTuple):
    """The time and the angle of a foot's roll about its toe edge.

    Attributes:
        start: when it begins to [samples].
        end: when it is level again [samples].
        angle: its greatest pitch [rad].
    """

    start: float
    end: float
    angle: float


@dataclass(frozen=True)
class FootRoll:
    """Pitch of one foot about its toe edge over time; the heel is up where it is positive.

    θ = 64 A s³ (1 - s)³ between begin and end: twice continuously differentiable, and highest shortly after the foot
    has left the ground, as a person's.

    Attributes:
        foot: which.
        start: begin, by the clock of the gait [s].
        end: end, by the clock of the gait [s].
        angle: A, the greatest pitch [rad].
        toe: toe edge from the sole's centre [m].
        scaling: how that clock goes meanwhile; None where it goes as the time does.
        shown: what clock and time show at the instant of the scaling [s].
    """

    foot: Foot
    start: float
    end: float
    angle: float
    toe: float
    scaling: TimeScaling | None = None
    shown: float = 0.0

    def rolling(self, time: float) -> bool:
        """Return true if the foot is not level."""
        return self.start < self._clock(time)[0] < self.end

    def _clock(self, time: float) -> tuple[float, float, float]:
        """The clock of the gait [s], its rate [-] and the derivative of that [1/s]."""
        return (time, 1.0, 0.0) if self.scaling is None else self.scaling.seconds(self.shown, time)

    def evaluate(self, time: float) -> tuple[float, float, float]:
        """Pitch, its rate and its acceleration [rad, rad/s, rad/s^2]."""
        if self.scaling is None and not self.start < time < self.end:  # as it is at most ticks
            return 0.0, 0.0, 0.0
        span, (clock, rate, change) = self.end - self.start, self._clock(time)
        value, slope, bend = bump((clock - self.start) / span)
        speed = self.angle * slope / span
        return self.angle * value, speed * rate, self.angle * bend / (span * span) * (rate * rate) + speed * change

    def hardest(self, begin: float, end: float) -> float:
        """Greatest acceleration with which it lifts the sole's centre between two instants [m/s^2]."""
        return self.toe * max(abs(self.evaluate(time)[2]) for time in np.linspace(begin, end, _LOOKED_AT).tolist())

    def lifts_harder(self, most: float, begin: float, end: float) -> bool:
        """The sole's centre is lifted harder than this between two instants, in which the roll begins [m/s^2]."""
        return self.start >= begin and self.hardest(begin, end) > most

    def centre(self, time: float, level: Array, rates: Array) -> tuple[Array, Array]:
        """Place and velocity of the sole's centre, with the foot turned about its toe edge.

        Args:
            time: [s].
            level: pose of the sole as if it were level, x, y, z [m], yaw, pitch, roll [rad], shape (6,).
            rates: its rates, shape (6,) [m/s, rad/s].

        Returns:
            Position, shape (3,) [m], and velocity, shape (3,) [m/s], in the world frame.
        """
        (pitch, rate, _), centre, velocity = self.evaluate(time), np.empty(3), np.empty(3)
        pose, moving = np.asarray(level, dtype=np.float64), np.asarray(rates, dtype=np.float64)
        roll_sole(pose, moving, self.toe, pitch, rate, centre, velocity)
        return centre, velocity


def bump(s: float) -> tuple[float, float, float]:
    """64 s³ (1 - s)³ within 0 to 1, else zero, and its first and second derivative."""
    if not 0.0 < s < 1.0:
        return 0.0, 0.0, 0.0
    w, tilt = s * (1.0 - s), 1.0 - 2.0 * s
    return 64.0 * w * w * w, 192.0 * (w * w) * tilt, 384.0 * w * (tilt * tilt - w)


def stretched(ahead: float, radius: float, length: float = 1.0) -> float:
    """Pitch that a foot needs so far behind the other one that its leg is too short [rad].

    The other foot is ahead [m]; a sole reaches flat a radius from under its hip [m]; `length` is the robot's size [-].
    """
    return min(max(_PER_WAY / length * (ahead - _SHORT * radius), 0.0), _MOST)


_PER_WAY, _SHORT, _MOST = 3.0, 1.1, 0.5
"""Pitch for each metre beyond so many radii, and the greatest [rad/m, -, rad]: 7 cm of leg are 0.5 rad."""


def rolls(leaving: Footstep, stance: Footstep, half_length: float) -> bool:
    """Return true if a foot, half a sole's length given [m], leaves so far behind the other one that it rolls."""
    ahead = (stance.position - leaving.position)[:2] @ frame_rotation(stance.yaw)
    return bool(ahead[0] > _LEAST_STEP * half_length)


def roll_span(ramp: float, lift_off: float, single: float, angle: float) -> RollSpan:
    """The times of a foot's roll.

    Args:
        ramp: time that the weight takes to leave it, which ends as it leaves the ground [samples].
        lift_off: when it leaves the ground [samples].
        single: duration of its single support [samples].
        angle: greatest pitch [rad].
    """
    return RollSpan(lift_off - (1.0 - _BEGIN) * ramp, lift_off + _END * single, angle)
