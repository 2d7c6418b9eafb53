"""Rolling feet: a foot leaves the ground about its toe edge, and comes to it about its heel edge.

A rear foot that stays flat is what a long step runs out of: with the heel up the ankle comes forward and up, by 7 cm at
0.5 rad. Toe-off begins in double support, once the ZMP has left the foot behind: from then on the toe edge and the
front foot can carry it. The foot comes back level in its swing.

A front foot that lands flat is what a long step runs out of at its other end. At heel strike the toes are up: the heel
edge touches first, and the sole comes down over the double support.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from surefoot.planner.geometry.orientation import roll_sole
from surefoot.planner.geometry.plane import frame_rotation
from surefoot.planner.model.time_scaling import TimeScaling
from surefoot.planner.types import Array, Edge, Foot, Footstep

_BEGIN = 0.25
"""Share of the weight shift after which the heel leaves the ground at toe-off [-].

Where the front foot lands on its heel and ankles bear the robot on its toes it is none: at 0.8 m/s the rear leg is
straight then, and a heel that waits costs a tenth more energy."""

_END = 0.7
"""Share of single support after which the foot is level again after toe-off [-].

It turns back while its shank swings forward, so that the ankle has the less to do. Toes go up for heel strike in what
is left."""

LEVEL_AGAIN = 0.9
"""The same at most, of a swing that is shortened when its foot has begun to roll [-]."""

BRAKING, LEAD, SINKING = 10.5, 0.25, 0.18
"""The arrival of a foot that lands on its heel, see `SwingCourse` [-, -, m/s].

A foot that is ahead early is farther from its hip than its leg is long, which straightens the knee against its end
and pulls the body down. Then it waits for the ground while the hip comes nearer, and the knee bends until the foot
carries. With a braking of 12 walks take 3 % more energy. With 10 or less, knees that stretch as late unload the stance
foot at 1.4 m/s: both feet leave the ground for 2 ms as it comes to a stop. Beyond 20 a foot would go too far and come
back. One that sinks no faster than others then grazes the ground on its way, and slips by 6 mm at 1.4 m/s with 0.15 m/s
in place of 4. With 0.2 and more, walks on bent knees take 4 % more energy."""

_FLAT = 0.8
"""Share of double support after which the sole is flat on the ground after heel strike [-].

By then the ZMP goes on from the heel edge. A sole that comes down as long as the double support lasts holds it back: it
lands with 1.4 body weights in place of one."""

_LOOKED_AT = 9
"""Instants at which the acceleration of a roll is looked at, of a double support [-]."""

_LEAST_STEP = 1.5
"""Feet nearer to each other than so many half soles along the foot do not roll [-]."""


_SAME_WAY, _DECIMALS = 1e-6, 6
"""Ways below this are none, and decimals to which their shares are rounded, lest usual steps differ [m, -]."""


class RollSpan(NamedTuple):
    """The time and the angle of a foot's roll about an edge of its sole.

    Attributes:
        foot: which.
        start: when it begins to [samples].
        end: when it is level again [samples].
        angle: its greatest pitch, heel up positive, about the toe edge; negative about the heel edge [rad].
    """

    foot: Foot
    start: float
    end: float
    angle: float

    @property
    def edge(self) -> Edge:
        """The edge about which it turns."""
        return Edge.TOE if self.angle > 0.0 else Edge.HEEL


@dataclass(frozen=True)
class FootRoll:
    """Pitch of one foot about an edge of its sole over time; the heel is up where it is positive.

    θ = 64 A s³ (1 - s)³ between begin and end: twice continuously differentiable. At toe-off it is highest shortly
    after the foot has left the ground, as a person's; at heel strike as the foot touches it.

    Attributes:
        foot: which.
        start: begin, by the clock of the gait [s].
        end: end, by the clock of the gait [s].
        angle: A, the greatest pitch, negative about the heel edge [rad].
        pivot: the edge, ahead of the sole's centre; negative for the heel edge [m].
        scaling: how that clock goes meanwhile; None where it goes as the time does.
        shown: what clock and time show at the instant of the scaling [s].
    """

    foot: Foot
    start: float
    end: float
    angle: float
    pivot: float
    scaling: TimeScaling | None = None
    shown: float = 0.0

    @property
    def edge(self) -> Edge:
        """The edge about which it turns."""
        return Edge.TOE if self.pivot > 0.0 else Edge.HEEL

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
        return abs(self.pivot) * max(
            abs(self.evaluate(time)[2]) for time in np.linspace(begin, end, _LOOKED_AT).tolist()
        )

    def bearable(self, most: float, begin: float, end: float) -> float:
        """Share of its pitch with which it lifts the sole's centre no harder between two instants, in which it begins.

        Args:
            most: greatest acceleration [m/s^2].
            begin: one that rolls already by then stays as it is [s].
            end: of what is looked at [s].
        """
        hardest = self.hardest(begin, end) if self.start >= begin else 0.0
        return 1.0 if hardest <= most else most / hardest

    def centre(self, time: float, level: Array, rates: Array) -> tuple[Array, Array]:
        """Place and velocity of the sole's centre, with the foot turned about its edge.

        Args:
            time: [s].
            level: pose of the sole as if it were level, x, y, z [m], yaw, pitch, roll [rad], shape (6,).
            rates: its rates, shape (6,) [m/s, rad/s].

        Returns:
            Position, shape (3,) [m], and velocity, shape (3,) [m/s], in the world frame.
        """
        (pitch, rate, _), centre, velocity = self.evaluate(time), np.empty(3), np.empty(3)
        pose, moving = np.asarray(level, dtype=np.float64), np.asarray(rates, dtype=np.float64)
        roll_sole(pose, moving, self.pivot, pitch, rate, centre, velocity)
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


def strides(behind: Footstep, ahead: Footstep, half_length: float) -> bool:
    """Return true if a foot, half a sole's length given [m], stands so far ahead of the other one that feet roll."""
    return way(behind, ahead) > _LEAST_STEP * half_length


def way(behind: Footstep, ahead: Footstep) -> float:
    """Way by which one foot stands ahead of the other, along its own heading [m]."""
    return float(((ahead.position - behind.position)[:2] @ frame_rotation(ahead.yaw))[0])


def landing_pitch(stance: Footstep, landing: Footstep, half_length: float, usual: float, most: float) -> float:
    """Pitch that a foot lands with, toes up, by how far ahead of the other one it lands [rad].

    A leg leans back by as much as its foot is ahead, and its sole with it. A foot that lands beside or behind the other
    one lands flat.

    Args:
        stance: the other foot.
        landing: where it lands.
        half_length: half of the sole's length [m].
        usual: way of the gait's steps, from which on the pitch is the greatest [m].
        most: that pitch [rad].
    """
    least = _LEAST_STEP * half_length
    beyond = way(stance, landing) - least
    if beyond <= 0.0:
        return 0.0
    return most * min(1.0, round(beyond / max(usual - least, _SAME_WAY), _DECIMALS))


def toe_off(foot: Foot, ramp: float, lift_off: float, single: float, angle: float, early: bool) -> RollSpan:
    """The roll of a foot that leaves the ground.

    Args:
        foot: which.
        ramp: time that the weight takes to leave it, which ends as it leaves the ground [samples].
        lift_off: when it leaves the ground [samples].
        single: duration of its single support [samples].
        angle: greatest pitch [rad].
        early: whether it does so as soon as the other foot lands.
    """
    waits = 0.0 if early else _BEGIN
    return RollSpan(foot, lift_off - (1.0 - waits) * ramp, lift_off + _END * single, angle)


def heel_strike(foot: Foot, touchdown: float, single: float, double: float, angle: float) -> RollSpan:
    """The roll of a foot that comes to the ground, which is flat on it at the end of double support.

    Args:
        foot: which.
        touchdown: when it comes to the ground [samples].
        single: duration of its single support [samples].
        double: duration of the double support after it [samples].
        angle: greatest pitch, toes up [rad].
    """
    return RollSpan(foot, touchdown - min(double, (1.0 - _END) * single), touchdown + _FLAT * double, -angle)


def pivot_of(angle: float, half_length: float) -> float:
    """The edge about which a sole turns by an angle [rad], ahead of its centre [m]."""
    return math.copysign(half_length, angle)
